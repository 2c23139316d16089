"""Samples that belong to particles: what a bootstrap draws again are particles, never single impacts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from restitution._internal.arrays import check_each, reals
from restitution._internal.parameters import ParameterError, Problem, shown, wrong
from restitution.fit._counts import Counts
from restitution.fit._result import Array, Fit, finite_samples
from restitution.fit.source import Parts, Window, counted, no_window, recorded

MOST_RESAMPLES = 1_000_000
"""Draws of a bootstrap, beyond which nothing is learned."""


@dataclass(frozen=True)
class Clustered:
    """Samples of each particle, ready to be drawn again.

    Parameters
    ----------
    samples : ndarray, shape (n,)
        Sorted by particle.
    start : ndarray of int, shape (particles + 1,)
        Where the samples of each particle start.
    """

    samples: Array
    start: NDArray[np.int64]

    @property
    def number(self) -> int:
        """Particles that have samples."""
        return int(self.start.size - 1)

    def pool(self) -> Array:
        """Return all samples."""
        return self.samples

    def redrawn(self, random: np.random.Generator) -> Array:
        """Draw as many particles with replacement and give their samples."""
        chosen = random.integers(self.number, size=self.number)
        sizes = self.start[chosen + 1] - self.start[chosen]
        offset = np.repeat(self.start[chosen] - np.concatenate([[0], np.cumsum(sizes)[:-1]]), sizes)
        return np.asarray(self.samples[offset + np.arange(offset.size)])

    def following(self, fit: Fit, random: np.random.Generator) -> Clustered:
        """Replace each sample by the quantile of the fit at its rank, at random among equal ones."""
        order = np.lexsort((random.random(self.samples.size), self.samples))
        mapped = np.empty(self.samples.size)
        mapped[order] = fit.distribution.ppf((np.arange(order.size) + 0.5) / order.size)
        return Clustered(mapped, self.start)


@dataclass(frozen=True)
class CountedRuns:
    """Counts of independent runs or blocks of particles, each of which is drawn again as a whole.

    Parameters
    ----------
    edges : ndarray, shape (bins + 1,)
        Of the bins.
    counts : ndarray, shape (runs, bins + 2)
        Of each run, those below and above the bins included.
    """

    edges: Array
    counts: Array

    @property
    def number(self) -> int:
        """Runs."""
        return len(self.counts)

    def pool(self) -> Counts:
        """Return the counts of all particles together."""
        below, *inside, above = self.counts.sum(axis=0)
        return Counts(self.edges, np.array(inside), int(below), int(above))

    def redrawn(self, random: np.random.Generator) -> Counts:
        """Draw as many runs with replacement and give their counts."""
        return CountedRuns(self.edges, self.counts[random.integers(self.number, size=self.number)]).pool()

    def following(self, fit: Fit, _: np.random.Generator) -> CountedRuns:
        """Move the edges of the bins to the ranks that they have in the fit; each bin is filled evenly."""
        one_by_one = np.cumsum(np.pad(self.counts, ((0, 0), (1, 0))), axis=1)
        ranks = one_by_one.sum(axis=0) / self.counts.sum()
        levels = np.concatenate([[0.0], fit.cdf(self.edges), [1.0]])
        moved = [np.rint(np.interp(levels, ranks, numbers)) for numbers in one_by_one]
        return CountedRuns(self.edges, np.diff(moved, axis=1))


def clustered(samples: Parts, clusters: ArrayLike | None, velocity: Window | None) -> Clustered | CountedRuns:
    """Sort samples by particle, or take counts or statistics of independent runs in place of particles.

    The arguments are those of `bootstrap`; without `clusters` every value is a particle of its own. Raises
    ValueError if labels do not match the samples, or there are fewer than two particles or runs.
    """
    several = isinstance(samples, list | tuple) and len(samples) > 0
    if several and isinstance(samples[0], Counts | xr.Dataset):  # type: ignore[index]
        parts = [one if isinstance(one, Counts) else counted(one, velocity) for one in samples]  # type: ignore[arg-type, union-attr]
        if clusters is not None:
            raise ValueError("clusters: must be left out, because counts are drawn again run by run")
        _several(len(parts), "counts")
        if any(not np.array_equal(part.edges, parts[0].edges) for part in parts):
            raise ValueError("counts: must all have the same edges")
        return CountedRuns(parts[0].edges, np.array([part.all for part in parts]))
    if isinstance(samples, Counts) or (isinstance(samples, xr.Dataset) and "restitution_count" in samples):
        raise ValueError(
            "samples: one set of counts, which do not distinguish particles; give those of several "
            "independent runs in a list"
        )
    if isinstance(samples, xr.Dataset):
        if clusters is not None:
            raise ValueError("clusters: a Dataset knows its particles, leave them out")
        values, labels = recorded(samples, velocity)
        x = finite_samples(values)
    else:
        no_window(samples, velocity)
        x = finite_samples(cast(ArrayLike, samples))
        labels = np.arange(x.size) if clusters is None else _labels(clusters)
    if labels.shape != x.shape:
        raise ValueError(f"clusters: {labels.size} values; one for each of the {x.size} samples is needed")
    order = np.argsort(labels, kind="stable")
    _, start = np.unique(labels[order], return_index=True)
    _several(start.size, "clusters")
    return Clustered(x[order], np.append(start, x.size))


def _labels(clusters: ArrayLike) -> NDArray[np.int64]:
    allowed = "whole numbers, one for each sample"
    labels = reals("clusters", clusters, allowed).ravel()
    check_each("clusters", labels, (labels == np.rint(labels)) & (np.abs(labels) < 2.0**63), allowed)
    # As given: doubles do not distinguish neighbours above 2**53.
    return np.asarray(clusters).ravel().astype(np.int64)


def begun(
    family: Callable[..., Fit],
    keywords: dict[str, Any],
    samples: Parts,
    clusters: ArrayLike | None,
    velocity: Window | None,
) -> tuple[Callable[[Any], Fit], Clustered | CountedRuns, Array | Counts, Fit]:
    """Return a family with its keywords, the particles to draw again, their samples, and the fit of these."""
    if callable(family) and keywords:
        family = partial(family, **keywords)
    source = clustered(samples, clusters, velocity)
    pool = source.pool()
    return family, source, pool, fitted_by(family, pool)


def refitted(
    family: Callable[[Any], Fit], source: Clustered | CountedRuns, random: np.random.Generator
) -> tuple[Array | Counts, Fit]:
    """Draw particles again and fit what they have.

    Raises
    ------
    ValueError
        If that cannot be fitted, as when few particles with equal samples are drawn.
    """
    again = source.redrawn(random)
    try:
        return again, fitted_by(family, again)
    except ValueError as error:
        text = f"clusters: {source.number} are too few, some drawn again cannot be fitted ({error})"
        raise ValueError(text) from error


def fitted_by(family: Callable[[Any], Fit], samples: Array | Counts) -> Fit:
    """Fit by `family`, if it can."""
    if not callable(family):
        raise ParameterError(wrong("family", family, "a function from samples to a Fit"))
    try:
        fit = family(samples)
    except ValueError:  # by this package, or by a family for samples that it cannot fit
        raise
    except Exception as error:
        text = f" = {shown(family)} gave {type(error).__name__}: {error}: must be a function to a Fit"
        raise ParameterError(Problem("family", text)) from error
    if not isinstance(fit, Fit):
        raise ParameterError(
            wrong("family", family, f"a function from samples to a Fit; it gave {shown(fit)}")
        )
    return fit


def _several(number: int, name: str) -> None:
    if number < 2:
        raise ValueError(f"{name}: all samples are in one; a standard error needs at least two")
