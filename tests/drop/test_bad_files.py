"""Runs as files are refused for the reasons that calls are, at once; and nothing is half-written."""

import re
from pathlib import Path
from typing import Any

import pytest

from reference.command import invoke
from reference.refused import BODY, LAW, LAW_TYPES, RUN, SEED, SHAPES, check, identify, message
from restitution.cli import BAD_INPUT
from restitution.drop.toml import read

GOOD: dict[str, dict[str, str]] = {
    "body": {"shape": '"dumbbell"', "radius": "3e-3", "separation": "3e-4"},
    "law": {"type": '"tangential-restitution"', "normal": "0.98"},
    "run": {"particles": "3", "impacts": "5"},
}


def write(path: Path, tables: dict[str, dict[str, str]]) -> Path:
    """Write tables of TOML literals to a file."""
    blocks = (
        "\n".join([f"[{name}]", *(f"{k} = {v}" for k, v in keys.items())]) for name, keys in tables.items()
    )
    path.write_text("\n".join(blocks), encoding="utf-8")
    return path


def literal(value: Any) -> str | None:
    """TOML for a value, or None where TOML has none."""
    if isinstance(value, bool | str):
        return repr(value).lower() if isinstance(value, bool) else f'"{value}"'
    if (isinstance(value, int | float) and abs(value) < 2**256) or isinstance(value, float):
        return repr(value)
    if isinstance(value, list) and all(literal(item) for item in value):
        return f"[{', '.join(literal(item) or '' for item in value)}]"
    return None


IN_A_FILE = [
    (table, name, value, allowed)
    for table, cases in (("body", BODY), ("law", LAW), ("run", RUN))
    for name, value, allowed in cases
    if type(value) in (bool, int, float, str, list) and literal(value)
]


def refused(path: Path) -> list[str]:
    """Return what the command says of a bad file, and check that nothing is written."""
    before = sorted(path.parent.iterdir())
    result = invoke("simulate", path, "--out", path.with_name("run.nc"))
    assert sorted(path.parent.iterdir()) == before
    assert result.exit_code == BAD_INPUT
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert all(line.startswith(f"error: {path}: ") for line in lines)
    text = [line.removeprefix(f"error: {path}: ") for line in lines]
    assert message(lambda: read(path)) == "\n".join(f"{path}: {line}" for line in text)
    return text


@pytest.mark.parametrize(("table", "name", "value", "allowed"), IN_A_FILE, ids=identify)
def test_a_file_is_refused_for_the_same_reasons(
    tmp_path: Path, table: str, name: str, value: Any, allowed: str
) -> None:
    tables = GOOD | {table: GOOD[table] | {name: str(literal(value))}}
    [line] = refused(write(tmp_path / "run.toml", tables))
    check(line, f"{table}.{name}", value, allowed)


def test_a_file_with_much_wrong(tmp_path: Path) -> None:
    """One reading finds everything; unknown keys come with a guess and with what the table takes."""
    tables = {
        "boddy": {"a": "1"},
        "body": {"shape": '"dumbbell"', "raduis": "3e-3", "separation": "-1"},
        "law": {"type": '"friction"', "normal": "0.98"},
        "run": {"particle": "3", "body": "1", "seed": "-1"},
    }
    takes = "[run] takes particles, impacts, release_height, gravity, orientation, spin, release_velocity, "
    takes += "incline, minimum_speed, seed"
    lines = refused(write(tmp_path / "run.toml", tables))
    assert [re.sub(r" \(.*\)$", "", line) for line in lines] == [  # without units and such
        "boddy: unknown; did you mean body? the file takes body, law, run, statistics, distribution",
        "body.raduis: unknown; did you mean body.radius? [body] takes shape, radius, separation, density, "
        "wall, inertia",
        "body.radius: missing; must be a finite number > 0",
        "body.separation = -1: must be a finite number >= 0",
        f"law.type = 'friction': must be {LAW_TYPES}",
        f"run.particle: unknown; did you mean run.particles? {takes}",
        f"run.body: unknown; {takes}",
        f"run.seed = -1: {SEED}",
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "",
            [
                f"body.shape: missing; must be {SHAPES}",
                f"law.type: missing; must be {LAW_TYPES}",
            ],
        ),
        (
            "body = 3\n[law]\ntype = 5",
            [
                "body = 3: must be a table [body]",
                f"body.shape: missing; must be {SHAPES}",
                f"law.type = 5: must be {LAW_TYPES}",
            ],
        ),
    ],
    ids=["empty", "no tables"],
)
def test_a_file_without_its_tables(tmp_path: Path, text: str, expected: list[str]) -> None:
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    assert refused(path) == expected


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"[body\nradius = 1", "not a TOML file: Expected ']'"),
        (b"[run]\nseed = 1\nseed = 2", "not a TOML file: Cannot overwrite a value"),
        (b"[run]\nseed = 1e", "not a TOML file: "),
        (b"# \xff", "not a TOML file: 'utf-8' codec can't decode"),
        (b"\x89HDF\r\n", "not a TOML file: "),
        (b"a = " + 5000 * b"[", "not a TOML file: lists or tables nested too deeply"),
    ],
    ids=["bracket", "twice", "number", "encoding", "netCDF", "nested"],
)
def test_a_file_that_is_not_toml(tmp_path: Path, content: bytes, expected: str) -> None:
    path = tmp_path / "run.toml"
    path.write_bytes(content)
    [line] = refused(path)
    assert line.startswith(expected)
