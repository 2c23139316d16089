"""The motion between impacts in closed form: beside recorded states, the plane, and an integrator."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import restitution as rs

Floats = npt.NDArray[np.float64]

EPS = float(np.finfo(np.float64).eps)
BODY = rs.Dumbbell(radius=3e-3, separation=4e-3)
LAW = rs.Coulomb(normal=0.9, friction=0.3)
RUNS: dict[str, dict[str, Any]] = {
    "at rest": {},
    "thrown": {
        "spin": rs.RandomSpin(rate=(0.0, 300.0)),
        "release_velocity": (0.1, -0.2, 0.1),
        "orientation": "isotropic",
        "incline": 0.2,
        "release_height": rs.RandomHeight(lowest=0.03, highest=0.06),
    },
}


def run(which: str, **more: Any) -> xr.Dataset:
    how: dict[str, Any] = {"particles": 6, "impacts": 25, "seed": 3, "record": "state"} | RUNS[which] | more
    return rs.simulate(BODY, LAW, **how)


def at_impacts(data: xr.Dataset, particle: int) -> Floats:
    times: Floats = data["time"].sel(particle=particle).dropna("impact").to_numpy()
    return times


def support(path: xr.Dataset) -> Floats:
    """Height of the centre of mass at which the lower sphere touches: R + L/2 |e_z| (2)."""
    upward = np.abs(path["axis"].sel(component="z").to_numpy())
    height: Floats = BODY.radius + 0.5 * BODY.separation * upward
    return height


@pytest.mark.parametrize("which", RUNS)
def test_it_goes_from_state_to_state(which: str) -> None:
    """At the end of every flight stands the state before the impact, and at its beginning the one after it.

    Rounding is that of the clock: a time t is known to ε t, in which it moves and turns by v ε t, ω ε t.
    """
    data = run(which)
    for particle in range(6):
        one = data.sel(particle=particle).dropna("impact", subset=["time"])
        times = at_impacts(data, particle)
        clock = 32.0 * EPS * times[-1]
        rate = float(np.abs(one["angular_velocity_before"]).max()) + 10.0
        for when, states in ((np.nextafter(times, 0.0), "before"), (times, "after")):
            path = rs.trajectory(data, particle, when)
            named = {
                "position": one["position"],
                "axis": one["axis"],
                "velocity": one[f"velocity_{states}"],
                "angular_velocity": one[f"angular_velocity_{states}"],
            }
            for name, expected in named.items():
                size = float(np.abs(expected).max()) + 1.0
                off = np.abs(path[name].to_numpy() - expected.to_numpy()).max()
                assert off <= clock * rate * size, (particle, states, name)
        np.testing.assert_array_equal(path["impacts"], np.arange(1, times.size + 1))


@pytest.mark.parametrize("which", RUNS)
def test_the_body_touches_at_impacts_and_never_dips(which: str) -> None:
    """The gap of the lower sphere is 0 at each impact and positive between, to rounding."""
    data = run(which)
    for particle in range(6):
        times = at_impacts(data, particle)
        rounding = 64.0 * EPS * times[-1] * (1.0 + BODY.separation * 400.0)
        touching = rs.trajectory(data, particle, times)
        gap = touching["position"].sel(component="z") - support(touching)
        assert np.abs(gap).max() <= rounding
        dense = np.sort(np.random.default_rng(particle).uniform(0.0, times[-1], 4000))
        path = rs.trajectory(data, particle, dense)
        assert (path["position"].sel(component="z") - support(path)).min() >= -rounding
        np.testing.assert_allclose(np.linalg.norm(path["axis"], axis=1), 1.0, rtol=32 * EPS)


def test_a_flight_is_that_of_a_general_integrator() -> None:
    """Newton and Euler's equations for the axis and the angular momentum, by DOP853 to 1e-12.

    dx/dt = v, dv/dt = g; de/dt = ω × e with ω = Λ/J' + (1/J - 1/J') (Λ·e) e; Λ stays.
    """
    data = run("thrown")
    gravity = 9.81 * np.array([np.sin(0.2), 0.0, -np.cos(0.2)])
    across, about = BODY.transverse_inertia, BODY.axial_inertia
    for particle in range(3):
        times = at_impacts(data, particle)
        for begin, end in ((0.0, times[0]), (times[3], times[4])):
            within = np.linspace(begin, np.nextafter(end, 0.0), 7)
            path = rs.trajectory(data, particle, within)
            x, v, e, w = (
                path[name].to_numpy() for name in ("position", "velocity", "axis", "angular_velocity")
            )
            momentum = across * w[0] + (about - across) * (w[0] @ e[0]) * e[0]

            def spin(axis: Floats, momentum: Floats = momentum) -> Floats:
                along = (1.0 / about - 1.0 / across) * (momentum @ axis)
                turning: Floats = momentum / across + along * axis
                return turning

            def motion(_: float, state: Floats, spin: Any = spin) -> Floats:
                return np.concatenate([state[3:6], gravity, np.cross(spin(state[6:]), state[6:])])

            start = np.concatenate([x[0], v[0], e[0]])
            solved = solve_ivp(
                motion, (begin, within[-1]), start, "DOP853", within, rtol=1e-12, atol=1e-15
            ).y.T
            np.testing.assert_allclose(np.hstack([x, v, e]), solved, rtol=0.0, atol=3e-11)
            np.testing.assert_allclose(w, [spin(axis) for axis in solved[:, 6:]], rtol=0.0, atol=1e-8)


TENSOR = np.array([[2e-6, 1e-7, 0.0], [1e-7, 1.5e-6, 2e-7], [0.0, 2e-7, 1e-6]])
RIGID = {
    "three moments": rs.Box(1e-2, 2e-2, 3e-2, inertia=TENSOR, centre=(1e-3, 0.0, 0.0)),
    "two moments": rs.Cylinder(radius=1e-2, height=3e-3),
    "equal moments": rs.Die(faces=4, edge=1e-2),
}


@pytest.mark.parametrize("kind", RIGID)
def test_a_flight_of_any_body_is_that_of_a_general_integrator(kind: str) -> None:
    """Newton's and Euler's equations, and dq/dt = ω q/2, by DOP853, from the release or from an impact on."""
    body = RIGID[kind]
    moved: dict[str, Any] = {"spin": (30.0, -10.0, 20.0), "release_velocity": (0.1, 0.2, 0.0), "incline": 0.1}
    law = rs.Coulomb(normal=0.8, friction=0.3)
    data = rs.simulate(body, law, particles=2, impacts=6, record="state", **moved)
    gravity = 9.81 * np.array([np.sin(0.1), 0.0, -np.cos(0.1)])

    def motion(_: float, state: Floats) -> Floats:
        velocity, (w, *v), spin = state[3:6], state[6:10], state[10:]
        turned = Rotation.from_quat([*v, w]).as_matrix()
        tensor = turned @ body.inertia_tensor @ turned.T
        quaternion = 0.5 * np.array([-spin @ v, *(w * spin + np.cross(spin, v))])
        change = np.linalg.solve(tensor, -np.cross(spin, tensor @ spin))
        return np.concatenate([velocity, gravity, quaternion, change])

    for particle in range(2):
        times = at_impacts(data, particle)
        for begin, end in ((0.0, times[0]), (times[3], times[4])):
            within = np.linspace(begin, np.nextafter(end, 0.0), 5)
            path = rs.trajectory(data, particle, within)
            names = ("position", "velocity", "attitude", "angular_velocity")
            states = np.hstack([path[name].to_numpy() for name in names])
            solved = solve_ivp(
                motion, (begin, within[-1]), states[0], "DOP853", within, rtol=1e-12, atol=1e-14
            ).y.T
            # A quaternion and its negative are the same attitude.
            states[:, 6:10] *= np.sign(np.sum(states[:, 6:10] * solved[:, 6:10], axis=1))[:, None]
            np.testing.assert_allclose(states[:, :10], solved[:, :10], rtol=0.0, atol=1e-10)
            np.testing.assert_allclose(states[:, 10:], solved[:, 10:], rtol=0.0, atol=1e-8)
        later = rs.trajectory(data, particle, np.nextafter(times, 0.0))
        here = data.isel(particle=particle)
        alike = np.abs(np.sum(later["attitude"].to_numpy() * here["attitude"].to_numpy(), axis=1))
        np.testing.assert_allclose(alike, 1.0, atol=1e-14)
        np.testing.assert_allclose(later["angular_velocity"], here["angular_velocity_before"], atol=1e-8)
        after = rs.trajectory(data, particle, times)
        np.testing.assert_allclose(after["angular_velocity"], here["angular_velocity_after"], atol=1e-13)
        first = rs.trajectory(data, particle, 0.0)
        np.testing.assert_allclose(first["attitude"][0], here["release_attitude"], atol=1e-15)


@pytest.mark.parametrize(
    ("harm", "said"),
    [
        ({"principal_moments": [1.0, 1.0, 3.0]}, r"data\.principal_moments = .*moments of inertia of a body"),
        ({"principal_moments": [1.0, 1.0]}, r"data\.principal_moments = .*moments of inertia of a body"),
        ({"principal_axes": "up"}, r"data\.principal_axes = 'up': must be 4 finite numbers"),
    ],
)
def test_states_of_no_body_are_named(harm: dict[str, Any], said: str) -> None:
    data = rs.simulate(
        RIGID["two moments"], rs.Frictionless(normal=0.9), particles=1, impacts=3, record="state"
    )
    with pytest.raises(ValueError, match=said):
        rs.trajectory(data.assign_attrs(harm), 0, 0.1)
    fast = data.assign(angular_velocity_after=1e12 * data.angular_velocity_after)
    with pytest.raises(ValueError, match=r"data: turns by .* rad in a flight"):
        rs.trajectory(fast, 0, float(data.time[0, 2]) * 0.999)


def test_times_in_any_order_and_one_alone() -> None:
    data = run("at rest")
    times = at_impacts(data, 2)
    asked = np.array([times[7], 0.0, 0.5 * times[0], times[3]])
    path = rs.trajectory(data, 2, asked)
    np.testing.assert_array_equal(path["impacts"], [8, 0, 0, 4])
    for i, when in enumerate(asked):
        assert rs.trajectory(data, 2, float(when))["position"].identical(path["position"][i : i + 1])
    released = path.isel(time=1)
    np.testing.assert_array_equal(released["position"], [0.0, 0.0, 0.06])
    np.testing.assert_array_equal(released["velocity"], 0.0)
    angle = float(data["release_angle"][2])
    np.testing.assert_allclose(released["axis"], [np.sin(angle), 0.0, np.cos(angle)], rtol=1e-15)


def test_states_survive_a_file(tmp_path: Any) -> None:
    data = run("thrown")
    data.to_netcdf(tmp_path / "run.nc")
    again = xr.load_dataset(tmp_path / "run.nc")
    when = [0.0, 0.01, float(at_impacts(data, 1)[-1])]
    expected, found = (rs.trajectory(one, 1, when) for one in (data, again))
    for name in expected.data_vars:
        np.testing.assert_array_equal(expected[name], found[name])


def test_the_state_is_recorded_for_who_asks() -> None:
    """The rest of the records is the same to the bit."""
    usual, full = run("thrown", record="impacts"), run("thrown")
    more = {"position", "axis"} | {
        f"{name}_{when}" for name in ("velocity", "angular_velocity") for when in ("before", "after")
    }
    assert set(full.data_vars) - set(usual.data_vars) == more
    for name in usual.data_vars:
        xr.testing.assert_identical(usual[name], full[name])
    for name in more:
        assert full[name].dims == ("particle", "impact", "component")


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"data": 3}, r'data = 3: must be a Dataset from restitution.simulate\(..., record="state"\)'),
        ({"data": "impacts"}, r"data lacks position, velocity_after, angular_velocity_after, axis: must be"),
        ({"particle": 6}, r"particle = 6: must be one of 0 to 5"),
        ({"particle": [1, 2]}, r"particle = \[1, 2\]: must be one of 0 to 5"),
        ({"times": -0.1}, r"times.* = -0\.1: must be in \[0, .*\] s, from the release to the last recorded"),
        ({"times": [0.0, 1e9]}, r"times\[1\] = 1000000000\.0: must be in \[0, .*\] s"),
        ({"times": np.nan}, r"times.* = nan: must be in"),
        ({"times": "soon"}, r"times = 'soon': must be times in s, one or several$"),
        ({"times": [[0.0]]}, r"times = \[\[0\.0\]\]: must be times in s, one or several$"),
        ({"times": xr.DataArray([0.0], attrs={"units": "m"})}, r"times .*'?m'?.*s"),
    ],
)
def test_bad_arguments_are_named(wrong: dict[str, Any], said: str) -> None:
    given: dict[str, Any] = {"data": run("at rest"), "particle": 0, "times": 0.01} | wrong
    if wrong.get("data") == "impacts":
        given["data"] = run("at rest", record="impacts")
    with pytest.raises(ValueError, match=f"^{said}"):
        rs.trajectory(**given)


def test_what_to_record_is_one_of_two() -> None:
    with pytest.raises(ValueError, match=r"^record = 'all': must be 'impacts' or 'state'$"):
        run("at rest", record="all")


def test_what_is_given_says_what_it_is() -> None:
    """Names, units and settings, as of the records."""
    data = run("thrown")
    path = rs.trajectory(data, 1, [0.0, 0.01])
    assert set(path.coords) == {"time", "component"}
    assert path["component"].to_numpy().tolist() == ["x", "y", "z"]
    assert path["time"].attrs == {"long_name": "time since release", "units": "s"}
    units = {"position": "m", "velocity": "m s-1", "axis": "1", "angular_velocity": "rad s-1"}
    for name, unit in units.items():
        assert path[name].dims == ("time", "component")
        assert path[name].attrs["units"] == unit
        assert set(path[name].attrs) == {"long_name", "units"}
    assert path["axis"].attrs["long_name"] == "unit vector of the symmetry axis, from sphere 2 to sphere 1"
    assert path["impacts"].dims == ("time",)
    assert path["impacts"].attrs == {"long_name": "number of impacts up to then"}
    assert path.attrs == data.attrs | {"particle": 1}
    recorded = data["position"].attrs
    assert recorded["units"] == "m"
    assert recorded["long_name"] == path["position"].attrs["long_name"] + "; at the impact"


def test_states_in_another_order_of_dimensions() -> None:
    data = run("thrown")
    expected = rs.trajectory(data, 1, [0.0, 0.01, 0.1])
    turned = data.transpose("component", "impact", "particle")
    xr.testing.assert_identical(rs.trajectory(turned, 1, [0.0, 0.01, 0.1]), expected)


def test_a_particle_without_impacts_has_its_release_alone() -> None:
    """Follow it to its release alone: it passes the largest angle before its first impact."""
    data = rs.simulate(
        BODY,
        LAW,
        particles=2,
        impacts=3,
        release_height=1.0,
        record="state",
        spin=[(0.0, 4e6, 0.0), (0.0, 1.0, 0.0)],
    )
    assert data["impacts"].to_numpy().tolist() == [0, 3]
    start = rs.trajectory(data, 0, 0.0)
    np.testing.assert_array_equal(start["angular_velocity"], [[0.0, 4e6, 0.0]])
    with pytest.raises(ValueError, match=r"^times.* = 0\.001: must be in \[0, 0\.0\] s, from the release"):
        rs.trajectory(data, 0, 1e-3)


def harmed(data: xr.Dataset, what: str) -> xr.Dataset:
    """Give a run one of whose settings or records is wrong."""
    data = data.copy(deep=True)
    name, _, value = what.partition(" ")
    if name == "component":
        return data.assign_coords(component=value.split())
    if name == "time":
        data["time"][0, 3] = float(value) if value != "before" else data["time"][0, 2] - 1e-3
    elif name == "first":
        data["time"][0, 0] = -1e-3
    elif name == "velocity":
        data["velocity_after"][0] = np.inf
    else:
        data.attrs[name] = [float(number) for number in value.split()] if " " in value else float(value)
    return data


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("component z y x", r"data\.component = .*'z'.*: must be x, y, z"),
        ("time inf", r"data\.time\[3\] = inf: must be a finite time >= 0, not before the impact before it"),
        ("time before", r"data\.time\[3\] = .*: must be a finite time >= 0, not before the impact before it"),
        ("first", r"data\.time\[0\] = -0\.001: must be a finite time >= 0, not before the impact"),
        ("velocity", r"data: the motion at these times is not finite; must be the states and settings of a"),
        ("release_velocity 1 2", r"data\.release_velocity = .*1.*2.*: must be three finite numbers$"),
        ("release_velocity nan 0 0", r"data\.release_velocity.*nan.*: must be three finite numbers"),
        ("transverse_inertia inf", r"data\.transverse_inertia = inf: must be a finite number > 0"),
        ("transverse_inertia 0", r"data\.transverse_inertia = 0\.0: must be a finite number > 0"),
        ("axial_inertia 0", r"data\.axial_inertia = 0\.0: must be a finite number in \(0, 2 trans"),
        ("gravity nan", r"data\.gravity = nan: must be"),
    ],
)
def test_a_run_that_came_to_harm_is_named(what: str, said: str) -> None:
    with pytest.raises(ValueError, match=f"^{said}"):
        rs.trajectory(harmed(run("at rest"), what), 0, [0.0, 0.3])


def test_two_impacts_at_one_time() -> None:
    """As in a collapse, when the clock has no digits left: the motion is that after the second."""
    data = run("at rest").copy(deep=True)
    data["time"][0, 3] = data["time"][0, 2]
    path = rs.trajectory(data, 0, float(data["time"][0, 2]))
    assert path["impacts"].to_numpy().tolist() == [4]
    np.testing.assert_array_equal(path["velocity"][0], data["velocity_after"][0, 3])


def test_no_body_is_flatter_than_a_disc() -> None:
    """J <= 2J', with what rounding makes of it, and the message says what 2J' is."""
    data = run("at rest")
    across = data.attrs["transverse_inertia"]
    data.attrs["axial_inertia"] = 2.0 * across * (1.0 + 1e-12)
    assert np.isfinite(rs.trajectory(data, 0, [0.3])["axis"]).all()
    data.attrs["axial_inertia"] = 2.01 * across
    said = (
        rf"data\.axial_inertia = .*: must be a finite number in \(0, 2 transverse_inertia = {2 * across:g}\]"
    )
    with pytest.raises(ValueError, match=f"^{said}$"):
        rs.trajectory(data, 0, [0.3])
