"""The distribution of ε at the first impact from rest of a sphere with asperities of equal height."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from restitution._internal.parameters import ParameterError, wrong
from restitution.analytic._branched import Branch, BranchedFirstImpact
from restitution.analytic._frozen import Values, cosine_of, scalar
from restitution.analytic._normal import coefficient
from restitution.analytic._orientation import Floats, Tilt
from restitution.bodies import RoughSphere

_FARTHEST = 14.0
"""Angles beyond this many times 2/√N are left out of sums: they have the probability exp(-196)."""


@dataclass(frozen=True)
class ContactTilt(Tilt):
    """Angle a of the contact of a sphere with N asperities, where one of them touches: docs/rough.md (1)."""

    asperities: int

    def below(self, theta: ArrayLike) -> Floats:
        return np.asarray(self._nearer(np.asarray(theta, dtype=np.float64)) / self._nearer(self.limit))

    def density(self, theta: ArrayLike) -> Floats:
        angle = np.asarray(theta, dtype=np.float64)
        none = np.exp((self.asperities - 1) * _log_farther(angle))
        return np.asarray(0.5 * self.asperities * none * np.sin(angle) / self._nearer(self.limit))

    def quantile(self, share: Floats) -> Floats:
        rest = np.log1p(-share * self._nearer(self.limit))
        theta: Floats = 2.0 * np.arcsin(np.sqrt(-np.expm1(rest / self.asperities)))
        return theta

    @property
    def edges(self) -> Floats:
        edges: Floats = 2.0 / np.sqrt(self.asperities) * np.arange(1.0, _FARTHEST + 1.0)
        return edges

    def _nearer(self, theta: Floats | float) -> Floats:
        """Return the probability that an asperity is nearer to the lowest point than a."""
        return np.asarray(-np.expm1(self.asperities * _log_farther(theta)))


def _log_farther(theta: Floats | float) -> Floats:
    """Return the logarithm of the probability that one asperity is farther from the lowest point than a."""
    return np.asarray(np.log1p(-(np.sin(0.5 * theta) ** 2)))


@dataclass(frozen=True)
class RoughFirstImpact(BranchedFirstImpact):
    """Distribution of ε of a sphere with equal asperities; make it with `first_impact`.

    Where an asperity touches, at the angle a, ε(a) is that of any lever arm. The sphere itself touches with a
    probability of its own, (3) of docs/rough.md, and then ε = ε_n: ``cdf`` has a step there, and ``pdf`` is
    the density of the rest. ``cos_theta`` is the cosine of a.
    """

    body: RoughSphere

    def __repr__(self) -> str:
        """Leave out the seed, on which nothing depends."""
        return super().__repr__().replace(f", seed={self.body.seed!r})", ", any surface)", 1)

    @cached_property
    def _tilt(self) -> ContactTilt:
        return ContactTilt("isotropic", self._curve.limit, self.body.asperities)

    @cached_property
    def _sphere(self) -> float:
        """Probability that the sphere itself touches."""
        return float(np.exp(self.body.asperities * _log_farther(self._curve.limit)))

    @cached_property
    def _bounce(self) -> float:
        """ε where the sphere itself touches."""
        squared = np.float64(self.fall.squared_speed(self.body.radius))
        return float(coefficient(self.law.normal, squared, float(np.sqrt(squared))))

    def support(self) -> tuple[float, float]:
        low, high = super().support()
        return min(low, self._bounce), max(high, self._bounce)

    def restitution(self, cos_theta: ArrayLike) -> Values:
        theta = np.arccos(cosine_of(cos_theta))
        return scalar(np.where(theta <= self._curve.limit, self._curve.restitution(theta), np.nan))

    def at(self, normal: ArrayLike) -> Values:
        """Raise a ValueError: the distribution is that over spheres whose asperities are not given."""
        raise ParameterError(wrong("body", self.body, "one whose contact follows from its attitude"))

    def entropy(self) -> float:
        """Return the differential entropy: -inf, because one value of ε has a probability of its own."""
        return super().entropy() if self._sphere == 0.0 else -np.inf

    def _density(self, x: Floats, without: Branch | None = None) -> Floats:
        return (1.0 - self._sphere) * super()._density(x, without)

    def _probability(self, x: Floats, *, above: bool) -> Floats:
        step = x < self._bounce if above else x >= self._bounce
        return (1.0 - self._sphere) * super()._probability(x, above=above) + self._sphere * step

    def _drawn(self, uniform: Floats) -> Values:
        share = uniform / (1.0 - self._sphere)
        drawn = self._curve.restitution(self._tilt.quantile(np.minimum(share, 1.0)))
        return scalar(np.where(share < 1.0, drawn, self._bounce))

    def _expected(
        self, func: Callable[[float], float], low: float, high: float, options: dict[str, Any]
    ) -> tuple[float, float]:
        total, part = super()._expected(func, low, high, options)
        itself = self._sphere if low <= self._bounce <= high else 0.0
        rest = 1.0 - self._sphere
        return rest * total + (itself * func(self._bounce) if itself else 0.0), rest * part + itself

    def _mean_of(self, polynomial: Callable[[Floats], Floats], order: int) -> float:
        itself = float(polynomial(np.array([self._bounce]))[0])
        return (1.0 - self._sphere) * super()._mean_of(polynomial, order) + self._sphere * itself
