"""Functions that take a Dataset of ours refuse one that was harmed, in our words, or give a result."""

import signal
import warnings
from collections.abc import Callable
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference.harmed import every_harm, harm, harms, takers
from restitution import figures, fit, flight

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
LAW = rs.TangentialRestitution(normal=0.98)
SPEEDS, RATIOS = np.linspace(0.7, 1.0, 4), np.linspace(0.9, 1.1, 21)

RUN = rs.simulate(BODY, LAW, particles=40, impacts=8, spin=(0.0, 30.0, 10.0), record="state")
FOUND = rs.reduce(rs.simulate(BODY, LAW, particles=300, impacts=20), SPEEDS, RATIOS)
MEASURED = flight.restitution(
    np.cumsum(0.9 ** np.arange(10.0)),
    1e-4,
    drop_height=0.3,
    drag=flight.Drag(terminal_velocity=9.0, uncertainty=0.4),
)
OF_A_RUN = ("gravity", "incline", "release_height", "release_velocity", "axial_inertia", "transverse_inertia")
OF_A_SERIES = (
    *("gravity", "gravity_uncertainty", "drop_height", "drop_height_uncertainty"),
    *("terminal_velocity", "terminal_velocity_uncertainty"),
)
LEARNED = rs.FluctuatingRestitution.from_statistics(FOUND)

HEARD = ["time", "impact_velocity", "rebound_velocity", "restitution", "rotational_fraction"]
SEEN = ["restitution_count", "velocity_edges", "restitution_edges", "number"]
COUNTED = [*SEEN, "restitution_underflow", "restitution_overflow"]
SPREAD = ["variance", "variance_error", "number", "velocity_edges"]
POINTS = ["restitution", "restitution_error", "impact_velocity", "impact_velocity_error"]

TAKERS: dict[str, tuple[xr.Dataset, tuple[str, ...], Callable[[xr.Dataset], Any]]] = {
    "trajectory": (RUN, OF_A_RUN, lambda data: rs.trajectory(data, 0, 0.1)),
    "flight.clock": (RUN[HEARD], OF_A_RUN[:2], flight.clock),
    "figures.trajectory": (RUN[HEARD], OF_A_RUN[:3], figures.trajectory),
    "fit.slopes of impacts": (
        RUN[HEARD],
        (),
        lambda data: fit.slopes(data, SPEEDS, location=0.98, resamples=2),
    ),
    "distance": (RUN[HEARD], (), LEARNED.distance),
    "flight.fit": (MEASURED, OF_A_SERIES, flight.fit),
    "flight.figure": (MEASURED[POINTS], (), flight.figure),
    "flight.restitution": (MEASURED[["time", "uncertainty"]], (), flight.restitution),
    "from_statistics": (FOUND, (), rs.FluctuatingRestitution.from_statistics),
    "fit.slopes of counts": (FOUND[COUNTED], (), lambda data: fit.slopes(data, location=0.98)),
    "figures.map": (FOUND[SEEN], (), figures.map),
    "figures.densities": (FOUND[SEEN], (), lambda data: figures.densities(data, 0.75)),
    "figures.scatter": (FOUND[SPREAD], (), figures.scatter),
}
ARGUMENTS = ("data", "found", "statistics", "times", "uncertainty", "particle", "velocity_bins", "velocities")


def broken(call: Callable[[], Any]) -> str | None:
    """Say what is wrong with what a call does with what it was given; None where it keeps the contract."""
    signal.setitimer(signal.ITIMER_REAL, 20.0)  # what hangs ends the tests
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", rs.DistanceWarning)
            call()
    except ValueError as error:
        text = str(error)
        named = text.startswith(ARGUMENTS)
        own = type(error).__module__.startswith("restitution") or type(error) is ValueError
        return None if named and own else f"{type(error).__name__}: {text}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        plt.close("all")
    return None


@pytest.mark.parametrize("name", list(TAKERS))
def test_a_harmed_dataset(name: str) -> None:
    """Every harm of the catalogue to what the function takes: our error, or a result, in time."""
    data, attributes, taker = TAKERS[name]
    found = {}
    for words, make in harms(data, attributes):
        harmed = make(data)
        wrong = broken(lambda harmed=harmed: taker(harmed))  # type: ignore[misc]
        if wrong is not None:
            found[words] = wrong
    assert found == {}


@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
@pytest.mark.parametrize("name", list(takers()))
@settings(max_examples=12)
@given(st.data())
def test_every_function_that_takes_one(name: str, data: st.DataObject) -> None:
    """Drawn from the catalogue, of all public functions; `make hostile` goes through all of it."""
    assert harm(name, data.draw(st.sampled_from(list(every_harm(name))))) is None
