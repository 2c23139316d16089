"""Shape and roughness together: the scatters of a smooth dumbbell and of a rough sphere add."""

import numpy as np
import pytest
from numpy.typing import NDArray
from test_measuring_pages import script

Array = NDArray[np.float64]


def test_scatters_add_and_roughness_rules_beyond_its_height(monkeypatch: pytest.MonkeyPatch) -> None:
    """L/R = 0.2, h_0 above L²/11.3R; the sum to five standard errors, and a quarter of the next order."""
    study = script("imperfections")
    for name, value in {"ELONGATIONS": (0.2,), "HEIGHTS": (3e-5,)}.items():
        monkeypatch.setattr(study, name, value)
    found = study.measure(particles=25, surfaces=8)
    share, error = study.share(found)
    assert np.all(share > 0.5 + 5.0 * error)
    ratio = found["both"][0, 0] / (found["shape"][0] + found["roughness"][0])
    assert np.all(np.abs(ratio - 1.0) < 5.0 * found["both_error"][0, 0] / found["both"][0, 0] + 0.25)
    height, elongation = 3e-5, 0.2 * 3e-3
    closed = 8.0 * np.sqrt(2.0) * height * 3e-3 / elongation**2  # σ_r/σ_s
    assert found["roughness"][0] / found["shape"][0] == pytest.approx(closed, rel=0.4)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("in_space", [False, True])
def test_what_the_page_derives(in_space: bool, seed: int) -> None:
    """Spins of twelve kicks: equal at L²/(8√2 R), and what both make of it, to five standard errors.

    First order, R = 1: the kick is the lever arm, and ε is spin times lever arm.
    """
    random, bodies, elongation = np.random.default_rng(seed), 60_000, 0.1
    height = elongation**2 / (8.0 * np.sqrt(2.0))

    def arms(shape: bool, rough: bool, space: bool) -> Array:
        found: Array = random.normal(0.0, np.sqrt(height) if rough else 0.0, (bodies, 2))
        angle = random.uniform(0.0, 2.0 * np.pi, bodies)
        sine = np.sqrt(1.0 - random.uniform(-1.0, 1.0, bodies) ** 2) if space else np.sin(angle)
        way = np.array([np.cos(angle), np.sin(angle)]) if space else np.sign([np.cos(angle), 0.0 * angle])
        found += (0.5 * elongation * shape * sine * way).T
        return found

    def scatter(*how: bool) -> float:
        spin = np.sum([arms(*how) for _ in range(12)], axis=0)
        return float((spin * arms(*how)).sum(axis=1).std())

    alone, rough = scatter(True, False, False), scatter(False, True, False)
    assert alone / rough == pytest.approx(1.0, abs=0.03)
    expected = (4.0 / 3.0 / np.sqrt(2.0) + 1.0) / 2.0 if in_space else np.sqrt((1.0 + np.sqrt(0.5)) / 2.0)
    assert scatter(True, True, in_space) / (alone + rough) == pytest.approx(expected, abs=0.03)


def test_the_table_has_every_body() -> None:
    study = script("imperfections")
    ones = np.ones((4, 5, 4))
    found = {"both": 2.0 * ones, "shape": ones[:, 0], "roughness": ones[0]}
    found |= {f"{name}_error": 0.01 * value for name, value in found.items()}
    rows = study.table(found).splitlines()
    assert len(rows) == 2 + 4
    assert rows[3] == "| 0.05 | " + " | ".join(["1.00 ± 0.01"] * 5) + " |"
