"""Pages for experimenters: their tables are those of the commands that they name."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import restitution as rs
from benchmarks import listening

ROOT = Path(__file__).parents[2]


def script(name: str) -> ModuleType:
    """Load a script of examples/."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "examples" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def row(page: str, name: str) -> list[str]:
    [line] = [line for line in page.splitlines() if line.startswith(f"| {name} |")]
    return [cell.strip() for cell in line.strip("|").split("|")]


@pytest.mark.parametrize("name", ["noise -30 dB", "8.8 kHz", "steel on steel"])
def test_the_precision_is_that_of_the_page(name: str) -> None:
    """Counts are the same; errors, which hang on the last bits of filters, within a third."""
    page = (ROOT / "docs" / "listening.md").read_text(encoding="utf-8")
    [condition] = [one for one in listening.CONDITIONS if one.name == name]
    here = row(listening.row(condition, listening.measure(condition)), name)
    there = row(page, name)
    assert here[1:4] == there[1:4]
    assert float(here[4]) == pytest.approx(float(there[4]), rel=0.34)


def test_every_condition_has_its_row() -> None:
    page = (ROOT / "docs" / "listening.md").read_text(encoding="utf-8")
    for condition in listening.CONDITIONS:
        assert len(row(page, condition.name)) == 7


def test_the_precision_with_balls_that_scatter_is_that_of_the_page() -> None:
    page = (ROOT / "docs" / "listening.md").read_text(encoding="utf-8")
    name = f"{listening.SCATTERING['slap']}, -45 dB"
    here, there = row(listening.scattering_row("slap", -45), name), row(page, name)
    assert [float(cell) for cell in here[1:]] == pytest.approx([float(cell) for cell in there[1:]], rel=0.34)
    for kind in listening.SCATTERING.values():
        for level in listening.LEVELS:
            assert len(row(page, f"{kind}, {level} dB")) == 4


def test_the_clock_is_that_of_the_page() -> None:
    clock = script("clock")
    found = [clock.compare(elongation) for elongation in clock.ELONGATIONS]
    assert clock.table(found).strip() in (ROOT / "docs" / "listening.md").read_text(encoding="utf-8")


def test_a_clock_is_never_off_by_more_than_heights_allow() -> None:
    """ε = ε_clock (1 + a)/(1 - b) with |a| <= gL/(4w²) after and |b| before, whatever the angles."""
    separation = 6e-4
    data = rs.flight.clock(
        rs.simulate(
            rs.Dumbbell(radius=3e-3, separation=separation),
            rs.Frictionless(normal=0.98),
            particles=300,
            impacts=60,
            release_height=0.1,
        )
    )
    w = data.clock_velocity.values
    a = 9.81 * separation / (4.0 * w**2)
    before, after = a[:, 1:-1], a[:, 2:]
    told, true = data.clock_restitution.values[:, 1:-1], data.restitution.values[:, 1:-1]
    known = np.isfinite(told) & (before < 0.5)
    slack = 1e-9
    assert known.sum() > 10_000
    assert np.all(true[known] <= (told * (1.0 + after) / (1.0 - before))[known] + slack)
    assert np.all(true[known] >= (told * (1.0 - after) / (1.0 + before))[known] - slack)
    assert np.abs(told - true)[known].max() > 1e-3


def test_a_sphere_and_a_clock_agree() -> None:
    data = rs.flight.clock(
        rs.simulate(
            rs.Dumbbell(radius=3e-3, separation=0.0), rs.Frictionless(normal=0.9), particles=3, impacts=20
        )
    )
    inner = data.isel(impact=slice(1, -1))
    assert inner.clock_restitution.values == pytest.approx(inner.restitution.values, rel=1e-9)
    assert inner.clock_velocity.values == pytest.approx(inner.impact_velocity.values, rel=1e-9)


def test_a_clock_needs_a_run() -> None:
    with pytest.raises(ValueError, match=r"^data lacks rebound_velocity: must be a Dataset from"):
        rs.flight.clock(rs.flight.restitution([0.0, 1.0, 1.9]))


def test_the_lab_sheet_has_its_figure(tmp_path: Path) -> None:
    script("lab_sheet").main(tmp_path)
    assert (tmp_path / "lab-sheet.png").stat().st_size > 10_000


def test_the_tables_of_roundness_are_those_of_the_command() -> None:
    page = (ROOT / "docs" / "roundness.md").read_text(encoding="utf-8")
    for table in script("roundness").tables().values():
        assert table.strip() in page
