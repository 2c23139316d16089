"""Impact velocities and coefficients of restitution from the times of impacts, measured or simulated."""

from __future__ import annotations

import math
from importlib.metadata import version

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import check_each, flag
from restitution._internal.parameters import ParameterError, wrong
from restitution.drop.recorded import RECORDS, check_successive, pull, variables
from restitution.experiment.flight.chain import chain, measured
from restitution.experiment.flight.contact import ContactTime, contact_of
from restitution.experiment.flight.drag import Drag
from restitution.experiment.flight.setting import QUARTZ, Once, attributes
from restitution.experiment.flight.times import checked


def restitution(
    times: npt.ArrayLike | xr.Dataset,
    uncertainty: npt.ArrayLike | None = None,
    *,
    gravity: float = 9.81,
    gravity_uncertainty: float | None = None,
    clock_uncertainty: float = QUARTZ,
    drop_height: float | None = None,
    drop_height_uncertainty: float = 0.0,
    drag: Drag | None = None,
    contact_time: ContactTime | float | None = None,
    doubtful: bool = False,
) -> xr.Dataset:
    """Return impact velocity and coefficient of restitution of each impact of a ball, from their times.

    Between the impacts i and i + 1 the ball flies for Δt_i = t_{i+1} - t_i. A flight that ends at the height
    where it began has g Δt_i/2 at both ends, so that impact i + 1 comes with v_{i+1} = g Δt_i/2 and

        ε_i = Δt_i/Δt_{i-1}.

    One time enters two flights and three coefficients: the errors of neighbours are correlated, and the
    covariance that is returned holds that, with the errors of g, the clock, the drop and the drag, which are
    common to all.

    Parameters
    ----------
    times : array_like, shape (n,), or Dataset
        Times of all impacts of one series in s, increasing, 2 to 3000 of them; NaN for an impact that was
        missed. Or a Dataset with ``time`` and ``uncertainty``, as `restitution.sound.impacts` and
        `restitution.flight.read` return it: what is flagged as missed or doubtful counts as NaN, what is
        flagged as doubled is left out.
    uncertainty : float or array_like, shape (n,), optional
        Standard error of the times in s, >= 0; independent of one another.
    gravity, gravity_uncertainty : float
        g and its standard error, in m/s²; left out 3e-3 of g, which covers the surface of the Earth, 9.78 to
        9.83. Buoyancy makes g smaller by the factor 1 - ρ_air/ρ.
    clock_uncertainty : float
        Standard error of the clock over what it shows, in [0, 1): that of the quartz of telephones and sound
        cards unless another is given. It cancels in quotients of times and enters speeds as that of g.
    drop_height, drop_height_uncertainty : float, optional
        How far the ball fell from rest to the first impact, in m: then the first impact has a velocity and a
        coefficient, too.
    drag : Drag, optional
        Air drag. Both speeds of a flight then differ from g Δt/2, and from one another.
    contact_time : ContactTime or float, optional
        How long ball and plate touch at 1 m/s, in s, with its standard error: the interval between two sounds
        is a contact, which lasts as v^(-1/5), and a flight. Left out it is neglected.
    doubtful : bool
        Whether times that a Dataset flags as doubtful count; they are NaN if not.

    Returns
    -------
    xarray.Dataset
        Dimension ``impact`` of size n, numbered from 0, the first impact after the drop: where rows are taken
        out, these numbers say which. ``time``, ``uncertainty``, ``impact_velocity`` and its standard error
        ``impact_velocity_error`` in m/s, ``restitution`` and ``restitution_error``; with the further
        dimension ``other_impact`` ``impact_velocity_covariance``, ``restitution_covariance`` and
        ``cross_covariance``, of the velocity at ``impact`` and the coefficient at ``other_impact``. NaN
        where the times do not determine them: the last coefficient, the first two numbers without a drop
        height, and next to a missed impact. The attributes hold all parameters.

    Raises
    ------
    ValueError
        If the times do not increase, or a value is out of range; the message names it.

    Notes
    -----
    For a non-spherical body g Δt/2 is not the velocity of the centre of mass, which has not the same
    height at all impacts; `restitution.flight.clock` shows by how much.

    Errors are propagated to first order, so they must be small beside the intervals.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.flight.restitution([0.0, 0.400, 0.780, 1.141], 1e-4)
    >>> data.restitution.values.round(4).tolist()
    [nan, 0.95, 0.95, nan]
    >>> data.restitution_error.values[1:3].round(5).tolist()
    [0.0006, 0.00063]
    """
    instants, errors = checked(times, uncertainty, doubtful=flag("doubtful", doubtful))
    once = Once(
        gravity=gravity,
        gravity_uncertainty=gravity_uncertainty,
        clock_uncertainty=clock_uncertainty,
        drop_height=drop_height,
        drop_height_uncertainty=drop_height_uncertainty,
    )
    if drag is not None and not isinstance(drag, Drag):
        raise ParameterError(wrong("drag", drag, "a Drag, or None"))
    contact = contact_of(contact_time)
    links = chain(measured(instants, errors, once, drag, contact))
    ratio = links.after / links.before
    with np.errstate(invalid="ignore"):
        ratio_by = (links.after_by - ratio[:, None] * links.before_by) / links.before[:, None]
    ratio_by[np.isnan(ratio)] = 0.0

    def covariance(a: Array, b: Array, known_a: Array, known_b: Array) -> Array:
        product = (a * links.variances) @ b.T
        product[np.isnan(known_a)] = np.nan
        product[:, np.isnan(known_b)] = np.nan
        return product

    of_velocity = covariance(links.before_by, links.before_by, links.before, links.before)
    of_ratio = covariance(ratio_by, ratio_by, ratio, ratio)
    crossed = covariance(links.before_by, ratio_by, links.before, ratio)
    velocity_error, ratio_error = np.sqrt(np.diag(of_velocity)), np.sqrt(np.diag(of_ratio))
    velocity = "normal velocity of the centre of mass towards the plane, before the impact"
    crossing = "covariance of the velocity at impact and the coefficient at other_impact"
    numbers = np.arange(instants.size)
    no_drop = {"drop_height", "drop_height_uncertainty"} if once.drop_height is None else set()
    return xr.Dataset(
        {
            "time": _told(instants, "s", long_name="time of the impact"),
            "uncertainty": _told(errors, "s", long_name="standard error of the time"),
            "impact_velocity": _told(links.before, "m s-1", long_name=velocity, symbol="v"),
            "impact_velocity_error": _told(
                velocity_error, "m s-1", long_name="standard error of the impact velocity"
            ),
            "restitution": _told(ratio, "1", long_name="coefficient of restitution", symbol="ε"),
            "restitution_error": _told(
                ratio_error, "1", long_name="standard error of the coefficient of restitution"
            ),
            "impact_velocity_covariance": _told(of_velocity, "m2 s-2"),
            "restitution_covariance": _told(of_ratio, "1"),
            "cross_covariance": _told(crossed, "m s-1", long_name=crossing),
        },
        {
            "impact": ("impact", numbers, {"long_name": "number of the impact, from 0"}),
            "other_impact": ("other_impact", numbers, {"long_name": "number of another impact, from 0"}),
        },
        attrs={
            "title": "Impact velocities and coefficients of restitution from times of impacts",
            "source": f"restitution {version('restitution')}",
            **once.model_dump(exclude=no_drop),
            "gravity_uncertainty": once.gravity_error,
            **attributes(drag, contact),
        },
    )


def _told(values: Array, units: str, **words: str) -> tuple[tuple[str, ...], Array, dict[str, str]]:
    """Make a variable over impacts, or over pairs of them."""
    return ("impact", "other_impact")[: values.ndim], values, {"units": units} | words


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
    of_velocity = {
        "long_name": "impact velocity from the time of flight",
        "units": "m s-1",
        "symbol": "g Δt/2",
    }
    of_ratio = {"long_name": "coefficient of restitution from the times of flight", "units": "1"}
    return data.assign(
        clock_velocity=(shape, velocity, of_velocity), clock_restitution=(shape, ratio, of_ratio)
    )
