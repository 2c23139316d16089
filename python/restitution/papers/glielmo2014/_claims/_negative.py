"""Claims on ε < 0: its two branches, its growth, and that it needs no spin (Sec. IV, Fig. 7)."""

from itertools import pairwise

import numpy as np

from restitution._internal.text import with_error
from restitution.analytic import first_impact
from restitution.papers.glielmo2014._claims._claim import SIGNIFICANT, Claim, Measurement, listed, verdict
from restitution.papers.glielmo2014._claims._estimate import blocks, in_bins, in_blocks
from restitution.papers.glielmo2014._claims._trend import RISING_RULE, falling, trend
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

BLOCKS = (0, 10, 30, 100, 200, 400)
FRACTION_BINS = 6
SPEED_BINS = 8


def judge(runs: Runs, settings: Settings) -> list[Claim]:
    """Judge the claims of Sec. IV on negative ε."""
    return [
        _branches(runs),
        _more_with_impacts(runs),
        _more_with_rotation(runs),
        _from_rest(runs, settings),
    ]


def _branches(runs: Runs) -> Claim:
    v, rebound, e = (
        runs.main[name].to_numpy() for name in ("impact_velocity", "rebound_velocity", "restitution")
    )
    negative = int(np.count_nonzero(e < 0))
    right = int(np.count_nonzero((e < 0) & (v > 0) & (rebound < 0)))
    left = int(np.count_nonzero((e < 0) & (v < 0) & (rebound > 0)))
    neither = negative - right - left
    return Claim(
        key="two-branches",
        quote="There are two different mechanisms leading to negative values of the coefficient of "
        "restitution",
        where="Sec. IV, Fig. 7",
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


def _more_with_impacts(runs: Runs) -> Claim:
    """More of them on later impacts, and at lower speed."""
    e = runs.main["restitution"].to_numpy()
    edges = blocks(runs.main, BLOCKS)
    impacts = in_blocks(~np.isnan(e), edges)
    share = impacts.means((impacts.of(e) < 0).astype(np.float64))
    bins = falling(runs.main, 1e-3, SPEED_BINS)
    slow = bins.impacts.means((bins.impacts.of(e) < 0).astype(np.float64))
    later, slower = trend(share), trend(slow)
    return Claim(
        key="negative-with-impacts",
        quote="the probability of such events increases with increasing impact number",
        where="Sec. IV",
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


def _more_with_rotation(runs: Runs) -> Claim:
    fraction = runs.main["rotational_fraction"]
    edges = np.unique(np.nanquantile(fraction, np.linspace(0, 1, FRACTION_BINS + 1)))
    edges[-1] *= 1 + 1e-12
    impacts = in_bins(fraction, edges)
    share = impacts.means((impacts.of(runs.main["restitution"]) < 0).astype(np.float64))
    return Claim(
        key="negative-with-rotation",
        quote="the probability to obtain a value ε < 0 increases with increasing rotational energy",
        where="Sec. IV",
        measured=listed(
            "P(ε < 0)", [f"E_rot/E_tot from {a:.3g} to {b:.3g}" for a, b in pairwise(edges)], share
        ),
        verdict=trend(share).verdict,
        rule=f"{FRACTION_BINS} equally filled bins of E_rot/E_tot. {RISING_RULE}",
        why=f"P(ε < 0) goes from {share.value[0]:.2g} in the lowest bin to {share.value[-1]:.2g} in the "
        "highest.",
    )


def _from_rest(runs: Runs, settings: Settings) -> Claim:
    values = runs.first["restitution"].to_numpy()[:, 0]
    exact = float(first_impact(settings.body(settings.first_elongation), settings.first_law).cdf(0.0))
    share = float(np.mean(values < 0))
    error = float(np.sqrt(share * (1 - share) / values.size))
    finite = share > SIGNIFICANT * error and share > 0
    return Claim(
        key="negative-from-rest",
        quote="even for |ω| = 0, there is a finite probability to obtain negative values",
        where="Sec. IV, Fig. 9",
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
