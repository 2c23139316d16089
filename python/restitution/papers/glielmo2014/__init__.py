"""The paper PRE 90, 052204 (2014), redrawn and judged claim by claim."""

from restitution.papers.glielmo2014._redraw import redraw

__all__ = ["redraw"]
