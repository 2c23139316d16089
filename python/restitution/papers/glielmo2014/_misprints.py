"""Misprints in the paper: formulas that disagree with its own model.

Of each, one quantity is found from the printed formula, from the corrected one, and without either. The other
formulas (Eqs. 1, 4, 5, 7–13, 15–17, 20, 22, A1–A4, A6, A8) are right as printed.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from restitution.analytic import first_impact
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution
from restitution.papers.paper import Check, Misprint

Floats = NDArray[np.float64]

# The paper's own example (Fig. 9), L = 2R. With R = 1 and ρ = 1/π, J is the bracket in Eqs. A5 and A8.
BODY = Dumbbell(radius=1.0, separation=2.0, density=1.0 / np.pi)
LAW = TangentialRestitution(normal=0.4, tangential=1.0)
TILT = np.pi / 3


def printed_density(restitution: ArrayLike, body: Dumbbell, law: TangentialRestitution) -> Floats:
    """Eq. 21 with Eq. 22 as printed, misprints included: to be compared with `restitution.analytic`, no more.

    It is 0 outside the support of Eq. 17, and nan for nan.
    """
    value = np.asarray(restitution, dtype=np.float64)
    low, high = first_impact(body, law).support()
    s = np.clip(value, low, high)
    radius, length, normal = body.radii[0], body.separation, law.constant
    inertia = body.transverse_inertia / body.mass
    k = 1.0 + normal
    f = np.sqrt(
        4.0 * (s - normal) * ((s + 1.0) * radius**2 + k * inertia) + k * (s + 1.0) * length**2
    )  # (22)
    bracket = 0.5 * k * (4.0 * inertia + length**2) + 4.0 * radius**2 * (2.0 * s - normal + 1.0)
    cosine = (2.0 * radius * (s - normal) + f) / (k * length)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    with np.errstate(divide="ignore"):
        density = (2.0 * radius * f + bracket) / (np.pi * f * k * length * sine)  # (21)
    return np.where((value < low) | (value > high), 0.0, density)


def fall(theta: float) -> Floats:
    """Solve Eq. 10, three linear equations, for P/m of a body that arrives at 1 m/s without spin."""
    axis = np.array([np.sin(theta), 0.0, -np.cos(theta)])  # of the lower sphere (Fig. 8, Eq. 16)
    up = np.array([0.0, 0.0, 1.0])
    contact = 0.5 * BODY.separation * axis - BODY.radius * up
    along = np.outer(axis, axis)
    inertia = (BODY.transverse_inertia * (np.eye(3) - along) + BODY.axial_inertia * along) / BODY.mass
    columns = [
        unit + np.cross(np.linalg.solve(inertia, np.cross(contact, unit)), contact) for unit in np.eye(3)
    ]
    return np.asarray(np.linalg.solve(np.transpose(columns), (1.0 + LAW.constant) * up), dtype=np.float64)


def axial_inertia() -> Check:
    """Return J_zz/(πρR⁵) at L = 2R (Eq. A5)."""

    def bracket(divisor: float) -> float:
        return 8 / 15 + 2 / 2 - 2**3 / 12 + 2**5 / divisor

    sphere = 4 / 3
    return Check(bracket(180), bracket(160), 2 * 2 / 5 * sphere)


def transverse_inertia() -> Check:
    """Return J_xx/(πρR⁵) at L = 2R from the integrand of Eq. A7."""
    nodes, weights = np.polynomial.legendre.leggauss(3)  # exact up to degree 5
    z = 1 + nodes  # 0 <= z <= R + L/2
    tail = (2 + 2**2 / 2) * z**2 + 2 * 2 * z**3 - 3 * z**4
    printed = (1 / 2 - 2**2 / 8) ** 2 + (2 * 2 * z**2 - 2**3 / 2) * z + tail
    right = ((1 - 2**2 / 4) ** 2 + (2 * 2 - 2**3 / 2) * z + tail) / 2
    sphere = 4 / 3
    steiner = 2 * sphere * (2 / 5 + 1)
    return Check(float(weights @ printed), float(weights @ right), steiner)


def normal_impulse() -> Check:
    """Return P·n/(m|v_G|) at θ = 60° (Eq. 14)."""
    inertia = BODY.transverse_inertia / BODY.mass
    x, z = BODY.separation / 2 * np.sin(TILT), -BODY.separation / 2 * np.cos(TILT) - BODY.radius  # (16)
    factor = (1 + LAW.constant) * (inertia + z**2) / (x**2 + z**2 + inertia)
    approach = -1.0  # v_G·n
    return Check(float(factor * approach), float(-factor * approach), float(fall(TILT)[2]))


def cumulative_probability() -> Check:
    """Return the probability that |cos θ| <= 1/2 (Eq. 18)."""
    angles = np.pi * (np.arange(300_000) + 0.5) / 300_000
    part = np.arccos(0.5) / np.pi
    return Check(float(1 - part), float(1 - 2 * part), float(np.mean(np.abs(np.cos(angles)) <= 0.5)))


def total_probability() -> Check:
    """Return the integral of Eq. 19 over 0 <= cos θ <= 1."""
    # The weight is (1 - s)^(-1/2).
    integral, _ = quad(lambda s: 1 / np.sqrt(1 + s), 0, 1, weight="alg", wvar=(0, -0.5))
    return Check(integral / np.pi, 2 * integral / np.pi, 1.0)


def negative_restitution() -> Check:
    """Return the probability that ε < 0 for Fig. 9 (Eq. 21)."""
    distribution = first_impact(BODY, LAW)
    low, _ = distribution.support()
    printed, _ = quad(lambda s: float(printed_density(s, BODY, LAW)), low, 0)
    right, _ = quad(lambda s: float(distribution.pdf(s)), low, 0)
    # ε = -1 + P·n/(m|v_G|) (13) falls from ε_n as the axis leans; beyond this angle it is negative.
    zero = brentq(lambda theta: fall(theta)[2] - 1, 0, np.pi / 2, xtol=1e-14)
    return Check(printed, right, 1 - float(zero) / (np.pi / 2))


def spinning_flight() -> Check:
    """Return the height e_z of the axis' end 0.1 s after e = (1, 0, 0), ω = (10, -10, 0) rad/s (Eq. 3)."""
    axis, spin, time = np.array([1.0, 0.0, 0.0]), np.array([10.0, -10.0, 0.0]), 0.1
    inertia = np.array([BODY.axial_inertia, BODY.transverse_inertia, BODY.transverse_inertia])

    def turned(rotation: Floats) -> float:  # (3), (4)
        angle = np.linalg.norm(rotation)
        unit = rotation / angle
        end = axis * np.cos(angle) + unit * (unit @ axis) * (1 - np.cos(angle))
        return float((end + np.cross(unit, axis) * np.sin(angle))[2])

    def euler(_: float, state: Floats) -> Floats:  # spin along the body's axes, and these axes in space
        omega, frame = state[:3], state[3:].reshape(3, 3)
        torque_free = np.cross(inertia * omega, omega) / inertia
        return np.concatenate([torque_free, np.cross(omega @ frame, frame).ravel()])

    start = np.concatenate([spin, np.eye(3).ravel()])
    end = solve_ivp(euler, (0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return Check(turned(spin * time), turned(inertia * spin * time / inertia[1]), float(end[5]))


def released_axis() -> Check:
    """Return the cosine of the axis at the first impact after release from rest at θ = 60° (Eqs. 2, 3)."""
    unit_matrix = np.eye(3)  # (3) at ω = 0
    upright, released = np.array([0.0, 0.0, 1.0]), np.array([np.sin(TILT), 0.0, np.cos(TILT)])
    return Check(float((unit_matrix @ upright)[2]), float((unit_matrix @ released)[2]), 0.5)


def contact_height() -> Check:
    """Return the height of the point r_G + r_c, in R, when the sphere at -r touches at θ = 60° (Eq. 6)."""
    offset = BODY.separation / 2 * np.cos(TILT)
    centre = BODY.radius + offset  # (2), second line
    polar = np.linspace(0, np.pi, 1001)
    lowest = min(np.min(centre + side * offset + BODY.radius * np.cos(polar)) for side in (1, -1))
    return Check(float(centre + offset - BODY.radius), float(centre - offset - BODY.radius), float(lowest))


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
        check=released_axis,
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
        check=spinning_flight,
    ),
    Misprint(
        equation="6",
        kind="caveat",
        printed="r_c = Âr − (0, 0, R)",
        corrected="r_c = ±Âr − (0, 0, R), with − where the sphere at −r touches (second line of Eq. 2)",
        proof="The contact point lies in the plane. With the other sphere touching, [r_G − Âr]_z = R, so that"
        " the printed r_G + r_c is 2[Âr]_z above it.",
        quantity="height of the contact point in R, L = 2R, sphere at −r touching at θ = 60°",
        check=contact_height,
    ),
    Misprint(
        equation="14",
        kind="misprint",
        printed="P = +m(1 + ε_n) (v_G·n + …)/(…) (…)",
        corrected="P = −m(1 + ε_n) (v_G·n + …)/(…) (…)",
        proof="The bracket is v_c·n, negative in an approach, and the last component is positive: as printed,"
        " the plane would pull. Eq. 15 follows from Eq. 13 only with the minus sign.",
        quantity="P·n/(m|v_G|) from rest, L = 2R, ε_n = 0.4, θ = 60°",
        check=normal_impulse,
    ),
    Misprint(
        equation="18",
        kind="misprint",
        printed="P(cos θ ≤ s) = 1 − {P(θ ∈ [0, arccos s]) + P(θ ∈ [π − arccos s, π])} = 1 − (1/π) arccos s",
        corrected="P(|cos θ| ≤ s) = 1 − {…} = 1 − (2/π) arccos s, 0 ≤ s ≤ 1",
        proof="Each of the two intervals in the braces has length arccos s, so the sum is (2/π) arccos s. "
        "They are the angles with |cos θ| > s: the lower sphere touches, and only |cos θ| counts.",
        quantity="P(|cos θ| ≤ 1/2)",
        check=cumulative_probability,
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
        check=total_probability,
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
        check=negative_restitution,
    ),
    Misprint(
        equation="A5",
        kind="misprint",
        printed="J_zz = πρ(8/15 R⁵ + 1/2 R⁴L − 1/12 R²L³ + 1/180 L⁵)",
        corrected="J_zz = πρ(8/15 R⁵ + 1/2 R⁴L − 1/12 R²L³ + 1/160 L⁵)",
        proof="The last term of πρ∫ϱ⁴dz is L⁵/(5·2⁵). At L = 2R, J_zz must be that of two touching spheres.",
        quantity="J_zz/(πρR⁵) at L = 2R",
        check=axial_inertia,
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
        check=transverse_inertia,
    ),
)
"""In the order of the paper."""
