"""Encounters of smooth dumbbells beside what kinetic theory assumes of them, and beside a body on a plane.

    python examples/pairs.py [pairs.png]

Prints, over T_rot/T_tr, the contacts of a particle and the energy that its rotation gains, of encounters that
are followed and by the closure that takes every contact as that of two strangers; and mean and standard
deviation of ε over the speed of a pair, and of one body on a plane. Units are the radius and the mass of a
body, and T_tr.
"""

import sys
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

Floats = npt.NDArray[np.float64]
RATIOS = np.array([0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0])
SHAPES, LONG, ROUND = (0.1, 0.3, 1.0, 2.0), (0.3, 1.0, 2.0), (0.1, 1.0)
"""L/R of all, of the rates, and of ε over speed."""
SPEEDS = np.array([0.25, 0.5, 1.0, 1.5, 2.0, 3.0])
"""Edges of v in thermal speeds of the relative motion, √(2T/m) of a pair and √(T/m) of one body."""


class Rates(NamedTuple):
    """Of a shape, over RATIOS."""

    contacts: Floats
    """Over those of the closure."""
    followed: Floats
    error: Floats
    closure: Floats
    """Rotational energy that a particle gains in a unit of time at unit density."""


class Restitution(NamedTuple):
    """Of a shape, over bins of SPEEDS."""

    mean: Floats
    deviation: Floats


class Found(NamedTuple):
    """What is drawn."""

    rates: dict[float, Rates]
    still: Floats
    """Exchange of the longest ones where none spins about its axis, over RATIOS."""
    restitution: dict[tuple[float, str], Restitution]
    """By L/R and "pair" or "plane"."""


def body(elongation: float) -> rs.Dumbbell:
    """Make a dumbbell of balls of radius 1, of mass 1."""
    one = rs.Dumbbell(radius=1.0, separation=elongation)
    return rs.Dumbbell(radius=1.0, separation=elongation, density=one.density / one.mass)


def measure(encounters: int) -> Found:
    """Follow encounters."""
    rates = {elongation: exchange(elongation, encounters) for elongation in LONG}
    found = {}
    law = rs.Frictionless(normal=0.9)
    for elongation in ROUND:
        one = body(elongation)
        for name, other, unit in (("pair", one, np.sqrt(2.0)), ("plane", rs.Plane(), 1.0)):
            kernel = rs.PairKernel.learn(
                one,
                other,
                law,
                translational_temperature=1.0,
                temperature_ratios=[1.0],
                encounters=encounters,
            )
            speed = kernel.data["centre_speed"].to_numpy() / unit
            epsilon = kernel.data["restitution_centres"].to_numpy()
            at = [epsilon[(speed >= low) & (speed < high)] for low, high in pairwise(SPEEDS)]
            means, deviations = np.array([(part.mean(), part.std()) for part in at]).T
            found[elongation, name] = Restitution(means, deviations)
    return Found(rates, np.array([still(LONG[-1], encounters, ratio) for ratio in RATIOS]), found)


def exchange(elongation: float, encounters: int) -> Rates:
    """Follow elastic encounters over RATIOS, with the closure beside them."""
    one, law = body(elongation), rs.Frictionless(normal=1.0)
    data = rs.pair.rates(one, law, temperature_ratios=RATIOS, encounters=encounters)
    theory = [
        rs.gas.theory.rates(one, law, translational_temperature=1.0, rotational_temperature=ratio)
        for ratio in RATIOS
    ]
    return Rates(
        data["contact_rate"].to_numpy() / [at.contacts for at in theory],
        data["rotational_exchange"].to_numpy(),
        data["rotational_exchange_error"].to_numpy(),
        np.array([at.rotational for at in theory]),
    )


def still(elongation: float, encounters: int, ratio: float) -> float:
    """Return the exchange of pairs whose spin about the axis is taken away; those of DynamO have none."""
    one, law = body(elongation), rs.Frictionless(normal=1.0)
    warm = {"translational_temperature": 1.0, "rotational_temperature": ratio}
    drawn = rs.pair.encounters(one, one, law, encounters=encounters, record="state", **warm)
    names = ("position", "velocity", "angular_velocity", "attitude")
    states = xr.Dataset({name: drawn[f"{name}_before"] for name in names})
    quaternions, spin = states["attitude"].to_numpy(), states["angular_velocity"].to_numpy()
    turn = Rotation.from_quat(quaternions.reshape(-1, 4), scalar_first=True)
    axis = turn.apply([0.0, 0.0, 1.0]).reshape(spin.shape)
    across = spin - axis * np.sum(axis * spin, axis=-1, keepdims=True)
    states["angular_velocity"] = (states["angular_velocity"].dims, across)
    data = rs.pair.encounters(one, one, law, states=states)
    gained = (data["rotational_energy_after"] - data["rotational_energy_before"]).mean()
    return float(drawn.attrs["attempt_rate"] * gained)


def table(found: Found) -> str:
    """Write the exchange over T_rot/T_tr, and ε over the speed."""
    head = " | ".join(f"$L/R = {x:g}$, followed | closure | contacts" for x in LONG)
    head += " | no spin about the axis"
    lines = [
        f"| $T_\\mathrm{{rot}}/T_\\mathrm{{tr}}$ | {head} |",
        "|---|" + "---|---|---|" * len(LONG) + "---|",
    ]
    for k, ratio in enumerate(RATIOS):
        cells = [f"{ratio:g}"]
        for rates in found.rates.values():
            cells.append(f"{rates.followed[k]:.2f} ± {rates.error[k]:.2f}")
            cells += [f"{rates.closure[k]:.2f}", f"{rates.contacts[k]:.3f}"]
        cells.append(f"{found.still[k]:.2f}")
        lines.append("| " + " | ".join(cells) + " |")
    head = " | ".join(f"$L/R = {x:g}$, {name}" for x, name in found.restitution)
    lines += ["", f"| $v$ | {head} |", "|---|" + "---|" * len(found.restitution)]
    for k, (low, high) in enumerate(pairwise(SPEEDS)):
        cells = [f"{one.mean[k]:.3f}, {one.deviation[k]:.3f}" for one in found.restitution.values()]
        lines.append(f"| {low:g} to {high:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


@fg.styled
def draw(found: Found, *, style: Style | None = None) -> Figure:
    """Draw contacts and exchange over T_rot/T_tr, and mean and deviation of ε over the speed."""
    figure, [[contacts, gained, epsilon]] = fg.panels(fg.PAGE, 2.8, 1, 3)
    looks = {one: {"color": colors()[k], "marker": fg.MARKERS[k]} for k, one in enumerate(SHAPES)}
    for elongation, rates in found.rates.items():
        look = looks[elongation] | {"linestyle": "none"}
        contacts.plot(RATIOS, rates.contacts, **look | {"linestyle": "-"})
        gained.plot(RATIOS, rates.closure, color=look["color"])
        gained.errorbar(RATIOS, rates.followed, rates.error, **look)
    gained.plot(
        RATIOS, found.still, **looks[LONG[-1]] | {"linestyle": "none", "fillstyle": "none", "markersize": 9}
    )
    contacts.axhline(1.0, color="0.6", linestyle=":", zorder=0)
    contacts.set(xlabel=r"$T_\mathrm{rot}/T_\mathrm{tr}$", ylabel="contacts, of the closure 1")
    gained.set(xlabel=r"$T_\mathrm{rot}/T_\mathrm{tr}$", ylabel=r"$\dot E_\mathrm{rot}$")
    middle = 0.5 * (SPEEDS[1:] + SPEEDS[:-1])
    for (elongation, name), one in found.restitution.items():
        how = {"linestyle": "-"} if name == "pair" else {"linestyle": "--", "fillstyle": "none"}
        for values in (one.mean, one.deviation):
            epsilon.plot(middle, values, **looks[elongation], **how)
    epsilon.set(xlabel="$v$ in thermal speeds", ylabel=r"$\langle\varepsilon\rangle$, $\sigma_\varepsilon$")
    for axes, name in ((contacts, "a"), (gained, "b"), (epsilon, "c")):
        fg.letter(axes, f"({name})", left=False)
    marks = [contacts.plot([], [], **look, label=f"$L/R = {one:g}$")[0] for one, look in looks.items()]
    figure.legend(handles=marks, loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    measured, path = measure(200_000), Path(sys.argv[1] if len(sys.argv) > 1 else "pairs.png")
    print(table(measured))
    for face in SITE:
        draw(measured, style=face).savefig(path.with_stem(path.stem + face[4:]), dpi=200)
