"""Impacts and the ones that follow them on the same particle."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from restitution.papers.estimate import Array, Impacts


def followed(impacts: Impacts, data: xr.Dataset) -> Impacts:
    """Select the impacts of a run that have a next one with a finite ε."""
    e = data["restitution"].to_numpy()
    follows = np.zeros(e.shape, dtype=np.bool_)
    follows[:, :-1] = np.isfinite(e[:, 1:])
    return impacts.only(follows[impacts.where] & np.isfinite(e[impacts.where]))


def following(impacts: Impacts, values: NDArray[np.generic]) -> Array:
    """Return values at the impacts that follow."""
    particle, impact = impacts.where
    return Impacts((particle, impact + 1), impacts.cell, impacts.cells, impacts.particles).of(values)
