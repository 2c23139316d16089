"""The energy ledger: what the paper says of dissipation, and the impacts that create kinetic energy."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from restitution._internal.text import with_error
from restitution.papers.claims import Claims, Finding, Measurement, verdict
from restitution.papers.estimate import Array, in_bins
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

CLAIMS: Claims[Runs, Settings] = Claims()
GAIN = 1e-9
"""Relative gain of energy that counts. An energy ratio is rounded at 1e−15 or so; the share of impacts above
1e−12 is recorded beside, and where the two agree the threshold decides nothing."""

SELDOM = 0.01
"""Share of impacts that create energy below which a law that does not dissipate may be said to keep it."""


@dataclass(frozen=True)
class Gains:
    """Impacts of one run that create kinetic energy."""

    share: float  # with an energy ratio above 1 + `GAIN`
    error: float  # of it
    share_above_round_off: float  # above 1 + 1e−12
    largest: float  # energy ratio


def gains(data: xr.Dataset, low: float = -np.inf, high: float = np.inf) -> Gains:
    """Count energy-creating impacts with low ≤ impact velocity < high."""
    impacts = in_bins(data["impact_velocity"], np.array([low, high]))
    ratio = impacts.of(data["energy_ratio"])
    share = impacts.means((ratio > 1 + GAIN).astype(np.float64))
    return Gains(
        float(share.value[0]),
        float(share.error[0]),
        float(np.mean(ratio > 1 + 1e-12)),
        float(ratio.max()),
    )


def gains_by_elongation(runs: Runs) -> Mapping[float, Gains]:
    """Return the energy-creating impacts for each L/R of the energy runs."""
    return {elongation: gains(data) for elongation, data in runs.energy.items()}


def energies(data: xr.Dataset, gravity: float) -> Array:
    """Return the kinetic energy per mass before each impact in m²/s², shape (particle, impact), or NaN.

    At the first impact, from rest, it is v²/2. An impact multiplies it by the energy ratio, and the flight to
    the next one changes it by g times the drop of the centre of mass.
    """
    v, rebound, time, ratio = (
        data[name].to_numpy() for name in ("impact_velocity", "rebound_velocity", "time", "energy_ratio")
    )
    flight = np.diff(time, axis=1)
    rise = rebound[:, :-1] * flight - gravity * flight**2 / 2  # (5)
    energy = np.empty_like(v)
    energy[:, 0] = v[:, 0] ** 2 / 2
    for k in range(v.shape[1] - 1):
        energy[:, k + 1] = ratio[:, k] * energy[:, k] - gravity * rise[:, k]
    return energy


@CLAIMS.add("no-dissipation", "ε_t = 1 (no energy dissipation in tangential direction)", "Sec. III")
def no_dissipation(runs: Runs, settings: Settings) -> Finding:
    low, high = settings.velocity_range
    drawn = gains(runs.main, low, high)
    found = gains_by_elongation(runs)
    most = max(found.values(), key=lambda g: g.share)
    ledgers = {f"L/R = {settings.elongation:g}, range of Fig. 2": drawn}
    ledgers |= {f"L/R = {elongation:g}, all speeds": one for elongation, one in found.items()}
    measured = [
        measurement
        for at, one in ledgers.items()
        for measurement in (
            Measurement("share of impacts creating energy", one.share, one.error, at=at),
            Measurement("share above round-off", one.share_above_round_off, at=at),
            Measurement("largest relative gain", one.largest - 1, at=at),
        )
    ]
    none = most.share == 0
    return Finding(
        measured=tuple(measured),
        verdict=verdict(none, drawn.share < SELDOM),
        rule="The normal impulse takes energy in every impact, so where energy grows the tangential "
        f"impulse has done positive work. Holds if no impact multiplies the kinetic energy by more than "
        f"1 + {with_error(GAIN, None)}; in part if fewer than {100 * SELDOM:g} % do in the range of Fig. 2, "
        f"the paper's own; fails otherwise. The {100 * SELDOM:g} % are ours: in part from "
        f"{100 * drawn.share:.2g} % on.",
        why="No impact creates energy."
        if none
        else "Keeping the tangential contact velocity takes a tangential impulse, and that creates "
        f"kinetic energy in {100 * most.share:.3g} % of the impacts at the worst L/R, up to a factor "
        f"{max(g.largest for g in found.values()):.3g}.",
    )
