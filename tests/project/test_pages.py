"""Tables and figures of the pages are what their commands make: docs/pages.py."""

import runpy
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
PAGES: dict[str, Any] = runpy.run_path(str(ROOT / "docs" / "pages.py"))


@pytest.mark.parametrize("name", PAGES["BLOCKS"])
@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
def test_no_page_is_stale(name: str) -> None:
    """Table, figures, sizes, and a small run of the same code have the digest that the page carries."""
    tables, stamp = PAGES["made"](name)
    assert PAGES["stamp"](name, tables) == stamp, f"docs/{name}.md is stale: python docs/pages.py {name}"


def test_a_changed_table_is_noticed() -> None:
    """One digit in another place is another digest."""
    tables, stamp = PAGES["made"]("shapes")
    assert PAGES["stamp"]("shapes", [*tables[:-1], tables[-1].replace("101", "102")]) != stamp


def test_pages_name_their_command() -> None:
    """A figure that docs/pages.py makes is shown in the page of its name, which says how to make it."""
    for name, block in PAGES["BLOCKS"].items():
        text = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
        assert f"`python docs/pages.py {name}`" in text
        for figure in block.figures:
            assert f"(images/{figure})" in text
