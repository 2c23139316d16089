"""What fits refuse, by name, and what they survive: few, equal, enormous, heavy-tailed, empty, infinite."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.flanks import scaled_flanks
from restitution import fit
from restitution.fit import Counts


def test_bad_input_is_named() -> None:
    x = [1.0, 2.0, 4.0]
    edges = np.array([0.0, 1.0, 2.0])
    data = scaled_flanks(10, 1)
    one = fit.slopes(data, [0.1, 0.3, 0.5], resamples=2)
    cases: list[tuple[Callable[[], Any], str]] = [
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=1), "resamples = 1: at least two"),
        (lambda: fit.bootstrap(fit.gaussian, x, [1]), "clusters: 1 values"),
        (lambda: fit.bootstrap(fit.gaussian, x, [1, 1, 1]), "clusters: all samples are in one"),
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=2).interval("mean", 1.0), "confidence = 1.0: must"),
        (lambda: fit.bootstrap(fit.gaussian, Counts(edges, np.ones(2))), "samples: one set of counts"),
        (lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2))]), "counts: all samples are in one"),
        (
            lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2)), Counts(edges + 1, np.ones(2))]),
            "counts: must all have the same edges",
        ),
        (
            lambda: fit.goodness(fit.gaussian, [Counts(edges, np.ones(2))] * 2, clusters=[1, 2]),
            "clusters: counts are drawn again run by run",
        ),
        (lambda: Counts(edges, np.ones(3)), r"count: shape \(3,\)"),
        (lambda: Counts(edges[::-1], np.ones(2)), "edges: must be finite and strictly increasing"),
        (lambda: Counts(edges, np.array([1.0, -1.0])), r"count: holds \[-1.\]"),
        (lambda: Counts(edges, np.array([1.0, 0.0])), r"count: 1 bin\(s\) filled"),
        (lambda: fit.slopes(data), "velocity_bins: missing"),
        (
            lambda: fit.slopes(rs.reduce(data, [0.1, 0.5], [0.0, 1.0]), [0.1, 0.5]),
            "velocity_bins: counts have",
        ),
        (lambda: one.power_law("left"), "side = 'left': must be 'above' or 'below'"),
        (lambda: one.power_law("above"), "low = 0.0, high = inf: fewer than three bins"),
        (lambda: fit.dependence(data, [0.0, 1.0], lags=0), "lags = 0: must be at least 1"),
    ]
    for call, message in cases:
        with pytest.raises(ValueError, match=message):
            call()
