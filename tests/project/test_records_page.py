"""docs/records.md has every variable that is recorded, with its unit."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

import restitution as rs
from restitution import _core
from restitution._internal.arrays import _spelt as spelt

PAGE = (Path(__file__).parents[2] / "docs/records.md").read_text(encoding="utf-8")
ROD = rs.Dumbbell(radius=3e-3, separation=3e-3)
BOX = rs.Box(6e-3, 4e-3, 3e-3)
GLASS = rs.Viscoelastic(young_modulus=6e10, poisson_ratio=0.22, dissipation=1e-5, density=2500.0, radius=3e-3)
VARYING = rs.Frictionless(normal=GLASS)
DROPPED: dict[str, Any] = {
    "particles": 3,
    "impacts": 3,
    "release_height": rs.RandomHeight(lowest=0.1, highest=0.2),
}
MET: dict[str, Any] = {"encounters": 20, "translational_temperature": 1e-9, "rotational_temperature": 1e-9}
COOLED: dict[str, Any] = {"particles": 20, "collisions": 1.0, "translational_temperature": 1e-9, "batches": 2}
RUNS: dict[str, list[Callable[[], xr.Dataset]]] = {
    "Impacts": [
        partial(rs.simulate, body, VARYING, record="state", spin=[1.0, 2.0, 3.0], **DROPPED)
        for body in (ROD, BOX)
    ],
    "Encounters": [
        lambda: rs.pair.encounters(ROD, BOX, rs.Frictionless(normal=0.9), record="contacts", **MET)
    ],
    "Gases": [
        lambda: rs.gas.cool(
            [ROD, BOX], rs.Frictionless(normal=0.9), record="state", distributions=True, samples=2, **COOLED
        )
    ],
}


def rows(section: str) -> dict[str, str]:
    """Every name in the first column of the tables of a section, and the unit in the last one."""
    text = PAGE.partition(f"\n## {section}\n")[2].partition("\n## ")[0]
    cells = [line.strip("| ").split("|") for line in text.splitlines() if line.startswith("| `")]
    return {name: row[-1].strip() for row in cells for name in re.findall(r"`(\w+)`", row[0])}


@pytest.mark.parametrize("section", RUNS)
def test_every_variable_has_a_row(section: str) -> None:
    named, seen = rows(section), set()
    for run in RUNS[section]:
        data = run()
        for name, variable in data.data_vars.items():
            own = str(name).removesuffix("_error")
            seen.add(own)
            assert own in named, f"{own} is recorded, and is not in docs/records.md"
            said, unit = named[own], variable.attrs.get("units", "number")
            assert spelt(said) == spelt(unit), own
    rare = {"velocity_exponent", "height"}
    assert set(named) - seen <= rare, "a row of nothing that is recorded"


def test_the_tables_of_the_core_are_all_there() -> None:
    """Also what this run happens not to record."""
    assert {*_core.PAIR_ENCOUNTER, *_core.PAIR_CONTACT} <= set(rows("Encounters"))
    for body in (ROD, BOX):
        columns = _core.columns(body.compiled, VARYING.compiled, True)
        assert set(columns) - {"part"} <= set(rows("Impacts"))  # which is called `contact`


@pytest.mark.parametrize("name", _core.STOP_REASONS)
def test_every_reason_to_stop_has_a_row(name: str) -> None:
    assert f"| {_core.STOP_REASONS.index(name)} | `{name}` |" in PAGE


def test_endings_have_their_numbers() -> None:
    for number, name in enumerate(_core.PAIR_ENDINGS):
        assert f"{number} `{name}`" in PAGE
