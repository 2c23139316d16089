"""Hostile values at every place of a study, from Python and in files: an error that names it, or a study."""

import copy
import datetime
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from reference.command import invoke
from reference.hostile import VALUES
from reference.studies import TINY
from restitution.study import study_of

Place = tuple[str | int, ...]


def _measured(data: xr.Dataset) -> xr.Dataset:
    return data[["number"]].astype(float)


def _grid() -> dict[str, Any]:
    """Every table and every key of a study, but for those of another design."""
    return {
        "body": {"shape": "dumbbell", "radius": 3e-3, "density": 1e3},
        "law": {"type": "tangential-restitution", "tangential": 1.0},
        "run": {
            "particles": 8,
            "impacts": 4,
            "release_height": 0.06,
            "gravity": 9.81,
            "orientation": "isotropic",
            "spin": [0.0, 0.0, 0.0],
            "release_velocity": [0.0, 0.0, 0.0],
            "incline": 0.0,
            "minimum_speed": 0.0,
            "seed": 3,
        },
        "sweep": {
            "design": "grid",
            "body.separation": [1e-4, 3e-4],
            "law": {"normal": {"from": 0.5, "to": 0.9, "points": 2, "scale": "log"}},
        },
        "statistics": {
            "velocity_bins": {"from": 0.0, "to": 1.5, "bins": 3},
            "restitution_bins": 4,
            "restitution_range": [-1.0, 3.0],
            "fraction_bins": [0.0, 0.5, 1.0],
        },
        "learn": {"levels": [0.0, 0.5, 1.0]},
        "fit": {"family": "cusp-mixture", "velocity": [0.5, 1.0], "location": "normal"},
        "measure": {"function": _measured, "of": "statistics"},
        "first_impact": {},
        "effort": {
            "batches": 2,
            "until": {"std": 0.01, "fit_share": "1 %"},
            "velocities": [0.2, 0.8],
            "most_particles": 16,
        },
    }


def _spread() -> dict[str, Any]:
    """A design that is drawn, and what is drawn of a run."""
    run = {
        "particles": 8,
        "impacts": 4,
        "seed": 3,
        "release_height": {"lowest": 0.05, "highest": 0.06},
        "spin": {"rate": [1.0, 2.0], "axis": "isotropic"},
    }
    return {
        "body": {"shape": "dumbbell", "radius": 3e-3},
        "law": {"type": "frictionless", "normal": {"type": "plastic", "yield_speed": 0.1}},
        "run": run,
        "sweep": {"design": "latin-hypercube", "points": 3, "body.separation": {"from": 1e-4, "to": 3e-4}},
        "statistics": {"restitution_bins": [-1.0, 1.0, 3.0]},
    }


MAKERS = {"grid": _grid, "spread": _spread}


def _places(tables: Any, place: Place = ()) -> Iterator[Place]:
    """Every key and every element of a list, at any depth."""
    if isinstance(tables, dict | list):
        for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
            yield (*place, key)
            yield from _places(value, (*place, key))


def _with(tables: dict[str, Any], place: Place, value: Any) -> dict[str, Any]:
    """Copy tables, with another value in one place."""
    changed = copy.deepcopy(tables)
    target: Any = changed
    for key in place[:-1]:
        target = target[key]
    target[place[-1]] = value
    return changed


PLACES = [(kind, place) for kind, make in MAKERS.items() for place in _places(make())]

NEVER = {
    *("True", "numpy False", "nan", "complex", "numpy complex", "Decimal", "Fraction", "date", "duration"),
    *("bytes", "masked", "masked array", "nan inside", "bools", "bool inside", "digits inside", "mixed"),
    *("None inside", "ragged", "itself", "exploding", "dates", "durations", "objects", "complex array"),
}
"""Values that are right in no place."""

PARTNERS = {
    "restitution_bins": "restitution_range",
    "velocity_bins": "fit.velocity",
    "run": "effort",
    "body.separation": "release_height",
}
"""Where a value is right in itself, what no longer goes with it may be the one that is named."""


def _said(text: str, place: Place) -> str | None:
    """Say what is wrong with the words of an error, if anything is."""
    if len(text) > 2000:
        return "goes on and on"
    if not all(line.startswith("study: ") or line.startswith("  ") for line in text.splitlines()):
        return "does not name the study"
    # A key in quotes is dotted; of some values the error names what they are a part of, or go together with.
    words = {word for key in place if isinstance(key, str) for word in (key, key.rpartition(".")[2])}
    words |= {PARTNERS[word] for word in words & set(PARTNERS)}
    return None if any(word in text for word in words) else "does not name the place"


@pytest.mark.parametrize(
    ("kind", "place"), PLACES, ids=lambda one: one if isinstance(one, str) else ".".join(map(str, one))
)
def test_every_hostile_value_at_every_place(kind: str, place: Place) -> None:
    """What is accepted has an identity, which only numbers, words and lists of them have."""
    wrong: dict[str, str] = {}
    for name, make in VALUES.items():
        try:
            found = study_of(_with(MAKERS[kind](), place, make()))
            assert found.digest
        except ValueError as error:
            problem = (said := _said(str(error), place)) and f"{said}: {error}"
        except Exception as error:
            problem = f"{type(error).__name__}: {error}"
        else:
            problem = "is accepted" if name in NEVER else None
        if problem is not None:
            wrong[name] = problem
    assert wrong == {}, wrong


@pytest.mark.parametrize("kind", MAKERS)
def test_every_hostile_key_in_every_table(kind: str) -> None:
    """A key that no table has; a list of a parameter's values would be one in [sweep]."""
    tables = MAKERS[kind]()
    places = [(), *((place) for place in _places(tables) if isinstance(_at(tables, place), dict))]
    for place in places:
        for name, make in VALUES.items():
            key = make()
            try:
                changed = _with(tables, (*place, key), {})
            except Exception:  # no value that a dictionary can have as a key
                continue
            with pytest.raises(ValueError, match=r"^study: ") as raised:
                study_of(changed)
            assert len(str(raised.value)) < 2000, (place, name)


def _ranged(**more: Any) -> dict[str, Any]:
    return {"sweep": {"law.normal": {"from": 0.1, "to": 0.2, "points": 3} | more}}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (_ranged(scale=np.array([1, 2])), r"sweep\.law\.normal\.scale = .*: must be 'linear' or 'log'"),
        (
            {"sweep": {"law.normal": [0.1], "design": np.array([1, 2])}},
            r"sweep\.design = .*: must be 'grid' or 'latin-hypercube' or 'sobol'",
        ),
        ({"run": 3}, r"run = 3: must be a table \[run\]"),
        ({"run": {"seed": np.inf}}, r"run\.seed = inf: must be a whole number in \[0, "),
        ({"run": {"seed": "x"}}, r"run\.seed = 'x': must be a whole number in \[0, "),
        (
            {"statistics": {"restitution_bins": {"from": False, "to": True, "bins": True}}},
            r"statistics\.restitution_bins\.bins = True: must be a whole number >= 1",
        ),
        (
            {"statistics": {"restitution_bins": {"from": "a", "to": 1.0, "bins": 3}}},
            r"statistics\.restitution_bins = \{.*'a'.*: must be \(low, high\) with low < high",
        ),
        (
            {"statistics": {"restitution_bins": {"from": 10**400, "to": 1.0, "bins": 3}}},
            r"statistics\.restitution_bins = \{.*1000.*: must be \(low, high\)",
        ),
    ],
)
def test_what_is_said(change: dict[str, Any], told: str) -> None:
    """The key, the value, if need be in few words, and what is allowed."""
    with pytest.raises(ValueError, match=rf"^study: {told}"):
        study_of(TINY | change)


# What TOML has.
WRITTEN: tuple[Any, ...] = (
    *(True, -1, 10**400, math.nan, math.inf, 1.7e308, 5e-324, "", "nan %"),
    *(datetime.date(2020, 1, 1), datetime.datetime(2020, 1, 1)),
    *([], [1.0, 1.0], [True], [10**400], [[0.0, 1.0]], [{"a": 1}], [math.nan], [-1.7e308, 1.7e308]),
    *({}, {"a": 1}, {"from": "a", "to": 1, "points": 3}),
)


def test_every_hostile_value_at_every_place_of_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lines that begin with the name of the file, or a study; a third of the values at each place.

    Every 40th goes to the command, too.
    """
    monkeypatch.setattr("restitution.study.estimate", lambda *_: "good")
    path = tmp_path / "study.toml"
    asked = 0
    for i, (kind, place) in enumerate(PLACES):
        tables = MAKERS[kind]()
        if "measure" in tables:
            tables["measure"]["function"] = "math:sin"
        for value in WRITTEN[i % 3 :: 3]:
            path.write_text(_toml(_with(tables, place, value)), encoding="utf-8")
            here = (place, value.bit_length() if isinstance(value, int) else value)
            lines = []
            try:
                assert study_of(path).digest
            except ValueError as error:
                lines = str(error).splitlines()
                assert lines, here
                assert all(line.startswith(f"{path}: ") for line in lines), (*here, lines)
            asked += 1
            if asked % 40 == 0:
                result = invoke("sweep", path, "--out", tmp_path / "s.zarr", "--dry-run")
                assert result.exit_code == (2 if lines else 0), (*here, result.exception)
                assert len(result.stderr.splitlines()) == len(lines), here


def _at(tables: Any, place: Place) -> Any:
    for key in place:
        tables = tables[key]
    return tables


def _toml(tables: dict[str, Any]) -> str:
    return "\n".join(f"{_word(key)} = {_written(value)}" for key, value in tables.items())


def _written(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_word(key)} = {_written(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and value >= 0:
        return hex(value)
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return _word(value) if isinstance(value, str) else repr(value)


def _word(text: str) -> str:
    return f'"{text}"'
