"""Runs written down as TOML files: bodies, laws, the run, and how to count it or learn from it."""

import re
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from inspect import signature
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from restitution import bodies, laws
from restitution._internal.described import kebab
from restitution._internal.files import content
from restitution._internal.parameters import ParameterError, Parameters, Problem, unknown, wrong
from restitution.drop.release import RandomHeight, RandomSpin
from restitution.drop.run import Run


def _by_name(kinds: Iterable[type[Parameters]]) -> dict[str, type[Parameters]]:
    return {kebab(kind.__name__): kind for kind in kinds}


_BODY = ("shape", _by_name((*bodies.KINDS, *bodies.RIGID)))
# Table: the key that chooses a kind of body, law or material, and the kinds there are.
_KINDS: dict[str, tuple[str, dict[str, type[Parameters]]]] = {
    "body": _BODY,
    "other": _BODY,
    "law": ("type", _by_name(laws.KINDS)),
    "normal": ("type", _by_name(laws.MATERIALS)),  # a table [law.normal]; a number stands for itself
}
_PARTS = ("body", "law")
_TABLES = (*_PARTS, "run", "statistics", "distribution")
COUNTING = (
    "velocity_bins",
    "velocity_range",
    "restitution_bins",
    "restitution_range",
    "fraction_bins",
    "fraction_range",
    "counts_only",
)
_ALLOWED = {"normal": "a real number in [0, 1] or a table [law.normal]"}
"""Values that a file may hold for a parameter where a call takes an object."""
_LEARNING = ("velocities", "given", "release_height", "heights_about")

P = TypeVar("P", bound=Parameters)
_NESTED = re.compile(rb"(?:[\[{]\s*){100}")


def read(path: Path) -> Run:
    """Read the parameters of a run from a TOML file.

    Raises
    ------
    ValueError
        If the file is not TOML, or if keys are unknown, missing or out of range: a line for each, with the
        name of the file, the key, its value and what is allowed.
    OSError
        If the file cannot be read.
    """
    run = run_of(tables_in(path), str(path))
    run.warn_of_units()
    return run


@dataclass(frozen=True)
class Asked:
    """The content of a file: bodies and laws by name, and the arguments of the calls."""

    bodies: dict[str, Any]  # of a table [body], or of tables [[body]] with a name each
    laws: dict[str, Any]
    run: dict[str, Any]  # checked; the others as they stand in the tables
    statistics: dict[str, Any]
    distribution: dict[str, Any]


def read_all(path: Path, *, single: bool = False) -> Asked:
    """Read what is to be counted, compared or learned; `single` refuses more than one body or law."""
    reader = Reader(tables_in(path))
    bodies, laws = (reader.several(name, single=single) for name in _PARTS)
    for body, law in product(bodies.values(), laws.values()):
        reader.run({"body": body, "law": law})
    run = dict(reader.table("run"))
    run |= reader.random(run)
    tables = {}
    for name, keys in (("statistics", COUNTING), ("distribution", _LEARNING)):
        tables[name] = reader.table(name)
        reader.only(name, tables[name], keys)
    reader.finish(str(path))
    return Asked(bodies, laws, run, **tables)


def tables_in(path: Path) -> dict[str, Any]:
    """Read the tables of a TOML file."""
    text = content(path)
    try:
        if _NESTED.search(text):  # which the parser recurses into
            raise ValueError("lists or tables nested too deeply")
        tables = tomllib.loads(text.decode())
    except (ValueError, RecursionError) as error:  # wrong syntax, or not UTF-8
        raise ValueError(f"{path}: not a TOML file: {error}") from None
    body = tables.get("body")
    for table in [*(body if isinstance(body, list) else [body]), tables.get("other")]:
        if isinstance(table, dict) and isinstance(table.get("file"), str):
            table["file"] = str(path.parent / table["file"])
    return tables


def run_of(tables: dict[str, Any], source: str) -> Run:
    """Make a run of the tables of a file; errors begin with `source`."""
    reader = Reader(tables)
    run = reader.run({name: reader.chosen(name, reader.table(name)) for name in _PARTS})
    reader.finish(source)
    assert run is not None
    return run


def bodies_of(tables: list[Any], source: str) -> dict[str, Any]:
    """Make the bodies of several tables [[body]], by their names; errors begin with `source`."""
    reader = Reader({"body": tables})
    found = reader.several("body", single=False)
    reader.finish(source)
    return found


def tables_of(run: Run) -> dict[str, Any]:
    """Write a run down as the tables of a file, complete, of plain values."""
    fields = {name: _plain(getattr(run, name)) for name in type(run).model_fields if name not in _PARTS}
    return {**{name: table_of(getattr(run, name)) for name in _PARTS}, "run": fields}


def table_of(parameters: Parameters) -> dict[str, Any]:
    """Write a body, a law or a material down as a table."""
    if isinstance(parameters, laws.CustomLaw):
        raise ParameterError(Problem("law", f" = {parameters!r}: a function cannot be written to a file"))
    every = {name: getattr(parameters, name) for name in type(parameters).model_fields}
    fields = {name: _plain(value) for name, value in every.items() if value is not None}
    own = kebab(type(parameters).__name__)
    return {selector: own for selector, kinds in _KINDS.values() if own in kinds} | fields


def _plain(value: Any) -> Any:
    if isinstance(value, Parameters):
        return table_of(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value


class Reader:
    """The tables of a file and everything that is wrong with them."""

    def __init__(self, tables: dict[str, Any], allowed: Sequence[str] = _TABLES) -> None:
        self.tables = tables
        self.problems = [unknown(name, "the file", allowed) for name in tables if name not in allowed]

    def only(self, name: str, table: Iterable[str], keys: Sequence[str]) -> None:
        """Note the keys of a table that are none of these."""
        strangers = (key for key in table if key not in keys)
        self.problems.extend(unknown(key, f"[{name}]", keys, prefix=f"{name}.") for key in strangers)

    def finish(self, source: str) -> None:
        """Raise what is wrong, if anything is, each thing once."""
        if self.problems:
            raise ValueError("\n".join(f"{source}: {problem}" for problem in dict.fromkeys(self.problems)))

    def run(self, parts: dict[str, Parameters | None]) -> Run | None:
        """Make the run of a body and a law."""
        table = self.table("run")
        return self.made("run", Run, table, parts | self.random(table))

    def random(self, table: dict[str, Any]) -> dict[str, Any]:
        """Make what a run draws at random, where its table has tables for it."""
        kinds: dict[str, type[Parameters]] = {"release_height": RandomHeight, "spin": RandomSpin}
        return {
            name: self.made(f"run.{name}", kind, table[name], {})
            for name, kind in kinds.items()
            if isinstance(table.get(name), dict)
        }

    def several(self, name: str, *, single: bool) -> dict[str, Parameters | None]:
        """Make the bodies or the laws of all tables of a name, by their own names."""
        found = self.tables.get(name, {})
        tables = found if isinstance(found, list) else [self.table(name)]
        if single and len(tables) > 1:
            self.problems.append(Problem(name, f": {len(tables)} tables; must be one, [{name}]"))
        made: dict[str, Parameters | None] = {}
        for number, table in enumerate(tables, start=1):
            place = name if len(tables) == 1 else f"{name}[{number}]"
            if not isinstance(table, dict):
                self.problems.append(wrong(place, table, f"a table [{name}]"))
                continue
            own = {key: value for key, value in table.items() if key != "name"}
            title = table.get("name", f"{name} {number}" if len(tables) > 1 else name)
            if not isinstance(title, str) or title in made:
                self.problems.append(wrong(f"{place}.name", title, "a string, another one for each"))
                continue
            made[title] = self.chosen(place, own)
        return made

    def chosen(self, name: str, table: dict[str, Any]) -> Parameters | None:
        """Make the body, the law or the material, of the kind that its table asks for."""
        selector, kinds = _KINDS[name.rpartition(".")[2].partition("[")[0]]
        allowed = " or ".join(f'"{kind}"' for kind in kinds)
        if selector not in table:
            self.problems.append(Problem(f"{name}.{selector}", f": missing; must be {allowed}"))
            return None
        kind = table[selector]
        if not isinstance(kind, str) or kind not in kinds:
            self.problems.append(wrong(f"{name}.{selector}", kind, allowed))
            return None
        tables = {key: value for key, value in table.items() if key in _KINDS and isinstance(value, dict)}
        parts = {key: self.chosen(f"{name}.{key}", value) for key, value in tables.items()}
        return self.made(name, kinds[kind], table, parts, selector)

    def made(
        self,
        name: str,
        kind: type[P],
        table: dict[str, Any],
        parts: dict[str, Parameters | None],
        *selector: str,
    ) -> P | None:
        """Make one set of parameters from a table and the parts that have tables of their own."""
        make: Any = kind
        fields = [field for field in kind.model_fields if kind is not Run or field not in _PARTS]
        if "file" in table and hasattr(kind, "from_file"):  # a clump, points, a profile or a mesh
            make = make.from_file
            fields = [field.replace("path", "file") for field in signature(make).parameters]
        keys = [*selector, *fields]
        self.only(name, table, keys)
        values = {field: table[field] for field in fields if field in table}
        good = {
            field: part for field, part in parts.items() if part is not None and field in kind.model_fields
        }
        bad = parts.keys() - good.keys()
        try:
            given = {key: value for key, value in (values | good).items() if key not in bad}
            made: P = make(**{"path" if key == "file" else key: value for key, value in given.items()})
            return made
        except ParameterError as error:
            # A part that is missing has been reported already.
            found = (
                problem._replace(
                    name=f"{name}.{problem.name}",
                    allowed=problem.allowed and _ALLOWED.get(problem.name, problem.allowed),
                )
                for problem in error.problems
                if problem.name not in bad
            )
            self.problems.extend(found)
            return None

    def table(self, name: str) -> dict[str, Any]:
        """Return a table of the file, empty if there is none."""
        table = self.tables.get(name, {})
        if isinstance(table, dict):
            return table
        self.problems.append(wrong(name, table, f"a table [{name}]"))
        return {}
