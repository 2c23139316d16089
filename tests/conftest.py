"""What all tests share."""

import matplotlib
import pytest
from hypothesis import settings

import restitution as rs

matplotlib.use("Agg")

# The same examples in every run, however busy the machine: a test that fails once fails always.
settings.register_profile("repeatable", derandomize=True, deadline=None, database=None)
settings.load_profile("repeatable")


@pytest.fixture
def body() -> rs.Dumbbell:
    """The paper's particle of Figs. 2-5 and 7, L/R = 0.1."""
    return rs.Dumbbell(radius=3e-3, separation=3e-4)


@pytest.fixture
def law() -> rs.TangentialRestitution:
    """The paper's law of Figs. 2-7."""
    return rs.TangentialRestitution(normal=0.98)
