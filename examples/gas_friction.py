"""Gases of grains with Coulomb friction, beside rough spheres with a constant β.

    python examples/gas_friction.py

Prints T_rot/T_tr of spheres after half of the collisions and after all, and how fast T_tr falls with the
collisions of a particle in between; where the ratio stays, also the constant β of rough spheres (ε, β) with
the same ratio, and how fast these cool (Huthmann and Zippelius 1997). Of dumbbells it prints the ratio across
their axis at the end, and about it after half and after all.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

import restitution as rs

Floats = npt.NDArray[np.float64]
NORMALS, FRICTIONS = (0.9, 0.7), (0.1, 0.2, 0.3, 0.5, 1.0)
SPHERE = rs.Dumbbell(radius=3e-3, separation=0.0)
DUMBBELL = rs.Dumbbell(radius=3e-3, separation=3e-3)
WARM, COLLISIONS = 1e-9, 100
SAME = 0.1
"""Largest change of the logarithm of the ratio that counts as none."""


def table(particles: int, collisions: float = COLLISIONS) -> str:
    """Follow the gases and write a row for each law."""
    lines = [
        "| $\\varepsilon_n$ | $\\mu$ | spheres, $T_\\mathrm{rot}/T_\\mathrm{tr}$ | rate | $\\beta$ "
        "| its rate | dumbbells, across | about their axis | rate |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for normal in NORMALS:
        for friction in FRICTIONS:
            law = rs.Coulomb(normal=normal, friction=friction)
            spheres, dumbbells = (cooled(body, law, particles, collisions) for body in (SPHERE, DUMBBELL))
            half, end = (float(np.mean(ratio)) for ratio in spheres.ratios)
            steady = abs(np.log(end / half)) < SAME
            cells = [f"{normal:g}", f"{friction:g}", f"{half:.3g}, {end:.3g}", f"{spheres.rate:.4f}"]
            cells += rough(normal, np.sqrt(half * end)) if steady else ["none", ""]
            half, end = (float(ratio[2]) for ratio in dumbbells.ratios)
            across = float(np.mean(dumbbells.ratios[1][:2]))
            cells += [f"{across:.3g}", f"{half:.3g}, {end:.3g}", f"{dumbbells.rate:.4f}"]
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


class Cooled(NamedTuple):
    """What is seen of a gas."""

    ratios: tuple[Floats, Floats]
    """T_rot/T_tr of each principal axis, at half of the collisions and at the end."""
    rate: float
    """-d ln T_tr/d(collisions) between."""


def cooled(body: rs.Dumbbell, law: rs.Coulomb, particles: int, collisions: float) -> Cooled:
    """Follow a gas."""
    data = rs.gas.cool(
        body,
        law,
        particles=particles,
        collisions=collisions,
        translational_temperature=WARM,
        batches=2,
        samples=40,
    )
    ratios = (data["axis_temperature"] / data["translational_temperature"]).transpose("time", "axis")
    middle = len(data["time"]) // 2
    late = data.isel(time=slice(middle, None))
    slope = np.polyfit(late["collisions"], np.log(late["translational_temperature"]), 1)[0]
    return Cooled((ratios[middle].to_numpy(), ratios[-1].to_numpy()), float(-slope))


def rough(normal: float, ratio: float) -> list[str]:
    """Write the β of rough spheres with this steady ratio, between sticking and sliding, and their rate."""

    def law(beta: float) -> rs.TangentialRestitution:
        return rs.TangentialRestitution(normal=normal, tangential=-beta)

    def beyond(beta: float) -> float:
        return rs.gas.theory.steady_ratio(SPHERE, law(beta)) - ratio

    try:
        beta = brentq(beyond, -0.5, 0.1)
    except ValueError:
        return ["none", ""]
    warm: dict[str, Any] = {"translational_temperature": WARM, "rotational_temperature": ratio * WARM}
    found = rs.gas.theory.rates(SPHERE, law(beta), **warm)
    return [f"{beta:.2f}", f"{-found.translational / found.contacts / (1.5 * WARM):.4f}"]


if __name__ == "__main__":
    print(table(20_000))
