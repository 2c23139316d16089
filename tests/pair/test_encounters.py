"""Encounters against closed forms, an independent search, and conservation."""

import sys
from itertools import combinations_with_replacement
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import restitution as rs
from reference.convex import area_and_mean_radius
from reference.unit import dumbbell

sys.path.insert(0, str(Path(__file__).parent))
import oracle

ELASTIC = rs.Frictionless(normal=1.0)


def surface(data: Any) -> Any:
    """Estimate I = nu √(2π/kT)/n of particles of mass 1, with its standard error."""
    contacts = data.contacts.to_numpy()
    scale = data.attrs["attempt_rate"] * np.sqrt(2 * np.pi)
    return scale * contacts.mean(), scale * contacts.std() / np.sqrt(contacts.size)


def drawn(body: Any, other: Any = None, law: Any = ELASTIC, **options: Any) -> Any:
    options = {"translational_temperature": 1.0, "rotational_temperature": 1.0, "seed": 3} | options
    return rs.pair.encounters(body, other or body, law, **options)


def test_spheres_meet_at_the_rate_of_kinetic_theory() -> None:
    body = dumbbell(0.0)
    data = drawn(body, encounters=1000)
    assert (data.contacts == 1).all()
    assert surface(data)[0] == pytest.approx(16 * np.sqrt(2) * np.pi, rel=1e-12)


@pytest.mark.parametrize(("separation", "exact"), [(0.1, 74.8100282), (1.0, 121.4752259)])
def test_contacts_of_dumbbells_in_equilibrium(separation: Any, exact: Any) -> None:
    data = drawn(dumbbell(separation), encounters=100_000)
    found, error = surface(data)
    assert abs(found - exact) < 4 * error
    assert error < 0.005 * exact


def test_contacts_of_spheroids_in_equilibrium() -> None:
    """J = 1 for semi-axes 2, 1 and 1."""
    density = 1.0 / rs.Spheroid(equatorial=1.0, polar=2.0, density=1.0).mass
    body = rs.Spheroid(equatorial=1.0, polar=2.0, density=density)
    found, error = surface(drawn(body, encounters=30_000))
    assert abs(found - 157.0410992) < 4 * error


FROZEN = (
    rs.Dumbbell(radius=1.0, separation=0.0),
    rs.Spherocylinder(radius=0.5, separation=2.0),
    rs.Spheroid(equatorial=1.0, polar=2.0),
    rs.Cylinder(radius=0.7, height=2.0),
    rs.Box(2.0, 1.6, 1.2),
)


@pytest.mark.parametrize(
    ("body", "other"),
    list(combinations_with_replacement(FROZEN, 2))[1:],  # two spheres always meet
    ids=lambda body: type(body).__name__,
)
def test_frozen_bodies_have_the_cross_section_of_convex_ones(body: Any, other: Any) -> None:
    """(S_A + S_B)/4 + 2π R_A R_B, R the mean radius, of bodies that do not turn."""
    data = rs.pair.encounters(body, other, ELASTIC, spin=(0.0, 0.0, 0.0), speed=1.0, encounters=4000, seed=5)
    (area, radius), (more, wider) = area_and_mean_radius(body), area_and_mean_radius(other)
    exact = (area + more) / 4 + 2 * np.pi * radius * wider
    hit = (data.contacts > 0).to_numpy()
    found, error = data.attrs["attempt_rate"] * np.array([hit.mean(), hit.std() / np.sqrt(hit.size)])
    assert abs(found - exact) < 4 * error


@pytest.mark.parametrize("temperatures", [(1.0, 1.0), (1.0, 2.0)])
def test_detailed_balance(temperatures: Any) -> None:
    """Equal temperatures of translation and rotation exchange no energy; others flow from hot to cold."""
    translation, rotation = temperatures
    data = drawn(dumbbell(2.0), rotational_temperature=rotation, encounters=60_000)
    gain = (data.rotational_energy_after - data.rotational_energy_before).sum("particle").to_numpy()
    mean, error = gain.mean(), gain.std() / np.sqrt(gain.size)
    if translation == rotation:
        assert abs(mean) < 4 * error
    else:
        # Chaos says -38.479 for each particle at unit density.
        rate = data.attrs["attempt_rate"] / 2 * np.array([mean, error])
        assert abs(rate[0] + 25.0) < 4 * rate[1] + 0.5


def test_what_is_kept() -> None:
    body, other = dumbbell(1.0), dumbbell(0.5, mass=3.0)
    law = rs.Coulomb(normal=0.7, friction=0.4, hypothesis="poisson")
    data = drawn(body, other, law, encounters=2000, record="contacts")
    masses = xr.DataArray([body.mass, other.mass], dims="particle")
    change = ((data.velocity_after - data.velocity_before) * masses).sum("particle")
    assert float(abs(change).max()) < 1e-12
    impulse = data.impulse.sum("contact")
    assert float(abs((data.velocity_after - data.velocity_before)[:, 0] * body.mass - impulse).max()) < 1e-12
    hit = data.ending == 1
    assert (data.restitution_energy.where(hit, 0.0) <= 1 + 1e-12).all()


def test_given_pairs_come_back() -> None:
    body = dumbbell(1.0)
    data = drawn(body, encounters=200, record="state")
    names = ("position", "velocity", "angular_velocity", "attitude")
    states = xr.Dataset({name: data[f"{name}_before"] for name in names})
    again = rs.pair.encounters(body, body, ELASTIC, states=states, record="contacts")
    for name in names:
        # A quaternion is normalised once more.
        assert float(abs(again[f"{name}_before"] - data[f"{name}_before"]).max()) < 4e-16
        assert float(abs(again[f"{name}_after"] - data[f"{name}_after"]).max()) < 1e-9
    turned = {name: data[f"{name}_after"] * (-1 if "velocity" in name else 1) for name in names}
    back = rs.pair.encounters(body, body, ELASTIC, states=xr.Dataset(turned))
    assert float(abs(back.velocity_after + data.velocity_before).max()) < 1e-7


def test_an_independent_search_finds_the_same_contacts() -> None:
    """Of clumps without any symmetry, at the first contact."""
    balls = [(0.6, 0.6, 0.6, 0.8), (0.6, -0.6, -0.6, 0.8), (-0.6, 0.6, -0.6, 0.7), (-0.6, -0.6, 0.6, 0.5)]
    clump, bar = rs.Clump(spheres=balls, density=0.1, inertia="sum"), dumbbell(1.0)
    law = rs.Frictionless(normal=0.8)
    data = drawn(clump, bar, law, encounters=40, record="contacts")
    compiled = clump.compiled
    w, x, y, z = compiled.principal_axes
    axes = Rotation.from_quat([x, y, z, w])
    places = axes.inv().apply(np.array(balls)[:, :3] - compiled.centre)
    grains = [
        oracle.Grain(
            np.column_stack([places, np.array(balls)[:, 3]]), clump.mass, compiled.principal_moments
        ),
        oracle.Grain(
            [(0, 0, 0.5, 1), (0, 0, -0.5, 1)],
            bar.mass,
            (bar.transverse_inertia, bar.transverse_inertia, bar.axial_inertia),
        ),
    ]
    compared = 0
    for k in range(data.sizes["encounter"]):
        row = data.isel(encounter=k)
        states = []
        for i, own in enumerate((axes, Rotation.identity())):
            attitude = Rotation.from_quat(row.attitude_before[i].to_numpy()[[1, 2, 3, 0]]) * own
            states.append(
                {
                    "position": row.position_before[i].to_numpy(),
                    "velocity": row.velocity_before[i].to_numpy(),
                    "attitude": attitude.as_quat(),
                    "spin": attitude.inv().apply(row.angular_velocity_before[i].to_numpy()),
                }
            )
        found = oracle.collide(grains, states, 0.8, float(row.duration) * (1 + 1e-9))
        assert (found is None) == (int(row.contacts) == 0)
        if found is None:
            continue
        time, velocities, _ = found
        assert time == pytest.approx(float(row.time[0]), abs=1e-9)
        if int(row.contacts) == 1:
            assert np.abs(np.array(velocities) - row.velocity_after.to_numpy()).max() < 1e-7
            compared += 1
    assert compared > 10


def test_the_first_contact_with_a_plane_is_that_of_a_drop() -> None:
    """At one speed, without spin, ε of the first impact is distributed as that of isotropic attitudes."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Frictionless(normal=0.9)
    data = rs.pair.encounters(
        body, rs.Plane(), law, encounters=40_000, speed=1.0, spin=(0.0, 0.0, 0.0), record="contacts"
    )
    first = data.approach_speed[:, 0]
    assert float(abs(first - 1.0).max()) < 1e-12
    single = (data.contacts == 1).to_numpy()
    kappa = 1.5e-3**2 * body.mass / body.transverse_inertia
    # The axis is isotropic: x = cos θ is uniform, and ε = (1 + e)/(1 + κ sin²θ) - 1 of the first contact.
    exact = quad(lambda x: 1.9 / (1 + kappa * (1 - x * x)) - 1, 0, 1)[0]
    rebound = (data.impulse[:, 0, 2] / body.mass - 1.0).to_numpy()
    assert abs(rebound.mean() - exact) < 4 * rebound.std() / np.sqrt(rebound.size)
    assert single.mean() > 0.5


def test_threads_and_chunks_do_not_show() -> None:
    body = dumbbell(1.0)
    one, two = (drawn(body, encounters=3000, threads=threads, record="contacts") for threads in (1, 2))
    assert one.identical(two)


def test_rates_of_a_gas() -> None:
    found = rs.pair.rates(dumbbell(1.0), ELASTIC, temperature_ratios=[1.0], encounters=80_000)
    exact = 121.4752259 / np.sqrt(2 * np.pi)
    assert abs(float(found.contact_rate[0]) - exact) < 4 * float(found.contact_rate_error[0])
    assert abs(float(found.rotational_exchange[0])) < 4 * float(found.rotational_exchange_error[0])


def test_what_cannot_turn_has_no_rate_of_rotation() -> None:
    found = rs.pair.rates(dumbbell(0.0), rs.Frictionless(normal=0.9), encounters=1000, seed=5)
    assert np.isnan(found["rotational_cooling"]).all()
    np.testing.assert_allclose(found["rotational_exchange"], 0.0, atol=1e-10)
    assert (found.attrs["law"], found.attrs["seed"]) == ("Frictionless(normal=0.9)", 5)


def states_of(**changed: Any) -> Any:
    rows = {
        "position": np.array([[[0.0, 0, 3], [0, 0, 0]]]),
        "velocity": np.array([[[0.0, 0, -1], [0, 0, 0]]]),
        "angular_velocity": np.zeros((1, 2, 3)),
        "attitude": np.array([[[1.0, 0, 0, 0]] * 2]),
    } | changed
    last = {"attitude": "quaternion"}
    return xr.Dataset(
        {
            name: (("encounter", "particle", last.get(name, "component")), value)
            for name, value in rows.items()
        }
    )


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"translational_temperature": -1.0}, "translational_temperature"),
        ({"rotational_temperature": (1.0, -1.0)}, "rotational_temperature"),
        ({"speed": 1.0}, "translational_temperature"),
        ({"spin": (0.0, 0.0, 1.0)}, "rotational_temperature"),
        ({"encounters": 0}, "encounters"),
        ({"impact_parameter": 100.0}, "impact_parameter"),
        ({"record": "everything"}, "record"),
        ({"other": rs.Ring}, "other"),
        ({"other": rs.Egg.example()}, "other"),
        ({"states": states_of()}, "translational_temperature"),
    ],
)
def test_bad_input_is_named(options: Any, name: Any) -> None:
    body = dumbbell(0.0)
    arguments = {"translational_temperature": 1.0, "rotational_temperature": 1.0} | options
    other = arguments.pop("other", body)
    with pytest.raises(ValueError, match=f"^{name}"):
        rs.pair.encounters(body, other, ELASTIC, **arguments)


@pytest.mark.parametrize(
    ("changed", "name"),
    [
        ({"position": np.array([[[0.0, 0, 1.9], [0, 0, 0]]])}, "states.position"),
        ({"attitude": np.array([[[2.0, 0, 0, 0]] * 2])}, "states.attitude"),
        ({"velocity": np.array([[[np.nan, 0, 0], [0, 0, 0]]])}, "states.velocity"),
    ],
)
def test_bad_states_are_named(changed: Any, name: Any) -> None:
    body = dumbbell(0.0)
    with pytest.raises(ValueError, match=f"^{name}"):
        rs.pair.encounters(body, body, ELASTIC, states=states_of(**changed))


@pytest.mark.parametrize("law", [ELASTIC, rs.Coulomb(normal=1.0, friction=0.0)])
def test_rotation_alone_lets_bodies_meet(law: Any) -> None:
    """Centres at rest d apart, one dumbbell turning at ω in its plane: sin ωt = (d² + L²/2 - 4R²)/dL."""
    body, apart, rate = dumbbell(1.0), 2.2, 10.0
    half = np.sqrt(0.5)
    states = states_of(
        position=np.array([[[0.0, 0, 0], [0, apart, 0]]]),
        velocity=np.zeros((1, 2, 3)),
        angular_velocity=np.array([[[0.0, 0, rate], [0, 0, 0]]]),
        attitude=np.array([[[half, 0, half, 0], [1.0, 0, 0, 0]]]),
    )
    found = rs.pair.encounters(body, body, law, states=states, record="contacts")
    exact = np.arcsin((apart**2 + 0.5 - 4.0) / apart) / rate
    assert found["time"][0, 0] == pytest.approx(exact, rel=1e-12)


BOXLIKE = rs.Superellipsoid(semi_axes=(3e-3, 2e-3, 1e-3), exponents=(4, 9))


@pytest.mark.parametrize("body", [rs.Ring.example(), rs.Mesh.example(), rs.Egg.example(), BOXLIKE])
def test_bodies_that_are_not_followed_are_refused(body: Any) -> None:
    with pytest.raises(ValueError, match=r"^body = "):
        drawn(body)


CAPSULE = rs.Spherocylinder(radius=0.5, separation=2.0)


@pytest.mark.parametrize(
    ("body", "within", "exact"),
    [
        (dumbbell(0.1), (1.99875, 2.1), 36.0544825),
        (dumbbell(1.0), (1.8708, 3.0), 61.2047854),
        (CAPSULE, (1.0, 3.0), None),
    ],
    ids=["dumbbells 0.1", "dumbbells 1", "spherocylinders"],
)
@pytest.mark.parametrize("pairs", [200, pytest.param(10_000, marks=pytest.mark.slow)])
def test_excluded_volume(body: Any, within: Any, exact: Any, pairs: int) -> None:
    """The volume in which a centre makes two bodies overlap, averaged over attitudes.

    All do that are nearer than the first of `within`, the square root of 4R² - L²/2 for dumbbells of balls of
    radius R, L apart, because the mean square of the distances of their balls is r² + L²/2; none do farther
    than the second. Of convex bodies it is V_A + V_B + S_A R_B + S_B R_A with the mean radii (A. Isihara, J.
    Chem. Phys. 18, 1446 (1950); H. Hadwiger).
    """
    rng = np.random.default_rng(1)
    inner, outer = (4 / 3 * np.pi * r**3 for r in within)
    if exact is None:
        area, radius = area_and_mean_radius(body)
        exact = 2 * (body.mass / body.density) + 2 * area * radius
    count = 0
    for _ in range(pairs):
        line = rng.normal(size=3)
        line *= np.cbrt(rng.uniform(within[0] ** 3, within[1] ** 3)) / np.linalg.norm(line)
        states = states_of(
            position=np.array([[line, np.zeros(3)]]),
            attitude=Rotation.random(2, rng=rng).as_quat(scalar_first=True)[np.newaxis],
        )
        try:
            rs.pair.encounters(body, body, ELASTIC, states=states, threads=1)
        except ValueError:
            count += 1
    share = count / pairs
    found, error = inner + share * (outer - inner), (outer - inner) * np.sqrt(share * (1 - share) / pairs)
    assert abs(found - exact) < 4 * error


@pytest.mark.parametrize("size", [1.0, 2.0, 0.3])
def test_viscoelastic_spheres_of_two_sizes(size: float) -> None:
    """The radius and the mass of Hertz are the effective ones, and half as stiff as a rigid plane."""
    about: Any = {"young_modulus": 6e10, "poisson_ratio": 0.22, "dissipation": 1e-6, "density": 2500.0}
    one, two = 3e-3, 3e-3 * size
    normal = rs.Viscoelastic(radius=one, **about)
    body, other = (rs.Dumbbell(radius=radius, separation=0.0, density=2500.0) for radius in (one, two))
    found = rs.pair.encounters(
        body,
        other,
        rs.Frictionless(normal=normal),
        encounters=1,
        speed=1.0,
        impact_parameter=0.0,
        spin=[0, 0, 0],
    )
    masses = [4 / 3 * np.pi * 2500.0 * radius**3 for radius in (one, two)]
    stiffness = 4 / 3 * np.sqrt(one * two / (one + two)) * 0.5 * 6e10 / (1 - 0.22**2)
    beta = 1.5 * 1e-6 * (stiffness * (1 / masses[0] + 1 / masses[1])) ** 0.4
    x = np.sqrt(beta) * float(found.contact_speed[0]) ** 0.1
    above = np.polynomial.Polynomial([1.0, 1.07232, 0.574198, 0.141552])
    below = np.polynomial.Polynomial([1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585])
    assert float(found.restitution_contact[0]) == pytest.approx(above(x) / below(x), rel=1e-12)
