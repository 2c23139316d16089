"""Claims of PRE 90, 052204 and of the abstract of its ref. 10 about rough spheres, each sentence judged."""

import numpy as np
import xarray as xr

from restitution.figures.report import grouped
from restitution.papers import shape
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import Array, deviations, in_windows, jackknife
from restitution.papers.gunkelmann2014._runs import Runs
from restitution.papers.gunkelmann2014._settings import Settings
from restitution.papers.shape import Shape
from restitution.papers.trend import falling, grows

CLAIMS: Claims[Runs, Settings] = Claims()
SPEED_BINS = 14
_MONTAINE = "abstract of ref. 10 (PRE 84, 041306)"


def _shapes(runs: Runs, s: Settings, data: xr.Dataset) -> list[Shape]:
    """Return the densities at the four speeds, slowest first."""
    return shape.shapes(runs, data, s, f"shapes, {data.attrs['run']}")


@CLAIMS.add("non-gaussian", "non-trivial (non-Gaussian) fluctuations of the measured values", _MONTAINE)
def non_gaussian(runs: Runs, s: Settings) -> Finding:
    gains = {one.label: one.rivals["Gaussian"] for one in _shapes(runs, s, runs.main)}
    better = [gain.z > SIGNIFICANT for gain in gains.values()]
    return Finding(
        measured=tuple(
            Measurement("gain in ln L an impact over a Gaussian", gain.difference, gain.standard_error, at=at)
            for at, gain in gains.items()
        ),
        verdict=verdict(all(better), any(better)),
        rule="Holds if the asymmetric Laplace density has the greater likelihood at each of the four "
        f"speeds, by more than {SIGNIFICANT:g} standard errors; in part if at some; fails otherwise.",
        why=f"Two exponentials are better than a Gaussian at {sum(better)} of {len(better)} speeds.",
    )


@CLAIMS.add(
    "two-exponentials",
    "the probability density of the coefficient of restitution, p(ε), is formed by two exponential "
    "functions (one increasing, one decreasing)",
    f"{_MONTAINE}; Secs. I and V: “a characteristic probability distribution [11]”, “of Laplace type”",
)
def two_exponentials(runs: Runs, s: Settings) -> Finding:
    shapes = _shapes(runs, s, runs.main)
    by_speed = "; ".join(
        f"at {one.label} it {one.verdict}, with flanks exp(−|x|^k), k = {one.exponent[0]:.3f} ± "
        f"{one.exponent[1]:.3f}"
        for one in shapes
    )
    return shape.laplace(shapes, f"{by_speed.capitalize()}.")


@CLAIMS.add("different-slope", "two exponential functions … of different slope", _MONTAINE)
def different_slope(runs: Runs, s: Settings) -> Finding:
    exact = [-2.0 * float(np.log(s.density(v).args[0])) for v in s.speeds]  # SciPy's parameter is √(b/a)
    why = "The decay lengths differ at {}; b > a where the impact is fast against the rotation."
    closed = listed("ln(a/b) in closed form", s.labels, exact)
    return shape.slopes(_shapes(runs, s, runs.main), "each speed", why, *closed)


@CLAIMS.add(
    "energy-transfer",
    "a certain roughness of the particle which leads to energy transfer between the linear and rotational "
    "degrees of freedom",
    _MONTAINE,
)
def energy_transfer(runs: Runs, s: Settings) -> Finding:
    """Correlate ε with what the rotational share does from this impact to the next one."""
    impacts = in_windows(runs.main["impact_velocity"], s.speed_windows).followed(runs.main)
    share = runs.main["rotational_fraction"].to_numpy()
    change = impacts.following(share) - impacts.of(share)
    found = impacts.correlations(impacts.of(runs.main["restitution"]), change)
    negative = found.beyond(0.0) < -SIGNIFICANT
    return Finding(
        measured=listed("correlation of ε with the change of E_rot/E_tot", s.labels, found),
        verdict=verdict(bool(negative.all()), bool(negative.any())),
        rule="Holds if ε and the change of the rotational share to the next impact have a negative "
        f"correlation at each speed, by more than {SIGNIFICANT:g} standard errors; in part if at some; fails "
        "otherwise.",
        why="Where ε is above its mean, the rotation has paid for it.",
    )


@CLAIMS.add(
    "scatter-grows",
    "an increasing uncertainty of the data (enhanced scatter) with decreasing impact velocity … The same "
    "effect is observed in experiments [10] and simulations of other nonspherical rough particles [11]",
    "Sec. III",
)
def scatter_grows(runs: Runs, s: Settings) -> Finding:
    bins = falling(runs.main, s.velocity_range[0], SPEED_BINS)
    sigma = bins.impacts.deviations(bins.impacts.of(runs.main["restitution"]))
    exact = [float(s.density(v).std()) for v in bins.speeds[::3]]
    closed = listed("σ(ε) in closed form", bins.labels[::3], exact)
    return grows(bins, ("σ(ε)", "σ(ε)"), sigma, 3, *closed)


@CLAIMS.add("superelastic", "the coefficient of restitution may exceed unity", "Sec. III, there of dumbbells")
def superelastic(runs: Runs, s: Settings) -> Finding:
    impacts = in_windows(runs.main["impact_velocity"], s.speed_windows)
    share = impacts.means((impacts.of(runs.main["restitution"]) > 1.0).astype(np.float64))
    exact = [float(s.density(v).sf(1.0)) for v in s.speeds]
    some = (share.value > SIGNIFICANT * share.error) & (share.value > 0.0)
    return Finding(
        measured=(*listed("P(ε > 1)", s.labels, share), *listed("P(ε > 1) in closed form", s.labels, exact)),
        verdict=verdict(bool(some.any()), bool((share.value > 0.0).any())),
        rule=f"Holds if the share of ε > 1 is above 0 by more than {SIGNIFICANT:g} standard errors at some "
        "speed; in part if there is any such impact; fails otherwise.",
        why=f"{100 * share.value[0]:.2g} % of the impacts at {s.labels[0]} have ε > 1. It depends on our "
        "heights: with the scatter.",
    )


@CLAIMS.add(
    "independence",
    "successive collisions of particles are only weakly correlated, which suggests one considers the "
    "coefficient of restitution as a random variable",
    "Sec. I, there of dilute gases",
)
def independence(runs: Runs, s: Settings) -> Finding:
    impacts = in_windows(runs.main["impact_velocity"], s.speed_windows).followed(runs.main)
    e = runs.main["restitution"].to_numpy()
    signed = impacts.correlations(impacts.of(e), impacts.following(e))
    away = np.abs(e - s.normal)
    sizes = impacts.correlations(impacts.of(away), impacts.following(away))
    free = np.abs(signed.beyond(0.0)) < SIGNIFICANT
    weak = np.abs(signed.value) < 0.1
    return Finding(
        measured=(
            *listed("correlation of successive ε", s.labels, signed),
            *listed("correlation of successive |ε − ε_n|", s.labels, sizes),
        ),
        verdict=verdict(bool(free.all()), bool(weak.all())),
        rule=f"Holds if the correlation of successive ε is within {SIGNIFICANT:g} standard errors of 0 at "
        "each speed; in part if it is below 0.1 at each; fails otherwise.",
        why="Successive signs are nearly independent; successive sizes are not, because the particle keeps "
        f"its spin: their correlation is about {sizes.value.mean():.2f}.",
    )


@CLAIMS.add(
    "rotation-grows",
    "the amount of rotational energy of the particle which increases on average with the number of bounces",
    "Sec. III, there of dumbbells",
)
def rotation_grows(runs: Runs, s: Settings) -> Finding:
    bins = falling(runs.main, s.velocity_range[0], SPEED_BINS)
    share = bins.impacts.means(bins.impacts.of(runs.main["rotational_fraction"]))
    exact = [s.mean_share(v) for v in bins.speeds[::3]]
    closed = listed("mean E_rot/E_tot in closed form", bins.labels[::3], exact)
    names = "mean E_rot/E_tot", "The mean share"
    return grows(bins, names, share, 3, *closed, of="The share E_rot/E_tot in ")


@CLAIMS.add(
    "same-density",
    "both types of imperfection lead to the same probability density of the scatter of Laplace type",
    "Sec. V",
)
def same_density(runs: Runs, s: Settings) -> Finding:
    found = {}
    for name, data in (("rough sphere", runs.main), ("dumbbell", runs.dumbbell)):
        found["flank exponent", name] = [one.exponent for one in _shapes(runs, s, data)]
        found["kurtosis", name] = [_kurtosis(data, window) for window in s.speed_windows]
    same = {}
    for what in ("flank exponent", "kurtosis"):
        (a, da), (b, db) = (np.array(found[what, name]).T for name in ("rough sphere", "dumbbell"))
        same[what] = np.abs(a - b) < SIGNIFICANT * np.hypot(da, db)
    every = np.array(list(same.values()))
    return Finding(
        measured=tuple(
            Measurement(f"{what}, {name}", *one, at=at)
            for (what, name), values in found.items()
            for at, one in zip(s.labels, values, strict=True)
        ),
        verdict=verdict(bool(every.all()), bool(every.any())),
        rule="Flanks exp(−|x|^k) by maximum likelihood; k = 1 and kurtosis 6 are Laplace, 2 and 3 Gaussian. "
        f"Holds if both of a rough sphere and of a dumbbell with L/R = {s.elongation:g} differ by less than "
        f"{SIGNIFICANT:g} standard errors at each speed; in part if one does at some; fails otherwise.",
        why=" and ".join(f"the {what} agrees at {int(one.sum())}" for what, one in same.items()).capitalize()
        + f" of {len(s.labels)} speeds. The lever arm of a dumbbell is at most L/2, that of a rough sphere "
        "has no such end.",
    )


def _kurtosis(data: xr.Dataset, window: tuple[float, float]) -> tuple[float, float]:
    impacts = in_windows(data["impact_velocity"], (window,))
    values = impacts.of(data["restitution"])
    return jackknife(lambda x: float(np.mean((x - x.mean()) ** 4) / x.var() ** 2), values, impacts.where[0])


@CLAIMS.add(
    "number-of-asperities",
    "a central sphere with a large number (typically 10^6 or more) of asperities",
    "Sec. V",
)
def number_of_asperities(runs: Runs, s: Settings) -> Finding:
    """Exponents of σ in N at equal heights, and in the mean height at one N; and in closed form."""
    k = 1  # 0.2 m/s
    at, v = s.labels[k], s.speeds[k]
    numbers = [s.contact(asperities=n) for n in s.numbers]
    heights = [s.contact(mean_height=h) for h in s.mean_heights]
    measured: list[Measurement] = []
    slopes, agree = [], []
    for name, by, contacts in (("N", runs.by_number, numbers), ("⟨h⟩", runs.by_height, heights)):
        found = [deviations(data, s).take([k]) for data in by.values()]
        sigma, error = (np.array([getattr(one, part)[0] for one in found]) for part in ("value", "error"))
        exact = np.array([float(s.density(v, contact).std()) for contact in contacts])
        x = np.log(np.array(list(by), dtype=np.float64))
        slope, closed, uncertain = _slopes(x, np.log([sigma, exact]), error / sigma)
        slopes += [slope, closed]
        agree.append(abs(slope - closed) < SIGNIFICANT * uncertain + 0.05)
        measured.append(Measurement(f"d ln σ/d ln {name}", slope, uncertain, at=at))
        measured.append(Measurement(f"d ln σ/d ln {name} in closed form", closed, at=at))
        texts = [
            f"σ(ε), {name} = {grouped(int(value)) if name == 'N' else f'{1e6 * value:g} µm'}" for value in by
        ]
        for text, value, one, other in zip(texts, sigma, error, exact, strict=True):
            measured.append(Measurement(text, float(value), float(one), at=at))
            measured.append(Measurement(f"{text}, in closed form", float(other), at=at))
    return Finding(
        measured=tuple(measured),
        verdict=verdict(False, all(agree)),
        rule="N: equal heights; ⟨h⟩: random ones. The number says what the scatter is only if heights are "
        "equal. In part if both exponents are those of Eqs. 10 and 12 of “The closed form” (−1 and 1 where "
        f"the spin is not braked) within 0.05 and {SIGNIFICANT:g} standard errors; fails otherwise.",
        why="With equal heights σ goes as N to the power {:.3f}, in closed form {:.3f}; with random ones as "
        "⟨h⟩ to the power {:.3f}, in closed form {:.3f}, and the number has dropped out: 10⁶ asperities "
        "alone do not say how a ball scatters.".format(*slopes),
    )


def _slopes(x: Array, y: Array, error: Array) -> tuple[float, float, float]:
    """Fit straight lines to both rows of y, with the errors of the first; return the slopes and an error."""
    weight = error**-2
    weight *= x - weight @ x / weight.sum()
    first, second = y @ weight / (weight @ x)
    return float(first), float(second), float((weight @ x) ** -0.5)
