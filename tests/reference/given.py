"""Impacts with given numbers, as a Dataset of `simulate`."""

from typing import Any

import numpy as np
import xarray as xr


def impacts(velocity: Any, restitution: Any, fraction: Any = None) -> xr.Dataset:
    """Data with one row a particle, as `simulate` gives them."""
    columns = {"impact_velocity": velocity, "restitution": restitution}
    columns["rotational_fraction"] = np.full(np.shape(velocity), 0.1) if fraction is None else fraction
    columns["energy_ratio"] = np.square(restitution)
    return xr.Dataset(
        {name: (("particle", "impact"), np.atleast_2d(values)) for name, values in columns.items()},
        attrs={"seed": 7},
    )
