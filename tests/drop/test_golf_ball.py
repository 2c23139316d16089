"""The double golf ball, L = 2R: dropped with spin it bounces with ε from about -4 to +2 (AJP 92, 568 (2024)).

The closed form of examples/golf.py, and what the engine makes of it, under each law.
"""

import runpy
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

import restitution as rs
from restitution.laws import Law
from restitution.laws._laws import Hypothesis

Array = NDArray[np.float64]

GOLF = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "golf.py"))
BODY, RADIUS, HEIGHT, GRAVITY = (GOLF[name] for name in ("BODY", "RADIUS", "HEIGHT", "GRAVITY"))
SMOOTH = rs.Frictionless(normal=0.8)
LAWS: dict[str, Law] = {
    "frictionless": SMOOTH,
    "slipping": rs.Coulomb(normal=0.8, friction=0.1),
    "sticking": rs.ChatterjeeRuina(normal=0.8, tangential=0.0, friction=1e6),
    "reversing": rs.ChatterjeeRuina(normal=0.8, tangential=0.3, friction=1e6),
    "paper": rs.TangentialRestitution(normal=0.8, tangential=1.0),
    "paper, rough": rs.TangentialRestitution(normal=0.8, tangential=0.0),
}
SPINS = {
    "frictionless": (100.5, 92.9),
    "slipping": (112.1, 96.6),
    "sticking": (150.1, 128.1),
    "reversing": (179.3, 143.6),
    "paper": (78.4, 78.1),
    "paper, rough": (129.9, 113.6),
}
"""In rad/s, for +2 and for -4: the table of docs/shapes.md."""
each_law = pytest.mark.parametrize("name", LAWS)


def closed_form(law: Law, angle: float, velocity: float, spin: float) -> float:
    return float(GOLF["restitution"](law, np.array(angle), np.array(velocity), np.array(spin)))


def spin_for(law: Law, angle: float, velocity: float, wanted: float) -> float:
    """The spin in rad/s at which the closed form has the ε that is wanted."""
    return float(
        brentq(lambda spin: closed_form(law, angle, velocity, spin) - wanted, 1.0, 2000.0, xtol=1e-12)
    )


def released(law: Law, **release: Any) -> Any:
    return rs.simulate(BODY, law, particles=1, impacts=1, gravity=GRAVITY, **release).isel(
        particle=0, impact=0
    )


def test_two_glued_balls() -> None:
    """Mass of two balls, and Steiner's J = 2(2/5 + 1)mR² for either."""
    assert pytest.approx(2 * 45.9e-3) == BODY.mass
    assert BODY.transverse_inertia / BODY.mass == pytest.approx(1.4 * RADIUS**2)


@each_law
def test_plus_two(name: str) -> None:
    """Dropped 6 cm with the right spin: the ball that comes down strikes at 150°, and ε = +2.

    The spins are 12 to 29 turns a second; the paper's law, which creates energy, takes the least.
    """
    law = LAWS[name]
    angle = np.radians(150.0)
    fallen = HEIGHT - RADIUS * (1.0 - np.cos(angle))
    speed = float(np.sqrt(2.0 * GRAVITY * fallen))
    spin = spin_for(law, angle, speed, 2.0)
    assert spin == pytest.approx(SPINS[name][0], abs=0.06)
    start = angle - spin * speed / GRAVITY
    found = released(law, release_height=HEIGHT, orientation=[[start, 0.0]], spin=[0, spin, 0])
    assert float(found.angle) == pytest.approx(angle, abs=1e-12)
    assert float(found.restitution) == pytest.approx(2.0, abs=1e-11)


@each_law
def test_minus_four(name: str) -> None:
    """The centre of mass rises with 0.5 m/s when the ball that comes down strikes: it rises on with 2 m/s."""
    law = LAWS[name]
    angle, rise = np.radians(110.0), 0.5
    spin = spin_for(law, angle, -rise, -4.0)
    assert spin == pytest.approx(SPINS[name][1], abs=0.06)
    lift = RADIUS * (1.0 - np.cos(angle))
    found = released(
        law,
        release_height=lift * (1.0 + 1e-15),
        release_velocity=[0.0, 0.0, rise],
        orientation=[[angle, 0.0]],
        spin=[0, spin, 0],
    )
    assert float(found.time) < 1e-15
    assert float(found.impact_velocity) == pytest.approx(-rise, rel=1e-12)
    assert float(found.restitution) == pytest.approx(-4.0, abs=1e-11)


@pytest.mark.parametrize("spin", [0.0, 40.0, 80.0, 120.0])
@pytest.mark.parametrize("law", [LAWS[name] for name in ("frictionless", "sticking", "paper")])
def test_the_first_impact_at_any_angle(law: Law, spin: float) -> None:
    """Dropped from all angles: where it lands the closed form holds, and nowhere is ε less than -1."""
    found = GOLF["drop"](law, spin, 500, 1).isel(impact=0)
    angle = found.release_angle + spin * found.time
    # The closed form takes the lower ball; a level axis has none.
    clear = np.abs(np.cos(angle.values)) > 1e-9
    predicted = GOLF["restitution"](law, angle.values, found.impact_velocity.values, spin)
    np.testing.assert_allclose(found.restitution.values[clear], predicted[clear], rtol=0, atol=1e-11)
    assert (found.restitution >= -1.0).all()


def test_friction_that_slips_throughout() -> None:
    """Coulomb's law under any hypothesis, wherever friction cannot stop the slip: ds/dp = K_nu + μK_uu."""
    spin, friction = 120.0, 0.05
    for hypothesis in get_args(Hypothesis):
        law = rs.Coulomb(normal=0.8, friction=friction, hypothesis=hypothesis)
        found = GOLF["drop"](law, spin, 200, 1).isel(impact=0)
        angle, speed = (found.release_angle + spin * found.time).values, found.impact_velocity.values
        predicted = GOLF["restitution"](law, angle, speed, spin)
        x, a = -np.sign(np.cos(angle)) * np.sin(angle), 1.0 + np.abs(np.cos(angle))
        change = (predicted + 1.0) * speed * (a * x + friction * (1.4 + a**2)) / 1.4
        slips = change < spin * RADIUS * a
        assert 0.6 < slips.mean() < 0.8
        np.testing.assert_allclose(found.restitution[slips], predicted[slips], rtol=0, atol=1e-11)


def test_a_plane_that_does_not_pull() -> None:
    """ε ≥ -1 of a body that falls and ε ≤ -1 of one that rises; dropped balls have ε beyond -4 and +2.

    Under the frictionless law nothing moves along the plane, so that E_rot/E_tot is J ω²/(v² + J ω²), and the
    closed form holds with one of the signs of ω at every impact, not at the first alone.
    """
    for law in (SMOOTH, rs.Coulomb(normal=0.8, friction=0.2), LAWS["sticking"]):
        found = GOLF["drop"](law, 100.0, 500, 4)
        falls = found.impact_velocity > 0
        assert (found.restitution.where(falls, 0.0) >= -1.0).all()
        assert (found.restitution.where(~falls, -1.0) <= -1.0).all()
        assert (found.restitution.where(~falls) < -4.0).any()
        assert (found.restitution.isel(impact=0) > 1.5).any()
    found = GOLF["drop"](SMOOTH, 100.0, 500, 4)
    share, speed = found.rotational_fraction.values, found.impact_velocity.values
    turning = np.abs(speed) * np.sqrt(share / (1.0 - share) / 1.4) / RADIUS
    signs = [GOLF["restitution"](SMOOTH, found.angle.values, speed, sign * turning) for sign in (1.0, -1.0)]
    error = np.min(np.abs(np.array(signs) - found.restitution.values), axis=0)
    # 1 - share cancels, and ε is larger than 1 where v is small.
    assert (error <= 1e-11 * (1.0 + np.abs(found.restitution.values)) / (1.0 - share)).all()


def test_how_much_spin_it_takes() -> None:
    """A smooth double ball needs |ω|R/|v| of 1.78 for +2 and of 3.86 for -4, at its best angles.

    With c = 3/(1 + e), ε = -1 + (1 + e)(1 + q x)/(1 + x²/J) is +2 at the least q where x² = J(1 - 1/c),
    and -4 at x = 1, both balls on the plane.
    """
    ratio = np.linspace(0.0, 6.0, 6001)
    highest, _, lowest = GOLF["extremes"](ratio)
    part = 3.0 / 1.8
    least = 2.0 * np.sqrt((part - 1.0) * part / 1.4)
    assert ratio[np.argmax(highest >= 2.0)] == pytest.approx(least, abs=2e-3)
    assert least == pytest.approx(1.78, abs=5e-3)
    assert ratio[np.argmax(lowest <= -4.0)] == pytest.approx(1.0 + part * (1.0 + 1.0 / 1.4), abs=2e-3)


def test_the_figure(tmp_path: Path) -> None:
    """The script draws docs/images/golf.png."""
    GOLF["draw"](tmp_path / "golf.png")
    assert (tmp_path / "golf.png").read_bytes().startswith(b"\x89PNG")
