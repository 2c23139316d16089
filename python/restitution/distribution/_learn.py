"""From an ensemble to the Dataset of a learned distribution."""

from collections.abc import Callable, Iterable, Iterator
from typing import Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._arrays import reals
from restitution._dataset import attributes
from restitution._parameters import ParameterError, Problem, wrong
from restitution._resources import progress_bar
from restitution._run import Run
from restitution.distribution import _nodes
from restitution.distribution._check import Check
from restitution.distribution._count import Counter, shares
from restitution.distribution._defaults import speeds
from restitution.distribution._ensemble import FRESH, LEARNING, Ensemble, Impacts
from restitution.distribution._store import assemble
from restitution.distribution._table import Floats, Table

Given: TypeAlias = Literal["rotational_fraction", "previous"]
Part: TypeAlias = tuple[Floats, Floats, Floats]
"""Impact velocity, restitution and condition of single impacts."""

_PILOT = 2_000_000


def learn(ensemble: Ensemble, nodes: Floats, given: Given | None, progress: bool) -> xr.Dataset:
    """Simulate the ensemble, count its impacts, and measure the result against a fresh ensemble."""
    if given is not None and not (isinstance(given, str) and given in get_args(Given)):
        raise ParameterError(wrong("given", given, " or ".join(map(repr, get_args(Given))) + " or None"))
    total = (2 if given is None else 3) * ensemble.run.particles
    done = 0

    with progress_bar("learn", total, "particles", show=progress) as tell:

        def advance(particles: int) -> None:
            nonlocal done
            done += particles
            if tell is not None:
                tell(done)

        pilot, scale = _pilot(ensemble, nodes)
        if nodes.size == 2:
            nodes = _nodes.speeds([block.velocity for block in pilot], nodes[0], nodes[1], scale)
        _enough(pilot, nodes, scale)
        everywhere = [np.zeros(1)] * nodes.size
        counter = _count(ensemble, pilot, scale, nodes, everywhere, _unconditional, advance)
        table = Table.of(nodes, [histogram for histogram, _, _ in counter.histograms()])
        conditional = None
        if given is not None:

            def look(block: Impacts) -> Part:
                z = condition(given, block, table)
                return block.velocity.ravel(), block.restitution.ravel(), z.ravel()

            groups = _condition_nodes(map(look, pilot), nodes)
            conditional = _count(ensemble, pilot, scale, nodes, groups, look, advance)
        del pilot
        check = Check.of(table, ensemble.blocks(FRESH, advance))
    attrs = attributes(
        ensemble.run, "Distribution of the coefficient of restitution at given impact velocity"
    )
    if len(ensemble.heights) > 1:
        attrs["release_height"] = list(ensemble.heights)
    return assemble(counter, conditional, given, check, attrs)


def checked_speeds(velocities: npt.ArrayLike | None, run: Run) -> Floats:
    """Give the least and the greatest speed to learn, or all nodes, in m/s."""
    if velocities is None:
        return speeds(run)
    allowed = "the least and the greatest speed, or all nodes, finite, in m/s"
    nodes = np.array(reals("velocities", velocities, allowed, unit="m s-1", dimensions=(1,), finite=False))
    if nodes.size < 2 or not np.all(np.isfinite(nodes)):
        raise ParameterError(wrong("velocities", velocities, allowed))
    if nodes[0] <= 0 or not np.all(np.diff(nodes) > 0):
        raise ParameterError(wrong("velocities", velocities, "> 0 and strictly increasing"))
    return nodes


def _pilot(ensemble: Ensemble, nodes: Floats) -> tuple[list[Impacts], float]:
    """Simulate part of the ensemble, and return how many times larger the whole is.

    The part has particles from every height of release: where the energy that is lost at an impact hardly
    varies, each height contributes impacts of its own at each node, and bins that were placed without them
    would hold several times their share.
    """
    run = ensemble.run
    share = min(1.0, _PILOT / (run.particles * run.impacts))
    while True:
        pilot, particles, impacts = [], 0, 0
        for block in ensemble.blocks(LEARNING, share=share):
            pilot.append(block)
            particles += block.velocity.shape[0]
            impacts += int(np.count_nonzero((block.velocity >= nodes[0]) & (block.velocity < nodes[-1])))
        if share == 1.0 or impacts >= _PILOT / 2:
            return pilot, run.particles / particles
        share = min(1.0, share * _PILOT / max(impacts, 1))


def _count(
    ensemble: Ensemble,
    pilot: list[Impacts],
    scale: float,
    nodes: Floats,
    conditions: list[Floats],
    look: Callable[[Impacts], Part],
    advance: Callable[[int], None],
) -> Counter:
    edges = [
        _nodes.bins(restitution, scale, where)
        for restitution, where in _at_nodes(map(look, pilot), nodes, conditions)
    ]
    counter = Counter(nodes, conditions, edges)
    for block in ensemble.blocks(LEARNING, advance):
        counter.add(block.batch, *look(block))
    return counter


def _at_nodes(parts: Iterable[Part], nodes: Floats, conditions: list[Floats]) -> Iterator[tuple[Floats, str]]:
    """Yield the restitutions that count at each component, and how an error names the component."""
    inside = []
    for velocity, restitution, z in parts:
        between = (velocity >= nodes[0]) & (velocity < nodes[-1])
        counted = between & np.isfinite(restitution) & np.isfinite(z)
        inside.append((velocity[counted], restitution[counted], z[counted]))
    velocity, restitution, z = map(np.concatenate, zip(*inside, strict=True))
    del inside
    order = np.argsort(velocity)
    velocity, restitution, z = velocity[order], restitution[order], z[order]
    start = np.searchsorted(velocity, np.concatenate([nodes[:1], nodes[:-1]]), side="left")
    stop = np.searchsorted(velocity, np.concatenate([nodes[1:], nodes[-1:]]), side="left")
    for i, group in enumerate(conditions):
        near = slice(start[i], stop[i])
        for k, chosen, weight in shares(z[near], group):
            where = f"{nodes[i]:.4g} m/s"
            if group.size > 1:
                where += f" and condition {group[k]:.4g}"
            yield restitution[near][chosen][np.broadcast_to(weight > 0, z[near][chosen].shape)], where


def _condition_nodes(parts: Iterable[Part], nodes: Floats) -> list[Floats]:
    columns = ((velocity, z, np.zeros_like(z)) for velocity, _, z in parts)
    near = _at_nodes(columns, nodes, [np.zeros(1)] * nodes.size)
    return [_nodes.conditions(values) for values, _ in near]


def _unconditional(block: Impacts) -> Part:
    return block.velocity.ravel(), block.restitution.ravel(), np.zeros(block.velocity.size)


def condition(given: Given, block: Impacts, table: Table) -> Floats:
    """Give z for each impact, in the shape of the block.

    The quantile level of the impact before is NaN for the first impact. Where that one was slower or faster
    than all nodes, its level is that at the nearest.
    """
    if given == "rotational_fraction":
        return block.fraction
    z = np.full(block.velocity.shape, np.nan)
    z[:, 1:] = table.value("cdf", block.restitution[:, :-1], block.velocity[:, :-1])
    return z


def _enough(pilot: list[Impacts], nodes: Floats, scale: float) -> None:
    """Refuse ranges with speeds that are hardly ever met."""
    velocity = np.concatenate([block.velocity.ravel() for block in pilot])
    impacts = scale * np.histogram(velocity[np.isfinite(velocity)], nodes)[0]
    if impacts.min() < _nodes.LEAST_IMPACTS:
        at = int(np.argmin(impacts))
        found = f": {impacts[at]:.0f} impacts between {nodes[at]:.6g} and {nodes[at + 1]:.6g} m/s; "
        allowed = f"must be speeds with at least {_nodes.LEAST_IMPACTS} impacts between any two nodes"
        raise ParameterError(
            Problem(
                "velocities", found + allowed + ": more particles, more impacts of each, or another range"
            )
        )
