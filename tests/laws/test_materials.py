"""The materials: their formulas against the physics they stand for, and the engine against both."""

import copy
import math
import pickle
from typing import Any

import mpmath
import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.special import beta

import restitution as rs
from restitution.drop.toml import table_of

STEEL: dict[str, float] = {
    "young_modulus": 2.1e11,
    "poisson_ratio": 0.3,
    "dissipation": 1e-6,
    "density": 7850.0,
    "radius": 5e-3,
}
SPEEDS = np.concatenate([[0.0, 5e-324, 1e-300, 1e-30], np.geomspace(1e-12, 1e6, 4001), [1e300]])


def by_newtons_equation(speed: float) -> float:
    """ε_n of the sphere of `STEEL` from its equation of motion in SI units, until the force would attract."""
    r, nu = STEEL["radius"], STEEL["poisson_ratio"]
    mass = 4 / 3 * math.pi * r**3 * STEEL["density"]
    stiffness = 4 / 3 * math.sqrt(r) * STEEL["young_modulus"] / (1 - nu**2) / mass
    length = (speed**2 / stiffness) ** 0.4
    time = length / speed

    def motion(_: float, y: Any) -> list[float]:
        root = math.sqrt(max(y[0], 0.0) * length)
        force = stiffness * root * (y[0] * length + 1.5 * STEEL["dissipation"] * y[1] * speed)
        return [y[1], -force * time / speed]

    def attracts(_: float, y: Any) -> float:
        return float(y[0] * length + 1.5 * STEEL["dissipation"] * y[1] * speed)

    attracts.terminal, attracts.direction = True, -1  # type: ignore[attr-defined]
    path = solve_ivp(motion, (0, 50), [0.0, 1.0], "DOP853", rtol=1e-11, atol=1e-13, events=attracts)
    assert path.y_events
    return float(-path.y_events[0][0][1])


def test_viscoelastic_is_the_motion_of_the_compressed_sphere() -> None:
    """The approximant is the integrated motion to 10⁻⁶ while ε_n > 3/4, and to 7·10⁻⁴ everywhere.

    Both bounds are of the approximant itself: it has six digits, and is made from the ends v* → 0 and v* → ∞.
    """
    steel = rs.Viscoelastic(**STEEL)
    for star in (0.03, 0.1, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0):
        speed = (star**2 / steel.beta) ** 5
        exact = by_newtons_equation(speed)
        assert abs(float(steel(speed)) - exact) < (1e-6 if exact > 0.75 else 7e-4)


def test_viscoelastic_at_low_speed() -> None:
    """ε = 1 - C₁ v*² + ..., with C₁ from the work of the viscous force along the elastic motion.

    In the units of β, (dx/dt)² = 1 - (4/5)x^{5/2}, and 1 - ε = 2β ∫ √x dx/dt dx, which is
    β (4/5)(5/4)^{3/5} B(3/5, 3/2).
    The approximant's coefficients have six digits.
    """
    c1 = 0.8 * 1.25**0.6 * float(beta(0.6, 1.5))
    assert pytest.approx(1.72765 - 0.574198, abs=6e-6) == c1
    steel = rs.Viscoelastic(**STEEL)
    speed = (1e-4 / steel.beta) ** 5
    assert 1.0 - float(steel(speed)) == pytest.approx(1e-4 * c1, rel=2e-3)
    assert float(rs.Viscoelastic(**STEEL | {"dissipation": 0.0})(1.0)) == 1.0


def test_plastic_is_elastic_up_to_yield() -> None:
    """1 up to v_y and continuous there; far beyond √(6√3/5) (x/(2√(6/5)))^{1/4} = 1.185 x^{1/4}."""
    material = rs.Plastic(yield_speed=0.2)
    limit = math.sqrt(6 * math.sqrt(3) / 5) * (2 * math.sqrt(1.2)) ** -0.25
    assert material([0.0, 0.1, 0.2]).tolist() == [1.0] * 3
    assert float(material(np.nextafter(0.2, 1.0))) == pytest.approx(1.0, abs=1e-15)
    assert float(material(2e19)) == pytest.approx(limit * 1e-20**0.25, rel=1e-9)
    v = np.geomspace(0.2, 200.0, 500)
    assert np.all(np.diff(material(v)) < 0)


def test_tabulated_joins_the_points() -> None:
    """Through the points, straight between them, constant beyond; one point is a constant."""
    table = rs.Tabulated(v=np.array([0.2, 0.4, 1.0]), e=[0.9, 0.8, 0.7])
    np.testing.assert_allclose(
        table([0.0, 0.2, 0.3, 0.4, 0.7, 1.0, 9.0]), [0.9, 0.9, 0.85, 0.8, 0.75, 0.7, 0.7]
    )
    assert rs.Tabulated(v=[3.0], e=[0.5])([0.0, 3.0, 7.0]).tolist() == [0.5] * 3


MATERIALS = [
    rs.Viscoelastic(**STEEL),
    rs.Viscoelastic(**STEEL | {"dissipation": 1e-2}),
    rs.Plastic(yield_speed=0.03),
    rs.Tabulated(v=[0.0, 0.1, 0.11, 5.0], e=[1.0, 0.2, 0.9, 0.0]),
]


def formula(material: Any, v: np.ndarray) -> np.ndarray:
    """ε_n(v) as the papers have it, with powers instead of roots and NumPy's interpolation."""
    match material:
        case rs.Viscoelastic():
            mass = 4 / 3 * np.pi * material.radius**3 * material.density
            force = (
                4 / 3 * np.sqrt(material.radius) * material.young_modulus / (1 - material.poisson_ratio**2)
            )
            beta = 1.5 * material.dissipation * (force / mass) ** 0.4
            above = np.polynomial.Polynomial([1.0, 1.07232, 0.574198, 0.141552])
            below = np.polynomial.Polynomial([1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585])
            x = beta**0.5 * v**0.1
            return np.asarray(above(x) / below(x))
        case rs.Plastic():
            x = np.minimum(material.yield_speed / np.maximum(v, 1e-300), 1.0)
            tail = (x / (x + 2 * np.sqrt(6 / 5 - x**2 / 5))) ** 0.25
            return np.asarray(np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - x**2 / 6) * tail)
    return np.asarray(np.interp(v, material.v, material.e))


@pytest.mark.parametrize("material", MATERIALS, ids=str)
def test_the_formulas_are_those_of_the_papers(material: Any) -> None:
    """To a few units in the last place of 1 at every magnitude of the speed, in the shape of the speeds."""
    found = material(SPEEDS)
    assert np.all((found >= 0.0) & (found <= 1.0))
    np.testing.assert_allclose(found, formula(material, SPEEDS), rtol=3e-15, atol=3e-15)
    np.testing.assert_array_equal(material(SPEEDS[:6].reshape(2, 3)), found[:6].reshape(2, 3))
    assert material(SPEEDS[3]).shape == ()
    assert np.isnan(material([0.1, np.nan])).tolist() == [False, True]


def test_the_engine_needs_no_power_function() -> None:
    """v^{1/10} is a square root and a fifth root: ε_n is the approximant with fifty digits to 8 ulp."""
    mpmath.mp.dps = 50
    steel = rs.Viscoelastic(**STEEL)
    r, nu = mpmath.mpf(STEEL["radius"]), mpmath.mpf(STEEL["poisson_ratio"])
    ratio = mpmath.mpf(STEEL["young_modulus"]) / (mpmath.pi * (1 - nu**2) * mpmath.mpf(STEEL["density"]))
    stiffness = ratio / (r**2 * mpmath.sqrt(r))
    scale = mpmath.sqrt(mpmath.mpf(1.5) * mpmath.mpf(STEEL["dissipation"])) * stiffness ** (mpmath.mpf(1) / 5)
    above = [1.0, 1.07232, 0.574198, 0.141552]
    below = [1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585]
    speeds = np.geomspace(1e-300, 1e250, 1500)
    for speed, found in zip(speeds, steel(speeds), strict=True):
        x = scale * mpmath.mpf(float(speed)) ** (mpmath.mpf(1) / 10)
        exact = mpmath.polyval(above[::-1], x) / mpmath.polyval(below[::-1], x)
        assert abs(found / exact - 1) < 8 * 2.0**-52


@pytest.mark.parametrize(
    ("kind", "values", "expected"),
    [
        (
            rs.Viscoelastic,
            STEEL | {"poisson_ratio": 0.6},
            "poisson_ratio = 0.6: must be a real number in (-1, 0.5]",
        ),
        (
            rs.Viscoelastic,
            STEEL | {"dissipation": -1.0},
            "dissipation = -1.0: must be a finite number >= 0 (s)",
        ),
        (rs.Viscoelastic, STEEL | {"radius": 1e-300}, "young_modulus = 210000000000.0, poisson_ratio = "),
        (rs.Plastic, {"yield_speed": 0}, "yield_speed = 0: must be a finite number > 0 (m/s)"),
        (rs.Tabulated, {"v": [], "e": []}, "v = []: must be a 1-D array of at least one number"),
        (rs.Tabulated, {"v": [[0.1]], "e": [1]}, "v = [[0.1]]: must be a 1-D array"),
        (rs.Tabulated, {"v": [0.1, math.nan], "e": [1, 1]}, "v[1] = nan: must be a finite number >= 0 (m/s)"),
        (rs.Tabulated, {"v": [0.1, 0.1], "e": [1, 1]}, "v[1] = 0.1: must be greater than v[0] = 0.1"),
        (rs.Tabulated, {"v": [0.1, 0.2], "e": [1]}, "v, e: 2 speeds and 1 coefficients; must match"),
        (rs.Tabulated, {"v": [0.1], "e": [1.1]}, "e[0] = 1.1: must be a real number in [0, 1]"),
        (
            rs.Frictionless,
            {"normal": -0.5},
            "normal = -0.5: must be a real number in [0, 1], a Viscoelastic, Plastic, Tabulated",
        ),
        (
            rs.Frictionless,
            {"normal": True},
            "normal = True: must be a real number in [0, 1], a Viscoelastic, Plastic, Tabulated",
        ),
        (rs.Coulomb, {"normal": 0.5, "friction": -1}, "friction = -1: must be a real number in [0, 1e+100]"),
        (
            rs.Coulomb,
            {"normal": 0.5, "friction": 1, "hypothesis": "routh"},
            "hypothesis = 'routh': must be 'stronge', 'poisson' or 'newton'",
        ),
        (
            rs.ChatterjeeRuina,
            {"normal": 1, "tangential": 2, "friction": 0},
            "tangential = 2: must be a real number in [-1, 1]",
        ),
    ],
)
def test_bad_parameters_are_named(kind: Any, values: dict[str, Any], expected: str) -> None:
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - looked at below
        kind(**values)
    assert str(caught.value).startswith(expected)


def test_of_a_velocity_the_magnitude_counts() -> None:
    """Some recorded impact velocities are negative, and those of impacts that never happened are NaN."""
    for material in (
        rs.Plastic(yield_speed=0.05),
        rs.Viscoelastic(**STEEL),
        rs.Tabulated(v=[0, 1], e=[1, 0.5]),
    ):
        v = np.array([[0.0, 0.3], [math.nan, 2.0]])
        np.testing.assert_array_equal(material(-v), material(v))
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    data = rs.simulate(body, rs.Frictionless(normal=0.7), particles=300, impacts=6)
    assert (data.impact_velocity < 0).any()
    found = rs.Plastic(yield_speed=0.05)(data.impact_velocity)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(data.impact_velocity))


def power(v: float) -> float:
    return float(0.97 * (1.0 + v / 3.0) ** -0.25)


@pytest.mark.parametrize(
    ("function", "tolerance"),
    [
        (power, 1e-6),
        (power, 1e-9),
        (lambda v: 1.0 - 0.1 * min(v, 2.0) ** 0.2, 1e-6),  # an infinite slope at 0, a kink at 2 m/s
        (lambda v: 0.9 + 0.05 * math.sin(v), 1e-6),
        (lambda v: np.float32(0.5), 1e-12),
    ],
)
def test_a_function_is_tabulated_to_its_tolerance(function: Any, tolerance: float) -> None:
    """At speeds that it was not asked for, of all magnitudes; the margin is for what lies in between."""
    table = rs.Tabulated.from_function(function, tolerance=tolerance)
    rng = np.random.default_rng(5)
    speeds = np.concatenate([100.0 * rng.random(2000), 10.0 ** rng.uniform(-12.0, 2.0, 2000)])
    exact = np.array([function(float(v)) for v in speeds])
    assert np.abs(table(speeds) - exact).max() <= 1.5 * tolerance
    assert table(1e3) == pytest.approx(float(function(100.0)), abs=1e-12)


def test_a_jump_is_where_it_is() -> None:
    table = rs.Tabulated.from_function(lambda v: 0.9 if v < 1.0 else 0.5)
    assert table([1.0 - 2e-9, 1.0 + 2e-9]).tolist() == [0.9, 0.5]


def test_a_law_takes_any_function_of_the_speed() -> None:
    """It is the table of it: compared, copied, pickled and written as that."""
    law = rs.Coulomb(normal=lambda v: 1.0 / (1.0 + 0.1 * v), friction=0.3)
    assert isinstance(law.normal, rs.Tabulated)
    assert law == rs.Coulomb(normal=rs.Tabulated.from_function(lambda v: 1.0 / (1.0 + 0.1 * v)), friction=0.3)
    assert pickle.loads(pickle.dumps(law)) == law
    assert table_of(law)["normal"]["type"] == "tabulated"
    body = rs.Dumbbell(radius=3e-3, separation=0.0)
    data = rs.simulate(body, law, particles=5, impacts=20)
    np.testing.assert_allclose(
        data.microscopic, 1.0 / (1.0 + 0.1 * data.impact_velocity), atol=1e-6, rtol=0.0
    )


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rs.Frictionless(normal=lambda v: 1.0 - 0.1 * v), "normal gave -"),
        (lambda: rs.Frictionless(normal=lambda v: v**-0.25), "normal gave ZeroDivisionError: "),
        (lambda: rs.Frictionless(normal=lambda v: "much"), "normal gave ValueError: "),
        (
            lambda: rs.Frictionless(normal=lambda v: math.nan),
            "normal gave nan at 0.0 m/s: must give ε_n in [0, 1]",
        ),
        (lambda: rs.Frictionless(normal=lambda: 0.5), "normal gave TypeError: "),
        (lambda: rs.Frictionless(normal=dict), "normal = <class 'dict'>: must be a real number in [0, 1]"),
        (lambda: rs.Tabulated.from_function(0.9), "function = 0.9: must be a function"),  # type: ignore[arg-type]
    ],
)
def test_functions_that_are_none_are_refused(make: Any, said: str) -> None:
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - looked at below
        make()
    assert str(caught.value).startswith(said)


def test_copies_and_files_hold_the_parameters_alone() -> None:
    """What the core has made of them is made again: a copy with another law runs under that one."""
    law = rs.Coulomb(normal=rs.Tabulated(v=[0.1, 1.0], e=[0.9, 0.8]), friction=0.3)
    contact = ((-1.0, 0.5, 0.0), (-1.0, 0.1), 0.4, 3.5)
    expected = law.compiled.respond(*contact)
    for same in (copy.copy(law), copy.deepcopy(law), pickle.loads(pickle.dumps(law)), law.model_copy()):
        assert same == law
        assert hash(same) == hash(law)
        assert same.compiled.respond(*contact) == expected
    smooth = law.model_copy(update={"friction": 0.0})
    assert smooth.compiled.respond(*contact) == rs.Frictionless(normal=law.normal).compiled.respond(*contact)
    body = pickle.loads(pickle.dumps(rs.Spheroid(equatorial=1.0, polar=2.0)))
    assert body.mass == rs.Spheroid(equatorial=1.0, polar=2.0).mass


def test_parameters_of_a_material_come_after_those_of_the_law() -> None:
    law = rs.Coulomb(normal=rs.Plastic(yield_speed=0.5), friction=0.2)
    plain = {"friction": 0.2, "hypothesis": "stronge"}
    assert law.attributes() == {"normal": "Plastic", "normal_yield_speed": 0.5} | plain
    assert rs.Coulomb(normal=0.5, friction=0.2).attributes() == {"normal": 0.5} | plain
    assert rs.Coulomb(normal=0.5, friction=0.2).constant == 0.5
    with pytest.raises(ValueError, match=r"^normal = Plastic\(yield_speed=0.5\): must be a number, the same"):
        _ = law.constant


def test_bounds_of_a_tabulated_function_belong_to_what_is_allowed() -> None:
    """ε_n = 0 and 1, the greatest tolerance, speeds below 1 m/s."""
    assert rs.Tabulated.from_function(lambda v: 0.0, fastest=0.5, tolerance=0.1).e == (0.0, 0.0)
    assert rs.Tabulated.from_function(lambda v: 1.0, fastest=0.5, tolerance=1e-12).v == (0.0, 0.5)


@pytest.mark.parametrize(
    ("use", "told"),
    [
        (
            lambda: rs.Tabulated.from_function(lambda v: 1.5),
            "function gave 1.5 at 0.0 m/s: must give ε_n in [0, 1] up to 100.0 m/s; "
            "Tabulated.from_function takes a lower `fastest`",
        ),
        (
            lambda: rs.Tabulated.from_function(lambda v: 0.5 + 0.4 * math.sin(1e6 * v)),
            "function needs more than 100,000 points for 1e-06: must be smoother, or have a greater "
            "tolerance",
        ),
        (
            lambda: rs.Tabulated.from_function(lambda v: 0.5, fastest=math.inf),
            "fastest = inf: must be a finite number > 0 (m/s)",
        ),
        (
            lambda: rs.Tabulated.from_function(lambda v: 0.5, tolerance=0.2),
            "tolerance = 0.2: must be a number in [1e-12, 0.1]",
        ),
        (
            lambda: rs.Tabulated.from_function(
                power,
                fastest=xr.DataArray(2.0, attrs={"units": "km/h"}),  # type: ignore[arg-type]
            ),
            "fastest has units 'km/h': must be in m s-1; drop_attrs() removes units that xarray copied",
        ),
        (lambda: rs.Plastic(yield_speed=1.0)("x"), "speed = 'x': must be real numbers (m/s), or nan"),
        (
            lambda: rs.Plastic(yield_speed=1.0)(xr.DataArray(1.0, attrs={"units": "km/h"})),
            "speed has units 'km/h': must be in m s-1; drop_attrs() removes units that xarray copied",
        ),
    ],
)
def test_what_a_material_refuses(use: Any, told: str) -> None:
    with pytest.raises(ValueError) as raised:  # noqa: PT011 (the message is compared below)
        use()
    assert str(raised.value) == told
