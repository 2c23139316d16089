"""The paper PRE 90, 052204 (2014), redrawn and judged claim by claim."""

from restitution.paper._redraw import redraw

__all__ = ["redraw"]
