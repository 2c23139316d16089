"""Slopes over all speeds and dependence of successive impacts: against data made to have known ones."""

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.flanks import CUSP, scaled_flanks
from restitution import fit


def test_growth_laws_come_back() -> None:
    """Exponents -1 and -1.5 within four stated errors, which are small; a bin's finite width adds 0.005."""
    data = scaled_flanks(1000, 1)
    edges = np.linspace(0.1, 0.5, 41)
    found = fit.slopes(data, edges, location=CUSP, resamples=20)
    for side, exponent, amplitude in (("above", -1.0, 0.01), ("below", -1.5, 0.02)):
        law = found.power_law(side)
        assert law.exponent_error < 0.02
        assert abs(law.exponent - exponent) < 4 * law.exponent_error + 0.005
        assert abs(law.amplitude - amplitude) < 4 * law.amplitude_error + 0.01 * amplitude
        assert law.misfit < 1.6
    assert found.fails_below(0.05) == 0.1
    assert np.isnan(found.fails_below(1e-4))
    free = fit.slopes(data, edges, resamples=2)
    assert np.abs(free.table.location - CUSP).max() < 0.02


def test_independent_kicks_give_the_growth_law_of_the_reservoir() -> None:
    """A spin that impacts kick at random by δω ∝ v, felt as ε = ε_n + cωs/v: exponent 1 in √(v₀²/v² − 1).

    Exactly so, for ⟨ω²⟩ ∝ Σ v_k² = (v₀² − v²)/(1 − ε_n²). Within four stated errors.
    """
    rng = np.random.default_rng(1)
    v = np.broadcast_to(CUSP ** np.arange(80), (3000, 80))
    kick = v * rng.normal(size=v.shape)
    spin = np.cumsum(kick, axis=1) - kick  # before the impact
    e = CUSP + 0.002 * spin * rng.uniform(-1, 1, v.shape) / v
    data = xr.Dataset(
        {"impact_velocity": (("particle", "impact"), v), "restitution": (("particle", "impact"), e)}
    )
    found = fit.slopes(data, CUSP ** np.arange(79.5, 0, -2), location=CUSP, resamples=20)
    for side in ("above", "below"):
        law = found.power_law(side, release_speed=1.0)
        assert law.exponent_error < 0.02
        assert abs(law.exponent - 1.0) < 4 * law.exponent_error
        assert law.scatter < 0.5 * found.power_law(side).scatter


def test_slopes_of_counts_are_those_of_the_impacts() -> None:
    data = scaled_flanks(500, 2)
    edges = np.linspace(0.1, 0.5, 9)
    counts = rs.reduce(data, edges, np.linspace(-1.0, 2.0, 3001))
    one, other = fit.slopes(counts, location=CUSP), fit.slopes(data, edges, location=CUSP, resamples=12)
    for side in ("above", "below"):
        gap = np.abs(one.table[side] - other.table[side])
        assert np.all(gap < 0.2 * other.table[f"{side}_error"])
        assert np.isnan(one.table[f"{side}_error"]).all()
        assert one.power_law(side).exponent == pytest.approx(other.power_law(side).exponent, abs=0.03)
        assert np.isnan(one.power_law(side).exponent_error)
        assert "counts do not say" in one.power_law(side).without_errors
        assert other.power_law(side).without_errors == ""


def test_the_exponential_form_fails_where_the_samples_are_gaussian() -> None:
    """Below 0.3 m/s the flanks are replaced by a Gaussian, 0.05 from any asymmetric Laplace distribution."""
    data = scaled_flanks(500, 3)
    v = data.impact_velocity
    gauss = np.random.default_rng(1).normal(CUSP, 0.1, v.shape)
    data["restitution"] = data.restitution.where(v >= 0.3, gauss)
    found = fit.slopes(data, np.linspace(0.1, 0.5, 9), resamples=2)
    assert found.fails_below(0.03) == pytest.approx(0.3)


def sequences(kind: str, seed: int = 1) -> xr.Dataset:
    """Particles of constant speed: ε an autoregression and spheres that alternate, or all random."""
    rng = np.random.default_rng(seed)
    shape = (400, 100)
    score = rng.normal(size=shape)
    if kind == "chain":
        for n in range(1, shape[1]):
            score[:, n] = 0.6 * score[:, n - 1] + 0.8 * score[:, n]
    contact = {
        "chain": 1 + np.cumsum(np.ones(shape, dtype=int), axis=1) % 2,
        "free": rng.integers(1, 3, size=shape),
    }[kind]
    return xr.Dataset(
        {
            "impact_velocity": (("particle", "impact"), np.full(shape, 0.35)),
            "restitution": (("particle", "impact"), score),
            "contact": (("particle", "impact"), contact.astype(np.int8)),
        },
        coords={"impact": np.arange(shape[1])},
    )


def test_dependence_of_known_sequences() -> None:
    """AR(1) of 0.6: ranks correlate by (6/π) arcsin(0.6^k/2), signs change with probability arccos(0.6)/π.

    Within five standard errors; independent impacts have 0, ½ and runs of 2.
    """
    chain = fit.dependence(sequences("chain"), [0.2, 0.3, 0.4], lags=3).isel(velocity=1)
    exact = 6 / np.pi * np.arcsin(0.6 ** np.arange(1, 4) / 2)
    assert np.all(np.abs(chain.autocorrelation - exact) < 5 * chain.autocorrelation_error)
    crossing = np.arccos(0.6) / np.pi
    assert abs(chain.crossing - crossing) < 5 * chain.crossing_error
    assert abs(chain.run - 1 / crossing) < 5 * chain.run_error
    assert float(chain.alternation) == 1.0
    assert int(chain.pairs) == 400 * 99
    free = fit.dependence(sequences("free"), [0.2, 0.3, 0.4], lags=3)
    assert np.isnan(free.alternation[0])  # no impacts there
    free = free.isel(velocity=1)
    assert np.all(np.abs(free.autocorrelation) < 5 * free.autocorrelation_error)
    assert 0.003 < float(free.autocorrelation_error[0]) < 0.007  # 1/√39 600 = 0.005
    assert abs(free.alternation - 0.5) < 5 * free.alternation_error
    assert abs(free.run - 2.0) < 5 * free.run_error
