"""Orientation of the axis at the first impact: the law of c = |cos θ|, θ between axis and plane normal.

The contact is with the lower sphere, so only |cos θ| matters, and it lies in [0, 1] (Eqs. 18 and 19 put it in
[-1, 1]). A law takes and gives c together with sin θ, because 1 - c² loses all digits where c is near 1, and
a probability together with its complement for the same reason.
"""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]
OrientationName: TypeAlias = Literal["uniform-angle", "isotropic"]

QUARTER_TURN = 0.5 * np.pi


class UniformAngle:
    """θ uniform in [0, π), the paper's choice: an axis at random in one vertical plane."""

    entropy = math.log(math.pi / 4.0)  # differential, of c

    def density(self, cosine: Floats, sine: Floats) -> Floats:
        """Return the probability density of c: Eq. 19 with its factor 2 put right."""
        with np.errstate(divide="ignore"):
            return 1.0 / (QUARTER_TURN * sine)

    def below(self, cosine: Floats, sine: Floats) -> Floats:
        """Return the probability that |cos θ| <= c, Eq. 18: 1 - (2/π) arccos c."""
        return np.arctan2(cosine, sine) / QUARTER_TURN

    def above(self, cosine: Floats, sine: Floats) -> Floats:
        """Return the probability that |cos θ| > c."""
        return np.arctan2(sine, cosine) / QUARTER_TURN

    def quantile(self, below: Floats, above: Floats) -> tuple[Floats, Floats]:
        """Return (c, sin θ) where |cos θ| <= c has probability ``below``; ``above = 1 - below``."""
        # sin of the complement, not cos: exactly 0 at the end of the support
        return np.sin(QUARTER_TURN * below), np.sin(QUARTER_TURN * above)


class Isotropic:
    """The axis uniform on the sphere: c uniform on [0, 1]; all as in `UniformAngle`."""

    entropy = 0.0

    def density(self, cosine: Floats, sine: Floats) -> Floats:
        return np.ones_like(cosine)

    def below(self, cosine: Floats, sine: Floats) -> Floats:
        return cosine

    def above(self, cosine: Floats, sine: Floats) -> Floats:
        return sine * sine / (1.0 + cosine)

    def quantile(self, below: Floats, above: Floats) -> tuple[Floats, Floats]:
        return below, np.sqrt(above * (1.0 + below))


Orientation: TypeAlias = UniformAngle | Isotropic
ORIENTATIONS: dict[str, Orientation] = {"uniform-angle": UniformAngle(), "isotropic": Isotropic()}


@dataclass(frozen=True)
class Tilt:
    """The law of the angle θ itself, 0 to ``limit``, for bodies that need not look the same upside down."""

    orientation: OrientationName
    limit: float  # π/2 where θ and π - θ are taken as one, else π

    @property
    def edges(self) -> Floats:
        """Angles between which the density is smooth."""
        return np.empty(0)

    def below(self, theta: ArrayLike) -> Floats:
        """Return the probability of angles up to θ."""
        angle = np.asarray(theta, dtype=np.float64)
        if self.orientation == "uniform-angle":
            return np.asarray(angle / self.limit)
        return np.asarray((np.sin(0.5 * angle) / np.sin(0.5 * self.limit)) ** 2)

    def between(self, low: float, high: float) -> float:
        """Return the probability of angles from low to high."""
        return float(self.below(high) - self.below(low))

    def density(self, theta: ArrayLike) -> Floats:
        """Return the probability density of θ, per rad."""
        angle = np.asarray(theta, dtype=np.float64)
        if self.orientation == "uniform-angle":
            return np.full_like(angle, 1.0 / self.limit)
        return np.asarray(np.sin(angle) / (2.0 * np.sin(0.5 * self.limit) ** 2))

    def quantile(self, share: Floats) -> Floats:
        """Return the angle up to which the probability is ``share``."""
        if self.orientation == "uniform-angle":
            return share * self.limit
        return np.asarray(2.0 * np.arcsin(np.sqrt(share) * np.sin(0.5 * self.limit)))
