"""Half-open bins, and the Dataset of statistics."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._core import LARGEST_RESTITUTION
from restitution._internal.arrays import FARTHEST, FloatArray, IntArray, pair, reals
from restitution._internal.parameters import ParameterError, Problem, shown, wrong

FRACTION_BINS: FloatArray = np.linspace(0.0, 1.0, 51)
FRACTION_BINS.flags.writeable = False

_MOST_BINS = 10_000_000
LARGEST = LARGEST_RESTITUTION
"""A restitution of this magnitude or more counts as undefined: its fourth power leaves the exact sums."""

_MOMENTS = {
    "mean_restitution": "mean of restitution",
    "variance": "variance of restitution, sum of squares over the number",
    "skewness": "skewness of restitution",
    "kurtosis": "kurtosis of restitution, Pearson's: 3 for a Gaussian",
    "minimum": "smallest restitution",
    "maximum": "largest restitution",
    "mean_fraction": "mean of E_rot/E_tot before the impact",
}


def _unit(name: str) -> str | None:
    """Return the unit of bins by their name; None of the edges of a lattice that is drawn."""
    if name in ("x_edges", "y_edges"):
        return None
    return "m s-1" if "velocity" in name else "1"


def increasing_edges(bins: npt.ArrayLike, name: str) -> FloatArray:
    """Take edges of bins: finite, strictly increasing, at least two."""
    allowed = "a 1-D array of at least two finite edges"
    edges = np.array(reals(name, bins, allowed, unit=_unit(name), finite=False))
    if edges.ndim != 1 or edges.size < 2:
        text = f" has shape {edges.shape}: needs one dimension and at least two edges"
        raise ParameterError(Problem(name, text))
    if not np.all(np.isfinite(edges)):
        raise ParameterError(Problem(name, f" holds {edges[~np.isfinite(edges)][0]}: edges must be finite"))
    with np.errstate(over="ignore"):
        widths = np.diff(edges)
    _check_bins(name, edges, widths > 0, "edges must increase strictly")
    if np.abs(edges).max() > FARTHEST:
        text = f" goes from {edges[0]} to {edges[-1]}: at most {FARTHEST:g} either way"
        raise ParameterError(Problem(name, text))
    _check_bins(name, edges, _wide_enough(widths), "bins must be so wide that 1/width is finite")
    return edges


def _check_bins(name: str, edges: FloatArray, good: npt.NDArray[np.bool_], allowed: str) -> None:
    """Name the edges of the first bin that is not good."""
    if not good.all():
        at = int(np.argmin(good))
        raise ParameterError(Problem(name, f" goes from {edges[at]} to {edges[at + 1]}: {allowed}"))


def _wide_enough(widths: FloatArray) -> npt.NDArray[np.bool_]:
    """Test whether the density of bins, by which a number finds its own, is finite."""
    with np.errstate(divide="ignore", over="ignore"):
        return np.isfinite(1.0 / widths)


def edges_from(bins: npt.ArrayLike | None, span: npt.ArrayLike | None, name: str) -> npt.ArrayLike | None:
    """Return the edges of a number of bins in a range, as `numpy.histogram` does; else `bins`."""
    kind = name.removesuffix("_bins")
    # To NumPy the type of a duration is one of whole numbers.
    if isinstance(bins, bool | np.timedelta64) or not isinstance(bins, int | np.integer):
        if span is not None:
            what = "is None" if bins is None else "are edges, not a number"
            raise ParameterError(wrong(f"{kind}_range", span, f"left out: {name} {what}"))
        return bins
    if span is None:
        raise ParameterError(
            Problem(f"{kind}_range", f": missing; {name} = {shown(bins)} needs a range (low, high)")
        )
    low, high = pair(f"{kind}_range", span, "(low, high) with low < high", unit=_unit(kind))
    if max(abs(low), abs(high)) > FARTHEST:
        raise ParameterError(wrong(f"{kind}_range", span, f"at most {FARTHEST:g} either way"))
    if not 1 <= bins <= _MOST_BINS:
        raise ParameterError(wrong(name, bins, f"edges, or a number of bins in [1, {_MOST_BINS}]"))
    edges = np.linspace(low, high, int(bins) + 1)
    if not _wide_enough(np.diff(edges)).all():
        allowed = f"so wide that 1/width of each of {bins} bins is finite"
        raise ParameterError(wrong(f"{kind}_range", span, allowed))
    return edges


def all_edges_from(**asked: tuple[npt.ArrayLike | None, npt.ArrayLike | None]) -> list[Any]:
    """Return `edges_from` for bins and ranges by the names of the bins; one error has all that is wrong."""
    found: list[Any] = []
    problems: list[Problem] = []
    for name, (bins, span) in asked.items():
        try:
            found.append(edges_from(bins, span, name))
        except ParameterError as error:
            problems.extend(error.problems)
    if problems:
        raise ParameterError(*problems)
    return found


def centres(edges: FloatArray) -> FloatArray:
    """Return the middle of each bin."""
    return 0.5 * (edges[:-1] + edges[1:])


def assemble(
    counts: dict[str, IntArray],
    number: IntArray,
    moments: dict[str, FloatArray],
    rows: xr.Variable,
    columns: dict[str, FloatArray],
    more: Mapping[str, Any],
) -> xr.Dataset:
    """Lay statistics out by row and bin, all at once: adding to a Dataset takes as long as making one.

    `counts` has ``restitution_count`` and perhaps ``fraction_count``, shape (rows, bins + 3): below the bins,
    the bins, above, undefined. `columns` has the edges of ``restitution`` and perhaps ``fraction``.
    """
    row = str(rows.dims[0])
    grid = counts["restitution_count"]
    site = {"long_name": "impacts in the site"}
    variables: dict[str, Any] = {"restitution_count": ((row, "restitution"), grid[:, 1:-2], site)}
    per_row: dict[str, tuple[npt.NDArray[Any], str]] = {
        "number": (number, "impacts whose restitution is defined"),
        "undefined": (grid[:, -1], "impacts whose restitution is not finite or at least 2**33 in magnitude"),
        "restitution_underflow": (grid[:, 0], "impacts below the restitution bins"),
        "restitution_overflow": (grid[:, -2], "impacts above the restitution bins"),
    }
    if "fraction_count" in counts:
        fractions = counts["fraction_count"]
        variables["fraction_count"] = ((row, "fraction"), fractions[:, 1:-2], site)
        per_row["fraction_underflow"] = (fractions[:, 0], "impacts below the fraction bins")
        per_row["fraction_overflow"] = (fractions[:, -2], "impacts above the fraction bins")
    per_row |= {name: (values, _MOMENTS[name]) for name, values in moments.items()}
    about = {"restitution": "restitution (Eq. 1)", "fraction": "E_rot/E_tot before the impact (Eq. 12)"}
    variables |= {name: ((row,), values, {"long_name": text}) for name, (values, text) in per_row.items()}
    coordinates: dict[str, Any] = {row: rows}
    for name, edges in columns.items():
        variables[f"{name}_edges"] = ((f"{name}_edge",), edges, {"units": "1"})
        coordinates[name] = ((name,), centres(edges), {"units": "1", "long_name": about[name]})
    return xr.Dataset(variables | dict(more), coordinates)


def by_velocity(
    counts: dict[str, IntArray],
    number: IntArray,
    moments: dict[str, FloatArray],
    velocity_edges: FloatArray,
    columns: dict[str, FloatArray],
    more: Mapping[str, Any],
) -> xr.Dataset:
    """`assemble` for rows that are bins of impact velocity, with one row more below them and one above."""
    about = {"units": "m s-1", "long_name": "impact velocity"}
    outer = {
        name: (
            (),
            number[row] + counts["restitution_count"][row, -1],
            {"long_name": f"impacts {where} the velocity bins"},
        )
        for name, row, where in (("velocity_underflow", 0, "below"), ("velocity_overflow", -1, "above"))
    }
    edges = {"velocity_edges": ("velocity_edge", velocity_edges, {"units": "m s-1"})}
    return assemble(
        {name: grid[1:-1] for name, grid in counts.items()},
        number[1:-1],
        {name: values[1:-1] for name, values in moments.items()},
        xr.Variable("velocity", centres(velocity_edges), about),
        columns,
        outer | edges | dict(more),
    )
