"""From an ensemble to the Dataset of a learned distribution."""

from collections.abc import Iterator
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._internal.arrays import check_each, either, reals
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution._internal.process import uninterrupted
from restitution._internal.resources import checked_threads, progress_bar
from restitution.distribution import _nodes
from restitution.distribution._check import Check
from restitution.distribution._count import Counter
from restitution.distribution._defaults import speeds
from restitution.distribution._ensemble import FRESH, Ensemble, Impacts
from restitution.distribution._pilot import Pilot, Sample
from restitution.distribution._store import assemble
from restitution.distribution._table import Floats, Table
from restitution.drop.dataset import attributes
from restitution.drop.energy import LEDGER
from restitution.drop.run import Run
from restitution.drop.statistics import dataset_of, edges_of

Given: TypeAlias = Literal["rotational_fraction", "previous"]

_JUDGED = 256
"""Particles whose impacts tell how much energy is created."""
_SLOWEST, _FASTEST = 1e-100, 1e100
"""In m/s; squares and quotients of such speeds neither over- nor underflow."""


def learn(ensemble: Ensemble, nodes: Floats, given: Given | None, progress: bool) -> xr.Dataset:
    """Simulate the ensemble, count its impacts, and measure the result against a fresh ensemble."""
    if given is not None and not (isinstance(given, str) and given in get_args(Given)):
        raise ParameterError(wrong("given", given, f"{either(get_args(Given))} or None"))
    total = (2 if given is None else 3) * ensemble.run.particles
    done = 0

    with progress_bar("learn", total, "particles", show=progress) as tell:

        def advance(particles: int) -> None:
            nonlocal done
            done += particles
            if tell is not None:
                tell(done)

        pilot = Pilot.of(ensemble, nodes[0], nodes[-1])
        if nodes.size == 2:
            nodes = pilot.density.speeds(pilot.scale)
        everywhere = [np.zeros(1)] * nodes.size
        sample = Sample(pilot.blocks(), nodes, lambda _: None)
        _enough(sample, nodes, pilot.scale)
        edges = _edges(sample, pilot.scale, nodes, everywhere)
        del sample
        counter = Counter(nodes, everywhere, edges)
        met = _nodes.Met(nodes[0], nodes[-1])
        blocks = met.watch(pilot.whole(advance, last=given is None))
        counter.add_all(blocks, lambda _: None, ensemble.threads)
        counted = counter.counted()
        del counter
        table = Table.of(nodes, counted.histograms)
        conditional = None
        if given is not None:

            def look(block: Impacts) -> Floats:
                return condition(given, block, table, ensemble.threads)

            sample = Sample(pilot.blocks(), nodes, look)
            groups = [_nodes.conditions(z) for _, z in sample.near()]
            edges = _edges(sample, pilot.scale, nodes, groups)
            del sample
            counter = Counter(nodes, groups, edges)
            counter.add_all(pilot.whole(advance, last=True), look, ensemble.threads)
            conditional = counter.counted()
            del counter
        check = Check.of(table, ensemble.blocks(FRESH, advance), ensemble.threads)
    attrs = attributes(
        ensemble.run, "Distribution of the coefficient of restitution at given impact velocity"
    )
    if len(ensemble.heights) > 1:
        attrs["release_height"] = list(ensemble.heights)
    return assemble(counted, conditional, given, check, attrs | _energy(ensemble), met.gaps())


def _energy(ensemble: Ensemble) -> dict[str, Any]:
    """Return the attributes on the kinetic energy that impacts create, as a few of the particles have it."""
    few = ensemble.run.of(np.arange(min(ensemble.run.particles, _JUDGED)))
    edges = edges_of([0.0, 1.0], [0.0, 1.0], None)
    parts = [(0, few.particles)]
    table, _, interrupted = _core.statistics(
        few.parameters(), edges, checked_threads(ensemble.threads), None, parts
    )
    found = dataset_of(few, edges, uninterrupted(table, interrupted)).attrs
    return {name: found[name] for name in LEDGER if name in found}


def checked_speeds(velocities: npt.ArrayLike | None, run: Run) -> Floats:
    """Return the least and the greatest speed to learn, or all nodes, in m/s."""
    if velocities is None:
        return speeds(run)
    allowed = "the least and the greatest speed, or all nodes, finite, in m/s"
    nodes = np.array(reals("velocities", velocities, allowed, unit="m s-1", dimensions=(1,), finite=False))
    if nodes.size < 2 or not np.all(np.isfinite(nodes)):
        raise ParameterError(wrong("velocities", velocities, allowed))
    if nodes[0] <= 0 or not np.all(np.diff(nodes) > 0):
        raise ParameterError(wrong("velocities", velocities, "> 0 and strictly increasing"))
    allowed = f"in [{_SLOWEST:g}, {_FASTEST:g}] m/s, to be squared"
    check_each("velocities", nodes, (nodes >= _SLOWEST) & (nodes <= _FASTEST), allowed)
    return nodes


def _edges(sample: Sample, scale: float, nodes: Floats, conditions: list[Floats]) -> list[Floats]:
    """Place the inner edges of the bins of each component."""
    found = _at_nodes(sample, nodes, conditions)
    return [_nodes.bins(restitution, scale, where) for restitution, where in found]


def _at_nodes(sample: Sample, nodes: Floats, conditions: list[Floats]) -> Iterator[tuple[Floats, str]]:
    """Yield the restitutions that count at each component, and how an error names the component."""
    for speed, group, (restitution, z) in zip(nodes, conditions, sample.near(), strict=True):
        where = f"{speed:.4g} m/s"
        if group.size == 1:
            yield restitution, where
            continue
        for k, condition in enumerate(group):
            # An impact counts at the conditions next to its own; beyond them all, at the last one.
            above = z > group[k - 1] if k > 0 else np.ones(z.size, dtype=bool)
            below = z < group[k + 1] if k + 1 < group.size else np.ones(z.size, dtype=bool)
            yield restitution[above & below], f"{where} and condition {condition:.4g}"


def condition(given: Given, block: Impacts, table: Table, threads: int | None = None) -> Floats:
    """Return z for each impact, in the shape of the block.

    The quantile level of the impact before is NaN for the first impact. Where that one was slower or faster
    than all nodes, its level is that at the nearest.
    """
    if given == "rotational_fraction":
        return block.fraction
    z = np.full(block.velocity.shape, np.nan)
    z[:, 1:] = table.value("cdf", block.restitution[:, :-1], block.velocity[:, :-1], threads=threads)
    return z


def _enough(sample: Sample, nodes: Floats, scale: float) -> None:
    """Refuse ranges with speeds that are hardly ever met."""
    impacts = scale * sample.impacts()
    if impacts.min() < _nodes.LEAST_IMPACTS:
        at = int(np.argmin(impacts))
        found = f": {impacts[at]:.0f} impacts between {nodes[at]:.6g} and {nodes[at + 1]:.6g} m/s; "
        allowed = f"must be speeds with at least {_nodes.LEAST_IMPACTS} impacts between any two nodes"
        how = ": more particles, more impacts of each, another range, or heights of release that are spread"
        raise ParameterError(Problem("velocities", found + allowed + how))
