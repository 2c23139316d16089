"""The Dataset that a learned distribution is kept in: ragged tables, their errors, what they came from."""

from collections.abc import Mapping
from hashlib import blake2b
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import check_each, reals
from restitution._internal.parameters import ParameterError, Problem
from restitution.distribution._check import Check
from restitution.distribution._count import Counted
from restitution.distribution._table import Floats, Histogram, Table, starts
from restitution.drop.recorded import check_has, check_variables

_WHOLE = "the Dataset of a FluctuatingRestitution"
_TABLE = ("edges", "restitution_edge", "probability_below")
GIVEN = {
    "rotational_fraction": "E_rot/E_tot before the impact (Eq. 12)",
    "previous": "probability of a smaller restitution at the impact before, at its own impact velocity",
}


def assemble(
    counted: Counted,
    conditional: Counted | None,
    given: str | None,
    check: Check,
    attrs: dict[str, Any],
    gaps: Floats,
) -> xr.Dataset:
    """Lay a distribution out as a Dataset.

    Components follow each other in ragged arrays, as the CF conventions have them: ``edges`` gives how many
    each has. ``velocity`` (node) are the speeds of the histograms, ``restitution_edge`` and
    ``probability_below`` (edge) the histograms themselves. ``probability_error`` (edge) is the standard
    error of the probability of the bin that starts there, ``probability_below_error`` that of the one below,
    ``mean_error``, ``std_error``, ``skewness_error`` and ``kurtosis_error`` (node) those of the moments.
    ``gap_lowest`` and ``gap_highest`` (gap), where there are any, are speeds between which no impact was
    seen. With a condition
    the tables and their errors again with the prefix ``given_``, for each of the ``given_components`` of a
    node at its ``given``, and the ``given_lowest`` and ``given_highest`` condition that a node has seen.
    ``ks_distance``, ``ks_scatter`` and ``fresh_impacts`` (interval) are how far a fresh ensemble is from this
    distribution between two nodes, and how far its own scatter alone takes it.
    """
    data = of_histograms(counted.nodes, counted.histograms, counted.impacts, attrs)
    data = data.assign(_errors(counted, "", "node"))
    if conditional is not None and given is not None:
        sizes = [group.size for group in conditional.conditions]
        about = {"long_name": GIVEN[given], "units": "1"}
        data["given_components"] = ("node", sizes, {"long_name": "conditions of the node"})
        data["given"] = ("given_component", np.concatenate(conditional.conditions), about)
        about = {"long_name": "impacts at the condition, each by its weight in the mixture", "units": "1"}
        data["given_impacts"] = ("given_component", conditional.impacts, about)
        data = data.assign(_ragged(conditional.histograms, "given_")).assign(
            _errors(conditional, "given_", "given_component")
        )
        # A level of probability is met everywhere in [0, 1], however few impacts there were.
        everywhere = np.tile([[0.0], [1.0]], counted.nodes.size)
        seen = conditional.seen if given == "rotational_fraction" else everywhere
        for name, values in zip(("lowest", "highest"), seen, strict=True):
            text = f"{name} condition that was seen at the node"
            data[f"given_{name}"] = ("node", values, {"long_name": text, "units": "1"})
        data.attrs["given"] = given
    for name, values in zip(("lowest", "highest"), gaps.T, strict=True):
        if values.size:
            text = f"{name} of the speeds at which no impact was seen"
            data[f"gap_{name}"] = ("gap", values, {"long_name": text, "units": "m s-1"})
    text = "Kolmogorov–Smirnov distance of fresh impacts between two nodes, upper bound"
    data["ks_distance"] = ("interval", check.distances(), {"long_name": text})
    text = "part of ks_distance that the scatter of the fresh particles makes, by bootstrap"
    data["ks_scatter"] = ("interval", check.scatter(), {"long_name": text})
    data["fresh_impacts"] = ("interval", check.impacts(), {"long_name": "impacts behind ks_distance"})
    return data


def _errors(counted: Counted, prefix: str, component: str) -> dict[str, Any]:
    about = "standard error of {}; a batch of particles is a draw"
    edge = f"{prefix}edge"
    shares = np.concatenate([np.append(share, np.nan) for share in counted.share_errors])
    found = {
        "probability_error": (edge, shares, "the probability of the bin above the edge"),
        "probability_below_error": (edge, np.concatenate(counted.below_errors), "probability_below"),
        "mean_error": (component, counted.mean_errors, "the mean"),
        "std_error": (component, counted.std_errors, "the standard deviation"),
        "skewness_error": (component, counted.shape_errors[:, 0], "the skewness"),
        "kurtosis_error": (component, counted.shape_errors[:, 1], "the kurtosis"),
    }
    return {
        f"{prefix}{name}": (dimension, values, {"long_name": about.format(text), "units": "1"})
        for name, (dimension, values, text) in found.items()
    }


def of_histograms(
    nodes: Floats, histograms: list[Histogram], impacts: Floats, attrs: dict[str, Any]
) -> xr.Dataset:
    """Lay out the variables that every learned distribution has."""
    speed = {"long_name": "impact velocity", "units": "m s-1"}
    number = {"long_name": "impacts at the node, each by its weight in the mixture", "units": "1"}
    return xr.Dataset(
        {"velocity": ("node", nodes, speed), "impacts": ("node", impacts, number), **_ragged(histograms, "")},
        attrs={**attrs, "beyond": "raise"},
    )


def _ragged(histograms: list[Histogram], prefix: str) -> dict[str, Any]:
    edge, component = f"{prefix}edge", f"{prefix}component" if prefix else "node"
    sizes = np.array([part.edges.size for part in histograms], dtype=np.int64)
    edges = np.concatenate([part.edges for part in histograms])
    below = np.concatenate([part.cumulative for part in histograms])
    about_sizes = {"long_name": "edges of the histogram", "sample_dimension": edge}
    about_edges = {"long_name": "edges of the bins of restitution (Eq. 1)", "units": "1"}
    about_below = {"long_name": "probability below the edge", "units": "1"}
    return {
        f"{prefix}edges": (component, sizes, about_sizes),
        f"{prefix}restitution_edge": (edge, edges, about_edges),
        f"{prefix}probability_below": (edge, below, about_below),
    }


def check(data: xr.Dataset) -> None:
    """Refuse what is not the Dataset of a distribution, or is damaged."""
    check_has("data", data, _WHOLE, ("velocity", *_TABLE))
    check_variables("data", data, "impacts")
    lacking = [name for name in ("source", "beyond") if name not in data.attrs]
    if lacking:
        raise ValueError(f"data lacks the attributes {', '.join(lacking)} of a FluctuatingRestitution")
    prefixes = [""]
    if "given" in data.attrs:
        names = [f"given_{name}" for name in ("components", "lowest", "highest", *_TABLE)]
        check_has("data", data, _WHOLE, ("given", *names))
        prefixes.append("given_")
    used = ("velocity", *(f"{prefix}{name}" for prefix in prefixes for name in _TABLE))
    for name in used:
        allowed = "finite numbers, as a FluctuatingRestitution has them"
        numbers = reals(f"data.{name}", data[name].to_numpy(), allowed, dimensions=(1,))
        if name in ("edges", "given_edges"):
            most = data[name.replace("edges", "restitution_edge")].size
            whole = (numbers >= 1) & (numbers <= most) & (numbers == np.rint(numbers))
            check_each(f"data.{name}", numbers, whole, "whole numbers of edges of the histograms")
    for prefix in prefixes:
        try:
            found = table(data, prefix)
            found.value("cdf", 0.0, found.speeds[0])
        except (ValueError, TypeError, IndexError) as error:
            allowed = f"the speeds, {prefix}edges, {prefix}restitution_edge and {prefix}probability_below"
            raise ValueError(f"data: {allowed} are not those of a distribution") from error


def table(data: xr.Dataset, prefix: str = "") -> Table:
    """Read a table back; ``"given_"`` is the prefix of the conditional one."""
    nodes = data["velocity"].to_numpy()
    groups, conditions = np.ones(nodes.size), np.zeros(nodes.size)
    if prefix:
        groups, conditions = data["given_components"].to_numpy(), data["given"].to_numpy()
    return Table(
        speeds=nodes,
        first=starts(groups),
        conditions=conditions,
        start=starts(data[f"{prefix}edges"].to_numpy()),
        edges=data[f"{prefix}restitution_edge"].to_numpy(),
        cumulative=data[f"{prefix}probability_below"].to_numpy(),
    )


def gaps(data: xr.Dataset) -> Floats:
    """Return the ends of the ranges of speed between which no impact was seen, in m/s; shape (gaps, 2)."""
    if "gap_lowest" not in data:
        return np.empty((0, 2))
    return np.stack([data[f"gap_{name}"].to_numpy() for name in ("lowest", "highest")], axis=1)


def in_gaps(data: xr.Dataset, v: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Mark the speeds near which no impact was seen."""
    speeds, ends = np.asarray(v)[..., None], gaps(data)
    return np.asarray(np.any((speeds >= ends[:, 0]) & (speeds < ends[:, 1]), axis=-1))


FORMAT = 1
"""Of the file; grows when a file of before cannot be read any more."""
_FORMAT, _CHECKSUM = "format_version", "checksum"


def sealed(data: xr.Dataset) -> xr.Dataset:
    """Add the format version, and a checksum by which a reader sees that no number has changed."""
    return data.assign_attrs({_FORMAT: FORMAT, _CHECKSUM: _checksum(data)})


def unsealed(data: xr.Dataset, path: str) -> xr.Dataset:
    """Check what `sealed` added, and take it off again.

    Raises
    ------
    ParameterError
        If it is not such a file, has another format, or is damaged.
    """
    attrs = dict(data.attrs)
    version, checksum = attrs.pop(_FORMAT, None), attrs.pop(_CHECKSUM, None)
    if version is None or checksum is None:
        lacks = ": lacks format version or checksum: must be a file that FluctuatingRestitution.save wrote"
        raise ParameterError(Problem(path, lacks))
    if version != FORMAT:
        text = f": is of format version {version}: must be {FORMAT}; save it again with this version"
        raise ParameterError(Problem(path, text))
    plain = data.drop_attrs(deep=False).assign_attrs(attrs)
    if checksum != _checksum(plain):
        raise ParameterError(Problem(path, ": is damaged: its checksum does not match its content"))
    return plain


def _checksum(data: xr.Dataset) -> str:
    """Hash names, dimensions, numbers and attributes, as they are after a journey through a file."""
    digest = blake2b(digest_size=16)
    for name, variable in sorted(data.variables.items(), key=lambda item: str(item[0])):
        values = np.ascontiguousarray(variable.to_numpy())
        about = (str(name), variable.dims, values.dtype.newbyteorder("=").str, values.shape)
        digest.update(repr(about).encode())
        digest.update(values.tobytes())
        digest.update(_plain(variable.attrs).encode())
    digest.update(_plain(data.attrs).encode())
    return digest.hexdigest()


def _plain(attrs: Mapping[Any, Any]) -> str:
    return repr([(str(name), np.atleast_1d(value).tolist()) for name, value in sorted(attrs.items())])
