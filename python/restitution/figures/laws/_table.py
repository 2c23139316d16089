"""The numbers of the figure as a Markdown table."""

import numpy as np
import xarray as xr


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
                f"{int(body['all_impacts']):,}".replace(",", " "),
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
    """Decimals that show two digits of an error."""
    return max(0, 1 - int(np.floor(np.log10(error)))) if error > 0 else 3
