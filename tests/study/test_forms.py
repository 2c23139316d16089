"""[learn] and [fit] of a study: quantiles and parameters beside those of recorded impacts of the same run."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.study import sweep

WINDOW = (0.4, 0.5)


def tables(**more: object) -> dict[str, object]:
    return {
        "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
        "law": rs.TangentialRestitution(normal=0.98),
        "run": {"particles": 1024, "impacts": 60, "seed": 7},
        "sweep": {"body.separation": [3e-4, 2e-3]},
        "statistics": {
            "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
            "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 1000},
        },
        **more,
    }


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> xr.Dataset:
    forms = {"learn": {"levels": [0.1, 0.5, 0.9]}, "fit": {"velocity": WINDOW, "location": "normal"}}
    return sweep(tables(**forms), tmp_path_factory.mktemp("forms") / "s.zarr").load()


def recorded(separation: float) -> xr.Dataset:
    body, law = rs.Dumbbell(radius=3e-3, separation=separation), rs.TangentialRestitution(normal=0.98)
    return rs.simulate(body, law, particles=1024, impacts=60, seed=7)


def test_moments_of_a_study_are_drawn_by_point(found: xr.Dataset) -> None:
    """A line for each, named by the value of what varies; too many are refused with what to do."""
    assert rs.figures.moments(found).legends[0].get_title().get_text() == "separation (m)"
    axes = rs.figures.scatter(found).axes[0]
    assert axes.get_legend_handles_labels()[1] == ["0.0003", "0.002"]
    shown = np.asarray(axes.lines[1].get_ydata(), float)
    expected = found["std_restitution"].isel(separation=1).to_numpy()
    np.testing.assert_allclose(shown[np.isfinite(shown)], expected[np.isfinite(shown)])
    many = found.isel(separation=[0] * 25)
    with pytest.raises(ValueError, match="found has 25 points in separation: must be at most 24; take some"):
        rs.figures.moments(many)


def test_quantiles_are_those_of_the_impacts_of_each_bin(found: xr.Dataset) -> None:
    """To a bin of 0.004 where bins are not thinned; from thinned bins to two thinned ones, 0.02 here."""
    assert found["restitution_quantile"].dims == ("separation", "velocity", "level")
    for separation in found["separation"].values:
        data = recorded(float(separation))
        v, epsilon = data["impact_velocity"].values, data["restitution"].values
        point = found.sel(separation=separation)
        for low in (0.3, 0.4, 0.6):
            exact = np.quantile(epsilon[(v >= low) & (v < low + 0.1)], [0.1, 0.5, 0.9])
            row = point.sel(velocity=low + 0.05, method="nearest")
            reach = 0.004 + 0.02 * row["std_restitution"].item() / 0.05
            assert np.abs(row["restitution_quantile"] - exact).max() < reach
    few = found["number"].values < 500
    assert few.any()
    assert np.isnan(found["restitution_quantile"].values[few]).all()


def test_standard_errors_of_quantiles_are_those_of_fresh_seeds(found: xr.Dataset, tmp_path: Path) -> None:
    """The median over 12 other seeds scatters by its error.

    Both are uncertain: the scatter by 1/√22 = 21 %, the error over 16 groups by 18 %, and jackknives of
    quantiles somewhat more; a factor 2.5 either way is beyond three of these.
    """
    run = {"particles": 512, "impacts": 60}
    body = rs.Dumbbell(radius=3e-3, separation=2e-3)
    varied = {"run.seed": list(range(20, 32))}
    study = tables(body=body, run=run, sweep=varied, learn={"levels": [0.5]})
    one = sweep(study, tmp_path / "s.zarr").sel(level=0.5).sel(velocity=[0.35, 0.45, 0.55], method="nearest")
    errors = one["restitution_quantile_error"].values
    ratio = np.sqrt(np.mean(errors**2, axis=0)) / one["restitution_quantile"].values.std(axis=0, ddof=1)
    assert 0.4 < np.exp(np.mean(np.log(ratio))) < 2.5


def test_the_fit_is_that_of_the_recorded_impacts(found: xr.Dataset) -> None:
    """Flanks of 0.02 in bins of 0.004: the likelihood of bins differs from that of samples by little.

    A tenth of a standard error is allowed, which is over particles: the bootstrap of the recorded impacts
    agrees with it within a third, three times what 16 groups and 60 resamples scatter together.
    """
    for separation in found["separation"].values:
        data, point = recorded(float(separation)), found.sel(separation=separation)
        boot = rs.fit.bootstrap(
            lambda x, **how: rs.fit.asymmetric_laplace(x, 0.98, **how), data, velocity=WINDOW, resamples=60
        )
        for name in ("above", "below"):
            error = float(point[f"fit_{name}_error"])
            assert abs(float(point[f"fit_{name}"]) - boot.fit.parameters[name]) < 0.1 * error + 2e-4
            assert abs(np.log(error / boot.standard_errors[name])) < 0.9
        assert float(point["fit_location"]) == 0.98
        assert 0.0 < float(point["fit_distance"]) < 0.2


def test_a_point_that_cannot_be_fitted_has_none(tmp_path: Path) -> None:
    """A body so round that all impacts are in a bin; the other points are as ever."""
    varied = {"body.separation": [3e-9, 3e-4]}
    study = tables(sweep=varied, fit={"family": "gaussian", "velocity": WINDOW})
    one = sweep(study, tmp_path / "s.zarr").load()
    assert np.isnan(one["fit_mean"].values).tolist() == [True, False]
    assert one["fit_mean"].values[1] == pytest.approx(0.98, abs=0.01)
    assert (one["status"] == 1).all()


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"learn": {"levels": 1}}, r"learn.levels = 1: must be a number of levels in \[2,"),
        ({"learn": {"levels": [0.5, 0.2]}}, "increasing levels in"),
        ({"learn": {"level": 3}}, "learn.level: unknown; did you mean learn.levels"),
        ({"learn": 3}, r"learn = 3: must be a table \[learn\]"),
        ({"learn": {}, "statistics": {"restitution_bins": [0, 1]}}, "statistics.velocity_bins: missing"),
        ({"fit": {}}, "fit.velocity: missing"),
        ({"fit": {"velocity": [0.42, 0.5]}}, "edges of velocity bins"),
        ({"fit": {"velocity": WINDOW, "family": "normal"}}, "fit.family = 'normal': must be 'asymmetric"),
        ({"fit": {"velocity": WINDOW, "family": "cusp-mixture"}}, "needs location = 'normal'"),
        ({"fit": {"velocity": WINDOW, "family": "gaussian", "location": "normal"}}, "a family with a cusp"),
        (
            {
                "fit": {"velocity": WINDOW, "location": "normal"},
                "law": rs.TangentialRestitution(normal=rs.Plastic(yield_speed=0.1)),
            },
            "depends on the speed",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(tmp_path: Path, more: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sweep(tables(**more), tmp_path / "s.zarr")
    assert list(tmp_path.iterdir()) == []
