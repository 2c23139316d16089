"""The caption with every parameter, and the numbers of the figure as a Markdown table."""

import numpy as np
import xarray as xr

from restitution.figures.laws._measure import BATCHES, FRICTION, NORMAL, RADIUS, STICK
from restitution.figures.report import grouped


def caption(data: xr.Dataset) -> str:
    """Return the caption of the figure."""
    about = data.attrs
    elongations = ", ".join(f"{x:g}" for x in data["elongation"].values)
    created = data["all_share"].max("elongation")
    quiet = "; ".join(str(law) for law in data["law"].values[created.to_numpy() == 0])
    total = grouped(int(data["all_impacts"].sum()))
    return (
        "The same bodies under six collision laws. Columns: dumbbells of two spheres of radius R, centres "
        f"L apart, L/R = {elongations}. Rows: probability density of the coefficient of restitution ε (Eq. "
        f"1) at the impact velocity {about['speed']:g} ± 0.01 m/s (the ranges of ε differ); its standard "
        "deviation; mean rotational over total kinetic energy before the impact. Below, for all bodies: (m) "
        "share of impacts that multiply the kinetic energy by more than 1 + 10⁻¹²; (n) the largest factor of "
        "any, less 1, and dash-dotted, with L/R beside it, what none under ε_t = 1 can exceed. All but the "
        "first row in bins of 0.02 m/s of the impact velocity. Laws and bodies that are not seen in (m) and "
        f"(n) created no energy there; at no velocity did: {quiet}. Where a line is not seen above, others "
        "cover it. Bands: ± one "
        f"standard error, from {BATCHES} independent batches of particles; mostly narrower than the line. "
        f"Parameters: ε_n = {NORMAL:g} in all laws; μ = {FRICTION:g} in Coulomb's and in Chatterjee and "
        f"Ruina's; in the latter e_t = {STICK:g}; R = {1e3 * RADIUS:g} mm; centre of mass released from "
        f"rest at {1e3 * about['release_height']:g} mm, θ uniform in [0, π); g = {about['gravity']:g} m/s². "
        f"Run: {about['particles']} particles for each body and law, each followed until it rests or for "
        f"{about['impacts']} impacts; {total} impacts in all; seed {about['seed']}; restitution "
        f"{about['version']}."
    )


def table(data: xr.Dataset) -> str:
    """Write a row for each body and law: created energy, and σ(ε) and E_rot/E_tot at one speed."""
    speed, slowest = data.attrs["speed"], data.attrs["slowest"]
    lines = [
        f"| L/R | law | impacts | create energy | largest factor | create energy, v ≥ {slowest:g} m/s | "
        f"largest factor there | σ(ε) at {speed:g} m/s | E_rot/E_tot at {speed:g} m/s |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    at = data.sel(velocity=speed, method="nearest")
    for elongation in data["elongation"].values:
        for law in data["law"].values:
            body, here = (one.sel(elongation=elongation, law=law) for one in (data, at))
            cells = [
                f"{elongation:g}",
                str(law),
                grouped(int(body["all_impacts"])),
                *_created(body, "all"),
                *_created(body, "total"),
                _with_error(here["deviation"], here["deviation_error"]),
                _with_error(here["mean_fraction"], here["mean_fraction_error"]),
            ]
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _created(body: xr.Dataset, which: str) -> tuple[str, str]:
    """Write the share of energy-creating impacts and their largest factor."""
    share, error = (100 * float(body[f"{which}_share{suffix}"]) for suffix in ("", "_error"))
    if not share > 0:
        return "none", "—"
    digits = _digits(error)
    gain = f"{float(body[f'{which}_factor']) - 1:.3g}"
    mantissa, _, power = gain.partition("e")
    gain = f"{mantissa}·10^{int(power)}" if power else gain
    return f"{share:.{digits}f} ± {error:.{digits}f} %", f"1 + {gain}"


def _with_error(value: xr.DataArray, error: xr.DataArray) -> str:
    digits = _digits(float(error))
    return f"{float(value):.{digits}f} ± {float(error):.{digits}f}"


def _digits(error: float) -> int:
    """Return the decimals that show two digits of an error."""
    return max(0, 1 - int(np.floor(np.log10(error)))) if error > 0 else 3
