"""What a learned distribution knows, and what it says of what it does not: gaps, tails, moments, heights."""

import ctypes
import shutil
import subprocess
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution import FluctuatingRestitution
from restitution.distribution._check import largest_distance
from restitution.distribution._ensemble import Impacts
from restitution.distribution._nodes import Met
from restitution.distribution.sources import header

BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.9)
HOW: dict[str, Any] = {"particles": 4000, "impacts": 8, "release_height": 0.06}
NODES = [0.8, 0.89, 0.99, 1.06]


@pytest.fixture(scope="module", params=[1, 2])
def gappy(request: pytest.FixtureRequest) -> FluctuatingRestitution:
    """From one height: the first impacts have bands of speeds, with nothing between them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.DistanceWarning)
        return FluctuatingRestitution.learn(BODY, LAW, **HOW, seed=request.param, velocities=NODES)


def test_gaps_are_found_in_planted_speeds() -> None:
    """Speeds with holes: those of a per cent and more are found to a quarter of a per cent, no others."""
    for seed in range(5):
        rng = np.random.default_rng(seed)
        v = np.exp(rng.uniform(np.log(0.1), 0.0, 200_000))
        holes = [(0.2, 0.21), (0.5, 0.6), (0.8, 0.802), (0.97, 1.0)]
        for low, high in holes:
            v = v[(v < low) | (v >= high)]
        met = Met(0.1, 1.0)
        for part in np.array_split(v, 3):
            assert (
                next(met.watch([Impacts(part[:, None], part[:, None], np.empty((0, 0)))])).velocity
                is not None
            )
        found = met.gaps()
        assert len(found) == 3
        np.testing.assert_allclose(found, [holes[0], holes[1], holes[3]], rtol=0.0026)
        assert all(
            start >= low * 0.999 and end <= high * 1.001
            for (start, end), (low, high) in zip(found, [holes[0], holes[1], holes[3]], strict=True)
        )


def test_speeds_without_impacts_are_refused(gappy: FluctuatingRestitution) -> None:
    """By every method, and by nothing that `clamped` returns; the gaps hold no impact of the same run."""
    assert len(gappy.gaps) >= 2
    speeds = rs.simulate(BODY, LAW, **HOW, seed=77).impact_velocity.to_numpy()
    for start, end in gappy.gaps:
        inside = (speeds > 1.003 * start) & (speeds < 0.997 * end)
        assert np.count_nonzero(inside) < 1e-3 * speeds.size
        middle = 0.5 * (start + end)
        for ask in (gappy.mean, gappy.std, gappy.kurtosis, gappy.rvs, gappy.resolved, gappy.mean_error):
            with pytest.raises(
                ValueError, match=r"^v = .*: must be outside \[.*\) m/s, where no impact was seen"
            ):
                ask(middle)
        assert np.isfinite(gappy.clamped().std(middle))
        assert f"no impact at {start:.4g} to {end:.4g} m/s" in gappy.summary()
    assert f"{len(gappy.gaps)} gaps" in repr(gappy)


def test_gaps_are_drawn_as_gaps(gappy: FluctuatingRestitution) -> None:
    axes = gappy.figure().axes[2]
    v, sigma = np.asarray(axes.lines[0].get_xdata()), np.asarray(axes.lines[0].get_ydata())
    for start, end in gappy.gaps:
        assert np.isnan(sigma[(v >= start) & (v < end)]).all()
        assert np.any((v > start) & (v < end))


def test_gaps_travel(gappy: FluctuatingRestitution, tmp_path: Path) -> None:
    """Through a file, and into a sampler that gives NaN there."""
    gappy.save(tmp_path / "dist.nc")
    again = FluctuatingRestitution.load(tmp_path / "dist.nc")
    np.testing.assert_array_equal(again.gaps, gappy.gaps)
    text = header(gappy.data, "grain")
    assert f"No impact was seen between {gappy.gaps[0, 0]:.6g}" in text
    assert "gap_lowest[" in text
    assert "gap_lowest" not in header(gappy.clamped().data, "grain")
    assert "gap_lowest" not in header(again.data.drop_dims("gap"), "grain")
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no compiler")
    (tmp_path / "grain.c").write_text(f"{text}\ndouble f(double v) {{ return grain_sample(v, 0.3, 0.4); }}\n")
    flags = ["-std=c99", "-Wall", "-Werror", "-shared", "-fPIC", "-o"]
    subprocess.run([compiler, *flags, tmp_path / "grain.so", tmp_path / "grain.c"], check=True)
    sample = ctypes.CDLL(str(tmp_path / "grain.so")).f
    sample.argtypes, sample.restype = [ctypes.c_double], ctypes.c_double
    for start, end in gappy.gaps:
        assert np.isnan(sample(0.5 * (start + end)))
        assert np.isnan(sample(start))
    met = next(
        v for v in np.linspace(0.8, 1.05, 500) if not np.any((v >= gappy.gaps[:, 0]) & (v < gappy.gaps[:, 1]))
    )
    assert np.isfinite(sample(met))


def test_the_same_words_give_the_same_numbers() -> None:
    """A height that is given is that of `statistics`: mean, σ and kurtosis agree within four errors.

    Other seeds, and the convention of the kurtosis: with the other one it would be off by 3.
    """
    smooth = rs.TangentialRestitution(normal=0.98)
    for seed in (1, 2, 3):
        how: dict[str, Any] = {"particles": 3000, "impacts": 300, "release_height": 0.06}
        dist = FluctuatingRestitution.learn(BODY, smooth, **how, seed=seed, velocities=(0.36, 0.46))
        edges = np.array([0.39, 0.41])
        bins: dict[str, Any] = {"velocity_bins": edges, "restitution_bins": np.linspace(-1.0, 3.0, 401)}
        found = rs.statistics(BODY, smooth, **how, seed=seed + 10, **bins).isel(velocity=0)
        v = 0.4
        pairs = [
            (dist.mean(v), dist.mean_error(v), found.mean_restitution, found.mean_restitution_error),
            (dist.var(v), dist.var_error(v), found.variance, found.variance_error),
            (dist.skewness(v), dist.skewness_error(v), found.skewness, found.skewness_error),
            (dist.kurtosis(v), dist.kurtosis_error(v), found.kurtosis, found.kurtosis_error),
        ]
        for ours, error, theirs, other in pairs:
            assert abs(ours - float(theirs)) < 4.5 * np.hypot(error, float(other)) + 0.02 * abs(ours)
    assert "released from 0.06 m" in dist.summary()
    assert "heights_about" not in dist.data.attrs


def test_heights_are_spread_where_none_is_given() -> None:
    how: dict[str, Any] = {"particles": 2000, "impacts": 100, "velocities": (0.3, 0.6)}
    one = FluctuatingRestitution.learn(BODY, LAW, **how)
    assert one.data.attrs["heights_about"] == 0.06
    assert "heights, 0.0" in one.summary()
    assert "spread about 0.06 m" in one.summary()
    assert FluctuatingRestitution.learn(BODY, LAW, **how, heights_about=0.06) == one
    high = FluctuatingRestitution.learn(BODY, LAW, **how, heights_about=0.12)
    assert min(high.data.attrs["release_height"]) < 0.12 < max(high.data.attrs["release_height"])
    with pytest.raises(
        ValueError, match=r"^heights_about = 0.1: must be None, because release_height is given"
    ):
        FluctuatingRestitution.learn(BODY, LAW, **how, release_height=0.06, heights_about=0.1)
    with pytest.raises(ValueError, match=r"^heights_about = 'high': must be a height"):
        FluctuatingRestitution.learn(BODY, LAW, **how, heights_about="high")  # type: ignore[arg-type]


def test_errors_of_skewness_and_kurtosis_are_those_of_repetition() -> None:
    """Twenty seeds: stated errors are the scatter, within 4/√38 of it and the 1/√62 of 32 batches.

    At a node, where what is stated is the error, and not what it is at most.
    """
    how: dict[str, Any] = {"particles": 640, "impacts": 60, "velocities": [0.5, 0.6, 0.7]}
    found = [FluctuatingRestitution.learn(BODY, LAW, **how, seed=seed) for seed in range(20)]
    for name in ("skewness", "kurtosis"):
        values = np.array([getattr(one, name)(0.6) for one in found])
        errors = np.array([getattr(one, f"{name}_error")(0.6) for one in found])
        ratio = np.sqrt(np.mean(errors**2)) / np.std(values, ddof=1)
        assert abs(ratio - 1.0) < 4 / np.sqrt(38), name


def test_tails_are_resolved_to_one_impact(gappy: FluctuatingRestitution) -> None:
    number = gappy.data["impacts"].to_numpy()
    spread = gappy.clamped()
    np.testing.assert_allclose(spread.resolved(gappy.data["velocity"].to_numpy()), 1.0 / number)
    worst = 1.0 / number.min()
    digit = repr(gappy).split("tails to ")[1].split(",")[0]
    assert float(digit) == pytest.approx(worst, rel=0.5)
    assert f"tails to {digit}" in gappy.summary()
    assert f"of {number.min():.0f} to {number.max():.0f} impacts" in gappy.summary()


def test_energy_that_is_created_is_said() -> None:
    paper = rs.TangentialRestitution(normal=0.98)
    how: dict[str, Any] = {"particles": 2000, "impacts": 200, "velocities": (0.3, 0.6)}
    with pytest.warns(rs.EnergyWarning, match="created kinetic energy in"):
        dist = FluctuatingRestitution.learn(BODY, paper, **how)
    data = rs.simulate(
        BODY, paper, particles=2000, impacts=200, minimum_speed=dist.data.attrs["minimum_speed"]
    )
    share = dist.data.attrs["energy_created_share"]
    assert share == pytest.approx(data.attrs["energy_created_share"], rel=0.2)
    for text in (dist.summary(), header(dist.data, "grain")):
        assert "of the impacts created kinetic energy" in text
    with warnings.catch_warnings():
        warnings.simplefilter("error", rs.EnergyWarning)
        quiet = FluctuatingRestitution.learn(BODY, rs.Frictionless(normal=0.9), **how)
    assert "kinetic energy" not in quiet.summary()


def test_summary_warning_and_header_name_the_same_worst_speed() -> None:
    with pytest.warns(rs.DistanceWarning) as caught:
        dist = FluctuatingRestitution.learn(BODY, LAW, **HOW, velocities=NODES)
    text = largest_distance(dist.data)
    worst = int(np.argmax(dist.data["ks_distance"].to_numpy()))
    assert f"{float(dist.data['ks_distance'][worst]):.4f} from" in text
    assert f"at {float(dist.data['velocity'][worst]):.4g} to" in text
    warned = next(str(one.message) for one in caught if one.category is rs.DistanceWarning)
    assert text in warned
    assert text in dist.summary()
    assert text in " ".join(header(dist.data, "grain").replace(" * ", " ").split())


def test_headers_state_the_whole_ensemble() -> None:
    """Every height where they are few, else their number and their ends; nothing is cut off."""
    how: dict[str, Any] = {"particles": 2000, "impacts": 60, "velocities": (0.3, 0.6)}
    heights = np.linspace(0.055, 0.065, 20)
    text = header(FluctuatingRestitution.learn(BODY, LAW, **how, release_height=heights).data, "grain")
    for height in heights:
        assert repr(float(height)) in text
    many = FluctuatingRestitution.learn(BODY, LAW, **how)
    spread = many.data.attrs["release_height"]
    text = header(many.data, "grain")
    assert f"{len(spread)} numbers from {min(spread):.9g} to {max(spread):.9g}" in text
    assert "heights_about = 0.06" in text
    assert "..." not in text
    assert max(map(len, text.split("*/")[0].splitlines())) < 100
