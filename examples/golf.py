"""The double golf ball: coefficients of restitution from -4 to +2, in closed form and simulated.

    python examples/golf.py golf.png

draws docs/images/golf.png; `python docs/pages.py shapes` also writes the table of docs/shapes.md.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.optimize import brentq

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors, ink
from restitution.laws import Law

RADIUS, MASS = 21.3e-3, 45.9e-3
"""Of one ball, in m and kg."""
BODY = rs.Dumbbell(radius=RADIUS, separation=2.0 * RADIUS, density=MASS / (4.0 / 3.0 * np.pi * RADIUS**3))
NORMAL, GRAVITY = 0.8, 9.81
DROP = 0.06
"""Release height less 2R, what an upright body falls, in m."""
HEIGHT = 2.0 * RADIUS + DROP
SPINS = (0.0, 40.0, 80.0, 120.0)
"""About the horizontal y axis, in rad/s."""


def restitution(law: Law, angle: np.ndarray, velocity: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """Coefficient of restitution of an impact of the double ball that stays in the x-z plane.

    The axis leans by the angle from the vertical towards x and turns with the spin ω about y; the centre of
    mass falls with v. The lower ball touches, x sideways of the centre of mass and a below it in units of R,
    and the point of contact approaches with v(1 + q), q = ωRx/v. With J/(mR²) = 7/5, K_nn = 1 + 5x²/7,
    K_uu = 1 + 5a²/7 and K_nu = 5ax/7 the normal impulse P, per mass, gives ε = -1 + P/v. A plane that does
    not pull has P ≥ 0: ε ≥ -1 of a body that falls, ε ≤ -1 of one that rises, v < 0.

    For Coulomb's law only if the slip neither stops nor turns, for Chatterjee's only within the friction
    cone.
    """
    inertia = 7.0 / 5.0
    side = -np.sign(np.cos(angle))
    x, a = side * np.sin(angle), 1.0 + np.abs(np.cos(angle))
    fall, turning = velocity / RADIUS, spin
    approach, slip = fall + turning * x, -turning * a
    nn, uu, nu = 1.0 + x**2 / inertia, 1.0 + a**2 / inertia, a * x / inertia
    determinant = nn * uu - nu**2
    compression = approach / nn  # of the frictionless impact
    if isinstance(law, rs.Frictionless):
        impulse = (1.0 + law.constant) * compression
    elif isinstance(law, rs.Coulomb):
        impulse = (1.0 + law.constant) * approach / (nn - law.friction * np.sign(slip) * nu)
    elif isinstance(law, rs.ChatterjeeRuina):
        sticking = (uu * approach + nu * slip) / determinant
        impulse = (1.0 + law.constant) * compression + (1.0 + law.tangential) * (sticking - compression)
    elif isinstance(law, rs.TangentialRestitution):
        impulse = uu * (1.0 + law.constant) * approach - nu * (law.tangential - 1.0) * slip
        impulse = impulse / determinant
    else:
        raise TypeError(law)
    return -1.0 + impulse / fall


def drop(law: Law, spin: float, particles: int, impacts: int):
    """Drop double balls that tumble about y, from all angles of the half circle."""
    angles = np.pi * (np.arange(particles) + 0.5) / particles
    return rs.simulate(
        BODY,
        law,
        particles=particles,
        impacts=impacts,
        release_height=HEIGHT,
        gravity=GRAVITY,
        orientation=np.stack([angles, np.zeros(particles)], axis=1),
        spin=(0.0, spin, 0.0),
    )


def spin_for(law: Law, angle: float, velocity: float, wanted: float) -> float:
    """Find the spin in rad/s at which an impact at `angle` (rad) with `velocity` (m/s) has the ε `wanted`."""

    def excess(spin: float) -> float:
        return float(restitution(law, np.array(angle), np.array(velocity), np.array(spin))) - wanted

    return float(brentq(excess, 1.0, 2000.0, xtol=1e-12))


def table() -> str:
    """Write the table of docs/shapes.md: the spins in rad/s for ε = +2 and for ε = −4."""
    falling, rising, rise = np.radians(150.0), np.radians(110.0), 0.5
    speed = float(np.sqrt(2.0 * GRAVITY * (HEIGHT - RADIUS * (1.0 + np.abs(np.cos(falling))))))
    lines = [
        f"| spin in rad/s for | ε = +2: released at 2R + {1e3 * DROP:g} mm, 150° at the impact | "
        f"ε = −4: rising with {rise:g} m/s, 110° |",
        "|---|---|---|",
    ]
    for name, law in {
        "`Frictionless`": rs.Frictionless(normal=NORMAL),
        "`Coulomb`, μ = 0.1, slips": rs.Coulomb(normal=NORMAL, friction=0.1),
        "`ChatterjeeRuina`, e_t = 0, sticks": rs.ChatterjeeRuina(normal=NORMAL, tangential=0.0, friction=1e6),
        "`TangentialRestitution`, ε_t = 1": rs.TangentialRestitution(normal=NORMAL, tangential=1.0),
        "`TangentialRestitution`, ε_t = 0": rs.TangentialRestitution(normal=NORMAL, tangential=0.0),
    }.items():
        spins = spin_for(law, falling, speed, 2.0), spin_for(law, rising, -rise, -4.0)
        lines.append(f"| {name} | {spins[0]:.0f} | {spins[1]:.0f} |")
    return "\n".join(lines)


def extremes(ratio: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Largest and least ε of a smooth double ball that falls, and least of one that rises, at |ω|R/|v|."""
    x = np.linspace(0.0, 1.0, 1001)[:, None]
    gain = (1.0 + NORMAL) / (1.0 + x**2 / 1.4)
    most, least = np.max(gain * (1.0 + ratio * x), axis=0), np.min(gain * (1.0 - ratio * x), axis=0)
    rising = np.max(gain * (ratio * x - 1.0), axis=0)
    return -1.0 + most, -1.0 + np.maximum(least, 0.0), -1.0 - np.maximum(rising, 0.0)


def first_impacts(axes: Axes) -> None:
    """Draw ε of the first impact against the angle at the impact."""
    smooth = rs.Frictionless(normal=NORMAL)
    angle = np.linspace(0.0, np.pi, 720)  # not 90°, where the other ball takes over
    lift = RADIUS * (1.0 + np.abs(np.cos(angle)))
    speed = np.sqrt(2.0 * GRAVITY * (HEIGHT - lift))
    for spin, color, marker in zip(SPINS, colors(), fg.MARKERS, strict=False):
        line = restitution(smooth, angle, speed, np.full(angle.shape, spin))
        line[line < -1.0] = np.nan  # the contact would open
        line[359] = np.nan
        axes.plot(np.degrees(angle), line, color=color)
        for law, filled in ((smooth, True), (rs.Coulomb(normal=NORMAL, friction=0.2), False)):
            found = drop(law, spin, 60, 1).isel(impact=0)
            met = np.degrees(found.release_angle + spin * found.time) % 180.0
            face = color if filled else "none"
            label = f"{spin:.0f} rad/s" if filled else None
            axes.plot(met, found.restitution, marker, color=color, mfc=face, mew=0.6, ms=2.6, label=label)
    axes.axhline(-1.0, color="0.5", lw=0.6, ls="--")
    axes.set(xlim=(0.0, 180.0), xticks=range(0, 181, 45), ylim=(-1.25, 3.0))
    axes.set(xlabel="angle at the impact (°)", ylabel=r"$\varepsilon$ of the first impact")
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 0.93))
    fg.letter(axes, "(a)")


def all_impacts(axes: Axes) -> None:
    """Draw ε of the first impacts against |ω|R/|v|, which E_rot/E_tot tells of a smooth body."""
    ratio = np.linspace(0.0, 6.0, 601)
    highest, least, lowest = extremes(ratio)
    axes.plot(ratio, highest, color=ink())
    axes.plot(ratio[ratio < 1.0], least[ratio < 1.0], color=ink())
    axes.plot(ratio[ratio > 1.0], lowest[ratio > 1.0], color=ink())
    for spin, color, marker in zip(SPINS[1:], colors()[1:], fg.MARKERS[1:], strict=False):
        found = drop(rs.Frictionless(normal=NORMAL), spin, 400, 4)
        share = found.rotational_fraction.values
        turning = np.sqrt(share / (1.0 - share) / 1.4)
        axes.plot(turning.ravel(), found.restitution.values.ravel(), marker, color=color, ms=1.5, mew=0.0)
    for level, text in ((2.0, "+2"), (-4.0, "−4")):
        axes.axhline(level, color="0.5", lw=0.6, ls=":")
        axes.text(5.9, level + 0.1, text, ha="right", va="bottom", color=ink(0.7))
    axes.axhline(-1.0, color="0.5", lw=0.6, ls="--")
    axes.text(5.9, -0.9, "falling", ha="right", va="bottom")
    axes.text(5.9, -1.15, "rising", ha="right", va="top")
    axes.set(
        xlim=(0.0, 6.0), ylim=(-6.0, 6.0), xlabel=r"$|\omega|R/|v|$ at the impact", ylabel=r"$\varepsilon$"
    )
    fg.letter(axes, "(b)")


def draw(path: Path) -> None:
    """Draw both panels."""
    for style in SITE:
        _draw(style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)


@fg.styled
def _draw(*, style: Style | None = None) -> Figure:
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.9, 1, 2)
    first_impacts(left)
    all_impacts(right)
    return figure


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
