"""Figures of one's own results: what is drawn is what was simulated."""

import io
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import restitution as rs
from restitution import figures as fg
from restitution.figures import style


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
    for name in ("densities", "compared", "trajectory"):
        figures[name].savefig(io.BytesIO(), dpi=30)
    for name in ("map", "moments"):
        assert [path.name for path in rs.figures.save(figures[name], str(tmp_path / name))] == [
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


def test_bars_of_resting_are_the_shares_and_the_line_what_is_decided() -> None:
    """A bar for each face with its two shares; the line ends at the share that is decided at all."""
    brick = rs.Box(a=1e-2, b=2e-2, c=3e-2)
    run = rs.simulate(brick, rs.Frictionless(normal=0.5), particles=40, impacts=100, record="state")
    found = rs.resting(brick, run)
    shares, decided = rs.figures.resting(found).axes
    heights = [bar.get_extents().transformed(shares.transData.inverted()).height for bar in shares.patches]
    np.testing.assert_allclose(heights, [*found["most"], *found["least"]], atol=1e-12)
    assert np.asarray(decided.lines[0].get_ydata(), float)[-1] == pytest.approx(
        1.0 - found.attrs["undecided"]
    )
    with pytest.raises(ValueError, match="found lacks decided_after, height"):
        rs.figures.resting(run)


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


BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)


def test_styles_differ_in_size_and_ground_and_leave_the_callers_settings() -> None:
    """Slides have larger letters and figures than a journal; every ground is opaque; nothing leaks."""
    found = rs.statistics(
        BODY, LAW, particles=50, velocity_bins=[0.1, 0.3, 0.5], restitution_bins=np.linspace(0.5, 1.5, 51)
    )
    before = dict(mpl.rcParams)
    paper, slides = rs.figures.map(found), rs.figures.map(found, style="slides-dark")
    assert dict(mpl.rcParams) == before
    assert slides.get_size_inches()[0] > 1.5 * paper.get_size_inches()[0]
    assert slides.axes[0].xaxis.label.get_fontsize() == 2 * paper.axes[0].xaxis.label.get_fontsize()
    for figure, dark in ((paper, False), (slides, True)):
        ground, ink = mpl.colors.to_rgba(figure.get_facecolor()), figure.axes[0].xaxis.label.get_color()
        assert ground[3] == 1.0
        assert (luminance(ground) < luminance(mpl.colors.to_rgba(ink))) == dark
    with pytest.raises(ValueError, match="style = 'poster': must be one of 'paper', 'page', 'slides'"):
        rs.figures.map(found, style="poster")  # type: ignore[arg-type]


def luminance(color: Any) -> float:
    """Relative luminance as WCAG 2 defines it."""
    parts = np.array(color[:3])
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_line_colours_stand_out_from_their_ground() -> None:
    """WCAG 2 asks for a contrast of 3 of what must be seen; of Okabe and Ito's sky blue 2.3 is tolerated."""
    for colors, ground in ((style.COLORS, "#FFFFFF"), (style.ON_DARK, "#14181E")):
        base = luminance(mpl.colors.to_rgb(ground))
        for color in colors:
            light = sorted((base, luminance(mpl.colors.to_rgb(color))))
            least = 2.2 if color in ("#56B4E9", "#CC79A7") else 3.0
            assert (light[1] + 0.05) / (light[0] + 0.05) > least, color


def test_moments_of_a_learned_distribution_and_its_closed_form() -> None:
    """The drawn lines are the methods' values, the band their errors, the dashed line that of near_round."""
    learned = rs.FluctuatingRestitution.learn(BODY, LAW, particles=200, velocities=(0.3, 0.6), seed=1)
    near = rs.analytic.near_round(BODY, LAW, velocity_bins=np.linspace(0.3, 0.6, 7))
    figure = rs.figures.moments(learned, exact=near)
    speeds = learned.data["velocity"].to_numpy()
    for axes, values in zip(figure.axes[:2], (learned.mean(speeds), learned.std(speeds)), strict=True):
        drawn, closed = axes.lines
        shown = np.asarray(drawn.get_ydata(), dtype=float)
        known = np.isfinite(shown)
        assert known.sum() > 5
        np.testing.assert_allclose(shown[known], np.asarray(values)[known])
        assert closed.get_linestyle() == "--"
        assert axes.get_legend() is not None
    band = figure.axes[1].collections[0].get_paths()[0].vertices
    assert np.ptp(np.asarray(band)[:, 1]) > np.ptp(shown[known])
    legends = [axes.get_legend() for axes in learned.figure(style="page").axes]
    assert [len(one.get_texts()) for one in legends if one] == [5, 4, 2, 2]


def test_densities_beside_their_closed_form() -> None:
    """First impacts follow the density of `first_impact`: most bins within three Poisson errors of it."""
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    exact = rs.analytic.first_impact(body, LAW)
    found = rs.statistics(
        body,
        LAW,
        particles=5000,
        impacts=1,
        velocity_bins=[0.0, 2.0],
        restitution_bins=np.linspace(0.4, 1, 31),
    )
    axes = rs.figures.densities(found, 1.0, exact=exact).axes[0]
    (line,) = axes.lines
    x, density = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
    np.testing.assert_allclose(density, exact.pdf(x))
    (steps,) = (patch for patch in axes.patches if hasattr(patch, "get_data"))
    values, edges, _ = steps.get_data()
    expected = np.diff(exact.cdf(edges)) / np.diff(edges)
    error = np.sqrt(expected / (5000 * np.diff(edges)))
    inside = expected > 0
    assert np.mean(np.abs(values - expected)[inside] < 3 * error[inside]) > 0.9
    with pytest.raises(
        ValueError, match=r"exact = 3: must be what restitution.analytic.first_impact returns"
    ):
        rs.figures.densities(found, 1.0, exact=3)  # type: ignore[arg-type]


def test_the_rotational_share_over_velocity() -> None:
    """What is drawn is the mean fraction of the statistics, a line for each law, named."""
    laws = [LAW, rs.Frictionless(normal=0.98)]
    both = rs.compare(
        [BODY], laws, particles=100, velocity_bins=np.linspace(0.1, 1, 10), restitution_bins=[0.0, 1.0, 2.0]
    )
    axes = rs.figures.fraction(both).axes[0]
    for k, line in enumerate(axes.lines):
        one = both.isel(body=0, law=k)
        known = (one["number"] >= 100).to_numpy()
        np.testing.assert_array_equal(
            np.asarray(line.get_ydata())[known], one["mean_fraction"].to_numpy()[known]
        )
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["TangentialRestitution", "Frictionless"]
