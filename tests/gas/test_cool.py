"""A gas beside exact rates of contact, Haff's law, rough spheres and what cannot change."""

import math
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.sonine import sonine
from reference.unit import dumbbell
from restitution.gas import theory

ELASTIC = rs.Frictionless(normal=1.0)


def pull(data: xr.Dataset, name: str, expected: float, at: int = -1) -> float:
    """Number of standard errors by which a value at a time is off."""
    return float((data[name][at] - expected) / data[f"{name}_error"][at])


def rate(data: xr.Dataset, name: str) -> tuple[float, float]:
    """A count of a particle and second, with its standard error."""
    time = float(data["time"][-1])
    return float(data[name][-1]) / time, float(data[f"{name}_error"][-1]) / time


# Encounters with contact, and contacts each, of a program in C++ that follows pairs: R = m = T = n = 1.
EQUILIBRIUM = {0.0: (71.086127 / np.sqrt(2 * np.pi), 1.0), 0.1: (29.8299, 1.00047), 1.0: (45.341, 1.0690)}


@pytest.mark.parametrize("elongation", EQUILIBRIUM)
def test_equilibrium(elongation: float) -> None:
    """Elastic bodies at one temperature keep it, and touch as often as the exact integral says."""
    body = dumbbell(elongation)
    data = rs.gas.cool(
        body, ELASTIC, particles=20_000, collisions=10, translational_temperature=1.0, seed=5, batches=20
    )
    encounters, contacts_each = EQUILIBRIUM[elongation]
    found, error = rate(data, "collisions")
    # The number of collisions is given; the time until then scatters.
    error = found * float(np.sqrt(2 / (20_000 * 10)))
    assert abs(found - encounters) < 4 * error + 1e-4 * encounters
    each = float(data["contacts"][-1] / data["collisions"][-1])
    assert abs(each - contacts_each) < 5 * np.sqrt(max(contacts_each - 1, 1e-12) / 1e5) + 1e-5
    exact = theory.rates(body, ELASTIC, translational_temperature=1.0, rotational_temperature=1.0).contacts
    assert rate(data, "contacts")[0] == pytest.approx(exact, rel=0.015)
    if elongation:
        assert abs(pull(data, "translational_temperature", 1.0)) < 4.5
        assert abs(pull(data, "rotational_temperature", 1.0)) < 4.5
    assert abs(pull(data, "a20", 0.0)) < 4.5
    assert data.attrs["beyond_majorant"] == 0


def test_spheres_cool_by_haffs_law() -> None:
    """With the second Sonine coefficient of van Noije and Ernst, by which they collide less often."""
    normal = 0.9
    law = rs.Frictionless(normal=normal)
    data = rs.gas.cool(
        dumbbell(0.0), law, particles=40_000, collisions=40, translational_temperature=1.0, batches=10
    )
    a2 = sonine(normal)
    tau = theory.haff_time(dumbbell(0.0), law, translational_temperature=1.0) / (1 + 3 * a2 / 16)
    half = len(data["time"]) // 2
    expected = (1 + data["time"] / tau) ** -2
    assert float(data["translational_temperature"][half] / expected[half]) == pytest.approx(1.0, abs=0.01)
    late = data["a20"][half:]
    assert float(late.mean()) == pytest.approx(a2, abs=0.006)


@pytest.mark.parametrize(("normal", "beta"), [(0.9, 0.5), (0.9, -0.5)])
def test_rough_spheres(normal: float, beta: float) -> None:
    """The ratio of the temperatures: that of Maxwellians, which is off by some hundredths."""
    law = rs.TangentialRestitution(normal=normal, tangential=-beta)
    data = rs.gas.cool(dumbbell(0.0), law, particles=20_000, collisions=80, translational_temperature=1.0)
    ratio = float(data["rotational_temperature"][-1] / data["translational_temperature"][-1])
    assert ratio == pytest.approx(theory.steady_ratio(dumbbell(0.0), law), rel=0.08)


def test_contacts_of_one_encounter_are_not_independent() -> None:
    """Dumbbells L/R = 2, T_rot = 2T_tr: molecular chaos gives dE_rot/dt = -38.485, encounters about -25."""
    body = dumbbell(2.0)
    chaos = theory.rates(body, ELASTIC, translational_temperature=1.0, rotational_temperature=2.0)
    data = rs.gas.cool(
        body,
        ELASTIC,
        particles=200_000,
        collisions=0.05,
        samples=1,
        translational_temperature=1.0,
        rotational_temperature=2.0,
        spin_temperature=1.0,
    )
    slope = float(data["rotational_temperature"][1] - 2.0) / float(data["time"][1])
    assert chaos.rotational == pytest.approx(-38.485, rel=1e-4)
    assert -29.0 < slope < -21.0


def test_phase_of_the_rotation() -> None:
    """By the time between encounters, or uniform: the same, as axes do not remember for so long."""
    body, law = dumbbell(1.0), rs.Frictionless(normal=0.8)
    both = [
        rs.gas.cool(body, law, particles=20_000, collisions=15, translational_temperature=1.0, phase=phase)
        for phase in ("time", "uniform")
    ]
    for name in ("translational_temperature", "rotational_temperature"):
        one, two = (data[name][-1] for data in both)
        error = math.hypot(*(float(data[f"{name}_error"][-1]) for data in both))
        assert abs(float(one - two)) < 5 * error


def test_what_cannot_change() -> None:
    """The energy falls at every look, and without friction the spin about the axis is what it was."""
    body, law = rs.Spherocylinder(radius=1e-3, separation=2e-3), rs.Frictionless(normal=0.9)
    data = rs.gas.cool(body, law, particles=2000, collisions=10, translational_temperature=1e-9, batches=4)
    energy = 1.5 * data["translational_temperature"] + data["rotational_temperature"]
    assert bool((np.diff(energy) < 0.0).all())
    along = data["axis_temperature"].isel(axis=2)
    np.testing.assert_allclose(along, along[0], rtol=1e-12)
    assert data.attrs["energy_created_share"] == 0.0


def test_the_same_bits_on_any_number_of_threads() -> None:
    body, law = rs.Clump(spheres=[(0, 0, 0, 1e-3), (1e-3, 0, 0, 8e-4)]), rs.Coulomb(normal=0.9, friction=0.3)
    one, two = (
        rs.gas.cool(body, law, particles=400, collisions=5, translational_temperature=1e-9, threads=threads)
        for threads in (1, 2)
    )
    xr.testing.assert_identical(one, two)


def test_a_mixture() -> None:
    """Rods in spheres: at one temperature nothing changes, and species have variables of their own."""
    data = rs.gas.cool(
        [rs.Spherocylinder(radius=1e-3, separation=4e-3), rs.Dumbbell(radius=2e-3, separation=0.0)],
        ELASTIC,
        particles=[8000, 4000],
        collisions=10,
        translational_temperature=1e-9,
    )
    assert data["translational_temperature"].dims == ("species", "time")
    for species in (0, 1):
        assert abs(pull(data.isel(species=species), "translational_temperature", 1e-9)) < 4.5


def test_laws_that_create_energy_heat_the_gas() -> None:
    law = rs.TangentialRestitution(normal=0.95, tangential=1.0)
    with pytest.warns(rs.gas.GasWarning, match=r"created energy, in a collision of each particle 0\.0[45]"):
        data = rs.gas.cool(dumbbell(1.0), law, particles=2000, collisions=10, translational_temperature=1.0)
    assert float(data["created_energy"][-1]) > 0.0


REFUSED: dict[str, dict[str, Any]] = {
    "particles": {"particles": 10},
    "collisions": {"collisions": 0.0},
    "translational_temperature": {"translational_temperature": -1.0},
    "rotational_temperature": {"rotational_temperature": np.nan},
    "spin_temperature": {"spin_temperature": -1.0},
    "number_density": {"number_density": 0.0},
    "phase": {"phase": "none"},
    "samples": {"samples": 0},
    "batches": {"batches": 1},
    "seed": {"seed": -1},
    "law": {"law": 0.9},
    "body": {"body": "rod"},
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_by_name(name: str) -> None:
    usual: dict[str, Any] = {"body": dumbbell(1.0), "law": ELASTIC, "translational_temperature": 1.0}
    with pytest.raises(ValueError, match=f"^{name}"):
        rs.gas.cool(**usual | REFUSED[name])


def test_bodies_that_are_not_their_hull_are_refused() -> None:
    with pytest.raises(ValueError, match=r"^body"):
        rs.gas.cool(rs.Ring(outer=3e-3, inner=1e-3, height=1e-3), ELASTIC, translational_temperature=1.0)


def test_a_run_is_continued_from_its_state() -> None:
    """Energies at the end of one run are those at the beginning of the next, and Haff's law goes on."""
    law = rs.Frictionless(normal=0.9)
    first = rs.gas.cool(
        dumbbell(1.0), law, particles=4000, collisions=5, translational_temperature=1.0, record="state"
    )
    then = rs.gas.cool(dumbbell(1.0), law, collisions=5, state=first, seed=2)
    for name in ("translational_temperature", "rotational_temperature", "axis_temperature", "a20", "a11"):
        np.testing.assert_allclose(then[name][0], first[name][-1], rtol=1e-12)
    whole = rs.gas.cool(
        dumbbell(1.0), law, particles=4000, collisions=10, translational_temperature=1.0, seed=3
    )
    for name in ("translational_temperature", "rotational_temperature"):
        error = float(np.hypot(then[f"{name}_error"][-1], whole[f"{name}_error"][-1]))
        assert abs(float(then[name][-1] - whole[name][-1])) < 4.5 * error


def test_a_gas_is_saved(tmp_path: Path) -> None:
    """With what it was made by, and read as it was."""
    data = rs.gas.cool(
        dumbbell(1.0), ELASTIC, particles=40, collisions=1, translational_temperature=1.0, record="state"
    )
    assert data.attrs["version"] == version("restitution")
    assert data.attrs["Conventions"].startswith("CF-")
    data.to_netcdf(tmp_path / "gas.nc")
    with xr.open_dataset(tmp_path / "gas.nc") as again:
        xr.testing.assert_equal(again, data)
        then = rs.gas.cool(dumbbell(1.0), ELASTIC, collisions=1, state=again.load(), seed=2)
    assert then.attrs["seed"] == 2


def test_the_state_of_a_mixture() -> None:
    bodies = [dumbbell(0.0), dumbbell(1.0)]
    law = rs.Frictionless(normal=0.8)
    first = rs.gas.cool(
        bodies, law, particles=[400, 200], collisions=3, translational_temperature=[1.0, 2.0], record="state"
    )
    then = rs.gas.cool(bodies, law, collisions=1, state=first, seed=2)
    np.testing.assert_allclose(
        then["translational_temperature"].isel(time=0),
        first["translational_temperature"].isel(time=-1),
        rtol=1e-12,
    )
    squares = (first["velocity"] ** 2).sum("component").groupby(first["particle_species"]).mean()
    np.testing.assert_allclose(squares / 3, first["translational_temperature"].isel(time=-1), rtol=1e-12)


def state(**changes: Any) -> xr.Dataset:
    variables: dict[str, Any] = {
        "velocity": (("particle", "component"), np.ones((40, 3))),
        "angular_velocity": (("particle", "component"), np.zeros((40, 3))),
        "attitude": (("particle", "quaternion"), np.tile([1.0, 0.0, 0.0, 0.0], (40, 1))),
    }
    return xr.Dataset(variables | changes)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"state": 3}, "state = 3: must be a Dataset of velocity"),
        ({"state": state().drop_vars("attitude")}, "state lacks attitude"),
        ({"state": state(velocity=(("particle", "component"), np.zeros((40, 3))))}, r"state.velocity = 0"),
        ({"state": state(attitude=(("particle", "quaternion"), np.ones((40, 4))))}, "unit quaternions"),
        ({"state": state(), "batches": 7}, "as many in each of 7 batches"),
        ({"state": state(), "particles": 40}, "particles: given beside state"),
        ({"state": state(), "translational_temperature": 1.0}, "translational_temperature: given beside"),
        ({}, "translational_temperature: missing"),
        ({"translational_temperature": 1.0, "record": "all"}, "record = 'all'"),
    ],
)
def test_states_that_are_none(given: dict[str, Any], text: str) -> None:
    with pytest.raises(ValueError, match=text):
        rs.gas.cool(dumbbell(0.0), ELASTIC, **given)


@pytest.mark.parametrize("elongation", [0.0, 1.0])
def test_distributions(elongation: float) -> None:
    """At first those of Maxwellians, by their closed form; fourth moments are those of `a20` and `a02`."""
    law = rs.Frictionless(normal=0.6)
    data = rs.gas.cool(
        dumbbell(elongation),
        law,
        particles=40_000,
        collisions=20,
        translational_temperature=1.0,
        samples=2,
        distributions=True,
        seed=3,
    )
    for name, axes, moment in [("speed", 3, "a20"), ("spin", 2, "a02")][: 2 if elongation else 1]:
        x = data[f"relative_{name}"]
        density, error = data[f"{name}_distribution"], data[f"{name}_distribution_error"]
        size = 2 * (axes / 2) ** (axes / 2) / math.gamma(axes / 2)
        maxwell = size * x ** (axes - 1) * np.exp(-axes * x**2 / 2)
        full = density[0] * 0.05 * 40_000 > 100
        pulls = ((density[0] - maxwell) / np.sqrt(maxwell / (0.05 * 40_000))).where(full)
        assert abs(pulls).max() < 4.5
        assert 0.5 < float((pulls**2).mean()) < 1.7
        for at in range(3):
            assert float((density[at] * 0.05).sum()) == pytest.approx(1.0, abs=1e-3)
            fourth = float((x**4 * density[at] * 0.05).sum())
            # <x^4> of a bin is above the fourth power of its centre by x²w²/4.
            fourth += 0.25 * 0.05**2 * float((x**2 * density[at] * 0.05).sum())
            assert fourth == pytest.approx((axes + 2) / axes * (1 + float(data[moment][at])), rel=2e-3)
        assert float(error[-1].max()) < 0.05
    assert np.isnan(data["spin_distribution"]).all() == (elongation == 0.0)


def test_distributions_of_a_mixture() -> None:
    """By species, and left out where they are not asked for."""
    bodies, law = [dumbbell(0.0), dumbbell(1.0)], rs.Frictionless(normal=0.9)
    few: dict[str, Any] = {
        "particles": [200, 400],
        "collisions": 1,
        "translational_temperature": 1.0,
        "samples": 1,
    }
    data = rs.gas.cool(bodies, law, distributions=True, **few)
    assert data["spin_distribution"].dims == ("species", "time", "relative_spin")
    same = rs.gas.cool(bodies, law, **few)
    assert "speed_distribution" not in same
    assert (same["a20"] == data["a20"]).all()


def test_more_particles_than_memory_are_named() -> None:
    with pytest.raises(ValueError, match=r"^particles = 1000000000000: must be at most .* particles, which"):
        rs.gas.cool(dumbbell(1.0), ELASTIC, particles=10**12, translational_temperature=1.0)


def test_viscoelastic_spheres_of_a_gas_are_two_spheres() -> None:
    """In the first collisions they lose what a pair does, which is less than on a rigid plane."""
    normal = rs.Viscoelastic(
        young_modulus=1e9, poisson_ratio=0.3, dissipation=2e-6, density=2500.0, radius=1e-3
    )
    body, law = rs.Dumbbell(radius=1e-3, separation=0.0), rs.Frictionless(normal=normal)
    warm = body.mass * 0.3**2
    gas = rs.gas.cool(body, law, particles=4000, collisions=0.2, translational_temperature=warm, samples=1)
    pairs = rs.pair.encounters(
        body, body, law, encounters=4000, translational_temperature=warm, rotational_temperature=0.0
    )
    lost = (pairs.translational_energy_before - pairs.translational_energy_after).sum("particle")
    collisions = 0.5 * float(gas.collisions[-1])
    falls = 1.5 * float(gas.translational_temperature[0] - gas.translational_temperature[-1])
    assert falls == pytest.approx(collisions * float(lost.mean()), rel=0.06)
