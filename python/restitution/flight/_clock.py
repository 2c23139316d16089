"""What times of flight would give for a simulated run."""

import math

import numpy as np
import xarray as xr

from restitution._arrays import real, reals
from restitution._parameters import ParameterError, Problem, wrong
from restitution._recorded import first_impact_of
from restitution._units import check_variables


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
        If the Dataset is not a run.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    >>> heard = rs.flight.clock(rs.simulate(body, law, particles=100, impacts=10))
    >>> difference = (heard.clock_restitution - heard.restitution).std()
    >>> 1e-4 < float(difference) < 1e-2
    True
    """
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong("data", data, "a Dataset that simulate returned"))
    missing = [name for name in ("time", "rebound_velocity") if name not in data]
    if missing or "gravity" not in data.attrs or "impact" not in data.dims:
        raise ParameterError(Problem("data", ": not a run; must be a Dataset that simulate returned"))
    check_variables("data", data, "time")
    if set(data.time.dims) - {"particle"} != {"impact"}:
        raise ParameterError(Problem("data.time", ": must have the dimensions (particle, impact)"))
    first_impact_of("data", data)  # after which all others must be there
    data = data.transpose(..., "impact")
    positive = "a finite number > 0 (m/s^2)"
    pull = real("data.gravity", data.attrs["gravity"], positive, lambda g: g > 0.0)
    steep = "a finite number in (-pi/2, pi/2) (rad)"
    incline = real("data.incline", data.attrs.get("incline", 0.0), steep, lambda a: abs(a) < math.pi / 2)
    gravity = pull * math.cos(incline)
    times = reals("data.time", data.time.to_numpy(), "real numbers (s), NaN for none", finite=False)
    flight = np.diff(times, axis=-1)
    velocity = np.full(data.time.shape, np.nan)
    velocity[..., 1:] = 0.5 * gravity * flight
    ratio = np.full(data.time.shape, np.nan)
    # Two spheres that touch at once are two impacts with no flight between.
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio[..., 1:-1] = flight[..., 1:] / flight[..., :-1]
    ratio[~np.isfinite(ratio)] = np.nan
    return data.assign(
        clock_velocity=(
            data.time.dims,
            velocity,
            {"long_name": "impact velocity from the time of flight", "units": "m s-1", "symbol": "g Δt/2"},
        ),
        clock_restitution=(
            data.time.dims,
            ratio,
            {"long_name": "coefficient of restitution from the times of flight", "units": "1"},
        ),
    )
