"""Studies that cannot be: an error that names the place, before anything is made."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from reference.command import invoke
from reference.studies import TINY
from restitution.study import study_of

HUGE = 10**5000
ENDLESS: dict[str, Any] = {}
ENDLESS["a"] = ENDLESS


def ranged(**more: Any) -> dict[str, Any]:
    return {"law.normal": {"from": 0.1, "to": 0.2, "points": 3} | more}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"sweep": {"law.normal": [0.9], "law": {"normal": [0.1, 0.2]}}},
            r'sweep\."law\.normal": is there',
        ),
        (
            {"sweep": ranged(**{"from": 0.9, "to": 0.9 + 4e-16, "points": 5})},
            r"sweep\.law\.normal = .*: must be",
        ),
        (
            {"sweep": {"law.normal": np.array([9], "m8[ns]")}},
            r"sweep\.law\.normal = .*: must be a list",
        ),
        (
            {"sweep": {"law.normal": [np.complex64(1)]}},
            r"sweep\.law\.normal = .*: must be a list",
        ),
        ({"sweep": {"run.seed": [3, 2**64 - 1]}}, r"sweep\.run\.seed = .*: must be a list"),
        ({"sweep": {"law.normal": [HUGE]}}, r"sweep\.law\.normal = \[an integer of 16610 bits\]: must be"),
        ({"sweep": ranged(to=HUGE)}, r"sweep\.law\.normal = .*an integer of 16610 bits.*: must be"),
        ({"sweep": ranged(**{"from": -1.7e308, "to": 1.7e308})}, r"sweep\.law\.normal = .*: must be"),
        ({"sweep": ranged(to=np.inf)}, r"sweep\.law\.normal = .*: must be"),
        ({"sweep": ranged(scale=np.array([1, 2]))}, r"sweep\.law\.normal\.scale = .*: must be 'linear' or"),
        ({"sweep": {"law.normal": [0.1], "design": np.array([1, 2])}}, r"sweep\.design = .*: must be 'grid'"),
        ({"sweep": {1: [0.1]}}, r"sweep\.1: no name"),
        ({"sweep": ENDLESS}, r"sweep\.a\.a\.a.*: tables in tables"),
        ({"run": 3}, r"run = 3: must be a table \[run\]"),
        ({"run": {"seed": np.inf}}, r"run\.seed = inf: must be a whole number in \[0, "),
        ({"run": {"seed": "x"}}, r"run\.seed = 'x': must be a whole number"),
        (
            {"statistics": {"restitution_bins": {"from": False, "to": True, "bins": True}}},
            r"statistics",
        ),
        (
            {"statistics": {"restitution_bins": {"from": "a", "to": 1.0, "bins": 3}}},
            r"statistics\.restitution_bins\.from = 'a': must be a finite number",
        ),
        (
            {"statistics": {"restitution_bins": {"from": 10**400, "to": 1.0, "bins": 3}}},
            r"statistics\.restitution_bins\.from = an integer of 1329 bits: must be a finite number",
        ),
        ({"effort": {3: 1}}, r"effort\.3: no name"),
        ({3: 1}, r"3: no name; a study takes body"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_study_that_cannot_be(change: dict[Any, Any], message: str) -> None:
    with pytest.raises(ValueError, match=rf"^study: {message}"):
        study_of(TINY | change)


@pytest.mark.parametrize(
    "line", ["normal = [0xDIGITS]", "run = 3", "normal = { from = 0.1, to = 0xDIGITS, points = 3 }"]
)
def test_files_of_studies(line: str, tmp_path: Path) -> None:
    """Integers of any length, in TOML's hexadecimal digits, and what is no table: no traceback."""
    text = line.replace("DIGITS", "f" * 5000)
    text = text if text.startswith("run") else f"[sweep.law]\n{text}\n[run]\nparticles = 16\n"
    file = tmp_path / "study.toml"
    file.write_text(text)
    found = invoke("sweep", file, "--out", tmp_path / "out.zarr")
    assert found.exit_code == 2
    assert "study.toml: " in found.output
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]
