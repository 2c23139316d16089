"""The ledger of every run: impacts that created energy or let the plane pull, and warnings of them."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from decimal import Decimal
from typing import Any

import numpy as np
import xarray as xr

from restitution import _core
from restitution._internal.arrays import FloatArray, IntArray


class EnergyWarning(UserWarning):
    """Impacts of a run left with more kinetic energy than they had, as the collision law demands.

    An impact counts where it multiplies the kinetic energy by more than 1 + 1e-12: rounding makes some 1e-15.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-3)
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     data = rs.simulate(body, rs.TangentialRestitution(normal=0.98), particles=20, impacts=50)
    >>> caught[0].category is rs.EnergyWarning
    True
    >>> 0.0 < data.attrs["energy_created_share"] < 1.0
    True
    """


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


def _harmless() -> Iterator[str]:
    """Name the laws that cannot create energy, with the values of a parameter for which they cannot."""
    for law in _core.LAWS:
        match law["creates_energy"]:
            case False:
                yield law["name"]
            case (parameter, value):
                (names,) = (about["names"] for about in law["parameters"] if about["name"] == parameter)
                others = " or ".join(repr(name) for name in names if name != value)
                yield f"{law['name']} with {parameter} {others}"


WHY = (
    "The law does this, not rounding: gains below 1e-12 are not counted. Laws that cannot: "
    f"{'; '.join(_harmless())}."
)
NO_PULL = (
    "which no plane without adhesion can. The law does this: Frictionless and laws with a cone of friction, "
    "as Coulomb, cannot. CustomLaw(law, pull='stop' or 'clip') is another rule"
)
LEDGER = (
    "all_impacts",
    "energy_created_impacts",
    "energy_created_share",
    "largest_energy_ratio",
    "pulling_impacts",
)
"""The attributes that say how much energy impacts created, and in how many the plane pulled."""
PULLING = "impacts in which the law let the plane pull"
_ROWS = 1000


def ledger(impacts: int, created: int, largest: float, pulls: int) -> dict[str, Any]:
    """Return the attributes that say how many impacts created energy, their share, and the largest factor.

    The factor has no meaning, and is left out, where no impact created energy; so is the number of impacts
    that pull where there are none.
    """
    found: dict[str, Any] = {
        "all_impacts": impacts,
        "energy_created_impacts": created,
        "energy_created_share": created / max(impacts, 1),
    }
    found |= {"largest_energy_ratio": largest} if created else {}
    return found | ({"pulling_impacts": pulls} if pulls else {})


def ledger_of(
    impact_velocity: FloatArray, restitution: FloatArray, energy_ratio: FloatArray
) -> dict[str, Any]:
    """`ledger` of recorded impacts, NaN where there was none."""
    impacts = energy_ratio.size - int(np.count_nonzero(np.isnan(energy_ratio)))
    created = int(np.count_nonzero(energy_ratio > _core.CREATES_ENERGY))
    pulls = 0
    for row in range(0, len(restitution), _ROWS):
        fall = impact_velocity[row : row + _ROWS]
        with np.errstate(invalid="ignore", over="ignore"):
            rise = fall * restitution[row : row + _ROWS]
            pulls += int(np.count_nonzero(fall + rise < -_core.PULLS * (np.abs(fall) + np.abs(rise))))
    return ledger(impacts, created, float(np.fmax.reduce(energy_ratio, axis=None, initial=np.nan)), pulls)


def by_row(row: str, created: IntArray, largest: FloatArray) -> dict[str, Any]:
    """Return for each row the impacts that created energy and their largest ratio, NaN for none."""
    text = "impacts that multiplied the kinetic energy by more than 1 + 1e-12"
    highest = "largest factor by which an impact multiplied the kinetic energy, where any created energy"
    factors = np.where(created > 0, largest, np.nan)
    return {
        "energy_created": (row, created, {"long_name": text}),
        "largest_energy_ratio": (row, factors, {"long_name": highest, "units": "1"}),
    }


def warn(data: xr.Dataset, *, stacklevel: int = 2) -> None:
    """Warn once if the run behind `data` created energy, and once if it let the plane pull."""
    about = data.attrs
    law, impacts = about["law"], about["all_impacts"]
    for category, did, number, more in told(about.get("largest_energy_ratio", 1.0)):
        where = share(about.get(number, 0), impacts, "impacts")
        tell(category, f"{law} {did}", where, more, stacklevel=stacklevel + 1)


def told(largest: float) -> Iterator[tuple[type[Warning], str, str, str]]:
    """Yield each warning: its kind, what the law did, the attribute that counts such impacts, and why."""
    gains = f"at most by a factor of {factor(largest)}. {WHY}"
    yield EnergyWarning, "created kinetic energy", "energy_created_impacts", gains
    yield PullWarning, "let the plane pull", "pulling_impacts", NO_PULL


def share(number: int, of: int, what: str) -> str:
    """Write how many of all there are; nothing if there are none."""
    return f"in {percent(number / of)} of the {what} ({number:,} of {of:,})" if number else ""


def tell(category: type[Warning], did: str, where: str, more: str, *, stacklevel: int = 2) -> None:
    """Warn of what happened, unless it happened nowhere; `stacklevel` is that of `warnings.warn`."""
    if where:
        warnings.warn(f"{did} {where}, {more}", category, stacklevel=stacklevel + 1)


def percent(share: float) -> str:
    """Write a share in percent with three digits, however small."""
    text = f"{100 * share:.3g}"
    return f"{Decimal(text):f} %" if share > 1e-8 else f"{text} %"


def factor(largest: float) -> str:
    """Write a factor above 1 so that it does not read as 1."""
    return f"{largest:.6g}" if largest >= 1.001 else f"1 + {largest - 1:.2g}"


@contextmanager
def reported_elsewhere() -> Iterator[None]:
    """Silence what `warn` says for code that reports it itself; also a decorator."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", EnergyWarning)
        warnings.simplefilter("ignore", PullWarning)
        yield
