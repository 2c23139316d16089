"""Claims of Sec. IV: ε < 0, its branches, its growth, that it needs no spin; Figs. 7 and 9."""

from itertools import pairwise

import numpy as np
from scipy import stats

from restitution._internal.text import with_error
from restitution.analytic import first_impact
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import blocks, in_bins, in_blocks
from restitution.papers.glielmo2014._misprints import printed_density
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.trend import RISING_RULE, falling, trend

CLAIMS: Claims[Runs, Settings] = Claims()
BLOCKS = (0, 10, 30, 100, 200, 400)
FRACTION_BINS = 6
SPEED_BINS = 8
REJECTED = 1e-3
NODES = 20_000


@CLAIMS.add(
    "two-branches",
    "There are two different mechanisms leading to negative values of the coefficient of restitution",
    "Sec. IV, Fig. 7",
)
def branches(runs: Runs, settings: Settings) -> Finding:
    v, rebound, e = (
        runs.main[name].to_numpy() for name in ("impact_velocity", "rebound_velocity", "restitution")
    )
    negative = int(np.count_nonzero(e < 0))
    right = int(np.count_nonzero((e < 0) & (v > 0) & (rebound < 0)))
    left = int(np.count_nonzero((e < 0) & (v < 0) & (rebound > 0)))
    neither = negative - right - left
    return Finding(
        measured=(
            Measurement("impacts with ε < 0", float(negative)),
            Measurement("… falling before and after (right branch)", float(right)),
            Measurement("… rising before and after (left branch)", float(left)),
            Measurement("… neither", float(neither)),
            Measurement("impacts while rising, all", float(np.count_nonzero(v < 0))),
        ),
        verdict=verdict(right > 0 and left > 0 and neither == 0, right + left > 0),
        rule="Holds if both branches are populated and no impact with ε < 0 belongs to neither; in part if "
        "only one branch is populated or some impact belongs to neither; fails if both are empty.",
        why=f"In {with_error(right, None)} of these impacts the centre of mass continues to fall, in "
        f"{with_error(left, None)} it is already rising; "
        f"{with_error(neither, None)} belong to neither branch.",
    )


@CLAIMS.add(
    "negative-with-impacts",
    "the probability of such events increases with increasing impact number",
    "Sec. IV",
)
def more_with_impacts(runs: Runs, settings: Settings) -> Finding:
    """More of them on later impacts, and at lower speed."""
    e = runs.main["restitution"].to_numpy()
    edges = blocks(runs.main, BLOCKS)
    impacts = in_blocks(~np.isnan(e), edges)
    share = impacts.means((impacts.of(e) < 0).astype(np.float64))
    bins = falling(runs.main, 1e-3, SPEED_BINS)
    slow = bins.impacts.means((bins.impacts.of(e) < 0).astype(np.float64))
    later, slower = trend(share), trend(slow)
    return Finding(
        measured=(
            *listed("P(ε < 0)", [f"impacts {a + 1} to {b}" for a, b in pairwise(edges)], share),
            *listed("P(ε < 0)", bins.labels, slow),
        ),
        verdict=verdict(later.monotone and slower.monotone, later.rises),
        rule=f"Blocks of impacts by their number, and {SPEED_BINS} logarithmic bins of v > 0, fastest first. "
        f"Holds if in both the last value is above the first by more than {SIGNIFICANT:g} standard errors "
        "and no step goes down by more; in part if at least it rises from the first block to the last; "
        "fails otherwise.",
        why=f"P(ε < 0) goes from {share.value[0]:.2g} in the first block to {share.value[-1]:.2g} in the "
        f"last, and from {slow.value[0]:.2g} at {bins.labels[0]} to {slow.value[-1]:.2g} at "
        f"{bins.labels[-1]}.",
    )


@CLAIMS.add(
    "negative-with-rotation",
    "the probability to obtain a value ε < 0 increases with increasing rotational energy",
    "Sec. IV",
)
def more_with_rotation(runs: Runs, settings: Settings) -> Finding:
    fraction = runs.main["rotational_fraction"]
    edges = np.unique(np.nanquantile(fraction, np.linspace(0, 1, FRACTION_BINS + 1)))
    edges[-1] *= 1 + 1e-12
    impacts = in_bins(fraction, edges)
    share = impacts.means((impacts.of(runs.main["restitution"]) < 0).astype(np.float64))
    return Finding(
        measured=listed(
            "P(ε < 0)", [f"E_rot/E_tot from {a:.3g} to {b:.3g}" for a, b in pairwise(edges)], share
        ),
        verdict=trend(share).verdict,
        rule=f"{FRACTION_BINS} equally filled bins of E_rot/E_tot. {RISING_RULE}",
        why=f"P(ε < 0) goes from {share.value[0]:.2g} in the lowest bin to {share.value[-1]:.2g} in the "
        "highest.",
    )


@CLAIMS.add(
    "negative-from-rest",
    "even for |ω| = 0, there is a finite probability to obtain negative values",
    "Sec. IV, Fig. 9",
)
def from_rest(runs: Runs, settings: Settings) -> Finding:
    values = runs.first["restitution"].to_numpy()[:, 0]
    exact = float(first_impact(settings.body(settings.first_elongation), settings.first_law).cdf(0.0))
    share = float(np.mean(values < 0))
    error = float(np.sqrt(share * (1 - share) / values.size))
    finite = share > SIGNIFICANT * error and share > 0
    return Finding(
        measured=(
            Measurement("P(ε < 0) at the first impact, L = 2R, ε_n = 0.4", share, error),
            Measurement("… from Eq. 17 in closed form", exact),
            Measurement("smallest ε", float(values.min())),
        ),
        verdict=verdict(finite and abs(share - exact) <= SIGNIFICANT * error, finite),
        rule=f"Holds if the share is above 0 by more than {SIGNIFICANT:g} standard errors and within as many "
        "of the probability from Eq. 17; in part if only the first; fails otherwise.",
        why=f"{100 * share:.3g} % of the first impacts have ε < 0, {100 * exact:.3g} % by Eq. 17.",
    )


@CLAIMS.add(
    "fig-9",
    "A comparison with a simulation for ε_n = 0.4 and L = 2R shows almost perfect agreement",
    "Sec. IV, Fig. 9, Eq. 17",
)
def agreement(runs: Runs, settings: Settings) -> Finding:
    exact = first_impact(settings.body(settings.first_elongation), settings.first_law)
    values = runs.first["restitution"].to_numpy()[:, 0]
    found = stats.kstest(exact.cdf(values), "uniform")
    return Finding(
        measured=(
            Measurement("first impacts", float(values.size)),
            Measurement("distance sup|F − F_exact|", float(found.statistic)),
            Measurement("p (Kolmogorov–Smirnov)", float(found.pvalue)),
        ),
        verdict=verdict(bool(found.pvalue > REJECTED), bool(found.statistic < 0.01)),
        rule=f"Distribution function from Eq. 17 in closed form. Holds if p > {REJECTED:g}; in part if "
        "the distance is below 0.01; fails otherwise.",
        why=f"Simulation and Eq. 17 differ by at most {found.statistic:.2g}, consistent with sampling "
        f"noise (p = {found.pvalue:.2g})."
        if found.pvalue > REJECTED
        else f"Simulation and Eq. 17 differ by {found.statistic:.2g}, more than sampling noise explains.",
    )


@CLAIMS.add("eq-21", "We obtain p_ε(s) = […]", "Sec. IV, Eq. 21")
def density(runs: Runs, settings: Settings) -> Finding:
    body, law = settings.body(settings.first_elongation), settings.first_law
    exact = first_impact(body, law)
    # ∫ printed ds = mean over u of printed/exact at s = quantile(u); bounded where both diverge.
    at = exact.ppf((np.arange(NODES) + 0.5) / NODES)
    quotient = printed_density(at, body, law) / exact.pdf(at)
    integral = float(np.mean(quotient))
    one = abs(integral - 1) < 1e-6
    return Finding(
        measured=(
            Measurement("integral of Eq. 21 as printed", integral),
            Measurement("printed over right density, lowest", float(quotient.min())),
            Measurement("… highest", float(quotient.max())),
        ),
        verdict=verdict(one and np.ptp(quotient) < 1e-6, one),
        rule="Holds if the printed density integrates to 1 and equals the derivative of the "
        "distribution function of Eq. 17 (to 1e−6); in part if it only integrates to 1; fails otherwise.",
        why="The printed density integrates to 1."
        if one
        else f"As printed it integrates to {integral:.4g}; with the corrections below it integrates to 1.",
    )
