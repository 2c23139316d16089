"""Rotation locked to bouncing: why slow dumbbells bounce back up.

    python examples/locking.py locking.png

draws docs/images/locking.png; `python docs/pages.py near-round` also writes the table of docs/near-round.md.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

RADIUS, GRAVITY = 3e-3, 9.81
IMPACTS = 1000
SPEEDS, RESTITUTIONS = np.linspace(0.03, 0.3, 541), np.linspace(0.4, 1.6, 961)
REPEATS, SLOWEST, LENGTH, AFTER = 0.03, 0.03, 50, 20
"""Locked: at least `LENGTH` impacts in a row, each as fast as the one before the last within `REPEATS`, none
slower than `SLOWEST` (in m/s; a body that comes to rest rattles in step as well). It ends at the highest
speed within `AFTER` impacts of the last of them."""
WINDOW = (0.08, 0.13)
"""Speeds in m/s between which the share of locked impacts is counted."""
CASES = ((0.98, 0.1), (0.99, 0.1), (0.95, 0.1), (0.98, 0.05), (0.98, 0.2))
"""ε_n and L/R."""

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def drop(particles: int, seed: int = 1, normal: float = 0.98, elongation: float = 0.1) -> xr.Dataset:
    """Drop dumbbells under the paper's law from 60 mm."""
    body = rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)
    law = rs.TangentialRestitution(normal=normal)
    return rs.simulate(body, law, particles=particles, impacts=IMPACTS, gravity=GRAVITY, seed=seed)


def locked(velocity: Floats) -> tuple[Ints, Ints]:
    """Find where each particle repeats itself longest: every impact as fast as the one before the last.

    Parameters
    ----------
    velocity : ndarray, shape (particles, impacts)
        Impact velocity in m/s, NaN where there was no impact.

    Returns
    -------
    first, last : ndarray of int, shape (particles,)
        Numbers of impacts, between which the speed changes by less than three per cent over two impacts and
        is never below 0.03 m/s.
    """
    fast = velocity > SLOWEST
    with np.errstate(divide="ignore", invalid="ignore"):
        repeats = np.abs(velocity[:, 2:] / velocity[:, :-2] - 1.0) < REPEATS
    repeats &= fast[:, 2:] & fast[:, 1:-1] & fast[:, :-2]
    run = np.zeros(velocity.shape[0], dtype=np.int64)
    length, last = run.copy(), run.copy()
    for number, again in enumerate(repeats.T):
        run = np.where(again, run + 1, 0)
        last = np.where(run > length, number + 2, last)
        length = np.maximum(length, run)
    return last - length - 1, last


def count(data: xr.Dataset) -> dict[str, float]:
    """Count the locked particles of an ensemble, and find where they end.

    Returns
    -------
    dict of str to float
        Shares of the particles with ``one`` bounce and with ``two`` bounces in half a turn, and of the
        ``impacts`` in `WINDOW` which are locked; medians of the speed at which they end in m/s, ``one_end``
        and ``two_end``, of those particles whose record goes on for `AFTER` impacts.
    """
    velocity, contact = data.impact_velocity.to_numpy(), data.contact.to_numpy().astype(int)
    first, last = locked(velocity)
    chosen = np.flatnonzero(last - first >= LENGTH)
    swaps = np.array([np.diff(contact[k, first[k] : last[k] + 1]).astype(bool).mean() for k in chosen])
    ways = {"one": swaps > 0.9, "two": np.abs(swaps - 0.5) < 0.1}
    inside = np.zeros(velocity.shape, dtype=bool)
    for k in chosen[ways["one"] | ways["two"]]:
        inside[k, first[k] : last[k] + 1] = True
    window = (velocity >= WINDOW[0]) & (velocity < WINDOW[1])
    found = {name: float(mask.sum()) / velocity.shape[0] for name, mask in ways.items()}
    found["impacts"] = float(inside[window].mean())
    complete = last[chosen] + AFTER < data.impacts.to_numpy()[chosen]
    for name, mask in ways.items():
        ends = [velocity[k, last[k] : last[k] + AFTER].max() for k in chosen[mask & complete]]
        found[f"{name}_end"] = float(np.median(ends)) if ends else np.nan
    return found


def _mean(values: list[float], scale: float) -> str:
    """Write mean and standard error over the seeds that have a value, with two digits of the error."""
    known = scale * np.array([value for value in values if np.isfinite(value)])
    if known.size < 2:
        return "—"
    error = known.std(ddof=1) / np.sqrt(known.size)
    digits = max(0, 1 - int(np.floor(np.log10(error)))) if error > 0 else 0
    return f"{known.mean():.{digits}f} ± {error:.{digits}f}"


def table(particles: int = 5000, seeds: int = 8) -> str:
    """Write the table of docs/near-round.md."""
    unit = np.sqrt(GRAVITY * RADIUS)
    lines = [
        "| ε_n | L/R | locked, of 1000: one bounce | two bounces | locked impacts from "
        f"{WINDOW[0]:g} to {WINDOW[1]:g} m/s (%) | end, one bounce (m/s) | in √(gR) "
        "| end, two bounces (m/s) | in √(gR) |",
        "|---" * 9 + "|",
    ]
    for normal, elongation in CASES:
        each = [count(drop(particles, seed, normal, elongation)) for seed in range(1, seeds + 1)]
        cells = [f"{normal:g}", f"{elongation:g}"]
        for name, scale in (
            ("one", 1000.0),
            ("two", 1000.0),
            ("impacts", 100.0),
            ("one_end", 1.0),
            ("one_end", 1.0 / unit),
            ("two_end", 1.0),
            ("two_end", 1.0 / unit),
        ):
            cells.append(_mean([found[name] for found in each], scale))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def draw(path: Path, particles: int = 100_000) -> None:
    """Draw the density of ε at every speed, and some particles that are locked."""
    found = rs.statistics(
        rs.Dumbbell(radius=RADIUS, separation=0.1 * RADIUS),
        rs.TangentialRestitution(normal=0.98),
        particles=particles,
        impacts=IMPACTS,
        gravity=GRAVITY,
        velocity_bins=SPEEDS,
        restitution_bins=RESTITUTIONS,
    )
    data = drop(500)
    velocity = data.impact_velocity.to_numpy()
    for style in SITE:
        _draw(found, velocity, style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)


@fg.styled
def _draw(found: xr.Dataset, velocity: Floats, *, style: Style | None = None) -> Figure:
    first, last = locked(velocity)
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.9, 1, 2)
    mesh = fg.population(left, SPEEDS, RESTITUTIONS, found["restitution_count"].to_numpy())
    fg.population_bar(figure, mesh, left)
    left.set(xlabel="impact velocity $v$ (m/s)", ylabel=r"$\varepsilon$")
    fg.letter(left, "(a)", left=False)
    each = np.arange(velocity.shape[0])
    start, end = first + (last - first) % 2, last  # of the same one of the two
    climb = velocity[each, end] - velocity[each, start]
    in_pairs = np.abs(velocity[each, start + 1] / velocity[each, start] - 1.0) > 0.1
    order = np.argsort(-climb)
    shown = np.concatenate([order[~in_pairs[order]][:2], order[in_pairs[order]][:1]])
    for particle, color in zip(shown, colors(), strict=False):
        early, late = slice(0, first[particle] + 1), slice(last[particle], None)
        for part in (early, late):
            number = np.arange(IMPACTS)[part]
            right.plot(number, velocity[particle, part], color=color, linewidth=0.4)
        for one in (first[particle], first[particle] + 1):
            number = np.arange(one, last[particle] + 1, 2)
            right.plot(number, velocity[particle, number], color=color, linewidth=1.4)
    right.set(xlim=(0, IMPACTS), ylim=(0.0, 0.3), xlabel="number of the impact")
    right.set_ylabel("impact velocity $v$ (m/s)")
    fg.letter(right, "(b)", left=False)
    return figure


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
