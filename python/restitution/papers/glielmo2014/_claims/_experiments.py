"""Claims on bouncing-ball experiments: the effect of the shape and all other errors (Secs. I, III and V)."""

import math
from functools import cache
from itertools import pairwise, product

import numpy as np
import xarray as xr

from restitution.bodies import Body, ball_grade, from_roundness
from restitution.experiment.budget import error_budget
from restitution.laws import Frictionless, TangentialRestitution
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import in_windows
from restitution.papers.glielmo2014._claims._scatter import by_elongation
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

CLAIMS: Claims[Runs, Settings] = Claims()
TIMING, GRAVITY_ERROR, DROP_ERROR, TILT, SPIN = 10e-6, 0.01, 1e-3, 2e-3, 2.0
"""A careful experiment with a microphone: 10 µs, 0.01 m/s², 1 mm, 2 mrad, 2 rad/s at release."""
DROP, COEFFICIENTS, NORMAL = 0.1, 20, 0.95
STEEL, GLASS = 7800.0, 2500.0


FEWEST = 100
"""Impacts from which a standard deviation is compared: it is known to 7 % then."""


def _balls(settings: Settings) -> dict[str, Body]:
    """Make balls that experiments use, of a diameter and an out-of-roundness in m."""
    balls = {
        f"steel, grade {grade}": from_roundness(6e-3, ball_grade(grade), density=STEEL)
        for grade in (10, 100, 200, 1000)
    }
    for x in settings.bead_elongations:  # L is 2t, so that t/D is a quarter of L/R
        balls[f"glass, L/R = {x:g}"] = from_roundness(6e-3, 0.25 * x * 6e-3, density=GLASS)
    return balls | {"marble, t = 0.1 mm": from_roundness(16e-3, 0.1e-3, density=GLASS)}


@cache
def _shares(settings: Settings) -> dict[str, tuple[float, float]]:
    """Return the eccentricity's share of the variance of a late ε and of the fitted ε_n, by ball and law.

    The effects of spin and of a tilted plate are attributed to the eccentricity: a sphere has none.
    """
    found = {}
    laws = {
        "paper's law": TangentialRestitution(normal=NORMAL, tangential=settings.tangential),
        "frictionless": Frictionless(normal=NORMAL),
    }
    for (ball, body), (name, law) in product(_balls(settings).items(), laws.items()):
        data = error_budget(
            body,
            law,
            drop=DROP,
            impacts=COEFFICIENTS,
            timing=TIMING,
            gravity=settings.gravity,
            gravity_uncertainty=GRAVITY_ERROR,
            drop_uncertainty=DROP_ERROR,
            tilt=TILT,
            spin=SPIN,
        ).data
        found[f"{ball}, {name}"] = (
            _share(data.standard_deviation.isel(impact=-1)),
            _share(data.parameter_standard_deviation.isel(parameter=0)),
        )
    return found


def _share(deviation: xr.DataArray) -> float:
    by_shape = deviation.sel(source=["shape", "spin", "tilt"])
    return float((by_shape**2).sum() / deviation.sel(source="total") ** 2)


_EXPERIMENT = (
    f"The experiment: a drop of {DROP:g} m, ε_n = {NORMAL:g}, {COEFFICIENTS} coefficients, times to "
    f"{1e6 * TIMING:g} µs, g to {GRAVITY_ERROR:g} m/s², the drop to {1e3 * DROP_ERROR:g} mm, the plate "
    f"level to {1e3 * TILT:g} mrad, a spin of {SPIN:g} rad/s at release; air drag is corrected for, C_d "
    "known to a tenth. The effects of spin and tilt are attributed to the eccentricity: a "
    "sphere has none. "
)


@CLAIMS.add(
    "considerable-variance",
    "the angular orientation at the instant of the collision whose variance is considerable, even for "
    "small eccentricity […] even for rather small eccentricity, the coefficient of restitution reveals "
    "significant fluctuations",
    "Abstract; Sec. V",
)
def considerable(runs: Runs, settings: Settings) -> Finding:
    lost = 1.0 - settings.normal
    sigma = by_elongation(runs, settings)
    beyond = {f"{x:g}": one.beyond(lost) > SIGNIFICANT for x, one in sigma.items()}
    some = [x for x, one in beyond.items() if one.any()]
    above = [x for x, one in beyond.items() if one.all()]
    named, everywhere = ("L/R = " + ", ".join(those) if those else "no L/R" for those in (some, above))
    clear = np.concatenate([one.value - SIGNIFICANT * one.error for one in sigma.values()])
    return Finding(
        measured=tuple(
            item for x in sigma for item in listed(f"σ(ε), L/R = {x:g}", settings.labels, sigma[x])
        ),
        verdict=verdict(len(above) == len(sigma), bool(some)),
        rule=f"Considerable means more than 1 − ε_n = {lost:.2g}, the loss due to the material. Holds if "
        f"σ(ε) is larger, by more than {SIGNIFICANT:g} standard errors, at each of the four speeds for every "
        "L/R of Figs. 2 and 6; in part if at some speed for some L/R; fails otherwise. The threshold is "
        f"ours: one below {np.nanmin(clear):.2g} would make it hold, one above {np.nanmax(clear):.2g} fail.",
        why=f"σ(ε) exceeds {lost:.2g} at some of the four speeds for {named}, at all of them for "
        f"{everywhere}.",
    )


@CLAIMS.add(
    "rotation-explains-scatter",
    "The substantial increase of the data scattering with the decrease of impact velocity is attributed to "
    "the growing role of the rotational degrees of freedom in the energy partition",
    "Sec. V",
)
def reservoir(runs: Runs, settings: Settings) -> Finding:
    """Compare σ(ε) at a given share of rotation between speeds."""
    data = runs.main
    windows = in_windows(data["impact_velocity"], settings.speed_windows[1:])
    fraction = windows.of(data["rotational_fraction"])
    edges = np.array([0.005, 0.01, 0.02, 0.04, 0.08])
    band, bands = np.searchsorted(edges, fraction, side="right") - 1, edges.size - 1
    cells = windows.regrouped(windows.cell * bands + band, windows.cells * bands)
    cells = cells.only((band >= 0) & (band < bands))
    sigma = cells.deviations(cells.of(data["restitution"]))
    alone = windows.deviations(windows.of(data["restitution"]))
    ratio = float(alone.value[0] / alone.value[-1])
    known = [sigma.value[k::bands][sigma.number[k::bands] >= FEWEST] for k in range(bands)]
    factors = [float(one.max() / one.min()) for one in known if one.size > 1]
    within, compared = max(factors, default=1.0), bool(factors)
    explained = 1.0 - math.log(within) / math.log(max(ratio, 1.0 + 1e-9))
    names = [
        f"{v:g} m/s, E_rot/E_tot from {a:g} to {b:g}" for v in settings.speeds[1:] for a, b in pairwise(edges)
    ]
    return Finding(
        measured=(
            *listed("σ(ε)", names, sigma),
            Measurement("σ(ε) at the lowest over that at the highest of these speeds", ratio),
            Measurement("the same at a given E_rot/E_tot, at most", within),
        ),
        verdict=verdict(compared and explained > 0.8, compared and explained > 0.5),
        rule="If it is the share of rotation that counts, σ(ε) at a given E_rot/E_tot must not depend on the "
        "speed. Speeds above the lowest of the four, bands of E_rot/E_tot; standard deviations of "
        f"{FEWEST} impacts or more. Holds if more than 80 % of the logarithm of the increase disappears "
        "within each band; in part if more than half; fails otherwise, and where no band has two speeds.",
        why=f"Between these speeds σ(ε) changes by a factor {ratio:.3g}; at a given share of rotation by "
        f"{within:.3g} at most.",
    )


@CLAIMS.add(
    "regime-not-relevant",
    "We believe that for most bouncing-ball experiments reported in the literature, this regime is not "
    "relevant",
    "Sec. III",
)
def regime(runs: Runs, settings: Settings) -> Finding:
    """Test whether beads' successive orientations are independent at the speeds of experiments."""
    found = {}
    measured: list[Measurement] = []
    for elongation, data in runs.beads.items():
        impacts = in_windows(data["impact_velocity"], settings.speed_windows).followed(data)
        tilt = np.abs(np.cos(data["angle"].to_numpy()))
        one = impacts.correlations(impacts.of(tilt), impacts.following(tilt))
        found[elongation] = np.abs(one.beyond(0.0)) > SIGNIFICANT
        measured += listed(
            f"correlation of |cos θ| at successive impacts, L/R = {elongation:g}", settings.labels, one
        )
    slow = all(bool(one[0]) for one in found.values())
    fast = any(bool(one[1:].any()) for one in found.values())
    return Finding(
        measured=tuple(measured),
        verdict=verdict(not fast, slow and not all(bool(one.all()) for one in found.values())),
        rule="The regime is that of successive impacts that are not independent, found at 0.1 m/s for L/R = "
        f"{settings.elongation:g}. Holds if for the glass beads of Fig. 6 the correlation "
        f"of |cos θ| is within {SIGNIFICANT:g} standard errors of 0 at every speed above the lowest of the "
        "four; in part if at some; fails otherwise.",
        why="The rounder a bead, the less it turns from impact to impact, and the higher the speed up to "
        "which impacts are dependent: "
        + "; ".join(
            f"L/R = {x:g} at {', '.join(np.array(settings.labels)[one]) or 'no speed'}"
            for x, one in found.items()
        )
        + ".",
    )


@CLAIMS.add(
    "eccentricity-dominates",
    "for bouncing-ball experiments, the error originating from the eccentricity dominates the total error "
    "of the experiment and cannot be disregarded",
    "Sec. III, with ref. 20 (unpublished)",
)
def dominates(runs: Runs, settings: Settings) -> Finding:
    shares = _shares(settings)
    single = [name for name, (one, _) in shares.items() if one > 0.5]
    fitted = [name for name, (_, fit) in shares.items() if fit > 0.5]
    return Finding(
        measured=tuple(
            Measurement(f"share of the eccentricity in the variance of {what}", share, at=name)
            for name, both in shares.items()
            for what, share in zip(("ε at 0.5 m/s", "the fitted ε_n"), both, strict=True)
        ),
        verdict=verdict(len(single) == len(fitted) == len(shares), bool(single)),
        rule=f"{_EXPERIMENT}It dominates with more than half of the variance. Holds if it does for every "
        "ball and law, of one ε and of the fitted ε_n; in part if for some of one ε; fails otherwise.",
        why=f"In one ε it dominates for {'; '.join(single) or 'no ball'}; in the fitted ε_n for "
        f"{'; '.join(fitted) or 'none'}. A nearly round ball turns too slowly for its shape to show in "
        "times of flight.",
    )


@CLAIMS.add(
    "may-dominate",
    "the deviation of the shape of the particle from the perfect sphere is one of the largest sources of "
    "uncertainty and may even dominate the total error of the measurement",
    "Sec. V, with ref. 20 (unpublished)",
)
def may_dominate(runs: Runs, settings: Settings) -> Finding:
    shares = {name: one for name, (one, _) in _shares(settings).items()}
    beads = {name: share for name, share in shares.items() if name.startswith("glass")}
    most, least = max(beads.values()), min(beads.values())
    return Finding(
        measured=listed(
            "share of the eccentricity in the variance of ε at 0.5 m/s", beads, [*beads.values()]
        ),
        verdict=verdict(most > 0.5 and least > 0.1, most > 0.5),
        rule=f"{_EXPERIMENT}Of one ε of the average glass beads of Fig. 6: holds if it is more than half for "
        "one bead and law, and more than a tenth for each; in part if only the first; fails otherwise.",
        why=f"For glass beads the share is between {least:.2g} and {most:.2g}, depending on law and bead.",
    )
