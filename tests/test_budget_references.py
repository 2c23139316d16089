"""Sources of error worked out again, drop by drop: what is heard, what counts, and how well it is known."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import restitution as rs
from restitution.budget import _sources
from restitution.budget._experiment import Experiment, Setting, mean_radius

METAL = rs.Frictionless(normal=rs.Plastic(yield_speed=0.05))
BODY = rs.from_roundness(6e-3, 3e-5)


def experiment(law: Any = METAL, **setting: Any) -> Experiment:
    given: dict[str, Any] = {"drop": 0.1, "impacts": 4, "particles": 50}
    return Experiment.of(law, Setting(**(given | setting)))


@pytest.mark.parametrize(
    ("body", "narrow", "wide"),
    [
        (rs.Spheroid(equatorial=3e-3, polar=4e-3), 6e-3, 8e-3),
        (rs.LoadedSphere(radius=3e-3, load=1e-5, offset=1e-4), 6e-3, 6e-3),
        (rs.Spherocylinder(radius=3e-3, separation=2e-3), 6e-3, 8e-3),
        (rs.Dumbbell(radius=3e-3, separation=2e-3), 6e-3, 8e-3),
        (rs.Dumbbell(radius=(3e-3, 2e-3), separation=3e-3), 6e-3, 8e-3),
    ],
)
def test_the_mean_radius_is_that_of_two_diameters(body: Any, narrow: float, wide: float) -> None:
    assert mean_radius(body) == pytest.approx(0.25 * (narrow + wide), rel=1e-14)


def test_the_bias_of_a_quotient_of_times_is_its_mean() -> None:
    """By Gauss's quadrature over the errors of three times; what is left is of fourth order, 1e-5."""
    one = experiment(timing=1e-4)
    nodes, weights = np.polynomial.hermite_e.hermegauss(9)
    weights = weights / weights.sum()
    x = 1e-4 * np.stack(np.meshgrid(nodes, nodes, nodes, indexing="ij"))
    w = weights[:, None, None] * weights[None, :, None] * weights[None, None, :]
    found = _sources.timing(one).bias
    assert found[0] == 0.0
    for i in range(1, 4):
        t = one.times[i - 1 : i + 2]
        before, after = t[1] + x[1] - t[0] - x[0], t[2] + x[2] - t[1] - x[1]
        exact = (t[2] - t[1]) / (t[1] - t[0])
        assert found[i] == pytest.approx(float((w * (after / before - exact)).sum()), rel=1e-4)


@pytest.mark.parametrize("law", [rs.Frictionless(normal=0.95), METAL])
def test_drag_under_any_law_is_that_of_an_integration(law: rs.Frictionless) -> None:
    """The bias, and by another terminal velocity how much of its uncertainty is in each coefficient."""

    def normal(v: Any) -> Any:
        return law.normal(v) if isinstance(law.normal, rs.Plastic) else law.normal

    def bias(terminal: float) -> np.ndarray:
        def landed(_: float, y: np.ndarray) -> float:
            return float(y[0])

        def motion(_: float, y: np.ndarray) -> list[float]:
            return [y[1], -9.81 * (1.0 + abs(y[1]) * y[1] / terminal**2)]

        landed.terminal, landed.direction = True, -1.0  # type: ignore[attr-defined]
        told, state = [math.sqrt(2 * 9.81 * 0.5)], [0.5, 0.0]
        for number in range(5):
            flight = solve_ivp(motion, (0.0, 10.0), state, events=landed, rtol=1e-12, atol=1e-14)
            if number:
                told.append(9.81 * float(flight.t_events[0][0]) / 2.0)  # type: ignore[index]
            speed = -float(flight.y_events[0][0][1])  # type: ignore[index]
            state = [1e-14, float(normal(np.array(speed))) * speed]
        v = np.array(told)
        return np.asarray(v[1:] / v[:-1] - normal(v[:-1]))

    one = experiment(law, drop=0.5)
    found = _sources.drag(one, rs.flight.Drag(terminal_velocity=9.0, uncertainty=0.3), corrected=False)
    assert found.bias == pytest.approx(bias(9.0), rel=1e-5)
    slope = (bias(9.02) - bias(8.98)) / 0.04
    assert found.covariance == pytest.approx(np.outer(slope, slope) * 0.3**2, rel=1e-4)


@pytest.fixture
def drops(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Fifty drops that are made up: alone, with a spin, on an incline; five of each are not heard."""
    asked: list[dict[str, Any]] = []

    def simulate(body: Any, law: Any, **run: Any) -> xr.Dataset:
        asked.append(run | {"body": body, "law": law})
        kind = 1 if run["spin"] is not None else 2 if run["incline"] else 0
        return xr.Dataset({"time": (("particle", "impact"), made(kind))})

    monkeypatch.setattr(_sources, "simulate", simulate)
    return asked


def made(kind: int) -> np.ndarray:
    """Times of impacts of drops that go astray by a little: every kind by another amount."""
    one = experiment()
    spread = np.random.default_rng(7).normal(1.0, 0.02, (50, 4)) * (1.0 + 0.01 * kind)
    spread = spread * np.random.default_rng(8 + kind).normal(1.0, 0.01, (50, 4))
    flights = np.diff(one.times) * spread
    flights[kind : kind + 4, kind] *= 0.05  # two impacts as one
    flights[10, -1] = np.nan  # at rest
    return np.concatenate([np.zeros((50, 1)), np.cumsum(flights, axis=1)], axis=1)


def heard(kind: int) -> dict[int, list[float]]:
    """Errors of ε of each drop that counts."""
    one, found = experiment(), {}
    for particle, times in enumerate(made(kind)):
        speed = [math.sqrt(2 * 9.81 * 0.1)] + [0.5 * 9.81 * (times[i + 1] - times[i]) for i in range(4)]
        if all(v > 0.1 * e * u for v, e, u in zip(speed[1:], one.coefficient, one.speed, strict=True)):
            law = [float(METAL.normal(np.array(v))) for v in speed[:-1]]  # type: ignore[operator]
            found[particle] = [speed[i + 1] / speed[i] - law[i] for i in range(4)]
    return found


def test_the_shape_alone_is_the_mean_and_scatter_of_what_is_heard(drops: list[dict[str, Any]]) -> None:
    one = experiment(tilt=0.1, spin=20.0, seed=5, gravity=9.81)
    source = _sources.shape(one, BODY)
    assert drops == [
        {
            "body": BODY,
            "law": METAL,
            "particles": 50,
            "impacts": 5,
            "release_height": mean_radius(BODY) + 0.1,
            "gravity": 9.81,
            "spin": None,
            "incline": 0.0,
            "seed": 5,
        }
    ]
    errors = np.array(list(heard(0).values()))
    assert len(errors) == 45
    np.testing.assert_allclose(source.bias, errors.mean(axis=0), rtol=1e-12)
    left = errors - errors.mean(axis=0)
    np.testing.assert_allclose(source.covariance, left.T @ left / 44, rtol=1e-12)


@pytest.mark.parametrize("kind", [1, 2])
def test_what_spin_and_tilt_add_is_a_difference_of_the_same_drops(
    kind: int, drops: list[dict[str, Any]]
) -> None:
    """Those that are heard in both; errors by sampling are of the difference, too."""
    one = experiment(tilt=0.1, spin=20.0, seed=5)
    alone = _sources.shape(one, BODY)
    source = (_sources.spin, _sources.tilt)[kind - 1](one, BODY, alone)
    run = drops[1]
    assert run["spin"] == (rs.RandomSpin(rate=20.0) if kind == 1 else None)
    assert run["incline"] == (0.1 if kind == 2 else 0.0)
    height = 0.1 * (math.cos(0.1) if kind == 2 else 1.0)
    assert run["release_height"] == pytest.approx(mean_radius(BODY) + height, rel=1e-14)

    both, first = heard(kind), heard(0)
    kept = sorted(both.keys() & first.keys())
    assert len(kept) < min(len(both), len(first))
    there, here = np.array([both[i] for i in kept]), np.array([first[i] for i in kept])
    away, off = there - there.mean(axis=0), here - here.mean(axis=0)
    n = len(kept)
    np.testing.assert_allclose(source.bias, (there - here).mean(axis=0), rtol=1e-9, atol=1e-15)
    covariance = (away.T @ away - off.T @ off) / (n - 1)
    np.testing.assert_allclose(source.covariance, covariance, rtol=1e-9, atol=1e-18)

    by = np.array([[1.0, 0.0, 0.0, 0.0], [0.25, 0.25, 0.25, 0.25], [0.0, 2.0, -1.0, 0.0]])
    found = source.carried(by)
    np.testing.assert_allclose(found.bias, by @ source.bias, rtol=1e-12, atol=1e-15)
    for k, row in enumerate(by):
        variance = max(float(row @ covariance @ row), 0.0)
        assert found.deviation[k] == pytest.approx(math.sqrt(variance), rel=1e-9)
        values = (there - here) @ row
        assert found.bias_error[k] == pytest.approx(values.std() / math.sqrt(n), rel=1e-9)
        squares = (away @ row) ** 2 - (off @ row) ** 2
        # σ² has this error; σ half of it over σ, or its root where σ is no larger.
        error = squares.std() / math.sqrt(n)
        expected = math.sqrt(error)
        if variance > 0.0:
            expected = min(expected, error / (2.0 * math.sqrt(variance)))
        assert found.deviation_error[k] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("lost", "refused"), [(5, False), (6, True)])
def test_nine_drops_of_ten_must_be_heard(lost: int, refused: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    one = experiment()
    flights = np.tile(np.diff(one.times), (50, 1))
    flights[:lost, 2] *= 0.05
    times = np.concatenate([np.zeros((50, 1)), np.cumsum(flights, axis=1)], axis=1)
    run = xr.Dataset({"time": (("particle", "impact"), times)})
    monkeypatch.setattr(_sources, "simulate", lambda *_, **__: run)
    if not refused:
        assert np.isnan(_sources.simulated(one, BODY, spin=False, tilt=False)[:, 0]).sum() == lost
        return
    said = (
        r"^impacts = 4, drop = 0\.1: only 88 % of such balls bounce so often with resolved flights; must be "
        "fewer, or the body rounder$"
    )
    with pytest.raises(ValueError, match=said):
        _sources.simulated(one, BODY, spin=False, tilt=False)


def test_what_the_engine_refuses_is_said_in_terms_of_the_experiment() -> None:
    said = r"^drop = 0\.1, gravity = 9\.81, spin = 1e\+30: gives "
    with pytest.raises(ValueError, match=said):
        _sources.simulated(experiment(spin=1e30), BODY, spin=True, tilt=False)
