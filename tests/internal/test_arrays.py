"""The one door for numbers: what NumPy would take for a number without a word is refused, by name."""

from array import array
from collections import UserList, deque
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import flight
from restitution._internal.arrays import real, reals, shape, whole
from restitution.drop.bins import increasing_edges
from restitution.drop.recorded import counted, records


class Quantity:
    """As astropy's: an array to NumPy, which forgets the unit."""

    def to_value(self) -> list[float]:
        return [1.0]

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.array([1.0])


class Failing:
    """Raises whatever is asked of it."""

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        raise RuntimeError("no array")


def nested(depth: int) -> Any:
    """A list in a list, and so on."""
    return [nested(depth - 1)] if depth else [1.0]


NO_REALS: list[Any] = [
    np.ma.masked,
    np.ma.masked_array([0.0, 1.0], [False, True]),
    [np.ma.masked_array([0.0, 1.0], [False, True])],
    [0.0, np.ma.masked],
    np.array(["2020-01-01", "2020-01-02"], dtype="datetime64[D]"),
    np.array([1, 2], dtype="timedelta64[ns]"),
    [True, False],
    [0.0, True],
    [[0.0], [np.True_]],
    np.array([True, False]),
    [0.0, 1j],
    np.array([1.0, 2.0], dtype=complex),
    ["0", "1"],
    "01",
    b"01",
    np.array([0.0, 1.0], dtype=object),
    [Decimal(1), Decimal(2)],
    [Fraction(1), Fraction(2)],
    [None, 1.0],
    None,
    {0.0, 1.0},
    {0.0: 1.0},
    (x for x in (0.0, 1.0)),
    [[0.0], [1.0, 2.0]],
    np.array([(1.0, 2.0)], dtype=[("a", "f8"), ("b", "f8")]),
    object(),
    Quantity(),
    Failing(),
    nested(70),
    10**400,
    [np.array(True), 2.0],
    [np.array([True, False]), np.array([0.0, 1.0])],
    [xr.DataArray(True), 2.0],
    deque([True, 2.0]),
    UserList([0.0, True]),
    deque([np.ma.masked, 1.0]),
    bytearray(b"01"),
    memoryview(b"01"),
]


@pytest.mark.parametrize("value", NO_REALS, ids=lambda value: type(value).__name__)
def test_what_is_no_array_of_reals(value: Any) -> None:
    with pytest.raises(ValueError, match=r"(?s)^bins = .*: must be edges"):
        reals("bins", value, "edges")


@pytest.mark.parametrize(
    "value",
    [
        [0, 1],
        (0.0, 1),
        range(2),
        deque([0.0, 1.0]),
        memoryview(array("d", [0.0, 1.0])),
        np.array([0.0, 1.0], dtype=">f8"),
        np.array([0, 1], dtype=np.uint8),
        np.array([0.0, 1.0], dtype=np.longdouble),
        np.ma.masked_array([0.0, 1.0], [False, False]),
        [np.ma.masked_array([0.0, 1.0])[0], 1.0],
        xr.DataArray([0.0, 1.0]),
        np.array([[0.0, 5.0], [1.0, 5.0]])[:, 0],
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_one(value: Any) -> None:
    found = reals("bins", value, "edges")
    assert found.dtype == np.float64
    assert found.dtype.isnative
    assert found.tolist() == [0.0, 1.0]


def test_the_element_that_is_not_finite_is_named() -> None:
    with pytest.raises(ValueError, match=r"^bins\[1, 0\] = inf: must be edges"):
        reals("bins", [[0.0, 1.0], [np.inf, np.nan]], "edges")
    with pytest.raises(ValueError, match=r"^x = nan: must be a number"):
        real("x", np.nan, "a number")
    assert np.isinf(reals("bins", np.longdouble("1e400"), "edges", finite=False))


@pytest.mark.parametrize(
    "value",
    [
        True,
        np.True_,
        1.0,
        "1",
        None,
        np.ma.masked,
        np.ma.masked_array(3, mask=True),
        1j,
        np.timedelta64(1, "ns"),
        np.datetime64(1, "s"),
    ],
)
def test_what_is_no_whole_number(value: Any) -> None:
    with pytest.raises(ValueError, match=r"^lags = .*: must be a whole number >= 1"):
        whole("lags", value, 1)
    assert whole("lags", np.uint8(3), 1) == 3


@pytest.mark.parametrize("size", [True, (True, 2), (2, np.ma.masked_array(3, mask=True)), "3", (1.0,), -1])
def test_what_is_no_shape(size: Any) -> None:
    with pytest.raises(ValueError, match=r"(?s)^size = .*: must be a whole number >= 0 or a tuple of them"):
        shape("size", size)
    assert shape("size", np.array([3, 0])) == (3, 0)


def test_a_duration_is_no_number_of_bins(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """To NumPy its type is one of whole numbers."""
    bins: Any = {"velocity_bins": np.timedelta64(10, "s"), "restitution_bins": [0.0, 1.0]}
    spans: Any = ({}, {"velocity_range": (0.0, 1.0)})
    for span in spans:
        with pytest.raises(ValueError, match=r"^velocity_(range|bins) = "):
            rs.statistics(body, law, particles=2, impacts=2, **bins, **span)


def test_scalars_that_pydantic_would_convert() -> None:
    """A masked separation is no sphere, a date no radius."""
    for value in (np.ma.masked, np.timedelta64(3, "ns"), np.complex64(1), np.array("1"), 10**400):
        with pytest.raises(ValueError, match=r"^separation = .*: must be a finite number >= 0"):
            rs.Dumbbell(radius=3e-3, separation=value)
        with pytest.raises(ValueError, match=r"^radius\[0\] = .*: must be a finite number > 0"):
            rs.Dumbbell(radius=(value, 1.0), separation=0.0)
    assert rs.Dumbbell(radius=np.float32(0.5), separation=np.longdouble(0.25)).separation == 0.25


def in_units(data: xr.Dataset, name: str, units: str) -> xr.Dataset:
    """The same numbers, said to be in other units."""
    return data.assign({name: data[name].assign_attrs(units=units)})


def test_units_of_labelled_arrays(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Numbers that say that they have other units are not taken for SI; those that say nothing are."""
    data = rs.simulate(body, law, particles=3, impacts=4)
    edges = xr.DataArray([0.0, 0.5, 1.0], dims="edge")
    plain = rs.reduce(data, edges, [-1.0, 0.0, 1.0])
    for same in ("m s-1", "m/s", "m s⁻¹"):
        assert rs.reduce(data, edges.assign_attrs(units=same), [-1.0, 0.0, 1.0]).identical(plain)
    for name in plain.data_vars:
        if str(name).endswith("_edges"):
            increasing_edges(plain[name], str(name))
    with pytest.raises(ValueError, match=r"^velocity_bins has units 'mm s-1': must be in m s-1"):
        rs.reduce(data, edges.assign_attrs(units="mm s-1"), [-1.0, 0.0, 1.0])
    with pytest.raises(ValueError, match=r"^restitution_bins has units 'm s-1': must be in 1"):
        rs.reduce(data, edges, plain.velocity_edges)
    heard = xr.Dataset({"time": ("impact", [0.0, 400.0, 780.0]), "uncertainty": ("impact", [0.1, 0.1, 0.1])})
    with pytest.raises(ValueError, match=r"^times.time has units 'ms': must be in s"):
        flight.restitution(in_units(heard, "time", "ms"))
    assert flight.restitution(in_units(heard, "time", "s")).identical(flight.restitution(heard))


@pytest.mark.parametrize("name", ["time", "uncertainty", "flag"])
@pytest.mark.parametrize("kind", ["datetime64[ns]", "timedelta64[ns]", "U8", "complex", "bool", "object"])
def test_a_dataset_of_times_has_numbers(name: str, kind: str) -> None:
    """A duration of 0.4 s is no 4e8: xarray makes durations of files whose times have the unit "seconds"."""
    heard = xr.Dataset(
        {
            "time": ("impact", [0.0, 4.0, 7.0]),
            "uncertainty": ("impact", [1.0, 1.0, 1.0]),
            "flag": ("impact", [0, 0, 0]),
        }
    )
    flight.restitution(heard)
    with pytest.raises(ValueError, match=rf"(?s)^times.{name} = .*: must be (numbers, in s|0 to 3)"):
        flight.restitution(heard.assign({name: heard[name].astype(kind)}))
    with pytest.raises(ValueError, match=rf"^times.*{name if name != 'time' else ''}.* has dimensions"):
        flight.restitution(
            heard.assign(
                {name: (("other", "more")[: 1 + (name == "time")], [[1.0]] if name == "time" else [1.0])}
            )
        )


def test_datasets_that_are_none(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Variables of other dimensions or types, and counts that count nothing, by name."""
    data = rs.simulate(body, law, particles=3, impacts=4)
    for harmed, message in (
        (None, "data = None: must be a Dataset"),
        (data.to_dataframe(), "data = .*: must be a Dataset"),
        (data.drop_vars("restitution"), "data lacks restitution"),
        (data.isel(impact=0), r"data.impact_velocity has dimensions \(particle\): must be"),
        (data.rename(impact="bounce"), r"data.impact_velocity has dimensions \(particle, bounce\)"),
        (data.assign(restitution=data.restitution.astype(str)), "data.restitution = .*: must be real"),
        (data.assign(restitution=data.restitution > 0), "data.restitution = .*: must be real"),
        (data.assign(restitution=data.restitution + 0j), "data.restitution = .*: must be real"),
        (
            in_units(data, "impact_velocity", "mm s-1"),
            "data.impact_velocity has units 'mm s-1': must be in m s-1",
        ),
        (in_units(data, "restitution", "%"), "data.restitution has units '%': must be in 1"),
    ):
        with pytest.raises(ValueError, match=f"(?s)^{message}"):
            records("data", harmed, "impact_velocity", "restitution")
    found = rs.reduce(data, np.linspace(0, 2, 5), np.linspace(-1, 2, 4))
    for harmed, message in (
        (data, "data lacks restitution_count"),
        (
            found.assign(restitution_count=found.restitution_count - 1),
            r"data.restitution_count\[0, 0\] = -1.0: must be a whole number",
        ),
        (
            found.assign(restitution_count=found.restitution_count + 0.5),
            r"data.restitution_count\[0, 0\] = 0.5: must be a whole number",
        ),
        (found.isel(velocity=0), "data.restitution_count has dimensions"),
        (found.assign(velocity_edges=-found.velocity_edges), "data.velocity_edges goes from -0.0 to -0.5"),
        (in_units(found, "velocity_edges", "km/h"), "data.velocity_edges has units 'km/h': must be in m s-1"),
        (found.isel(velocity=slice(2)), "data.velocity_edges has 5 edges: must be one more than the 2"),
    ):
        with pytest.raises(ValueError, match=f"(?s)^{message}"):
            counted("data", harmed)


@pytest.mark.parametrize("kind", ["datetime64[ns]", "timedelta64[ns]", "U8", "complex", "bool"])
def test_states_and_measured_times_are_numbers(
    kind: str, body: rs.Dumbbell, law: rs.TangentialRestitution
) -> None:
    """Neither the motion between impacts nor a law fitted to times takes dates, text or complex numbers."""
    data = rs.simulate(body, law, particles=3, impacts=4, record="state")
    for name in ("time", "position", "axis", "velocity_after", "angular_velocity_after", "release_angle"):
        with pytest.raises(ValueError, match=rf"(?s)^data.{name} = .*: must be real numbers"):
            rs.trajectory(data.assign({name: data[name].astype(kind)}), 1, 0.01)
    measured = flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    for name in ("time", "uncertainty"):
        with pytest.raises(ValueError, match=rf"(?s)^data.{name} = .*: must be real numbers"):
            flight.fit(measured.assign({name: measured[name].astype(kind)}))


@pytest.mark.parametrize("value", [None, "1", 1j, True, [1.0, 2.0], np.datetime64("2020-01-01"), np.nan])
def test_settings_of_a_trajectory_are_numbers(
    value: Any, body: rs.Dumbbell, law: rs.TangentialRestitution
) -> None:
    data = rs.simulate(body, law, particles=3, impacts=4, record="state")
    for name in ("gravity", "incline", "release_velocity", "axial_inertia", "release_height"):
        with pytest.raises(ValueError, match=rf"(?s)^data.{name}.* = .*: must be (a|three) finite number"):
            rs.trajectory(data.assign_attrs({name: value}), 1, 0.01)
    with pytest.raises(ValueError, match=r"^data.transverse_inertia = 0: must be a finite number > 0"):
        rs.trajectory(data.assign_attrs(transverse_inertia=0), 1, 0.01)
