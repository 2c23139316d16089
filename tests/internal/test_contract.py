"""The contract of every public function: our error, which names the argument, or a right answer, in time."""

import contextlib
import inspect
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.contract import CALLS, WORKINGS, arguments, attack, judged, public
from reference.hostile import VALUES


def test_every_public_function_is_in_the_catalogue() -> None:
    """With all its arguments, which are those that its signature has; and none that is no more."""
    found = dict(public())
    assert set(found) - WORKINGS == set(CALLS)
    for name, function in found.items():
        if name in CALLS:
            own = inspect.signature(CALLS[name][0]).parameters.values()
            if all(one.kind is not one.VAR_KEYWORD for one in own):
                needed = {
                    one.name
                    for one in inspect.signature(function).parameters.values()
                    if one.name != "self" and one.kind is not one.VAR_KEYWORD
                }
                assert needed <= {one.name for one in own} or needed <= set(arguments(name)), name


def test_the_catalogue_is_right_as_it_stands() -> None:
    """What is not attacked passes: an error then comes from the attack."""
    for name in ("simulate", "reduce", "fit.laplace", "flight.restitution", "figures.line", "study.status"):
        function, make = CALLS[name]
        function(**make())


@pytest.mark.parametrize(
    ("text", "good"),
    [
        ("radius = nan: must be > 0", True),
        ("radius = inf: must be > 0", False),
        ("separation = 1.0: must be > 0", False),
        ("separation = 1.0, radius = nan: must be such that", True),
        ("the radius must be > 0", False),
        ("radius: missing", True),
    ],
)
def test_the_judge(text: str, good: bool) -> None:
    """Another argument's name, or another value than was given, is found out."""
    assert (judged("Dumbbell", text, "radius", float("nan")) is None) == good


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Some of the values are names of files that can be written."""
    with contextlib.chdir(tmp_path_factory.mktemp("hostile")):
        yield


@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
@pytest.mark.parametrize("name", list(CALLS))
@settings(max_examples=10)
@given(st.data())
def test_a_hostile_argument(elsewhere: None, name: str, data: st.DataObject) -> None:
    """Drawn from the catalogue; `make hostile` goes through all of it."""
    if not arguments(name):
        return
    argument = data.draw(st.sampled_from(arguments(name)))
    value = data.draw(st.sampled_from(list(VALUES)))
    assert attack(name, argument, VALUES[value]()) is None


TESTS = Path(__file__).parents[1]


def test_harmed_files_and_random_tables() -> None:
    """An error of ours that names the file or the argument, or a right result; never an abort or a hang."""
    if sys.platform == "win32":
        pytest.skip("no process can be forked")
    words = [
        sys.executable,
        str(TESTS / "manual" / "fuzz.py"),
        "--every",
        "3",
    ]  # make hostile: all
    env = os.environ | {"PYTHONPATH": str(TESTS), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=900, env=env)
    assert (done.returncode, done.stderr) == (0, ""), done.stdout
