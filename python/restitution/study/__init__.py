"""Parameter studies: a run, what is varied in it and what is measured, on one machine or many."""

from restitution.study._identity import Refused
from restitution.study._results import Status, learned, open_store, status
from restitution.study._study import Study, study_of
from restitution.study._sweep import Estimate, estimate, merge, sweep

__all__ = [
    "Estimate",
    "Refused",
    "Status",
    "Study",
    "estimate",
    "learned",
    "merge",
    "open_store",
    "status",
    "study_of",
    "sweep",
]
