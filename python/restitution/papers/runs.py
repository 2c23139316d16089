"""The simulations behind a paper's figures and claims: each with a seed of its own, recorded or counted."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
import xarray as xr

import restitution as rs
from restitution._core import STOP_REASONS
from restitution.bodies import AnyBody
from restitution.drop.energy import reported_elsewhere
from restitution.figures.report import grouped
from restitution.laws import Law

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Runs:
    """Base of a paper's runs: a dataclass of Datasets, and of mappings that end in Datasets.

    A Dataset is recorded as from `restitution.simulate`, or counted as from `restitution.statistics`;
    `Runner` makes both. Its attrs hold its own seed and, as ``run``, its name.
    """

    seed: int  # that those of all runs derive from
    asked: int  # impacts
    _found: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    def all(self) -> dict[str, xr.Dataset]:
        """Return the runs by name, in the order of the fields; one that was counted in several bins once."""
        return {str(data.attrs["run"]): data for data in _datasets(vars(self))}

    @property
    def version(self) -> str:
        """The version of the package that made them."""
        return str(next(iter(self.all().values())).attrs["version"])

    def once(self, name: str, work: Callable[[], T]) -> T:
        """Compute a result that several claims need the first time only; `name` identifies it."""
        if name not in self._found:
            self._found[name] = work()
        found: T = self._found[name]
        return found


def _datasets(value: Any) -> Iterator[xr.Dataset]:
    if isinstance(value, xr.Dataset):
        yield value
    elif isinstance(value, Mapping):
        for part in value.values():
            yield from _datasets(part)


def derived_seed(seed: int, name: str) -> int:
    """Return the seed in [0, 2⁶³) of the run called `name`, which no other run's name or presence changes."""
    sequence = np.random.SeedSequence(seed, spawn_key=tuple(name.encode()))
    return int(sequence.generate_state(1, np.uint64)[0] >> np.uint64(1))


@dataclass(frozen=True)
class Runner:
    """Runs simulations one after the other, each with the seed of its name; `done` is called after each."""

    seed: int
    threads: int | None = None
    done: Callable[[], object] = lambda: None

    def record(self, name: str, body: AnyBody, law: Law, **how: Any) -> xr.Dataset:
        """Record every impact of a run; `how` as in `restitution.simulate`."""
        with reported_elsewhere():  # by a claim, or a section of the report
            seed = derived_seed(self.seed, name)
            data = rs.simulate(body, law, seed=seed, threads=self.threads, **how)
        self.done()
        return data.assign_attrs(run=name)

    def count(
        self, recorded: xr.Dataset, body: AnyBody, law: Law, *, particles: int, **bins: Any
    ) -> xr.Dataset:
        """Count the impacts of at least so many particles, of which the recorded ones are the first."""
        about = recorded.attrs
        same = {name: about[name] for name in ("impacts", "release_height", "gravity", "orientation", "seed")}
        with reported_elsewhere():
            found = rs.statistics(
                body,
                law,
                particles=max(particles, recorded.sizes["particle"]),
                threads=self.threads,
                batches=1,
                **same,
                **bins,
            )
        self.done()
        return found.assign_attrs(run=f"{about['run']}, counted")


def is_counted(data: xr.Dataset) -> bool:
    """Test whether a run's impacts were counted and not recorded."""
    return "particles_ended" in data


def impacts_of(data: xr.Dataset) -> int:
    """Return the number of impacts of a run, in the bins or not."""
    if not is_counted(data):
        return int(data["impacts"].sum())
    inside = data["number"].sum() + data["undefined"].sum()
    return int(inside + data["velocity_underflow"] + data["velocity_overflow"])


def _ended(data: xr.Dataset) -> str:
    """Count the trajectories by the reason why they ended."""
    numbers = (
        data["particles_ended"].to_numpy()
        if is_counted(data)
        else np.bincount(data["stop_reason"].to_numpy(), minlength=len(STOP_REASONS))
    )
    return ", ".join(
        f"{grouped(int(n))} {reason.replace('_', ' ')}"
        for reason, n in zip(STOP_REASONS, numbers, strict=True)
        if n
    )


DROPPED: Mapping[str, Callable[[xr.Dataset], str]] = {
    "particles": lambda data: grouped(data.attrs["particles"]),
    "impacts": lambda data: grouped(impacts_of(data)),
    "trajectories ended": _ended,
}
"""Columns of the size of a run of dropped particles."""
