"""Numbers that are hardly any: integers of thousands of digits, records, ranges, views."""

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import fit

BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
HUGE = 10**5000
MASK: Any = [(1, 0)]
RECORDS: Any = np.ma.masked_array([(1.0, 2.0)], mask=MASK, dtype=[("a", "f8"), ("b", "f8")])
TABLE: Any = np.zeros((2, 2))
ONE: Any = np.array(0.1)
SAMPLES = np.random.default_rng(1).normal(size=100)


def simulated(**given: Any) -> xr.Dataset:
    return rs.simulate(BODY, LAW, impacts=2, **given)


def counted(**given: Any) -> xr.Dataset:
    bins = {"velocity_bins": [0.0, 1.0], "restitution_bins": [0.0, 1.0]}
    return rs.statistics(BODY, LAW, particles=4, impacts=2, **(bins | given))


def compared(bodies: Any) -> xr.Dataset:
    return rs.compare(bodies, [LAW], velocity_bins=[0.0, 1.0], restitution_bins=[0.0, 1.0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rs.Frictionless(normal=[HUGE]), r"^normal = \[an integer of 16610 bits\]: must be "),
        (lambda: rs.Dumbbell(radius=[HUGE], separation=0.0), r"^radius = \[an integer of 16610 bits\]"),
        (lambda: rs.RandomSpin(rate=HUGE), r"^rate = an integer of 16610 bits: must be"),
        (lambda: counted(velocity_bins=HUGE), r"^velocity_range: missing; velocity_bins = an integer of 166"),
        (lambda: simulated(particles=1, orientation=RECORDS), r"^orientation = .*: must be .*; it holds rec"),
        (lambda: simulated(particles=RECORDS[0]), r"^particles = .*: must be a whole number"),
        (lambda: fit.gaussian(RECORDS), r"^samples = .*: must be .*; it holds records"),
        (
            lambda: simulated(orientation=range(10**12)),
            r"^orientation = range\(0, 1000000000000\): must be",
        ),
        (lambda: simulated(orientation=range(10**30)), r"^orientation = range.*: must be at most .* numbers"),
        (
            lambda: simulated(orientation=np.broadcast_to(0.5, (10**13,))),
            r"^orientation = an array of shape \(10000000000000,\): must be at most .* numbers",
        ),
        (lambda: compared(xr.DataArray(0.5)), r"^bodies = .*: must be a dict or list of Body"),
        (lambda: compared(np.array(0.5)), r"^bodies = 0\.5: must be a dict or list of Body"),
        (lambda: compared(memoryview(TABLE)), r"^bodies = .*: must be a dict or list of Body"),
        (
            lambda: counted(velocity_bins=10, velocity_range=(-1.7e308, 1.7e308)),
            r"^velocity_range = \(-1\.7e\+308, 1\.7e\+308\): must be a range that 10 bins divide",
        ),
        (lambda: counted(velocity_bins=10, velocity_range=(0, 5e-324)), r"^velocity_range = \(0, 5e-324\): "),
        (
            lambda: counted(velocity_bins=[1e-310, 2e-310, 3e-310]),
            r"^velocity_bins goes from .*: bins must",
        ),
        (
            lambda: rs.reduce(simulated(particles=2), [1e-310, 2e-310, 3e-310], [0.0, 1.0]),
            r"^velocity_bins goes from .*: bins must be so wide that there are finitely many in a unit",
        ),
        (
            lambda: rs.analytic.near_round(BODY, LAW, velocity_bins=[0.0, 1.0], gravity=10**308),
            r"^gravity = an integer of 1024 bits: must be such that speeds neither overflow nor underflow",
        ),
    ],
)
@pytest.mark.filterwarnings("error")
def test_what_is_refused(call: Callable[[], Any], message: str) -> None:
    """By name, in a line, and before memory is filled."""
    with pytest.raises(ValueError, match=message) as caught:
        call()
    assert len(str(caught.value)) < 300


def test_ranges_are_angles() -> None:
    found = simulated(particles=3, orientation=range(3))
    np.testing.assert_array_equal(found.time, simulated(particles=3, orientation=[0.0, 1.0, 2.0]).time)


def test_more_batches_than_can_be_written_out() -> None:
    why = counted(batches=HUGE).attrs["standard_errors"]
    assert why == "none: 4 particles are fewer than two for each of an integer of 16610 bits batches"


def test_a_pair_of_rates_in_an_array() -> None:
    """As the attribute ``spin_rate`` of a file has it."""
    assert rs.RandomSpin(rate=np.array([1.0, 50.0])) == rs.RandomSpin(rate=(1.0, 50.0))


@pytest.mark.parametrize("location", [xr.DataArray(0.1), ctypes.c_double(0.1), memoryview(ONE)])
@pytest.mark.parametrize("family", [fit.asymmetric_laplace, fit.asymmetric_power])
def test_a_location_is_any_number(family: Callable[..., fit.Fit], location: Any) -> None:
    """The number that was checked is the one that is used."""
    assert family(SAMPLES, location=location).parameters == family(SAMPLES, location=0.1).parameters


@pytest.mark.parametrize("gravity", [np.int8(100), np.uint64(9)])
@pytest.mark.filterwarnings("error")
def test_gravity_of_any_type(gravity: Any) -> None:
    """Small integers of NumPy would overflow where they are multiplied."""
    found = rs.analytic.near_round(BODY, LAW, velocity_bins=[0.0, 0.5, 1.0], gravity=gravity)
    same = rs.analytic.near_round(BODY, LAW, velocity_bins=[0.0, 0.5, 1.0], gravity=float(gravity))
    xr.testing.assert_equal(found, same)
