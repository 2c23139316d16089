"""Samples for a fit: from an array, binned counts, recorded impacts or statistics at an impact velocity."""

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from restitution._internal.arrays import pair, real
from restitution._internal.parameters import ParameterError, Problem, shown, wrong
from restitution.drop.bins import LARGEST
from restitution.drop.recorded import counted as recorded_counts
from restitution.drop.recorded import records
from restitution.fit._counts import Counts, of_bins
from restitution.fit._result import Array, finite_samples

Window: TypeAlias = float | tuple[float, float]
Samples: TypeAlias = ArrayLike | Counts | xr.Dataset
Parts: TypeAlias = Samples | Sequence[Counts] | Sequence[xr.Dataset]


def taken(samples: Samples, velocity: Window | None, location: float | None = None) -> Array | Counts:
    """Return the samples that a family fits: a flat array or counts.

    The arguments are those of `asymmetric_laplace`, and the location of a cusp that is given, as from `cusp`.
    Raises ValueError if `velocity` is missing, superfluous or outside the data, no impact is there, or the
    samples are not as they must be.
    """
    if isinstance(samples, xr.Dataset):
        if "restitution_count" in samples:
            return counted(samples, velocity)
        return finite_samples(recorded(samples, velocity)[0], location)
    no_window(samples, velocity)
    return samples if isinstance(samples, Counts) else finite_samples(samples, location)


def cusp(location: Any) -> float:
    """Take the location of a cusp that is given."""
    return real("location", location, "a finite number, at most 1e100 either way", lambda x: abs(x) <= 1e100)


def counted(statistics: xr.Dataset, velocity: Window | None) -> Counts:
    """Take the counts of a velocity bin, or of several together."""
    if velocity is None:
        raise ValueError("velocity: missing; statistics need a number or a window (low, high) in m/s")
    if "velocity_edges" not in statistics:
        raise ValueError("samples: statistics without velocity bins; give velocity_bins to `statistics`")
    statistics = recorded_counts("samples", statistics)
    if not isinstance(velocity, tuple | list) and np.ndim(velocity) == 0:
        return Counts.at(statistics, velocity)
    low, high = window(velocity)
    edges = statistics["velocity_edges"].to_numpy()
    first, last = (int(np.argmin(np.abs(edges - v))) for v in (low, high))
    allowed = 1e-6 * float(np.diff(edges).min())
    if first >= last or abs(edges[first] - low) > allowed or abs(edges[last] - high) > allowed:
        near = ", ".join(f"{v:g}" for v in edges[max(first - 1, 0) : last + 2][:6])
        raise ParameterError(wrong("velocity", velocity, f"edges of velocity bins, here {near}, …, in m/s"))
    return of_bins(statistics, slice(first, last))


def recorded(data: xr.Dataset, velocity: Window | None) -> tuple[Array, NDArray[np.int64]]:
    """Take restitutions in a velocity window, with the number of the particle of each.

    Those that are not finite or at least 2³³ in magnitude are left out, as in `restitution.reduce`.
    """
    speed, restitution = records("samples", data, "impact_velocity", "restitution")
    if velocity is None or not isinstance(velocity, tuple | list | np.ndarray):
        text = f" = {shown(velocity)}: recorded impacts need a window (low, high) in m/s"
        raise ParameterError(Problem("velocity", text))
    low, high = window(velocity)
    particle, impact = np.nonzero((speed >= low) & (speed < high) & (np.abs(restitution) < LARGEST))
    if particle.size == 0:
        raise ParameterError(wrong("velocity", velocity, "a window that holds an impact"))
    return restitution[particle, impact], particle


def no_window(samples: object, velocity: Window | None) -> None:
    """Refuse an impact velocity of samples that have none."""
    if velocity is not None:
        text = f" = {shown(velocity)}: is for a Dataset, and samples = {shown(samples)}: is none"
        raise ParameterError(Problem("velocity", text))


def window(velocity: Window) -> tuple[float, float]:
    """Check a window of impact velocity."""
    allowed = "a window (low, high) with low < high, in m/s"
    return pair("velocity", velocity, allowed, unit="m s-1")
