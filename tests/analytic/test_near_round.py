"""`analytic.near_round`: the exact engine's moments, without its search for contacts."""

import math
import statistics

import numpy as np
import pytest

import restitution as rs
from restitution.analytic import near_round

EDGES = np.linspace(0.0, 2.5, 126)


@pytest.mark.parametrize(
    ("radius", "height", "elongation", "law"),
    [
        (3e-3, 0.06, 0.01, rs.TangentialRestitution(normal=0.9)),
        (3e-3, 0.06, 0.05, rs.TangentialRestitution(normal=0.9)),
        (3e-3, 0.06, 0.2, rs.TangentialRestitution(normal=0.9)),
        (3e-3, 0.30, 0.1, rs.TangentialRestitution(normal=0.8)),
        (1e-2, 0.06, 0.05, rs.TangentialRestitution(normal=0.7)),
        (3e-3, 0.06, 0.1, rs.TangentialRestitution(normal=0.9, tangential=-0.5)),
        (3e-3, 0.06, 0.05, rs.Frictionless(normal=0.9)),
        (3e-3, 0.06, 0.2, rs.Frictionless(normal=0.9)),
    ],
)
def test_moments_are_those_of_the_engine(
    radius: float, height: float, elongation: float, law: rs.TangentialRestitution | rs.Frictionless
) -> None:
    """σ of 4000 impacts scatters by 1 to 2 %; the map adds what its docstring says.

    Bins at the edge of a group of impacts, which hold few of them, are left out.
    """
    body = rs.Dumbbell(radius=radius, separation=elongation * radius)
    exact = rs.statistics(
        body,
        law,
        particles=8000,
        impacts=60,
        release_height=height,
        velocity_bins=EDGES,
        restitution_bins=[-1.0, 3.0],
        seed=11,
    )
    found = near_round(body, law, velocity_bins=EDGES, release_height=height)
    full = (exact["number"] > 4000) & (found["number"] > 2000) & found["std_restitution"].notnull()
    assert int(full.sum()) >= 5
    ratio = found["std_restitution"].values[full] / np.sqrt(exact["variance"].values[full])
    assert np.sqrt(np.mean((ratio - 1) ** 2)) < 0.045
    assert np.abs(ratio - 1).max() < 0.15
    sigma = np.sqrt(exact["variance"].values[full])
    off = (found["mean_restitution"] - exact["mean_restitution"]).values[full]
    assert np.all(np.abs(off) < 0.15 * sigma)
    square = found["mean_restitution"] ** 2 + found["std_restitution"] ** 2
    np.testing.assert_allclose(found["second_moment"], square, rtol=1e-12)


def test_the_first_impact_is_that_of_the_closed_form() -> None:
    """Falls from one height differ by L|cos θ|/2 in their length only; the bin holds no second impact.

    The midpoint rule over 4000 angles; and Eq. 17 has no height in it.
    """
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.5)
    first = rs.analytic.first_impact(body, law)
    found = near_round(body, law, velocity_bins=[0.9, 1.2])
    assert found["number"].values.tolist() == [4000]
    assert found["mean_restitution"].values[0] == pytest.approx(first.mean(), abs=1e-7)
    assert found["std_restitution"].values[0] == pytest.approx(first.std(), rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"body": rs.Dumbbell(radius=3e-3, separation=1e-3)}, r"separation = 0\.001: must be at most 0\.2"),
        ({"body": rs.Dumbbell(radius=(3e-3, 2e-3), separation=1e-4)}, "Dumbbell with equal spheres"),
        ({"body": rs.Spheroid(equatorial=3e-3, polar=3.1e-3)}, "Dumbbell with equal spheres"),
        ({"law": rs.Coulomb(normal=0.9, friction=0.1)}, "TangentialRestitution or Frictionless"),
        ({"law": rs.Frictionless(normal=rs.Plastic(yield_speed=0.1))}, "a number for normal"),
        ({"law": rs.Frictionless(normal=1.0)}, "the impacts would never end"),
        ({"angles": 0}, "angles = 0: must be a whole number"),
        ({"velocity_bins": [1.0]}, "at least two edges"),
        ({"release_height": 1e-3}, "release_height = 0.001"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(changes: dict[str, object], message: str) -> None:
    given = {
        "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
        "law": rs.Frictionless(normal=0.9),
        "velocity_bins": EDGES,
        **changes,
    }
    with pytest.raises(ValueError, match=message):
        near_round(**given)  # type: ignore[arg-type]


def test_slow_bins_are_left_empty() -> None:
    """0.6 √(gR) is 0.103 m/s here; a sphere has no scatter, and its bins are those of ε_n^k v₀."""
    found = near_round(
        rs.Dumbbell(radius=3e-3, separation=0.0), rs.Frictionless(normal=0.5), velocity_bins=EDGES
    )
    speeds = np.sqrt(2 * 9.81 * 0.057) * 0.5 ** np.arange(4)
    filled = found["number"].values > 0
    assert np.flatnonzero(filled).tolist() == sorted(np.searchsorted(EDGES, speeds) - 1)
    assert found["mean_restitution"].values[filled] == pytest.approx(0.5, abs=1e-14)
    assert np.all(found["std_restitution"].values[filled] < 1e-14)


def one_body(
    theta: float, body: rs.Dumbbell, law: rs.TangentialRestitution | rs.Frictionless, height: float, g: float
) -> list[tuple[float, float]]:
    """Follow one body by the map of the docstring, each impact a solution of its linear equations.

    Unknowns are the velocities after it and the impulse: momentum along and across, spin, and the law.
    """
    assert isinstance(law.normal, float)
    radius, half, mass = body.radii[0], body.separation / 2, body.mass

    def ends(angle: float) -> float:
        return half * abs(math.cos(angle))

    speed = math.sqrt(2 * g * (height - radius - ends(theta)))
    along, spin, found = 0.0, 0.0, []
    while True:
        x = -half * math.sin(theta) * math.copysign(1.0, math.cos(theta))
        z = -radius - ends(theta)
        before = (along + z * spin, -speed - x * spin)
        # (along', up', spin', P_x, P_z); the law gives the surface's velocity after the impact.
        rows = [
            ([mass, 0, 0, -1, 0], mass * along),
            ([0, mass, 0, 0, -1], -mass * speed),
            ([0, 0, body.transverse_inertia, -z, x], body.transverse_inertia * spin),
            ([0, 1, -x, 0, 0], -law.normal * before[1]),
            ([1, 0, z, 0, 0], law.tangential * before[0])
            if isinstance(law, rs.TangentialRestitution)
            else ([0, 0, 0, 1, 0], 0.0),
        ]
        along, up, spin, _, _ = np.linalg.solve([row for row, _ in rows], [value for _, value in rows])
        found.append((speed, up / speed))
        if up <= 0 or speed < 0.01:
            return found
        turned = theta + spin * 2 * up / g
        speed = math.sqrt(max(up**2 - 2 * g * (ends(turned) - ends(theta)), 0.0))
        theta += spin * (up + speed) / g
        if speed == 0.0:
            return found


@pytest.mark.parametrize("gravity", [9.81, 1.62])
@pytest.mark.parametrize(
    "law", [rs.TangentialRestitution(normal=0.8, tangential=-0.4), rs.Frictionless(normal=0.6)]
)
def test_moments_are_those_of_bodies_followed_one_by_one(
    law: rs.TangentialRestitution | rs.Frictionless, gravity: float
) -> None:
    """Angles are the middles of equal parts of [0, π); slow impacts and those of no bin do not count.

    The steps of the angle amplify rounding in later impacts: 1e-9 is far below the width of a bin.
    """
    body = rs.Dumbbell(radius=3e-3, separation=5e-4)
    edges = np.linspace(0.05, 0.95, 10)
    slowest = 0.6 * math.sqrt(gravity * 3e-3)
    every = [one_body((k + 0.5) * math.pi / 37, body, law, 0.05, gravity) for k in range(37)]
    found = near_round(body, law, velocity_bins=edges, release_height=0.05, gravity=gravity, angles=37)
    np.testing.assert_allclose(found["velocity"], 0.5 * (edges[1:] + edges[:-1]), rtol=1e-15)
    assert found["velocity"].attrs == {"units": "m s-1", "long_name": "impact velocity"}
    assert found["number"].dtype == np.int64
    told = 0
    for i in range(9):
        here = [e for body_ in every for v, e in body_ if max(edges[i], slowest) <= v < edges[i + 1]]
        one = found.isel(velocity=i)
        assert int(one.number) == len(here)
        if not here or edges[i] < slowest:
            for name in ("mean_restitution", "std_restitution", "second_moment"):
                assert np.isnan(one[name])
            continue
        told += 1
        assert float(one.mean_restitution) == pytest.approx(statistics.fmean(here), rel=1e-9)
        assert float(one.std_restitution) == pytest.approx(statistics.pstdev(here), rel=1e-7, abs=1e-12)
        assert float(one.second_moment) == pytest.approx(statistics.fmean(e * e for e in here), rel=1e-9)
    assert told >= 2


def test_numbers_at_the_ends_of_what_is_allowed() -> None:
    """One angle; the most angles; g and heights whose products are too large or too small for a double."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.5)
    alone = near_round(body, law, velocity_bins=[0.9, 1.2], angles=1)
    assert alone["number"].values.tolist() == [1]
    # θ = π/2: the lower end is L/2 aside.
    lying = 1.5 / (1 + body.mass * 1.5e-4**2 / body.transverse_inertia) - 1
    assert alone["mean_restitution"].values[0] == pytest.approx(lying, rel=1e-12)
    with pytest.raises(ValueError, match=r"gravity = 1e\+308: must be such that speeds neither overflow"):
        near_round(body, law, velocity_bins=EDGES, gravity=1e308, release_height=1e3)
    with pytest.raises(ValueError, match="angles = 1000001: must be a whole number"):
        near_round(body, law, velocity_bins=EDGES, angles=10**6 + 1)
    with pytest.raises(ValueError, match=r"release_height = .*: must be a number, the same for all"):
        near_round(body, law, velocity_bins=EDGES, release_height=rs.RandomHeight(0.05, 0.06))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"body = 3: must be a Dumbbell with equal spheres"):
        near_round(3, law, velocity_bins=EDGES)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"law = 3: must be TangentialRestitution or Frictionless"):
        near_round(body, 3, velocity_bins=EDGES)  # type: ignore[arg-type]
