"""Arrays and Datasets that say that they are in other units are refused by every public function."""

import contextlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.contract import CALLS
from reference.processes import same
from restitution import flight
from restitution._internal.arrays import check_units, real, reals
from restitution._internal.datasets import _UNITS

ANY = {
    "analytic.FirstImpact.restitution": "cos_theta",
    "figures.histogram": "edges density error",
    "figures.line": "x y error",
    "figures.plain_log": "ticks",
    "figures.population": "x_edges y_edges",
    "sound.impacts": "source",
}
"""What is drawn, or heard, in whatever units it is; and the cosine of an angle in rad."""


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Some functions write files."""
    with contextlib.chdir(tmp_path_factory.mktemp("units")):
        yield


def numbers(value: Any) -> bool:
    """Whether an argument is a number, or an array of them."""
    if isinstance(value, bool) or not isinstance(
        value, int | float | list | tuple | np.ndarray | xr.DataArray
    ):
        return False
    try:
        return np.asarray(value).dtype.kind in "iuf"
    except ValueError:
        return False


@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
@pytest.mark.parametrize("name", list(CALLS))
def test_other_units_are_refused(elsewhere: None, name: str) -> None:
    """By an error that names the argument and its units, if the function needs it at all."""
    function, make = CALLS[name]
    for argument, value in make().items():
        if numbers(value) and argument not in ANY.get(name, "").split():
            given = make() | {argument: xr.DataArray(value, attrs={"units": "furlong"})}
            with pytest.raises(ValueError, match=rf"^{argument}\b"):
                function(**given)
        if isinstance(value, xr.Dataset):
            for variable in variables_that_matter(name, argument):
                harmed = value.assign({variable: value[variable].assign_attrs(units="furlong")})
                text = rf"(?s)^{argument}\.{variable} has units 'furlong': must be in "
                with pytest.raises(ValueError, match=text):
                    function(**make() | {argument: harmed})


def variables_that_matter(name: str, argument: str) -> list[str]:
    """Numbers of a Dataset without which a function fails, or gives something else."""
    function, make = CALLS[name]
    data = make()[argument]
    if name == "flight.clock":  # which hands on all that it is given
        return ["time"]
    whole, found = function(**make()), []
    for variable in data.data_vars:
        if data[variable].dtype.kind in "iuf":
            try:
                without = function(**make() | {argument: data.drop_vars(variable)})
            except (ValueError, KeyError, AttributeError):
                found.append(str(variable))
            else:
                if not same(without, whole):
                    found.append(str(variable))
    return found


def test_our_units_are_those_that_we_write(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """What one function returns another takes."""
    run = rs.simulate(
        body, law, particles=3, impacts=4, record="state", release_height=rs.RandomHeight(0.05, 0.07),
        orientation="isotropic", spin=rs.RandomSpin(rate=3.0, axis="isotropic"),
    )  # fmt: skip
    counts = rs.reduce(run, np.linspace(0, 2, 5), np.linspace(-1, 2, 4))
    measured = flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    seen = set()
    for data in (run, counts, measured, flight.clock(run)):
        for name, variable in data.variables.items():
            if "units" in variable.attrs and name in _UNITS:
                seen.add(name)
                assert variable.attrs["units"] == _UNITS[str(name)], name
    assert set(_UNITS) - seen == {"height"}  # of a run before its positions are known


@pytest.mark.parametrize(
    ("unit", "spellings"),
    [
        (
            "m s-1",
            ["m s-1", "m/s", "m s⁻¹", "m·s⁻¹", "m.s-1", "m s^-1", "m s**-1", "meter / second", " m/s "],
        ),
        ("rad s-1", ["rad s-1", "rad/s", "s-1", "radian / second"]),
        ("s", ["s", "second", "seconds", "sec"]),
        ("m", ["m", "metre", "meters"]),
        ("rad", ["rad", "radians"]),
        ("Hz", ["Hz", "s-1"]),
        ("1", ["1", "", "dimensionless"]),
        ("kg m-3", ["kg m-3"]),
    ],
)
def test_spellings(unit: str, spellings: list[str]) -> None:
    for said in spellings:
        check_units("x", xr.DataArray(1.0, attrs={"units": said}), unit)
    for said in ("mm s-1", "km/h", "ms", "%", "deg", "mm", "minutes", "kHz"):
        text = rf"^x has units '{said}': must be in {unit};"
        with pytest.raises(ValueError, match=text):
            real("x", xr.DataArray(1.0, attrs={"units": said}), "a number", unit=unit)
        with pytest.raises(ValueError, match=text):
            reals("x", [xr.DataArray(1.0, attrs={"units": said}), 2.0], "numbers", unit=unit)


def test_a_series_of_pandas_can_have_units_too() -> None:
    series = xr.DataArray([1.0, 2.0], dims="n").to_series()
    series.attrs["units"] = "km/h"
    with pytest.raises(ValueError, match=r"^v has units 'km/h': must be in m s-1"):
        reals("v", series, "speeds", unit="m s-1")
