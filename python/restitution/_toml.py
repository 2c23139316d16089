"""Runs written down as TOML files: the tables ``[body]``, ``[law]`` and ``[run]``, with ``[run.spin]``."""

import tomllib
from pathlib import Path
from typing import Any, TypeVar

from restitution._parameters import ParameterError, Parameters, Problem, unknown, wrong
from restitution._release import RandomSpin
from restitution._run import Run
from restitution.bodies import Dumbbell, LoadedSphere, Spherocylinder, Spheroid
from restitution.laws import (
    ChatterjeeRuina,
    Coulomb,
    Frictionless,
    Plastic,
    Tabulated,
    TangentialRestitution,
    Viscoelastic,
)

# Table: the key that chooses a kind of body, law or material, and the kinds there are.
_KINDS: dict[str, tuple[str, dict[str, type[Parameters]]]] = {
    "body": (
        "shape",
        {
            "dumbbell": Dumbbell,
            "loaded-sphere": LoadedSphere,
            "spherocylinder": Spherocylinder,
            "spheroid": Spheroid,
        },
    ),
    "law": (
        "type",
        {
            "tangential-restitution": TangentialRestitution,
            "frictionless": Frictionless,
            "coulomb": Coulomb,
            "chatterjee-ruina": ChatterjeeRuina,
        },
    ),
    # A table [law.normal]; a number stands for itself.
    "normal": ("type", {"viscoelastic": Viscoelastic, "plastic": Plastic, "tabulated": Tabulated}),
}
_PARTS = ("body", "law")
_TABLES = (*_PARTS, "run")

P = TypeVar("P", bound=Parameters)


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
    with path.open("rb") as file:
        try:
            tables = tomllib.load(file)
        except ValueError as error:  # wrong syntax, or not UTF-8
            raise ValueError(f"{path}: not a TOML file: {error}") from None
    reader = _Reader(tables)
    parts = {name: reader.chosen(name, reader.table(name)) for name in _PARTS}
    table = reader.table("run")
    if isinstance(table.get("spin"), dict):
        parts["spin"] = reader.made("run.spin", RandomSpin, table["spin"], {})
    run = reader.made("run", Run, table, parts)
    if reader.problems or run is None:
        raise ValueError("\n".join(f"{path}: {problem}" for problem in reader.problems))
    return run


class _Reader:
    """The tables of a file and everything that is wrong with them."""

    def __init__(self, tables: dict[str, Any]) -> None:
        self.tables = tables
        self.problems = [unknown(name, "the file", _TABLES) for name in tables if name not in _TABLES]

    def chosen(self, name: str, table: dict[str, Any]) -> Parameters | None:
        """Make the body, the law or the material, of the kind that its table asks for."""
        selector, kinds = _KINDS[name.rpartition(".")[2]]
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
        fields = [field for field in kind.model_fields if field not in _PARTS]
        keys = [*selector, *fields]
        strangers = (key for key in table if key not in keys)
        self.problems.extend(unknown(key, f"[{name}]", keys, prefix=f"{name}.") for key in strangers)
        values = {field: table[field] for field in fields if field in table}
        good = {
            field: part for field, part in parts.items() if part is not None and field in kind.model_fields
        }
        bad = parts.keys() - good.keys()
        try:
            return kind(**{key: value for key, value in (values | good).items() if key not in bad})
        except ParameterError as error:
            # A part that is missing has been reported already.
            found = (Problem(f"{name}.{key}", text) for key, text in error.problems if key not in bad)
            self.problems.extend(found)
            return None

    def table(self, name: str) -> dict[str, Any]:
        """Return a table of the file, empty if there is none."""
        table = self.tables.get(name, {})
        if isinstance(table, dict):
            return table
        self.problems.append(wrong(name, table, f"a table [{name}]"))
        return {}
