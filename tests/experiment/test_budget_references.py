"""Sources of error worked out again, drop by drop: what is heard, what counts, and how well it is known."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq, curve_fit

import restitution as rs
from reference.bouncing import told_in_air
from restitution.experiment.budget import _sources
from restitution.experiment.budget._closed_forms import near_round
from restitution.experiment.budget.experiment import Experiment, Setting, mean_radius

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
        v = told_in_air(lambda speed: float(normal(np.array(speed))), 0.5, terminal, 4)
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
    source = _sources.added(one, BODY, alone, **({"spin": 20.0}, {"tilt": 0.1})[kind - 1])
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
    np.testing.assert_allclose(found["bias"], by @ source.bias, rtol=1e-12, atol=1e-15)
    for k, row in enumerate(by):
        variance = max(float(row @ covariance @ row), 0.0)
        assert found["standard_deviation"][k] == pytest.approx(math.sqrt(variance), rel=1e-9)
        values = (there - here) @ row
        assert found["bias_error"][k] == pytest.approx(values.std() / math.sqrt(n), rel=1e-9)
        squares = (away @ row) ** 2 - (off @ row) ** 2
        # σ² has this error; σ half of it over σ, or its root where σ is no larger.
        error = squares.std() / math.sqrt(n)
        expected = math.sqrt(error)
        if variance > 0.0:
            expected = min(expected, error / (2.0 * math.sqrt(variance)))
        assert found["standard_deviation_error"][k] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("lost", "refused"), [(5, False), (6, True)])
def test_nine_drops_of_ten_must_be_heard(lost: int, refused: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    one = experiment()
    flights = np.tile(np.diff(one.times), (50, 1))
    flights[:lost, 2] *= 0.05
    times = np.concatenate([np.zeros((50, 1)), np.cumsum(flights, axis=1)], axis=1)
    run = xr.Dataset({"time": (("particle", "impact"), times)})
    monkeypatch.setattr(_sources, "simulate", lambda *_, **__: run)
    if not refused:
        assert np.isnan(_sources.simulated(one, BODY)[:, 0]).sum() == lost
        return
    said = (
        r"^impacts = 4, drop = 0\.1: only 88 % of such balls bounce so often with resolved flights; must be "
        "fewer, or the body rounder$"
    )
    with pytest.raises(ValueError, match=said):
        _sources.simulated(one, BODY)


def test_what_the_engine_refuses_is_said_in_terms_of_the_experiment() -> None:
    said = r"^drop = 0\.1, gravity = 9\.81, spin = 1e\+30: gives "
    with pytest.raises(ValueError, match=said):
        _sources.simulated(experiment(spin=1e30), BODY, spin=1e30)


def height(body: Any) -> Any:
    """Height of the centre of mass over the plane by the cosine of the angle of the axis."""
    if isinstance(body, rs.Spheroid):
        return lambda u: np.sqrt(body.polar**2 * u**2 + body.equatorial**2 * (1.0 - u**2))
    if isinstance(body, rs.LoadedSphere):
        return lambda u: body.radius - body.centre_of_mass * u
    return lambda u: body.radii[0] + 0.5 * body.separation * np.abs(u)


@pytest.mark.parametrize(
    ("law", "kept"),
    [
        (rs.TangentialRestitution(normal=0.9, tangential=1.0), True),
        (rs.Frictionless(normal=0.9), False),
        (METAL, False),
    ],
)
@pytest.mark.parametrize(
    "body",
    [
        rs.Spheroid(equatorial=3e-3, polar=3.0003e-3),
        rs.Spheroid(equatorial=3e-3, polar=2.9997e-3),
        rs.Dumbbell(radius=3e-3, separation=6e-7),
        rs.LoadedSphere(radius=3e-3, load=1e-7, offset=1e-3),
    ],
    ids=lambda body: type(body).__name__,
)
@pytest.mark.parametrize("rate", [0.0, 50.0])
def test_closed_forms_are_averages_over_angles(body: Any, law: Any, kept: bool, rate: float) -> None:
    """Of the lever arm dh/dθ and of dh/dt by a spin, to lowest order in t/R <= 1e-4."""
    one = experiment(law, spin=rate)
    found = near_round(one, body)
    assert found is not None
    kick, bias, deviation = found
    h, step = height(body), 1e-4
    theta = (np.arange(4000) + 0.37) * 2.0 * np.pi / 4000
    above, here, below = (h(np.cos(theta + by)) for by in (step, 0.0, -step))
    arm, bend = (above - below) / (2 * step), (above - 2 * here + below) / step**2
    bend = bend[np.abs(np.cos(theta)) > 0.01]  # elsewhere two spheres meet in an edge
    inertia = body.transverse_inertia + (body.mass * (3e-3) ** 2 if kept else 0.0)
    q, e, v = body.mass / inertia, one.coefficient, one.speed
    square, c = float((arm**2).mean()), 1.0 + one.coefficient
    assert bias == pytest.approx(-c * q * square, rel=3e-3)
    # The largest |h''| is that of the angles where h is least or largest.
    assert kick == pytest.approx(2.0 * c * q * e * v**2 * np.abs(bend).max() / 9.81, rel=3e-3)
    u, weight = np.polynomial.legendre.leggauss(200)
    by_u = (h(u + 1e-6) - h(u - 1e-6)) / 2e-6
    # A spin of any direction gives (ω·(a x z))², a third of ω² sin² θ in the mean.
    turned = rate**2 / 3.0 * float((weight * by_u**2 * (1.0 - u**2)).sum() / 2.0)
    scatter = float((arm**2).var())
    gained = [q**2 * square * float(((c * v) ** 2)[:k].sum()) for k in range(4)]
    expected = c * np.sqrt((np.array(gained) * square + turned) / v**2 + q**2 * scatter)
    assert deviation == pytest.approx(expected, rel=3e-3)


@pytest.mark.parametrize(
    ("law", "body"),
    [
        (rs.TangentialRestitution(normal=0.9, tangential=0.5), BODY),
        (rs.Coulomb(normal=0.9, friction=0.05), BODY),
        (rs.Frictionless(normal=0.9), rs.Spherocylinder(radius=3e-3, separation=1e-5)),
        (rs.Frictionless(normal=0.9), rs.Dumbbell(radius=(3e-3, 2.9e-3), separation=1e-5)),
    ],
)
def test_closed_forms_that_are_not_known_are_none(law: Any, body: Any) -> None:
    assert near_round(experiment(law), body) is None


RUBBER = rs.Viscoelastic(young_modulus=1e7, poisson_ratio=0.3, dissipation=1e-4, density=1100.0, radius=3e-3)
TABLE = rs.Tabulated(v=[0.1, 0.5, 1.0, 2.0], e=[0.95, 0.9, 0.88, 0.86])


@pytest.mark.parametrize(
    ("normal", "name"),
    [(0.9, "constant"), (METAL.normal, "plastic"), (RUBBER, "viscoelastic"), (TABLE, "power law")],
)
def test_the_covariance_of_what_is_measured_is_that_of_its_derivatives(normal: Any, name: str) -> None:
    """ε_i - ε_n(v_i) by each time, by g and by the height of the drop, as differences."""
    law = rs.Frictionless(normal=normal)
    one = experiment(law)
    assert one.form.name == name
    numbers = np.array([*one.times, 9.81, 0.1])

    def misfit(numbers: np.ndarray) -> np.ndarray:
        g, drop = numbers[-2:]
        v = np.concatenate([[math.sqrt(2.0 * g * drop)], 0.5 * g * np.diff(numbers[:-2])])
        told = normal(v[:-1]) if callable(normal) else normal
        return np.asarray(v[1:] / v[:-1] - told)

    step = 1e-6
    by = np.stack(
        [
            (misfit(numbers + step * unit) - misfit(numbers - step * unit)) / (2 * step)
            for unit in np.eye(numbers.size)
        ],
        axis=1,
    )
    errors = np.array([2e-5] * one.times.size + [0.03, 1e-3])
    found = one.covariance(timing=2e-5, gravity=0.03, drop=1e-3)
    assert found == pytest.approx((by * errors**2) @ by.T, rel=2e-4, abs=1e-12)


def test_parameters_of_another_law_are_those_of_least_squares() -> None:
    """A power law through what a table says at the speeds: SciPy's own fit of it."""
    one = experiment(rs.Frictionless(normal=TABLE))

    def power(v: Any, *values: float) -> Any:
        return one.form.coefficient(v, np.array(values))

    fitted, _ = curve_fit(power, one.speed, one.coefficient, p0=0.7 * one.parameters, xtol=1e-14, ftol=1e-14)
    assert one.parameters == pytest.approx(fitted, rel=1e-6)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (
            lambda: experiment(gravity_uncertainty=10.0),
            r"^gravity_uncertainty = 10\.0: must be at most gravity = 9\.81",
        ),
        (lambda: experiment(drop_uncertainty=0.2), r"^drop_uncertainty = 0\.2: must be at most drop = 0\.1"),
        (
            lambda: experiment(rs.Frictionless(normal=0.0)),
            r"^law = Frictionless\(normal=0\.0\): must be one under which a ball bounces, ε_n > 0",
        ),
        (
            lambda: experiment(rs.Frictionless(normal=1e-6)),
            r"^law = Frictionless\(normal=1e-06\): must be one whose flights last at least 1e-10 of the time "
            r"since release, for impacts = 4 of them",
        ),
        (
            lambda: experiment(rs.Frictionless(normal=rs.Plastic(yield_speed=50.0))),
            r"^law = Frictionless\(.*yield_speed=50\.0\)\): must be one from whose ε_n at the speeds "
            r"1\.40071 to 1\.40071 m/s the yield_speed can be fitted",
        ),
    ],
)
def test_what_is_no_experiment_is_said(make: Callable[[], object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        make()


def test_what_is_known_just_well_enough() -> None:
    assert experiment(drop_uncertainty=0.1).setting.drop_uncertainty == 0.1


def test_the_shortest_flights_that_a_double_resolves() -> None:
    """The fourth takes 1e-10 of the time since release: 2 e⁴ = 1e-10 (1 + 2 e + 2 e² + 2 e³ + 2 e⁴)."""
    normal = brentq(lambda e: 2 * e**4 - 1e-10 * (1 + 2 * (e + e**2 + e**3 + e**4)), 1e-3, 1e-2, xtol=1e-12)
    assert experiment(rs.Frictionless(normal=normal * 1.0005)).times.size == 5
    with pytest.raises(ValueError, match=r"^law = .*: must be one whose flights last at least 1e-10 of"):
        experiment(rs.Frictionless(normal=normal * 0.9995))
