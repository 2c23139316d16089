"""Every misprint of the paper that is on record is proved with exact algebra, and its numbers checked."""

from itertools import combinations
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

import restitution as rs
from restitution.analytic import first_impact
from restitution.papers.glielmo2014._misprints import MISPRINTS, printed_density
from restitution.papers.paper import Misprint

R, L, m, j, j_z, k, z = sp.symbols("R L m j j_z k z", positive=True)  # j = J_xx/m, j_z = J_zz/m, k = 1 + ε_n
s = sp.symbols("s", real=True)
RECORDS = {misprint.equation: misprint for misprint in MISPRINTS}
FIG_9 = rs.Dumbbell(radius=1.0, separation=2.0), rs.TangentialRestitution(normal=0.4)


def over_the_upper_half(integrand: Any) -> Any:
    return sp.expand(sp.integrate(sp.expand(integrand), (z, 0, R + L / 2)))


RHO_2 = R**2 - (z - L / 2) ** 2  # A2


def test_the_records_can_be_shown() -> None:
    """Plain text in the order of the paper, each label once."""
    assert list(RECORDS) == ["2, 3", "3", "6", "14", "18", "19", "21", "A5", "A7"]
    assert [r.kind for r in MISPRINTS] == [
        *["caveat"] * 3,
        "misprint",
        "misprint",
        "caveat",
        *["misprint"] * 3,
    ]
    for record in MISPRINTS:
        for text in (record.printed, record.corrected, record.proof, record.quantity):
            assert text == " ".join(text.split()) != ""
            assert not set(text) & set("\\$")


@pytest.mark.parametrize("record", MISPRINTS, ids=lambda record: str(record.equation))
def test_the_corrected_formula_agrees_with_the_independent_value(record: Misprint) -> None:
    """To 1e-12, where the printed one is off by at least 1e-2; plain floats, fit for a report."""
    check = record.check()
    assert all(type(value) is float for value in check)
    assert check.right == pytest.approx(check.independent, abs=1e-12)
    assert abs(check.printed - check.independent) > 1e-2


@pytest.mark.parametrize(
    ("equation", "printed", "right"),
    [
        ("2, 3", 1, sp.Rational(1, 2)),
        ("6", 1, 0),
        ("14", -sp.Rational(511, 440), sp.Rational(511, 440)),
        ("18", sp.Rational(2, 3), sp.Rational(1, 3)),
        ("19", sp.Rational(1, 2), 1),
        ("A5", sp.Rational(47, 45), sp.Rational(16, 15)),
        ("A7", sp.Rational(232, 15), sp.Rational(56, 15)),
    ],
)
def test_the_values_are_exact_where_they_are_rational(equation: str, printed: Any, right: Any) -> None:
    check = RECORDS[equation].check()
    assert check.printed == pytest.approx(float(printed), abs=1e-13)
    assert check.right == pytest.approx(float(right), abs=1e-13)


def test_a5_has_160() -> None:
    """The integral of ϱ⁴ over the upper half; the mass, A3, is right."""
    correct = sp.Rational(8, 15) * R**5 + R**4 * L / 2 - R**2 * L**3 / 12
    assert over_the_upper_half(2 * RHO_2) == sp.Rational(4, 3) * R**3 + R**2 * L - L**3 / 12  # A3
    assert over_the_upper_half(RHO_2**2) == correct + L**5 / 160
    assert over_the_upper_half(RHO_2**2) != correct + L**5 / 180


def test_a7_needs_all_three_repairs() -> None:
    """A6 is A8; A7 as printed is neither, nor is it with one or two of its three errors mended."""
    integrand = 2 * (RHO_2**2 / 4 + z**2 * RHO_2)  # A6
    correct = sp.Rational(8, 15) * R**5 + sp.Rational(3, 4) * R**4 * L + R**3 * L**2 / 3
    correct += R**2 * L**3 / 24 + L**5 / 960  # A8
    assert over_the_upper_half(integrand) == sp.expand(correct)

    def a7(repairs: tuple[str, ...]) -> Any:
        square = (R**2 - L**2 / 4) ** 2 if "square" in repairs else (R**2 / 2 - L**2 / 8) ** 2
        linear = (2 * L * (R**2 if "2LR²" in repairs else z**2) - L**3 / 2) * z
        bracket = square + linear + (2 * R**2 + L**2 / 2) * z**2 + 2 * L * z**3 - 3 * z**4
        return bracket / 2 if "half" in repairs else bracket

    repairs = ("half", "square", "2LR²")
    assert sp.expand(a7(repairs) - integrand) == 0
    for number in range(3):
        for some in combinations(repairs, number):
            assert over_the_upper_half(a7(some)) != sp.expand(correct)


def general_contact() -> tuple[Any, Any, Any, Any]:
    """Axis towards the lower sphere, any unit vector; r_c (16), ω and v_G in three dimensions."""
    a, b, c = sp.symbols("a b c", real=True)
    axis = sp.Matrix([a, b, -c])
    contact = L / 2 * axis - sp.Matrix([0, 0, R])
    return (
        axis,
        contact,
        sp.Matrix(sp.symbols("omega_x:z", real=True)),
        sp.Matrix(sp.symbols("v_x:z", real=True)),
    )


def test_14_has_a_minus_and_15_and_17_follow() -> None:
    """With the minus, P of Eq. 14 solves Eq. 10 with ε_t = 1, for every orientation, spin and velocity."""
    axis, contact, spin, velocity = general_contact()
    c = -axis[2]
    up = sp.Matrix([0, 0, 1])
    x, y, height = contact
    approach = velocity[2] + spin[0] * y - spin[1] * x
    assert sp.expand((velocity + spin.cross(contact))[2] - approach) == 0  # v_c·n, Eqs. 7 and 8
    square = contact.dot(contact)
    printed = m * k * approach / (square + j) * sp.Matrix([x * height, y * height, j + height**2])
    inverse = ((sp.eye(3) - axis * axis.T) / j + axis * axis.T / j_z) / m

    def on_the_sphere(value: Any) -> Any:  # 0 if the value is 0 for every unit vector
        return sp.rem(sp.numer(sp.together(value)), sp.expand(axis.dot(axis) - 1), c)

    def misfit(impulse: Any) -> Any:  # of Eq. 10
        turned = (inverse * contact.cross(impulse)).cross(contact)
        return (-k * approach * up - impulse / m - turned).applyfunc(on_the_sphere)

    assert misfit(-printed) == sp.zeros(3, 1)
    assert misfit(printed) != sp.zeros(3, 1)

    restitution = -1 - (-printed)[2] / (m * velocity[2])  # Eq. 13
    eq_15 = -1 + k / velocity[2] * approach * (j + height**2) / (square + j)
    assert sp.simplify(restitution - eq_15) == 0
    eq_17 = -1 + k * (4 * j + L**2 * c**2 + 4 * L * R * c + 4 * R**2) / (
        4 * j + 4 * L * R * c + 4 * R**2 + L**2
    )
    assert on_the_sphere(eq_15.subs(dict.fromkeys(spin, 0)) - eq_17) == 0


def test_18_and_19_count_both_intervals() -> None:
    """θ uniform in [0, π): |cos θ| > s on [0, arccos s] and on [π - arccos s, π], as in the braces."""
    level = sp.symbols("s", positive=True)
    braces = sp.acos(level) / sp.pi + (sp.pi - (sp.pi - sp.acos(level))) / sp.pi
    assert sp.simplify(1 - braces - (1 - 2 * sp.acos(level) / sp.pi)) == 0
    density = sp.diff(1 - braces, level)
    assert sp.simplify(density - 2 / (sp.pi * sp.sqrt(1 - level**2))) == 0
    assert sp.integrate(density, (level, 0, 1)) == 1
    assert sp.integrate(1 / (sp.pi * sp.sqrt(1 - level**2)), (level, 0, 1)) == sp.Rational(1, 2)  # 19


def test_21_has_twice_2r2_where_22_is_right() -> None:
    """h⁻¹ with f of Eq. 22 inverts Eq. 17, runs from 0 to 1, and Eq. 20 gives the corrected Eq. 21."""
    normal = k - 1
    f_squared = 4 * (s - normal) * ((s + 1) * R**2 + k * j) + k * (s + 1) * L**2  # 22
    f = sp.symbols("f", positive=True)
    c = (2 * R * (s - normal) + f) / (k * L)
    top, bottom = 4 * j + L**2 * c**2 + 4 * L * R * c + 4 * R**2, 4 * j + 4 * L * R * c + 4 * R**2 + L**2
    misfit = sp.expand(sp.numer(sp.together(-1 + k * top / bottom - s)))
    assert sp.rem(misfit, sp.expand(f**2 - f_squared), f) == 0  # h(h⁻¹(s)) = s

    inverse = c.subs(f, sp.sqrt(f_squared))
    lowest = -1 + k * (4 * j + 4 * R**2) / (4 * j + 4 * R**2 + L**2)
    assert sp.simplify(inverse.subs(s, normal)) == 1
    assert sp.simplify(f_squared.subs(s, lowest) - (2 * R * (lowest - normal)) ** 2) == 0  # h⁻¹(h(0)) = 0

    def eq_21(square: Any, factor: int) -> Any:
        bracket = k * (4 * j + L**2) / 2 + square * (2 * s - normal + 1)
        return factor * (2 * R * f + bracket) / (sp.pi * f * k * L * sp.sqrt(1 - c**2))

    slope = (2 * R + sp.diff(f_squared, s) / (2 * f)) / (k * L)  # dh⁻¹/ds
    density = 2 / (sp.pi * sp.sqrt(1 - c**2)) * slope  # 20 with the corrected 19
    assert sp.simplify(density - eq_21(2 * R**2, 2)) == 0
    for square, factor in ((4 * R**2, 1), (2 * R**2, 1), (4 * R**2, 2)):
        assert sp.simplify(density - eq_21(square, factor)) != 0


def test_3_holds_only_across_the_axis() -> None:
    """With ω constant, Λ would change unless ω ⟂ e or ω ∥ e; but e turns about Λ, at |Λ|/J_xx."""
    axis, omega = (sp.Matrix(sp.symbols(f"{name}_x:z", real=True)) for name in ("e", "omega"))
    momentum = j * omega + (j_z - j) * omega.dot(axis) * axis  # Λ/m
    turn = omega.cross(axis)  # de/dt
    change = (j_z - j) * (omega.dot(turn) * axis + omega.dot(axis) * turn)  # dΛ/dt with ω constant
    assert (change - (j_z - j) * omega.dot(axis) * turn).applyfunc(sp.expand) == sp.zeros(3, 1)
    assert (turn - (momentum / j).cross(axis)).applyfunc(sp.expand) == sp.zeros(3, 1)


def test_3_at_rest_is_the_unit_matrix() -> None:
    """Eq. 3 at ωt = 0, for every e_ω: a body released at rest at an angle cannot be described by it alone."""
    unit = sp.Matrix(sp.symbols("e_x:z", real=True))
    skew = sp.Matrix([[0, -unit[2], unit[1]], [unit[2], 0, -unit[0]], [-unit[1], unit[0], 0]])  # 4
    angle = sp.symbols("angle", real=True)
    turn = sp.eye(3) * sp.cos(angle) + unit * unit.T * (1 - sp.cos(angle)) + skew * sp.sin(angle)
    assert turn.subs(angle, 0) == sp.eye(3)


def test_6_puts_the_contact_point_of_the_other_sphere_above_the_plane() -> None:
    """With Eq. 2, r_G + r_c must have the height 0 for either sphere."""
    lift, centre = sp.symbols("lift centre", real=True)  # [Âr]_z and the height of r_G
    first, other = sp.solve(centre + lift - R, centre)[0], sp.solve(centre - lift - R, centre)[0]
    assert sp.expand(first + lift - R) == 0
    assert sp.expand(other + lift - R) == 2 * lift
    assert sp.expand(other - lift - R) == 0


def test_the_printed_density_is_the_printed_formula() -> None:
    """Eqs. 21 and 22 letter for letter, thirty digits, L = 2R = 2, J_xx/m = 7/5, ε_n = 0.4; its integral."""
    mp = mpmath.MPContext()
    mp.dps = 30

    def literal(value: Any) -> Any:
        e, k, inertia, length = mp.mpf("0.4"), mp.mpf("1.4"), mp.mpf("1.4"), 2
        f = mp.sqrt(4 * (value - e) * ((value + 1) + k * inertia) + k * (value + 1) * length**2)
        top = 2 * f + (k * (4 * inertia + length**2) / 2 + 4 * (2 * value - e + 1))
        return top / (mp.pi * f * k * length * mp.sqrt(1 - ((2 * (value - e) + f) / (k * length)) ** 2))

    low, high = first_impact(*FIG_9).support()
    values = np.linspace(low, high, 12)[:-1]
    # 1 - c² loses a digit; at the lower end c, a difference of equal numbers, matters only in its square
    np.testing.assert_allclose(
        printed_density(values, *FIG_9), [float(literal(value)) for value in values], rtol=1e-14
    )
    exact_low = -1 + mp.mpf("1.4") * mp.mpf("9.6") / mp.mpf("13.6")
    total = mp.quadts(literal, [exact_low, mp.mpf("0.2"), mp.mpf("0.4")])
    assert f"integrates to {float(total):.3f}." in RECORDS["21"].proof
    negative = mp.quadgl(literal, [exact_low, 0])
    assert RECORDS["21"].check().printed == pytest.approx(float(negative), abs=1e-14)


def test_the_printed_density_keeps_to_the_support() -> None:
    """0 outside, infinite at ε_n, nan for nan, any shape; size and density of the body do not matter."""
    low, high = first_impact(*FIG_9).support()
    density = printed_density([[low - 1e-9, high + 1e-9], [high, np.nan]], *FIG_9)
    np.testing.assert_array_equal(density, [[0, 0], [np.inf, np.nan]])
    small = rs.Dumbbell(radius=3e-3, separation=6e-3, density=7850.0)
    np.testing.assert_allclose(
        printed_density([0.1, 0.3], small, FIG_9[1]), printed_density([0.1, 0.3], *FIG_9), rtol=1e-13
    )
