"""Tables of a study: how they are taken, and what those of effort, of quantiles and of fits say."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
import xarray as xr
from pydantic import BeforeValidator

from restitution._internal.arrays import either, pair, real, reals, whole
from restitution._internal.parameters import (
    Allowed,
    ParameterError,
    Parameters,
    Problem,
    plain_number,
    renamed,
    shown,
    unknown,
    wrong,
)
from restitution.distribution import quantiles
from restitution.drop.run import Run
from restitution.drop.statistics import MOMENTS, Edges

P = TypeVar("P", bound=Parameters)

_DEEPEST = 8  # tables in tables that are looked into; those of a study are four deep
_LONGEST = 100  # letters of a key, which an error writes out


def copied(name: str, value: Any, depth: int = 0) -> Any:
    """Copy a table with all tables in it, whose keys must be names; anything else stays what it is."""
    if not isinstance(value, Mapping):
        return value
    if depth > _DEEPEST:
        raise ParameterError(Problem(name, f": must be at most {_DEEPEST} tables deep"))
    for key in value:
        if not isinstance(key, str) or len(key) > _LONGEST or not key.isprintable():
            allowed = f"keys must be strings of at most {_LONGEST} printable characters"
            raise ParameterError(Problem(name, f" has the key {shown(key)}: {allowed}"))
    return {
        key: copied(f"{name}.{key}" if depth > 0 else key, part, depth + 1) for key, part in value.items()
    }


def made(name: str, kind: type[P], value: Any) -> P:
    """Make one set of parameters of a table of the study."""
    checked = table(name, value, kind.model_fields)
    with renamed(lambda field: f"{name}.{field}"):
        return kind(**checked)


def table(name: str, value: Any, keys: Collection[str]) -> Mapping[str, Any]:
    """Take a table of a study, which has no other keys."""
    if not isinstance(value, Mapping):
        raise ParameterError(wrong(name, value, f"a table [{name}]"))
    for stranger in value:
        if stranger not in keys:
            raise ParameterError(unknown(stranger, f"[{name}]", keys, prefix=f"{name}."))
    return value


def number(name: str, value: Any, allowed: str, good: Callable[[float], bool] = math.isfinite) -> int | float:
    """Take a number for which `good` holds; a whole one stays one, and has the digest that it always had."""
    checked, plain = real(name, value, allowed, good), plain_number(value)
    return plain if isinstance(plain, int) else checked


_SHORT = ("mean", "std")  # of restitution, which may be asked for by these words
_BATCHES = 16
_MOST_DOUBLINGS = 10
_MOST_PARTICLES = 2**40 - 1  # of a point; as many as a run can have
TASK = 100_000_000  # impacts of a task, at most, where batches are not larger


@dataclass(frozen=True)
class Effort:
    """Particles and batches of a point.

    Particles come in blocks of the run's ``particles``; a block is cut into batches. A point begins with one
    block and doubles the number, up to ``blocks``, until the standard errors of variables are as small as is
    asked for, absolute or, as ``"1 %"``, relative, in the bins of impact velocity whose centres are between
    ``velocities``. They are taken over as many groups as a block has batches: group g has batch g of each.
    """

    particles: int
    batches: int
    blocks: int
    impacts: int
    until: tuple[tuple[str, float | str], ...]
    velocities: tuple[float, float] | None

    def part(self, batch: int) -> tuple[int, int]:
        """Return the first particle of a batch, and the one after its last."""
        block, number = divmod(batch, self.batches)
        start = block * self.particles
        cut = [start + i * self.particles // self.batches for i in (number, number + 1)]
        return cut[0], cut[1]

    @property
    def task_batches(self) -> int:
        """Batches of a task: a divisor of those of a block."""
        most = max(1, TASK * self.batches // (self.particles * self.impacts))
        return max(size for size in range(1, self.batches + 1) if self.batches % size == 0 and size <= most)

    @property
    def block_tasks(self) -> int:
        """Tasks of a block."""
        return self.batches // self.task_batches

    def table(self) -> dict[str, Any]:
        """Return all values that results depend on, as plain values."""
        return {
            "batches": self.batches,
            "until": dict(self.until),
            "velocities": list(self.velocities) if self.velocities else None,
            "most_particles": self.blocks * self.particles,
        }

    def check(self, names: Collection[str]) -> None:
        """Refuse to wait for the standard error of a variable that is not among those that have one."""
        for name, _ in self.until:
            if _variable(name) not in names:
                there = f"there are {', '.join(sorted(names))}" if names else "no variable has one"
                raise ParameterError(Problem(f"effort.until.{name}", f": has no standard error; {there}"))

    def is_enough(self, found: xr.Dataset, blocks: int) -> bool:
        """Find out whether a point with so many blocks is finished."""
        self.check([str(key)[:-6] for key in found if str(key).endswith("_error")])
        return blocks >= self.blocks or all(self._is_reached(found, *one) for one in self.until)

    def _is_reached(self, found: xr.Dataset, name: str, target: float | str) -> bool:
        """Find out whether a standard error is small enough in every bin that counts, and known there."""
        value, error = found[_variable(name)], found[f"{_variable(name)}_error"]
        if "velocity" in value.dims:
            if self.velocities is None:
                kept = found["number"].to_numpy() > 0
            else:
                centres = found["velocity"].to_numpy()
                kept = (centres >= self.velocities[0]) & (centres <= self.velocities[1])
            value, error = (x.isel(velocity=np.flatnonzero(kept)) for x in (value, error))
        allowed = _share(target) * np.abs(value.to_numpy()) if isinstance(target, str) else target
        return bool(np.all((error.to_numpy() <= allowed) | (error.to_numpy() == 0.0)))


def effort(given: Any, run: Run) -> Effort:
    """Read the table ``[effort]``."""
    own = table("effort", given, ("batches", "until", "velocities", "most_particles"))
    if run.particles < 2:
        text = f" = {run.particles}: must be at least 2, because standard errors need two batches"
        raise ParameterError(Problem("run.particles", text))
    batches = own.get("batches", min(_BATCHES, run.particles))
    batches = whole("effort.batches", batches, 2, min(run.particles, 4096))
    until = _until(own.get("until", {}))
    velocities = own.get("velocities")
    if velocities is not None:
        velocities = pair(
            "effort.velocities", velocities, "a pair (low, high) with low < high, in m/s", unit="m s-1"
        )
    usual = min(_MOST_PARTICLES, 2**_MOST_DOUBLINGS * run.particles) if until else run.particles
    most = whole("effort.most_particles", own.get("most_particles", usual), run.particles, _MOST_PARTICLES)
    if not until and most != run.particles:
        text = ": is used with `until` only; without it run.particles is the number"
        raise ParameterError(Problem("effort.most_particles", text))
    if until and (run.orientations is not None or run.spins is not None):
        text = ": particles cannot be added where orientation or spin are given one by one"
        raise ParameterError(Problem("effort.until", text))
    blocks = 1 << (most // run.particles).bit_length() - 1
    return Effort(run.particles, batches, blocks, run.impacts, tuple(until.items()), velocities)


def _until(value: Any) -> dict[str, float | str]:
    if not isinstance(value, Mapping):
        raise ParameterError(wrong("effort.until", value, "a table of standard errors, as { std = 0.01 }"))
    allowed = 'a number > 0, or a share as "1 %"'
    until: dict[str, float | str] = {}
    for name, target in value.items():
        if isinstance(target, str) and 0 < _share(target) < np.inf:
            until[name] = str(target)
        else:
            until[name] = number(f"effort.until.{name}", target, allowed, lambda size: 0 < size < np.inf)
    return until


def _variable(name: str) -> str:
    return f"{name}_restitution" if name in _SHORT else name


def _share(text: str) -> float:
    """Read ``"1 %"``; NaN if it is no share."""
    number, sign, rest = text.partition("%")
    try:
        return float(number) / 100.0 if sign and not rest.strip() else np.nan
    except ValueError:
        return np.nan


_PARAMETERS = {
    "asymmetric-laplace": ("location", "above", "below"),
    "laplace": ("location", "scale"),
    "gaussian": ("mean", "deviation"),
    "logistic": ("location", "scale"),
    "student-t": ("degrees", "location", "scale"),
    "cusp-mixture": ("share", "location", "above", "below", "mean", "deviation"),
}
_CUSPED = ("asymmetric-laplace", "cusp-mixture")
_MOST_LEVELS = 10_001
_LEVELS = f"a number of levels in [2, {_MOST_LEVELS}], from 0 to 1, or increasing levels in [0, 1]"
_AT_NORMAL = f"'normal', the law's ε_n, and for a family with a cusp: {' or '.join(_CUSPED)}"
_WINDOW = "a pair (low, high) of edges of velocity bins, with low < high"

_EXTREMES = ("minimum", "maximum")
"""They have no standard error: leaving out a group moves them by a jump, or not at all."""
MOVED = tuple(name for name in MOMENTS if name not in _EXTREMES)
"""Moments that have one."""
DERIVED = {
    "std_restitution": "standard deviation of restitution",
    "second_moment": "mean of restitution squared",
    "density": "probability density of restitution",
}


def _levels(given: Any) -> tuple[float, ...]:
    number = plain_number(given)
    if isinstance(number, int) and 2 <= number <= _MOST_LEVELS:
        return tuple(np.linspace(0.0, 1.0, number).tolist())
    levels = reals("levels", given, _LEVELS, dimensions=(1,))
    within = bool(np.all((levels >= 0.0) & (levels <= 1.0)) and np.all(levels[:-1] < levels[1:]))
    if not 1 <= levels.size <= _MOST_LEVELS or not within:
        raise ParameterError(wrong("levels", given, _LEVELS))
    return tuple(levels.tolist())


def _window(given: Any) -> tuple[float, float]:
    return pair("velocity", given, _WINDOW, unit="m s-1")


class Learn(Parameters):
    """The learned distribution of every impact velocity bin, as quantiles at increasing levels in [0, 1]."""

    levels: Annotated[tuple[float, ...], BeforeValidator(_levels), Allowed(_LEVELS)] = _levels(33)

    def variables(self) -> list[str]:
        """Name the variables of this form."""
        return ["restitution_quantile"]

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Return ``restitution_quantile`` (velocity, level); NaN where there are too few impacts."""
        level = xr.Variable("level", np.array(self.levels), {"long_name": "probability of a smaller one"})
        about = {"long_name": "quantile of restitution"}
        values = quantiles(statistics, np.array(self.levels))
        return xr.Dataset(
            {"restitution_quantile": (("velocity", "level"), values, about)},
            {"level": level, "velocity": statistics["velocity"]},
        )


class Fitted(Parameters):
    """A density fitted to the impacts of a window of impact velocity, its cusp at the law's ε_n or fitted."""

    family: Annotated[str, Allowed(either(_PARAMETERS))] = "asymmetric-laplace"
    velocity: Annotated[tuple[float, float], BeforeValidator(_window), Allowed(_WINDOW)]
    location: Annotated[Literal["normal"] | None, Allowed(_AT_NORMAL)] = None

    def variables(self) -> list[str]:
        """Name the parameters, and the distance."""
        return [*(f"fit_{name}" for name in _PARAMETERS[self.family]), "fit_distance"]

    def check(self, edges: Edges, run: Run) -> None:
        """Refuse what does not go together, or with the bins and the law."""
        bins = edges["velocity"]
        assert bins is not None
        off = max(float(np.abs(bins - end).min()) for end in self.velocity)
        if self.family not in _PARAMETERS:
            raise ParameterError(wrong("fit.family", self.family, either(_PARAMETERS)))
        if off > 1e-6 * (bins[1] - bins[0]):
            raise ParameterError(wrong("fit.velocity", self.velocity, _WINDOW))
        if self.location is not None and self.family not in _CUSPED:
            raise ParameterError(wrong("fit.location", self.location, _AT_NORMAL))
        if self.location is not None and not isinstance(run.standard_law.normal, float):
            text = " = 'normal': must be left out; the law's ε_n depends on the speed"
            raise ParameterError(Problem("fit.location", text))
        if self.location is None and self.family == "cusp-mixture":
            text = ": missing; a cusp-mixture needs location = 'normal'"
            raise ParameterError(Problem("fit.location", text))

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Return ``fit_…`` for each parameter, and ``fit_distance``; NaN where no density can be fitted."""
        from restitution import fit
        from restitution.fit.source import counted

        location = {} if self.location is None else {"location": run.standard_law.normal}
        function = getattr(fit, self.family.replace("-", "_"))
        words = {name: f"{name} of the {self.family} density" for name in _PARAMETERS[self.family]}
        try:
            found = function(statistics, velocity=self.velocity, **location)
            counts = counted(statistics, self.velocity)
            distance = float(np.abs(counts.cumulative() - found.cdf(counts.edges)).max())
            values = {name: float(found.parameters[name]) for name in words}
        except ValueError:  # a body may be so round that all impacts are in a bin or two
            distance, values = np.nan, dict.fromkeys(words, np.nan)
        variables = {f"fit_{name}": ((), values[name], {"long_name": text}) for name, text in words.items()}
        about = {"long_name": "largest difference of the cumulative shares, at the edges of bins"}
        return xr.Dataset(variables | {"fit_distance": ((), distance, about)})


Forms = dict[str, Learn | Fitted]
"""By the table that asks for it: gives variables for a run and its statistics, real ones with errors."""


def forms_of(tables: Mapping[str, Any], edges: Edges | None, run: Run) -> Forms:
    """Read ``[learn]`` and ``[fit]``, which are taken from statistics by impact velocity."""
    found: Forms = {}
    kinds: dict[str, type[Learn] | type[Fitted]] = {"learn": Learn, "fit": Fitted}
    for name, kind in kinds.items():
        if name not in tables:
            continue
        if edges is None or edges["velocity"] is None:
            text = f": missing; [{name}] is taken from statistics by impact velocity"
            raise ParameterError(Problem("statistics.velocity_bins", text))
        found[name] = form = made(name, kind, tables[name])
        if isinstance(form, Fitted):
            form.check(edges, run)
    return found


def with_errors(edges: Edges | None, forms: Iterable[Learn | Fitted]) -> list[str]:
    """Name the variables of statistics and of their forms that have a standard error."""
    if edges is None:
        return []
    derived = MOVED + tuple(DERIVED) if edges["fraction"] is not None else ("density",)
    return [*derived, *(name for form in forms for name in form.variables())]
