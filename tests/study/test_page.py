"""docs/near-round.md and docs/studies.md: what they say is what their commands give."""

import re
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import integrate

import restitution as rs
from restitution.drop.toml import tables_in
from restitution.study import Refused, learned, study_of, sweep

ROOT = Path(__file__).parents[2]
PAGE = "".join(
    (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8") for name in ("near-round", "studies")
)
ROWS = (0, 6, 10)
"""Of the L/R of the study: the roundest, one where the scaling ends, one where it has ended."""


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "examples" / "near_round.py"))


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study of the page at three of its fifteen L/R: a point is the same whatever else is varied."""
    path = tmp_path_factory.mktemp("near_round") / "near_round.zarr"
    tables = tables_in(ROOT / "examples" / "near_round.toml")
    values = study_of(tables_in(ROOT / "examples" / "near_round.toml")).design.axes[0].values
    tables["sweep"]["body.separation"] = [values[i] for i in ROWS]
    sweep(tables, path)
    return path


@pytest.fixture(scope="module")
def rows(script: dict[str, Any], store: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = script["compared"](xr.open_zarr(store, chunks=None).load())
    return found


def numbers(line: str) -> list[float]:
    return [float(text) for text in re.findall(r"[-+]?\d+\.?\d*(?:e-?\d+)?", line)]


def printed(start: str) -> list[str]:
    return [line for line in PAGE.splitlines() if line.startswith(start)]


def test_the_table_is_that_of_the_command(script: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    """Up to the last digit; at κ > 1 the maps are chaotic, and their 4000 angles scatter by a per cent."""
    lines = [
        script["table"]([row for row in rows if row["delta"] == d]).splitlines()[2] for d in elongations(rows)
    ]
    for place, here in zip(ROWS, lines, strict=True):
        there = printed("| 0.")[place // 2]
        kappa, off = numbers(here)[1], np.abs(np.subtract(numbers(there), numbers(here)))
        assert off[:3].max() == 0.0, (there, here)
        assert off[3:].max() <= (0.11 if kappa < 0.5 else 2.0), (there, here)


def elongations(rows: list[dict[str, Any]]) -> list[float]:
    return sorted({row["delta"] for row in rows})


def test_the_exponent_is_2(script: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    """From two L/R here, from seven on the page: 2 within the next order in L/R, which is 3 % at 0.03."""
    exponent, error = script["exponent"](rows)
    (text,) = re.findall(r"\*\*(\d\.\d+ ± \d\.\d+)\*\*", PAGE)
    there, there_error = numbers(text)
    assert abs(exponent - there) < 4 * np.hypot(error, there_error)
    assert abs(there - 2) < 0.03


def test_the_map_is_the_limit_of_the_engine(rows: list[dict[str, Any]]) -> None:
    """In the roundest bodies every bin is within 5 % or five standard errors of σ."""
    for row in rows:
        if row["delta"] < 0.004:
            off = np.abs(row["std"] - row["map"])
            assert np.all(off < np.maximum(0.05 * row["map"], 5 * row["error"]))


def test_the_closed_form_is_as_good_as_the_page_says(script: dict[str, Any]) -> None:
    table = script["closed_over_map"]().splitlines()
    for line in table[2:]:
        (there,) = printed(line.split(" |")[0] + " |")
        # Worst factors belong to single speeds of a chaotic map.
        assert np.abs(np.subtract(numbers(there), numbers(line)))[:-1].max() <= 1.0, (there, line)
        assert numbers(line)[-1] < 1.8


def test_the_limits_of_the_closed_form_are_those_of_the_map(script: dict[str, Any]) -> None:
    """At κ → 0 the axis is exactly at rest; at κ = 10⁹ a flight turns it by any angle.

    In the latter, standard deviations of 4000 scatter by 1.1 %, kurtosis makes it somewhat more; 6 % is five
    times that. The first impact has no spin, and is exact in all limits.
    """
    for normal in (0.7, 0.98):
        u, _, std = script["reduced"](normal, 1e-12, 12)
        assert std == pytest.approx(script["closed"](u, normal, 1e-12), rel=1e-6)
        u, _, std = script["reduced"](normal, 1e9, 12)
        ratio = std / script["closed"](u, normal, 1e9)
        assert ratio[0] == pytest.approx(1.0, rel=1e-6)
        assert np.all(np.abs(ratio - 1) < 0.06)


def test_the_constant_of_libration(script: dict[str, Any]) -> None:
    """½√⟨s²p²⟩ by quadrature: x = π/2 - θ goes from x₀ to 0 and beyond, p²/2 = sin x₀ - sin x, s = cos x."""

    def average(x0: float) -> float:
        def p(z: float) -> float:
            return float(np.sqrt(2 * max(np.sin(x0) - np.sin(x0 - z * z), 1e-300)))

        end = np.sqrt(x0)  # x = x₀ - z² takes the root of the turning point away
        above = integrate.quad(lambda z: np.cos(x0 - z * z) ** 2 * p(z) * z, 0.0, end)[0]
        below = integrate.quad(lambda z: z / p(z), 1e-9, end)[0]
        return float(above / below)

    # The average vanishes like a logarithm at x₀ = π/2: the midpoint rule is good to a thousandth.
    starts = (np.arange(200) + 0.5) * np.pi / 400
    assert script["LIBRATING"] == pytest.approx(
        0.5 * np.sqrt(np.mean([average(x) for x in starts])), rel=2e-3
    )


def test_a_point_is_a_learned_distribution(store: Path) -> None:
    """Of the point itself, with its parameters; its moments are those of the study."""
    data = xr.open_zarr(store, chunks=None)
    found = learned(store, separation=3e-4, normal=0.98)
    assert found.data.attrs["separation"] == data["separation"].values[2]
    assert found.data.attrs["normal"] == 0.98
    assert found.data.attrs["particles"] == 8000
    point = data.isel(separation=2).sel(normal=0.98).sel(velocity=0.51, method="nearest")
    v = float(point["velocity"])
    # Bins of ε are 0.01 wide, and spread evenly.
    assert found.mean(v) == pytest.approx(float(point["mean_restitution"]), abs=2e-3)
    assert found.std(v) == pytest.approx(float(point["std_restitution"]), abs=2e-3)
    with pytest.raises(ValueError, match="values of separation: must be those of separation, normal"):
        learned(store, separation=3e-4)


def test_a_single_height_leaves_speeds_without_impacts(tmp_path: Path) -> None:
    """Of a round body, which loses as much in every impact: the error says what to do, and that helps."""
    study = {
        "body": rs.Dumbbell(radius=3e-3, separation=3e-6),
        "law": rs.TangentialRestitution(normal=0.9),
        "run": {"particles": 2000, "impacts": 30},
        "sweep": {"law.normal": [0.9]},
        "statistics": {
            "velocity_bins": {"from": 0.0, "to": 1.2, "bins": 24},
            "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 400},
        },
    }
    sweep(study, tmp_path / "one.zarr")
    told = (
        r"one\.zarr: nothing can be learned from it: .*set run\.release_height = \{ lowest = \.\.\., highest"
    )
    with pytest.raises(Refused, match=told):
        learned(tmp_path / "one.zarr", normal=0.9)
    study["run"] = {"particles": 2000, "impacts": 30, "release_height": {"lowest": 0.02, "highest": 0.08}}
    sweep(study, tmp_path / "all.zarr")
    assert learned(tmp_path / "all.zarr", normal=0.9).mean(0.725) == pytest.approx(0.9, abs=0.01)


def test_the_catalogue(tmp_path: Path) -> None:
    """The page lists what the command makes; a file pools the impacts of all heights of release."""
    catalogue = runpy.run_path(str(ROOT / "examples" / "catalogue.py"))
    listed = printed("| dumbbell, ") + printed("| spheroid, ")
    assert len(listed) == len(catalogue["LAWS"]) * sum(
        len(values) for *_, values in catalogue["BODIES"].values()
    )
    body, law, study = next(iter(catalogue["studies"](particles=64)))
    assert (body, law) == ("dumbbell", "tangential-restitution")
    study["sweep"] = {
        "body.separation": [1.5e-3],
        "law.normal": [0.9],
        "run.release_height": [0.04, 0.06, 0.09],
    }
    sweep(study, tmp_path / "s.zarr")
    found = learned(tmp_path / "s.zarr", separation=1.5e-3, normal=0.9)
    assert found.data.attrs["release_height"].tolist() == [0.04, 0.06, 0.09]
    epsilon = []
    for height in (0.04, 0.06, 0.09):
        data = rs.simulate(
            rs.Dumbbell(radius=3e-3, separation=1.5e-3),
            rs.TangentialRestitution(normal=0.9),
            particles=64,
            impacts=300,
            release_height=height,
        )
        v = data["impact_velocity"].values
        epsilon.append(data["restitution"].values[(v >= 0.3) & (v < 0.4)])
    pooled = np.concatenate(epsilon)
    # Some hundred impacts are learned as twenty bins or so of equal probability, spread evenly.
    assert found.mean(0.35) == pytest.approx(pooled.mean(), abs=0.03 * pooled.std())
    assert found.std(0.35) == pytest.approx(pooled.std(), rel=0.03)
    found.save(tmp_path / "one.nc")
    assert rs.FluctuatingRestitution.load(tmp_path / "one.nc").std(0.35) == found.std(0.35)
    one = learned(tmp_path / "s.zarr", separation=1.5e-3, normal=0.9, release_height=0.06)
    assert one.data.attrs["release_height"] == 0.06
