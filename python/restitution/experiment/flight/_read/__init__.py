"""Times of impacts from files of other programs, by the conventions of each."""

from restitution.experiment.flight._read._reader import read

__all__ = ["read"]
