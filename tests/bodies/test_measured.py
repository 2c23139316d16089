"""Bodies from what callipers, roundness gauges and grades tell."""

import numpy as np
import pytest

import restitution as rs


def test_length_and_width_are_those_of_the_body() -> None:
    dumbbell = rs.Dumbbell.from_length_width(7e-3, 6e-3)
    assert 2.0 * dumbbell.radii[0] + dumbbell.separation == pytest.approx(7e-3, rel=1e-15)
    assert dumbbell.radii == (3e-3, 3e-3)
    spheroid = rs.Spheroid.from_length_width(5e-3, 6e-3, density=7800.0)
    assert (spheroid.polar, spheroid.equatorial, spheroid.density) == (2.5e-3, 3e-3, 7800.0)


@pytest.mark.parametrize(
    ("length", "width", "message"),
    [
        (5e-3, 6e-3, r"^length = 0.005: must be >= width = 0.006 \(m\)"),
        (-1.0, 6e-3, r"^length = -1.0: must be a finite number > 0, in m"),
        (6e-3, float("nan"), r"^width = nan"),
    ],
)
def test_sizes_that_are_none_are_refused(length: float, width: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rs.Dumbbell.from_length_width(length, width)


@pytest.mark.parametrize("form", ["lobed", "flattened", "dumbbell", "off-centre"])
def test_every_form_has_the_lever_arm_that_it_stands_for(form: str) -> None:
    """At the first impact from rest ⟨ε⟩ = ε_n - (1 + ε_n) (m/J) t²/2, whatever the form, to order t."""
    t, diameter = 3e-6, 6e-3
    body = rs.from_roundness(diameter, t, form=form, density=2700.0)  # type: ignore[arg-type]
    angles = (np.arange(2000) + 0.5) * np.pi / 1000
    run = rs.simulate(
        body,
        rs.Frictionless(normal=0.9),
        particles=2000,
        impacts=1,
        orientation=angles,
        release_height=0.1,
    )
    lost = 0.9 - run.restitution.values[:, 0]
    expected = 1.9 * 2.5 / (diameter / 2.0) ** 2 * t**2 / 2.0
    assert lost.mean() == pytest.approx(expected, rel=3e-3)
    assert body.mass == pytest.approx(2700.0 * np.pi / 6.0 * diameter**3, rel=2e-3)


@pytest.mark.parametrize("form", ["lobed", "flattened", "dumbbell", "off-centre"])
def test_every_form_of_a_shell_has_its_mass_and_inertia(form: str) -> None:
    """J = 2 m (R⁵ - r⁵)/(5 (R³ - r³)), and m of the wall, to first order in t/R; the hull stays."""
    t, diameter, wall = 4e-6, 0.04, 4e-4
    body = rs.from_roundness(diameter, t, form=form, density=1400.0, wall=wall)  # type: ignore[arg-type]
    outside, inside = diameter / 2.0, diameter / 2.0 - wall
    assert body.mass == pytest.approx(1400.0 * 4 / 3 * np.pi * (outside**3 - inside**3), rel=1e-3)
    inertia = 0.4 * body.mass * (outside**5 - inside**5) / (outside**3 - inside**3)
    assert body.transverse_inertia == pytest.approx(inertia, rel=1e-3)
    full = rs.from_roundness(diameter, t, form=form, density=1400.0)  # type: ignore[arg-type]
    angles = np.cos(np.linspace(0.0, np.pi, 7))
    for angle in angles:
        height, other = (one.compiled.lowest(np.array([angle])) for one in (body, full))
        assert height == pytest.approx(other, abs=1e-3 * t)


def test_more_lobes_have_a_longer_lever_arm() -> None:
    three = rs.from_roundness(6e-3, 10e-6, lobes=3)
    two = rs.from_roundness(6e-3, 15e-6)
    assert three == two


def test_a_round_ball_is_a_sphere() -> None:
    for form in ("lobed", "flattened", "dumbbell", "off-centre"):
        body = rs.from_roundness(6e-3, 0.0, form=form)
        assert body.transverse_inertia == pytest.approx(body.axial_inertia, rel=1e-14)


def test_a_grade_is_its_number_in_millionths_of_an_inch() -> None:
    """ISO rounds to two figures, at most 5 % away."""
    for grade in (3, 5, 10, 16, 20, 24, 28, 40, 48, 60, 100, 200, 500, 1000):
        assert rs.ball_grade(grade) == pytest.approx(grade * 25.4e-9, rel=0.055)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rs.from_roundness(6e-3, 1e-3), r"^out_of_roundness = 0.001: must be in \[0, 0.0006\]"),
        (lambda: rs.from_roundness(6e-3, -1e-6), r"^out_of_roundness = -1e-06"),
        (
            lambda: rs.from_roundness(6e-3, 1e-6, form="egg"),  # type: ignore[arg-type]
            r"^form = 'egg': must be 'lobed', 'flattened', 'dumbbell' or 'off-centre'$",
        ),
        (lambda: rs.from_roundness(6e-3, 1e-6, lobes=1), r"^lobes = 1"),
        (lambda: rs.from_roundness(6e-3, 1e-6, wall=-1e-4), r"^wall = -0.0001: must be a finite number > 0"),
        (
            lambda: rs.from_roundness(6e-3, 1e-6, wall=4e-3),
            r"^diameter = 0.006, .*, wall = 0.004: gives wall = 0.004.*: must be at most the equatorial",
        ),
        (lambda: rs.from_roundness(6e-3, 1e-6, form="flattened", lobes=3), r"^lobes = 3: must be left out"),
        (lambda: rs.ball_grade(7), r"^grade = 7: must be one of 3, 5, 10"),
        (lambda: rs.ball_roughness(500), r"^grade = 500: must be one of 3, 5, 10"),
        (lambda: rs.ball_grade([]), r"^grade = \[\]"),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_ball_is_refused(call: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()  # type: ignore[operator]
