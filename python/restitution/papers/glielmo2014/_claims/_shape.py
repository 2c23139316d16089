"""Claims on the density of ε at given speed: two exponentials, asymmetric, not at 0.1 m/s (Fig. 4)."""

from dataclasses import dataclass

import numpy as np

from restitution import fit
from restitution.papers.glielmo2014._claims._claim import SIGNIFICANT, Claim, Measurement, Verdict, verdict
from restitution.papers.glielmo2014._claims._estimate import Array, Index, in_windows, jackknife
from restitution.papers.glielmo2014._runs import Runs, derived_seed
from restitution.papers.glielmo2014._settings import Settings

RIVALS = (fit.gaussian, fit.logistic, fit.student_t)
RESAMPLES = 499
REJECTED = 0.002
"""p-value at which a density is rejected: no draw from it is as far off."""


@dataclass(frozen=True)
class Shape:
    """The density of ε at one speed beside the asymmetric Laplace distribution.

    Attributes
    ----------
    label : str
        The speed.
    goodness : Goodness
        Of the Laplace fit to independent draws, at most one of each particle.
    distance : float
        Kolmogorov–Smirnov distance between all impacts and their fit.
    rivals : dict
        By family: gain of the Laplace fit over it in log-likelihood an impact, with an error by particle.
    exponent : (float, float)
        k of the flanks exp(−|x|^k) with its standard error; 1 is Laplace, 2 is Gaussian.
    asymmetry : (float, float)
        ln(a/b) of the decay lengths above and below the cusp with its standard error; 0 is symmetric.
    """

    label: str
    goodness: fit.Goodness
    distance: float
    rivals: dict[str, fit.Comparison]
    exponent: tuple[float, float]
    asymmetry: tuple[float, float]

    @property
    def rejected(self) -> bool:
        """Whether a test or the exponent excludes the Laplace density."""
        k, error = self.exponent
        p = min(self.goodness.kolmogorov_smirnov_p, self.goodness.anderson_darling_p)
        return p <= REJECTED or abs(k - 1) > SIGNIFICANT * error

    @property
    def verdict(self) -> Verdict:
        """By `LAPLACE_RULE`, for this speed."""
        scores = [c.z for c in self.rivals.values()]
        return verdict(
            not self.rejected, all(z > -SIGNIFICANT for z in scores) and any(z > SIGNIFICANT for z in scores)
        )


LAPLACE_RULE = (
    "At one speed: holds if the Laplace density is not rejected (both p-values of independent draws above "
    f"{REJECTED:g} and flank exponent within {SIGNIFICANT:g} standard errors of 1); in part if it is, but no "
    f"rival (Gaussian, logistic, Student's t) is better by more than {SIGNIFICANT:g} standard errors of the "
    "log-likelihood and some rival is worse by as much; fails otherwise. Overall: holds if it holds at "
    f"every speed, fails if it fails at every one. The p-values come from {RESAMPLES} draws, so none is "
    f"below {1 / (RESAMPLES + 1):g}."
)


def judge(runs: Runs, settings: Settings) -> list[Claim]:
    """Judge the claims of Sec. III on the density of ε."""
    found = _shapes(runs, settings)
    return [_laplace(found[1:]), _asymmetric(found[1:]), _deviates(found)]


def _shapes(runs: Runs, settings: Settings) -> list[Shape]:
    """Shapes at the four speeds, slowest first."""
    impacts = in_windows(runs.main["impact_velocity"], settings.speed_windows)
    seed = derived_seed(runs.seed, "goodness of fit")
    drawn = impacts.one_per_particle(seed)
    every, some = (chosen.of(runs.main["restitution"]) for chosen in (impacts, drawn))
    return [
        _shape(
            f"{v:g} m/s",
            every[impacts.cell == k],
            impacts.where[0][impacts.cell == k],
            some[drawn.cell == k],
            seed,
        )
        for k, v in enumerate(settings.speeds)
    ]


def _shape(label: str, values: Array, particle: Index, independent: Array, seed: int) -> Shape:
    laplace = fit.asymmetric_laplace(values)
    ordered = np.sort(values)
    model, n = laplace.cdf(ordered), values.size
    rank = np.arange(n)
    return Shape(
        label,
        fit.goodness(fit.asymmetric_laplace, independent, resamples=RESAMPLES, seed=seed),
        float(max(np.max((rank + 1) / n - model), np.max(model - rank / n))),
        {
            one.family: fit.compare(laplace, one, values, particle)
            for one in (rival(values) for rival in RIVALS)
        },
        jackknife(lambda x: fit.asymmetric_power(x).parameters["exponent"], values, particle),
        jackknife(_log_ratio, values, particle),
    )


def _log_ratio(values: Array) -> float:
    found = fit.asymmetric_laplace(values).parameters
    return float(np.log(found["above"] / found["below"]))


def _tests(one: Shape) -> tuple[Measurement, ...]:
    """Give what decides whether the Laplace density is rejected."""
    return (
        Measurement("p (Kolmogorov–Smirnov)", one.goodness.kolmogorov_smirnov_p, at=one.label),
        Measurement("p (Anderson–Darling)", one.goodness.anderson_darling_p, at=one.label),
        Measurement("flank exponent k", *one.exponent, at=one.label),
    )


def _laplace(shapes: list[Shape]) -> Claim:
    measured = []
    for one in shapes:
        good = one.goodness
        measured += [
            Measurement("independent draws", float(good.fit.samples), at=one.label),
            *_tests(one),
            *(
                Measurement(
                    f"gain in ln L an impact over {name}", c.difference, c.standard_error, at=one.label
                )
                for name, c in one.rivals.items()
            ),
        ]
    verdicts = [one.verdict for one in shapes]
    by_speed = "; ".join(
        f"at {one.label} it {one.verdict} (flanks exp(−|x|^k) with k = {one.exponent[0]:.3g})"
        for one in shapes
    )
    return Claim(
        key="laplace",
        quote="a probability density composed of two exponential functions (asymmetric Laplace function)",
        where="Sec. III, Fig. 4; Sec. V",
        measured=tuple(measured),
        verdict=verdict(all(v == "holds" for v in verdicts), any(v != "fails" for v in verdicts)),
        rule=LAPLACE_RULE,
        why=f"{by_speed[0].upper()}{by_speed[1:]}.",
    )


def _asymmetric(shapes: list[Shape]) -> Claim:
    clear = [abs(value) > SIGNIFICANT * error for value, error in (one.asymmetry for one in shapes)]
    return Claim(
        key="asymmetric",
        quote="(asymmetric Laplace function)",
        where="Sec. III, Fig. 4",
        measured=tuple(Measurement("ln(a/b)", *one.asymmetry, at=one.label) for one in shapes),
        verdict=verdict(all(clear), any(clear)),
        rule="a, b: decay lengths above and below the fitted cusp. Holds if ln(a/b) differs from 0 by more "
        f"than {SIGNIFICANT:g} standard errors at each speed above the lowest; in part if at some; fails "
        "otherwise.",
        why="The decay lengths above and below the cusp differ at "
        + (", ".join(s.label for s, c in zip(shapes, clear, strict=True) if c) or "no speed")
        + ".",
    )


def _deviates(shapes: list[Shape]) -> Claim:
    lowest, others = shapes[0], shapes[1:]
    farthest = all(lowest.distance > one.distance for one in others)
    return Claim(
        key="not-laplace-when-slow",
        quote="For very small velocity, the probability density deviates from the Laplacian (data for v_G^n "
        "= 0.1 m/s in Fig. 4)",
        where="Sec. III, Fig. 4",
        measured=(
            *_tests(lowest),
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
