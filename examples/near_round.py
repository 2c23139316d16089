"""Nearly round bodies: what the scatter of ε depends on, from a study and from maps without contacts.

    restitution sweep examples/near_round.toml --out near_round.zarr
    python examples/near_round.py near_round.zarr docs/images

prints the tables of docs/near-round.md and draws near_round.png and near_round_maps.png.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

import restitution as rs
from restitution import figures as fg
from restitution.analytic import near_round
from restitution.figures.style import SITE, Style, colormap, ink

RADIUS, HEIGHT, GRAVITY = 3e-3, 0.06, 9.81
FIRST = np.sqrt(2 * GRAVITY * (HEIGHT - RADIUS))
"""v₀, the speed of the first impact of a round body, in m/s."""
SLOWEST, ENOUGH = 0.1, 4000
"""Bins that are compared: faster than this, in m/s, and with half an impact for each particle."""
LIBRATING = 0.2604
"""√<s²p²>/2 where a pendulum with the force s, let go at angles uniform in [0, π/2), has been for long."""
KINDS = ("still", "librating", "between", "random")

Floats = NDArray[np.float64]
Row = dict[str, Floats | float]


def reduced(normal: float, phase: float, impacts: int, angles: int = 4000) -> tuple[Floats, Floats, Floats]:
    """Iterate the motion of a nearly round body under the paper's law, to leading order in δ = L/R.

    The speed is u = v/v₀, falling by ε_n at each impact; the spin is ωR/(δ v₀); between impacts the axis
    turns by 2 κ u times the spin, κ = δ v₀²/(gR). The lower end is s = sin θ sign cos θ to the side.

    Returns
    -------
    u, mean, std : ndarray, shape (impacts,)
        Speed, and <ε - ε_n>/δ² and σ/δ² over angles at release, uniform in [0, π).
    """
    theta = (np.arange(angles) + 0.5) * np.pi / angles
    spin, u, found = np.zeros(angles), 1.0, []
    for _ in range(impacts):
        side = np.sin(theta) * np.sign(np.cos(theta))
        epsilon = -(1 + normal) * (0.5 * side * spin / u + 5 / 28 * side**2)
        found.append((u, epsilon.mean(), epsilon.std()))
        spin += 5 / 14 * (1 + normal) * side * u
        u *= normal
        theta += 2 * phase * spin * u
    speed, mean, std = np.array(found).T
    return speed, mean, std


def kick(normal: float, phase: float) -> float:
    """K, the parameter of the standard map that the first impacts are: 2κ times the gain of spin."""
    return 5 / 7 * (1 + normal) * phase


def turned(u: Floats, normal: float, phase: float) -> Floats:
    """T, the time in units of that of the pendulum which the axis is where K is small."""
    return np.asarray(np.sqrt(kick(normal, phase)) * (1 - u) / (1 - normal))


def kind(u: Floats, normal: float, phase: float) -> NDArray[np.int64]:
    """Tell how the axis moves, as a number in `KINDS`."""
    strength = kick(normal, phase)
    regular = np.where(turned(u, normal, phase) < 1, 0, 1 if strength < 0.3 else 2)
    return np.where(strength < 3, regular, 3)


def closed(u: Floats, normal: float, phase: float) -> Floats:
    """Give σ/δ² in closed form, from three limits: the axis is at rest, librates, or has any angle."""
    gain = 1 + normal
    random = 5 / 56 * gain * np.sqrt(gain**2 * (1 / u**2 - 1) / (1 - normal**2) + 0.5)
    if kick(normal, phase) >= 3:
        return np.asarray(random)
    still = 5 / 28 * gain / np.sqrt(8) * (1 + gain * (1 / u - 1) / (1 - normal))
    still *= 1 + 0.5 * np.minimum(turned(u, normal, phase), 1) ** 2
    librating = 1.1 * LIBRATING * gain / u * np.sqrt(5 / 28 * gain / phase)
    return np.asarray(np.minimum(still, np.maximum(librating, 0.75 * random)))


def closed_over_map() -> str:
    """Write the table of how good the closed form is, for ε_n from 0.5 to 0.98 and κ from 0.003 to 40."""
    logs: list[list[Floats]] = [[] for _ in KINDS]
    for normal in (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98):
        for phase in np.geomspace(0.003, 40.0, 30):
            u, _, std = reduced(normal, phase, int(np.log(0.1) / np.log(normal)) + 1, angles=1500)
            # As many speeds of each law, spread evenly over their logarithm.
            at = np.unique(np.searchsorted(-u, -np.geomspace(1.0, 0.1, 12)).clip(0, u.size - 1))
            off = np.log(std / closed(u, normal, phase))[at]
            for number, part in enumerate(logs):
                part.append(off[kind(u, normal, phase)[at] == number])
    lines = ["| the axis | where | σ of the map over the closed form: mean, rms, worst |", "|---|---|---|"]
    where = ("K < 3, T < 1", "K < 0.3, T > 1", "0.3 < K < 3, T > 1", "K > 3")
    for name, text, part in zip(("at rest", *KINDS[1:]), where, logs, strict=True):
        x = np.concatenate(part)
        percent = 100 * np.expm1(x)
        worst = np.exp(np.abs(x).max())
        lines.append(
            f"| {name} | {text} | {percent.mean():+.0f} %, {100 * np.sqrt(np.mean(x**2)):.0f} %, "
            f"a factor {worst:.2f} |"
        )
    return "\n".join(lines)


def compared(found: xr.Dataset) -> list[Row]:
    """Give, at each point, σ/δ², its error, and what both maps and the closed form say, by bin of v."""
    edges = found["velocity_edges"].values
    rows: list[Row] = []
    for separation in found["separation"].values:
        for normal in found["normal"].values:
            point = found.sel(separation=separation, normal=normal)
            delta = separation / RADIUS
            phase = delta * FIRST**2 / (GRAVITY * RADIUS)
            impacts = int(np.log(0.5 * SLOWEST / FIRST) / np.log(normal)) + 1
            speed, _, std = reduced(normal, phase, impacts)
            place = np.searchsorted(edges, speed * FIRST, side="right") - 1
            number, square, speeds = (
                np.bincount(place, weight, edges.size)[: edges.size - 1]
                for weight in (speed**0, std**2, speed)
            )
            v = point["velocity"].values
            # Full bins: of one at the edge of a group of impacts a part is elsewhere.
            good = (v > SLOWEST) & (v < 0.98 * FIRST) & (number > 0) & (point["number"].values >= ENOUGH)
            u, expected = speeds[good] / number[good], np.sqrt(square[good] / number[good])
            row: Row = {
                "delta": delta,
                "normal": float(normal),
                "phase": phase,
                "v": v[good],
                "u": u,
                "std": point["std_restitution"].values[good] / delta**2,
                "error": point["std_restitution_error"].values[good] / delta**2,
                "map": expected,
                "closed": closed(u, float(normal), phase),
            }
            if delta <= 0.2:
                body, law = (
                    rs.Dumbbell(radius=RADIUS, separation=separation),
                    rs.TangentialRestitution(normal=float(normal)),
                )
                near = near_round(body, law, velocity_bins=edges, release_height=HEIGHT, gravity=GRAVITY)
                there = (near["number"].values >= ENOUGH // 4)[good]
                row["near"] = np.where(there, near["std_restitution"].values[good] / delta**2, np.nan)
                square_off = point["second_moment"] - near["second_moment"]
                row["second"] = np.where(there, square_off.values[good], np.nan)
            rows.append(row)
    return rows


def exponent(rows: list[Row], largest: float = 0.03) -> tuple[float, float]:
    """Fit σ ∝ δ^p at fixed v, ε_n and κ: 2 and the slope of log(σ/δ² over the map); the error is over ε_n."""
    slopes = []
    for normal in sorted({row["normal"] for row in rows}):
        chosen = [r for r in rows if r["normal"] == normal and r["delta"] <= largest and np.size(r["u"])]
        x = [np.log(row["delta"]) for row in chosen]
        y = [np.mean(np.log(row["std"] / row["map"])) for row in chosen]
        slopes.append(np.polyfit(x, y, 1)[0])
    return 2 + float(np.mean(slopes)), float(np.std(slopes, ddof=1) / np.sqrt(len(slopes)))


def table(rows: list[Row]) -> str:
    """Write the table of docs/near-round.md, of every other L/R."""
    lines = [
        "| L/R | κ | bins | σ over the scaling map: mean, rms | over `near_round`: mean, rms, worst "
        "| over the closed form: mean, rms | ⟨ε²⟩ less that of `near_round`: rms |",
        "|---|---|---|---|---|---|---|",
    ]
    for delta in sorted({row["delta"] for row in rows})[::2]:
        chosen = [row for row in rows if row["delta"] == delta]
        off = {
            name: np.concatenate([row["std"] / row[name] for row in chosen if name in row] or [[np.nan]]) - 1
            for name in ("map", "near", "closed")
        }
        texts = [_percent(off["map"]), _percent(off["near"], worst=True), _percent(off["closed"])]
        second = [row["second"] for row in chosen if "second" in row]
        square = f"{np.sqrt(np.nanmean(np.concatenate(second) ** 2)):.1g}" if second else ""
        phase = chosen[0]["phase"]
        lines.append(f"| {delta:.2g} | {phase:.2g} | {off['map'].size} | {' | '.join(texts)} | {square} |")
    return "\n".join(lines)


def _percent(off: Floats, *, worst: bool = False) -> str:
    off = off[np.isfinite(off)]
    if not off.size:
        return ""
    text = f"{100 * off.mean():+.1f} %, {100 * np.sqrt(np.mean(off**2)):.1f} %"
    return text + (f", {100 * np.abs(off).max():.0f} %" if worst else "")


@fg.styled
def draw(found: xr.Dataset, rows: list[Row], *, style: Style | None = None) -> Figure:
    """Draw σ against L/R at one speed, the collapse, and where it ends."""
    figure, [[left, middle, right]] = fg.panels(fg.PAGE, 2.6, 1, 3)
    deltas, normals = found["separation"].values / RADIUS, found["normal"].values
    sigma = np.full((deltas.size, normals.size), np.nan)
    for row in rows:
        near = np.abs(np.asarray(row["v"]) - 0.3)
        if near.size:
            i, j = np.argmin(np.abs(deltas - row["delta"])), np.argmin(np.abs(normals - row["normal"]))
            sigma[i, j] = row["std"][int(np.argmin(near))] * row["delta"] ** 2
    colors = colormap()(np.linspace(0.0, 0.92, deltas.size))
    for j, normal in enumerate(normals):
        if normal in (0.5, 0.7, 0.9, 0.98):
            left.loglog(deltas, sigma[:, j], "o-", markersize=2.0, label=f"{normal:g}")
    left.loglog(deltas[:9], 1.5 * deltas[:9] ** 2, ":", color=ink(0.9), linewidth=0.8)
    left.loglog(deltas[:9], 1.2 * deltas[:9] ** 1.5, "--", color=ink(0.9), linewidth=0.6)
    left.set(xlabel="$L/R$", ylim=(5e-6, 3.0), ylabel=r"$\sigma$ near $v = 0.3$ m/s")
    left.legend(title=r"$\varepsilon_n$")
    for row in rows:
        i = int(np.argmin(np.abs(deltas - row["delta"])))
        style = {"color": colors[i], "markersize": 2, "linestyle": "none", "marker": "o"}
        middle.loglog(row["map"], row["std"], **style)
        if row["normal"] in (0.7, 0.98):
            right.semilogx(
                row["u"], row["std"] / row["map"], **(style | {"marker": "os"[row["normal"] > 0.9]})
            )
    ends = np.array([0.15, 20.0])
    middle.loglog(ends, ends, "-", color=ink(0.9), linewidth=0.6)
    middle.set(xlabel=r"$\Phi(v/v_0, \varepsilon_n, \kappa)$", ylabel=r"$\sigma / (L/R)^2$")
    right.axhline(1.0, color=ink(0.9), linewidth=0.6)
    right.set(xlabel="$v/v_0$", ylabel=r"$\sigma / (L/R)^2 \Phi$", ylim=(0.0, 1.4))
    for i in range(0, deltas.size, 2):
        middle.plot([], [], "o", color=colors[i], markersize=2.5, label=f"{deltas[i]:.2g}")
    middle.legend(title="$L/R$", fontsize="xx-small")
    for axes, letter in ((left, "(a)"), (middle, "(b)"), (right, "(c)")):
        fg.letter(axes, letter, left=axes is not left)
    return figure


@fg.styled
def draw_maps(found: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw σ and <ε²>/ε_n² - 1 in the plane of v and L/R, for three ε_n; grey where impacts are few."""
    from matplotlib.colors import LogNorm, SymLogNorm

    figure, panels = fg.panels(fg.PAGE, 4.0, 2, 3)
    deltas, edges = found["separation"].values / RADIUS, found["velocity_edges"].values
    step = np.sqrt(deltas[1] / deltas[0])
    rows = np.concatenate([deltas[:1] / step, deltas * step])
    shown: list[tuple[str, object]] = [
        (r"$\sigma$", LogNorm(1e-5, 1.0)),
        (r"$\langle\varepsilon^2\rangle/\varepsilon_n^2 - 1$", SymLogNorm(1e-4, vmin=-1.0, vmax=1.0)),
    ]
    for line, (text, norm) in zip(panels, shown, strict=True):
        for axes, normal in zip(line, (0.7, 0.9, 0.98), strict=True):
            point = found.sel(normal=normal, method="nearest")
            enough = point["number"].values >= 500
            square = point["second_moment"].values / normal**2 - 1
            values = point["std_restitution"].values if line is panels[0] else square
            image = axes.pcolormesh(
                edges,
                rows,
                np.where(enough, values, np.nan),
                norm=norm,
                cmap=colormap() if line is panels[0] else "RdBu_r",
                rasterized=True,
            )
            axes.set_facecolor(ink(0.2))
            axes.set(yscale="log", xlim=(0.0, 1.06), title=rf"$\varepsilon_n = {normal:g}$")
            if line is panels[1]:
                axes.set_xlabel("$v$ (m/s)")
        line[0].set_ylabel("$L/R$")
        figure.colorbar(image, ax=list(line), label=text)
    return figure


if __name__ == "__main__":
    study, folder = xr.open_zarr(sys.argv[1], chunks=None).load(), Path(sys.argv[2])
    points = compared(study)
    print(table(points))
    print("\nexponent of L/R at fixed κ, up to 0.03: {:.3f} ± {:.3f}\n".format(*exponent(points)))
    print(closed_over_map())
    for ground in SITE:
        for stem, figure in (
            ("near_round", draw(study, points, style=ground)),
            ("near_round_maps", draw_maps(study, style=ground)),
        ):
            figure.savefig(folder / f"{stem}{ground[4:]}.png", dpi=200)
