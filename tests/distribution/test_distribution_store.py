"""The Dataset and the file of a learned distribution, from histograms that are written down here."""

import hashlib
import re
from typing import Any

import numpy as np
import pytest
import xarray as xr

from restitution._internal.parameters import ParameterError
from restitution.distribution import _store
from restitution.distribution._table import Histogram

NODES = np.array([0.1, 0.3])
EDGES = [np.array([0.0, 0.5, 1.0]), np.array([-0.5, 0.0, 0.75, 1.0])]
BELOW = [np.array([0.0, 0.25, 1.0]), np.array([0.0, 0.25, 0.5, 1.0])]


@pytest.fixture
def data() -> xr.Dataset:
    histograms = [Histogram(edges, below) for edges, below in zip(EDGES, BELOW, strict=True)]
    return _store.of_histograms(NODES, histograms, np.array([40.0, 80.0]), {"source": "here"})


@pytest.fixture
def conditional(data: xr.Dataset) -> xr.Dataset:
    """Two conditions at the first node and one at the second."""
    return data.assign(
        given_components=("node", [2, 1]),
        given=("given_component", [0.0, 0.5, 0.2]),
        given_lowest=("node", [0.0, 0.2]),
        given_highest=("node", [0.5, 0.2]),
        given_edges=("given_component", [2, 3, 2]),
        given_restitution_edge=("given_edge", [0.0, 1.0, 0.0, 0.5, 1.0, 0.0, 1.0]),
        given_probability_below=("given_edge", [0.0, 1.0, 0.0, 0.5, 1.0, 0.0, 1.0]),
    ).assign_attrs(given="rotational_fraction")


def test_histograms_follow_each_other(data: xr.Dataset) -> None:
    """As ragged arrays of the CF conventions, with units."""
    assert data["velocity"].values.tolist() == [0.1, 0.3]
    assert data["edges"].values.tolist() == [3, 4]
    assert data["edges"].dtype == np.int64
    assert data["edges"].attrs["sample_dimension"] == data["restitution_edge"].dims[0] == "edge"
    assert data["restitution_edge"].values.tolist() == [*EDGES[0], *EDGES[1]]
    assert data["probability_below"].values.tolist() == [*BELOW[0], *BELOW[1]]
    assert data["impacts"].values.tolist() == [40.0, 80.0]
    assert data["velocity"].dims == data["impacts"].dims == data["edges"].dims == ("node",)
    assert data["probability_below"].dims == ("edge",)
    units = {str(name): variable.attrs.get("units") for name, variable in data.variables.items()}
    assert units == {
        "velocity": "m s-1",
        "impacts": "1",
        "edges": None,
        "restitution_edge": "1",
        "probability_below": "1",
    }
    assert all(variable.attrs["long_name"] for variable in data.variables.values())
    assert data.attrs == {"source": "here", "beyond": "raise"}


def test_a_table_is_read_back(conditional: xr.Dataset) -> None:
    """Of all impacts, and by condition."""
    _store.check(conditional)
    whole, given = _store.table(conditional), _store.table(conditional, "given_")
    assert whole.speeds.tolist() == given.speeds.tolist() == [0.1, 0.3]
    assert (whole.first.tolist(), whole.start.tolist()) == ([0, 1, 2], [0, 3, 7])
    assert (given.first.tolist(), given.start.tolist()) == ([0, 2, 3], [0, 2, 5, 7])
    assert (whole.conditions.tolist(), given.conditions.tolist()) == ([0.0, 0.0], [0.0, 0.5, 0.2])
    assert whole.edges.tolist() == [*EDGES[0], *EDGES[1]]
    assert whole.cumulative.tolist() == [*BELOW[0], *BELOW[1]]
    assert {part.dtype for part in (whole.first, whole.start, given.first)} == {np.dtype(np.int64)}
    assert float(whole.value("cdf", np.array(0.5), np.array(0.1))) == 0.25


NO_TABLE = r"^data: the speeds, {0}edges, {0}restitution_edge and {0}probability_below are not those of a dis"


@pytest.mark.parametrize(
    ("harm", "told"),
    [
        (lambda data: data.drop_vars("velocity"), "^data lacks velocity: must be the Dataset of a Fluct"),
        (
            lambda data: data.drop_vars(["edges", "restitution_edge"]),
            "^data lacks edges, restitution_edge: must be the Dataset of a FluctuatingRestitution$",
        ),
        (
            lambda data: data.drop_vars("given_lowest"),
            "^data lacks given_lowest: must be the Dataset of a FluctuatingRestitution$",
        ),
        (lambda data: data.drop_vars("given"), "^data lacks given: must be"),
        (
            lambda data: data.drop_vars("given_probability_below"),
            "^data lacks given_probability_below: must be",
        ),
        (
            lambda data: data.drop_attrs(deep=False),
            "^data lacks the attributes source, beyond of a FluctuatingRestitution$",
        ),
        (lambda data: data.assign(velocity=data.velocity * np.nan), r"^data.velocity\[0\] = nan: must be"),
        (
            lambda data: data.assign(given_restitution_edge=data.given_restitution_edge * np.inf),
            r"^data.given_restitution_edge\[0\] = nan: must be finite numbers, as a Fluct",
        ),
        (lambda data: data.assign(velocity=-data.velocity), NO_TABLE.format("")),
        (lambda data: data.assign(edges=data.edges + 1), NO_TABLE.format("")),
        (lambda data: data.assign(given_edges=data.given_edges + 1), NO_TABLE.format("given_")),
        (lambda data: data.assign(probability_below=-data.probability_below), NO_TABLE.format("")),
    ],
)
def test_what_is_no_distribution_is_refused(harm: Any, told: str, conditional: xr.Dataset) -> None:
    """With the name of what is missing or wrong."""
    with pytest.raises(ValueError, match=told):
        _store.check(harm(conditional))


@pytest.mark.parametrize(
    ("name", "unit", "wanted"),
    [
        ("velocity", "km/h", "m s-1"),
        ("impacts", "m", "1"),
        ("edges", "m", "1"),
        ("restitution_edge", "m", "1"),
        ("given_probability_below", "m", "1"),
    ],
)
def test_other_units_are_refused(name: str, unit: str, wanted: str, conditional: xr.Dataset) -> None:
    """Whatever the Dataset has, the number of impacts as well, which no table needs."""
    with pytest.raises(ValueError, match=rf"^data\.{name} .*{unit}.*{wanted}"):
        _store.check(conditional.assign({name: conditional[name].assign_attrs(units=unit)}))
    _store.check(conditional.drop_vars("impacts"))


@pytest.mark.parametrize("name", ["edges", "restitution_edge", "given_probability_below"])
def test_a_table_is_not_of_two_dimensions(name: str, conditional: xr.Dataset) -> None:
    values = conditional[name].values
    with pytest.raises(ParameterError, match=rf"^data\.{name} = .*: must be finite numbers"):
        _store.check(conditional.drop_vars(name).assign({name: (("one", "other"), values[None])}))


@pytest.mark.parametrize("thing", [None, 3, "file.nc", {}])
def test_what_is_no_dataset_is_refused(thing: Any) -> None:
    shown = re.escape(repr(thing))
    with pytest.raises(ParameterError, match=rf"^data = {shown}: must be the Dataset of a FluctuatingRest"):
        _store.check(thing)


def test_a_seal_is_put_on_and_taken_off(conditional: xr.Dataset) -> None:
    sealed = _store.sealed(conditional)
    assert set(sealed.attrs) - set(conditional.attrs) == {"format_version", "checksum"}
    assert sealed.attrs["format_version"] == 1
    assert len(sealed.attrs["checksum"]) == 32
    assert _store.unsealed(sealed, "d.nc").identical(conditional)


@pytest.mark.parametrize(
    "harm",
    [
        lambda data: data.assign(edges=data.edges.astype(np.int32)),
        lambda data: data.assign(velocity=data.velocity * (1 + 2**-52)),
        lambda data: data.rename(node="knot"),
        lambda data: data.rename(impacts="numbers"),
        lambda data: data.drop_vars("impacts"),
        lambda data: data.assign(impacts=data.impacts.assign_attrs(units="m")),
        lambda data: data.assign(impacts=data.impacts.assign_attrs(unit="1")),
        lambda data: data.assign_attrs(source="there"),
        lambda data: data.assign_attrs(sources="here"),
        lambda data: data.assign(probability_below=data.probability_below[::-1]),
        lambda data: data.assign(new=("node", [1.0, 2.0])),
    ],
)
def test_a_change_of_anything_breaks_the_seal(harm: Any, conditional: xr.Dataset) -> None:
    """Of a number, its type, a name, a dimension or an attribute."""
    with pytest.raises(ParameterError, match=r"^d\.nc: is damaged: its checksum does not match its content$"):
        _store.unsealed(harm(_store.sealed(conditional)), "d.nc")


def test_a_checksum_is_of_the_content_and_not_of_its_order(conditional: xr.Dataset) -> None:
    """A file may give variables and attributes in another order, and numbers as arrays of one."""
    sealed = _store.sealed(conditional.assign_attrs(number=3.0))
    turned = sealed[sorted(map(str, sealed.data_vars), reverse=True)]
    turned.attrs = dict(reversed(sealed.attrs.items())) | {"number": np.array([3.0])}
    assert _store.unsealed(turned, "d.nc")["velocity"].identical(conditional["velocity"])


def test_the_checksum_of_a_file_of_before(data: xr.Dataset) -> None:
    """Format 1: BLAKE2b of 16 bytes over the variables in the order of their names, then the attributes."""
    digest = hashlib.blake2b(digest_size=16)
    for name in sorted(map(str, data.variables)):
        values = data[name].to_numpy()
        digest.update(repr((name, data[name].dims, values.dtype.str, values.shape)).encode())
        digest.update(values.tobytes())
        digest.update(repr([(key, [text]) for key, text in sorted(data[name].attrs.items())]).encode())
    digest.update(b"[('beyond', ['raise']), ('source', ['here'])]")
    assert _store.sealed(data).attrs["checksum"] == digest.hexdigest()
