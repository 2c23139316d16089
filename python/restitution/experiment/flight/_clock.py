"""Coefficients that times of flight would give for a simulated run."""

import math

import numpy as np
import xarray as xr

from restitution._internal.arrays import check_each
from restitution._internal.parameters import ParameterError, wrong
from restitution.drop.recorded import RECORDS, check_successive, pull, variables


def clock(data: xr.Dataset) -> xr.Dataset:
    """Add to a simulated run what an experimenter gets from its times alone.

    The centre of mass of a non-spherical body is at a height h_i at impact i that depends on its angle.
    Over a flight that lasts Δt, h_{i+1} - h_i = v' Δt - g Δt²/2: the clock's g Δt/2 misses the rebound
    velocity by -(h_{i+1} - h_i)/Δt and the next impact velocity by +(h_{i+1} - h_i)/Δt.

    Parameters
    ----------
    data : Dataset
        A run as `restitution.simulate` returns it.

    Returns
    -------
    xarray.Dataset
        The same with ``clock_velocity``, g Δt/2 in m/s, which stands for the impact velocity, and
        ``clock_restitution``, the ratio of the times of flight after and before the impact. Both are NaN at
        the first impact, the second also at the last.

    Raises
    ------
    ValueError
        If the Dataset is not a run, or its impacts do not follow one another, as the coordinate ``impact``
        says.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    >>> heard = rs.flight.clock(rs.simulate(body, law, particles=100, impacts=10))
    >>> difference = (heard.clock_restitution - heard.restitution).std()
    >>> 1e-4 < float(difference) < 1e-2
    True
    """
    # Of one particle, as isel(particle=0) gives it, there is no dimension of particles.
    shape = RECORDS if not isinstance(data, xr.Dataset) or "particle" in data.dims else RECORDS[1:]
    time, _ = variables(
        "data", data, "restitution.simulate", dict.fromkeys(("time", "rebound_velocity"), shape)
    )
    check_successive("data", data)
    gravity, incline = pull("data", data)
    check_each("data.time", time, ~np.isinf(time), "finite times, NaN for none")
    flight = np.diff(time, axis=-1)
    check_each("data.time", time[..., 1:], ~(flight < 0.0), "not before the impact before it")
    velocity = np.full(time.shape, np.nan)
    with np.errstate(over="ignore"):
        velocity[..., 1:] = 0.5 * gravity * math.cos(incline) * flight
    if np.isinf(velocity).any():
        raise ParameterError(wrong("data.gravity", gravity, "such that speeds after the flights are finite"))
    ratio = np.full(time.shape, np.nan)
    # Two spheres that touch at once are two impacts with no flight between.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio[..., 1:-1] = flight[..., 1:] / flight[..., :-1]
    ratio[~np.isfinite(ratio)] = np.nan
    return data.assign(
        clock_velocity=(
            shape,
            velocity,
            {"long_name": "impact velocity from the time of flight", "units": "m s-1", "symbol": "g Δt/2"},
        ),
        clock_restitution=(
            shape,
            ratio,
            {"long_name": "coefficient of restitution from the times of flight", "units": "1"},
        ),
    )
