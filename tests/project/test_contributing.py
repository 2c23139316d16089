"""CONTRIBUTING.md names the files that a further law, body or material takes; a run is declared once."""

import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest

import restitution as rs
from restitution import bodies, laws
from restitution.drop.release import Axis, Orientation
from restitution.drop.run import Run
from restitution.drop.toml import _KINDS
from restitution.laws._laws import Hypothesis

ROOT = Path(__file__).parents[2]
SOURCES = [
    path
    for folder in ("crates/core/src", "crates/python/src", "python/restitution")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in (".rs", ".py", ".pyi")
]


def snake(name: str) -> str:
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def knowing(names: list[str]) -> set[str]:
    """The source files in which every one of these is named."""
    patterns = [re.compile(rf"\b({name}|{snake(name)}|{snake(name).upper()})\b") for name in names]
    texts = {path: path.read_text(encoding="utf-8") for path in SOURCES}
    known = [path for path, text in texts.items() if all(pattern.search(text) for pattern in patterns)]
    return {str(path.relative_to(ROOT)) for path in known}


COLUMNS = [
    pytest.param(1, laws.KINDS, id="law"),
    pytest.param(2, bodies.KINDS, id="body"),
    pytest.param(3, [kind for kind in bodies.RIGID if kind.entry()], id="rigid body"),
    pytest.param(4, laws.MATERIALS, id="material"),
]
CHOSEN = {
    "python/restitution/figures/laws/_measure.py",
    "python/restitution/experiment/inference/_family.py",
}
"""Files that compare some laws, or infer a parameter of some materials; they need no further one."""


@pytest.mark.parametrize(("column", "kinds"), COLUMNS)
def test_each_takes_the_files_of_the_table(column: int, kinds: tuple[type, ...]) -> None:
    """A file that names all laws would need the next one, too. Each has a file of its own on either side."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("## A new law, body or material")[1]
    rows = [row.split("|") for row in text.splitlines() if "`" in row and row.startswith("|")]
    core, name_core, package, name_package, public = (row[column + 1].strip(" `") for row in rows)
    listed = {name_core, name_package, public} | ({package} if package.endswith(".py") else set())
    listed |= {"crates/core/src/shape/mod.rs"} if column == 2 else set()  # where all bodies are entered
    assert knowing([kind.__name__ for kind in kinds]) - CHOSEN == listed
    entered = r"(pub struct ({0}|Points)\b.*KIND\b|BodyKind::Rigid).*\"{0}\""
    for place, declared in ((core, entered), (package, r"class {0}\(")):
        for kind in kinds:
            pattern = re.compile(declared.format(kind.__name__), re.DOTALL)
            here = [path for path in SOURCES if str(path.relative_to(ROOT)).startswith(place)]
            assert sum(bool(pattern.search(path.read_text(encoding="utf-8"))) for path in here) == 1


def test_every_kind_is_entered() -> None:
    """All classes of laws, bodies and materials can be chosen in a file, under their own names."""
    families: tuple[tuple[Any, tuple[Any, ...]], ...] = (
        (laws.Law, laws.KINDS),
        (bodies.Body, bodies.KINDS),
        (bodies.RigidBody, bodies.RIGID),
        (laws.Tabulated.__base__, laws.MATERIALS),
    )

    def ends(base: Any) -> set[type]:
        return {end for one in base.__subclasses__() for end in ends(one) or {one}}

    for base, kinds in families:
        assert ends(base) == set(kinds)
        assert {kind.__name__ for kind in kinds} <= set(rs.__all__)
    every = (*bodies.KINDS, *bodies.RIGID)
    for place, kinds in (("body", every), ("law", laws.KINDS), ("normal", laws.MATERIALS)):
        assert list(_KINDS[place][1]) == [snake(kind.__name__).replace("_", "-") for kind in kinds]


@pytest.mark.parametrize("function", [rs.simulate, rs.statistics, rs.FluctuatingRestitution.learn])
def test_a_run_is_asked_for_alike_everywhere(function: Callable[..., Any]) -> None:
    """Each call has the parameters of `Run`, in its order, with its defaults; None stands for no motion.

    `learn` follows more particles, and chooses for itself from which heights and how far.
    """
    found = inspect.signature(function).parameters
    assert [name for name in found if name in Run.model_fields] == list(Run.model_fields)
    own: dict[str, int | None] = {}
    if function == rs.FluctuatingRestitution.learn:
        own = {"particles": 20_000, "impacts": None, "release_height": None, "minimum_speed": None}
    for name, field in Run.model_fields.items():
        default = found[name].default
        if field.is_required():
            assert default is inspect.Parameter.empty
        elif name in own:
            assert default == own[name]
        elif default is None:
            np.testing.assert_array_equal(field.default, (0.0, 0.0, 0.0))
        else:
            assert default == field.default


def test_names_in_annotations_are_the_cores() -> None:
    """What a type checker allows is what the core knows; it refuses others with the list of these."""
    run = Run(body=rs.Spheroid(equatorial=1e-3, polar=2e-3), law=rs.Frictionless(normal=0.9)).parameters()
    spin = {"low": 0.0, "high": 1.0, "axis": "upwards"}
    for changed, names in (
        ({"orientation": "upright"}, get_args(Orientation)),
        ({"spin": spin}, [axis for axis in get_args(Axis) if axis != "thermal"]),  # a law of its own there
    ):
        with pytest.raises(ValueError, match=r"upright|upwards") as caught:
            rs._core.simulate(run | changed, 1, None)
        assert caught.value.allowed == " or ".join(map(repr, names))  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="hypothesis = 'routh'") as caught:
        rs._core.law("Coulomb", 0.5, [0.1, "routh"])
    assert caught.value.allowed == " or ".join(map(repr, get_args(Hypothesis)))  # type: ignore[attr-defined]
    assert (caught.value.name, caught.value.value) == ("hypothesis", "routh")  # type: ignore[attr-defined]


def test_the_glossary_is_of_names_in_the_core() -> None:
    """Every name of ARCHITECTURE.md's glossary is an identifier of the core."""
    section = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8").split("### Glossary of the core")[1]
    section = section.split("\n###")[0]
    names = re.findall(r"`(\w+)`", "".join(row.split("|")[1] for row in section.splitlines() if "|" in row))
    source = "".join(path.read_text(encoding="utf-8") for path in SOURCES if path.suffix == ".rs")
    assert 0 < section.count("\n| `") <= 5  # for the rest the field has words
    assert [name for name in names if not re.search(rf"\b{name}\b", source)] == []
