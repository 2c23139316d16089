"""Rotation locked to bouncing: why slow dumbbells bounce back up.

    python examples/locking.py locking.png

draws docs/images/locking.png.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import restitution as rs
from restitution import figures as fg

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
LAW = rs.TangentialRestitution(normal=0.98)
IMPACTS = 1000
SPEEDS, RESTITUTIONS = np.linspace(0.03, 0.3, 541), np.linspace(0.4, 1.6, 961)
_REPEATS = 0.03

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def locked(velocity: Floats) -> tuple[Ints, Ints]:
    """Find where each particle repeats itself longest: every impact as fast as the one before the last.

    Parameters
    ----------
    velocity : ndarray, shape (particles, impacts)
        Impact velocity, NaN where there was no impact.

    Returns
    -------
    first, last : ndarray of int, shape (particles,)
        Numbers of impacts, between which the speed changes by less than three per cent over two.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        repeats = np.abs(velocity[:, 2:] / velocity[:, :-2] - 1.0) < _REPEATS
    run = np.zeros(velocity.shape[0], dtype=np.int64)
    length, last = run.copy(), run.copy()
    for number, again in enumerate(repeats.T):
        run = np.where(again, run + 1, 0)
        last = np.where(run > length, number + 2, last)
        length = np.maximum(length, run)
    return last - length - 1, last


@fg.styled
def draw(path: Path, particles: int = 100_000) -> None:
    """Draw the density of ε at every speed, and some particles that are locked."""
    found = rs.statistics(
        BODY,
        LAW,
        particles=particles,
        impacts=IMPACTS,
        velocity_bins=SPEEDS,
        restitution_bins=RESTITUTIONS,
    )
    data = rs.simulate(BODY, LAW, particles=500, impacts=IMPACTS)
    velocity = data.impact_velocity.to_numpy()
    first, last = locked(velocity)
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.9, 1, 2)
    mesh = fg.population(left, SPEEDS, RESTITUTIONS, found["count"].to_numpy())
    fg.population_bar(figure, mesh, left)
    left.set(xlabel="impact velocity $v$ (m/s)", ylabel=r"$\varepsilon$")
    fg.letter(left, "(a)", left=False)
    each = np.arange(velocity.shape[0])
    start, end = first + (last - first) % 2, last  # of the same one of the two
    climb = velocity[each, end] - velocity[each, start]
    in_pairs = np.abs(velocity[each, start + 1] / velocity[each, start] - 1.0) > 0.1
    order = np.argsort(-climb)
    shown = np.concatenate([order[~in_pairs[order]][:2], order[in_pairs[order]][:1]])
    for particle, color in zip(shown, fg.COLORS, strict=False):
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
    figure.savefig(path, dpi=200)


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
