"""The caption: what is drawn, and every parameter."""

import xarray as xr

from restitution.figures.laws._measure import BATCHES, FRICTION, NORMAL, RADIUS, STICK


def caption(data: xr.Dataset) -> str:
    """Caption of the figure."""
    about = data.attrs
    elongations = ", ".join(f"{x:g}" for x in data["elongation"].values)
    created = data["all_share"].max("elongation")
    quiet = "; ".join(str(law) for law in data["law"].values[created.to_numpy() == 0])
    total = f"{int(data['all_impacts'].sum()):,}".replace(",", " ")
    return " ".join(
        [
            "The same bodies under six collision laws. Columns: dumbbells of two spheres of radius R,",
            f"centres L apart, L/R = {elongations}. Rows: probability density of the coefficient of",
            f"restitution ε (Eq. 1) at the impact velocity {about['speed']:g} ± 0.01 m/s (the ranges of ε",
            "differ); its standard deviation; mean rotational over total kinetic energy before the",
            "impact; share of impacts that multiply the kinetic energy by more than 1 + 10⁻¹²; the",
            "largest factor of any, less 1. All but the first in bins of 0.02 m/s of the impact velocity.",
            "Dash-dotted: what no impact under ε_t = 1 can exceed. Laws that are not seen in the last two",
            f"rows created no energy there; at no velocity did: {quiet}.",
            "Where a line is not seen in the first three rows, others cover it.",
            "Bands: ± one standard error, from",
            f"{BATCHES} independent batches of particles; mostly narrower than the line. Parameters: ε_n =",
            f"{NORMAL:g} in all laws; μ = {FRICTION:g} in Coulomb's and in Chatterjee and Ruina's; in the",
            f"latter e_t = {STICK:g}; R = {1e3 * RADIUS:g} mm; centre of mass released from rest at",
            f"{1e3 * about['release_height']:g} mm, θ uniform in [0, π); g = {about['gravity']:g} m/s².",
            f"Run: {about['particles']} particles for each body and law, each followed until it rests or",
            f"for {about['impacts']} impacts; {total} impacts in all; seed {about['seed']}; restitution",
            f"{about['version']}.",
        ]
    )
