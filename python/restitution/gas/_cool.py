"""A dilute gas that cools, every encounter followed exactly."""

from __future__ import annotations

import hashlib
import math
import os
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
import xarray as xr

from restitution import _core
from restitution._internal.arrays import FloatArray, IntArray, positive, real, whole, word
from restitution._internal.datasets import load, save
from restitution._internal.files import NETCDF, check, path_for, there
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution._internal.process import undisturbed
from restitution._internal.resources import check_size, checked_threads, progress_bar
from restitution.bodies import AnyBody, Body, RigidBody
from restitution.drop.dataset import made_here
from restitution.laws import CollisionLaw
from restitution.pair.partners import between, read_states, turned_axes

Phase = Literal["time", "uniform"]
Record = Literal["moments", "state"]
_STATE = {"velocity": 3, "angular_velocity": 3, "attitude": 4}

_PARTICLE = 96
"""Bytes."""
_WARM = "a finite number >= 0 (J)"


_EACH = 60.0
"""Seconds between two states of a run that are kept in its checkpoint."""
_FAINT = -960
"""Power of two below which temperatures in J would soon be no normal numbers."""
_STEP = 200
"""Powers of two by which velocities are told greater at once."""


class _Pause(KeyboardInterrupt):
    """A run stops to keep how far it has come, and goes on."""


class GasWarning(UserWarning):
    """Encounters of a gas created energy or ended as a collapse, or it is colder than numbers can say.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=1e-3, separation=1e-3), rs.TangentialRestitution(normal=0.95)
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     data = rs.gas.cool(body, law, particles=200, collisions=5, translational_temperature=1e-9)
    >>> caught[0].category is rs.gas.GasWarning
    True
    """


class _Kind(NamedTuple):
    body: AnyBody
    particles: int
    translational: float
    rotational: tuple[float, float, float]
    turned: tuple[bool, bool, bool]
    """For each principal axis, true if contacts turn the body about it."""


def cool(
    body: AnyBody | Sequence[AnyBody],
    law: CollisionLaw,
    *,
    particles: int | Sequence[int] | None = None,
    collisions: float = 50.0,
    translational_temperature: float | Sequence[float] | None = None,
    rotational_temperature: float | Sequence[float] | None = None,
    spin_temperature: float | Sequence[float] | None = None,
    number_density: float = 1.0,
    heating: float = 0.0,
    state: xr.Dataset | None = None,
    record: Record = "moments",
    distributions: bool = False,
    phase: Phase = "time",
    samples: int = 50,
    batches: int = 10,
    seed: int = 1,
    threads: int | None = None,
    progress: bool = False,
    checkpoint: str | os.PathLike[str] | None = None,
) -> xr.Dataset:
    """Follow a homogeneous gas of bodies that collide with each other, without gravity.

    Direct simulation Monte Carlo: any two particles may meet, on lines that are uniform on the disc of their
    reaches, as often as their relative speed says; each encounter is then followed to its end, with all of
    its contacts, as `restitution.pair.encounters` does. So the rate of collisions is counted, not assumed. It
    is the gas in the limit of low density, n(2S)³ << 1 with S the reach of a body: encounters take no time
    beside the flights between them, and particles that meet have not met before (molecular chaos). Between
    encounters bodies turn freely, at rates and about axes that they keep.

    Parameters
    ----------
    body : Dumbbell or another body, or a sequence of them
        The particles; of a mixture each of its species.
    law : Frictionless or another law
        The collision law, of every contact. The coefficient of `Viscoelastic` is that of two spheres with its
        radius.
    particles : int or sequence of int, optional
        How many there are, of each species; at least 2 for each of the batches. 100 000 if left out.
    collisions : float
        Encounters with contact that a particle has had at the end, on average.
    translational_temperature : float or sequence of float, optional
        T_tr at the beginning, in J, of each species: the mean energy of translation is 3T_tr/2. Needed
        without `state`.
    rotational_temperature : float or sequence of float, optional
        T_rot in J: T_rot/2 is the mean energy of rotation about each principal axis; T_tr if left out.
    spin_temperature : float or sequence of float, optional
        Of the rotation about the axis of bodies of revolution, which contacts without friction do not change;
        T_rot if left out.
    number_density : float
        Particles per volume, in 1/m³. Without heating times go with its inverse, and nothing else depends
        on it.
    heating : float
        The mean power that a particle receives from a noise of forces, white in time, in W: in a time t a
        component of its velocity gains a normal number of variance 2 heating t/3m. The mean velocity of the
        gas is kept at 0. Where collisions take as much, the gas is steady.
    state : xarray.Dataset, optional
        Begin with these particles instead of Maxwellians: what a run with `record` "state" gave, or one's own
        ``velocity`` (m/s) and ``angular_velocity`` (rad/s) over (particle, component) and ``attitude``, unit
        quaternions (w, x, y, z), over (particle, quaternion). `particles` and temperatures are left out. The
        batches take as many each, one after the other; those of a mixture as many of each species, in its
        order, which ``particle_species`` numbers from 0. To continue a run give another seed.
    record : {"moments", "state"}
        With "state" also velocity, angular velocity and attitude of every particle at the end.
    distributions : bool
        Count the distributions of velocity and rotation at each of the `samples`, too.
    phase : {"time", "uniform"}
        Bodies turn between encounters for the time that passes, or so far that the phase of their rotation is
        uniform, as in the limit of low density.
    samples : int
        How often the gas is looked at, after equal numbers of collisions.
    batches : int
        Independent gases over which the particles are spread; standard errors are those of their means.
    seed : int
        Of the random numbers, in [0, 2⁶⁴). The same seed gives the same bits with any number of threads.
    threads : int, optional
        At most one for each batch; one for each core if left out.
    progress : bool
        Show a progress bar on standard error.
    checkpoint : path, optional
        A netCDF file that keeps how far the run has come, written every minute, at its end and when Ctrl-C
        ends it. The same call goes on from there, with any number of threads, and gives the same bits as one
        that was never interrupted. It takes 200 bytes a particle in memory, too.

    Returns
    -------
    xarray.Dataset
        Over ``time``, of a mixture also ``species``: ``translational_temperature`` and
        ``rotational_temperature`` (2<E_rot>/f over the f axes about which contacts turn the body: all three,
        but for that of a body of revolution without friction; NaN for spheres without friction), in J;
        ``axis_temperature`` by ``axis``, about each principal axis; ``a20`` = 4<E_tr²>/15T_tr² - 1, ``a02`` =
        4<E_rot²>/f(f + 2)T_rot² - 1 and ``a11`` = <E_tr E_rot>/<E_tr><E_rot> - 1; ``cos2_velocity_spin`` and
        ``cos2_velocity_axis``, 1/3 where directions are independent, the axis being z of the body. With
        `distributions` ``speed_distribution`` over ``relative_speed``, the density of v/<v²>^(1/2), and
        ``spin_distribution`` over ``relative_spin``, that of (E_rot/<E_rot>)^(1/2), at the centres of bins
        up to 6; a Maxwellian has 2(f/2)^(f/2)/Γ(f/2) x^(f - 1) exp(-fx²/2), f = 3 for the first. Over
        ``time`` alone, since the beginning: ``collisions`` and ``contacts`` of a particle, ``attempts``
        (pairs that came within reach) and ``created_energy`` a particle, in J. Each has a standard error
        ``..._error``. Hard contacts have no scale of time: a gas whose temperatures would be no normal
        numbers goes on with greater velocities, and ``velocity_exponent`` over ``time``, which there is only
        then, has the power k of two by which they are too great; temperatures are 4^k times too great.
        Attributes have the parameters, the share of collisions that created energy and of
        those that ended as a collapse.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed; also if rotation becomes so much hotter than
        translation that encounters take too many turns, or `checkpoint` is the file of another run.

    Warns
    -----
    GasWarning
        If collisions created energy, with the rate at which it heats, or more than a hundredth ended as a
        collapse, or if temperatures became smaller than the smallest normal numbers.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=1e-3, separation=1e-3), rs.Frictionless(normal=0.9)
    >>> data = rs.gas.cool(body, law, particles=2000, collisions=20, translational_temperature=1e-9)
    >>> bool(data["translational_temperature"][-1] < 0.5e-9)
    True
    """
    word("record", record, get_args(Record))
    number = whole("batches", batches, 2, 10**4)
    warm = {
        "translational_temperature": translational_temperature,
        "rotational_temperature": rotational_temperature,
        "spin_temperature": spin_temperature,
    }
    given = None
    if state is not None:
        for name, value in {"particles": particles, **warm}.items():
            if value is not None:
                raise ParameterError(Problem(name, ": given beside state, which says it already"))
        given = np.concatenate(read_states("state", state, _STATE, particle=None), axis=1)
        particles, warm = _of_state(body, state, given, number)
    elif translational_temperature is None:
        raise ParameterError(Problem("translational_temperature", ": missing; must be a number > 0 (J)"))
    kinds = _kinds(body, law, {"particles": 100_000 if particles is None else particles, **warm})
    if not isinstance(law, CollisionLaw):
        raise ParameterError(wrong("law", law, "a collision law"))
    word("phase", phase, get_args(Phase))
    course: dict[str, Any] = {
        "number_density": positive("number_density", number_density, "m-3"),
        "uniform": phase == "uniform",
        "batches": number,
        "heating": real(
            "heating", heating, "a finite number >= 0 (W)", lambda p: 0.0 <= p < math.inf, unit="W"
        ),
        "keep": record == "state",
        "distributions": bool(distributions),
        "collisions": real("collisions", collisions, "a number in (0, 10⁹]", lambda x: 0.0 < x <= 1e9),
        "samples": whole("samples", samples, 1, 10**6),
        "seed": whole("seed", seed, 0, 2**64 - 1),
    }
    for kind in kinds:
        if kind.particles < 2 * number:
            raise ParameterError(wrong("particles", kind.particles, f">= {2 * number}, 2 for each batch"))
    total = sum(kind.particles // number * number for kind in kinds)
    path = None if checkpoint is None else path_for("checkpoint", checkpoint, NETCDF)
    room = _PARTICLE * (1 + (record == "state") + 2 * (path is not None))
    check_size("particles", total, total, room, "particles")
    expected = round(course["collisions"] * total / 2)
    table, last = _follow(kinds, law, course, checked_threads(threads), given, path, expected, show=progress)
    data = _dataset(kinds, table, total)
    if record == "state":
        data = data.assign(_state(kinds, last, number))
    data.attrs |= made_here("A dilute gas, every encounter followed") | {
        "body": ", ".join(str(kind.body) for kind in kinds),
        "law": str(law),
        "number_density": number_density,
        "heating": heating,
        "phase": phase,
        "batches": number,
        "seed": seed,
    }
    if not isinstance(body, list | tuple):
        data = data.isel(species=0)
    _warn(data)
    return data


def _follow(
    kinds: Sequence[_Kind],
    law: CollisionLaw,
    course: dict[str, Any],
    threads: int,
    given: FloatArray | None,
    path: Path | None,
    expected: int,
    *,
    show: bool,
) -> tuple[FloatArray, FloatArray]:
    """Return the looks at a gas and its last states; what `path` keeps is gone on from."""
    rows = [(kind.body.compiled, *kind[1:]) for kind in kinds]
    text = repr((made_here("")["version"], [(str(kind.body), *kind[1:]) for kind in kinds], str(law), course))
    mark = hashlib.sha256(text.encode() + (b"" if given is None else given.tobytes())).hexdigest()
    store = None if path is None else _kept(path, mark)
    with progress_bar("gas", expected, "collisions", show=show) as tell:
        while True:
            began = time.monotonic()

            def watch(done: int, end: float = began + _EACH) -> None:
                if tell is not None:
                    tell(done)
                if done < expected and time.monotonic() > end:
                    raise _Pause

            (table, last, store), interrupted = _core.cool(
                rows, between(law).compiled, course, threads, given, tell if path is None else watch, store
            )
            if path is not None:
                about = {"restitution_gas": mark, "title": "How far a gas has come, for restitution.gas.cool"}
                with undisturbed():  # a signal would leave netCDF locked
                    save(xr.Dataset({"store": ("number", store)}, attrs=about), path, replace=True)
            if interrupted is None:
                return table, last
            if not isinstance(interrupted, _Pause):
                raise interrupted


def _kept(path: Path, mark: str) -> FloatArray:
    """Return how far the run of this mark has come, nothing at first."""
    if not there(path):
        check(path, replace=False)
        return np.empty(0)
    data = load(path)
    if data.attrs.get("restitution_gas") != mark:
        allowed = "a new file, or that of the same run: with the same arguments, by the same version"
        raise ParameterError(wrong("checkpoint", str(path), allowed))
    store: FloatArray = data["store"].to_numpy()
    return store


def _bodies(body: Any) -> list[Any]:
    bodies = list(body) if isinstance(body, list | tuple) else [body]
    if not bodies or not all(isinstance(one, AnyBody) for one in bodies):
        raise ParameterError(wrong("body", body, "a body, or a sequence of them"))
    return bodies


def _kinds(body: Any, law: Any, given: dict[str, Any]) -> list[_Kind]:
    """Check numbers of particles and temperatures, each given for all species or one by one."""
    bodies = _bodies(body)

    def each(name: str, value: Any) -> list[Any]:
        if not isinstance(body, list | tuple):
            return [value]
        if value is None or np.ndim(value) == 0:
            return [value] * len(bodies)
        if len(value) != len(bodies):
            raise ParameterError(wrong(name, value, f"one number, or {len(bodies)}, one for each body"))
        return list(value)

    kinds = []
    columns = [each(name, value) for name, value in given.items()]
    for one, count, t, r, s in zip(bodies, *columns, strict=True):
        number = whole("particles", count, 1, 2**40)
        warm = positive("translational_temperature", t, "J")
        about = warm if r is None else _temperature("rotational_temperature", r)
        if s is not None and not isinstance(one, Body):
            raise ParameterError(wrong("spin_temperature", s, f"left out: {type(one).__name__} has no axis"))
        along = about if s is None else _temperature("spin_temperature", s)
        kinds.append(_Kind(one, number, warm, (about, about, along), turned_axes(one, law)))
    return kinds


def _order(counts: Sequence[int], batches: int) -> IntArray:
    """Return the number of the species of each particle."""
    return np.tile(np.repeat(np.arange(len(counts)), [count // batches for count in counts]), batches)


def _of_state(body: Any, state: xr.Dataset, given: FloatArray, batches: int) -> tuple[Any, dict[str, Any]]:
    """Return the numbers of particles of a state, and about its temperatures, which the core checks."""
    several, bodies = isinstance(body, list | tuple), _bodies(body)
    which = np.zeros(len(given), dtype=np.int64)
    if several and "particle_species" in state:
        which = state["particle_species"].to_numpy()
    counts = [int(np.sum(which == number)) for number in range(len(bodies))]
    if len(given) % batches or min(counts) < batches or not np.array_equal(which, _order(counts, batches)):
        text = f" has {len(given)} particles: must be as many in each of {batches} batches"
        raise ParameterError(Problem("state", text + ", and of a mixture of each species, in its order"))
    warm: dict[str, list[float]] = {"translational_temperature": [], "rotational_temperature": []}
    for number, one in enumerate(bodies):
        speed, spin = (np.mean(given[which == number, start : start + 3] ** 2) for start in (0, 3))
        if speed == 0.0:
            raise ParameterError(
                wrong("state.velocity", 0.0, "other than 0 for some particle of each species")
            )
        rigid = isinstance(one, RigidBody)
        moments = one.principal_moments if rigid else (one.axial_inertia, one.transverse_inertia)
        warm["translational_temperature"].append(float(one.mass * speed))
        warm["rotational_temperature"].append(float(max(moments) * spin))
    if not several:
        return counts[0], {name: values[0] for name, values in warm.items()} | {"spin_temperature": None}
    return counts, {**warm, "spin_temperature": None}


def _state(kinds: Sequence[_Kind], last: FloatArray, batches: int) -> dict[str, Any]:
    variables: dict[str, Any] = {}
    start = 0
    for (name, parts), unit in zip(_STATE.items(), ("m s-1", "rad s-1", "1"), strict=True):
        dims = ("particle", "component" if parts == 3 else "quaternion")
        about = {"long_name": f"{name.replace('_', ' ')} at the end, in the axes of space", "units": unit}
        variables[name] = (dims, last[:, start : start + parts], about)
        start += parts
    if len(kinds) > 1:
        order = _order([kind.particles for kind in kinds], batches)
        variables["particle_species"] = ("particle", order, {"long_name": "number of the species"})
    return variables


def _temperature(name: str, value: Any) -> float:
    return real(name, value, _WARM, lambda t: 0.0 <= t < math.inf, unit="J")


_MEANS = {
    "translational_temperature": ("temperature of translation", "J"),
    "rotational_temperature": ("temperature of rotation", "J"),
    "axis_temperature": ("temperature of rotation about a principal axis", "J"),
    "a20": ("4<E_tr²>/15T_tr² - 1", "1"),
    "a02": ("4<E_rot²>/f(f + 2)T_rot² - 1", "1"),
    "a11": ("<E_tr E_rot>/<E_tr><E_rot> - 1", "1"),
    "cos2_velocity_spin": ("<cos²> of the angle between velocity and angular velocity", "1"),
    "cos2_velocity_axis": ("<cos²> of the angle between velocity and the z axis of the body", "1"),
}
_COUNTS = {
    "collisions": ("encounters with contact, of a particle", "1"),
    "contacts": ("contacts of a particle", "1"),
    "attempts": ("pairs within reach of each other, of a particle", "1"),
    "created_energy": ("energy that the law created, a particle", "J"),
}


def _dataset(kinds: Sequence[_Kind], table: FloatArray, total: int) -> xr.Dataset:
    batches = len(table)
    counts = {name: table[..., k] for k, name in enumerate(_core.GAS_WHOLE)}
    each = total / batches
    variables: dict[str, Any] = {}

    def put(name: str, values: FloatArray, dims: tuple[str, ...], text: str, unit: str) -> None:
        """Take the mean over batches, the first axis, and its standard error."""
        # Squares of small temperatures would be 0.
        _, power = np.frexp(np.abs(values).max(axis=0))
        error = np.ldexp(np.ldexp(values, -power).std(axis=0, ddof=1) / math.sqrt(batches), power)
        variables[name] = (dims, values.mean(axis=0), {"long_name": text, "units": unit})
        variables[f"{name}_error"] = (dims, error, {"long_name": f"standard error of {name}", "units": unit})

    for name, (text, unit) in _COUNTS.items():
        particles = 1.0 if name == "created_energy" else 2.0  # to which each belongs
        put(name, counts[name] * (particles / each), ("time",), text, unit)
    exponent = counts["exponent"].astype(np.int64)
    reported = _told(kinds, table, exponent)
    parts, counted = [], []
    own = np.split(table[..., len(_core.GAS_WHOLE) :], len(kinds), axis=-1)
    for kind, columns in zip(kinds, own, strict=True):
        means = columns[..., : len(_core.GAS_KIND)]
        named = dict(zip(_core.GAS_KIND, np.moveaxis(means, -1, 0), strict=True))
        parts.append(_of_kind(kind, named, exponent, reported))
        counted.append(_densities(kind, columns[..., len(_core.GAS_KIND) :], batches))
    for name, (text, unit) in _MEANS.items():
        values = np.stack([part[name] for part in parts], axis=1)
        dims = ("species", "time", "axis") if name == "axis_temperature" else ("species", "time")
        put(name, values, dims, text, unit)
    coordinates: dict[str, Any] = {}
    if counted[0].size:
        bins, width = _core.GAS_BINS
        for place, (name, (text, of)) in enumerate(_DENSITIES.items()):
            values = np.stack([each[:, :, place] for each in counted], axis=1)
            dimension = f"relative_{name}"
            put(f"{name}_distribution", values, ("species", "time", dimension), f"density of {of}", "1")
            about = {"long_name": f"{of}, {text}", "units": "1"}
            coordinates[dimension] = (dimension, width * (np.arange(bins) + 0.5), about)
    if reported.any():
        text = "power of two by which velocities are too great; temperatures by twice this"
        variables["velocity_exponent"] = ("time", reported, {"long_name": text, "units": "1"})
    times = counts["time"].mean(axis=0)
    coordinates |= {
        "time": ("time", times, {"long_name": "time", "units": "s"}),
        "axis": ("axis", ["first", "second", "third"], {"long_name": "principal axis"}),
    }
    data = xr.Dataset(variables, coordinates)
    met, last = counts["collisions"][:, -1].sum(), {name: counts[name][:, -1].sum() for name in counts}
    data.attrs = {
        "particles": [kind.particles // batches * batches for kind in kinds],
        "energy_created_share": float(last["creating"] / met),
        "collapse_share": float(last["collapses"] / met),
        "looks_an_attempt": float(last["steps"] / last["attempts"]),
        "beyond_majorant": int(last["beyond"]),
    }
    return data


_DENSITIES = {
    "speed": ("speed over its root mean square", "v/<v²>^(1/2)"),
    "spin": ("root of the energy of rotation over its mean", "(E_rot/<E_rot>)^(1/2)"),
}


def _densities(kind: _Kind, counts: FloatArray, batches: int) -> FloatArray:
    """Return densities of speed and rotation, shape (batch, time, 2, bin); NaN where nothing turns."""
    bins, width = _core.GAS_BINS
    each = kind.particles // batches
    found = counts.reshape(*counts.shape[:2], -1, bins) / (each * width)
    if not any(kind.turned):
        found[:, :, 1:] = math.nan
    return found


def _told(kinds: Sequence[_Kind], table: FloatArray, own: IntArray) -> IntArray:
    """Return the power of two by which velocities are told too great; `own` is that of what was followed."""
    first = len(_core.GAS_WHOLE) + _core.GAS_KIND.index("speed_squared")
    squares = table[..., first :: (table.shape[-1] - len(_core.GAS_WHOLE)) // len(kinds)]
    warm = np.log2(squares * [kind.body.mass / 3.0 for kind in kinds]).min(axis=-1) - 2.0 * own
    steps = np.ceil(np.maximum(_FAINT - warm.min(axis=0), 0.0) / (2.0 * _STEP))
    told: IntArray = _STEP * steps.astype(np.int64)
    return told


def _of_kind(
    kind: _Kind, means: dict[str, FloatArray], own: IntArray, told: IntArray
) -> dict[str, FloatArray]:
    """Return the variables of a species in every batch, shape (batch, time), or with the axes (..., 3).

    Velocities were followed, and are told, 2 to the power `own` and `told` too great, but for the spins of
    bodies that contacts do not turn.
    """
    mass, turned = kind.body.mass, np.array(kind.turned)
    power = 2 * (told - own)
    spins = power if turned.any() else 2 * told
    energies = np.stack([means[f"rotational_{axis}"] for axis in "xyz"], axis=-1)
    translational = mass * means["speed_squared"] / 3.0
    axes = int(turned.sum())
    rotation = (energies * turned).sum(axis=-1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = {
            "translational_temperature": np.ldexp(translational, power),
            "rotational_temperature": np.ldexp(2.0 * rotation / axes, power),
            "axis_temperature": np.ldexp(2.0 * energies, spins[..., np.newaxis]),
            "a20": mass**2 * means["speed_fourth"] / (15.0 * translational**2) - 1.0,
            "a02": means["rotational_squared"] / rotation**2 * (axes / (axes + 2.0)) - 1.0,
            "a11": means["mixed"] / (means["speed_squared"] * rotation) - 1.0,
        }
    return found | {name: means[name] for name in ("cos2_velocity_spin", "cos2_velocity_axis")}


def _warn(data: xr.Dataset) -> None:
    created, collapsed = data.attrs["energy_created_share"], data.attrs["collapse_share"]
    told = []
    if created > 0.0:
        each = 1.5 * data["translational_temperature"] + 0.5 * data["axis_temperature"].sum("axis")
        if "species" in each.dims:
            each = each.weighted(xr.DataArray(data.attrs["particles"], dims="species")).mean("species")
        gained = np.sum(np.diff(data["created_energy"]) / each[1:].to_numpy())
        told.append(
            f"{created:.3g} of the collisions created energy, in a collision of each particle "
            f"{float(gained / data['collisions'][-1]):.2g} of what the gas has: the law does this; "
            "created_energy has how much"
        )
    if collapsed > 1e-2:
        told.append(
            f"{collapsed:.3g} of the collisions ended as a collapse, in which bodies stay together; they "
            "go on with the velocities that they had then"
        )
    if "velocity_exponent" in data:
        told.append(
            "the gas has cooled below the smallest normal numbers: velocities at the end are "
            f"2^{int(data['velocity_exponent'][-1])} times too great, and temperatures by the square of it; "
            "velocity_exponent has the powers"
        )
    for text in told:
        warnings.warn(text, GasWarning, stacklevel=3)
