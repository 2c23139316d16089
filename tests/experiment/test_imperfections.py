"""Shape and roughness together: the scatters of a smooth dumbbell and of a rough sphere add."""

import numpy as np
import pytest
from test_measuring_pages import script


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


def test_the_table_has_every_body() -> None:
    study = script("imperfections")
    ones = np.ones((4, 5, 4))
    found = {"both": 2.0 * ones, "shape": ones[:, 0], "roughness": ones[0]}
    found |= {f"{name}_error": 0.01 * value for name, value in found.items()}
    rows = study.table(found).splitlines()
    assert len(rows) == 2 + 4
    assert rows[3] == "| 0.05 | " + " | ".join(["1.00 ± 0.01"] * 5) + " |"
