"""A gas of smooth dumbbells cools, every encounter followed, beside spheres and kinetic theory.

    python examples/gas.py [gas.png]

All gases begin with T_rot = T_tr. Prints, for each L/R, the ratio of the temperatures in the second half, by
the gas and by the closure for Maxwellians (`restitution.gas.theory`), and how fast T_tr then falls with the
collisions of a particle, beside (1 - ε²)/3 of smooth spheres.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

LAW = rs.Frictionless(normal=0.9)
SPHERES = (1 - 0.9**2) / 3
"""-d ln T/d(collisions) of smooth spheres."""
RADIUS, WARM = 3e-3, 1e-9
GAS = {"translational_temperature": WARM, "number_density": 1e6}
COLLISIONS = {0.1: 300, 0.3: 150, 1.0: 100, 2.0: 100}
"""Of a particle at the end, by L/R."""


def main(path: Path) -> None:
    """Follow the gases, print a table, and draw both temperatures."""
    gases = measure(20_000)
    print(table(gases))
    for style in SITE:
        draw(gases, style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)


def body(elongation: float) -> rs.Dumbbell:
    """Make the particle of a gas."""
    return rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)


def measure(particles: int, share: float = 1.0) -> dict[float, xr.Dataset]:
    """Cool gases of dumbbells, by L/R, for this share of the collisions."""
    more = {"particles": particles, "samples": 100}
    return {
        elongation: rs.gas.cool(body(elongation), LAW, collisions=share * collisions, **GAS, **more)
        for elongation, collisions in COLLISIONS.items()
    }


def table(gases: dict[float, xr.Dataset]) -> str:
    """Write a row for each L/R, of the second half of each gas."""
    lines = [
        "| $L/R$ | $T_\\mathrm{rot}/T_\\mathrm{tr}$ | closure "
        "| $-d\\ln T_\\mathrm{tr}/d(\\text{collisions})$ "
        "| over that of spheres | contacts a collision | collapses |",
        "|---|---|---|---|---|---|---|",
    ]
    for elongation, data in gases.items():
        late = data.isel(time=slice(len(data.time) // 2, None))
        ratio = late["rotational_temperature"] / late["translational_temperature"]
        error = float(ratio.std() / np.sqrt(len(ratio)))
        fall = -np.polyfit(late["collisions"], np.log(late["translational_temperature"]), 1)[0]
        each = float(data["contacts"][-1] / data["collisions"][-1])
        steady = rs.gas.theory.steady_ratio(body(elongation), LAW)
        lines.append(
            f"| {elongation:g} | {float(ratio.mean()):.3f} ± {error:.3f} | {steady:.3f} | {fall:.4f} "
            f"| {fall / SPHERES:.2f} | {each:.3f} | {data.attrs['collapse_share']:.0e} |"
        )
    return "\n".join(lines)


def closure(elongation: float, data: xr.Dataset) -> xr.Dataset:
    """Give the temperatures by kinetic theory at the same times."""
    times = data["time"].to_numpy()
    return rs.gas.theory.cooling(body(elongation), LAW, times=times, rotational_temperature=WARM, **GAS)


@fg.styled
def draw(gases: dict[float, xr.Dataset], *, style: Style | None = None) -> Figure:
    """Draw T_tr and T_rot/T_tr over the collisions of a particle, with the closure as lines."""
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.8, 1, 2)
    for k, (elongation, data) in enumerate(gases.items()):
        number = data["collisions"]
        look = {"color": colors()[k], "marker": fg.MARKERS[k], "linestyle": "none", "markevery": 5}
        for one, line in ((data, look), (closure(elongation, data), {"color": colors()[k]})):
            translational, rotational = one["translational_temperature"], one["rotational_temperature"]
            left.plot(number, translational / WARM, **line)
            label = f"$L/R = {elongation:g}$" if line is look else None
            right.plot(number, rotational / translational, **line, label=label)
    ends = np.array([0.0, 110.0])
    left.plot(ends, np.exp(-SPHERES * ends), color="0.6", linestyle="--")
    left.text(113, np.exp(-SPHERES * 110), "spheres", color="0.6", va="center")
    left.set(yscale="log", xlabel="collisions of a particle", ylabel=r"$T_\mathrm{tr}/T_0$")
    right.set(yscale="log", xlabel="collisions of a particle", ylabel=r"$T_\mathrm{rot}/T_\mathrm{tr}$")
    right.set_ylim(0.8, 25)
    for axes, name in ((left, "a"), (right, "b")):
        fg.letter(axes, f"({name})", left=False)
    figure.legend(*right.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "gas.png"))
