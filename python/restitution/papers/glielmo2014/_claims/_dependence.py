"""Claims on the dependence of successive impacts at low speed (Sec. III)."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from restitution.papers.glielmo2014._claims._claim import SIGNIFICANT, Claim, Measurement, listed, verdict
from restitution.papers.glielmo2014._claims._estimate import Array, Impacts, in_windows
from restitution.papers.glielmo2014._claims._trend import falling
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

SLOW_BINS = 12


def judge(runs: Runs, settings: Settings) -> list[Claim]:
    """Judge the claims of Sec. III on successive impacts."""
    return [_independent(runs, settings), _sphere_to_sphere(runs, settings)]


def followed(impacts: Impacts, data: xr.Dataset) -> Impacts:
    """Those impacts of a run that have a next one with a finite ε."""
    e = data["restitution"].to_numpy()
    follows = np.zeros(e.shape, dtype=np.bool_)
    follows[:, :-1] = np.isfinite(e[:, 1:])
    return impacts.only(follows[impacts.where] & np.isfinite(e[impacts.where]))


def following(impacts: Impacts, values: NDArray[np.generic]) -> Array:
    """Values at the impacts that follow."""
    particle, impact = impacts.where
    return Impacts((particle, impact + 1), impacts.cell, impacts.cells, impacts.particles).of(values)


def _changes(impacts: Impacts, runs: Runs) -> Array:
    """1.0 where the next impact is on the other sphere, else 0.0."""
    contact = runs.main["contact"].to_numpy()
    return np.not_equal(impacts.of(contact), following(impacts, contact)).astype(np.float64)


def _independent(runs: Runs, settings: Settings) -> Claim:
    impacts = followed(in_windows(runs.main["impact_velocity"], settings.speed_windows), runs.main)
    labels = [f"{v:g} m/s" for v in settings.speeds]
    tilt = np.abs(np.cos(runs.main["angle"].to_numpy()))
    e = runs.main["restitution"].to_numpy()
    change = impacts.means(_changes(impacts, runs))
    orientation = impacts.correlations(impacts.of(tilt), following(impacts, tilt))
    restitution = impacts.correlations(impacts.of(e), following(impacts, e))
    scores = np.array([change.beyond(0.5), orientation.beyond(0), restitution.beyond(0)])
    dependent = np.max(np.abs(scores), axis=0) > SIGNIFICANT
    named = [label for label, yes in zip(labels, dependent, strict=True) if yes]
    return Claim(
        key="independence",
        quote="For such small velocities, the angular orientations of the particle at times of successive "
        "impact are not statistically independent",
        where="Sec. III, Fig. 4 (0.1 m/s)",
        measured=(
            *listed("correlation of |cos θ| at successive impacts", labels, orientation),
            *listed("correlation of ε at successive impacts", labels, restitution),
            *listed("share on the other sphere next time", labels, change),
        ),
        verdict=verdict(bool(dependent[0] and not dependent[1:].any()), bool(dependent[0])),
        rule="Impacts are dependent at a speed if a correlation differs from 0, or the share on the other "
        f"sphere from ½, by more than {SIGNIFICANT:g} standard errors. Holds if they are so at {labels[0]} "
        f"and at none of the higher speeds; in part if at {labels[0]} and another; fails if not at "
        f"{labels[0]}.",
        why=f"Successive impacts are dependent at {', '.join(named) or 'no speed'}.",
    )


def _sphere_to_sphere(runs: Runs, settings: Settings) -> Claim:
    bins = falling(runs.main, 1e-3, SLOW_BINS)
    impacts = followed(bins.impacts, runs.main)
    change = impacts.means(_changes(impacts, runs))
    low = settings.speed_windows[0][1]
    slow = np.flatnonzero(bins.speeds < low)
    shown = change.take(list(slow))
    above = shown.beyond(0.5) > SIGNIFICANT
    scale = settings.lowest_speed**2 / (2 * settings.gravity * settings.radius)
    return Claim(
        key="sphere-to-sphere",
        quote="the height of the jumps is much smaller than R such that numerical experiments show that the "
        "particle jumps from one sphere of the dumbbell to the other",
        where="Sec. III",
        measured=(
            *listed("share on the other sphere next time", [bins.labels[k] for k in slow], shown),
            Measurement("height of a jump v²/2g", scale, unit="R", at=f"{settings.lowest_speed:g} m/s"),
        ),
        verdict=verdict(bool(above.size and above.all()), bool(above.any())),
        rule=f"Bins of impact velocity up to {low:.3g} m/s. Holds if the share of impacts followed by one on "
        f"the other sphere is above ½ by more than {SIGNIFICANT:g} standard errors in each; in part if in "
        "some; fails otherwise.",
        why="The particle comes down on the other sphere more often than not."
        if above.size and above.all()
        else "The slower the impact, the more often the next one is on the same sphere: "
        f"{100 * (1 - shown.value[-1]):.3g} % at {bins.labels[slow[-1]]}. The body makes many small "
        "jumps on one sphere, then on the other.",
    )
