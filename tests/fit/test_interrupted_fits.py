"""Fits of many draws: Ctrl-C within a second, memory that is refused by name, the same bits in parts."""

import json
import subprocess
import sys
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.command import Program
from restitution import fit
from restitution.fit import _result
from restitution.fit._result import Fit

SAMPLES = np.concatenate(
    [np.random.default_rng(1).laplace(0.98, 0.01, 300), np.random.default_rng(2).normal(0.9, 0.1, 900)]
)
FAMILIES = ["gaussian", "laplace", "logistic", "student_t", "asymmetric_laplace", "cusp_mixture"]
EDGES = np.linspace(0.2, 1.0, 5)


def fitted(family: str) -> Fit:
    return fit.cusp_mixture(SAMPLES, 0.98) if family == "cusp_mixture" else getattr(fit, family)(SAMPLES)


def impacts(particles: int = 200) -> Any:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    return rs.simulate(body, law, particles=particles, impacts=40)


@pytest.mark.parametrize("family", FAMILIES)
def test_parts_have_the_bits_of_the_whole(family: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Draws follow one another in the generator, and a density knows of one number only."""
    one, points = fitted(family), np.linspace(0.5, 1.5, 1000).reshape(2, 500)

    def found() -> tuple[Any, ...]:
        random = np.random.default_rng(3)
        values = one.rvs(999, seed=random), random.random(2)
        return *values, one.pdf(points), one.logpdf(points), one.cdf(points)

    whole = found()
    monkeypatch.setattr(_result, "PART", 64)
    for part, expected in zip(found(), whole, strict=True):
        np.testing.assert_array_equal(part, expected)
    assert (one.cdf(0.9).shape, one.rvs(0).shape) == ((), (0,))


def test_slopes_draw_all_particles_of_one_resample_after_the_other() -> None:
    """Which are the rows that NumPy draws at once: the bins are fitted to the same draws."""
    data = impacts()
    found = fit.slopes(data, EDGES, resamples=7, seed=3)
    times = np.random.default_rng(3).multinomial(200, np.full(200, 1 / 200), size=7)
    velocity, restitution = data["impact_velocity"].to_numpy(), data["restitution"].to_numpy()
    for bin_, (low, high) in enumerate(pairwise(EDGES)):
        inside = (velocity >= low) & (velocity < high)
        for again, row in enumerate(times):
            drawn = np.repeat(restitution[inside], row[np.nonzero(inside)[0]])
            expected = fit.asymmetric_laplace(drawn).parameters["above"]
            assert float(found.resampled["above"][again, bin_]) == pytest.approx(expected, rel=1e-12)


def test_what_no_memory_holds_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """The argument that asks for it, and how much of it there can be, before anything is drawn."""
    data, mixture, gaussian = impacts(), fitted("cusp_mixture"), fitted("gaussian")
    dist = rs.FluctuatingRestitution.from_statistics(
        rs.reduce(impacts(3000), np.linspace(0.5, 1.0, 3), np.linspace(-1, 3, 40))
    )
    speeds = np.full(10_001, 0.75)
    monkeypatch.setattr("restitution._internal.resources.available_memory", lambda: 80_000)
    for act, told in (
        (
            lambda: gaussian.rvs(10_001),
            r"size = 10001: must be at most 1e\+04 draws, which this process can hold",
        ),
        (lambda: mixture.rvs(2501), "size = 2501: must be at most 2500 draws, which this process can hold"),
        (lambda: dist.rvs(0.75, size=10_001), r"size = 10001: must be at most 1e\+04 draws"),
        (lambda: dist.rvs(speeds), r"v = an array of shape \(10001,\): must be at most 1e\+04 draws"),
        (lambda: fit.slopes(data, EDGES, resamples=420), "resamples = 420: must be at most 41[0-9] draws"),
    ):
        for kind in (ValueError, MemoryError):
            with pytest.raises(kind, match=f"^{told}"):
                act()
    assert gaussian.rvs(10_000).size == dist.rvs(speeds[1:]).size == 10_000


@pytest.mark.parametrize(
    ("made", "call"),
    [
        (
            "rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Frictionless(normal=0.9), "
            "particles=20_000, impacts=40)",
            "fit.slopes(one, np.linspace(0.2, 1, 40), resamples=10**4)",
        ),
        ("fit.gaussian(samples)", "one.rvs(10**8)"),
        ("fit.cusp_mixture(samples, 0.9)", "one.rvs(10**8)"),
        ("fit.gaussian(samples); many = np.linspace(0, 2, 6 * 10**7)", "one.cdf(many)"),
    ],
)
def test_ctrl_c_within_a_second(made: str, call: str) -> None:
    """Of the processor's time: a machine may be busy otherwise."""
    code = f"""
import json, os, signal, threading, time
import numpy as np
import restitution as rs
from restitution import fit
samples = np.random.default_rng(1).normal(0.9, 0.1, 1000)
one = {made}
pressed = []
def press():
    pressed.append(time.process_time())
    signal.raise_signal(signal.SIGINT)
threading.Timer(0.3, press).start()
try:
    {call}
except KeyboardInterrupt:
    print(json.dumps(time.process_time() - pressed[0]))
"""
    assert json.loads(Program(code).said()) < 1.0


def test_nothing_is_left_to_be_imported_when_a_run_ends() -> None:
    """What xarray imports with its first index would take a quarter of a second after Ctrl-C."""
    code = """
import sys
import restitution
assert "xarray" not in sys.modules
restitution.statistics, restitution.simulate
before = set(sys.modules)
import numpy as np
body, law = restitution.Dumbbell(radius=3e-3, separation=3e-4), restitution.Frictionless(normal=0.9)
bins = {"velocity_bins": np.linspace(0, 1, 4), "restitution_bins": np.linspace(-1, 3, 4)}
restitution.statistics(body, law, particles=2, impacts=2, **bins)
late = {name for name in set(sys.modules) - before if name.partition(".")[0] in ("dask", "scipy", "pandas")}
print(sorted(late))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
