"""The laws of the core's table, and their base: the normal coefficient, and how a law is written down."""

from abc import abstractmethod
from functools import cached_property
from typing import Annotated, Any, Literal

from pydantic import Field

from restitution import _core
from restitution._internal.described import Described
from restitution._internal.parameters import Allowed, Number, ParameterError, Parameters, wrong
from restitution.laws._materials import Material, NormalCoefficient, Scattered

Friction = Annotated[Number, Field(ge=0, le=_core.MOST_FRICTION)]
"""μ; the bound keeps products of it finite, and nothing slips long before."""
Hypothesis = Literal["stronge", "poisson", "newton"]


class CollisionLaw(Parameters):
    """A collision law, of the package or of one's own."""

    @property
    @abstractmethod
    def compiled(self) -> _core.Law:
        """The law as the core knows it."""

    @abstractmethod
    def attributes(self) -> dict[str, Any]:
        """Return what a result says of the law besides its kind, as plain values."""


class Law(Described, CollisionLaw):
    """A collision law of the package: the impulse as a function of the contact velocity.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n, in [0, 1], or a material that gives it for the normal speed at
        which the contact point approaches the plane. A function of one speed in m/s becomes
        `Tabulated.from_function` of it, to 1e-6 up to 100 m/s.
    """

    normal: NormalCoefficient

    @cached_property
    def compiled(self) -> _core.Law:
        """The law as the core knows it, made and checked once."""
        normal = self.normal.compiled if isinstance(self.normal, Material) else self.normal
        return _core.law(type(self).__name__, normal, self._arguments())

    @property
    def constant(self) -> float:
        """ε_n where it is a number.

        Raises
        ------
        ValueError
            If it depends on the speed, or scatters.
        """
        if isinstance(self.normal, Material):
            raise ParameterError(wrong("normal", self.normal, "a number, the same at every impact"))
        return self.normal

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, those of a material after `normal_`, as plain values."""
        normal = self.normal
        return self.model_dump() | (normal.attributes() if isinstance(normal, Material) else {})


def check_steady(law: Law) -> None:
    """Refuse a law whose coefficient scatters, where that has no meaning or is what is sought."""
    if isinstance(law.normal, Scattered):
        raise ParameterError(wrong("law.normal", law.normal, "a coefficient that does not scatter"))


class TangentialRestitution(Law):
    """The paper's law: both components of the contact velocity change by a fixed factor (Eq. 9).

    ``v_n' = -normal * v_n`` and ``v_t' = tangential * v_t`` for the velocity of the contact point.

    ``tangential = 1`` is not frictionless for a body that is not a sphere: keeping the tangential contact
    velocity takes a tangential impulse, which can do positive work and lie outside every friction cone.
    Kinetic energy can grow; it cannot for a sphere, nor where ``tangential = -normal``. Watch
    ``energy_ratio`` in the results.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n at the contact point, in [0, 1], or a material.
    tangential : float, default 1
        Tangential coefficient of restitution ε_t at the contact point, in [-1, 1]. Kinetic theory writes
        β = -ε_t.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.TangentialRestitution(normal=0.98, tangential=1.0)
    """

    tangential: Annotated[Number, Field(ge=-1, le=1)] = 1.0


class Frictionless(Law):
    """An impulse along the plane normal alone, P = (1 + ε_n)|v_n|/K_nn, so that ``v_n' = -normal * v_n``.

    The horizontal velocity of the centre of mass and the angular momentum about the plane normal are
    conserved. Kinetic energy falls by (1 - ε_n²)v_n²/(2K_nn) and cannot grow.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n at the contact point, in [0, 1], or a material.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.Frictionless(normal=0.98)
    """


class Coulomb(Law):
    """Coulomb friction during the impact, with slip that may stop, turn or reverse.

    The impact is followed in the normal impulse (Routh 1860; Wang and Mason, J. Appl. Mech. 59, 635 (1992)):
    in closed form where the slip stays in the vertical plane of the axis, else by an integration to double
    precision. |P_t| <= μ P_n always; the hypotheses differ only where the slip stops or turns during the
    impact.

    Parameters
    ----------
    normal : float, material or callable
        Coefficient of restitution ε_n, in [0, 1], or a material; its meaning depends on the hypothesis.
    friction : float
        Coefficient of friction μ, in [0, 1e100]. 0 is `Frictionless`.
    hypothesis : {"stronge", "poisson", "newton"}, default "stronge"
        When the impact is over. "stronge": the normal force has given back ε_n² of the work that it took
        (Proc. R. Soc. Lond. A 431, 169 (1990)). "poisson": the normal impulse of restitution is ε_n times
        that of compression. "newton": ``v_n' = -normal * v_n``. Kinetic energy cannot grow with the first
        two; with Newton's it can, where the slip stops or reverses.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.Coulomb(normal=0.9, friction=0.3)
    """

    friction: Friction
    hypothesis: Annotated[Hypothesis, Allowed("'stronge', 'poisson' or 'newton'")] = "stronge"


class ChatterjeeRuina(Law):
    """The algebraic law of Chatterjee and Ruina, J. Appl. Mech. 65, 939 (1998).

    P = (1 + e)P_I + κ(P_II - P_I), with P_I the impulse of a frictionless and P_II that of a sticking plastic
    impact, and κ = 1 + e_t or, where that lies outside the friction cone |P_t| <= μ P_n, the κ at which P is
    on it. ``v_n' = -normal * v_n`` always, and kinetic energy cannot grow.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient e, in [0, 1], or a material.
    tangential : float
        Tangential coefficient e_t, in [-1, 1]: -1 is frictionless, 0 sticks, 1 reverses the slip. For a
        sphere it is -ε_t.
    friction : float
        Coefficient of friction μ, in [0, 1e100].

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.ChatterjeeRuina(normal=0.9, tangential=0.0, friction=0.3)
    """

    tangential: Annotated[Number, Field(ge=-1, le=1)]
    friction: Friction
