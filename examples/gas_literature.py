"""Published statements on gases of rough and of long grains, beside `restitution.gas.cool`.

    python examples/gas_literature.py

Prints a row for each: who, on which grains, says what, what the gas here has, and whether both agree.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

import restitution as rs

RADIUS, WARM = 3e-3, 1e-9
SPHERE = rs.Dumbbell(radius=RADIUS, separation=0.0)
RODS = 1.5, 2.0, 4.0
"""Lengths over diameters of rods."""


def table(particles: int, share: float = 1.0) -> str:
    """Write a row for each publication, of gases that have had this share of their collisions."""
    head = [
        "| publication | grains | says | here | |",
        "|---|---|---|---|---|",
    ]
    return "\n".join(head + [f"| {' | '.join(cells)} |" for cells in rows(particles, share)])


def rows(particles: int, share: float) -> Iterator[tuple[str, ...]]:
    """Yield the cells of each row."""

    def cool(body: Any, law: Any, collisions: float, few: int = 1) -> xr.Dataset:
        return rs.gas.cool(
            body,
            law,
            particles=max(particles // few, 40),
            collisions=share * collisions,
            translational_temperature=WARM,
            samples=40,
        )

    laws = {beta: rs.TangentialRestitution(normal=0.8, tangential=-beta) for beta in (-0.9, -0.5, 0.0, 0.5)}
    rough = {beta: cool(SPHERE, law, 60) for beta, law in laws.items()}
    for beta in (-0.5, 0.5):
        found, error = late(rough[beta], "ratio")
        closure = rs.gas.theory.steady_ratio(SPHERE, laws[beta])
        yield (
            "Huthmann and Zippelius, [PRE 56, R6275 (1997)](https://doi.org/10.1103/PhysRevE.56.R6275)",
            f"rough spheres, $\\varepsilon = 0.8$, $\\beta = {beta}$",
            f"$T_\\mathrm{{rot}}/T_\\mathrm{{tr}}$ becomes {closure:.3f} (Maxwellian theory)",
            f"{found:.3f} ± {error:.3f}, $a_{{02}} = {late(rough[beta], 'a02')[0]:.2f}$",
            f"{100.0 * (found / closure - 1.0):+.0f} %",
        )
    cosines = {beta: late(data, "cos2_velocity_spin") for beta, data in rough.items()}
    yield (
        "Brilliantov et al., [PRL 98, 128001 (2007)](https://doi.org/10.1103/PhysRevLett.98.128001); Kranz "
        "et al., [EPJ ST 179, 91 (2009)](https://doi.org/10.1140/epjst/e2010-01196-0)",
        "rough spheres, $\\varepsilon = 0.8$",
        "spin mostly perpendicular to the velocity ('sliced tennis ball'), parallel ('rifled bullet') in a "
        "small range only",
        "$\\langle\\cos^2\\rangle - 1/3$: "
        + "; ".join(
            f"{100 * (value - 1 / 3):+.2f} ± {100 * error:.2f} %, $\\beta = {beta}$"
            for beta, (value, error) in cosines.items()
        ),
        verdict(sum(value < 1 / 3 for value, _ in cosines.values()) >= 3),
    )
    loose, tight, lossy = (
        late(cool(SPHERE, rs.Coulomb(normal=normal, friction=friction), 60), "ratio")
        for normal, friction in ((0.7, 0.1), (0.9, 0.5), (0.85, 0.5))
    )
    yield (
        "Herbst, Huthmann and Zippelius, Granular Matter 2, 211 (2000)",
        "spheres with Coulomb friction",
        "small $\\varepsilon$ and $\\mu$: rotation stays, translation cools on; $\\varepsilon$ near 1 and "
        "large $\\mu$: a constant ratio",
        f"$\\varepsilon_n = 0.7$, $\\mu = 0.1$: {loose[0]:.0f} and growing; 0.9, 0.5: "
        f"{tight[0]:.2f} ± {tight[1]:.2f}",
        verdict(loose[0] > 100.0 and tight[1] < 0.1),
    )
    rods = {
        (aspect, normal): cool(rod(aspect), rs.Frictionless(normal=normal), 40, few=4)
        for aspect in RODS
        for normal in (0.98, 0.8)
    }
    tail = max(abs(late(data, "a20")[0]) for data in rods.values())
    ratios = {key: late(data, "ratio") for key, data in rods.items()}
    yield (
        "Rubio-Largo et al., Physica A 443, 477 (2016)",
        f"smooth rods, {', '.join(f'{aspect:g}' for aspect in RODS)} diameters long",
        "energies shared the more equally the closer to the elastic limit; velocities nearly Gaussian",
        "$T_\\mathrm{rot}/T_\\mathrm{tr}$ "
        + "; ".join(
            ", ".join(f"{ratios[aspect, normal][0]:.2f}" for aspect in RODS)
            + f" at $\\varepsilon_n = {normal}$"
            for normal in (0.98, 0.8)
        )
        + f"; $\\lvert a_{{20}}\\rvert$ at most {tail:.2f}",
        verdict(all(far(ratios[a, 0.98][0]) < far(ratios[a, 0.8][0]) + 0.02 for a in RODS)),
    )
    long = cool(rod(RODS[-1]), rs.Coulomb(normal=0.7, friction=0.3), 40, few=8)
    alike, along = late(long, "across"), late(long, "cos2_velocity_axis")
    yield (
        "Harth et al., [PRL 120, 214301 (2018)](https://doi.org/10.1103/PhysRevLett.120.214301)",
        "rods with friction, in free fall",
        "somewhat more energy in translation; rods prefer to fly along their axis",
        "4 diameters, $\\varepsilon_n = 0.7$, $\\mu = 0.3$: "
        f"$T_\\mathrm{{rot}}/T_\\mathrm{{tr}}$ across the axis {alike[0]:.2f} ± {alike[1]:.2f}; "
        f"$\\langle\\cos^2\\rangle - 1/3 = {along[0] - 1 / 3:.3f} ± {along[1]:.3f}$",
        f"energies: {verdict(alike[0] < 1.0)}; alignment: "
        + ("agrees" if along[0] - 1 / 3 > 2 * along[1] else "none seen"),
    )
    yield (
        "Trittel et al., [npj Microgravity 10, 81 (2024)](https://doi.org/10.1038/s41526-024-00420-5)",
        "spheres with friction, in free fall",
        "energy of rotation two thirds of that of translation, while they cool",
        "; ".join(
            f"{found:.2f} ± {error:.2f} at $\\varepsilon_n = {normal}$, $\\mu = 0.5$"
            for normal, (found, error) in ((0.9, tight), (0.85, lossy))
        ),
        "agrees for an $\\varepsilon_n$ between" if tight[0] < 0.67 < lossy[0] else verdict(False),
    )


def rod(aspect: float) -> rs.Spherocylinder:
    """Make a rod so many diameters long."""
    return rs.Spherocylinder(radius=RADIUS, separation=2.0 * RADIUS * (aspect - 1.0))


def far(ratio: float) -> float:
    """Return how far a ratio is from 1."""
    return float(abs(np.log(ratio)))


def late(data: xr.Dataset, name: str) -> tuple[float, float]:
    """Return the mean and its standard error of the second half.

    "ratio" is T_rot/T_tr, and "across" the same of the first axis. Looks at the same gas are not independent,
    so that the error is that of one look.
    """
    second = data.isel(time=slice(len(data["time"]) // 2, None))
    if name not in ("ratio", "across"):
        return float(second[name].mean()), float(second[f"{name}_error"].mean())
    of = "rotational_temperature" if name == "ratio" else "axis_temperature"
    if name == "across":
        second = second.isel(axis=0)
    values = second[of] / second["translational_temperature"]
    parts = (second[f"{of}_error"] / second[of]) ** 2
    parts = parts + (second["translational_temperature_error"] / second["translational_temperature"]) ** 2
    return float(values.mean()), float((values * np.sqrt(parts)).mean())


def verdict(agrees: bool) -> str:
    """Say whether both agree."""
    return "agrees" if agrees else "does not agree"


if __name__ == "__main__":
    print(table(20_000))
