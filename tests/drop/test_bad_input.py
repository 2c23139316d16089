"""Bad arguments are refused at once, with their name, their value and what is allowed."""

import math
from functools import partial
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.refused import (
    ANGLE,
    BODIES,
    LAWS,
    RUN,
    THREADS_CASES,
    check,
    identify,
    message,
)


@pytest.mark.parametrize(("name", "value", "allowed"), [*RUN, *THREADS_CASES], ids=identify)
def test_simulate(
    body: rs.Dumbbell, law: rs.TangentialRestitution, name: str, value: Any, allowed: str
) -> None:
    check(message(lambda: rs.simulate(body, law, **{name: value})), name, value, allowed)


def test_angles(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """An array is refused with the index and value of its first bad angle, or with its length."""

    def refused(angles: Any) -> str:
        return message(lambda: rs.simulate(body, law, particles=3, orientation=angles))

    assert refused([0.1, math.nan, 0.3]) == f"orientation[1] = nan: {ANGLE}"
    assert refused(np.array([0.1, 0.2, -np.inf])) == f"orientation[2] = -inf: {ANGLE}"
    assert refused([2.0**20 + 1, 0.2, 0.3]) == f"orientation[0] = 1048577.0: {ANGLE}"
    expected = "orientation has {} angles: must have one for each of particles = 3"
    assert refused([0.1, 0.2]) == expected.format(2)
    assert refused([]) == expected.format(0)
    assert refused([[0.1, 0.2]]) == expected.format(1)
    told = message(lambda: rs.simulate(body, law, particles=3, spin=np.zeros((7, 3))))
    assert told == "spin has 7 vectors: must have one for each of particles = 3"


def test_a_tilted_body_may_start_lower(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """The height that is allowed is that of the given angles: R for a horizontal axis, not R + L/2."""
    height = 3e-3 * (1 + 1e-9)
    horizontal = np.array([math.pi / 2])
    data = rs.simulate(body, law, particles=1, impacts=1, release_height=height, orientation=horizontal)
    assert data.impacts == 1
    upright = np.array([0.0])
    text = message(lambda: rs.simulate(body, law, particles=1, release_height=height, orientation=upright))
    check(text, "release_height", height, "must be at least 0.00315 m, or a part of the body")
    assert text.endswith("below the plane")
    text = message(lambda: rs.simulate(rs.Box(a=3.0, b=3.0, c=3.0), law, particles=1))
    assert text.endswith("below the plane; are its lengths in m?")


def test_body_and_law(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Refuse what is no body or no law, be it as much as the other of the two or their parameters."""
    no_bodies: list[Any] = [law, None, 3, "dumbbell", {"radius": 1.0, "separation": 0.1}, rs.Dumbbell]
    for wrong in no_bodies:
        for call, allowed in (
            (rs.simulate, BODIES),
            (rs.analytic.first_impact, BODIES),
        ):
            text = message(partial(call, wrong, law))
            assert text.startswith("body = ")
            assert text.endswith(f": must be {allowed}")
    no_laws: list[Any] = [body, None, 0.98, {"normal": 0.98}]
    for wrong in no_laws:
        for call, more in ((rs.simulate, ", or a CustomLaw"), (rs.analytic.first_impact, "")):
            text = message(partial(call, body, wrong))
            assert text.startswith("law = ")
            assert text.endswith(f": must be {LAWS}{more}")


def test_missing_and_unknown_names() -> None:
    """All that is wrong is said at once, a line each, with a guess at what was meant."""
    lines = message(lambda: rs.Dumbbell(radus=1.0, density=-1)).splitlines()  # type: ignore[call-arg]
    assert [line.partition(" (")[0] for line in lines] == [
        "radius: missing; must be a finite number > 0",
        "separation: missing; must be a finite number >= 0",
        "density = -1: must be a finite number > 0",
        "radus: unknown; did you mean radius? Dumbbell takes radius, separation, density, wall, inertia",
    ]
    assert message(lambda: rs.TangentialRestitution(normal=1, friction=0.3)) == (  # type: ignore[call-arg]
        "friction: unknown; TangentialRestitution takes normal, tangential"
    )


def test_a_wrong_call_is_a_type_error(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    with pytest.raises(TypeError, match="'body' and 'law'"):
        rs.simulate()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="'particle'"):
        rs.simulate(body, law, particle=10)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="positional"):
        rs.simulate(body, law, 10)  # type: ignore[call-arg, arg-type]
    with pytest.raises(TypeError, match="'velocity_bins' and 'restitution_bins'"):
        rs.compare([body], [law])
    with pytest.raises(TypeError, match=r"argument: 'restitution_bins'$"):
        rs.compare([body], [law], velocity_bins=[0.0, 1.0])
    with pytest.raises(TypeError, match="'particle'"):
        rs.compare([body], [law], velocity_bins=[0.0, 1.0], restitution_bins=[0.0, 1.0], particle=10)


def test_all_ranges_that_are_wrong_are_named(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """In one error, as all parameters of a body are; a range without bins is not passed over."""
    told = r"velocity_range: missing; velocity_bins = 20 needs a range \(low, high\)\n"
    told += r"restitution_range = \(3.0, -1.0\): must be \(low, high\) with low < high"
    bins = {"velocity_bins": 20, "restitution_bins": 30, "restitution_range": (3.0, -1.0)}
    with pytest.raises(ValueError, match=f"^{told}$"):
        rs.statistics(body, law, **bins)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=f"^{told}$"):
        rs.reduce(rs.simulate(body, law, particles=2, impacts=2), **bins)  # type: ignore[arg-type]
    with pytest.raises(
        ValueError, match=r"velocity_range = \(0, 1\): must be left out: velocity_bins is None"
    ):
        rs.statistics(body, law, velocity_bins=None, velocity_range=(0, 1), restitution_bins=[0.0, 1.0])


@pytest.mark.parametrize(
    "values",
    [
        {"radius": 1e-110, "separation": 1e-111},
        {"radius": 1e200, "separation": 1e199},
        {"radius": 3e-3, "separation": 1e300},
        {"radius": 3e-3, "separation": 3e-4, "density": 1e-320},
    ],
    ids=str,
)
def test_a_body_beyond_floating_point(values: dict[str, float]) -> None:
    """Finite parameters whose mass or inertia is no normal number would give NaN later."""
    text = message(lambda: rs.Dumbbell(**values))
    assert text.startswith("radius = ")
    assert "mass and inertia" in text
    assert "neither overflow nor underflow" in text


@pytest.mark.parametrize("gravity", [1e273, 1e-273])
def test_scales_with_few_digits(gravity: float) -> None:
    """Refuse a subnormal R/g or gR: times and speeds would be off by the digits that it lacks."""
    body, law = rs.Dumbbell(radius=1.4e-50, separation=0.0), rs.Frictionless(normal=0.5)
    text = message(lambda: rs.simulate(body, law, release_height=1e-49, gravity=gravity))
    assert text.startswith("gravity = 1e")
    assert "such that R/g and gR neither overflow nor underflow" in text


def test_absurd_scales(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Finite heights and gravities that overflow in the engine's units, R and √(R/g)."""
    assert message(lambda: rs.simulate(body, law, release_height=1.7e308)).startswith("release_height = 1")
    assert message(lambda: rs.simulate(body, law, spin=[0, 1e200, 0])).startswith(
        "spin[1] = 1e+200: must be at most"
    )
    assert message(lambda: rs.simulate(body, law, release_velocity=[0, 0, 1e200])).startswith(
        "release_velocity[2] = 1e+200: must be at most"
    )
    assert "must be such that R/g and gR" in message(lambda: rs.simulate(body, law, gravity=1e-320))


def test_a_table_that_no_memory_holds(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Each number is allowed, their product is not."""
    text = message(lambda: rs.simulate(body, law, particles=2**39, impacts=2**39))
    assert text.startswith(f"particles * impacts = {2**78}: must be at most ")
    assert text.endswith(" impacts, which this process can hold")
