"""Densities of impacts in bins, with errors in which each particle is one draw."""

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, IntArray


def mesh(low: float, high: float, step: float) -> FloatArray:
    """Return edges of the lattice with origin 0 and this step, from `low` to `high`, shape (n + 1,)."""
    return step * np.arange(round(low / step), round(high / step) + 1, dtype=np.float64)


def in_window(data: xr.Dataset, name: str, window: tuple[float, float]) -> tuple[IntArray, FloatArray]:
    """Return particle and value of `name` of impacts with impact velocity in [lo, hi), shapes (n,)."""
    velocity = data["impact_velocity"].to_numpy()
    particle, impact = np.nonzero((velocity >= window[0]) & (velocity < window[1]))
    return particle, data[name].to_numpy()[particle, impact]


def design_effect(particle: IntArray, values: FloatArray, edges: FloatArray) -> FloatArray:
    """Design effect in each bin: the variance of its density over that if all impacts were independent.

    A share p = Σc/Σn, with c of the n impacts of a particle in the bin, has the variance Σ(c − np)²/(Σn)²,
    each particle being one draw. Given is Σ(c − np)²/Σc, which is 1 for rare impacts of different particles,
    and 1 where there are none.
    """
    size = edges.size - 1
    bins = np.searchsorted(edges, values, side="right") - 1
    inside = (bins >= 0) & (bins < size)
    cell, each = np.unique(particle[inside] * size + bins[inside], return_counts=True)
    drawn = np.bincount(particle)
    weights = (each, each**2, each * drawn[cell // size])
    single, squares, mixed = (np.bincount(cell % size, weights=w, minlength=size) for w in weights)
    share = single / values.size
    scatter = squares - 2 * share * mixed + share**2 * np.sum(drawn**2)
    # Rounding may carry it below zero where every impact is in the bin.
    return np.divide(np.maximum(scatter, 0.0), single, out=np.ones(size), where=single > 0)


def density(count: IntArray, number: int, edges: FloatArray, together: FloatArray | float) -> xr.Dataset:
    """Return the density of `number` impacts, and its standard error if `together` impacts are one draw."""
    scale = 1 / (number * np.diff(edges))
    error = np.sqrt(count * together)
    return xr.Dataset(
        {
            "edges": ("edge", edges),
            "impacts": ("bin", count),
            "density": ("bin", count * scale, {"long_name": "probability density"}),
            "density_error": ("bin", error * scale, {"long_name": "standard error, a particle is a cluster"}),
            "number": number,
            "outside": number - int(count.sum()),
        }
    )
