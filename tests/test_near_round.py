"""`analytic.near_round`: the exact engine's moments, without its search for contacts."""

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
