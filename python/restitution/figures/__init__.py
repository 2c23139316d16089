"""Figures in a journal's style: of one's own results in a line each, and the pieces that they are made of.

`map`, `densities`, `scatter`, `fraction`, `moments`, `trajectory` and `resting` take what `statistics`,
`compare`, `sweep`, `simulate` and `resting` give, `body` a body, `impact` and `animate` an impact. They
return a Matplotlib figure or a film, which a notebook shows; `save` writes a figure. Each takes a
``style``: "paper", "page" or "slides", or one of these with "-dark". The other functions draw what they are
given into a panel, in the sizes, colours and markers that stand here:

>>> from restitution import figures
>>> figure, [[left, right]] = figures.panels(figures.PAGE, 0.6 * figures.COLUMN, columns=2)
>>> for i, (color, marker) in enumerate(zip(figures.COLORS, figures.MARKERS, strict=True)):
...     lines = left.plot([0, 1], [i, i], color=color, marker=marker)
>>> image = right.imshow([[0.0, 0.5, 1.0]], cmap=figures.COLORMAP)
"""

from restitution.figures._plots import densities, fraction, map, moments, resting, scatter, trajectory
from restitution.figures.pieces import histogram, line, plain_log, population, population_bar
from restitution.figures.scene import Film, animate, body, impact
from restitution.figures.style import COLORMAP, COLORS, COLUMN, MARKERS, PAGE, letter, panels, save, styled

__all__ = [
    "COLORMAP",
    "COLORS",
    "COLUMN",
    "MARKERS",
    "PAGE",
    "Film",
    "animate",
    "body",
    "densities",
    "fraction",
    "histogram",
    "impact",
    "letter",
    "line",
    "map",
    "moments",
    "panels",
    "plain_log",
    "population",
    "population_bar",
    "resting",
    "save",
    "scatter",
    "styled",
    "trajectory",
]
