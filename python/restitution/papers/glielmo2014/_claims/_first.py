"""Claims on the first impact from rest: Fig. 9 and Eq. 21."""

import numpy as np
from scipy import stats

from restitution.analytic import first_impact
from restitution.papers.glielmo2014._claims._claim import Claim, Measurement, verdict
from restitution.papers.glielmo2014._misprints import printed_density
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

REJECTED = 1e-3
NODES = 20_000


def judge(runs: Runs, settings: Settings) -> list[Claim]:
    """Judge the claims of Sec. IV on the first impact from rest."""
    body = settings.body(settings.first_elongation)
    exact = first_impact(body, settings.first_law)
    values = runs.first["restitution"].to_numpy()[:, 0]
    found = stats.kstest(exact.cdf(values), "uniform")
    # ∫ printed ds = mean over u of printed/exact at s = quantile(u); bounded where both diverge.
    at = exact.ppf((np.arange(NODES) + 0.5) / NODES)
    quotient = printed_density(at, body, settings.first_law) / exact.pdf(at)
    integral = float(np.mean(quotient))
    return [
        Claim(
            key="fig-9",
            quote="A comparison with a simulation for ε_n = 0.4 and L = 2R shows almost perfect agreement",
            where="Sec. IV, Fig. 9, Eq. 17",
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
        ),
        Claim(
            key="eq-21",
            quote="We obtain p_ε(s) = […]",
            where="Sec. IV, Eq. 21",
            measured=(
                Measurement("integral of Eq. 21 as printed", integral),
                Measurement("printed over right density, lowest", float(quotient.min())),
                Measurement("… highest", float(quotient.max())),
            ),
            verdict=verdict(abs(integral - 1) < 1e-6 and np.ptp(quotient) < 1e-6, abs(integral - 1) < 1e-6),
            rule="Holds if the printed density integrates to 1 and equals the derivative of the "
            "distribution function of Eq. 17 (to 1e−6); in part if it only integrates to 1; fails otherwise.",
            why=f"As printed it integrates to {integral:.4g}; with the corrections below it integrates to 1."
            if abs(integral - 1) >= 1e-6
            else "The printed density integrates to 1.",
        ),
    ]
