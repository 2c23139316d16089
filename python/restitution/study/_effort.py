"""How many particles a point gets, in which portions, and when it has enough."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import reals, whole
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.run import Run
from restitution.study._tables import number, table

_KEYS = ("batches", "until", "velocities", "most_particles")
_SHORT = ("mean", "std")
"""Mean and standard deviation of restitution may be asked for by these words."""
_BATCHES = 16
_MOST_DOUBLINGS = 10
_MOST_PARTICLES = 2**40 - 1
"""Of a point; as many as a run can have."""
TASK = 100_000_000
"""Impacts of a task, at most, where batches are not larger."""


@dataclass(frozen=True, eq=False)
class Effort(Content):
    """Particles and batches of a point.

    Particles come in blocks of the run's ``particles``; a block is cut into batches. A point begins with one
    block and doubles the number until it has enough.

    Attributes
    ----------
    particles : int
        Particles of a block.
    batches : int
        Batches of a block. Standard errors are taken over as many groups; group g has batch g of every block.
    blocks : int
        Most blocks of a point, a power of 2.
    impacts : int
        Most impacts of a particle.
    until : mapping of str to float or str
        Standard errors that are asked for: of a variable, absolute or, as ``"1 %"``, relative.
    velocities : tuple of two floats, or None
        Bins of impact velocity, by their centres, in which they are asked for; in m/s.
    """

    particles: int
    batches: int
    blocks: int
    impacts: int
    until: Mapping[str, float | str]
    velocities: tuple[float, float] | None

    def part(self, batch: int) -> tuple[int, int]:
        """First particle of a batch, and the one after its last."""
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
        """Everything that results depend on, as plain values."""
        velocities = list(self.velocities) if self.velocities else None
        most = self.blocks * self.particles
        return {
            "batches": self.batches,
            "until": dict(self.until),
            "velocities": velocities,
            "most_particles": most,
        }

    def check(self, names: Collection[str]) -> None:
        """Refuse to wait for the standard error of a variable that is not among those that have one."""
        for name in self.until:
            if _variable(name) not in names:
                there = f"there are {', '.join(sorted(names))}" if names else "no variable has one"
                raise ParameterError(Problem(f"effort.until.{name}", f": has no standard error; {there}"))

    def is_enough(self, found: xr.Dataset, blocks: int) -> bool:
        """Whether a point with so many blocks is finished."""
        return blocks >= self.blocks or all(self._excess(found, name) <= 1.0 for name in self.until)

    def needed(self, found: xr.Dataset, particles: int) -> int:
        """Predict the blocks of a point from a pilot: squares of standard errors fall with the particles."""
        excess = max((self._excess(found, name) for name in self.until), default=0.0)
        if not np.isfinite(excess):
            return self.blocks
        blocks = excess**2 * particles / self.particles
        return min(self.blocks, 1 << max(0, int(np.ceil(np.log2(max(blocks, 1.0))))))

    def _excess(self, found: xr.Dataset, name: str) -> float:
        """Give the largest standard error over the one that is asked for; infinite where one is unknown."""
        self.check([str(key)[:-6] for key in found if str(key).endswith("_error")])
        wanted = _variable(name)
        value, error = found[wanted], found[f"{wanted}_error"]
        if "velocity" in value.dims:
            if self.velocities is None:
                kept = found["number"].to_numpy() > 0
            else:
                centres = found["velocity"].to_numpy()
                kept = (centres >= self.velocities[0]) & (centres <= self.velocities[1])
            value, error = (x.isel(velocity=np.flatnonzero(kept)) for x in (value, error))
        target = self.until[name]
        allowed = _share(target) * np.abs(value.to_numpy()) if isinstance(target, str) else target
        with np.errstate(divide="ignore", invalid="ignore"):
            excess = np.where(error.to_numpy() == 0.0, 0.0, error.to_numpy() / allowed)
        return float(np.max(np.where(np.isnan(excess), np.inf, excess), initial=0.0))


def effort(given: Any, run: Run) -> Effort:
    """Read the table ``[effort]``."""
    own = table("effort", given, _KEYS)
    batches = _batches(own.get("batches", min(_BATCHES, run.particles)), run.particles)
    until = _until(own.get("until", {}))
    velocities = _velocities(own.get("velocities"))
    usual = min(_MOST_PARTICLES, 2**_MOST_DOUBLINGS * run.particles) if until else run.particles
    most = whole("effort.most_particles", own.get("most_particles", usual), run.particles, _MOST_PARTICLES)
    if not until and most != run.particles:
        raise ParameterError(
            Problem("effort.most_particles", ": is for `until`; without it run.particles decides")
        )
    if until and (run.angles is not None or run.spins is not None):
        text = ": particles cannot be added where orientation or spin are given one by one"
        raise ParameterError(Problem("effort.until", text))
    blocks = 1 << (most // run.particles).bit_length() - 1
    return Effort(run.particles, batches, blocks, run.impacts, MappingProxyType(until), velocities)


def _batches(value: Any, particles: int) -> int:
    if particles < 2:
        text = f" = {particles}: must be at least 2, of which batches for standard errors are made"
        raise ParameterError(Problem("run.particles", text))
    return whole("effort.batches", value, 2, min(particles, 4096))


def _until(value: Any) -> dict[str, float | str]:
    if not isinstance(value, Mapping):
        raise ParameterError(wrong("effort.until", value, "a table of standard errors, as { std = 0.01 }"))
    allowed = 'a number > 0, or a share as "1 %"'
    until: dict[str, float | str] = {}
    for name, target in value.items():
        share = _share(target) if isinstance(target, str) else None
        if share is None or not 0 < share < np.inf:
            until[name] = number(f"effort.until.{name}", target, allowed, lambda size: 0 < size < np.inf)
        else:
            until[name] = str(target)
    return until


def _variable(name: str) -> str:
    return f"{name}_restitution" if name in _SHORT else name


def _velocities(value: Any) -> tuple[float, float] | None:
    if value is None:
        return None
    allowed = "a pair (low, high) with low < high, in m/s"
    ends = reals("effort.velocities", value, allowed, unit="m s-1", dimensions=(1,), finite=False)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ParameterError(wrong("effort.velocities", value, allowed))
    return float(ends[0]), float(ends[1])


def _share(text: str) -> float | None:
    """Read ``"1 %"``."""
    number, sign, rest = text.partition("%")
    try:
        return float(number) / 100.0 if sign and not rest.strip() else None
    except ValueError:
        return None
