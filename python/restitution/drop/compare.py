"""The statistics of several bodies under several laws, side by side."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from typing import Any, TypeVar

import numpy as np
import xarray as xr

from restitution._internal.arrays import several
from restitution._internal.parameters import ParameterError, Parameters, Problem, shown, wrong
from restitution._internal.resources import progress_bar
from restitution.bodies import AnyBody, Rough, RoughSphere
from restitution.drop.energy import LEDGER, PULLING, percent, reported_elsewhere, tell, told
from restitution.drop.simulate import SimulationInterrupted
from restitution.drop.statistics import statistics
from restitution.laws import CollisionLaw

T = TypeVar("T", bound=Parameters)

_NEEDED = ("velocity_bins", "restitution_bins")
"""Arguments that have no default."""

_PER_RUN = {
    "all_impacts": "impacts of the run, in the bins or not",
    "energy_created_impacts": "of these, impacts that multiplied the kinetic energy by more than 1 + 1e-12",
    "energy_created_share": "their share",
    "largest_energy_ratio_of_all": "their largest factor, 1 where there are none",
    "pulling_impacts": PULLING,
}


def compare(
    bodies: Mapping[str, AnyBody] | Iterable[AnyBody],
    laws: Mapping[str, CollisionLaw] | Iterable[CollisionLaw],
    *,
    progress: bool = False,
    **run: Any,
) -> xr.Dataset:
    """Drop every body under every law and put the statistics side by side.

    Parameters
    ----------
    bodies, laws : mapping of str to body, or to Law or CustomLaw, or iterable of them
        The bodies and the collision laws. Without names they are called by their class and those
        parameters in which they differ from others of their class.
    progress : bool
        Show a progress bar on standard error, over the combinations.
    **run
        As in `restitution.statistics`: ``velocity_bins`` and ``restitution_bins`` must be given. All
        combinations have the same bins and the same seed.

    Returns
    -------
    xarray.Dataset
        As from `restitution.statistics`, with dimensions (body, law) first. Over (body, law) also
        ``all_impacts``, ``energy_created_impacts``, ``energy_created_share`` and
        ``largest_energy_ratio_of_all`` and ``pulling_impacts``; over body and over law ``body_parameters``
        and ``law_parameters``.
        Each parameter in which bodies differ is a coordinate over body, such as ``separation``, each in which
        laws differ over law: ``found.swap_dims(body="separation")`` makes an axis of it. The attributes are
        what all runs share.

    Raises
    ------
    TypeError
        If ``velocity_bins`` or ``restitution_bins`` is missing, or an argument is unknown.
    ValueError
        Naming the argument that is wrong.
    SimulationInterrupted
        On Ctrl-C; its ``data`` holds the combinations that were finished, and says which in ``finished``.

    Warns
    -----
    EnergyWarning, PullWarning
        Once each, naming the laws that created kinetic energy, or let the plane pull.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.compare(
    ...     {"short": rs.Dumbbell(radius=3e-3, separation=3e-4)},
    ...     [rs.Frictionless(normal=0.98), rs.Coulomb(normal=0.98, friction=0.3)],
    ...     particles=50, velocity_bins=np.linspace(0.0, 1.2, 13),
    ...     restitution_bins=np.linspace(-1.0, 3.0, 401))
    >>> found["mean_restitution"].dims, found["law"].values.tolist()
    (('body', 'law', 'velocity'), ['Frictionless', 'Coulomb'])
    """
    try:
        inspect.signature(statistics).bind(None, None, **dict.fromkeys(_NEEDED) | run)
    except TypeError as error:
        raise TypeError(f"compare(): {error}") from None
    if missing := [name for name in _NEEDED if name not in run]:
        raise TypeError(f"compare(): missing a required argument: {' and '.join(map(repr, missing))}")
    solids = _named("bodies", bodies, AnyBody)
    rules = _named("laws", laws, CollisionLaw)
    pairs = list(product(solids, rules))
    with (
        reported_elsewhere(),  # below, once
        progress_bar("compare", len(pairs), "combinations", show=progress) as tell,
    ):
        runs: list[xr.Dataset] = []
        for done, (body, law) in enumerate(pairs, start=1):
            try:
                runs.append(statistics(solids[body], rules[law], **run))
            except SimulationInterrupted as stop:
                raise SimulationInterrupted(_finished(runs, stop.data, solids, rules)) from stop
            if tell is not None:
                tell(done)
    found = _side_by_side(runs, solids, rules)
    _warn(found)
    return found


def _finished(
    runs: list[xr.Dataset],
    begun: xr.Dataset,
    bodies: Mapping[str, AnyBody],
    laws: Mapping[str, CollisionLaw],
) -> xr.Dataset:
    """Put the finished runs side by side, with blanks in the places of the others."""
    example = runs[0] if runs else begun  # what had only begun may lack standard errors
    empty = xr.zeros_like(example)
    for name, variable in example.data_vars.items():
        if str(name).endswith("_edges"):
            empty[name] = variable
        elif variable.dtype.kind == "f":
            empty[name] = variable * np.nan
    empty.attrs |= dict.fromkeys(("all_impacts", "energy_created_impacts"), 0)
    empty.attrs |= {"energy_created_share": 0.0, "largest_energy_ratio": 1.0}
    missing = len(bodies) * len(laws) - len(runs)
    found = _side_by_side([*runs, *[empty] * missing], bodies, laws)
    finished = np.arange(len(bodies) * len(laws)) < len(runs)
    about = {"long_name": "whether the run was finished; all else is blank where it was not"}
    found["finished"] = (("body", "law"), finished.reshape(len(bodies), len(laws)), about)
    incomplete = f"interrupted: {len(runs)} of {finished.size} combinations are finished"
    return found.assign_attrs(incomplete=incomplete)


def _named(what: str, given: Mapping[str, T] | Iterable[T], kind: type[Any]) -> dict[str, T]:
    """Name every body or law."""
    called = kind.__name__.removeprefix("Any")

    def checked(_: int, value: T) -> T:
        if not isinstance(value, kind):
            raise ParameterError(Problem(what, f" holds {shown(value)}: must be objects of a {called}"))
        return value

    allowed = f"a dict or list of {called}"
    if isinstance(given, Parameters | str) or not isinstance(given, Iterable):
        raise ParameterError(wrong(what, given, allowed))
    if isinstance(given, Mapping):
        names, values = list(given), several(what, given.values(), allowed, checked)
    else:
        values = several(what, given, allowed, checked)
        names = [_name(value, values) for value in values]
    if not values:
        raise ParameterError(Problem(what, ": must not be empty"))
    for name in names:
        if not isinstance(name, str):
            raise ParameterError(Problem(what, f": {shown(name)} is not a name; must be a str"))
    named = dict(zip(names, values, strict=True))
    if len(named) < len(values):
        twice = next(name for name in names if names.count(name) > 1)
        text = f": {twice} appears twice; all must differ, or have names in a dict"
        raise ParameterError(Problem(what, text))
    return named


def _name(one: Parameters, others: list[T]) -> str:
    """Name an object by its class and the parameters in which it differs from others of the class."""
    alike = [other for other in others if type(other) is type(one)]
    telling = [
        f"{field} = {getattr(one, field)!r}"
        for field in _written(one)
        if any(getattr(other, field) != getattr(one, field) for other in alike)
    ]
    return type(one).__name__ + (f"({', '.join(telling)})" if telling else "")


def _written(one: Parameters) -> list[str]:
    """Return the names of the parameters that are values, not functions."""
    return [name for name, field in type(one).model_fields.items() if field.repr]


def _side_by_side(
    runs: list[xr.Dataset], bodies: Mapping[str, AnyBody], laws: Mapping[str, CollisionLaw]
) -> xr.Dataset:
    """Stack statistics, all in the same bins, in the order body, law."""
    first = runs[0]
    variables: dict[str, Any] = {}
    for name, variable in first.data_vars.items():
        if str(name).endswith("_edges"):
            variables[str(name)] = variable
            continue
        stacked = np.stack([run[name].to_numpy() for run in runs])
        shape = (len(bodies), len(laws), *stacked.shape[1:])
        variables[str(name)] = (("body", "law", *variable.dims), stacked.reshape(shape), variable.attrs)
    for name, text in _PER_RUN.items():
        # There is no attribute largest_energy_ratio where no energy is created, none where nothing pulls.
        none = 0 if name == "pulling_impacts" else 1.0
        attribute = name.removesuffix("_of_all")
        values = np.array([run.attrs.get(attribute, none) for run in runs]).reshape(len(bodies), len(laws))
        variables[name] = (("body", "law"), values, {"long_name": text})
    coordinates: dict[str, Any] = {
        "body": list(bodies),
        "law": list(laws),
        **{str(k): v for k, v in first.coords.items()},
    }
    coordinates |= _parameters("body", bodies.values()) | _parameters("law", laws.values())
    coordinates["body_parameters"] = (("body",), [repr(body) for body in bodies.values()])
    coordinates["law_parameters"] = (("law",), [repr(law) for law in laws.values()])
    shared = {
        name: value
        for name, value in first.attrs.items()
        if all(name in run.attrs and run.attrs[name] == value for run in runs) and name not in LEDGER
    }
    shared["title"] = "Statistics of the impacts of bodies under collision laws"
    return xr.Dataset(variables, coordinates, shared)


def _parameters(axis: str, objects: Iterable[Parameters]) -> dict[str, Any]:
    """Return the parameters in which objects differ as coordinates: numbers as numbers, NaN for none."""
    rows: list[dict[str, Any]] = []
    units: dict[str, str] = {}
    for one in objects:
        row: dict[str, Any] = {}
        for name, value, unit in _values(one):
            units.setdefault(name, unit)
            if isinstance(value, tuple) and len(value) == 2:
                row |= {f"{name}_1": value[0], f"{name}_2": value[1]}
            else:
                row[name] = value if isinstance(value, float | str) else repr(value)
        rows.append(row)
    found: dict[str, Any] = {}
    for name in dict.fromkeys(key for row in rows for key in row):
        values = [row.get(name) for row in rows]
        if all(value == values[0] for value in values):
            continue
        numeric = all(value is None or isinstance(value, float) for value in values)
        if numeric:
            column = np.array([np.nan if value is None else value for value in values])
            unit = units[name.removesuffix("_1").removesuffix("_2")]
            found[name] = ((axis,), column, {"long_name": f"{name} of the {axis}", "units": unit})
        else:
            words = ["" if value is None else str(value) for value in values]
            found[name] = ((axis,), words, {"long_name": f"{name} of the {axis}"})
    return found


def _values(one: Parameters) -> Iterator[tuple[str, Any, str]]:
    """Yield name, value and unit of what was given; of a rough body as `attributes` names and writes it."""
    if not isinstance(one, Rough | RoughSphere):
        given = {name: getattr(one, name) for name in _written(one)}
    else:
        given = one.attributes() | {"asperities": float(one.asperities)}
    kinds = [type(one), *([type(one.body)] if isinstance(one, Rough) else [])]
    for name, value in given.items():
        if value is not None:
            yield name, value, next((unit_of(kind, name) for kind in kinds if name in kind.model_fields), "1")


def _warn(found: xr.Dataset) -> None:
    for category, did, name, more in told(float(found["largest_energy_ratio_of_all"].max())):
        laws = [str(law) for law in found["law"].values[found[name].sum("body") > 0]]
        share = float((found[name] / np.maximum(found["all_impacts"], 1)).max())
        where = f"in up to {percent(share)} of the impacts of a run" if laws else ""
        tell(category, f"{', '.join(laws)} {did}", where, more, stacklevel=3)


_UNITS = {"m/s": "m s-1", "m/s²": "m s-2", "rad/s": "rad s-1", "kg/m³": "kg m-3"}
_UNITS |= {unit: unit for unit in ("m", "s", "rad", "kg", "Pa")} | {"kg m²": "kg m2"}


def unit_of(kind: type[Parameters], name: str) -> str:
    """Return the unit of a parameter as the CF conventions write it; "1" of pure numbers."""
    return _UNITS.get((kind.model_fields[name].description or "").partition(";")[0], "1")
