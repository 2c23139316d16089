"""docs/theory.md: what its programs print agrees with other runs of the same bodies."""

import re
from pathlib import Path

import numpy as np

import restitution as rs

PAGE = (Path(__file__).parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")


def test_sigma_of_two_heights_is_that_of_other_seeds() -> None:
    """Within four combined standard errors, from recorded impacts and not from counts."""
    printed = re.findall(r"# (0\.\d+) m: σ = ([\d.]+) ± ([\d.]+)", PAGE)
    assert [height for height, *_ in printed] == ["0.06", "0.24"]
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    for height, *numbers in printed:
        sigma, error = map(float, numbers)
        for seed in (11, 12):
            data = rs.simulate(
                body, law, particles=3000, release_height=float(height), minimum_speed=0.2, seed=seed
            )
            v, epsilon = data.impact_velocity.to_numpy(), data.restitution.to_numpy()
            near = (v >= 0.39) & (v < 0.41)
            particles = [epsilon[i][near[i]] for i in np.flatnonzero(near.any(axis=1))]
            own = np.std(np.concatenate(particles))
            random = np.random.default_rng(seed)
            again = [
                np.std(
                    np.concatenate(
                        [particles[i] for i in random.integers(len(particles), size=len(particles))]
                    )
                )
                for _ in range(100)
            ]
            assert abs(own - sigma) < 4 * np.hypot(error, np.std(again))
