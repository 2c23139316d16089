"""Check the record of an impact: columns chosen by name, and the full state held to mechanics."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import restitution as rs
from restitution import _core
from restitution.drop.dataset import dataset
from restitution.drop.run import Run

Floats = npt.NDArray[np.float64]

GLASS = rs.Viscoelastic(young_modulus=6e10, poisson_ratio=0.22, dissipation=1e-5, density=2500.0, radius=3e-3)
BODY = rs.Dumbbell(radius=3e-3, separation=1.5e-3)
IN_SPACE: dict[str, Any] = {
    "spin": rs.RandomSpin(rate=(0.0, 300.0)),
    "release_velocity": (0.1, -0.2, 0.0),
    "orientation": "isotropic",
}
EPS = float(np.finfo(np.float64).eps)


def recorded(run: Run, columns: list[str]) -> dict[str, Floats]:
    """The columns of these names, by name."""
    table, _ = _core.simulate(run.parameters(), 1, None, columns=columns)
    return {name: values for name, (_, values, _) in table.items()}


def with_state(law: Any, **more: Any) -> dict[str, Floats]:
    run = Run(body=BODY, law=law, particles=40, impacts=30, seed=5, **more)
    return recorded(run, _core.columns(run.body.compiled, run.law.compiled, True))


def test_a_run_records_what_it_is_asked_for() -> None:
    """Nothing else takes memory, and what is recorded does not depend on what else is."""
    run = Run(body=BODY, law=rs.Frictionless(normal=0.9), particles=9, impacts=7, **IN_SPACE)
    per_particle = {"impacts", "stop_reason", "release_angle", "release_azimuth", "release_spin"}
    every = recorded(run, _core.columns(run.body.compiled, run.law.compiled, True))
    for name, size in (("angle", 8), ("contact", 1), ("velocity_after", 24)):
        alone = recorded(run, [name])
        assert set(alone) == {name} | per_particle
        np.testing.assert_array_equal(alone[name], every[name])
        assert _core.bytes_per_impact([name]) == size


def test_an_unknown_column_is_refused_with_the_list() -> None:
    with pytest.raises(ValueError, match="columns = 'colour'") as caught:
        _core.bytes_per_impact(["time", "colour"])
    assert set(_core.columns(BODY.compiled, rs.Frictionless(normal=0.9).compiled, True)) < set(
        caught.value.allowed.removeprefix("one of ").split(", ")  # type: ignore[attr-defined]
    )


def test_the_state_does_not_enlarge_the_usual_records() -> None:
    """Seven doubles and a byte; one double more where the coefficient varies."""
    assert _core.bytes_per_impact(_core.columns(BODY.compiled, rs.Frictionless(normal=0.9).compiled)) == 57
    assert _core.bytes_per_impact(_core.columns(BODY.compiled, rs.Frictionless(normal=GLASS).compiled)) == 65


def test_every_variable_is_described() -> None:
    run = Run(body=BODY, law=rs.Frictionless(normal=GLASS), particles=3, impacts=2, **IN_SPACE)
    table, _ = _core.simulate(
        run.parameters(), 1, None, columns=_core.columns(run.body.compiled, run.law.compiled, True)
    )
    data = dataset(run, table)
    for name, variable in data.data_vars.items():
        assert variable.attrs["long_name"], name
        assert ("units" in variable.attrs) == (variable.dtype.kind == "f"), name
        assert ("component" in variable.dims) == (variable.ndim - ("impact" in variable.dims) == 2), name


def test_microscopic_is_recorded_where_it_varies() -> None:
    steady = rs.simulate(BODY, rs.TangentialRestitution(normal=0.9), particles=3, impacts=2)
    varying = rs.simulate(BODY, rs.TangentialRestitution(normal=GLASS), particles=3, impacts=2)
    assert "microscopic" not in steady
    assert varying.microscopic.attrs["symbol"] == "ε_n"


def contact_velocity(found: dict[str, Floats], when: str) -> Floats:
    """v_c = v + ω × r_c (7), r_c = ±(L/2)e - R n (6)."""
    sign = np.where(found["contact"] == 1, 1.0, -1.0)[..., None]
    arm = sign * (BODY.separation / 2.0) * found["axis"] - BODY.radius * np.array([0.0, 0.0, 1.0])
    turning: Floats = np.cross(found[f"angular_velocity_{when}"], arm)
    return found[f"velocity_{when}"] + turning


@pytest.mark.parametrize("release", [{}, IN_SPACE])
@pytest.mark.parametrize("law", [rs.TangentialRestitution(normal=GLASS, tangential=0.3)])
def test_microscopic_is_the_ratio_of_the_contact_speeds(law: Any, release: dict[str, Any]) -> None:
    """The law sets the normal velocity of the contact to -ε_n times that before (8).

    Both are sums of a speed of the centre and one of the rotation, and round as these do.
    """
    found = with_state(law, **release)
    happened = found["contact"] != 0
    before = contact_velocity(found, "before")[happened][:, 2]
    after = contact_velocity(found, "after")[happened][:, 2]
    speeds = np.linalg.norm(found["velocity_before"][happened], axis=-1) + BODY.radius * np.linalg.norm(
        found["angular_velocity_before"][happened], axis=-1
    )
    microscopic = found["microscopic"][happened]
    assert np.all(np.abs(after + microscopic * before) <= 32.0 * EPS * speeds)
    clear = -before > 1e-3 * speeds
    assert clear.sum() > 200  # the comparison is of something
    np.testing.assert_allclose(microscopic[clear], GLASS(-before[clear]), rtol=0.0, atol=1e-12)
    assert np.ptp(microscopic) > 0.05


@pytest.mark.parametrize("release", [{}, IN_SPACE])
def test_the_state_obeys_mechanics(release: dict[str, Any]) -> None:
    """The sphere that touches lies on the plane (2), gravity alone acts between impacts (5).

    The angular momentum stays in flight; the recorded velocities, energies and angle follow from the state.
    """
    found = with_state(rs.Coulomb(normal=0.9, friction=0.3), **release)
    run = Run(body=BODY, law=rs.Frictionless(normal=1.0), particles=1, impacts=1)
    happened = found["contact"] != 0
    both = happened[:, 1:]
    support = BODY.radius + BODY.separation / 2.0 * np.abs(found["axis"][..., 2])
    np.testing.assert_allclose(found["height"][happened], support[happened], rtol=4.0 * EPS)
    np.testing.assert_allclose(np.linalg.norm(found["axis"][happened], axis=-1), 1.0, rtol=4.0 * EPS)
    np.testing.assert_array_equal(
        found["velocity_before"][..., 2][happened], -found["impact_velocity"][happened]
    )
    np.testing.assert_array_equal(
        found["velocity_after"][..., 2][happened], found["rebound_velocity"][happened]
    )

    fall = run.gravity * np.diff(found["time"], axis=1)
    scale = np.nanmax(np.abs(found["velocity_before"])) + run.gravity * np.nanmax(found["time"])
    later = found["velocity_before"][:, 1:] - found["velocity_after"][:, :-1]
    np.testing.assert_allclose(later[..., 2][both], -fall[both], rtol=0.0, atol=16.0 * EPS * scale)
    np.testing.assert_array_equal(later[..., :2][both], 0.0)

    def momentum(when: str) -> Floats:
        spin, axis = found[f"angular_velocity_{when}"], found["axis"]
        along = np.sum(spin * axis, axis=-1, keepdims=True)
        total: Floats = (
            BODY.transverse_inertia * spin + (BODY.axial_inertia - BODY.transverse_inertia) * along * axis
        )
        return total

    size = np.nanmax(np.abs(momentum("before")))
    drift = (momentum("before")[:, 1:] - momentum("after")[:, :-1])[both]
    np.testing.assert_allclose(drift, 0.0, rtol=0.0, atol=16.0 * EPS * size)

    def energy(when: str) -> Floats:
        rotation: Floats = np.sum(momentum(when) * found[f"angular_velocity_{when}"], axis=-1)
        moving: Floats = BODY.mass * np.sum(found[f"velocity_{when}"] ** 2, axis=-1)
        return moving + rotation

    ratio = (energy("after") / energy("before"))[happened]
    np.testing.assert_allclose(found["energy_ratio"][happened], ratio, rtol=64.0 * EPS)
    cosine = np.cos(found["angle"][happened])
    np.testing.assert_allclose(found["axis"][..., 2][happened], cosine, rtol=0.0, atol=4.0 * EPS)
