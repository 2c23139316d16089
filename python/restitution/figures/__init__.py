"""Plots of restitution data in a journal's style; they draw what they are given and compute nothing."""

from restitution.figures._panels import histogram, line, plain_log, population, population_bar
from restitution.figures._style import COLORMAP, COLORS, COLUMN, MARKERS, PAGE, letter, panels, save, styled

__all__ = [
    "COLORMAP",
    "COLORS",
    "COLUMN",
    "MARKERS",
    "PAGE",
    "histogram",
    "letter",
    "line",
    "panels",
    "plain_log",
    "population",
    "population_bar",
    "save",
    "styled",
]
