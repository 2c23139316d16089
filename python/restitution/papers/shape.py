"""The density of ε at one speed beside the asymmetric Laplace distribution: tests, flanks and rivals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy import stats

from restitution import fit
from restitution.papers.claims import SIGNIFICANT, Finding, Measurement, Verdict, verdict
from restitution.papers.estimate import Array, Index, in_windows, jackknife
from restitution.papers.runs import Runs, derived_seed
from restitution.papers.settings import AtSpeeds

RIVALS = (fit.gaussian, fit.logistic, fit.student_t)
RESAMPLES = 499
IN_TAILS = 100
REJECTED = 0.002
"""p-value at which a density is rejected: no draw from it is as far off."""


@dataclass(frozen=True)
class Shape:
    """Measurements of the density at one speed."""

    label: str  # the speed
    goodness: fit.Goodness  # of the Laplace fit to independent draws, at most one of each particle
    distance: float  # of Kolmogorov and Smirnov, between all impacts and their fit
    rivals: dict[str, fit.Comparison]  # gain of the Laplace fit in log-likelihood an impact, by family
    exponent: tuple[float, float]  # k of the flanks exp(−|x|^k), and its error; 1 is Laplace, 2 Gaussian
    tails: tuple[float, float]  # √ of the impacts in the tails over those of the fit, and its error
    asymmetry: tuple[float, float]  # ln(a/b) of the decay lengths above and below, and its error

    @property
    def rejected(self) -> bool:
        """True if a test, the exponent or the tails exclude the Laplace density."""
        p = min(self.goodness.kolmogorov_smirnov_p, self.goodness.anderson_darling_p)
        far = (abs(value - 1) > SIGNIFICANT * error for value, error in (self.exponent, self.tails))
        return p <= REJECTED or any(far)

    @property
    def skewed(self) -> bool:
        """True if the decay lengths above and below differ."""
        value, error = self.asymmetry
        return abs(value) > SIGNIFICANT * error

    @property
    def verdict(self) -> Verdict:
        """By `LAPLACE_RULE`, for this speed."""
        scores = [c.z for c in self.rivals.values()]
        return verdict(
            not self.rejected, all(z > -SIGNIFICANT for z in scores) and any(z > SIGNIFICANT for z in scores)
        )


LAPLACE_RULE = (
    f"Tails: farther from the cusp than the fit expects {IN_TAILS} impacts to be. At one speed: holds if the "
    f"Laplace density is not rejected (both p-values of independent draws above {REJECTED:g}; flank "
    f"exponent, and √ of the number in the tails over {IN_TAILS}, within {SIGNIFICANT:g} standard errors of "
    "1); in part if it is, but no "
    f"rival (Gaussian, logistic, Student's t) is better by more than {SIGNIFICANT:g} standard errors of the "
    "log-likelihood and some rival is worse by as much; fails otherwise. Overall: holds if it holds at "
    f"every speed, fails if it fails at every one. The p-values come from {RESAMPLES} draws, so none is "
    f"below {1 / (RESAMPLES + 1):g}."
)


def shapes(runs: Runs, data: xr.Dataset, settings: AtSpeeds, name: str) -> list[Shape]:
    """Measure the density of ε at each speed, slowest first, once for all claims; `name` seeds the draws."""
    seed = derived_seed(runs.seed, name)

    def measure() -> list[Shape]:
        impacts = in_windows(data["impact_velocity"], settings.speed_windows)
        drawn = impacts.one_per_particle(seed)
        every, some = (chosen.of(data["restitution"]) for chosen in (impacts, drawn))
        found = []
        for k, label in enumerate(settings.labels):
            here = impacts.cell == k
            found.append(shape(label, every[here], impacts.where[0][here], some[drawn.cell == k], seed))
        return found

    return runs.once(name, measure)


def shape(label: str, values: Array, particle: Index, independent: Array, seed: int) -> Shape:
    """Measure the density of values, some of which are independent draws, at most one of each particle."""
    laplace = fit.asymmetric_laplace(values)
    return Shape(
        label,
        fit.goodness(fit.asymmetric_laplace, independent, resamples=RESAMPLES, seed=seed),
        float(stats.kstest(laplace.cdf(values), "uniform", method="asymp").statistic),
        {
            one.family: fit.compare(laplace, one, values, particle)
            for one in (rival(values) for rival in RIVALS)
        },
        jackknife(lambda x: fit.asymmetric_power(x).parameters["exponent"], values, particle),
        jackknife(tails, values, particle),
        jackknife(_log_ratio, values, particle),
    )


def tails(values: Array) -> float:
    """Return √ of the number of impacts where the Laplace fit has `IN_TAILS`, over that of the fit."""
    found = fit.asymmetric_laplace(values).parameters
    away = values - found["location"]
    lengths = np.where(away > 0, away / found["above"], -away / found["below"])
    return float(np.sqrt(np.count_nonzero(lengths > np.log(values.size / IN_TAILS)) / IN_TAILS))


def _log_ratio(values: Array) -> float:
    found = fit.asymmetric_laplace(values).parameters
    return float(np.log(found["above"] / found["below"]))


def laplace(shapes: Sequence[Shape], why: str) -> Finding:
    """Judge the claim that the density is a Laplace density at these speeds, by `LAPLACE_RULE`."""
    measured: list[Measurement] = []
    for one in shapes:
        measured += [
            Measurement("independent draws", float(one.goodness.fit.samples), at=one.label),
            *tests(one),
            *(
                Measurement(
                    f"gain in ln L an impact over {name}", c.difference, c.standard_error, at=one.label
                )
                for name, c in one.rivals.items()
            ),
        ]
    verdicts = [one.verdict for one in shapes]
    holds = verdict(all(v == "holds" for v in verdicts), any(v != "fails" for v in verdicts))
    return Finding(tuple(measured), holds, LAPLACE_RULE, why)


def slopes(shapes: Sequence[Shape], speeds: str, why: str, *exact: Measurement) -> Finding:
    """Judge the claim that the two decay lengths differ at these speeds, which a text may fill into `why`."""
    clear = [one.label for one in shapes if one.skewed]
    return Finding(
        (*(Measurement("ln(a/b)", *one.asymmetry, at=one.label) for one in shapes), *exact),
        verdict(len(clear) == len(shapes), bool(clear)),
        "a, b: decay lengths above and below the fitted cusp. Holds if ln(a/b) differs from 0 by more than "
        f"{SIGNIFICANT:g} standard errors at {speeds}; in part if at some; fails otherwise.",
        why.format(", ".join(clear) or "no speed"),
    )


def tests(one: Shape) -> tuple[Measurement, ...]:
    """Return the measures by which the Laplace density may be rejected."""
    return (
        Measurement("p (Kolmogorov–Smirnov)", one.goodness.kolmogorov_smirnov_p, at=one.label),
        Measurement("p (Anderson–Darling)", one.goodness.anderson_darling_p, at=one.label),
        Measurement("flank exponent k", *one.exponent, at=one.label),
        Measurement("√(impacts in the tails over those of the fit)", *one.tails, at=one.label),
    )
