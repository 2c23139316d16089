"""Encounters that are drawn again: exact for spheres, right in distribution for bodies that turn."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.unit import dumbbell
from restitution.pair import PairKernel


def geometry(number: int, seed: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    u, k = rng.normal(size=(2, number, 3))
    k /= np.linalg.norm(k, axis=1, keepdims=True)
    return u * -np.sign(np.sum(u * k, axis=1, keepdims=True)), k


def learned(body: Any, law: Any, other: Any = None, **options: Any) -> PairKernel:
    options = {"translational_temperature": 1.0, "encounters": 20_000, "seed": 4} | options
    return PairKernel.learn(body, other or body, law, **options)


def test_smooth_spheres_are_reflected() -> None:
    """u' = u - (1 + ε)(u·k)k, in any geometry and whatever the recorded one was."""
    kernel = learned(dumbbell(0.0), rs.Frictionless(normal=0.8), encounters=2000)
    u, k = geometry(200, 1)
    u -= k  # faster than the lowest of the fifty bins
    after = kernel.rvs(u, k, random_state=2)
    np.testing.assert_allclose(after.velocity, u - 1.8 * np.sum(u * k, axis=1, keepdims=True) * k, atol=1e-12)
    np.testing.assert_allclose(after.rotational_change, 0.0, atol=1e-12)
    assert (after.contacts == 1).all()
    np.testing.assert_allclose(kernel.data["restitution_centres"], 0.8, rtol=1e-10)
    exact = np.sqrt(np.pi) * 4.0 * 4.0 / np.sqrt(1.0)  # 4 √π d² √(T/m), d = 2
    np.testing.assert_allclose(kernel.data["encounter_rate"], exact, rtol=1e-12)


def test_rough_spheres_keep_normal_restitution() -> None:
    kernel = learned(dumbbell(0.0), rs.TangentialRestitution(normal=0.7, tangential=-0.4), encounters=2000)
    u, k = geometry(100, 3)
    u -= k
    after = kernel.rvs(u, k, random_state=1)
    np.testing.assert_allclose(np.sum(after.velocity * k, axis=1), -0.7 * np.sum(u * k, axis=1), atol=1e-12)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_rough_spheres_exchange_what_kinetic_theory_says(ratio: float) -> None:
    """M. Huthmann and A. Zippelius, Phys. Rev. E 56, R6275 (1997), and S. Luding et al. (1998), Maxwellians.

    A particle gains -2(A T_tr - B T_rot) and 2(B T_tr - C T_rot) in a contact on average, d = 2, m = 1.
    """
    normal, beta, q = 0.8, -0.5, 0.4  # 4J/md²
    law = rs.TangentialRestitution(normal=normal, tangential=-beta)
    kernel = learned(dumbbell(0.0), law, temperature_ratios=[ratio], encounters=100_000)
    rng = np.random.default_rng(12)
    count = 200_000
    speed = np.sqrt(-4.0 * np.log(rng.random(count)))  # of those that meet, u of variance 2T/m
    u = np.concatenate([np.sqrt(2.0) * rng.normal(size=(count, 2)), -speed[:, np.newaxis]], axis=1)
    after = kernel.rvs(u, [0.0, 0.0, 1.0], ratio, random_state=3)
    eta = q * (1 + beta) / (2 * (1 + q))
    a, b, c = (1 - normal**2) / 4 + eta * (1 - eta), eta**2 / q, eta / q * (1 - eta / q)
    moved = 0.25 * ((after.velocity**2).sum(axis=1) - (u**2).sum(axis=1))
    turned = after.rotational_change.sum(axis=1)
    for found, expected in ((moved, -4 * (a - b * ratio)), (turned, 4 * (b - c * ratio))):
        error = np.std(found) * np.hypot(1 / np.sqrt(count), 1 / np.sqrt(100_000))
        assert abs(np.mean(found) - expected) < 4.5 * error
        assert error < 0.01


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_energies_in_distribution(ratio: float) -> None:
    """Fed with the collisions of other encounters, it exchanges on average what these did."""
    body, law = dumbbell(1.0), rs.Frictionless(normal=0.9)
    kernel = learned(body, law, temperature_ratios=[0.5, 2.0], encounters=60_000)
    fresh = learned(body, law, temperature_ratios=[ratio], encounters=60_000, seed=9).data
    speed = fresh["centre_speed"].to_numpy()
    k = np.tile([0.0, 0.0, 1.0], (len(speed), 1))
    u = np.stack([fresh["tangential_speed"], 0.0 * speed, -speed], axis=1)
    after = kernel.rvs(u, k, ratio, random_state=6)
    for found, expected in (
        (after.rotational_change.sum(axis=1), fresh["rotational_change"].sum("particle").to_numpy()),
        (after.velocity[:, 2], (fresh["velocity_change"][:, 0] - fresh["centre_speed"]).to_numpy()),
        (after.contacts, fresh["contacts"].to_numpy()),
    ):
        error = np.hypot(np.std(found), np.std(expected)) / np.sqrt(len(speed))
        assert abs(np.mean(found) - np.mean(expected)) < 4.5 * error
    assert abs(np.mean(after.rotational_change)) > 10 * np.std(after.rotational_change) / np.sqrt(len(speed))


def test_a_plane() -> None:
    """ε and the change of E_rot are those of one encounter, so that no energy comes from nowhere."""
    body = dumbbell(1.0)
    kernel = learned(body, rs.Frictionless(normal=1.0), rs.Plane(), encounters=5000)
    data = kernel.data
    before = data["centre_speed"]
    gained = 0.5 * ((data["restitution_centres"] * before) ** 2 - before**2)
    np.testing.assert_allclose(gained, -data["rotational_change"][:, 0], atol=1e-11)
    v = np.tile([0.3, 0.0, -1.0], (1000, 1))
    after = kernel.rvs(v, [0.0, 0.0, 1.0], random_state=1)
    energy = 0.5 * (after.velocity**2 - v**2).sum(axis=1) + after.rotational_change[:, 0]
    np.testing.assert_allclose(energy, 0.0, atol=1e-11)


def test_what_is_saved_draws_alike(tmp_path: Any) -> None:
    kernel = learned(dumbbell(0.5), rs.Frictionless(normal=0.9), encounters=2000)
    kernel.data.to_netcdf(tmp_path / "kernel.nc")
    with xr.open_dataset(tmp_path / "kernel.nc") as data:
        again = PairKernel(data.load())
    u, k = geometry(50, 7)
    np.testing.assert_array_equal(
        kernel.rvs(u, k, 1.5, random_state=3).velocity, again.rvs(u, k, 1.5, random_state=3).velocity
    )


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"direction": [0.0, 0.0, 2.0]}, r"direction = \[0.0, 0.0, 2.0\]: must be unit vectors"),
        ({"velocity": [0.0, 0.0, 1.0]}, r"velocity = \[0.0, 0.0, 1.0\]: must be towards each other"),
        ({"velocity": [0.0, 1.0]}, "velocity has the shape"),
        ({"temperature_ratio": -1.0}, "temperature_ratio = -1.0"),
        ({"random_state": -1}, "random_state = -1"),
    ],
)
def test_collisions_that_are_none(arguments: dict[str, Any], text: str) -> None:
    kernel = learned(dumbbell(0.0), rs.Frictionless(normal=0.8), encounters=50)
    with pytest.raises(ValueError, match=text):
        kernel.rvs(**({"velocity": [0.0, 0.0, -1.0], "direction": [0.0, 0.0, 1.0]} | arguments))
