"""A gas that noise heats, beside the power that goes in and the steady states that theory knows."""

import math

import pytest

import restitution as rs
from reference.unit import dumbbell
from restitution.gas import theory

ELASTIC = rs.Frictionless(normal=1.0)


def test_the_power_goes_in() -> None:
    """Of elastic dumbbells all of it stays: 3T_tr/2 + T_rot, less what the mean velocity would take."""
    power, particles, batches = 3.0, 20_000, 20
    data = rs.gas.cool(
        dumbbell(1.0),
        ELASTIC,
        particles=particles,
        collisions=6,
        translational_temperature=1.0,
        heating=power,
        batches=batches,
    )
    energy = 1.5 * data["translational_temperature"] + data["rotational_temperature"]
    # N - 1 of N velocities of a batch are heated.
    given = power * float(data["time"][-1]) * (1.0 - batches / particles)
    # A kick's energy is mv·dv, of variance m²v²·2P dt/3m = 2T P dt for each particle.
    warm = float(data["translational_temperature"].mean())
    error = math.sqrt((2.0 * warm * given + 2.0 / 3.0 * given**2) / particles)
    assert given > 0.3
    assert abs(float(energy[-1] - energy[0]) - given) < 4.5 * error
    assert data.attrs["beyond_majorant"] == 0
    assert data.attrs["heating"] == power


@pytest.mark.parametrize("normal", [0.5, 0.9])
def test_spheres_become_steady(normal: float) -> None:
    """Where collisions take the power, with the second Sonine coefficient of van Noije and Ernst.

    T. P. C. van Noije and M. H. Ernst, Granular Matter 1, 57 (1998), for d = 3: a₂ is 16(1 - ε)(1 - 2ε²) over
    73 + 56d - 24dε - 105ε + 30(1 - ε)ε². A sphere of radius 1 and mass 1 meets 16√(πT) others in a second,
    and each takes (1 - ε²)T/2 of its energy.
    """
    a2 = 16 * (1 - normal) * (1 - 2 * normal**2) / (241 - 177 * normal + 30 * (1 - normal) * normal**2)
    power = 8 * math.sqrt(math.pi) * (1 - normal**2) * (1 + 3 * a2 / 16)  # that keeps T = 1
    data = rs.gas.cool(
        dumbbell(0.0),
        rs.Frictionless(normal=normal),
        particles=40_000,
        collisions=80,
        translational_temperature=0.5,
        heating=power,
        batches=10,
    )
    steady = data.isel(time=slice(25, None)).mean("time")
    assert float(steady["translational_temperature"]) == pytest.approx(1.0, abs=0.006)
    assert float(steady["a20"]) == pytest.approx(a2, abs=0.005)


def test_dumbbells_become_steady() -> None:
    """Rotation, which the noise does not heat, is where collisions give it as much as they take."""
    body, law = dumbbell(1.0), rs.Frictionless(normal=0.9)

    def gain(ratio: float) -> float:
        at = theory.rates(body, law, translational_temperature=1.0, rotational_temperature=ratio)
        return at.rotational

    low, high = 0.1, 1.0
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gain(middle) > 0 else (low, middle)
    data = rs.gas.cool(
        body,
        law,
        particles=20_000,
        collisions=60,
        translational_temperature=1.0,
        rotational_temperature=low,
        heating=5.0,
        batches=10,
        seed=3,
    )
    late = data.isel(time=slice(25, None))
    ratio = float((late["rotational_temperature"] / late["translational_temperature"]).mean())
    # The closure takes contacts of one encounter as independent.
    assert ratio == pytest.approx(low, rel=0.05)
    warm = late["translational_temperature"]
    assert float(warm[-10:].mean() / warm[:10].mean()) == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize("heating", [-1.0, math.nan, math.inf, "much"])
def test_what_is_no_power(heating: float) -> None:
    with pytest.raises(ValueError, match="heating ="):
        rs.gas.cool(dumbbell(0.0), ELASTIC, particles=100, translational_temperature=1.0, heating=heating)


def test_a_power_beyond_all_numbers() -> None:
    with pytest.raises(ValueError, match=r"heating = .*neither overflow nor underflow"):
        rs.gas.cool(dumbbell(0.0), ELASTIC, particles=100, translational_temperature=1.0, heating=1e200)
