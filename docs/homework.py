"""The questions of the lecturers' tutorial without their answers.

`python docs/homework.py` makes docs/homework.md of docs/tutorial-lecturer.md. An answer is the slanted text
after a question, and a cell with the tag `answer`.
"""

import re
from pathlib import Path

HERE = Path(__file__).parent
SOURCE, PAGE = HERE / "tutorial-lecturer.md", HERE / "homework.md"
_PART = re.compile(r"^## Thirty minutes in Python\n(.*?)^## ", re.DOTALL | re.MULTILINE)
_ANSWER = re.compile(r"^(\*\*Question\.\*\* .*?) \*[^*]+\*$", re.DOTALL | re.MULTILINE)
_CELL = re.compile(r"^```\{code-cell\}\n:tags: \[answer\]\n.*?^```\n\n?", re.DOTALL | re.MULTILINE)
_HEAD = """---
file_format: mystnb
kernelspec: {name: python3, display_name: Python 3}
---

<!-- python docs/homework.py makes this page from tutorial-lecturer.md -->

# Homework: a thousand dumbbells

*A notebook: {nb-download}`homework.ipynb`.*
"""


def without_answers(text: str) -> str:
    """Make the page of the tutorial's text."""
    part = _PART.search(text)
    if part is None:
        raise ValueError(f"{SOURCE.name}: has no part in Python")
    questions = _ANSWER.sub(r"\1\n\n*Your answer:*", _CELL.sub("", part[1]))
    return f"{_HEAD}\n{questions.strip().replace('### ', '## ')}\n"


if __name__ == "__main__":
    PAGE.write_text(without_answers(SOURCE.read_text(encoding="utf-8")), encoding="utf-8")
