"""Claims on the rotational energy: its share of the total, its growth, its density (Figs. 3, 5)."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from restitution._core import STOP_REASONS
from restitution._internal.text import with_error
from restitution.papers.claims import SIGNIFICANT, Claims, Finding, Measurement, listed, verdict
from restitution.papers.estimate import Array, Estimate, blocks, in_blocks, in_windows
from restitution.papers.glielmo2014._claims._energy import energies
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.trend import RISING_RULE, falling, trend

CLAIMS: Claims[Runs, Settings] = Claims()
SPEED_BINS = 20
BLOCKS = (0, 1, 2, 5, 10, 20, 50, 100, 200, 400)
DENSITY_BINS = 10
_ERRORS = "standard errors"
REST = 1e-6
"""Share of the energy that counts as none; that of the speed 1 mm/s after a fall at 1 m/s."""


@CLAIMS.add(
    "rotation-monotone",
    "the ratio E_rot/(E_rot + E_tran) increases monotonously in Fig. 3",
    "Sec. III, Fig. 3, Eq. 12",
)
def share_monotone(runs: Runs, settings: Settings) -> Finding:
    bins = falling(runs.main, 1e-3, SPEED_BINS)
    share = bins.impacts.means(bins.impacts.of(runs.main["rotational_fraction"]))
    found = trend(share)
    shown = slice(None, None, 3)
    rolling = settings.rolling
    return Finding(
        measured=(
            *listed("mean E_rot/E_tot", bins.labels[shown], share.take(shown)),
            found.step,
            Measurement("E_rot/E_tot of rolling, J_xx/(J_xx + mR²)", rolling),
        ),
        verdict=found.verdict,
        rule=f"{SPEED_BINS} logarithmic bins of impact velocity, fastest first, down to {bins.labels[-1]}. "
        f"{RISING_RULE}",
        why=f"The mean goes from {share.value[0]:.2g} at {bins.labels[0]} to {share.value[-1]:.3g} at "
        f"{bins.labels[-1]}, "
        f"{'with no significant decrease' if found.monotone else 'but does not rise at every step'}. For a "
        f"rolling body it is {rolling:.3f}.",
    )


@CLAIMS.add(
    "rotation-grows",
    "the amount of rotational energy of the particle which increases on average with the number of bounces",
    "Sec. III",
)
def grows_with_bounces(runs: Runs, settings: Settings) -> Finding:
    fraction = runs.main["rotational_fraction"].to_numpy()
    total = energies(runs.main, settings.gravity)
    edges = blocks(runs.main, BLOCKS)
    energy, share = _blocks(fraction * total / total[:, :1], edges), _blocks(fraction, edges)
    grows, accumulates = trend(energy), trend(share)
    labels = [f"impacts {a + 1} to {b}" if b > a + 1 else f"impact {b}" for a, b in pairwise(edges)]
    peak = int(np.argmax(energy.value))
    return Finding(
        measured=(
            *listed("mean E_rot, over E_tot at the first impact", labels, energy),
            Measurement("largest step down of it", grows.worst, unit=_ERRORS),
            Measurement("largest step down of mean E_rot/E_tot", accumulates.worst, unit=_ERRORS),
        ),
        verdict=verdict(grows.monotone, accumulates.monotone),
        rule="Blocks of impacts by their number. Holds if the mean rotational energy is larger in the last "
        f"block than in the first and no step goes down by more than {SIGNIFICANT:g} standard errors; in "
        "part if that is so only of its share E_rot/E_tot; fails otherwise.",
        why="The mean rotational energy grows throughout."
        if grows.monotone
        else f"The mean rotational energy is largest at {labels[peak]} and then falls as all energy is "
        "dissipated; its share E_rot/E_tot "
        f"{'keeps growing' if accumulates.monotone else 'does not grow throughout either'}.",
    )


@CLAIMS.add(
    "energy-ceases",
    "asymptotically both components of the energy, translation and rotation, will cease",
    "Sec. III",
)
def ceases(runs: Runs, settings: Settings) -> Finding:
    """Measure the energy left after infinitely many impacts, that is, after a collapse."""
    total = energies(runs.main, settings.gravity)
    last = runs.main["impacts"].to_numpy() - 1
    left = total[np.arange(last.size), last] / total[:, 0]
    fraction = runs.main["rotational_fraction"].to_numpy()[np.arange(last.size), last]
    ended = runs.main["stop_reason"].to_numpy() == STOP_REASONS.index("collapse")
    kept = int(np.count_nonzero(left[ended] > REST))
    return Finding(
        measured=(
            Measurement("mean energy left at the last impact", *_mean(left), unit="of that at the first"),
            Measurement(
                "trajectories that collapse (infinitely many impacts)", float(np.count_nonzero(ended))
            ),
            Measurement("mean energy left in them", *_mean(left[ended]), unit="of that at the first"),
            Measurement("mean E_rot/E_tot at their last impact", *_mean(fraction[ended])),
            Measurement("E_rot/E_tot of rolling, J_xx/(J_xx + mR²)", settings.rolling),
        ),
        verdict=verdict(kept == 0, float(left.mean()) < 0.5),
        rule=f"Holds if no trajectory collapses with more than {with_error(REST, None)} of the energy of its "
        "first impact left; in part if at least half of the energy is lost by the last impact, on average; "
        "fails otherwise.",
        why=f"{kept} of {np.count_nonzero(ended)} trajectories with infinitely many impacts in finite time "
        f"retain energy, on average {100 * _mean(left[ended])[0]:.2g} % of the initial energy: this law does "
        "not slow down rolling."
        if kept
        else "No trajectory collapses with energy left.",
    )


def _blocks(values: Array, edges: Sequence[int]) -> Estimate:
    impacts = in_blocks(np.isfinite(values), edges)
    return impacts.means(impacts.of(values))


def _mean(values: Array) -> tuple[float, float]:
    """Return the mean of independent values and its standard error; NaN without values."""
    if values.size == 0:
        return float("nan"), float("nan")
    return float(values.mean()), float(values.std() / np.sqrt(values.size))


@CLAIMS.add(
    "rotation-decays",
    "we obtain decaying functions whose slope decreases with decreasing impact velocity",
    "Sec. III, Fig. 5",
)
def decaying(runs: Runs, settings: Settings) -> Finding:
    windows = in_windows(runs.main["impact_velocity"], settings.speed_windows)
    fraction = windows.of(runs.main["rotational_fraction"])
    mean = windows.means(fraction)
    rate = Estimate(1 / mean.value, mean.covariance / np.outer(mean.value, mean.value) ** 2, mean.number)
    rises = _rises(runs.main, settings)
    flattens = trend(rate)
    rising = [label for label, rise in zip(settings.labels, rises, strict=True) if rise > SIGNIFICANT]
    others: list[Measurement] = []
    for radius, by in runs.by_radius.items():
        if radius != settings.radius:
            name = f"largest rise of the density, R = {1e3 * radius:g} mm"
            others += listed(name, settings.labels, _rises(by[settings.elongation], settings), _ERRORS)
    return Finding(
        measured=(
            *listed("decay rate 1/⟨E_rot/E_tot⟩", settings.labels, rate),
            *listed("largest rise of the density", settings.labels, rises, _ERRORS),
            *others,
        ),
        verdict=verdict(flattens.monotone and not rising, flattens.monotone),
        rule="Decay rate: of the exponential with the same mean, its maximum-likelihood estimate. Rise: "
        f"between neighbours of {DENSITY_BINS} equal bins from 0 to the 99th percentile. Holds if the rate "
        f"falls from speed to speed and the density rises nowhere, each by more than {SIGNIFICANT:g} "
        "standard errors; in part if only the rate falls; fails otherwise.",
        why="The density decays at all four speeds and flattens as they fall."
        if not rising and flattens.monotone
        else f"The density flattens as the speed falls{'' if flattens.monotone else ' not at every step'}, "
        f"but it is not a decaying function at {' and '.join(rising) or 'no speed'}, where it has a second "
        "maximum at high E_rot/E_tot.",
    )


def _rises(data: xr.Dataset, settings: Settings) -> list[float]:
    """Return the largest rise of the density of E_rot/E_tot between bins at each speed, in its errors."""
    windows = in_windows(data["impact_velocity"], settings.speed_windows)
    found = []
    for k in range(windows.cells):
        one = windows.only(windows.cell == k)
        fraction = one.of(data["rotational_fraction"])
        if fraction.size == 0:
            found.append(float("nan"))
            continue
        label = (fraction / np.quantile(fraction, 0.99) * DENSITY_BINS).astype(np.intp)
        share = one.shares(np.minimum(label, DENSITY_BINS), DENSITY_BINS + 1)
        found.append(float(max(share.take(slice(0, DENSITY_BINS)).steps())))
    return found
