"""Impacts in which the law let the plane pull."""

import warnings

import numpy as np
import xarray as xr

from restitution.drop.energy import percent

_ROUNDING = 1e-12
"""Of the greatest impact velocity of a particle: by less P_n may be wrong because of rounding."""
_ROWS = 1000


class PullWarning(UserWarning):
    """The plane pulled at the body in some impacts of a run, as the collision law demands.

    It does where the body leaves more slowly along the normal, or falls faster, than it would without any
    impulse: P_n/m is the sum of impact and rebound velocity.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    >>> law = rs.TangentialRestitution(normal=0.5, tangential=-0.5)
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     data = rs.simulate(body, law, particles=500, impacts=50, spin=(0.0, 30.0, 0.0))
    >>> caught[-1].category is rs.PullWarning
    True
    """


def counted(data: xr.Dataset) -> xr.Dataset:
    """Add the attribute ``pulling_impacts`` where there are any."""
    fall, rise = (data[name].to_numpy() for name in ("impact_velocity", "rebound_velocity"))
    pulls = 0
    for row in range(0, len(fall), _ROWS):
        a, b = fall[row : row + _ROWS], rise[row : row + _ROWS]
        fastest = np.fmax.reduce(np.abs(a), axis=1, initial=0.0, keepdims=True)
        pulls += int(np.count_nonzero(a + b < -_ROUNDING * fastest))
    return data.assign_attrs(pulling_impacts=pulls) if pulls else data


def warn(data: xr.Dataset, *, stacklevel: int = 2) -> None:
    """Warn once of the impacts that were counted; `stacklevel` is that of `warnings.warn`."""
    pulls, impacts = data.attrs.get("pulling_impacts", 0), data.attrs["all_impacts"]
    if pulls:
        warnings.warn(
            f"{data.attrs['law']} let the plane pull in {percent(pulls / impacts)} of the impacts "
            f"({pulls:,} of {impacts:,}), which no plane without adhesion can. The law does this: "
            "Frictionless and laws with a cone of friction, as Coulomb, cannot. "
            "CustomLaw(law, pull='stop' or 'clip') is another rule",
            PullWarning,
            stacklevel=stacklevel + 1,
        )
