"""The Dataset that a learned distribution is kept in: ragged tables, their errors, what they came from."""

from typing import Any

import numpy as np
import xarray as xr

from restitution._parameters import ParameterError, wrong
from restitution.distribution._check import Check
from restitution.distribution._count import Counter
from restitution.distribution._table import Floats, Histogram, Table

_TABLE = ("edges", "restitution_edge", "probability_below")
GIVEN = {
    "rotational_fraction": "E_rot/E_tot before the impact (Eq. 12)",
    "previous": "probability of a smaller restitution at the impact before, at its own impact velocity",
}


def assemble(
    counter: Counter, conditional: Counter | None, given: str | None, check: Check, attrs: dict[str, Any]
) -> xr.Dataset:
    """Lay a distribution out as a Dataset.

    Components follow each other in ragged arrays, as the CF conventions have them: ``edges`` tells how many
    each has. ``velocity`` (node) are the speeds of the histograms, ``restitution_edge`` and
    ``probability_below`` (edge) the histograms themselves. ``probability_error`` (edge) is the standard
    error of the probability of the bin that starts there, ``probability_below_error`` that of the one below,
    ``mean_error`` and ``std_error`` (node) those of the moments. With a condition
    the tables again with the prefix ``given_``, for each of the ``given_components`` of a node at its
    ``given``. ``ks_distance``, ``ks_scatter`` and ``fresh_impacts`` (interval) are how far a fresh ensemble
    is from this distribution between two nodes, and how far its own scatter alone takes it.
    """
    parts = list(counter.histograms())
    data = of_histograms(counter.nodes, [part for part, _, _ in parts], counter.impacts(), attrs)
    for name, errors, text in (
        (
            "probability_error",
            [np.append(share, np.nan) for _, share, _ in parts],
            "the probability of the bin above the edge",
        ),
        ("probability_below_error", [below for _, _, below in parts], "probability_below"),
    ):
        about = {"long_name": f"standard error of {text}; a batch of particles is a draw", "units": "1"}
        data[name] = ("edge", np.concatenate(errors), about)
    for name, moment, moment_errors in zip(
        ("mean_error", "std_error"), ("mean", "standard deviation"), counter.moment_errors(), strict=True
    ):
        about = {"long_name": f"standard error of the {moment}; a batch of particles is a draw", "units": "1"}
        data[name] = ("node", moment_errors, about)
    if conditional is not None and given is not None:
        histograms = [part for part, _, _ in conditional.histograms()]
        sizes = [group.size for group in conditional.conditions]
        about = {"long_name": GIVEN[given], "units": "1"}
        data["given_components"] = ("node", sizes, {"long_name": "conditions of the node"})
        data["given"] = ("given_component", np.concatenate(conditional.conditions), about)
        data["given_impacts"] = ("given_component", conditional.impacts(), {"units": "1"})
        data = data.assign(_ragged(histograms, "given_"))
        data.attrs["given"] = given
    data["ks_distance"] = (
        "interval",
        check.distances(),
        {"long_name": "Kolmogorov–Smirnov distance of fresh impacts between two nodes, upper bound"},
    )
    data["ks_scatter"] = (
        "interval",
        check.scatter(),
        {"long_name": "part of ks_distance that the scatter of the fresh particles makes, by bootstrap"},
    )
    data["fresh_impacts"] = ("interval", check.impacts(), {"long_name": "impacts behind ks_distance"})
    return data


def of_histograms(
    nodes: Floats, histograms: list[Histogram], impacts: Floats, attrs: dict[str, Any]
) -> xr.Dataset:
    """Lay out what every learned distribution has."""
    speed = {"long_name": "impact velocity", "units": "m s-1"}
    number = {"long_name": "impacts at the node, each counted as the mixture weights it", "units": "1"}
    return xr.Dataset(
        {"velocity": ("node", nodes, speed), "impacts": ("node", impacts, number), **_ragged(histograms, "")},
        attrs={**attrs, "beyond": "raise"},
    )


def _ragged(histograms: list[Histogram], prefix: str) -> dict[str, Any]:
    edge = f"{prefix}edge"
    sizes = [part.edges.size for part in histograms]
    component = f"{prefix}component" if prefix else "node"
    return {
        f"{prefix}edges": (
            component,
            np.array(sizes, dtype=np.int64),
            {"long_name": "edges of the histogram", "sample_dimension": edge},
        ),
        f"{prefix}restitution_edge": (
            edge,
            np.concatenate([part.edges for part in histograms]),
            {"long_name": "edges of the bins of restitution (Eq. 1)", "units": "1"},
        ),
        f"{prefix}probability_below": (
            edge,
            np.concatenate([part.cumulative for part in histograms]),
            {"long_name": "probability below the edge", "units": "1"},
        ),
    }


def check(data: xr.Dataset) -> None:
    """Refuse what is not the Dataset of a distribution, or is one that came to harm."""
    require(data, "data", ("velocity", *_TABLE), "the Dataset of a FluctuatingRestitution")
    lacking = [name for name in ("source", "beyond") if name not in data.attrs]
    if lacking:
        raise ValueError(f"data lacks the attributes {', '.join(lacking)} of a FluctuatingRestitution")
    prefixes = [""]
    if "given" in data.attrs:
        names = ("given", "given_components", *(f"given_{name}" for name in _TABLE))
        require(data, "data", names, "the Dataset of a FluctuatingRestitution")
        prefixes.append("given_")
    for prefix in prefixes:
        try:
            found = table(data, prefix)
            found.value("cdf", 0.0, found.speeds[0])
        except (ValueError, TypeError, IndexError) as error:
            allowed = f"the speeds, {prefix}edges, {prefix}restitution_edge and {prefix}probability_below"
            raise ValueError(f"data: {allowed} are not those of a distribution") from error


def require(data: xr.Dataset, name: str, needed: tuple[str, ...], instead: str) -> None:
    """Refuse what is no Dataset, or lacks something."""
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong(name, data, instead))
    lacking = [variable for variable in needed if variable not in data]
    if lacking:
        raise ValueError(f"{name} lacks {', '.join(lacking)}: give {instead}")


def table(data: xr.Dataset, prefix: str = "") -> Table:
    """Read a table back; ``"given_"`` is the prefix of the conditional one."""
    start = np.concatenate([[0], np.cumsum(data[f"{prefix}edges"].to_numpy())]).astype(np.int64)
    nodes = data["velocity"].to_numpy()
    if prefix:
        groups, conditions = data["given_components"].to_numpy(), data["given"].to_numpy()
    else:
        groups, conditions = np.ones(nodes.size, dtype=np.int64), np.zeros(nodes.size)
    return Table(
        speeds=nodes,
        first=np.concatenate([[0], np.cumsum(groups)]).astype(np.int64),
        conditions=conditions,
        start=start,
        edges=data[f"{prefix}restitution_edge"].to_numpy(),
        cumulative=data[f"{prefix}probability_below"].to_numpy(),
    )
