"""Whole numbers of more digits than Python writes, wherever they stand in what is given."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import restitution as rs
from reference.refused import message
from restitution.drop.toml import read

ENDLESS = 10**5000
BITS = f"an integer of {ENDLESS.bit_length()} bits"
BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
BINS: dict[str, Any] = {"velocity_bins": [0.0, 2.0], "restitution_bins": [-1.0, 3.0]}

CALLS: list[tuple[Callable[[Any], object], str]] = [
    (lambda x: rs.Frictionless(normal=x), "normal"),
    (lambda x: rs.Dumbbell(radius=x, separation=0.0), "radius"),
    (lambda x: rs.RandomSpin(rate=x), "rate"),
    *(
        (lambda x, name=name: rs.simulate(BODY, LAW, **{name: x}), name)
        for name in ("particles", "release_height", "orientation", "spin", "release_velocity", "seed")
    ),
    (lambda x: rs.statistics(BODY, LAW, **BINS | {"velocity_bins": x}), "velocity_bins"),
]


@pytest.mark.parametrize(("call", "name"), CALLS, ids=[name for _, name in CALLS])
@pytest.mark.parametrize(
    ("given", "shown"),
    [([ENDLESS], f"[{BITS}]"), ({"a": -ENDLESS}, f"{{'a': {BITS}}}"), ((ENDLESS,), f"({BITS},)")],
)
def test_inside_what_is_given(call: Callable[[Any], object], name: str, given: Any, shown: str) -> None:
    assert message(lambda: call(given)).startswith(f"{name} = {shown}: must be ")


def test_alone() -> None:
    assert message(lambda: rs.RandomSpin(rate=ENDLESS)).startswith(f"rate = {BITS}: must be ")
    text = message(lambda: rs.statistics(BODY, LAW, **BINS | {"velocity_bins": ENDLESS}))
    assert text == f"velocity_range: missing; velocity_bins = {BITS} needs a range (low, high)"


class Failing(list[float]):
    """A list that cannot be gone through."""

    def __iter__(self) -> Any:
        raise ValueError("not again")


def test_an_error_of_the_object_itself() -> None:
    """It is no error of the core, which has a name and a value."""
    with pytest.raises(ValueError, match=r"^rate = .*: must be a finite number >= 0"):
        rs.RandomSpin(rate=Failing([1.0, 2.0]))


@pytest.mark.parametrize("line", ["law.normal", "run.orientation", "run.spin", "run.release_velocity"])
def test_in_a_file(tmp_path: Path, line: str) -> None:
    """TOML's hexadecimal numbers have any length, its decimal ones do not."""
    table, _, key = line.partition(".")
    tables = {"body": "shape = 'dumbbell'\nradius = 3e-3\nseparation = 3e-4", "law": "type = 'frictionless'"}
    if key != "normal":
        tables["law"] += "\nnormal = 0.9"
    tables[table] = f"{tables.get(table, '')}\n{key} = [0x{'f' * 5000}]"
    file = tmp_path / "run.toml"
    file.write_text("".join(f"[{name}]\n{text}\n" for name, text in tables.items()), encoding="utf-8")
    assert f"{line} = [an integer of 20000 bits]: must be " in message(lambda: read(file))
