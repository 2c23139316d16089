"""A number, or a few, in every form that a number comes in: what is checked is what is used."""

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.hostile import masked_with_fields
from reference.refused import message
from restitution import analytic, fit

FORMS: dict[str, Callable[[float], Any]] = {
    "array": np.array,
    "data array": xr.DataArray,
    "of C": ctypes.c_double,
    "view of memory": lambda x: np.array(x).data,
    "NumPy": np.float64,
}


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
@pytest.mark.parametrize("family", [fit.asymmetric_laplace, fit.asymmetric_power, fit.cusp_mixture])
def test_a_location_in_every_form(family: Any, form: Callable[[float], Any]) -> None:
    x = np.random.default_rng(1).normal(size=50)
    assert family(x, form(0.1)).parameters == family(x, 0.1).parameters


@pytest.mark.parametrize("family", [fit.asymmetric_laplace, fit.asymmetric_power, fit.cusp_mixture])
@pytest.mark.parametrize("location", [1e101, np.nan, "0.1", [0.1], 10**400], ids=lambda one: str(one)[:5])
def test_no_location(family: Any, location: Any) -> None:
    """The three families have the same bound."""
    text = message(lambda: family(np.arange(9.0), location))
    assert text.startswith("location = ")
    assert text.endswith(": must be a finite number, at most 1e100 either way")


@pytest.mark.filterwarnings("error")
def test_whole_numbers_of_near_round() -> None:
    """They are used as the doubles that were checked: as they come they overflow, or NumPy refuses them."""
    law, edges = rs.Frictionless(normal=0.9), [0.3, 0.5]

    def found(**given: Any) -> xr.Dataset:
        return analytic.near_round(
            rs.Dumbbell(radius=3e-3, separation=3e-5), law, velocity_bins=edges, **given
        )

    assert found(gravity=np.int8(100)).identical(found(gravity=100.0))
    assert found(gravity=np.array(10)).identical(found(gravity=10.0))
    assert found(release_height=np.int8(1)).identical(found(release_height=1.0))
    text = message(lambda: found(gravity=10**308))
    assert text == "gravity = 1e+308: must be such that speeds neither overflow nor underflow"


@pytest.mark.parametrize(
    "pair",
    [
        np.array([1.0, 50.0]),
        np.array([1, 50], dtype=np.int8),
        xr.DataArray([1.0, 50.0], dims="end", attrs={"units": "rad s-1"}),
        [np.array(1.0), 50],
        (1, 50),
    ],
    ids=lambda pair: type(pair).__name__,
)
def test_rates_of_spin_in_every_form(pair: Any) -> None:
    """A netCDF file gives back the attribute ``spin_rate`` as an array."""
    assert rs.RandomSpin(rate=pair) == rs.RandomSpin(rate=(1.0, 50.0))


def test_rates_of_spin_from_a_file(tmp_path: Any) -> None:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    run = rs.simulate(body, law, particles=2, impacts=2, spin=rs.RandomSpin(rate=(1.0, 50.0)))
    run.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as data:
        assert rs.RandomSpin(rate=data.attrs["spin_rate"]).rates == (1.0, 50.0)


@pytest.mark.parametrize(
    "rate", [[5.0], [], [1.0, 2.0, 3.0], np.zeros((2, 1)), [2.0, 1.0], [-1.0, 1.0], [0.0, np.inf]]
)
def test_no_rates_of_spin(rate: Any) -> None:
    assert message(lambda: rs.RandomSpin(rate=rate)).startswith("rate = ")


MASKED = masked_with_fields()


@pytest.mark.parametrize("value", [MASKED, MASKED[0], [MASKED[0]], [1.0, MASKED[0]]], ids=repr)
@pytest.mark.parametrize("name", ["orientation", "spin", "release_velocity", "gravity", "seed"])
def test_masked_values_with_fields(name: str, value: Any) -> None:
    """Of these NumPy cannot say whether any is masked, and raises; they are no numbers in any case."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    assert message(lambda: rs.simulate(body, law, **{name: value})).startswith(f"{name} = ")


def test_an_offset_beyond_the_radius_names_both() -> None:
    """Either may be the one that is wrong."""
    text = message(lambda: rs.LoadedSphere(radius=1e-300, load=1e-4, offset=2e-3))
    assert text == "offset = 0.002, radius = 1e-300: must be at most the radius (m)"


@pytest.mark.parametrize(
    "bodies",
    [xr.DataArray(0.5), np.zeros((2, 2)).data, np.array(0.5), 3, "dumbbell", None],
    ids=lambda one: type(one).__name__,
)
def test_no_bodies(bodies: Any) -> None:
    """What says that it can be gone through, and cannot."""
    bins: dict[str, Any] = {"velocity_bins": [0.0, 1.0], "restitution_bins": [0.0, 1.0]}
    text = message(lambda: rs.compare(bodies, [rs.Frictionless(normal=0.9)], **bins))
    assert text.startswith("bodies = ")
    assert text.endswith(": must be a dict or list of Body")


def test_the_first_that_is_no_body() -> None:
    """It ends the search, however many there are; what makes the bodies may be what is wrong."""
    bins: dict[str, Any] = {"velocity_bins": [0.0, 1.0], "restitution_bins": [0.0, 1.0]}
    law = rs.Frictionless(normal=0.9)
    endless: Any = range(10**12)
    assert message(lambda: rs.compare(endless, [law], **bins)) == "bodies holds 0: must be objects of a Body"
    made = (rs.Dumbbell(radius=radius, separation=0.0) for radius in (1.0, -1.0))
    assert message(lambda: rs.compare(made, [law], **bins)).startswith("radius = -1.0: ")


def test_parts_of_a_study_that_cannot_be_gone_through() -> None:
    parts: Any = np.zeros((2, 2)).data
    assert message(lambda: rs.study.merge("both.zarr", parts)).endswith(": must be a list of paths")
