"""`restitution listen`: from a recording to a report with ε(v), its errors and the laws that fit."""

from restitution.listen._analysis import Analysis, Series, analyse
from restitution.listen._report import write

__all__ = ["Analysis", "Series", "analyse", "write"]
