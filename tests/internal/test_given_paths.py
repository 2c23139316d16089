"""Paths that no file can have are refused by the name of their argument; what cannot be read is named."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import restitution as rs
from reference.refused import message
from restitution import figures, flight, sound, study
from restitution.experiment import listen
from restitution.experiment.listen._analysis import Setting

READERS: dict[str, tuple[str, Callable[[str], object]]] = {
    "load": ("path", rs.FluctuatingRestitution.load),
    "read": ("file", flight.read),
    "impacts": ("source", sound.impacts),
    "study_of": ("study", study.study_of),
    "analyse": ("file", lambda path: listen.analyse(Path(path), Setting(diameter=0.02))),
    "status": ("out", study.status),
    "open_store": ("path", lambda path: study.open_store(Path(path))),
    "learned": ("out", lambda path: study.learned(path, normal=0.9)),
    "save": ("name", lambda path: figures.save(figures.panels(3.0, 2.0)[0], path)),
}
EVERYWHERE = pytest.mark.parametrize(("name", "call"), READERS.values(), ids=READERS)


@EVERYWHERE
def test_half_a_character(name: str, call: Callable[[str], object]) -> None:
    """A lone surrogate is in no encoding of names; those that stand for single bytes are in that of Unix."""
    told = rf"^{name} = .*: must be the path of a file, without null characters or lone surrogates$"
    with pytest.raises(ValueError, match=told):
        call("\ud800")


@EVERYWHERE
@pytest.mark.parametrize("path", ["a" * 100_000, "a/" * 50_000], ids=["one name", "folders"])
def test_longer_than_any_path(name: str, call: Callable[[str], object], path: str) -> None:
    """The error does not repeat it."""
    text = message(lambda: call(path))
    assert text.startswith(f"{name} = ")
    assert ": must be the path of a file, of at most " in text
    assert len(text) < 240


@pytest.mark.skipif(sys.platform != "linux", reason="a file of Linux that opens and cannot be read")
@pytest.mark.parametrize("call", [flight.read, study.study_of])
def test_a_file_that_opens_and_cannot_be_read(call: Callable[[str], object]) -> None:
    """Python's own error of a read names no file."""
    with pytest.raises(OSError, match="Input/output error") as caught:
        call("/proc/self/mem")
    assert caught.value.filename == "/proc/self/mem"


@pytest.mark.parametrize("name", ["/", "..", "none/.."])
def test_a_figure_without_a_name(name: str) -> None:
    """There is nothing that an ending could be put to."""
    text = message(lambda: figures.save(figures.panels(3.0, 2.0)[0], name))
    assert text.startswith(f"name = {name!r}: must be the name of a figure")


@pytest.mark.parametrize("argument", ["title", "caption"])
def test_half_a_character_in_the_words_of_a_figure(tmp_path: Path, argument: str) -> None:
    """Refused before a file is written."""
    given: dict[str, Any] = {argument: "a \ud800"}
    text = message(lambda: figures.save(figures.panels(3.0, 2.0)[0], tmp_path / "figure", **given))
    assert text == f"{argument} = 'a \\ud800': must be text, without lone surrogates"
    assert not list(tmp_path.iterdir())
