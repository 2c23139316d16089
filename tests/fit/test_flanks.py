"""Flanks of ε against velocity and their power laws, worked out again bin by bin."""

from math import exp, inf, isnan, log, sqrt
from statistics import stdev
from typing import Any

import numpy as np
import pytest
import xarray as xr

from reference.scattered import EDGES, distance, impacts
from restitution import fit
from restitution.fit import Slopes
from restitution.fit._slopes import _again, _deviation

Counts: Any = fit.Counts  # lists are taken, though its fields are arrays


def known_slopes() -> Slopes:
    """Give five bins whose flanks, errors and redrawn flanks are written down; one has no fit."""
    v = np.array([0.2, 0.3, 0.4, 0.6, 0.9])
    above = np.array([0.05, 0.034, 0.024, np.nan, 0.012])
    error = np.array([0.002, 0.001, 0.003, np.nan, 0.0005])
    rng = np.random.default_rng(3)
    drawn = above * np.exp(0.05 * rng.normal(size=(7, 5)))
    drawn[4, 0] = np.nan  # a draw that could not be fitted
    drawn[5, 1] = 0.0  # and one with all samples on one side of the cusp
    table = xr.Dataset(
        {
            "above": ("velocity", above),
            "above_error": ("velocity", error),
            "ks_distance": ("velocity", [0.05, 0.03, 0.04, 0.03, np.nan]),
            "velocity_edges": ("velocity_edge", [0.15, 0.25, 0.35, 0.5, 0.7, 1.1]),
        },
        coords={"velocity": v},
        attrs={"standard_errors": "over resampled particles"},
    )
    return Slopes(table, xr.Dataset({"above": (("resample", "velocity"), drawn)}, coords={"velocity": v}))


@pytest.mark.parametrize("release", [None, 1.5])
def test_power_law_is_the_weighted_line(release: float | None) -> None:
    """Normal equations of the line through ln y, by hand; the ends of the range belong to it."""
    given = known_slopes()
    v, y = given.table["velocity"].to_numpy(), given.table["above"].to_numpy()
    used = [0, 1, 2, 4]

    def line(values: Any, weights: list[float]) -> tuple[float, float]:
        x = [log(v[i]) if release is None else log(sqrt(release**2 / v[i] ** 2 - 1)) for i in used]
        z = [log(values[i]) for i in used]
        w = [one**2 for one in weights]
        mean_x = sum(a * b for a, b in zip(w, x, strict=True)) / sum(w)
        mean_z = sum(a * b for a, b in zip(w, z, strict=True)) / sum(w)
        slope = sum(a * (b - mean_x) * (d - mean_z) for a, b, d in zip(w, x, z, strict=True)) / sum(
            a * (b - mean_x) ** 2 for a, b in zip(w, x, strict=True)
        )
        return slope, mean_z - slope * mean_x

    def residuals(weights: list[float]) -> list[float]:
        slope, intercept = line(y, weights)
        x = [log(v[i]) if release is None else log(sqrt(release**2 / v[i] ** 2 - 1)) for i in used]
        return [log(y[i]) - intercept - slope * x[k] for k, i in enumerate(used)]

    error = given.table["above_error"].to_numpy()
    weights = [y[i] / error[i] for i in used]
    slope, intercept = line(y, weights)
    found = given.power_law("above", 0.2, 0.9, release_speed=release)
    assert found.exponent == pytest.approx(slope, rel=1e-10)
    assert found.amplitude == pytest.approx(exp(intercept), rel=1e-10)
    off = residuals(weights)
    assert found.scatter == pytest.approx(sqrt(sum(r**2 for r in off) / 2), rel=1e-9)
    misfit = sqrt(sum((r * w) ** 2 for r, w in zip(off, weights, strict=True)) / 2)
    assert found.misfit == pytest.approx(misfit, rel=1e-9)
    again = [line(one, weights) for one in given.resampled["above"].to_numpy() if np.all(one[used] > 0)]
    assert len(again) == 5
    assert found.exponent_error == pytest.approx(stdev(one[0] for one in again), rel=1e-9)
    assert found.amplitude_error == pytest.approx(exp(intercept) * stdev(one[1] for one in again), rel=1e-9)
    assert found.without_errors == ""

    given.table["above_error"][2] = 0.0  # without an error of one bin, all weigh the same
    unweighted = given.power_law("above", 0.2, 0.9, release_speed=release)
    assert unweighted.exponent == pytest.approx(line(y, [1.0] * 4)[0], rel=1e-10)
    assert unweighted.scatter == pytest.approx(sqrt(sum(r**2 for r in residuals([1.0] * 4)) / 2), rel=1e-9)
    assert isnan(unweighted.misfit)


def test_power_law_needs_three_bins_and_two_draws() -> None:
    given = known_slopes()
    without = given.power_law("above")
    given.table["above"][3] = 0.0  # a flank without a width has no logarithm, as one that is not known
    assert given.power_law("above") == without
    assert given.power_law("above", 0.2, 0.4).exponent == pytest.approx(-1.0, abs=0.2)
    for low, high in ((0.2, 0.39), (0.21, 0.6)):
        with pytest.raises(ValueError, match="fewer than three bins have a fit there"):
            given.power_law("above", low, high)
    with pytest.raises(ValueError, match=r"release_speed = 0\.9: must be above 0\.9 m/s"):
        given.power_law("above", release_speed=0.9)
    pair = Slopes(given.table, given.resampled.isel(resample=[0, 1]))
    assert pair.power_law("above").exponent_error > 0
    assert pair.power_law("above").without_errors == ""
    alone = Slopes(given.table, given.resampled.isel(resample=[0])).power_law("above")
    assert isnan(alone.exponent_error)
    assert isnan(alone.amplitude_error)
    assert alone.without_errors == "over resampled particles"


def test_the_end_of_the_form_is_an_edge() -> None:
    """A distance that is just allowed is allowed; a bin without a fit is far; the fastest may be left out."""
    given = known_slopes()
    assert isnan(given.fails_below(0.05))  # the fastest bin has no distance
    assert given.fails_below(0.03, high=0.6) == 0.5
    assert isnan(given.fails_below(0.029, high=0.6))
    assert given.fails_below(0.04, high=0.6) == given.fails_below(0.045, high=0.6) == 0.25
    assert given.fails_below(0.05, high=0.6) == 0.15
    assert given.fails_below(high=0.6) == given.fails_below(0.03, high=0.6)


def test_arguments_of_the_slopes_are_named() -> None:
    given = known_slopes()
    data = impacts()
    wrong: list[tuple[Any, str]] = [
        (lambda: given.power_law("above", low=np.nan), r"low = nan: must be a speed in m/s"),
        (lambda: given.power_law("above", high=np.nan), r"high = nan: must be a speed in m/s"),
        (lambda: given.power_law("above", release_speed=inf), "release_speed = inf: must be a finite speed"),
        (lambda: given.fails_below(np.nan), "distance = nan: must be a number"),
        (lambda: given.fails_below(0.03, np.nan), "high = nan: must be a speed in m/s"),
        (lambda: fit.slopes(data, EDGES, location=inf), "location = inf: must be a finite number"),
        (lambda: fit.slopes(data, EDGES, seed=-1), "seed = -1"),
    ]
    for call, text in wrong:
        with pytest.raises(ValueError, match=text):
            call()
    other = xr.DataArray(0.2, attrs={"units": "mm"})
    for name in ("low", "high", "release_speed"):
        arguments: dict[str, Any] = {name: other}
        with pytest.raises(ValueError, match=f"{name}.*m s-1"):
            given.power_law("above", **arguments)
    with pytest.raises(ValueError, match=r"high.*m s-1"):
        given.fails_below(0.03, other)  # type: ignore[arg-type]


def test_slopes_fit_what_is_in_each_bin() -> None:
    """Bins closed below and open above; draws of the same particles in all; the cusp given or fitted."""
    data = impacts(particles=12, each=60, seed=5)
    v, e = data["impact_velocity"].to_numpy(), data["restitution"].to_numpy()
    v[v >= EDGES[3]] = 2.0
    v[:2, :4] = 1.05  # eight impacts of two particles are not enough
    data["impact_velocity"][:] = v
    times = np.random.default_rng(4).multinomial(12, np.full(12, 1 / 12), size=5)
    for location in (None, 0.9):
        found = fit.slopes(data, EDGES, location=location, resamples=5, seed=4)
        assert dict(found.table.sizes) == {"velocity": 4, "velocity_edge": 5}
        assert found.table.attrs["standard_errors"] == "over resampled particles"
        np.testing.assert_allclose(found.resampled["velocity"], found.table["velocity"], rtol=0)
        for i in range(4):
            inside = (v >= EDGES[i]) & (v < EDGES[i + 1]) & np.isfinite(e)
            one = found.table.isel(velocity=i)
            assert int(one.particles) == np.count_nonzero(inside.any(axis=1))
            if i == 3:
                assert int(one.samples) == 0
                assert isnan(one.above)
                assert isnan(one.above_error)
                assert np.isnan(found.resampled["above"].isel(velocity=i)).all()
                continue
            assert int(one.samples) == np.count_nonzero(inside)
            whole = fit.asymmetric_laplace(e[inside], location)
            assert float(one.ks_distance) == pytest.approx(distance(e[inside], whole), rel=1e-12)
            for name in ("location", "above", "below"):
                assert float(one[name]) == pytest.approx(whole.parameters[name], rel=1e-9)
                draws = []
                for row in times:
                    again = np.concatenate([np.repeat(e[p][inside[p]], row[p]) for p in range(12)])
                    draws.append(fit.asymmetric_laplace(again, location).parameters[name])
                np.testing.assert_allclose(found.resampled[name].isel(velocity=i), draws, rtol=1e-9)
                assert float(one[f"{name}_error"]) == pytest.approx(stdev(draws), rel=1e-7, abs=1e-15)


def test_draws_that_cannot_be_fitted_are_left_out() -> None:
    """None of the bin's particles, or equal samples alone; the deviation is that of the others, if two."""
    x = np.array([0.8, 0.9, 1.0])
    for times in ([0, 0, 0], [0, 2, 0], [0, 1, 0]):
        assert np.isnan(_again(x, np.array(times), 0.9)).all()
    for times in ([2, 0, 1], [1, 0, 2], [0, 2, 1], [1, 2, 0]):
        assert np.isfinite(_again(x, np.array(times), 0.9)).all()
    known = np.array([[0.9, 0.1, 0.2], [0.92, 0.12, 0.25]])
    nothing = np.full((1, 3), np.nan)
    np.testing.assert_allclose(
        _deviation(np.concatenate([known, nothing])), np.array([0.02, 0.02, 0.05]) / sqrt(2), rtol=1e-12
    )
    for few in (known[:1], nothing):
        assert np.isnan(_deviation(few)).tolist() == [True] * 3


def test_the_least_that_is_fitted() -> None:
    """Thirty samples of ten particles just do; of equal ones, of 29, of nine particles, no fit is made.

    A bin after one without a fit has its own. Of those that are equal but for one there is a fit.
    """
    rng = np.random.default_rng(6)
    v = np.concatenate([np.full((10, 3), 0.25), np.full((10, 3), 0.4), np.full((10, 3), 0.7)], axis=1)
    e = rng.normal(0.9, 0.1, v.shape)
    dims = ("particle", "impact")

    def fitted(restitution: np.ndarray, velocity: np.ndarray = v) -> list[int]:
        data = xr.Dataset({"impact_velocity": (dims, velocity), "restitution": (dims, restitution)})
        return [int(n) for n in fit.slopes(data, EDGES, location=0.9, resamples=3).table["samples"]]

    assert fitted(e) == [30, 30, 30, 0]
    equal = e.copy()
    equal[:, :3] = 0.9
    assert fitted(equal) == [0, 30, 30, 0]
    for p, n, value in ((0, 0, 0.8), (9, 2, 1.0)):
        one_other = equal.copy()
        one_other[p, n] = value
        assert fitted(one_other) == [30, 30, 30, 0]
    few = e.copy()
    few[0, 4] = np.nan
    assert fitted(few) == [30, 0, 30, 0]
    nine = np.insert(v, 0, 2.0, axis=1)
    nine[0, 7:] = 2.0
    nine[1, 0] = 0.7
    nine[2, 0] = nine[3, 0] = 0.7  # as many samples, of nine particles
    assert fitted(np.insert(e, 0, 0.85, axis=1), nine) == [30, 30, 0, 0]


def test_slopes_of_counts_need_more_bins_than_parameters() -> None:
    """Two filled bins do for a given cusp with two lengths and an open bin, not for three parameters."""

    def table(count: list[int], below: int, above: int) -> xr.Dataset:
        return xr.Dataset(
            {
                "restitution_count": (("velocity", "restitution"), [count]),
                "restitution_underflow": ("velocity", [below]),
                "restitution_overflow": ("velocity", [above]),
                "number": ("velocity", [sum(count) + below + above]),
                "velocity_edges": ("velocity_edge", [0.2, 0.4]),
                "restitution_edges": ("restitution_edge", np.linspace(0.6, 1.2, 7)),
            },
            coords={"velocity": [0.3], "restitution": np.linspace(0.65, 1.15, 6)},
        )

    def samples(given: xr.Dataset, location: float | None) -> int:
        return int(fit.slopes(given, location=location, resamples=5).table["samples"][0])

    three, four = table([0, 8, 20, 1, 0, 0], 0, 1), table([0, 8, 20, 5, 0, 0], 0, 1)
    assert samples(three, 0.82) == 30
    assert samples(four, None) == 34
    assert samples(table([0, 8, 20, 5, 0, 0], 0, 0), None) == 0  # three filled bins, three parameters
    assert samples(table([0, 8, 20, 5, 0, 0], 0, 0), 0.82) == 33
    assert samples(table([0, 28, 20, 0, 0, 0], 0, 0), 0.82) == 0
    for below, above in ((1, 0), (0, 1)):  # an open bin counts, with one sample
        assert samples(table([0, 20, 10, 0, 0, 0], below, above), 0.82) == 31
    assert samples(table([0, 8, 20, 1, 0, 0], 0, 0), 0.82) == 0  # 29
    counts = Counts.at(four, 0.2)
    one = fit.asymmetric_laplace(counts)
    share = np.cumsum([0, 0, 8, 20, 5, 0, 0]) / 34
    expected = max(abs(a - one.distribution.cdf(x)) for a, x in zip(share, counts.edges, strict=True))
    found = fit.slopes(four)
    assert float(found.table["ks_distance"][0]) == pytest.approx(expected, rel=1e-12)
    assert found.table.attrs["standard_errors"].startswith("unknown: counts do not say")
    assert np.isnan(found.table["particles"][0])
