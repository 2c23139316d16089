"""The same bodies under all laws: statistics with standard errors, and the bound on created energy."""

from math import ceil, sqrt
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, whole
from restitution._internal.resources import progress_bar
from restitution.bodies import Dumbbell
from restitution.drop.compare import compare
from restitution.drop.energy import reported_elsewhere
from restitution.laws import ChatterjeeRuina, Coulomb, Frictionless, Law, TangentialRestitution

NORMAL, FRICTION, STICK = 0.98, 0.3, 0.0
"""ε_n of all laws, μ of those with friction, and e_t of Chatterjee and Ruina's."""
LAWS: dict[str, Law] = {
    "ε_t = 1 (the paper's)": TangentialRestitution(normal=NORMAL, tangential=1.0),
    "frictionless": Frictionless(normal=NORMAL),
    "Coulomb, Stronge": Coulomb(normal=NORMAL, friction=FRICTION, hypothesis="stronge"),
    "Coulomb, Poisson": Coulomb(normal=NORMAL, friction=FRICTION, hypothesis="poisson"),
    "Coulomb, Newton": Coulomb(normal=NORMAL, friction=FRICTION, hypothesis="newton"),
    "Chatterjee–Ruina": ChatterjeeRuina(normal=NORMAL, tangential=STICK, friction=FRICTION),
}
RADIUS = 3e-3
SPEED = 0.4
"""Impact velocity at which p(ε | v) is drawn, in m/s: the middle of a velocity bin."""
SLOWEST = 0.05
"""Shares are given for all impacts and for those from here on, in m/s, an edge of the velocity bins: a body
rattles before it rests."""
BATCHES = 16
_MEAN_IMPACTS = 1230
"""Mean number of impacts of a particle over all combinations."""
_RESTITUTION: dict[float, tuple[float, float]] = {
    0.01: (0.973, 0.987),
    0.1: (0.6, 1.35),
    0.5: (-0.8, 2.8),
    2.0: (-1.0, 3.4),
}
"""By L/R: the range of ε in which p(ε | v) is drawn."""
_SITES = 90
"""Number of bins in that range."""
ELONGATIONS = tuple(_RESTITUTION)
RUN: dict[str, Any] = {
    "impacts": 4000,
    "release_height": 0.06,
    "gravity": 9.81,
    "orientation": "uniform-angle",
    "velocity_bins": np.linspace(0.01, 2.31, 116),
}


def measure(impacts: int, seed: int, *, threads: int | None = None, progress: bool = False) -> xr.Dataset:
    """Run every law on every body.

    Each combination has so many impacts roughly and on average over all; all have the same particles. Every
    batch of them derives its seed from that given, which is in [0, 2⁶³).

    Returns
    -------
    xarray.Dataset
        Dimensions (elongation, law) and velocity (bins of 0.02 m/s), or site (bins of ε). ``density`` at
        the impact velocity of 0.4 m/s, ``deviation``, ``mean_fraction``, ``created_share`` and
        ``largest_energy_ratio`` in each velocity bin; ``total_share`` and ``total_factor`` over the impacts
        from 0.05 m/s on, ``all_share`` and ``all_factor`` over all; ``bound``, which no factor under the
        paper's law can exceed. Standard errors are called ``…_error``; they come from the scatter of 16
        independent batches of particles.
    """
    impacts = whole("impacts", impacts, BATCHES * _MEAN_IMPACTS, 2**53)
    seed = whole("seed", seed, 0, 2**63 - 1)
    particles = ceil(impacts / (_MEAN_IMPACTS * BATCHES))
    seeds = np.random.SeedSequence(seed).generate_state(BATCHES, np.uint64)
    found = []
    with (
        reported_elsewhere(),  # it is what the figure shows
        progress_bar("laws", len(ELONGATIONS) * BATCHES, "batches", show=progress) as tell,
    ):
        for k, elongation in enumerate(ELONGATIONS):
            body = Dumbbell(radius=RADIUS, separation=elongation * RADIUS)
            low, high = _RESTITUTION[elongation]
            batches = []
            for one in seeds:
                batches.append(
                    compare(
                        [body],
                        LAWS,
                        particles=particles,
                        seed=int(one),
                        threads=threads,
                        batches=1,
                        restitution_bins=np.linspace(low, high, _SITES + 1),
                        **RUN,
                    ).isel(body=0, drop=True)
                )
                if tell is not None:
                    tell(k * BATCHES + len(batches))
            found.append(_reduced(xr.concat(batches, "batch", combine_attrs="drop_conflicts"), body))
    data = xr.concat(found, "elongation", join="exact", combine_attrs="drop_conflicts")
    data = data.assign_coords(elongation=("elongation", list(ELONGATIONS), {"long_name": "L/R"}))
    return data.assign_attrs(seed=seed, particles=particles * BATCHES, speed=SPEED, slowest=SLOWEST)


def _reduced(batches: xr.Dataset, body: Dumbbell) -> xr.Dataset:
    """Pool the batches of one body, dimensions (batch, law, …); their scatter gives the errors."""
    number, mean, variance = (batches[name] for name in ("number", "mean_restitution", "variance"))
    found = xr.Dataset(attrs=batches.attrs)

    def weighted(values: xr.DataArray) -> xr.DataArray:
        return (values.fillna(0) * number).sum("batch") / number.sum("batch")

    def keep(name: str, pooled: xr.DataArray, each: xr.DataArray | None, text: str) -> None:
        found[name] = pooled.assign_attrs(long_name=text, units="1")
        if each is not None:
            error = each.std("batch", ddof=1, skipna=False) / sqrt(BATCHES)
            found[f"{name}_error"] = error.assign_attrs(long_name=f"standard error of the {text}", units="1")

    def keep_share(name: str, some: xr.DataArray, all: xr.DataArray, text: str) -> None:
        keep(name, some.sum("batch") / all.sum("batch"), some / all, f"share of {text}")

    spread = weighted(variance + (mean - weighted(mean)) ** 2)
    keep("deviation", spread**0.5, variance**0.5, "standard deviation of restitution")
    fraction = batches["mean_fraction"]
    keep("mean_fraction", weighted(fraction), fraction, "mean of E_rot/E_tot before the impact")
    happened, created = number + batches["undefined"], batches["energy_created"]
    keep_share("created_share", created, happened, "impacts that create energy")
    factor, of_all = batches["largest_energy_ratio"], batches["largest_energy_ratio_of_all"]
    text = "largest factor by which an impact multiplied the kinetic energy"
    keep("largest_energy_ratio", factor.max("batch"), None, text)
    keep("number", number.sum("batch"), None, "impacts in the velocity bin")

    row = batches.sel(velocity=SPEED, method="nearest").rename(restitution="site")
    found["restitution"] = row["site"].drop_vars("site").assign_attrs(units="1")
    row = row.drop_vars("site")
    width = float(found["restitution"][1] - found["restitution"][0])
    density = row["restitution_count"].sum("batch") / (row["number"].sum("batch") * width)
    each = row["restitution_count"] / (row["number"] * width)
    keep("density", density, each, "probability density of restitution")

    fast, where = batches["velocity"] >= SLOWEST, f"at {SLOWEST:g} m/s and above"
    all_fast, fast_created = happened.where(fast).sum("velocity"), created.where(fast).sum("velocity")
    keep_share("total_share", fast_created, all_fast, f"energy-creating impacts {where}")
    largest = factor.where(fast).max(("batch", "velocity"))
    keep("total_factor", largest, None, f"largest factor of kinetic energy in an impact {where}")
    keep("total_impacts", all_fast.sum("batch"), None, f"impacts {where}")
    impacts = batches["all_impacts"]
    keep_share("all_share", batches["energy_created_impacts"], impacts, "energy-creating impacts among all")
    keep("all_factor", of_all.max("batch"), None, "largest factor of all")
    keep("all_impacts", impacts.sum("batch"), None, "all impacts")
    keep("bound", xr.DataArray(bound(body, NORMAL, 1.0)), None, "no impact exceeds this factor")
    return found.drop_vars("restitution_edges", errors="ignore")


def coupling(body: Dumbbell, angle: FloatArray) -> FloatArray:
    """Return κ² = K_nu²/(K_nn K_uu) of two equal spheres that touch with their axis at `angle` (rad)."""
    inertia = body.transverse_inertia / body.mass
    half = body.separation / 2
    across, down = half * np.sin(angle), half * np.abs(np.cos(angle)) + body.radii[0]
    found: FloatArray = (across * down) ** 2 / ((inertia + across**2) * (inertia + down**2))
    return found


def growth(coupling: FloatArray, normal: float, tangential: float) -> FloatArray:
    """Return the largest factor by which Eq. 9 can multiply the energy that the contact can reach.

    It is the larger eigenvalue of K D K⁻¹ D, D = diag(-ε_n, ε_t), whose trace is
    (ε_n² + ε_t² + 2κ²ε_nε_t)/(1 - κ²) and whose determinant is ε_n²ε_t². See docs/energy.md.
    """
    half = (normal**2 + tangential**2 + 2 * coupling * normal * tangential) / (2 * (1 - coupling))
    found: FloatArray = half + np.sqrt(np.maximum(half**2 - (normal * tangential) ** 2, 0.0))
    return found


def bound(body: Dumbbell, normal: float, tangential: float) -> float:
    """Return the largest `growth` over all angles, to a part in 10⁷, and 1 where energy never grows."""
    return max(
        1.0, float(growth(coupling(body, np.linspace(0, np.pi / 2, 20_001)), normal, tangential).max())
    )
