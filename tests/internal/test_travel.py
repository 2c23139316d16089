"""Every public object pickles, copies, compares and hashes, and comes back from another process."""

import copy
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, is_dataclass
from functools import cache
from multiprocessing import get_context
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution import fit
from restitution._internal.parameters import Parameters
from restitution.analytic import first_impact
from restitution.fit import Counts


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


def there_and_back(thing: Any) -> Any:
    """Do nothing, elsewhere."""
    return thing


@pytest.mark.parametrize("name", list(objects()))
def test_an_object_travels(name: str) -> None:
    """By pickle and by copy, to one that is equal and has the same hash."""
    thing = objects()[name]
    for protocol in (2, pickle.HIGHEST_PROTOCOL):
        again = pickle.loads(pickle.dumps(thing, protocol))
        assert again == thing
        assert hash(again) == hash(thing)
    assert copy.deepcopy(thing) == thing
    assert copy.copy(thing) == thing
    assert thing != name
    assert len({thing, copy.deepcopy(thing)}) == 1
    others = [other for other in objects().values() if other is not thing]
    assert all(other != thing for other in others)


def test_objects_come_back_from_a_process_pool() -> None:
    things = objects()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        for name, again in zip(things, pool.map(there_and_back, things.values()), strict=True):
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


@pytest.mark.parametrize("name", list(objects()))
def test_a_pickle_of_another_version(name: str) -> None:
    """With a field more or less: an error that names it, or what the default makes of one that is missing."""
    thing = objects()[name]
    with pytest.raises(ValueError, match=r"another|pickled by another version"):
        of_another_version(thing, lambda state: state.update(another=1))
    for field in fields_of(thing):
        default = type(thing).model_fields[field] if isinstance(thing, Parameters) else None
        if default is None or default.is_required():
            with pytest.raises(ValueError, match=field):
                of_another_version(thing, without(field))
            continue
        again = of_another_version(thing, without(field))
        assert getattr(again, field) == default.default
    assert of_another_version(thing, lambda _: None) == thing


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
