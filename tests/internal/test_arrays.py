"""Numbers from outside: what NumPy would take for a number without a word is refused, by name."""

import contextlib
from array import array
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.commands import same
from reference.contract import CALLS
from reference.refused import message
from restitution import analytic, flight
from restitution._internal.arrays import check_units, real, reals, shape, whole
from restitution.drop.bins import increasing_edges
from restitution.drop.recorded import _UNITS, check_variables, counted, records


class Quantity:
    """As astropy's: an array to NumPy, which forgets the unit."""

    def to_value(self) -> list[float]:
        return [1.0]

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        return np.array([1.0])


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
    10**400,
    [np.array(True), 2.0],
    [np.array([True, False]), np.array([0.0, 1.0])],
    [xr.DataArray(True), 2.0],
    bytearray(b"01"),
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
    for said in ("m s-1", "m/s", "m s⁻¹"):
        assert rs.reduce(data, edges.assign_attrs(units=said), [-1.0, 0.0, 1.0]).identical(plain)
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


def test_datasets_that_are_none(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Variables of other dimensions or types, and counts that count nothing, by name."""
    data = rs.simulate(body, law, particles=3, impacts=4)
    for harmed, said in (
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
        with pytest.raises(ValueError, match=f"(?s)^{said}"):
            records("data", harmed, "impact_velocity", "restitution")
    found = rs.reduce(data, np.linspace(0, 2, 5), np.linspace(-1, 2, 4))
    for harmed, said in (
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
        with pytest.raises(ValueError, match=f"(?s)^{said}"):
            counted("data", harmed)


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
    ours, seen = " ".join(_UNITS.values()).split(), set()
    for data in (run, counts, measured, flight.clock(run)):
        names = [name for name in ours if name in data.variables and "units" in data[name].attrs]
        check_variables("data", data, *names)
        seen |= set(names)
    assert set(ours) - seen == {"height"}  # of a run before its positions are known


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


def test_parts_of_a_study_that_cannot_be_gone_through() -> None:
    parts: Any = np.zeros((2, 2)).data
    assert message(lambda: rs.study.merge("both.zarr", parts)).endswith(": must be a list of paths")
