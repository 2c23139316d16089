"""Options of every command with values that nobody can mean: refused by name, before anything is written."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer.main

from reference.command import invoke
from reference.commands import COMMANDS, inputs
from restitution.cli import app

NEVER = {
    "nothing": "",
    "a blank": " ",
    "nan": "nan",
    "-inf": "-inf",
    "-1e400": "-1e400",
    "words": "None",
    "hexadecimal": "0x10",
    "a comma": "1,5",
    "5000 digits": "9" * 5000,
    "escapes": "\x1b[31m1",
    "markup": "[bold]1[/bold",
    "two lines": "1\n2",
    "not UTF-8": "1\udcff",
    "a null": "1\\0",
}
"""Texts that are no numbers."""
NUMBERS = {"N", "S", "D", "M", "H", "G", "T", "LOW HIGH"}
"""Names of numbers in help."""
INFINITE = ("-inf", "-1e400", "5000 digits")
ENDS = {"velocity"}
"""Of a window, which may lie at infinity."""


def numeric() -> Iterator[tuple[str, Any]]:
    """Yield every option that takes a number, or two, with its command."""
    group: Any = typer.main.get_command(app)
    for name, command in group.commands.items():
        below = getattr(command, "commands", None)
        for words, one in {f"{name} {key}": one for key, one in (below or {"": command}).items()}.items():
            for option in one.params:
                if option.metavar in NUMBERS:
                    yield words.strip(), option


CASES = list(numeric())


def test_all_of_them_are_found() -> None:
    assert {words.split()[0] for words, _ in CASES} == set(COMMANDS) - {
        "template", "version", "help", "sweep merge", "sweep status",
    }  # fmt: skip
    assert len(CASES) > 30


@pytest.mark.parametrize(("words", "option"), CASES, ids=[f"{words} {one.opts[0]}" for words, one in CASES])
def test_no_number(words: str, option: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    known = {"sweep run": "sweep", "sweep merge": "sweep merge"}
    given = COMMANDS[known.get(words, words)][0].split()
    for word in given:
        if (inputs() / word).is_file():
            (tmp_path / word).symlink_to(inputs() / word)
    before = sorted(tmp_path.iterdir())
    first = option.opts[0]
    if first in given:
        at = given.index(first)
        del given[at : at + 1 + option.nargs]
    for name, value in NEVER.items():
        if name in INFINITE and first.removeprefix("--") in ENDS:
            continue
        pair = ["0.5"] if option.nargs == 2 else []
        done = invoke(*given, first, value, *pair)
        text = done.output.replace("\n", " ")
        assert done.exit_code == 2, (name, text)
        named = {first, first.removeprefix("--"), first.removeprefix("--").replace("-", "_"), option.name}
        assert any(one in text for one in named), (name, text)
        # Typer before 0.20 repeats the word, and frames each line of it.
        assert len(text) < 3000 + 2 * len(value)
        assert sorted(tmp_path.iterdir()) == before, name
