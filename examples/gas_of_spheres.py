"""A gas of spheres with the ε of dumbbells, beside the gas of the dumbbells themselves.

    python examples/gas_of_spheres.py [gas_of_spheres.png]

Direct simulation Monte Carlo of a uniform, force-free gas of hard spheres of mass 1. Two of them meet along
the unit vector k, with u their relative velocity and v = -u·k > 0; positions do not appear. Four rules say
what follows:

* "plane": u' = u + (1 + ε)v k with ε from p(ε | v) of one body that bounces on a plane, as the paper has it,
* "pair": the same with ε of the centres in encounters of two bodies, T_rot = T_tr = T_0,
* "scaled": the same, where v is measured in thermal speeds of the gas at that time,
* "kernel": u' and the change of E_rot from one encounter, at the T_rot/T_tr that the gas has.

Prints T_tr over the collisions of a particle and how fast it falls at the end, beside `restitution.gas.cool`,
and draws them. Time is counted in 1/ν0, ν0 = 4√π nσ²√θ0 being the initial frequency of collisions of a
particle of spheres, and θ = <v²>/3 in m²/s².
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

Floats = npt.NDArray[np.float64]


class Outcome(NamedTuple):
    """Result of collisions."""

    change: Floats
    """Of the relative velocity, shape (..., 3)."""
    turning: Floats | float
    """Energy over mass that rotation gains, of both particles."""


Rule = Callable[[Floats, Floats, float, float, np.random.Generator], Outcome]
"""Outcome of collisions from u, k, θ of translation and of rotation, and random numbers."""

STEP = 0.02
"""Mean number of collisions of a particle in a step."""
FASTEST = 10.0
"""No pair is faster than this times √θ along k: seven standard deviations in a Gaussian gas."""
AXES = 2
"""About which contacts turn a dumbbell."""


class Gas(NamedTuple):
    """Course of a gas, once in a collision of each particle."""

    time: Floats
    collisions: Floats
    """Of a particle."""
    theta: Floats
    rotation: Floats
    """T_rot/m."""
    a2: Floats
    """Second Sonine coefficient."""


def cool(rule: Rule, theta: float, collisions: float, seed: int, particles: int = 10_000) -> Gas:
    """Cool one gas from T_rot = T_tr, until a particle has had so many collisions."""
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(particles, 3))
    u -= u.mean(axis=0)
    u *= np.sqrt(theta / np.mean(u**2))
    time, met, now, turning, step, found = 0.0, 0.0, theta, theta, 0, []
    # The rate of a pair is proportional to |u·k|, whose mean is 2√(θ/π) in a Gaussian gas.
    candidates = 0.5 * particles * STEP * FASTEST * np.sqrt(np.pi) / 2
    while not found or found[-1][1] < collisions:
        if step % round(1 / STEP) == 0:
            square = np.sum(u**2, axis=1)
            now = float(np.mean(square)) / 3.0  # of which sums of changes lose the digits as it falls
            a2 = 0.6 * np.mean(square**2) / np.mean(square) ** 2 - 1.0
            found.append((time, met, now, turning, a2))
        one, two = rng.choice(particles, (2, int(candidates + rng.random())), replace=False)
        k = rng.normal(size=(one.size, 3))
        k /= np.linalg.norm(k, axis=1)[:, np.newaxis]
        relative = u[one] - u[two]
        v = -np.sum(relative * k, axis=1)
        hit = FASTEST * np.sqrt(now) * rng.random(v.size) < np.abs(v)
        one, two, relative = one[hit], two[hit], relative[hit]
        k = k[hit] * np.sign(v[hit])[:, np.newaxis]
        outcome = rule(relative, k, now, turning, rng)
        before = now
        now += float(np.sum((relative + outcome.change) ** 2) - np.sum(relative**2)) / (6.0 * particles)
        turning += 2.0 * float(np.sum(outcome.turning)) / (AXES * particles)
        u[one] += 0.5 * outcome.change
        u[two] -= 0.5 * outcome.change
        time += STEP * 0.5 * np.sqrt(theta) * (before**-0.5 + now**-0.5)
        met += 2.0 * one.size / particles
        step += 1
    return Gas(*np.array(found).T)


def along(epsilon: Callable[[Floats, float, np.random.Generator], Floats | float]) -> Rule:
    """Make the rule of smooth spheres from ε of v and θ."""

    def rule(u: Floats, k: Floats, theta: float, _: float, rng: np.random.Generator) -> Outcome:
        v = -np.sum(u * k, axis=1)
        return Outcome(((1.0 + epsilon(v, theta, rng)) * v)[:, np.newaxis] * k, 0.0)

    return rule


THETA = 0.5
"""θ of translation at the beginning, in m²/s²."""
RADIUS, DROP = 3e-3, 1.0
"""Of the balls of a dumbbell, and the height from which it falls on the plane, in m."""
RATIOS = np.geomspace(0.4, 100.0, 24)
"""T_rot/T_tr of the encounters; one between two of them is drawn from either."""
COLLISIONS = {0.1: 300, 0.3: 150, 1.0: 60, 2.0: 60}
"""Of a particle at the end, by L/R."""
NORMALS = 0.9, 0.7
SHOWN = 0.1, 1.0
"""L/R of the gases whose temperatures are drawn, at the first of the NORMALS."""


Restitution = Callable[[Floats, np.random.Generator], Floats]
"""ε of pairs at speeds v in m/s, drawn."""


def dropped(body: rs.Dumbbell, law: rs.Frictionless, pair: Restitution, particles: int) -> dict[str, Rule]:
    """Make the rules of v in m/s; learn p(ε | v) of a body on a plane."""
    # Spread, so that no first impact stands out.
    heights = RADIUS + DROP * np.geomspace(law.normal**2, 1.0, min(particles // 2, 100))
    plane = rs.FluctuatingRestitution.learn(
        body, law, particles=particles, impacts=300, release_height=heights, velocities=(0.05, 4.0)
    ).clamped()
    return {
        "plane": along(lambda v, _, rng: plane.rvs(v, random_state=rng, threads=1)),
        "pair": along(lambda v, _, rng: pair(v, rng)),
    }


def met(body: rs.Dumbbell, law: rs.Frictionless, encounters: int) -> Restitution:
    """Learn to draw ε, of the centres along their line, from encounters at T_rot = T_tr = T_0."""
    data = rs.PairKernel.learn(body, body, law, temperature_ratios=[1.0], **warm(body, encounters)).data
    data = data.sortby("centre_speed")
    speeds, epsilon = data["centre_speed"].to_numpy(), data["restitution_centres"].to_numpy()

    def draw(v: Floats, rng: np.random.Generator) -> Floats:
        """Take one of the fifty encounters that had nearly the same speed."""
        place = np.searchsorted(speeds, v) + rng.integers(-25, 25, v.shape)
        return np.asarray(epsilon[place.clip(0, speeds.size - 1)])

    return draw


def warm(body: rs.Dumbbell, encounters: int) -> dict[str, Any]:
    """Give the temperature of the encounters to learn from, and their number."""
    return {"translational_temperature": body.mass * THETA, "encounters": encounters}


def scaled(body: rs.Dumbbell, law: rs.Frictionless, pair: Restitution, encounters: int) -> dict[str, Rule]:
    """Make the rules that know the temperatures of the gas; learn encounters at any of them."""
    kernel = rs.PairKernel.learn(body, body, law, temperature_ratios=RATIOS, **warm(body, encounters))

    def whole(u: Floats, k: Floats, theta: float, rotation: float, rng: np.random.Generator) -> Outcome:
        place = np.interp(np.log(rotation / theta), np.log(RATIOS), np.arange(len(RATIOS)))
        ratio = RATIOS[np.floor(place + rng.random(len(u))).astype(int).clip(max=len(RATIOS) - 1)]
        unit = np.sqrt(theta / THETA)
        after = kernel.rvs(u / unit, k, ratio, random_state=rng)
        return Outcome(after.velocity * unit - u, after.rotational_change.sum(axis=1) * unit**2 / body.mass)

    return {
        "scaled": along(lambda v, theta, rng: pair(v * np.sqrt(THETA / theta), rng)),
        "kernel": whole,
    }


Key = tuple[float, float]
"""ε_n and L/R."""


def measure(particles: int, share: float = 1.0) -> dict[Key, dict[str, Gas]]:
    """Cool all gases, for this share of the collisions."""
    return {
        (normal, elongation): gases(normal, elongation, particles, share * collisions)
        for normal in NORMALS
        for elongation, collisions in COLLISIONS.items()
    }


def gases(normal: float, elongation: float, particles: int, collisions: float) -> dict[str, Gas]:
    """Cool the grains themselves, and spheres by the rules."""
    law = rs.Frictionless(normal=normal)
    body = rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)
    course = {"particles": 2 * particles, "collisions": collisions}
    data = rs.gas.cool(body, law, translational_temperature=body.mass * THETA, **course)
    turning, translational = (data[f"{of}_temperature"] / body.mass for of in ("rotational", "translational"))
    columns = data["time"], data["collisions"], translational, turning, data["a20"]
    pair = met(body, law, 6 * particles)
    learned = scaled(body, law, pair, 6 * particles)
    if normal == NORMALS[0] and elongation in SHOWN:
        learned = dropped(body, law, pair, max(particles, 1000)) | learned  # p(ε | v) needs a thousand
    cooled = {name: cool(rule, THETA, collisions, 1, particles) for name, rule in learned.items()}
    return {"exact": Gas(*(column.to_numpy() for column in columns))} | cooled


def rate(normal: float, gas: Gas) -> float:
    """Return -d ln θ/d(collisions) in the second half, over that of smooth spheres."""
    half = slice(len(gas.theta) // 2, None)
    slope = np.polyfit(gas.collisions[half], np.log(gas.theta[half]), 1)[0]
    return float(-slope / ((1.0 - normal**2) / 3.0))


def table(found: dict[Key, dict[str, Gas]]) -> str:
    """Write rates and Sonine coefficients in the second half, and where rules of v alone end."""
    names = ("exact", "kernel", "scaled")
    lines = [
        "| $\\varepsilon_n$ | $L/R$ | rate, grains | with $E_\\mathrm{rot}$ "
        "| of $v/\\sqrt{T_\\mathrm{tr}}$ | $a_2$, grains | with $E_\\mathrm{rot}$ "
        "| of $v/\\sqrt{T_\\mathrm{tr}}$ | $T_\\mathrm{tr}/T_0$ at the end, pair | plane |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for (normal, elongation), cooled in found.items():
        cells = [f"{normal:g}", f"{elongation:g}"]
        cells += [f"{rate(normal, cooled[name]):.3f}" for name in names]
        cells += [f"{cooled[name].a2[len(cooled[name].a2) // 2 :].mean():.3f}" for name in names]
        for name in ("pair", "plane"):
            cells.append(f"{cooled[name].theta[-1] / THETA:.3f}" if name in cooled else "")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


@fg.styled
def draw(found: dict[Key, dict[str, Gas]], *, style: Style | None = None) -> Figure:
    """Draw the temperatures of two bodies, and the rates at the end over L/R."""
    figure, [axes] = fg.panels(fg.PAGE, 2.8, 1, 3)
    labels = {
        "plane": r"spheres, $p(\varepsilon\,|\,v)$ of a plane",
        "pair": r"of a pair",
        "scaled": r"$p(\varepsilon\,|\,v/\sqrt{T_\mathrm{tr}})$",
        "kernel": r"with $E_\mathrm{rot}$, at $T_\mathrm{rot}/T_\mathrm{tr}$",
    }
    look = {
        name: {"color": colors()[k], "marker": fg.MARKERS[k], "linestyle": "none", "label": label}
        for k, (name, label) in enumerate(labels.items())
    }
    line = {"color": "0.5", "label": "the grains themselves"}
    for elongation, panel in zip(SHOWN, axes[:2], strict=True):
        for name, gas in found[NORMALS[0], elongation].items():
            every = max(len(gas.theta) // 15, 1)
            options = line if name == "exact" else look[name] | {"markevery": every, "fillstyle": "none"}
            panel.plot(gas.collisions, gas.theta / THETA, **options)
        panel.set(yscale="log", xlabel="collisions of a particle", ylabel=r"$T_\mathrm{tr}/T_0$")
        panel.set_title(f"$L/R = {elongation:g}$")
        panel.set_ylim(3e-3, 1.5)
    for normal in NORMALS:
        at = list(COLLISIONS)
        fill = "full" if normal == NORMALS[0] else "none"
        for name in ("exact", "scaled", "kernel"):
            values = [rate(normal, found[normal, elongation][name]) for elongation in at]
            options = line if name == "exact" else look[name] | {"fillstyle": fill}
            axes[2].plot(at, values, **options)
    axes[2].set(
        xscale="log",
        yscale="log",
        xlabel="$L/R$",
        ylabel="rate of cooling, of spheres 1",
    )
    for panel, name in zip(axes, "abc", strict=True):
        fg.letter(panel, f"({name})", left=False)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    return figure


if __name__ == "__main__":
    measured, path = measure(10_000), Path(sys.argv[1] if len(sys.argv) > 1 else "gas_of_spheres.png")
    print(table(measured))
    for face in SITE:
        draw(measured, style=face).savefig(path.with_stem(path.stem + face[4:]), dpi=200)
