"""The numbers of the figure as a Markdown table."""

import numpy as np
import xarray as xr

from restitution._energy import percent


def table(data: xr.Dataset) -> str:
    """Write a row for each body and law: created energy, and σ(ε) and E_rot/E_tot at one speed."""
    lines = [
        "| L/R | law | impacts | share creating energy | largest factor | "
        f"σ(ε) at {data.attrs['speed']:g} m/s | E_rot/E_tot there |",
        "|---|---|---|---|---|---|---|",
    ]
    at = data.sel(velocity=data.attrs["speed"], method="nearest")
    for elongation in data["elongation"].values:
        for law in data["law"].values:
            body, here = (one.sel(elongation=elongation, law=law) for one in (data, at))
            created = float(body["total_share"]) > 0
            cells = [
                f"{elongation:g}",
                str(law),
                f"{int(body['total_impacts']):,}".replace(",", " "),
                _share(body) if created else "0",
                f"1 + {float(body['total_factor']) - 1:.3g}" if created else "—",
                _with_error(here["deviation"], here["deviation_error"]),
                _with_error(here["mean_fraction"], here["mean_fraction_error"]),
            ]
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _share(body: xr.Dataset) -> str:
    share, error = 100 * float(body["total_share"]), 100 * float(body["total_share_error"])
    digits = _digits(error)
    return f"{share:.{digits}f} ± {error:.{digits}f} %" if digits <= 6 else percent(share / 100)


def _with_error(value: xr.DataArray, error: xr.DataArray) -> str:
    digits = _digits(float(error))
    return f"{float(value):.{digits}f} ± {float(error):.{digits}f}"


def _digits(error: float) -> int:
    """Decimals that show two digits of an error."""
    return max(0, 1 - int(np.floor(np.log10(error)))) if error > 0 else 3
