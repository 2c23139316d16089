"""The materials of two bodies that touch each other."""

from __future__ import annotations

from restitution.laws import CollisionLaw, Law, Viscoelastic


def between(law: CollisionLaw, mass_ratio: float = 1.0) -> CollisionLaw:
    """Return the law of two spheres of a material, instead of one sphere and a rigid plane.

    Hertz' ρ/m is (4/3)√R Y/((1 - ν²) m) of the sphere on the plane, and half of it with R_eff and m_eff of
    two spheres, the second `mass_ratio`^(1/3) times as large as the first. β ∝ A(ρ/m)^(2/5).
    """
    if not isinstance(law, Law) or not isinstance(law.normal, Viscoelastic):
        return law
    own = law.normal.model_dump()
    size = mass_ratio ** (1.0 / 3.0)
    softer = 0.5 * (size / (1.0 + size)) ** 0.5 * (1.0 + mass_ratio) / mass_ratio
    normal = Viscoelastic(**own | {"dissipation": own["dissipation"] * softer**0.4})
    return law.model_copy(update={"normal": normal})
