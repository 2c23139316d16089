"""Runs made up so that the answer to each of the paper's claims is known.

The made-up particles lose speed from impact to impact; all else about them is chosen by the test. What a test
makes differ does so by far more than the four standard errors that verdicts ask for, and the seeds are fixed.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from restitution.analytic import first_impact
from restitution.papers.claims import Finding
from restitution.papers.glielmo2014._claims import CLAIMS
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

Array = NDArray[np.float64]
Noise = Callable[[np.random.Generator, tuple[int, ...]], Array]
Function = Callable[[Array], Array]

SETTINGS = Settings()
PARTICLES, IMPACTS = 500, 120
SHAPE = (PARTICLES, IMPACTS)


def skew(random: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Asymmetric Laplace with decay lengths 0.9 above and 0.5 below."""
    above = random.random(shape) < 0.9 / 1.4
    return np.where(above, random.exponential(0.9, shape), -random.exponential(0.5, shape))


def even(random: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Symmetric Laplace."""
    return random.laplace(0, 0.7, shape)


def normal(random: np.random.Generator, shape: tuple[int, ...]) -> Array:
    """Gaussian."""
    return random.normal(size=shape)


def run(
    *,
    sigma: Function = lambda v: 0.01 / v,
    noise: Noise = skew,
    slow_noise: Noise | None = None,
    fraction: Function = lambda v: 0.25 * (1.1 - v),
    change: Function = lambda v: np.full_like(v, 0.5),
    first: float = 1e-3,
    ratio: float = 0.97,
    seed: int = 1,
) -> xr.Dataset:
    """Make up a run of particles that slow down from 1.05 m/s to 4 mm/s.

    `sigma` and `fraction` give the scale of ε − ε_n and the mean of E_rot/E_tot (exponential) by velocity,
    `change` the probability that the next impact is on the other sphere. Below 0.15 m/s `slow_noise` replaces
    `noise`. ε_n − ε at the first impact is uniform up to `first`; `ratio` is energy after over before.
    """
    random = np.random.default_rng(seed)
    v = 1.05 * np.geomspace(1, 0.004, IMPACTS) * (1 - 0.03 * random.random(SHAPE))
    z = noise(random, SHAPE)
    if slow_noise is not None:
        z = np.where(v < 0.15, slow_noise(random, SHAPE), z)
    e = SETTINGS.normal + sigma(v) * z
    e[:, 0] = SETTINGS.normal - first * random.random(PARTICLES)
    share = np.minimum(fraction(v) * random.exponential(size=SHAPE), 0.99)
    share[:, 0] = 0
    turned = np.cumsum(random.random(SHAPE) < change(v), axis=1)
    return dataset(
        impact_velocity=v,
        restitution=e,
        rotational_fraction=share,
        energy_ratio=np.full(SHAPE, ratio),
        angle=np.pi * random.random(SHAPE),
        contact=(1 + turned % 2).astype(np.int8),
    )


def dataset(**values: NDArray[Any]) -> xr.Dataset:
    """Complete a run: the flights bring the centre of mass back to its height."""
    rebound = values["impact_velocity"] * values["restitution"]
    flight = 2 * np.maximum(rebound, 0) / SETTINGS.gravity
    values |= {"rebound_velocity": rebound, "time": np.cumsum(flight, axis=1) - flight}
    particles, impacts = rebound.shape
    per_impact = {name: (("particle", "impact"), value) for name, value in values.items()}
    return xr.Dataset(
        per_impact
        | {
            "impacts": ("particle", np.full(particles, impacts)),
            "stop_reason": ("particle", np.zeros(particles, np.int8)),
        }
    )


def changed(data: xr.Dataset, **values: NDArray[Any]) -> xr.Dataset:
    """Another run with some of its (particle, impact) variables replaced."""
    return data.assign({name: (("particle", "impact"), value) for name, value in values.items()})


def from_rest(number: int = 20_000) -> xr.Dataset:
    """First impacts of Fig. 9, drawn from the closed form."""
    exact = first_impact(SETTINGS.body(SETTINGS.first_elongation), SETTINGS.first_law)
    e = exact.rvs(size=number, random_state=np.random.default_rng(3))[:, np.newaxis]
    return dataset(impact_velocity=np.ones_like(e), restitution=e, rotational_fraction=np.zeros_like(e))


MAIN, REST = run(), from_rest()


def runs(**chosen: Any) -> Runs:
    """Runs that are all alike, but for those given."""
    pair = dict.fromkeys((SETTINGS.elongation, SETTINGS.bead_elongations[0]), MAIN)
    everything: dict[str, Any] = {
        "main": MAIN,
        "beads": {0.01: run(sigma=lambda v: 1e-3 / v), 0.02: run(sigma=lambda v: 2e-3 / v)},
        "first": REST,
        "isotropic": run(seed=2),
        "energy": dict.fromkeys(SETTINGS.energy_elongations, MAIN),
        "by_radius": dict.fromkeys(SETTINGS.radii, pair),
        "by_height": dict.fromkeys(SETTINGS.heights, pair),
        **dict.fromkeys(("lattice", "slow", "windows", "beads_counted")),  # verdicts rest on what is recorded
        "seed": 1,
        "asked": 1,
    }
    return Runs(**(everything | chosen))


def judged(key: str, **chosen: Any) -> Finding:
    """The claim called `key`, judged on these runs."""
    return CLAIMS.judge(runs(**chosen), SETTINGS, key)[0].finding


def dip(v: Array) -> Array:
    """A factor that is 1 but for one octave of the speed."""
    return np.where((v > 0.05) & (v < 0.1), 0.3, 1.0)


def where_slow(low: float, high: float) -> Function:
    """`low` at and below 0.15 m/s, `high` above."""
    return lambda v: np.where(v < 0.15, low, high)
