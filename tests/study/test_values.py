"""What a study is asked to vary and to measure is done, each value by itself, or refused by its name."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.studies import TINY
from restitution.study import learned, merge, open_store, study_of


def refused(**tables: Any) -> str:
    """Give the words by which a study is refused, less the name of the source."""
    with pytest.raises(ValueError, match=r"^study: ") as raised:
        study_of(TINY | tables)
    return str(raised.value).removeprefix("study: ")


def varied(**tables: Any) -> tuple[float, ...]:
    """Give the values of the first axis."""
    return study_of(TINY | tables).design.axes[0].values


@pytest.mark.parametrize(
    ("sweep", "name"),
    [
        ({"law.normal": [0.9], "law": {"normal": [0.1, 0.2]}}, "law.normal: appears twice"),
        ({"law": {"normal": [0.9]}, "law.normal": [0.1]}, "law.normal: appears twice"),
        ({"law.normal.yield_speed": [0.1], "law.normal": [0.9]}, "law.normal.yield_speed: must be left out"),
        ({"body.separation": [1e-4], "law.normal": {}}, "law.normal = {}: must be a list"),
        ({"body.separation": [1e-4], "law": {}}, "law = {}: must be a list"),
    ],
)
def test_nothing_that_is_varied_is_dropped(sweep: dict[str, Any], name: str) -> None:
    """A key in quotes and a dotted one are the same; one of the two would take the place of the other."""
    assert refused(sweep=sweep).startswith(f"sweep.{name}")


def test_a_range_has_as_many_points_as_it_says() -> None:
    """0.9 and 0.9 + 4e-16 have four doubles between them, and one value of 15 digits."""
    text = refused(sweep={"law.normal": {"from": 0.9, "to": 0.9 + 4e-16, "points": 5}})
    assert text.startswith("sweep.law.normal = {")
    assert text.endswith("must be so far apart that its 5 points differ in 15 digits")
    ends = {"from": 0.9, "to": 0.9 + 4e-16}
    assert varied(sweep={"law.normal": ends | {"points": 2}}) == (ends["from"], ends["to"])
    # The first digits of 0.12345678901234567 are less than itself: points begin at it, and go on upwards.
    low = 0.12345678901234567
    assert "differ in 15 digits" in refused(
        sweep={"law.normal": {"from": low, "to": low + 1e-16, "points": 3}}
    )
    spread = {"design": "latin-hypercube", "points": 64, "law.normal": {"from": 0.9, "to": 0.9 + 1e-15}}
    assert "its 64 points differ" in refused(sweep=spread)


@pytest.mark.parametrize("ends", [(-1.7e308, 1.7e308), (0.0, np.inf), (-np.inf, 0.0)])
def test_a_range_of_no_finite_width(ends: tuple[float, float]) -> None:
    """Differences of doubles overflow; pytest makes an error of NumPy's warning."""
    low, high = ends
    assert refused(sweep={"law.normal": {"from": low, "to": high, "points": 3}}).startswith(
        "sweep.law.normal"
    )
    bins = TINY["statistics"] | {"velocity_bins": {"from": low, "to": high, "bins": 3}}
    assert refused(statistics=bins).startswith("statistics.velocity_bins = {")
    scaled = {"from": 5e-324, "to": 1.7e308, "points": 3, "scale": "log"}
    assert "to / from, is finite" in refused(sweep={"law.normal": scaled})


def test_arrays_of_less_precision_are_varied() -> None:
    single = np.array([0.5, 0.75], np.float32)
    assert varied(sweep={"law.normal": single}) == varied(sweep={"law.normal": [0.5, 0.75]}) == (0.5, 0.75)


def test_seeds_are_exact(tmp_path: Path) -> None:
    """Coordinates are doubles, of which 2**64 - 1 is none: it would be the same as 2**64 - 2."""
    told = refused(sweep={"run.seed": [3, 2**64 - 1]})
    assert told.startswith("sweep.run.seed[1] = 18446744073709551615: must be a number that a double")
    seeds = (3, 2**53, 2**63)
    found = rs.sweep(TINY | {"sweep": {"run.seed": list(seeds)}}, tmp_path / "s.zarr", threads=1)
    assert tuple(map(int, found["seed"].to_numpy())) == seeds
    means = found["mean_restitution"].to_numpy()
    assert not np.array_equal(means[1], means[2], equal_nan=True)


@pytest.mark.parametrize("seed", ["x", float("nan"), float("inf"), -1, 2**64, None, 3.0])
def test_the_seed_of_points_that_are_drawn(seed: Any) -> None:
    """It is that of the run, by whose name it is refused, and not by the generator of NumPy."""
    drawn = {"design": "latin-hypercube", "points": 4, "law.normal": {"from": 0.5, "to": 0.9}}
    told = refused(run=TINY["run"] | {"seed": seed}, sweep=drawn)
    assert told.startswith(f"run.seed = {seed!r}: must be a whole number in")


def test_points_of_a_range_are_for_a_grid() -> None:
    """A design that is drawn has one number of points for all parameters."""
    drawn = {"design": "sobol", "points": 4, "law.normal": {"from": 0.5, "to": 0.9, "points": 8}}
    assert refused(sweep=drawn).startswith("sweep.law.normal.points: unknown")


@pytest.mark.parametrize("design", ["latin-hypercube", "sobol"])
def test_a_store_of_points_that_were_drawn_knows_its_study(tmp_path: Path, design: str) -> None:
    """Shards are merged without the study, and a point is learned from; its values were drawn once."""
    ranges = {"law.normal": {"from": 0.5, "to": 0.9}, "body.separation": {"from": 1e-4, "to": 2e-3}}
    bins = {
        "velocity_bins": {"from": 0.2, "to": 1.0, "bins": 4},
        "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40},
    }
    run = {"particles": 1500, "impacts": 8, "seed": 7}
    tables = TINY | {"run": run, "statistics": bins, "sweep": {"design": design, "points": 2} | ranges}
    parts = [tmp_path / f"{number}.zarr" for number in (1, 2)]
    for number, part in enumerate(parts, start=1):
        rs.sweep(tables, part, threads=1, shard=(number, 2))
    assert merge(tmp_path / "both.zarr", parts, threads=1).finished == 2
    rs.sweep(tables, tmp_path / "whole.zarr", threads=1)
    xr.testing.assert_identical(
        open_store(tmp_path / "both.zarr").load(), open_store(tmp_path / "whole.zarr").load()
    )
    normal = study_of(tables).design.values(1)["law.normal"]
    assert learned(tmp_path / "both.zarr", point=1).data.attrs["normal"] == normal


@pytest.mark.parametrize(
    ("more", "names"),
    [
        ({}, "density, kurtosis, mean_fraction, mean_restitution, second_moment, skewness, std_"),
        ({"statistics": TINY["statistics"] | {"fraction_bins": None}}, "density"),
        ({"learn": {}}, "restitution_quantile"),
        ({"fit": {"velocity": (0.22, 0.66)}}, "fit_above, fit_below, fit_distance, fit_location"),
        ({"statistics": None, "first_impact": {}}, "no variable has one"),
    ],
)
def test_standard_errors_that_there_are_none_of(more: dict[str, Any], names: str) -> None:
    """Before anything is computed; and each of those that are named is one that there is."""
    tables = {key: value for key, value in (TINY | more).items() if value is not None}
    with pytest.raises(ValueError, match=r"effort\.until\.foo: has no standard error; .*" + names) as raised:
        study_of(tables | {"effort": {"until": {"foo": 0.01}}})
    there = str(raised.value).partition("there are ")[2]
    if there:
        found = study_of(tables | {"effort": {"until": dict.fromkeys(there.split(", "), 0.01)}})
        assert len(found.effort.until) > 0


def _counts(data: xr.Dataset) -> xr.Dataset:
    return xr.Dataset({"share": data["restitution"].mean()}) if "restitution" in data else data[["energy"]]


@pytest.mark.parametrize("of", ["statistics", "simulate"])
def test_standard_errors_of_a_measure(tmp_path: Path, of: str) -> None:
    """What it gives is known once it has been called, which is before there is a store."""
    tables = TINY | {"measure": {"function": _counts, "of": of}}
    with pytest.raises(ValueError, match=r"effort\.until\.foo: has no standard error; .*share"):
        rs.sweep(tables | {"effort": {"until": {"foo": 0.01}}}, tmp_path / "s.zarr", threads=1)
    assert list(tmp_path.iterdir()) == []
    good = tables | {"effort": {"batches": 4, "until": {"share": 1e3}}}
    assert "share_error" in rs.sweep(good, tmp_path / "s.zarr", threads=1)


@pytest.mark.parametrize(
    "function", [".:x", ":", "", "os", "no\0module:f", "restitution._core.none:f", "math:pi"]
)
def test_a_function_that_there_is_none_of(function: str) -> None:
    assert refused(measure={"function": function}).startswith("measure.function = ")


def test_a_module_that_cannot_be_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever it raises, the end of Python too."""
    monkeypatch.syspath_prepend(tmp_path)
    for name, text in (
        ("divides_study", "1 / 0"),
        ("ends_study", "raise SystemExit(0)"),
        ("syntax_study", "("),
    ):
        (tmp_path / f"{name}.py").write_text(text)
        assert refused(measure={"function": f"{name}:f"}).startswith(f"measure.function = '{name}:f': ")


def test_tables_that_hold_themselves() -> None:
    for name in ("sweep", "effort", "learn", "run", "law", "statistics"):
        table: dict[str, Any] = {}
        table["a"] = table
        assert refused(**{name: table}).startswith(f"{name}.a.a.a")
    table = dict(TINY)
    table["run"] = table
    with pytest.raises(ValueError, match=r"^study: run\.run\.run.*: must be at most 8 tables deep$"):
        study_of(table)
