"""Results pickle, copy, compare and hash by what they hold; files of Datasets say what is wrong with them."""

import copy
import json
import pickle
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, is_dataclass, replace
from functools import cache
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference import measuring
from reference.command import SERVER, Program
from reference.contract import CALLS
from restitution import fit
from restitution._internal.datasets import Content, same
from restitution._internal.parameters import Parameters
from restitution.analytic import first_impact
from restitution.fit import Counts
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
    recording = analysis.recordings[0]._replace(series=(other,))
    yield "Analysis", analysis, replace(analysis, recordings=(recording,))
    assert series.shape is not None
    draws = xr.DataTree.from_dict({"/posterior": xr.Dataset({"elongation": ("draw", [0.1, 0.2])})})
    inferred = replace(series.shape, draws=draws)
    yield "Shape", inferred, replace(inferred, draws=draws * 2)
    yield "a Shape without a posterior", replace(inferred, draws=None), inferred
    yield "Mixture", mixture(MIXED), mixture(MIXED + 0.001)
    yield "Effort", effort(std=0.1), effort(std=0.2)


def test_equal_is_what_holds_the_same() -> None:
    """Also after a journey, for a set, and where a Dataset's own truth value would say that all is well."""
    for name, one, other in pairs():
        for again in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
            assert (again == one, again != one, hash(again) == hash(one)) == (True, False, True), name
        assert (one == other, other == one, one != other) == (False, False, True), name
        assert len({one, other, copy.deepcopy(one)}) == 2, name


def test_the_same_recording_gives_the_same_result() -> None:
    """Whenever it is analysed: a posterior does not tell when it was drawn."""
    again = measuring.analysed()
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
    home = type(thing).__module__
    if isinstance(thing, type) or not home.startswith("restitution") or home.endswith("_core"):
        return
    yield thing
    for name in dir(thing) if depth else ():
        if not name.startswith("_") and not callable(getattr(thing, name, None)):
            yield from within(getattr(thing, name, None), depth - 1)


SLOW_ONES = {
    "figures.Film.save",
    "listen.analyse",
    "listen.write",
    "explorer.page",
    "explorer.link",
    "explore",
    "explorer.serve",
    "laws.write",
    "glielmo2014.redraw",
    "gunkelmann2014.redraw",
}
"""Pages, films, an analysis that is among the arguments of others, and calls that a test ends."""


def test_everything_that_public_functions_return_compares(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Results, what is in them, arguments of this catalogue; figures and films are equal to themselves."""
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
        if kind.__name__ in ("_Displayed", "Film"):  # equal to themselves alone
            continue
        for again in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing)):
            assert again == thing, kind
            assert hash(again) == hash(thing), kind
        assert thing != "another", kind


@cache
def objects() -> dict[str, Any]:
    """Make one of each kind that users get hold of."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    bodies = [
        body,
        rs.Dumbbell(radius=(3e-3, 2e-3), separation=3e-3, density=(1.0, 2.0)),
        rs.Spherocylinder(radius=1.0, separation=2.0),
        rs.Spheroid(equatorial=1.0, polar=2.0),
    ]
    glass = rs.Viscoelastic(
        young_modulus=6e10, poisson_ratio=0.22, dissipation=1e-7, density=2500.0, radius=3e-3
    )
    laws = [
        law,
        rs.Frictionless(normal=rs.Plastic(yield_speed=0.01)),
        rs.Coulomb(normal=glass, friction=0.3),
        rs.ChatterjeeRuina(normal=0.5, tangential=0.1, friction=0.3),
        rs.Coulomb(normal=rs.Tabulated(v=[0.1, 0.2], e=[0.9, 0.8]), friction=0.3),
    ]
    data = rs.simulate(body, law, particles=300, impacts=60)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.1, 1.2, 12),
        "restitution_bins": np.linspace(-1, 3, 401),
    }
    found = rs.statistics(body, law, particles=300, impacts=60, **bins)
    window = (0.5, 0.7)
    counts = Counts.at(found, 0.6)
    asymmetric, power = fit.asymmetric_laplace(data, velocity=window), fit.slopes(found)
    learned = rs.FluctuatingRestitution.from_statistics(
        rs.reduce(
            rs.simulate(body, law, particles=2000, impacts=20), np.linspace(0.7, 1, 4), np.linspace(-2, 3, 99)
        )
    )
    learned.pdf(1.0, 0.85)  # what it keeps for the next time does not travel
    families = ("gaussian", "laplace", "logistic", "student_t")
    things = [
        *bodies,
        *laws,
        glass,
        rs.RandomSpin(rate=(0.0, 1.0)),
        counts,
        asymmetric,
        fit.asymmetric_laplace(counts),
        fit.cusp_mixture(data, 0.9, velocity=window),
        *(getattr(fit, family)(data, velocity=window) for family in families),
        fit.bootstrap(fit.laplace, data, velocity=window, resamples=3),
        fit.goodness(fit.laplace, data, velocity=window, resamples=3),
        fit.compare(asymmetric, fit.laplace(data, velocity=window), data, velocity=window),
        power,
        power.power_law("above"),
        first_impact(body, law),
        first_impact(bodies[1], laws[3]),
        first_impact(bodies[3], laws[2], release_height=3.0, gravity=9.81),
        learned,
        learned.clamped(),
    ]
    return {f"{i} {type(thing).__name__}": thing for i, thing in enumerate(things)}


def test_an_object_travels() -> None:
    """By pickle and by copy, to one that is equal and has the same hash."""
    for name, thing in objects().items():
        for protocol in (2, pickle.HIGHEST_PROTOCOL):
            again = pickle.loads(pickle.dumps(thing, protocol))
            assert again == thing, name
            assert hash(again) == hash(thing), name
        assert copy.deepcopy(thing) == thing, name
        assert copy.copy(thing) == thing, name
        assert thing != name
        assert len({thing, copy.deepcopy(thing)}) == 1, name
        assert all(other != thing for other in objects().values() if other is not thing), name


def test_objects_come_back_from_a_process_pool() -> None:
    things = objects()
    with ProcessPoolExecutor(1, mp_context=SERVER) as pool:
        there_and_back = pool.map(itemgetter(0), [(thing,) for thing in things.values()])
        for name, again in zip(things, there_and_back, strict=True):
            assert again == things[name], name
    one = next(thing for thing in things.values() if isinstance(thing, Counts))
    with pytest.raises(ValueError, match="read-only"):
        one.count[0] = 1.0


def test_exceptions_travel(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """With what they carry."""
    data = rs.simulate(body, law, particles=2, impacts=2)
    stop = pickle.loads(pickle.dumps(rs.SimulationInterrupted(data)))
    assert stop.data.identical(data)
    assert "impacts so far" in str(stop)
    trouble = pickle.loads(pickle.dumps(rs.NumericalError("particle 3")))
    assert (type(trouble), str(trouble)) == (rs.NumericalError, "particle 3")


def of_another_version(thing: Any, change: Callable[[dict[str, Any]], object]) -> Any:
    """Make it anew of a state in which fields have been changed, as a pickle of another version has them."""
    made, arguments, state = thing.__reduce_ex__(pickle.HIGHEST_PROTOCOL)[:3]
    state = pickle.loads(pickle.dumps(state))
    change(state.get("__dict__", state))
    again = made(*arguments)
    again.__setstate__(state)
    return again


def without(field: str) -> Callable[[dict[str, Any]], object]:
    return lambda state: state.pop(field)


def fields_of(thing: Any) -> list[str]:
    kind = type(thing)
    if isinstance(thing, Parameters):
        return list(kind.model_fields)
    return [one.name for one in fields(kind)] if is_dataclass(kind) else ["data"]


def test_a_pickle_of_another_version() -> None:
    """With a field more or less: an error that names it, or what the default makes of one that is missing."""
    for name, thing in objects().items():
        with pytest.raises(ValueError, match=r"another|pickled by another version"):
            of_another_version(thing, lambda state: state.update(another=1))
        for field in fields_of(thing):
            default = type(thing).model_fields[field] if isinstance(thing, Parameters) else None
            if default is None or default.is_required():
                with pytest.raises(ValueError, match=field):
                    of_another_version(thing, without(field))
                continue
            again = of_another_version(thing, without(field))
            assert getattr(again, field) == default.default, name
        assert of_another_version(thing, lambda _: None) == thing, name


@pytest.mark.parametrize(
    ("name", "field", "bad", "told"),
    [
        ("Dumbbell", "radius", -1.0, "radius"),
        ("TangentialRestitution", "normal", float("nan"), "normal = nan"),
        ("Tabulated", "e", (2.0, 0.8), "e"),
        ("Counts", "count", np.array([-1.0]), "count"),
        ("FluctuatingRestitution", "data", 1, "data = 1"),
    ],
)
def test_a_pickle_whose_numbers_are_not_allowed(name: str, field: str, bad: Any, told: str) -> None:
    """As of a version with other bounds: it is checked as when it is made."""
    found: dict[str, Any] = {type(one).__name__: one for one in objects().values()}
    found["Tabulated"] = rs.Tabulated(v=[0.1, 0.2], e=[0.9, 0.8])
    with pytest.raises(ValueError, match=told):
        of_another_version(found[name], lambda state: state.update({field: bad}))


def test_the_error_is_the_systems_wherever_room_ends(tmp_path: Path) -> None:
    """A limit on the size of files stands for the disk; HDF5 keeps something beside the numbers."""
    if sys.platform == "win32":
        pytest.skip("there are no limits of a process")
    code = f"""
import errno, json, os, resource, signal
from pathlib import Path
from reference.command import small
from restitution._internal.datasets import save
data, file = small(), Path({str(tmp_path)!r}) / "run.nc"
save(data, file)
size = file.stat().st_size
found = [data.nbytes, size]
for limit in (0, 512, data.nbytes, data.nbytes + 4096, size // 2, size - 4096, size - 1):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        save(data, file, replace=True)
        found.append("done")
    except OSError as error:
        found.append(errno.errorcode[error.errno])
print(json.dumps([*found, os.listdir(file.parent)]))
"""
    numbers, size, *errors, left = json.loads(Program(code).said())
    assert numbers < size // 2
    assert errors == ["EFBIG"] * 7
    assert left == ["run.nc"]
