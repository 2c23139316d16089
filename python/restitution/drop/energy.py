"""The energy ledger of every run: which impacts created kinetic energy, and a warning where any did."""

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
LEDGER = ("all_impacts", "energy_created_impacts", "energy_created_share", "largest_energy_ratio")
"""The attributes of a result that say how much energy its impacts created."""


def ledger(impacts: int, created: int, largest: float) -> dict[str, Any]:
    """Return the attributes that say how many impacts created energy, their share, and the largest factor.

    The factor has no meaning, and is left out, where no impact created energy.
    """
    found: dict[str, Any] = {
        "all_impacts": impacts,
        "energy_created_impacts": created,
        "energy_created_share": created / max(impacts, 1),
    }
    return found | ({"largest_energy_ratio": largest} if created else {})


def ledger_of(energy_ratio: FloatArray) -> dict[str, Any]:
    """`ledger` of recorded energy ratios, NaN where there was no impact."""
    impacts = energy_ratio.size - int(np.count_nonzero(np.isnan(energy_ratio)))
    created = int(np.count_nonzero(energy_ratio > _core.CREATES_ENERGY))
    return ledger(impacts, created, float(np.fmax.reduce(energy_ratio, axis=None, initial=np.nan)))


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
    """Warn once if the run behind `data` created energy; `stacklevel` is that of `warnings.warn`."""
    about = data.attrs
    created = about["energy_created_impacts"]
    if not created:
        return
    warnings.warn(
        f"{about['law']} created kinetic energy in {percent(about['energy_created_share'])} of the impacts "
        f"({created:,} of {about['all_impacts']:,}), at most by a factor of "
        f"{factor(about['largest_energy_ratio'])}. {WHY}",
        EnergyWarning,
        stacklevel=stacklevel + 1,
    )


def percent(share: float) -> str:
    """Write a share in percent with three digits, however small."""
    text = f"{100 * share:.3g}"
    return f"{Decimal(text):f} %" if share > 1e-8 else f"{text} %"


def factor(largest: float) -> str:
    """Write a factor above 1 so that it does not read as 1."""
    return f"{largest:.6g}" if largest >= 1.001 else f"1 + {largest - 1:.2g}"


@contextmanager
def reported_elsewhere() -> Iterator[None]:
    """Silence `EnergyWarning` for code that reports the created energy itself; also a decorator."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", EnergyWarning)
        yield
