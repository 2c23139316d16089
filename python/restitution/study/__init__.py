"""Parameter studies: a run, what is varied in it and what is measured, on one machine or many."""

from restitution.study._estimate import Estimate, estimate
from restitution.study._identity import Refused
from restitution.study._learned import learned
from restitution.study._merge import merge
from restitution.study._status import Status, open_store, status
from restitution.study._study import Study, study_of
from restitution.study._sweep import sweep

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
