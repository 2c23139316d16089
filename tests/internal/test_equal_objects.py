"""Results that hold Datasets, trees and SciPy's distributions: equal where they hold the same."""

import copy
import pickle
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from reference import measuring
from reference.contract import CALLS
from restitution import fit
from restitution._internal.datasets import Content, same
from restitution.experiment import listen
from restitution.experiment.listen._analysis import Setting
from restitution.fit._mixture import Mixture
from restitution.study import study_of

MIXED = np.concatenate(
    [np.random.default_rng(1).laplace(0.98, 0.01, 300), np.random.default_rng(2).normal(0.9, 0.1, 900)]
)


def mixture(samples: Any) -> Mixture:
    found = fit.cusp_mixture(samples, 0.98).distribution
    assert isinstance(found, Mixture)
    return found


def effort(**asked: float) -> Any:
    return study_of(measuring.study_tables() | {"effort": {"until": asked}}).effort


def pairs() -> Iterator[tuple[str, Any, Any]]:
    """Yield objects with others that differ in what their Datasets, trees and distributions hold."""
    analysis = measuring.heard()
    series = analysis.series[0]
    other = replace(series, data=series.data * 2)
    yield "Series", series, other
    yield "Analysis", analysis, replace(analysis, series=(other,))
    assert series.shape is not None
    draws = xr.DataTree.from_dict({"/posterior": xr.Dataset({"elongation": ("draw", [0.1, 0.2])})})
    inferred = replace(series.shape, draws=draws)
    yield "Shape", inferred, replace(inferred, draws=draws * 2)
    yield "a Shape without a posterior", replace(inferred, draws=None), inferred
    yield "Mixture", mixture(MIXED), mixture(MIXED + 0.001)
    yield "Effort", effort(std=0.1), effort(std=0.2)


PAIRS = list(pairs())


@pytest.mark.parametrize(("one", "other"), [pair[1:] for pair in PAIRS], ids=[pair[0] for pair in PAIRS])
def test_equal_is_what_holds_the_same(one: Any, other: Any) -> None:
    """Also after a journey, for a set, and where a Dataset's own truth value would say that all is well."""
    for again in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
        assert (again == one, again != one, hash(again) == hash(one)) == (True, False, True)
    assert (one == other, other == one, one != other) == (False, False, True)
    assert len({one, other, copy.deepcopy(one)}) == 2


def test_the_same_recording_gives_the_same_result() -> None:
    """Whenever it is analysed: a posterior does not tell when it was drawn."""
    again = listen.analyse(measuring.recording(), Setting(diameter=0.02))
    assert again.series[0].shape is not None
    assert again.series[0].shape.draws is not None
    assert again == measuring.heard()


@pytest.mark.parametrize(
    "part",
    [np.ones(2), xr.Dataset({"x": 1}), xr.DataTree(xr.Dataset({"x": 1})), {"x": 1}, (1,)],
    ids=lambda part: type(part).__name__,
)
def test_a_part_is_not_the_same_as_one_of_another_kind(part: Any) -> None:
    """Which compares number by number, to something without a truth value or one that is true."""
    for other in (None, 1.0, "x", [1, 1]):
        assert same(part, other) is False
        assert same(other, part) is False
    assert same(part, copy.deepcopy(part)) is True


def within(thing: Any, depth: int = 3) -> Iterator[Any]:
    """Yield the objects of ours that can be reached from one."""
    if isinstance(thing, list | tuple):
        for part in thing:
            yield from within(part, depth)
        return
    if not type(thing).__module__.startswith("restitution") or isinstance(thing, type):
        return
    yield thing
    for name in dir(thing) if depth else ():
        if not name.startswith("_") and not callable(getattr(thing, name, None)):
            yield from within(getattr(thing, name, None), depth - 1)


SLOW_ONES = {
    "explorer.page",
    "explorer.link",
    "explore",
    "explorer.serve",
    "laws.write",
    "paper.redraw",
}
"""Pages, and calls that a test ends."""


def test_everything_that_public_functions_return_compares(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Results, what is in them, and the arguments of this catalogue; a figure is equal to itself alone."""
    monkeypatch.chdir(tmp_path)  # some of the functions write files
    kinds: dict[type, Any] = {}
    for name, (function, make) in CALLS.items():
        if name in SLOW_ONES:
            continue
        given = make()
        for thing in (*given.values(), function(**make())):
            for found in within(thing):
                kinds.setdefault(type(found), found)
    assert sum(issubclass(kind, Content) for kind in kinds) > 12
    for kind, thing in kinds.items():
        if kind.__name__ == "_Displayed":
            continue
        for again in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing)):
            assert again == thing, kind
            assert hash(again) == hash(thing), kind
        assert thing != "another", kind
