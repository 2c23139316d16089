"""The standard error of times that came without one, apart from the scatter of ε itself."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from restitution._internal.text import digits, with_error
from restitution.experiment.flight.chain import Measured, joined

DECIDED = 2.71
"""Twice the logarithm of a ratio of likelihoods that a variance of zero exceeds in 5 of 100 cases."""
_FEWEST = 4
"""Differences beyond the law that are needed to tell two variances apart."""
_SHARES = np.linspace(0.0, 1.0, 1001) ** 2  # evenly in the scatter


@dataclass(frozen=True)
class Separation:
    """Two causes of scatter: errors of the times, and ε itself.

    Attributes
    ----------
    timing : float
        Standard error of the times in s; 0 where the coefficients do not show one.
    scatter : float or "fit"
        That of ε itself with which a law is to be fitted. Where none is shown it is what is likely, by the
        mean square over the likelihood: with none the errors of the law would be far too small.
    words : str
        A sentence that says what is known of the two.
    """

    timing: float
    scatter: float | Literal["fit"]
    words: str


KNOWN = Separation(0.0, 0.0, "")
"""Where the times came with their errors."""


def separation(experiments: list[Measured]) -> Separation:
    """Separate errors of times that came without an uncertainty from a scatter of ε.

    It is done by restricted likelihood, beside a law ε = a + b ln v. The first impact after a drop depends on
    its height and on g, and is left out.

    A time enters three coefficients, with alternating signs and the more the shorter the flights; the
    scatter of ε is independent from one to the next and the same at all speeds. In the space left by a and
    b, and in the eigenvectors of A = (∂ε/∂t)(∂ε/∂t)ᵀ there, the variance of component k is s² λ_k + σ², of
    which the share of σ² is varied and the sum is the most likely one.
    """

    def told(words: str, timing: float = 0.0, scatter: float | Literal["fit"] = "fit") -> Separation:
        return Separation(timing, scatter, f"The times came without an uncertainty; {words}.")

    links = joined(experiments, None)
    ratio = links.after / links.before
    times, drops = ratio.size, slice(-len(experiments), None)
    known = np.isfinite(ratio) & ~np.any(links.before_by[:, drops], axis=1)
    speed, ratio = links.before[known], ratio[known]
    slopes = links.after_by[known, :times] - ratio[:, None] * links.before_by[known, :times]
    law = np.stack([np.ones_like(speed), np.log(speed)], axis=1)
    free = np.linalg.qr(law, mode="complete")[0][:, 2:]
    number = free.shape[1]
    if number < _FEWEST:
        return told(f"{ratio.size} coefficients do not separate their errors from a scatter of ε")
    reduced = free.T @ (slopes / speed[:, None])
    eigenvalues, vectors = np.linalg.eigh(reduced @ reduced.T)
    mean = float(eigenvalues.mean())
    components = vectors.T @ free.T @ ratio
    relative = (1.0 - _SHARES[:, None]) * eigenvalues / mean + _SHARES[:, None]
    total = np.mean(components**2 / relative, axis=1)
    if not total.min() > 0.0:
        return told("the coefficients do not scatter")
    likelihood = -0.5 * (number * np.log(total) + np.sum(np.log(relative), axis=1))
    timing, scatter = np.sqrt((1.0 - _SHARES) * total / mean), np.sqrt(_SHARES * total)
    best = int(np.argmax(likelihood))
    possible = 2.0 * (likelihood[best] - likelihood) < DECIDED
    timed, scatters = not possible[-1], not possible[0]
    most_timing, most_scatter = 1e6 * float(timing[possible].max()), float(scatter[possible].max())
    if timed and scatters:
        slopes = np.stack([2.0 * timing[best] * eigenvalues, np.full(number, 2.0 * scatter[best])])
        slopes /= timing[best] ** 2 * eigenvalues + scatter[best] ** 2
        error = float(np.sqrt(np.linalg.inv(0.5 * slopes @ slopes.T)[0, 0]))
        found = _microseconds(timing[best], error)
        words = f"their standard error, fitted together with a scatter of ε, is {found}"
        return told(words, float(timing[best]))
    if timed:
        error = float(timing[best] / np.sqrt(2.0 * number))
        weights = np.exp(likelihood - likelihood[best])
        likely = float(np.sqrt(np.average(scatter**2, weights=weights)))
        words = (
            f"their standard error, fitted to the scatter of the coefficients, is "
            f"{_microseconds(timing[best], error)}, and ε itself scatters by less than "
            f"{digits(most_scatter)} (95 %)"
        )
        return told(words, float(timing[best]), likely)
    if scatters:
        return told(f"ε itself scatters, and the times err by less than {digits(most_timing)} µs (95 %)")
    return told(
        f"the scatter of the coefficients may be that of ε, up to {digits(most_scatter)}, or that of "
        f"times with a standard error of up to {digits(most_timing)} µs: {ratio.size} coefficients do not "
        "separate the two"
    )


def _microseconds(timing: float, error: float) -> str:
    return f"{with_error(1e6 * timing, 1e6 * error)} µs"
