"""`restitution listen`: from a recording to a report with ε(v), its errors and the laws that fit."""

from restitution.experiment.listen._analysis import Analysis, Series, analyse
from restitution.experiment.listen._report import write
from restitution.experiment.listen._setting import Setting

__all__ = ["Analysis", "Series", "Setting", "analyse", "write"]
