"""Statistics that the core counts on the fly: the same impacts, exactly counted, in any order."""

import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference.command import Program
from restitution.laws import Law

COUNTS = (
    "restitution_count",
    "fraction_count",
    "number",
    "undefined",
    "restitution_underflow",
    "restitution_overflow",
    "fraction_underflow",
    "fraction_overflow",
    "velocity_underflow",
    "velocity_overflow",
)
QUANTUM = 2.0**-24
"""The core rounds ε − ε_n to multiples of this before it sums."""

LAW = rs.TangentialRestitution(normal=0.9, tangential=0.4)


def call(**given: Any) -> dict[str, Any]:
    """Arguments of a small run with bins that leave something on every side."""
    return {
        "particles": 70,
        "impacts": 60,
        "velocity_bins": np.linspace(0.0, 0.8, 9),
        "restitution_bins": np.linspace(-0.5, 1.5, 41),
        "fraction_bins": np.linspace(0.1, 0.6, 11),
    } | given


@settings(max_examples=25)
@given(
    elongation=st.sampled_from([0.0, 0.02, 0.1, 1.0, 2.0, 3.0]),
    normal=st.sampled_from([0.0, 0.5, 0.98, 1.0]),
    tangential=st.sampled_from([-1.0, 0.0, 1.0]),
    seed=st.integers(0, 2**64 - 1),
)
def test_it_counts_what_simulate_records(
    elongation: float, normal: float, tangential: float, seed: int
) -> None:
    """Counts are those of the recorded impacts; moments differ by no more than the rounding to quanta."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-3 * elongation)
    law = rs.TangentialRestitution(normal=normal, tangential=tangential)
    arguments = call(seed=seed)
    found = rs.statistics(body, law, **arguments)
    bins = {name: arguments.pop(name) for name in list(arguments) if name.endswith("_bins")}
    data = rs.simulate(body, law, **arguments)
    expected = rs.reduce(data, **bins)
    for name in COUNTS:
        np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
    np.testing.assert_array_equal(found.energy_created, expected.energy_created)
    np.testing.assert_array_equal(found.largest_energy_ratio, expected.largest_energy_ratio)
    np.testing.assert_array_equal(found.minimum, expected.minimum)
    np.testing.assert_array_equal(found.maximum, expected.maximum)
    # A mean moves by half a quantum at most, a variance by that times twice the largest deviation. Values
    # further than 2 from the origin, which is in [0, 1], have quanta that are 16 times as large.
    speeds, ratios = data.impact_velocity.to_numpy(), data.restitution.to_numpy()
    far, all_there = (
        np.histogram(speeds[which], bins["velocity_bins"])[0]
        for which in (np.abs(ratios) > 1.0, np.isfinite(ratios))
    )
    coarse = 1.0 + 15.0 * far / np.maximum(all_there, 1)
    spread = np.maximum(expected.maximum - expected.minimum, QUANTUM)
    rounding = (1e-13 * np.maximum(abs(expected.maximum), 1.0)).fillna(1)
    np.testing.assert_array_less(
        abs(found["mean_restitution"] - expected["mean_restitution"]).fillna(0),
        0.5 * QUANTUM * coarse + rounding,
    )
    allowed = (2 * QUANTUM * spread + rounding * spread).fillna(1)
    np.testing.assert_array_less(abs(found.variance - expected.variance).fillna(0), allowed)
    np.testing.assert_allclose(found.mean_fraction, expected.mean_fraction, atol=2.0**-42)
    np.testing.assert_array_equal(
        found.particles_ended, np.bincount(data.stop_reason.to_numpy().astype(int), minlength=6)
    )


@pytest.mark.parametrize("velocity_bins", [np.linspace(0.0, 0.8, 9), None], ids=["velocity", "number"])
@pytest.mark.parametrize("law", [LAW, rs.Frictionless(normal=0.98)], ids=["creates energy", "does not"])
def test_counts_alone_are_the_same_counts(velocity_bins: Any, law: Law) -> None:
    """Nothing else changes, neither the ledger of energy; what rests on more than counts is left out."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-3)
    full = rs.statistics(body, law, **call(velocity_bins=velocity_bins))
    found = rs.statistics(body, law, **call(velocity_bins=velocity_bins, counts_only=True))
    left_out = {"mean_restitution", "variance", "skewness", "kurtosis", "minimum", "maximum", "mean_fraction"}
    left_out |= {f"{name}_error" for name in left_out} & set(full.data_vars)
    left_out |= {"fraction_count", "fraction_underflow", "fraction_overflow", "fraction_edges"}
    expected = full.drop_vars([*left_out, "fraction"])
    expected.attrs["standard_errors"] = "none: counts_only leaves the moments out"
    xr.testing.assert_identical(found, expected)
    assert (float(found.energy_created.sum()) > 0) == (law == LAW)


@pytest.mark.parametrize("value", ["yes", 1, None])
def test_counts_only_is_yes_or_no(value: Any) -> None:
    body = rs.Dumbbell(radius=3e-3, separation=3e-3)
    with pytest.raises(ValueError, match=r"^counts_only = .*: must be True or False$"):
        rs.statistics(body, LAW, **call(counts_only=value))


def test_nothing_is_dropped() -> None:
    """Every impact that happened is in a bin, beside the bins, or among the undefined."""
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    found = rs.statistics(body, LAW, **call(particles=500, impacts=300))
    data = rs.simulate(body, LAW, particles=500, impacts=300)
    total = found.number.sum() + found.undefined.sum() + found.velocity_underflow + found.velocity_overflow
    assert int(total) == int(data.impacts.sum())
    inside = (
        found["restitution_count"].sum("restitution")
        + found.restitution_underflow
        + found.restitution_overflow
    )
    np.testing.assert_array_equal(inside, found.number)
    inside = found.fraction_count.sum("fraction") + found.fraction_underflow + found.fraction_overflow
    np.testing.assert_array_equal(inside, found.number)


def test_rows_may_be_the_numbers_of_the_impacts() -> None:
    """Without velocity bins the rows are impacts 0, 1, ...: the first has the moments of Eq. 17."""
    body, law = rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.4)
    found = rs.statistics(body, law, **call(particles=40_000, impacts=5, velocity_bins=None))
    assert found["restitution_count"].dims == ("impact", "restitution")
    assert int(found.number[0]) == 40_000
    exact = rs.analytic.first_impact(body, law)
    assert (
        abs(float(found["mean_restitution"][0]) - exact.mean()) < 5 * exact.std() / 200
    )  # five standard errors
    data = rs.simulate(body, law, particles=40_000, impacts=5)
    np.testing.assert_allclose(found["mean_restitution"], data.restitution.mean("particle"), atol=QUANTUM)


@pytest.mark.parametrize("counts_only", [False, True])
def test_rows_of_impacts_hold_what_happened_in_each(counts_only: bool) -> None:
    """Counted from the record, under a law that creates energy, with values beside the bins."""
    body, law = rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.4)
    run: dict[str, Any] = {"particles": 300, "impacts": 30, "seed": 3}
    edges = np.linspace(-0.5, 1.0, 16)
    with pytest.warns(rs.EnergyWarning):
        data = rs.simulate(body, law, **run)
    with pytest.warns(rs.EnergyWarning):
        found = rs.statistics(
            body, law, **run, velocity_bins=None, restitution_bins=edges, counts_only=counts_only, batches=5
        )
    assert found.attrs["title"] == "Statistics of the impacts of bouncing aspherical particles"
    assert found.impact.values.tolist() == list(range(30))
    assert found.impact.attrs == {"long_name": "number of the impact, from 0"}
    values, energy = data.restitution.values, data.energy_ratio.values
    for row in range(30):
        here = values[:, row][~np.isnan(data.time.values[:, row])]
        assert int(found.number[row]) == np.isfinite(here).sum()
        assert found["restitution_count"].values[row].tolist() == [
            int(((here >= low) & (here < high)).sum()) for low, high in pairwise(edges)
        ]
        gains = energy[:, row][energy[:, row] > 1.0 + 1e-12]
        assert int(found.energy_created[row]) == gains.size
        assert float(found.largest_energy_ratio[row]) == (
            gains.max() if gains.size else pytest.approx(np.nan, nan_ok=True)
        )
    assert found.attrs["all_impacts"] == data.attrs["all_impacts"] == int(data.impacts.sum())
    assert found.attrs["energy_created_impacts"] == int(found.energy_created.sum()) > 0
    reasons = data.stop_reason.attrs["flag_meanings"].split()
    assert found.stop_reason.values.tolist() == reasons
    ended = [int((data.stop_reason.values == code).sum()) for code in range(len(reasons))]
    assert found.particles_ended.values.tolist() == ended
    assert found.particles_ended.attrs == {"long_name": "particles by the reason why they ended"}
    names = {"fraction_count", "variance", "mean_restitution", "mean_restitution_error"}
    assert {name in found for name in names} == {not counts_only}
    if not counts_only:
        assert found.mean_restitution_error.dims == ("impact",)


def test_the_progress_is_that_of_the_whole_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Batch after batch: it never falls back to the beginning of one."""
    told: list[int] = []
    shown: list[Any] = []

    @contextmanager
    def progress_bar(*what: Any, show: bool) -> Iterator[Any]:
        shown.append((*what, show))
        yield told.append

    monkeypatch.setattr("restitution.drop.statistics.progress_bar", progress_bar)
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    rs.statistics(body, LAW, **call(particles=20_000, impacts=200, threads=1, batches=4, progress=True))
    assert shown == [("statistics", 20_000, "particles", True)]
    assert told == sorted(told)
    assert told[-1] == 20_000


@pytest.mark.parametrize(
    ("bins", "rows", "columns"),
    [
        ({}, 10, 43 + 13),
        ({"velocity_bins": None}, 60, 43 + 13),
        ({"counts_only": True}, 10, 43),
        ({"batches": 1}, 10, 43 + 13),
    ],
)
def test_the_memory_of_grids_is_said_beforehand(
    bins: dict[str, Any], rows: int, columns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """8 bytes a site, and 4 a thread; 400 a row and as much a thread, and 200 a batch: no less is enough."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    batches = 1 if "batches" in bins or "counts_only" in bins else 7
    needed = rows * ((8 + 4 * 3) * columns + 400 * (1 + 3) + 200 * batches)
    given = call(threads=3, batches=7) | bins
    monkeypatch.setattr("restitution.drop.statistics.available_memory", lambda: needed)
    assert rs.statistics(body, LAW, **given).sizes
    monkeypatch.setattr("restitution.drop.statistics.available_memory", lambda: needed - 1)
    text = (
        f"velocity_bins, restitution_bins, fraction_bins: {rows} rows of {columns} sites, counted by 3 "
        f"threads, take {needed / 1e9:.3g} GB: must be at most {(needed - 1) / 1e9:.3g} GB, "
        "what this process can have"
    )
    for kind in (ValueError, MemoryError):
        with pytest.raises(kind, match=f"^{re.escape(text)}$"):
            rs.statistics(body, LAW, **given)


def test_the_threads_do_not_show() -> None:
    """Whole numbers add up to the same whatever the order; so do the moments made of them, to the bit."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    one = rs.statistics(body, LAW, **call(particles=3000, threads=1))
    for threads in (2, 3, 7):
        xr.testing.assert_identical(one, rs.statistics(body, LAW, **call(particles=3000, threads=threads)))


@pytest.mark.parametrize("level", rs.build_info()["simd_available"])
def test_the_vectors_do_not_show(level: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every SIMD level of the machine gives the bits of the best one."""
    body = rs.Dumbbell(radius=3e-3, separation=1.5e-3)
    best = rs.statistics(body, LAW, **call(particles=500))
    monkeypatch.setenv("RESTITUTION_SIMD", level)
    assert rs.build_info()["simd"] == level
    xr.testing.assert_identical(best, rs.statistics(body, LAW, **call(particles=500)))


def test_a_level_that_is_not_there_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """An unknown or missing level is an error that lists the ones there are, never a silent substitute."""
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    for name, reason in (("sse9", "no such SIMD level"), ("neon", "this machine lacks it")):
        if name in rs.build_info()["simd_available"]:
            continue
        monkeypatch.setenv("RESTITUTION_SIMD", name)
        with pytest.raises(ValueError, match=f"RESTITUTION_SIMD = {name}: {reason}.*scalar"):
            rs.simulate(body, LAW, particles=1, impacts=1)
        monkeypatch.delenv("RESTITUTION_SIMD")


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_memory_does_not_grow_with_the_particles() -> None:
    """Four million impacts on the lattice of Fig. 2 (records: 230 MB) take less than 60 MB."""
    program = (
        "import numpy as np, restitution as rs\n"
        "def peak():\n"
        "    return int(next(line.split()[1] for line in open('/proc/self/status') if 'VmHWM' in line))\n"
        "before = peak()\n"
        "rs.statistics(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),"
        " particles=20_000, impacts=200, velocity_bins=0.002 * np.arange(551),"
        " restitution_bins=0.01 * np.arange(-100, 301))\n"
        "print(peak() - before)"
    )
    assert int(Program(program).said()) < 60_000
