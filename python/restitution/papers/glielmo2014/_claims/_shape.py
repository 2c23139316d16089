"""Claims on Fig. 4: the density of ε at given speed, and how successive impacts depend when slow."""

import numpy as np

from restitution.papers import shape
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import Array, Impacts, in_windows
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.shape import Shape, tests
from restitution.papers.trend import falling

CLAIMS: Claims[Runs, Settings] = Claims()
SLOW_BINS = 12


def _shapes(runs: Runs, settings: Settings) -> list[Shape]:
    """Return the shapes at the four speeds, slowest first."""
    return shape.shapes(runs, runs.main, settings, "goodness of fit")


@CLAIMS.add(
    "laplace",
    "a probability density composed of two exponential functions (asymmetric Laplace function)",
    "Sec. III, Fig. 4; Sec. V",
)
def laplace(runs: Runs, settings: Settings) -> Finding:
    shapes = _shapes(runs, settings)[1:]
    by_speed = "; ".join(
        f"at {one.label} it {one.verdict} (flanks exp(−|x|^k) with k = {one.exponent[0]:.3g}, in the tails "
        f"{100 * one.tails[0] ** 2:.0f} % of the impacts that the fit has there)"
        for one in shapes
    )
    return shape.laplace(shapes, f"{by_speed[0].upper()}{by_speed[1:]}.")


@CLAIMS.add("asymmetric", "(asymmetric Laplace function)", "Sec. III, Fig. 4")
def asymmetric(runs: Runs, settings: Settings) -> Finding:
    why = "The decay lengths above and below the cusp differ at {}."
    return shape.slopes(_shapes(runs, settings)[1:], "each speed above the lowest", why)


@CLAIMS.add(
    "not-laplace-when-slow",
    "For very small velocity, the probability density deviates from the Laplacian (data for v_G^n = 0.1 "
    "m/s in Fig. 4)",
    "Sec. III, Fig. 4",
)
def deviates(runs: Runs, settings: Settings) -> Finding:
    lowest, *others = shapes = _shapes(runs, settings)
    farthest = all(lowest.distance > one.distance for one in others)
    return Finding(
        measured=(
            *tests(lowest),
            *(Measurement("distance sup|F − F_fit|", one.distance, at=one.label) for one in shapes),
        ),
        verdict=verdict(lowest.rejected and farthest, lowest.rejected),
        rule=f"Holds if the asymmetric Laplace density is rejected at {lowest.label} (as above) and lies "
        "farther from the impacts there than at any other speed; in part if it is only rejected; fails "
        "otherwise.",
        why=f"At {lowest.label} the asymmetric Laplace density is "
        f"{'' if lowest.rejected else 'not '}rejected and is "
        f"{lowest.distance / max(one.distance for one in others):.2g} times as far from the impacts as at "
        "the worst of the other speeds.",
    )


def _changes(impacts: Impacts, runs: Runs) -> Array:
    """1.0 where the next impact is on the other sphere, else 0.0."""
    contact = runs.main["contact"].to_numpy()
    return np.not_equal(impacts.of(contact), impacts.following(contact)).astype(np.float64)


@CLAIMS.add(
    "independence",
    "For such small velocities, the angular orientations of the particle at times of successive impact are "
    "not statistically independent",
    "Sec. III, Fig. 4 (0.1 m/s)",
)
def independent(runs: Runs, settings: Settings) -> Finding:
    impacts = in_windows(runs.main["impact_velocity"], settings.speed_windows).followed(runs.main)
    tilt = np.abs(np.cos(runs.main["angle"].to_numpy()))
    e = runs.main["restitution"].to_numpy()
    change = impacts.means(_changes(impacts, runs))
    orientation = impacts.correlations(impacts.of(tilt), impacts.following(tilt))
    restitution = impacts.correlations(impacts.of(e), impacts.following(e))
    scores = np.array([change.beyond(0.5), orientation.beyond(0), restitution.beyond(0)])
    dependent = np.max(np.abs(scores), axis=0) > SIGNIFICANT
    slowest = settings.labels[0]
    named = [label for label, yes in zip(settings.labels, dependent, strict=True) if yes]
    return Finding(
        measured=(
            *listed("correlation of |cos θ| at successive impacts", settings.labels, orientation),
            *listed("correlation of ε at successive impacts", settings.labels, restitution),
            *listed("share on the other sphere next time", settings.labels, change),
        ),
        verdict=verdict(bool(dependent[0] and not dependent[1:].any()), bool(dependent[0])),
        rule="Impacts are dependent at a speed if a correlation differs from 0, or the share on the other "
        f"sphere from ½, by more than {SIGNIFICANT:g} standard errors. Holds if they are so at {slowest} and "
        f"at none of the higher speeds; in part if at {slowest} and another; fails if not at {slowest}.",
        why=f"Successive impacts are dependent at {', '.join(named) or 'no speed'}.",
    )


@CLAIMS.add(
    "sphere-to-sphere",
    "the height of the jumps is much smaller than R such that numerical experiments show that the particle "
    "jumps from one sphere of the dumbbell to the other",
    "Sec. III",
)
def sphere_to_sphere(runs: Runs, settings: Settings) -> Finding:
    at = in_windows(runs.main["impact_velocity"], settings.speed_windows[:1]).followed(runs.main)
    named = at.means(_changes(at, runs))
    bins = falling(runs.main, 1e-3, SLOW_BINS)
    impacts = bins.impacts.followed(runs.main)
    change = impacts.means(_changes(impacts, runs))
    slow = [int(k) for k in np.flatnonzero(bins.speeds < settings.speed_windows[0][0])]
    slower = change.take(slow)
    beyond = float(named.beyond(0.5)[0])
    always = beyond > SIGNIFICANT and bool(np.all(slower.beyond(0.5) > SIGNIFICANT))
    clear = min(float(np.min(one.value - SIGNIFICANT * one.error)) for one in (named, slower))
    highest = float(named.value[0] + SIGNIFICANT * named.error[0])
    scale = settings.lowest_speed**2 / (2 * settings.gravity * settings.radius)
    return Finding(
        measured=(
            *listed("share on the other sphere next time", settings.labels[:1], named),
            *listed("share on the other sphere next time", [bins.labels[k] for k in slow], slower),
            Measurement("height of a jump v²/2g", scale, unit="R", at=f"{settings.lowest_speed:g} m/s"),
        ),
        verdict=verdict(always, beyond > -SIGNIFICANT),
        rule=f"The paper speaks of {settings.labels[0]}. Holds if there, and in each bin of lower speed, the "
        f"share of impacts followed by one on the other sphere is above ½ by more than {SIGNIFICANT:g} "
        f"standard errors; in part if at {settings.labels[0]} it is not below ½ by as much; fails otherwise. "
        f"The half is ours: a share below {clear:.2g} in its place would make it hold, one above "
        f"{highest:.2g} fail.",
        why="The particle comes down on the other sphere more often than not."
        if always
        else f"At {settings.labels[0]} the next impact is on the other sphere in {100 * named.value[0]:.3g} "
        "% of the cases. The slower the impact, the more often it is on the same sphere: "
        f"{100 * (1 - slower.value[-1]):.3g} % at {bins.labels[slow[-1]]}. The body makes many small jumps "
        "on one sphere, then on the other.",
    )
