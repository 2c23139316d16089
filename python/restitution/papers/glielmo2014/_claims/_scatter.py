"""Claims on the scatter of ε: above 1, at the first impact, at low speed, of round beads (Figs. 2, 6)."""

from itertools import pairwise

import numpy as np

from restitution._internal.text import with_error
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import Estimate, deviations, in_bins
from restitution.papers.glielmo2014._claims._energy import energies
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.trend import RISING_RULE, falling, grows, trend

CLAIMS: Claims[Runs, Settings] = Claims()
SPEED_BINS = 15
ROUND_OFF = 1e-12
"""ε at a first impact is a quotient of a few rounded numbers of order 1."""


def by_elongation(runs: Runs, settings: Settings) -> dict[float, Estimate]:
    """Return σ(ε) at the four speeds for each L/R of Figs. 2 and 6."""
    data = {**runs.beads, settings.elongation: runs.main}
    return {elongation: deviations(one, settings) for elongation, one in data.items()}


@CLAIMS.add("above-one", "the coefficient of restitution may exceed unity", "Sec. III, Fig. 2")
def above_one(runs: Runs, settings: Settings) -> Finding:
    impacts = in_bins(runs.main["impact_velocity"], np.array(settings.velocity_range))
    values = impacts.of(runs.main["restitution"])
    share = impacts.means((values > 1).astype(np.float64))
    value, error = float(share.value[0]), float(share.error[0])
    low, high = settings.velocity_range
    return Finding(
        measured=(
            Measurement("share of ε > 1", value, error, at=f"{low:g} to {high:g} m/s"),
            Measurement("largest ε there", float(values.max())),
        ),
        verdict=verdict(value > SIGNIFICANT * error and value > 0, value > 0),
        rule=f"Holds if the share of ε > 1 is above 0 by more than {SIGNIFICANT:g} standard errors; in part "
        "if there is any such impact; fails otherwise.",
        why=f"{100 * value:.3g} % of the impacts in the range of Fig. 2 have ε > 1.",
    )


@CLAIMS.add(
    "expense-of-rotation",
    "the postcollisional linear velocity perpendicular to the plane may be larger than the precollisional "
    "value, at the expense of rotation",
    "Sec. III, Fig. 2",
)
def expense_of_rotation(runs: Runs, settings: Settings) -> Finding:
    """Compare what rotation and sideways motion lose where ε > 1; no flight changes either."""
    data = runs.main
    total = energies(data, settings.gravity)
    rotation = total * data["rotational_fraction"].to_numpy()
    sideways = total - rotation - data["impact_velocity"].to_numpy() ** 2 / 2
    impacts = in_bins(data["impact_velocity"][:, :-1], np.array(settings.velocity_range))
    impacts = impacts.only((impacts.of(data["restitution"]) > 1) & np.isfinite(impacts.of(rotation[:, 1:])))
    turning, moving = (impacts.of(kind[:, :-1]) - impacts.of(kind[:, 1:]) for kind in (rotation, sideways))
    falls = impacts.means((turning > 0).astype(np.float64))
    value, error = float(falls.value[0]), float(falls.error[0])
    # The share is a quotient of two means, whose influence is linearised.
    lost = float(np.mean(turning + moving))
    part = float(np.mean(turning)) / lost
    part_error = float(impacts.means((turning - part * (turning + moving)) / lost).error[0])
    return Finding(
        measured=(
            Measurement("impacts with ε > 1 in the range of Fig. 2", float(falls.number[0])),
            Measurement("share of them in which E_rot falls", value, error),
            Measurement(
                "share of rotation in what rotation and sideways motion lose in them", part, part_error
            ),
            Measurement("J_xx/(J_xx + mR²)", settings.rolling),
        ),
        verdict=verdict(value == 1 and part > 0.5, value > 0.5),
        rule="Holds if the rotational energy falls in every impact with ε > 1 in the range of Fig. 2, and "
        "pays more than half of what rotation and sideways motion lose in them together; in part if it "
        "falls in more than half of them; fails otherwise. Both halves are our thresholds.",
        why="Rotational energy falls in "
        f"{'every impact' if value == 1 else f'{100 * value:.3g} % of the impacts'}"
        f" with ε > 1, and pays {100 * part:.3g} % of what is lost there; sideways motion pays the rest. A "
        "nearly round body that does not turn when it is released does not slip at its contacts under this "
        "law, so that sideways motion and rotation have energies in the ratio mR² : J_xx.",
    )


@CLAIMS.add(
    "first-impact",
    "at the first impact, the particle can only gain but not lose rotational energy […] thus, to a "
    "macroscopic (measured) coefficient of restitution ε < ε_n",
    "Sec. III",
)
def first_impact(runs: Runs, settings: Settings) -> Finding:
    cases = (
        ("uniform angle", runs.main, settings.normal),
        ("isotropic", runs.isotropic, settings.normal),
        ("L = 2R", runs.first, settings.first_normal),
    )
    excess = {name: data["restitution"].to_numpy()[:, 0] - normal for name, data, normal in cases}
    above = sum(int(np.count_nonzero(x > ROUND_OFF)) for x in excess.values())
    number = sum(x.size for x in excess.values())
    return Finding(
        measured=(
            *(Measurement("largest ε − ε_n", float(np.nanmax(x)), at=name) for name, x in excess.items()),
            Measurement("first impacts with ε > ε_n", float(above)),
            Measurement("first impacts looked at", float(number)),
        ),
        verdict=verdict(above == 0, above < number / 1000),
        rule=f"Holds if no particle has ε − ε_n > {with_error(ROUND_OFF, None)} (round-off) at its first "
        "impact; in part if fewer than one in a thousand have; fails otherwise.",
        why="No first impact exceeds ε_n; by Eq. 17 it is reached where the axis is along the normal."
        if above == 0
        else f"{above} of {number} first impacts exceed ε_n.",
    )


@CLAIMS.add(
    "scatter-grows",
    "an increasing uncertainty of the data (enhanced scatter) with decreasing impact velocity",
    "Sec. III, Fig. 2",
)
def scatter_grows(runs: Runs, settings: Settings) -> Finding:
    bins = falling(runs.main, 1e-3, SPEED_BINS)
    sigma = bins.impacts.deviations(bins.impacts.of(runs.main["restitution"]))
    ends = ", monotonically", ", but does not rise at every step"
    return grows(bins, ("σ(ε)", "σ(ε)"), sigma, 2, ends=ends)


@CLAIMS.add(
    "scatter-and-rotation",
    "the absolute of fluctuations, |ε − ε_n|, is intimately related to the amount of rotational energy of "
    "the particle",
    "Sec. III",
)
def scatter_and_rotation(runs: Runs, settings: Settings) -> Finding:
    inside = in_bins(runs.main["impact_velocity"], np.array(settings.velocity_range))
    fraction = inside.of(runs.main["rotational_fraction"])
    edges = np.unique(np.quantile(fraction, np.linspace(0, 1, 11)))
    tenth = np.clip(np.searchsorted(edges, fraction, side="right") - 1, 0, edges.size - 2)
    impacts = inside.regrouped(tenth, edges.size - 1)
    distance = impacts.means(np.abs(inside.of(runs.main["restitution"]) - settings.normal))
    found = trend(distance)
    centres = [f"E_rot/E_tot from {low:.2g} to {high:.2g}" for low, high in pairwise(edges)]
    return Finding(
        measured=(
            *listed("mean |ε − ε_n|", centres[::3], distance.take(slice(None, None, 3))),
            found.step,
        ),
        verdict=found.verdict,
        rule=f"Tenths of the impacts in the range of Fig. 2 by E_rot/E_tot, lowest first. {RISING_RULE}",
        why=f"The mean |ε − ε_n| goes from {distance.value[0]:.2g} in the lowest tenth of E_rot/E_tot to "
        f"{distance.value[-1]:.2g} in the highest.",
    )


@CLAIMS.add(
    "beads",
    "the error is rather small for small deviations from the spherical shape",
    "Sec. III, Fig. 6",
)
def beads(runs: Runs, settings: Settings) -> Finding:
    sigma = by_elongation(runs, settings)
    ordered = [sigma[x] for x in sorted(sigma)]
    longer = np.array([b.apart(a) for a, b in pairwise(ordered)])
    slower = {x: trend(sigma[x].take(slice(None, None, -1))) for x in runs.beads}
    grows, scatters = bool(np.all(longer > SIGNIFICANT)), all(t.monotone for t in slower.values())
    largest = max(float(np.nanmax(sigma[x].value)) for x in runs.beads)
    return Finding(
        measured=tuple(
            item for x in runs.beads for item in listed(f"σ(ε), L/R = {x:g}", settings.labels, sigma[x])
        ),
        verdict=verdict(grows and scatters, grows or scatters),
        rule=f"Holds if σ(ε) grows with L/R (up to {settings.elongation:g}) at each of the four speeds, by "
        f"more than {SIGNIFICANT:g} standard errors, and for the beads with falling speed as well; in part "
        "if only one of the two is so; fails otherwise. The paper does not say what is small: this tests the "
        f"order alone. The least growth with L/R is by {longer.min():.3g} standard errors: where more were "
        "asked for, the verdict would change.",
        why=f"σ(ε) of the beads is at most {largest:.2g}. Rounder beads scatter less at every speed, and "
        "each scatters more the slower it is."
        if grows and scatters
        else f"Growth with L/R: {'yes' if grows else 'no'}; with falling speed: "
        f"{'yes' if scatters else 'no'}.",
    )
