"""A law of one's own: impacts of known laws, the frame, what it may not return, where it is refused."""

import json
import pickle
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import restitution as rs
from restitution.distribution._defaults import heights
from restitution.drop.run import Run
from restitution.drop.toml import tables_of
from restitution.explorer import link

Floats = npt.NDArray[np.float64]

BODIES = (
    rs.Dumbbell(radius=3e-3, separation=4e-3),
    rs.Dumbbell(radius=(3e-3, 2e-3), separation=4e-3, density=(2500.0, 900.0)),
    rs.Spheroid(equatorial=3e-3, polar=6e-3),
    rs.LoadedSphere(radius=3e-3, density=1000.0, load=2e-4, offset=1e-3),
)
IN_SPACE: dict[str, Any] = {"spin": (20.0, -30.0, 50.0), "release_velocity": (0.1, -0.2, 0.0), "incline": 0.3}
RELEASES: tuple[dict[str, Any], ...] = ({}, IN_SPACE)
STATES = ("velocity_before", "velocity_after", "angular_velocity_after")


def frictionless(K: Floats, velocity: Floats) -> list[float]:
    return [0.0, 0.0, -1.9 * velocity[2] / K[2, 2]]


def tangential(K: Floats, velocity: Floats) -> Any:
    """By Cramer's rule."""
    wanted = np.array([-0.7 * velocity[0], -0.7 * velocity[1], -1.9 * velocity[2]])
    columns = [np.column_stack([wanted if i == j else K[:, j] for j in range(3)]) for i in range(3)]
    return np.array([np.linalg.det(column) for column in columns]) / np.linalg.det(K)


def sticking(K: Floats, velocity: Floats) -> Any:
    """Coulomb friction that is so strong that nothing slips; by Newton's hypothesis."""
    return np.linalg.solve(K, [-velocity[0], -velocity[1], -1.9 * velocity[2]])


SAME: tuple[tuple[Callable[..., Any], rs.Coulomb | rs.Frictionless | rs.TangentialRestitution], ...] = (
    (frictionless, rs.Frictionless(normal=0.9)),
    (tangential, rs.TangentialRestitution(normal=0.9, tangential=0.3)),
    (sticking, rs.Coulomb(normal=0.9, friction=1e6, hypothesis="newton")),
)


@pytest.mark.parametrize(("function", "law"), SAME)
@pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
@pytest.mark.parametrize("release", RELEASES, ids=["rest", "space"])
def test_impacts_are_those_of_the_same_law(
    function: Callable[..., Any], law: Any, body: Any, release: dict[str, Any]
) -> None:
    """Rounding errors grow by less than 10⁵ in three impacts. From rest only speeds and energies agree."""
    how = {"particles": 10, "impacts": 3, **release}
    found = rs.simulate(body, rs.CustomLaw(function), record="state", **how)
    known = rs.simulate(body, law, record="state", **how)
    names = ["impact_velocity", "rebound_velocity", "energy_ratio", "time", "angle"]
    for name in names + (list(STATES) if release else []):
        scale = np.abs(known[name]).max()
        np.testing.assert_allclose(found[name] / scale, known[name] / scale, atol=1e-10, err_msg=name)


def test_a_sphere_that_slips() -> None:
    """Coulomb friction that does not stop the slip, whose direction a sphere keeps."""

    def slipping(K: Floats, velocity: Floats) -> Any:
        direction = np.array([*(-0.1 * velocity[:2] / np.hypot(*velocity[:2])), 1.0])
        return -1.9 * velocity[2] / (K @ direction)[2] * direction

    body = rs.Dumbbell(radius=3e-3, separation=0.0)
    how: dict[str, Any] = {
        "particles": 5,
        "impacts": 2,
        "record": "state",
        "release_velocity": (3.0, -2.0, 0.0),
    }
    found = rs.simulate(body, rs.CustomLaw(slipping), **how)
    known = rs.simulate(body, rs.Coulomb(normal=0.9, friction=0.1), **how)
    for name in STATES:
        np.testing.assert_allclose(found[name], known[name], rtol=1e-12, atol=1e-12, err_msg=name)


def test_the_frame_is_that_of_the_plane() -> None:
    """On a slope: x descends, z is the normal, K and the velocity are those of the records, in SI units."""
    asked: list[tuple[Floats, Floats]] = []

    def watching(K: Floats, velocity: Floats) -> Any:
        asked.append((K, velocity))
        return tangential(K, velocity)

    body = rs.Spheroid(equatorial=3e-3, polar=3.0000001e-3)
    law = rs.CustomLaw(watching)
    data = rs.simulate(body, law, particles=1, impacts=1, record="state", **IN_SPACE).isel(particle=0)
    ((K, velocity),) = asked
    # Nearly a sphere: the contact is at (0, 0, -R), K = diag(1/m + R²/J, 1/m + R²/J, 1/m).
    across = 1.0 / body.mass + 3e-3**2 / body.transverse_inertia
    np.testing.assert_allclose(K, np.diag([across, across, 1.0 / body.mass]), atol=1e-6 * across)
    omega = data.angular_velocity_before[0].to_numpy()
    contact = data.velocity_before[0].to_numpy() + np.cross(omega, [0.0, 0.0, -3e-3])
    np.testing.assert_allclose(velocity, contact, rtol=1e-5)
    fall = 9.81 * float(data.time[0]) * np.array([np.sin(0.3), 0.0, -np.cos(0.3)])
    np.testing.assert_allclose(
        data.velocity_before[0], np.array([0.1, -0.2, 0.0]) + fall, rtol=1e-9, atol=1e-12
    )
    impulse = tangential(K, velocity)
    change = (data.velocity_after - data.velocity_before)[0].to_numpy()
    np.testing.assert_allclose(change, impulse / body.mass, rtol=1e-12, atol=1e-14)


def test_directions_in_the_plane_may_differ() -> None:
    """Grooves along x: the contact slips freely along them, and not at all across."""

    def grooved(K: Floats, velocity: Floats) -> Floats:
        impulse = np.zeros(3)
        impulse[1:] = np.linalg.solve(K[1:, 1:], [-velocity[1], -1.9 * velocity[2]])
        return impulse

    body = BODIES[0]
    angles = np.linspace(0.2, 1.4, 7)
    for azimuth, law in (
        (0.0, rs.Frictionless(normal=0.9)),
        (np.pi / 2, rs.TangentialRestitution(normal=0.9, tangential=0.0)),
    ):
        axes = np.column_stack([angles, np.full(7, azimuth)])
        how: dict[str, Any] = {"particles": 7, "impacts": 2, "orientation": axes}
        found, known = (rs.simulate(body, one, **how) for one in (rs.CustomLaw(grooved), law))
        np.testing.assert_allclose(found.restitution, known.restitution, rtol=1e-10)


def test_the_bits_do_not_depend_on_the_threads() -> None:
    law = rs.CustomLaw(tangential)
    one, two = (
        rs.simulate(BODIES[0], law, particles=300, impacts=3, threads=threads, **IN_SPACE)
        for threads in (1, 2)
    )
    assert one.identical(two)


BAD: tuple[tuple[Any, str], ...] = (
    ([1.0, 2.0], "gave [1.0, 2.0]: must be three numbers, the impulse in N s"),
    (None, "gave None: must be three numbers"),
    ("abc", "gave 'abc': must be three numbers"),
    (np.zeros((3, 3)), "must be three numbers"),
    (np.zeros((3, 1)) + 1j, "must be three numbers"),
    ([0.0, 0.0, np.nan], "gave (0.0, 0.0, NaN) N s: must be finite"),
    ([np.inf, 0.0, 1.0], "gave (inf, 0.0, 1.0) N s: must be finite"),
    ([0.0, 0.0, -1e-3], "which pulls: the component along z must be >= 0"),
    ([0.0, 0.0, 0.0], "after which the contact still approaches the plane at 1.0"),
)


@pytest.mark.parametrize(("given", "text"), BAD)
@pytest.mark.parametrize("threads", [1, 2])
def test_bad_returns_name_particle_and_seed(given: Any, text: str, threads: int) -> None:
    """With one thread it is the first particle; the threads stop after the first error."""
    calls = 0

    def bad(K: Floats, velocity: Floats) -> Any:
        nonlocal calls
        calls += 1
        return given

    with pytest.raises(ValueError, match="particle ") as caught:
        rs.simulate(
            BODIES[0],
            rs.CustomLaw(bad, name="mine", pull="stop"),
            particles=500,
            impacts=10,
            seed=7,
            threads=threads,
        )
    assert text in str(caught.value)
    assert "(seed 7), impact 0: mine gave" in str(caught.value)
    assert threads > 1 or str(caught.value).startswith("particle 0 ")
    assert calls <= threads


def test_impact_and_particle_of_an_error() -> None:
    """The fourth impact of particle 2 alone is refused, in its run and in that of the particle by itself."""
    body = BODIES[2]
    data = rs.simulate(body, rs.CustomLaw(tangential), particles=5, impacts=6, record="state", **IN_SPACE)

    def picky(K: Floats, velocity: Floats) -> Any:
        mass = body.mass
        fine = tangential(K, velocity)
        before = data.velocity_before.to_numpy()
        after = data.velocity_after.to_numpy()
        one = np.allclose((after - before)[2, 3], fine / mass, rtol=1e-12, atol=1e-15)
        return [np.nan] * 3 if one else fine

    with pytest.raises(ValueError, match=r"^particle 2 \(seed 1\), impact 3: picky gave \(NaN"):
        rs.simulate(body, rs.CustomLaw(picky), particles=5, impacts=6, **IN_SPACE)


def test_rounding_is_no_approach() -> None:
    """A perfectly plastic, sticking impact leaves v_n' = 0 up to rounding, of either sign."""

    def plastic(K: Floats, velocity: Floats) -> Any:
        return np.linalg.solve(K, -velocity)

    data = rs.simulate(BODIES[2], rs.CustomLaw(plastic), particles=100, impacts=1)
    assert np.isfinite(data.restitution[:, 0]).all()


def test_an_exception_is_raised_again() -> None:
    """With its traceback, and a note that names particle and seed."""

    def failing(K: Floats, velocity: Floats) -> Floats:
        raise LookupError("not here")

    with pytest.raises(LookupError, match="not here") as caught:
        rs.simulate(BODIES[0], rs.CustomLaw(failing), particles=5, impacts=10, seed=7, threads=2)
    assert any("(seed 7), impact 0: failing raised an exception" in note for note in caught.value.__notes__)
    assert "failing" in [entry.name for entry in caught.traceback]


def test_ctrl_c_ends_a_run() -> None:
    """Within a second, though every call takes 20 ms; what was finished is there."""

    def slow(K: Floats, velocity: Floats) -> Any:
        time.sleep(0.02)
        return frictionless(K, velocity)

    sent = []

    def interrupt() -> None:
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(0.5, interrupt)
    timer.start()
    with pytest.raises(rs.SimulationInterrupted) as caught:
        rs.simulate(BODIES[0], rs.CustomLaw(slow), particles=1000, impacts=1000)
    assert time.perf_counter() - sent[0] < 1.0
    assert caught.value.data.sizes["particle"] >= 1


def test_results_of_every_kind() -> None:
    """Statistics, a comparison, a learned distribution and a trajectory are those of the same law."""
    body, law, known = BODIES[0], rs.CustomLaw(tangential, name="ours"), SAME[1][1]
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.0, 1.2, 4),
        "restitution_bins": np.linspace(-2, 4, 7),
    }
    how: dict[str, Any] = {"particles": 40, "impacts": 3}
    found = rs.compare([body], [law, known], **how, **bins)
    assert found["law"].values.tolist() == ["CustomLaw", "TangentialRestitution"]
    assert found["law_parameters"].values.tolist()[0] == "CustomLaw(name='ours')"
    assert found["name"].values.tolist() == ["ours", ""]
    one, other = found.isel(law=0), found.isel(law=1)
    assert (one.restitution_count == other.restitution_count).all()
    np.testing.assert_allclose(one.mean_restitution, other.mean_restitution, atol=1e-6)
    alone = rs.statistics(body, law, **how, **bins)
    assert alone.attrs["law"] == "CustomLaw"
    assert alone.attrs["law_name"] == "ours"
    assert json.loads(json.dumps(alone.attrs))["law_name"] == "ours"
    assert (
        alone.attrs["energy_created_impacts"]
        == rs.statistics(body, known, **how, **bins).attrs["energy_created_impacts"]
    )
    data = rs.simulate(body, law, record="state", **how)
    path = rs.trajectory(data, 0, [0.0, float(data.time[0, 2])])
    np.testing.assert_allclose(path.position[1], data.position[0, 2], atol=1e-12)


def test_a_distribution_is_learned() -> None:
    learned = rs.FluctuatingRestitution.learn(
        BODIES[0], rs.CustomLaw(frictionless), particles=1000, velocities=(0.3, 0.6)
    )
    assert 0.0 < float(learned.mean(0.4)) < 1.0


def test_heights_are_spread_over_the_loss_of_a_first_impact() -> None:
    """A ball loses what ε_n = 0.9 takes, under one's own law as under a known one; a long body loses less."""
    ball, law = rs.Dumbbell(radius=3e-3, separation=0.0), rs.CustomLaw(frictionless)
    runs = [Run(body=ball, law=law, particles=1000), Run(body=ball, law=SAME[0][1], particles=1000)]
    found, expected = (np.array(heights(run, None)) for run in runs)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    np.testing.assert_allclose(expected[[0, -1]] / 3e-3, 1 + 19 * 0.81 ** np.array([-1, 1]), rtol=0.07)

    run = Run(body=BODIES[0], law=law, particles=1000, release_height=0.1)
    base = BODIES[0].compiled.farthest()
    few = rs.simulate(BODIES[0], law, particles=64, impacts=1, release_height=0.1)
    kept = few.energy_ratio.mean().item()
    found = (np.array(heights(run, None)) - base) / (0.1 - base)
    assert found[0] * found[-1] == pytest.approx(1.0)
    assert kept < found[-1] < kept**0.9 < 1.0


def test_a_dataset_is_saved(tmp_path: Path) -> None:
    data = rs.simulate(BODIES[0], rs.CustomLaw(frictionless, name="ours"), particles=2, impacts=2)
    data.to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as read:
        assert read.attrs["law_name"] == "ours"


def test_refused_by_name(tmp_path: Path) -> None:
    """Where a file or a page would have to hold the function, or a law must have a coefficient."""
    body, law = BODIES[0], rs.CustomLaw(frictionless, name="ours")
    run = Run(body=body, law=law)
    text = r"law = CustomLaw\(name='ours'\)"
    with pytest.raises(ValueError, match=f"{text}: a function cannot be written to a file"):
        tables_of(run)
    study = {"body": body, "law": law, "sweep": {"body.separation": [1e-3, 2e-3]}, "first_impact": {}}
    with pytest.raises(ValueError, match=f"{text}: a function cannot be written to a file"):
        rs.sweep(study, out=tmp_path / "study.zarr")
    with pytest.raises(ValueError, match=f"{text}: the explorer shows this only if"):
        link(run)
    with pytest.raises(ValueError, match=f"{text}: must be a TangentialRestitution"):
        rs.analytic.first_impact(body, law)  # type: ignore[arg-type]


def test_arguments() -> None:
    """A function, by place or by name, and a name; the law is a value like any other."""
    law = rs.CustomLaw(frictionless)
    assert law.name == "frictionless"
    assert rs.CustomLaw(function=frictionless, name="x").name == "x"
    assert law == rs.CustomLaw(frictionless)
    assert law != rs.CustomLaw(tangential, name="frictionless")
    assert pickle.loads(pickle.dumps(law)) == law
    with pytest.raises(ValueError, match="function = 3: must be a function of K and the velocity"):
        rs.CustomLaw(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="name = 3: must be a str"):
        rs.CustomLaw(frictionless, name=3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="function: missing; must be a function"):
        rs.CustomLaw()  # type: ignore[call-arg]
    with pytest.raises(ValueError, match=r"law = 3: must be a .*, or a CustomLaw"):
        rs.simulate(BODIES[0], 3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "body", [BODIES[0], rs.Ellipsoid(semi_axes=(1e-3, 1.5e-3, 3e-3))], ids=["axis", "none"]
)
def test_one_rule_for_impulses_that_pull(body: Any) -> None:
    """A law of the package, the same as a function, and both with another rule."""
    known = rs.TangentialRestitution(normal=0.5, tangential=-0.5)

    pulled: list[bool] = []

    def function(K: Floats, velocity: Floats) -> Any:
        impulse = np.linalg.solve(K, -1.5 * velocity)
        pulled.append(bool(impulse[2] < -1e-12 * body.mass))
        return impulse

    how: dict[str, Any] = IN_SPACE | {
        "particles": 200,
        "impacts": 40,
        "orientation": "isotropic",
        "incline": 0.0,
    }
    for law in (known, rs.CustomLaw(known), rs.CustomLaw(function)):
        with pytest.warns(rs.PullWarning, match="let the plane pull"):
            data = rs.simulate(body, law, **how)
        assert data.attrs["pulling_impacts"] > 0
    assert data.attrs["pulling_impacts"] == pytest.approx(sum(pulled), abs=0.02 * sum(pulled))
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(-1.0, 2.0, 4),
        "restitution_bins": np.linspace(-1.0, 3.0, 5),
    }
    data = rs.simulate(body, known, **how)
    many: tuple[dict[str, Any], ...] = ({}, {"counts_only": True})
    for more in many:
        with pytest.warns(rs.PullWarning, match="let the plane pull") as told:
            found = rs.statistics(body, known, **how, **bins, **more)
        assert [one.category for one in told].count(rs.PullWarning) == 1
        assert found.attrs["pulling_impacts"] == data.attrs["pulling_impacts"]
    assert rs.reduce(data, **bins).attrs["pulling_impacts"] == data.attrs["pulling_impacts"]
    laws = {"paper": known, "smooth": rs.Frictionless(normal=0.5)}
    with pytest.warns(rs.PullWarning, match=r"^paper let the plane pull in up to .* of the impacts of a run"):
        both = rs.compare({"one": body}, laws, **how, **bins)
    assert both["pulling_impacts"].values.tolist() == [[data.attrs["pulling_impacts"], 0]]
    with pytest.warns(rs.PullWarning, match="let the plane pull"):
        dist = rs.FluctuatingRestitution.learn(body, known, particles=2000, spin=how["spin"])
    assert dist.data.attrs["pulling_impacts"] > 0
    for clipped in (rs.CustomLaw(known, pull="clip"), rs.CustomLaw(function, pull="clip")):
        data = rs.simulate(body, clipped, **how)
        assert "pulling_impacts" not in data.attrs
        assert float((data.impact_velocity + data.rebound_velocity).min()) > -1e-14
        with pytest.raises(ValueError, match="which pulls"):
            rs.simulate(body, rs.CustomLaw(clipped.function, pull="stop"), **how)
    with pytest.raises(ValueError, match="pull = 'keep': must be 'stop', 'clip' or None"):
        rs.CustomLaw(known, pull="keep")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="does not scatter"):
        rs.CustomLaw(rs.Frictionless(normal=rs.Scattered(normal=0.9, deviation=0.01)))
