"""The caption: what is drawn, and every parameter."""

import xarray as xr

from restitution.laws_figure._measure import BATCHES, FRICTION, NORMAL, RADIUS, STICK


def caption(data: xr.Dataset) -> str:
    """Caption of the figure."""
    about = data.attrs
    elongations = ", ".join(f"{x:g}" for x in data["elongation"].values)
    quiet = [
        str(law)
        for law in data["law"].values
        if not float(data["total_share"].sel(law=law).max()) > 0
    ]
    total = int(data["total_impacts"].sum())
    return (
        "The same bodies under six collision laws. "
        f"Columns: dumbbells of two spheres of radius R, centres L apart, L/R = {elongations}. "
        f"Rows: probability density of the coefficient of restitution ε (Eq. 1) at the impact velocity {about['speed']:g}"
        " ± 0.01 m/s (note the different ranges of ε); its standard deviation, the mean rotational over the total "
        "kinetic energy before the impact, the share of impacts that multiply the kinetic energy by more than "
        "1 + 10⁻¹², and the largest factor of any, less 1, in bins of 0.02 m/s of the impact velocity. "
        "Dash-dotted: what no impact under ε_t = 1 can exceed. "
        f"None of the impacts created energy under: {', '.join(quiet)}; where a law has no line in the two last "
        "rows, none did for this L/R. "
        f"Bands: ± one standard error, from {BATCHES} independent batches of particles; mostly narrower than the line. "
        f"Parameters: ε_n = {NORMAL:g} in all laws; μ = {FRICTION:g} in Coulomb's and Chatterjee and Ruina's; in the "
        f"latter e_t = {STICK:g}; R = {1e3 * RADIUS:g} mm; centre of mass released from rest at "
        f"{1e3 * about['release_height']:g} mm, θ uniform in [0, π); g = {about['gravity']:g} m/s². "
        f"Run: {about['particles']} particles for each body and law, each followed until it rests or for "
        f"{about['impacts']} impacts; {total:,}".replace(",", " ", 0)
        + f" impacts at {about['slowest']:g} m/s and above in all; seed {about['seed']}; "
        f"restitution {about['version']}."
    )
