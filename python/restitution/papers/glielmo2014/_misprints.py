"""Misprints in the paper: formulas that disagree with its own model.

The other formulas (Eqs. 1, 4, 5, 7–13, 15–17, 20, 22, A1–A4, A6, A8) are right as printed.
"""

from restitution.papers.glielmo2014 import _checks as checks
from restitution.papers.misprints import Misprint

MISPRINTS = (
    Misprint(
        equation="2, 3",
        kind="caveat",
        printed="Â(t) turns by the angle ωt about ω",
        corrected="Â(t) = D(t − τᵢ) Â(τᵢ), where D turns by the angle ω(t − τᵢ) about ω",
        proof="With ω = 0, Eq. 3 is the unit matrix, so that every body released from rest would stand "
        "upright; Sec. III releases it at random orientation. The turn starts at τᵢ, from the "
        "orientation at τᵢ.",
        quantity="cos θ at the first impact, released from rest at θ = 60°",
        check=checks.released_axis,
    ),
    Misprint(
        equation="3",
        kind="caveat",
        printed="ω is constant in flight",
        corrected="the angular momentum Λ is; the symmetry axis turns about Λ at the rate |Λ|/J_xx, and ω is "
        "constant only where it is perpendicular to the axis",
        proof="Without torque Λ = Ĵω is constant. If ω were constant too, the body's turn about ω would turn "
        "Λ with it, unless Λ is parallel to ω. From rest, ω stays perpendicular to the axis under the "
        "paper's law, so that the paper's results are not touched.",
        quantity="e_z of the axis after 0.1 s, L = 2R, from e = (1, 0, 0), ω = (10, −10, 0) rad/s",
        check=checks.spinning_flight,
    ),
    Misprint(
        equation="6",
        kind="caveat",
        printed="r_c = Âr − (0, 0, R)",
        corrected="r_c = ±Âr − (0, 0, R), with − where the sphere at −r touches (second line of Eq. 2)",
        proof="The contact point lies in the plane. With the other sphere touching, [r_G − Âr]_z = R, so that"
        " the printed r_G + r_c is 2[Âr]_z above it.",
        quantity="height of the contact point in R, L = 2R, sphere at −r touching at θ = 60°",
        check=checks.contact_height,
    ),
    Misprint(
        equation="14",
        kind="misprint",
        printed="P = +m(1 + ε_n) (v_G·n + …)/(…) (…)",
        corrected="P = −m(1 + ε_n) (v_G·n + …)/(…) (…)",
        proof="The bracket is v_c·n, negative in an approach, and the last component is positive: as printed,"
        " the plane would pull. Eq. 15 follows from Eq. 13 only with the minus sign.",
        quantity="P·n/(m|v_G|) from rest, L = 2R, ε_n = 0.4, θ = 60°",
        check=checks.normal_impulse,
    ),
    Misprint(
        equation="18",
        kind="misprint",
        printed="P(cos θ ≤ s) = 1 − {P(θ ∈ [0, arccos s]) + P(θ ∈ [π − arccos s, π])} = 1 − (1/π) arccos s",
        corrected="P(|cos θ| ≤ s) = 1 − {…} = 1 − (2/π) arccos s, 0 ≤ s ≤ 1",
        proof="Each of the two intervals in the braces has length arccos s, so the sum is (2/π) arccos s. "
        "They are the angles with |cos θ| > s: the lower sphere touches, and only |cos θ| counts.",
        quantity="P(|cos θ| ≤ 1/2)",
        check=checks.cumulative_probability,
    ),
    Misprint(
        equation="19",
        kind="caveat",
        printed="p(s) = 1/(π√(1 − s²))",
        corrected="p(s) = 2/(π√(1 − s²)), 0 ≤ s < 1",
        proof="The printed density is that of cos θ on −1 < s < 1, where it integrates to 1. Eq. 17 holds, "
        "and has one inverse, on 0 ≤ s ≤ 1, for |cos θ|, which is what the braces of Eq. 18 are about: "
        "there it integrates to 1/2.",
        quantity="∫ p(s) ds over 0 ≤ s ≤ 1",
        check=checks.total_probability,
    ),
    Misprint(
        equation="21",
        kind="misprint",
        printed="p(s) = {2Rf + [½k(4J_xx/m + L²) + 4R²(2s − ε_n + 1)]} / {π f kL √(1 − […]²)}",
        corrected="p(s) = 2{2Rf + [½k(4J_xx/m + L²) + 2R²(2s − ε_n + 1)]} / {π f kL √(1 − […]²)}, "
        "h(0) ≤ s < ε_n",
        proof="h⁻¹(s) = [2R(s − ε_n) + f(s)]/(kL), and df/ds = [½k(4J_xx/m + L²) + 2R²(2s − ε_n + 1)]/f by "
        "Eq. 22. The factor 2 in front is that of Eq. 19. For L = 2R and ε_n = 0.4 the printed density "
        "integrates to 0.580.",
        quantity="P(ε < 0), L = 2R, ε_n = 0.4",
        check=checks.negative_restitution,
    ),
    Misprint(
        equation="A5",
        kind="misprint",
        printed="J_zz = πρ(8/15 R⁵ + 1/2 R⁴L − 1/12 R²L³ + 1/180 L⁵)",
        corrected="J_zz = πρ(8/15 R⁵ + 1/2 R⁴L − 1/12 R²L³ + 1/160 L⁵)",
        proof="The last term of πρ∫ϱ⁴dz is L⁵/(5·2⁵). At L = 2R, J_zz must be that of two touching spheres.",
        quantity="J_zz/(πρR⁵) at L = 2R",
        check=checks.axial_inertia,
    ),
    Misprint(
        equation="A7",
        kind="misprint",
        printed="J_xx = ρπ ∫ (½R² − ⅛L²)² + (2Lz² − ½L³)z + (2R² + ½L²)z² + 2Lz³ − 3z⁴ dz",
        corrected="J_xx = ½ρπ ∫ [(R² − ¼L²)² + (2LR² − ½L³)z + (2R² + ½L²)z² + 2Lz³ − 3z⁴] dz",
        proof="Twice the integrand of Eq. A6 is ½ϱ⁴ + 2z²ϱ², which is half the bracket of the corrected "
        "formula: the factor ½, the square and 2LR² (printed as 2Lz²) must be corrected. Eq. A8 is the "
        "integral of Eq. A6, not of Eq. A7 as printed.",
        quantity="J_xx/(πρR⁵) at L = 2R",
        check=checks.transverse_inertia,
    ),
)
"""In the order of the paper."""
