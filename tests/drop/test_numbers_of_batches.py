"""The number of batches in every form that a whole number comes in."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs

BINS: dict[str, Any] = {"velocity_bins": [0.0, 2.0], "restitution_bins": [-1.0, 3.0]}


class Sixteen:
    """A whole number that is none of Python's, as those of other libraries."""

    def __index__(self) -> int:
        return 16


def told(batches: Any, particles: int) -> set[str]:
    """What `statistics` and `reduce` say of the standard errors of the same run."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    data = rs.simulate(body, law, particles=particles, impacts=3)
    found: tuple[xr.Dataset, ...] = (
        rs.statistics(body, law, particles=particles, impacts=3, batches=batches, **BINS),
        rs.reduce(data, **BINS, batches=batches),
    )
    return {each.attrs["standard_errors"] for each in found}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", [np.int8, np.uint8, np.int64, np.array], ids=lambda kind: kind.__name__)
def test_numpy_numbers_of_batches(kind: Any) -> None:
    """Twice 100 does not fit into int8; the comparison with the particles is made with Python's numbers."""
    assert told(kind(100), 3) == {"none: 3 particles are fewer than two for each of 100 batches"}


def test_an_object_that_is_a_whole_number() -> None:
    assert told(Sixteen(), 40) == {"jackknife over 16 batches of particles"}
    assert told(Sixteen(), 3) == {"none: 3 particles are fewer than two for each of 16 batches"}


def test_a_number_of_more_digits_than_python_writes() -> None:
    bits = (10**5000).bit_length()
    text = f"none: 3 particles are fewer than two for each of an integer of {bits} bits batches"
    assert told(10**5000, 3) == {text}


@pytest.mark.parametrize("batches", [0, -1, True, 2.0, "16", None])
def test_no_number_of_batches(batches: Any) -> None:
    """Refused before the run, also where only counts are wanted and no batches are made."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    data = rs.simulate(body, law, particles=2, impacts=2)
    for counts_only in (False, True):
        with pytest.raises(ValueError, match=r"^batches = .*: must be a whole number >= 1$"):
            rs.statistics(body, law, batches=batches, counts_only=counts_only, **BINS)
    with pytest.raises(ValueError, match=r"^batches = .*: must be a whole number >= 1$"):
        rs.reduce(data, **BINS, batches=batches)
