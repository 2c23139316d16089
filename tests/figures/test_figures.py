"""Figures of one's own results: what is drawn is what was simulated."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution import figures as fg


def test_population_is_normalised_by_its_largest_and_blank_where_empty() -> None:
    """The paper's colour code, population over largest population; none has no colour on a log scale."""
    _, [[axes]] = fg.panels(fg.COLUMN, 2.0)
    sites = fg.population(axes, np.array([0.0, 1, 2]), np.array([0.0, 1, 2]), np.array([[4, 0], [1, 2]]))
    share: np.ma.MaskedArray[Any, Any] = np.ma.masked_array(sites.get_array())
    np.testing.assert_array_equal(share.mask, [[False, False], [True, False]])
    np.testing.assert_array_equal(share.compressed(), [1.0, 0.25, 0.5])
    with pytest.raises(ValueError, match="empty"):
        fg.population(axes, np.array([0.0, 1]), np.array([0.0, 1]), np.zeros((1, 1), np.int64))


def test_a_figure_of_ones_own_takes_three_lines(tmp_path: Path) -> None:
    """Maps, densities, scatter, moments and trajectories; saved under a string, as one file or as two."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.0, 1.1, 23),
        "restitution_bins": np.linspace(0.0, 2.0, 41),
    }
    found = rs.statistics(body, law, particles=200, **bins)
    both = rs.compare([body], [law, rs.Frictionless(normal=0.98)], particles=50, **bins)
    data = rs.simulate(body, law, particles=3, impacts=30)
    figures = {
        "map": rs.figures.map(found),
        "fraction": rs.figures.map(found, of="fraction"),
        "densities": rs.figures.densities(found, [0.2, 0.4]),
        "scatter": rs.figures.scatter({"one": found, "the same": found}),
        "compared": rs.figures.scatter(both),
        "moments": rs.figures.moments(found),
        "trajectory": rs.figures.trajectory(data, 1),
    }
    for name, drawn in figures.items():
        assert [path.name for path in rs.figures.save(drawn, str(tmp_path / name))] == [
            f"{name}.png",
            f"{name}.pdf",
        ]
    (svg,) = rs.figures.save(figures["map"], str(tmp_path / "map.svg"))
    assert svg.read_text(encoding="utf-8").startswith("<?xml")
    with pytest.raises(ValueError, match=r"velocities = 3.0: must be in \[0, 1.1\) m/s, the velocity bins"):
        rs.figures.densities(found, 3.0)
    with pytest.raises(ValueError, match="found lacks restitution_count"):
        rs.figures.map(data)
    with pytest.raises(ValueError, match=r"particle = 3: must be a whole number in \[0, 2\]"):
        rs.figures.trajectory(data, 3)


def test_the_drawn_trajectory_lands_where_the_body_touches(tmp_path: Path) -> None:
    """At every impact the centre of mass is R + L/2 |cos θ| high (Eqs. 2, 5): heights that only θ knows."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    data = rs.simulate(body, law, particles=1, impacts=12, seed=4)
    drawn = rs.figures.trajectory(data, impacts=12).axes[0].lines[0]
    time, height = np.asarray(drawn.get_xdata()), 1e-3 * np.asarray(drawn.get_ydata())
    landings = height.reshape(12, 40)[:, -1]
    np.testing.assert_allclose(time.reshape(12, 40)[:, -1], data.time[0], rtol=1e-15)
    expected = body.radius + body.separation / 2 * abs(np.cos(data.angle.values[0]))
    np.testing.assert_allclose(landings, expected, rtol=0, atol=1e-12)
