"""The page of names has every public name."""

import re
from operator import attrgetter
from pathlib import Path
from types import ModuleType

import pytest

import restitution as rs

DOCS = Path(__file__).parents[2] / "docs"
MODULES = ["analytic", "pair", "gas", "gas.theory", "fit", "flight", "sound", "study", "figures"]
PAGE = (DOCS / "names.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("module", ["restitution", *MODULES])
def test_every_public_name_is_on_the_page(module: str) -> None:
    listed = set(re.findall(r"`([A-Za-z_]\w*)`", PAGE))
    names = set(rs.__all__ if module == "restitution" else attrgetter(module)(rs).__all__)
    assert names <= listed


@pytest.mark.parametrize("module", ["", *MODULES])
def test_every_public_name_is_in_the_api(module: str) -> None:
    """The pages made from docstrings: docs/api.md lists the names of a module below its name."""
    text = (DOCS / "api.md").read_text(encoding="utf-8")
    space = attrgetter(module)(rs) if module else rs
    blocks = re.findall(
        rf"currentmodule:: {re.escape(space.__name__)}\n(.*?)^```", text, re.DOTALL | re.MULTILINE
    )
    listed = sorted(re.findall(r"^   (\w+)$", "".join(blocks), re.MULTILINE))
    public = [name for name in space.__all__ if not isinstance(getattr(space, name), ModuleType)]
    assert listed == sorted(public)


def test_a_type_of_the_core_has_a_name_of_its_own() -> None:
    """One word, one thing: types that a file defines, public or not; associated types are not counted."""
    core = DOCS.parent / "crates/core/src"
    item = re.compile(r"^(?:pub(?:\([a-z]+\))? )?(?:struct|enum|trait|type|union) ([A-Z]\w*)", re.MULTILINE)
    names = [name for path in core.rglob("*.rs") for name in item.findall(path.read_text(encoding="utf-8"))]
    assert {name for name in names if names.count(name) > 1} == set()
