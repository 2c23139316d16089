"""The gases behind the figures and claims."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

import restitution as rs
from restitution.bodies import AnyBody
from restitution.drop.dataset import version_here
from restitution.laws import Law
from restitution.papers import runs
from restitution.papers.gases import _spheres as spheres
from restitution.papers.gases._settings import Settings
from restitution.papers.runs import Runner, derived_seed

Key = tuple[float, float]
_FRICTION = ("spheres", "dumbbells")


@dataclass(frozen=True, eq=False)
class Runs(runs.Runs):
    """All gases; those of spheres have the variables of `restitution.gas.cool` that a figure shows."""

    grains: Mapping[Key, xr.Dataset]  # smooth dumbbells, by ε_n and L/R
    cold: xr.Dataset  # the least elongated of them, from T_rot = 0
    steady: Mapping[Key, xr.Dataset]  # from the steady ratio of the closure, by ε_n and L/R
    rules: Mapping[Key, Mapping[str, xr.Dataset]]  # spheres by ε_n and L/R, and the rule for ε
    friction: Mapping[str, Mapping[Key, xr.Dataset]]  # by ε_n and μ
    rough: Mapping[float, xr.Dataset]  # spheres by β
    lossy: xr.Dataset  # spheres of another ε_n and μ = 0.5
    rods: Mapping[Key, xr.Dataset]  # smooth, by length over diameter and ε_n
    long: xr.Dataset  # with friction


def number(s: Settings) -> int:
    """Return the number of gases."""
    gases = len(s.normals) * len(s.elongations)
    friction = len(_FRICTION) * len(s.normals) * len(s.frictions)
    steady = len(s.coefficients) * (len(s.elongations) - 1)
    rods = len(s.rods) * len(s.rod_normals)
    return 3 * gases + 2 * len(_shown(s)) + steady + friction + len(s.roughness) + rods + 3


def _shown(s: Settings) -> tuple[float, ...]:
    """Give L/R of the gases, at the first ε_n, for which rules of v in m/s are followed too."""
    return (s.elongations[0], s.elongations[2])


def simulate(s: Settings, particles: int, runner: Runner) -> Runs:
    """Follow every gas, of so many particles; of rods a quarter of them, of spheres by the rules half."""

    def cool(name: str, body: AnyBody, law: Law, collisions: float, **other: Any) -> xr.Dataset:
        usual: dict[str, Any] = {
            "particles": particles,
            "translational_temperature": s.temperature,
            "number_density": s.number_density,
            "samples": 60,
        }
        seed = derived_seed(runner.seed, name)
        course = {"collisions": s.share * collisions, "seed": seed, "threads": runner.threads}
        data = rs.gas.cool(body, law, **(usual | course | other))
        runner.done()
        return data.assign_attrs(run=name)

    def followed(normal: float, elongation: float, collisions: float) -> dict[str, xr.Dataset]:
        body, law = s.dumbbell(elongation), rs.Frictionless(normal=normal)
        pair = spheres.met(body, law, 6 * particles, s.theta)
        rules = spheres.scaled(body, law, pair, 3 * particles, s.theta)
        if normal == s.normals[0] and elongation in _shown(s):
            # p(ε | v) needs a thousand particles.
            rules = spheres.dropped(body, law, pair, max(particles // 2, 1000), s.drop) | rules
        found = {}
        few, warm = max(particles // 2, 40), s.temperature / s.theta
        for rule, outcome in rules.items():
            name = f"spheres, {rule}, ε_n {normal:g}, L/R {elongation:g}"
            seed = derived_seed(runner.seed, name)
            gas = spheres.cool(outcome, s.theta, s.share * collisions, seed, few)
            columns = {
                "collisions": gas.collisions,
                "translational_temperature": warm * gas.theta,
                "rotational_temperature": warm * gas.rotation,
                "a20": gas.a2,
            }
            data = xr.Dataset({key: ("time", column) for key, column in columns.items()})
            told = {"body": f"sphere that draws ε of {body}", "law": str(law), "version": version_here()}
            found[rule] = data.assign_attrs(run=name, seed=seed, particles=few, **told)
            runner.done()
        return found

    lengths = dict(zip(s.elongations, s.collisions, strict=True))
    keys = [(normal, elongation) for normal in s.normals for elongation in lengths]
    grains = {
        (e, x): cool(f"dumbbells, ε_n {e:g}, L/R {x:g}", s.dumbbell(x), rs.Frictionless(normal=e), lengths[x])
        for e, x in keys
    }
    rounded, law = s.dumbbell(s.elongations[0]), rs.Frictionless(normal=s.normals[0])
    cold = cool("from T_rot = 0", rounded, law, s.collisions[0], rotational_temperature=0.0)
    steady = {}
    for e in s.coefficients:
        for x in s.elongations[1:]:
            body, law = s.dumbbell(x), rs.Frictionless(normal=e)
            warm = {"rotational_temperature": s.temperature * rs.gas.theory.steady_ratio(body, law)}
            steady[e, x] = cool(f"steady, ε_n {e:g}, L/R {x:g}", body, law, s.steady_collisions, **warm)
    bodies = dict(zip(_FRICTION, (s.dumbbell(0.0), s.dumbbell(1.0)), strict=True))
    friction = {
        name: {
            (e, mu): cool(
                f"{name}, ε_n {e:g}, μ {mu:g}",
                body,
                rs.Coulomb(normal=e, friction=mu),
                s.friction_collisions,
                samples=40,
            )
            for e in s.normals
            for mu in s.frictions
        }
        for name, body in bodies.items()
    }

    def rod(name: str, aspect: float, law: Law) -> xr.Dataset:
        few = max(particles // 4, 40)
        return cool(name, s.rod(aspect), law, 2.0 / 3.0 * s.other_collisions, particles=few)

    return Runs(
        seed=runner.seed,
        asked=particles,
        grains=grains,
        cold=cold,
        steady=steady,
        rules={(e, x): followed(e, x, lengths[x]) for e, x in keys},
        friction=friction,
        rough={
            beta: cool(
                f"rough spheres, β {beta:g}",
                bodies["spheres"],
                rs.TangentialRestitution(normal=s.rough_normal, tangential=-beta),
                s.other_collisions,
            )
            for beta in s.roughness
        },
        lossy=cool(
            "spheres, another ε_n",
            bodies["spheres"],
            rs.Coulomb(normal=s.lossy, friction=0.5),
            s.other_collisions,
        ),
        rods={
            (aspect, e): rod(f"rods, {aspect:g} diameters, ε_n {e:g}", aspect, rs.Frictionless(normal=e))
            for aspect in s.rods
            for e in s.rod_normals
        },
        long=rod(
            "rods with friction", s.rods[-1], rs.Coulomb(normal=s.long_normal, friction=s.long_friction)
        ),
    )


def half(data: xr.Dataset) -> xr.Dataset:
    """Return the second half of the looks at a gas."""
    return data.isel(time=slice(len(data["time"]) // 2, None))


def fall(data: xr.Dataset) -> float:
    """Return -d ln T_tr/d(collisions of a particle) in the second half."""
    late = half(data)
    return -float(np.polyfit(late["collisions"], np.log(late["translational_temperature"]), 1)[0])


def ratio(data: xr.Dataset) -> tuple[float, float]:
    """Return T_rot/T_tr in the second half with its standard error.

    Looks at the same gas are not independent, so that the error is that of one look.
    """
    return _quotient(half(data), "rotational_temperature")


def across(data: xr.Dataset) -> tuple[float, float]:
    """Return the same of the rotation about the first principal axis."""
    return _quotient(half(data).isel(axis=0), "axis_temperature")


def _quotient(data: xr.Dataset, of: str) -> tuple[float, float]:
    by = "translational_temperature"
    values = data[of] / data[by]
    error = values * np.hypot(data[f"{of}_error"] / data[of], data[f"{by}_error"] / data[by])
    return float(values.mean()), float(error.mean())


def late(data: xr.Dataset, name: str) -> tuple[float, float]:
    """Return the mean of a variable in the second half, with the standard error of one look."""
    second = half(data)
    return float(second[name].mean()), float(second[f"{name}_error"].mean())


def beta(s: Settings, normal: float, wanted: float) -> tuple[float, float] | None:
    """Return the β of rough spheres with this steady ratio, between sticking and sliding, and their fall."""
    from scipy.optimize import brentq

    sphere = s.dumbbell(0.0)

    def law(value: float) -> rs.TangentialRestitution:
        return rs.TangentialRestitution(normal=normal, tangential=-value)

    def beyond(value: float) -> float:
        return rs.gas.theory.steady_ratio(sphere, law(value)) - wanted

    if beyond(-0.5) * beyond(0.1) > 0.0:
        return None
    found = float(brentq(beyond, -0.5, 0.1))
    warm = {"translational_temperature": 1.0, "rotational_temperature": wanted}
    rates = rs.gas.theory.rates(sphere, law(found), **warm)
    return found, -rates.translational / rates.contacts / 1.5
