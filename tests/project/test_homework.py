"""The homework is the lecturers' tutorial without its answers: docs/homework.py."""

import re
import runpy
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt

DOCS = Path(__file__).parents[2] / "docs"
HOMEWORK: dict[str, Any] = runpy.run_path(str(DOCS / "homework.py"))
TUTORIAL, PAGE = (HOMEWORK[name].read_text(encoding="utf-8") for name in ("SOURCE", "PAGE"))


def test_the_page_is_of_this_tutorial() -> None:
    assert HOMEWORK["without_answers"](TUTORIAL) == PAGE, "python docs/homework.py makes it anew"


def test_all_questions_and_no_answer() -> None:
    """Every question of the tutorial is there; of the words in asterisks after it, and of its cells, none."""
    found = re.findall(r"^\*\*Question\.\*\* (.*?) \*([^*]+)\*$", TUTORIAL, re.DOTALL | re.MULTILINE)
    assert len(found) == TUTORIAL.count("**Question.**") == PAGE.count("**Question.**") == 5
    assert PAGE.count("*Your answer:*") == len(found)
    for question, answer in found:
        assert question in PAGE
        assert answer not in PAGE
    assert TUTORIAL.count(":tags: [answer]") == 2
    assert ":tags:" not in PAGE
    assert not re.search(r"0\.33|1/3", PAGE)


def test_its_cells_run() -> None:
    """From first to last, without those that were left out."""
    found: dict[str, Any] = {}
    for cell in re.findall(r"^```\{code-cell\}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE):
        exec(cell, found)
    assert found["data"].sizes == {"particle": 1000, "impact": 100}
    assert abs(float(found["tilted"].restitution.values[0, 0]) - found["by_hand"]) < 1e-14
    plt.close("all")
