"""Rates of contacts and exchange in a gas, from encounters, of which few are held at a time."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import check_each, positive, reals, whole
from restitution._internal.resources import checked_threads
from restitution.bodies import AnyBody
from restitution.drop.dataset import made_here
from restitution.laws import CollisionLaw
from restitution.pair._encounters import COLLAPSE, LASTED, Pairs
from restitution.pair.partners import turned_axes


def rates(
    body: AnyBody,
    law: CollisionLaw,
    *,
    temperature_ratios: npt.ArrayLike = (0.5, 1.0, 2.0),
    translational_temperature: float = 1.0,
    encounters: int = 100_000,
    seed: int = 0,
    threads: int | None = None,
) -> xr.Dataset:
    """Rates of contacts and of exchange of energy in a gas of equal bodies, over T_rot/T_tr.

    Every encounter is followed, with all of its contacts; velocities and spins are Maxwellian before it, and
    attitudes uniform. Closures that take every contact as that of two strangers are `restitution.gas.theory`.

    Parameters
    ----------
    body : Dumbbell or another body that `encounters` takes
        Both bodies.
    law : Law or CustomLaw
        The collision law.
    temperature_ratios : array_like
        T_rot/T_tr, each >= 0.
    translational_temperature : float
        T_tr in J.
    encounters : int
        Number of encounters at each ratio, misses among them.
    seed, threads : int
        As those of `encounters`.

    Returns
    -------
    xarray.Dataset
        Over ``temperature_ratio``, at unit density, of a particle: ``contact_rate`` and ``encounter_rate``
        (encounters with contact) in m³/s; ``translational_exchange`` and ``rotational_exchange``, the changes
        of its energies, in W m³; ``translational_cooling`` and ``rotational_cooling``, the same as rates
        -(dE/dt)/E, in m³/s, NaN where E = 0; each with a standard error, ``..._error``. ``collapsed`` is the
        share of encounters that ended as a collapse, which are left out of the exchange and the contacts, and
        ``lasted`` that of those with a lasting contact, which is not counted as one.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=1e-3, separation=1e-3)
    >>> found = rs.pair.rates(
    ...     body, rs.Frictionless(normal=1.0), temperature_ratios=[2.0],
    ...     translational_temperature=1e-8, encounters=20_000,
    ... )
    >>> bool(found.rotational_exchange[0] < 0)
    True
    """
    ratios = reals("temperature_ratios", temperature_ratios, "numbers >= 0", dimensions=(1,))
    check_each("temperature_ratios", ratios, ratios >= 0.0, "numbers >= 0")
    count, number = whole("encounters", encounters, 2, 2**40), checked_threads(threads)
    temperature = positive("translational_temperature", translational_temperature, "J")
    rows = [_of(body, law, ratio, temperature, count, seed, number) for ratio in ratios.tolist()]
    variables = {}
    for name, (text, unit) in _FOUND.items():
        values = np.array([row[name] for row in rows])
        variables[name] = (("temperature_ratio",), values, {"long_name": text, "units": unit})
    attributes = {"long_name": "T_rot/T_tr", "units": "1"}
    about = {
        "body": str(body),
        "law": str(law),
        "translational_temperature": temperature,
        "encounters": count,
        "seed": seed,
    }
    return xr.Dataset(
        variables,
        {"temperature_ratio": ("temperature_ratio", ratios, attributes)},
        made_here("Rates of contacts and exchange in a gas, from encounters") | about,
    )


_RATES = {
    "contact_rate": ("rate of contacts of a particle at unit density", "m3 s-1"),
    "encounter_rate": ("rate of encounters with contact of a particle at unit density", "m3 s-1"),
    "translational_exchange": ("change of the translational energy of a particle at unit density", "W m3"),
    "rotational_exchange": ("change of the rotational energy of a particle at unit density", "W m3"),
    "translational_cooling": ("-(dE/dt)/E of the translation at unit density", "m3 s-1"),
    "rotational_cooling": ("-(dE/dt)/E of the rotation at unit density", "m3 s-1"),
}
_FOUND = {
    **_RATES,
    **{f"{name}_error": (f"standard error of the {text}", unit) for name, (text, unit) in _RATES.items()},
    "collapsed": ("share of encounters that end as a collapse", "1"),
    "lasted": ("share of encounters with a lasting contact", "1"),
}


def _of(
    body: AnyBody,
    law: CollisionLaw,
    ratio: float,
    temperature: float,
    count: int,
    seed: int,
    threads: int,
) -> dict[str, float]:
    """Follow the encounters of one ratio of temperatures, chunk by chunk."""
    warm = {"translational_temperature": temperature, "rotational_temperature": ratio * temperature}
    pairs = Pairs.of(body, body, law, encounters=count, seed=seed, **warm)
    sums, squares, collapsed, lasted, rate = np.zeros(4), np.zeros(4), 0, 0, 0.0
    for met, _, flux in pairs.in_chunks(threads):
        rate = flux
        good = met["ending"] != COLLAPSE
        collapsed += int(np.count_nonzero(~good))
        lasted += int(np.count_nonzero(met["ending"] == LASTED))
        number = met["contacts"][good]
        gained, turned = (
            (met[f"{kind}_energy_after"] - met[f"{kind}_energy_before"])[good].mean(axis=1)
            for kind in ("translational", "rotational")
        )
        each = np.stack([number, number > 0, gained, turned])
        sums += each.sum(axis=1)
        squares += (each**2).sum(axis=1)
    means = sums / count
    # The two bodies of a pair share what happens to them, so that an encounter is one sample.
    errors = rate * np.sqrt(np.maximum(squares / count - means**2, 0.0) / count)
    means *= rate
    freedom = np.array([3.0, sum(turned_axes(body, law))])
    energies = 0.5 * freedom * temperature * np.array([1.0, ratio])
    energies[energies == 0.0] = np.nan
    cooling, cooling_errors = -means[2:] / energies, errors[2:] / energies
    values = [*means, *cooling]
    found = dict(zip(_RATES, values, strict=True))
    found |= {f"{name}_error": value for name, value in zip(_RATES, [*errors, *cooling_errors], strict=True)}
    return found | {"collapsed": collapsed / count, "lasted": lasted / count}
