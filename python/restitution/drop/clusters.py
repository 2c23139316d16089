"""Impacts at one instant, as of a box that lands flat, where the order decides."""

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray
from restitution.drop.dataset import labelled
from restitution.drop.energy import share, tell
from restitution.drop.recorded import RECORDS, check_filled, check_successive, pull, records

_INSTANT, _FAST = 1e-9, 0.01
"""Of the time v/g, within which two impacts are at one instant; of the speed of the first impact, above which
they count. Slower ones are those of a body that comes to rest."""


class ClusterWarning(UserWarning):
    """Several parts of a body struck the plane at one instant; what follows depends on their order.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> flat = {"particles": 1, "impacts": 8, "orientation": [(1.0, 0.0, 0.0, 0.0)]}
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     data = rs.simulate(rs.Box(a=2e-2, b=1e-2, c=1e-2), rs.Frictionless(normal=0.5), **flat)
    >>> caught[0].category is rs.ClusterWarning
    True
    """


def _joined(
    time: FloatArray, impact_velocity: FloatArray, rebound_velocity: FloatArray, gravity: float
) -> npt.NDArray[np.bool_]:
    """Say of each impact whether it is at the instant of the one before."""
    joined = np.zeros(time.shape, np.bool_)
    speed = np.maximum(np.abs(impact_velocity), np.abs(rebound_velocity))
    near = gravity * np.diff(time, axis=1) < _INSTANT * speed[:, 1:]
    joined[:, 1:] = near & (speed[:, :-1] > _FAST * np.abs(impact_velocity[:, :1]))
    return joined


def warn(data: xr.Dataset, *, stacklevel: int = 2) -> None:
    """Warn once of impacts at one instant; `stacklevel` is that of `warnings.warn`."""
    names = ("time", "impact_velocity", "rebound_velocity")
    time, fall, rise = (data[name].to_numpy() for name in names)
    joined = _joined(time, fall, rise, data.attrs["gravity"])
    if joined.any():
        particle, impact = np.argwhere(joined)[0]
        tell(
            ClusterWarning,
            "several parts of a body struck the plane at one instant",
            share(int(np.count_nonzero(joined.any(axis=1))), len(joined), "particles"),
            f"first at impact {impact - 1} of particle {particle}: one follows the other in an order that "
            "the model does not decide, and restitution is that of each by itself. clusters(data) gives that "
            "of all impacts of an instant; a release tilted by 1e-6 rad has an order of its own",
            stacklevel=stacklevel + 1,
        )


def clusters(data: xr.Dataset) -> xr.Dataset:
    """Find impacts at one instant, and the coefficient of restitution of each such cluster as a whole.

    A box that lands flat strikes with four corners at one instant. The engine takes one after the other,
    those that approach the plane, until none does; the order is up to rounding, and the result depends on it
    (docs/shapes.md). Two impacts are at one instant if less than 1e-9 v/g is between them, v being the speed
    of the centre of mass; those slower than a hundredth of the first impact do not count.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts from `restitution.simulate`.

    Returns
    -------
    xarray.Dataset
        Over ``particle`` and ``impact``: ``cluster``, the number of the first impact at the instant of this
        one, its own if it is alone; ``impacts``, how many there are at this instant; and ``restitution``, ε
        of the cluster, the rebound velocity after its last impact over the impact velocity of its first.
        NaN, and 0 impacts, where there was no impact, and at all but the first impact of a cluster.

    Raises
    ------
    ValueError
        If the data are no recorded impacts, from the first one on.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", rs.ClusterWarning)
    ...     data = rs.simulate(
    ...         rs.Box(a=2e-2, b=1e-2, c=1e-2), rs.Frictionless(normal=0.5), particles=1, impacts=8,
    ...         orientation=[(1.0, 0.0, 0.0, 0.0)])
    >>> found = rs.clusters(data)
    >>> found.cluster.values.tolist()
    [[0, 0, 0, 0, 0, 0, 6, 7]]
    """
    time, fall, rise = records("data", data, "time", "impact_velocity", "rebound_velocity")
    check_filled("data", time)
    check_successive("data", data, start=0)
    joined = _joined(time, fall, rise, pull("data", data)[0])
    number = np.broadcast_to(np.arange(time.shape[1]), time.shape)
    first = np.maximum.accumulate(np.where(joined, 0, number), axis=1)
    happened = np.isfinite(time)
    impacts = np.zeros(time.shape, np.int64)
    rows = np.broadcast_to(np.arange(len(time))[:, None], time.shape)
    np.add.at(impacts, (rows[happened], first[happened]), 1)
    last = np.minimum(number + np.maximum(impacts, 1) - 1, time.shape[1] - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        whole = np.where(impacts > 0, np.take_along_axis(rise, last, axis=1) / fall, np.nan)
    about = {
        "cluster": (RECORDS, first, "number of the first impact at the instant of this one", None),
        "impacts": (RECORDS, impacts, "impacts at this instant, at the first of them", None),
        "restitution": (RECORDS, whole, "coefficient of restitution of all impacts at this instant", "1"),
    }
    coordinates = {name: data[name] for name in RECORDS if name in data.coords}
    return xr.Dataset(labelled(about), coordinates, data.attrs)
