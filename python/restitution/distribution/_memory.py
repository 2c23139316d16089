"""Dependence of successive impacts of a particle on each other, with and without a condition."""

import numpy as np
import xarray as xr

from restitution.distribution._table import Floats


def correlations(levels: dict[str, Floats], lags: int) -> xr.Dataset:
    """Correlate quantile levels, and their distances from the median, over impacts of the same particle.

    Parameters
    ----------
    levels : dict of ndarray, shape (particles, impacts)
        Quantile levels u by the name of the distribution that they belong to; NaN where there is none. Under
        that distribution they are uniform on [0, 1], so that mean and variance are known.
    lags : int
        Largest number of impacts between the two of a pair.
    """
    names = list(levels)
    shape = (len(names), lags)
    found = {name: np.empty(shape) for name in ("level", "level_error", "spread", "spread_error")}
    for row, name in enumerate(names):
        u = levels[name]
        for kind, deviation in (
            ("level", (u - 0.5) * np.sqrt(12.0)),
            ("spread", (np.abs(u - 0.5) - 0.25) * np.sqrt(48.0)),
        ):
            for lag in range(1, lags + 1):
                product = deviation[:, :-lag] * deviation[:, lag:]
                pairs = np.isfinite(product)
                number = pairs.sum(axis=1)
                sums = np.where(pairs, product, 0.0).sum(axis=1)
                correlation = sums.sum() / max(number.sum(), 1)
                scatter = np.sqrt(np.sum((sums - correlation * number) ** 2)) / max(number.sum(), 1)
                found[kind][row, lag - 1] = correlation
                found[f"{kind}_error"][row, lag - 1] = scatter
    about = {
        "level": "autocorrelation of the quantile level of restitution",
        "level_error": "standard error of level, over particles",
        "spread": "autocorrelation of the distance of the quantile level from the median",
        "spread_error": "standard error of spread, over particles",
    }
    return xr.Dataset(
        {
            name: (("distribution", "lag"), values, {"long_name": about[name]})
            for name, values in found.items()
        },
        coords={"distribution": names, "lag": np.arange(1, lags + 1)},
    )
