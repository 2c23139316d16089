"""A granular gas cools: constant and fluctuating coefficients of restitution side by side.

    python examples/cooling.py [cooling.png]

Direct simulation Monte Carlo of a spatially uniform, force-free gas of smooth hard
spheres. In a collision along the unit vector n, with v = |v12·n|, the particles exchange velocity along n,

    v1' = v1 - (1 + ε)/2 (v12·n) n,  v2' = v2 + (1 + ε)/2 (v12·n) n,

so that (v12·n)' = -ε v12·n and the energy changes by -(m/4)(1 - ε²) v². ε may be any real number: positions
do not appear, so that ε < 0, after which the pair still approaches, is a change of velocities like any other.
Time is counted in ν0⁻¹, ν0 = 4√π nσ²√θ0 being the initial frequency of collisions of a particle, and
temperature is θ = <u²>/3 in m²/s². docs/gas.md says what it means and what it does not.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from scipy import integrate, optimize, stats

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

Floats = npt.NDArray[np.float64]
Rule = Callable[[Floats, np.random.Generator], "Floats | float"]
"""ε of collisions at normal speeds v."""

STEP = 0.02
"""Mean number of collisions of a particle in a step."""
FASTEST = 10.0
"""No pair is faster than this times √θ along n: seven standard deviations in a Gaussian gas."""


def cool(rule: Rule, theta: float, end: float, seed: int, particles: int = 10_000) -> Floats:
    """Cool one gas; return times, θ and the Sonine coefficient a2, once in a collision of each particle."""
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(particles, 3))
    u -= u.mean(axis=0)
    u *= np.sqrt(theta / np.mean(u**2))
    time, now, step, found = 0.0, theta, 0, []
    # The rate of a pair is proportional to |v12·n|, whose mean is 2√(θ/π) in a Gaussian gas.
    candidates = 0.5 * particles * STEP * FASTEST * np.sqrt(np.pi) / 2
    while not found or found[-1][0] < end:
        if step % round(1 / STEP) == 0:
            square = np.sum(u**2, axis=1)
            found.append((time, np.mean(square) / 3.0, 0.6 * np.mean(square**2) / np.mean(square) ** 2 - 1.0))
        one, two = rng.choice(particles, (2, int(candidates + rng.random())), replace=False)
        n = rng.normal(size=(one.size, 3))
        n /= np.linalg.norm(n, axis=1)[:, None]
        v = np.einsum("ij,ij->i", u[one] - u[two], n)
        hit = FASTEST * np.sqrt(now) * rng.random(v.size) < np.abs(v)
        one, two, n, v = one[hit], two[hit], n[hit], v[hit]
        e = rule(np.abs(v), rng)
        kick = (0.5 * (1.0 + e) * v)[:, None] * n
        u[one] -= kick
        u[two] += kick
        before, now = now, now - float(np.sum((1.0 - e**2) * v**2)) / (6.0 * particles)
        time += STEP * 0.5 * np.sqrt(theta) * (before**-0.5 + now**-0.5)
        step += 1
    return np.array(found).T


QUANTILES = stats.gamma(2).ppf((np.arange(500) + 0.5) / 500)


def sonine(epsilon: float) -> float:
    """a2 of the homogeneous cooling state (van Noije and Ernst 1998, d = 3)."""
    e = epsilon
    return 16.0 * (1.0 - e) * (1.0 - 2.0 * e**2) / (81.0 - 17.0 * e + 30.0 * e**2 * (1.0 - e))


def haff(time: Floats, epsilon: float) -> Floats:
    """θ/θ0 for constant ε: (1 + t/τ)⁻² with 1/τ = (1 - ε²)(1 + 3 a2/16) ν0/6."""
    rate = (1.0 - epsilon**2) / 6.0 * (1.0 + 3.0 / 16.0 * sonine(epsilon))
    return np.asarray((1.0 + rate * time) ** -2)


def mean_square(dist: rs.FluctuatingRestitution, theta: float) -> float:
    """<v³ε²>/<v³> in a Gaussian gas, where v²/4θ has density x e⁻ˣ: the ε² that the energy loss sees."""
    v = 2.0 * np.sqrt(theta * QUANTILES)
    return float(np.mean(dist.mean(v) ** 2 + dist.var(v)))


def closure(dist: rs.FluctuatingRestitution, theta: float, times: Floats) -> Floats:
    """θ from dθ/dt = -(ν/3)(1 - <v³ε²>/<v³>) θ, ν = ν0 √(θ/θ0), in a Gaussian gas."""

    def rate(_: float, log: Floats) -> Floats:
        now = np.exp(log[0])
        return np.array([-np.sqrt(now / theta) * (1.0 - mean_square(dist, now)) / 3.0])

    span = (0.0, float(times[-1]))
    return np.exp(integrate.solve_ivp(rate, span, [np.log(theta)], t_eval=times, rtol=1e-6).y[0])


def repeat(rule: Rule, theta: float, times: Floats, replicas: int) -> list[Floats]:
    """θ/θ0 and a2 at given times: mean and standard error over independent gases."""
    gases = [cool(rule, theta, times[-1], seed) for seed in range(replicas)]
    cooled = [np.exp(np.interp(times, time, np.log(now / theta))) for time, now, _ in gases]
    shaped = [np.interp(times, time, a2) for time, _, a2 in gases]
    columns = np.array(cooled), np.array(shaped)
    return [np.array([x.mean(axis=0), x.std(axis=0, ddof=1) / np.sqrt(replicas)]) for x in columns]


def main(path: Path) -> None:
    """Learn p(ε | v) of a dumbbell, cool four gases, print and draw what becomes of them."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    heights = 3e-3 + np.geomspace(law.normal**2, 1.0, 100)  # in m; so that no first impact stands out
    dist = rs.FluctuatingRestitution.learn(
        body, law, particles=20_000, impacts=300, release_height=heights, velocities=(0.05, 4.0)
    ).clamped()
    theta, times = 0.5, np.concatenate([[0.0], np.geomspace(1.0, 1000.0, 49)])
    constant = np.sqrt(mean_square(dist, theta))
    rest = optimize.brentq(lambda end: mean_square(dist, end) - 1.0, 1e-3, theta) / theta
    print(f"<v³ε²>/<v³> = {constant:.4f}² at the start, 1 at θ/θ0 = {rest:.4f}")
    rules: dict[str, Rule] = {
        f"ε = {law.normal}": lambda v, _: law.normal,
        f"ε = {constant:.3f}": lambda v, _: constant,
        "ε = √<ε²>(v)": lambda v, _: np.sqrt(dist.mean(v) ** 2 + dist.var(v)),
        "ε random, p(ε | v)": lambda v, rng: dist.rvs(v, random_state=rng, threads=1),
    }
    labels = (
        rf"$\varepsilon = {law.normal}$",
        rf"$\varepsilon = {constant:.3f}$",
        r"$\varepsilon = \sqrt{\langle\varepsilon^2\rangle(v)}$",
        r"$\varepsilon$ random, $p(\varepsilon\,|\,v)$",
    )
    gases = {}
    for name, rule in rules.items():
        gases[name] = cooled, _ = repeat(rule, theta, times, replicas=8)
        slope = -np.gradient(np.log(cooled[0, 1:]), np.log(times[1:]))
        print(name, *(f"{x:.5f}±{error:.5f}" for x, error in cooled[:, [17, 33, 49]].T), f"{slope[-2]:.2f}")
    colder = np.geomspace(5e-4, 1.0, 100)
    lines = {
        "closure": closure(dist, theta, times) / theta,
        "rest": rest,
        "losses": np.array([mean_square(dist, x * theta) for x in colder]),
    }
    for style in SITE:
        figure = draw(times, list(gases.values()), labels, law.normal, colder, lines, style=style)
        figure.savefig(path.with_stem(path.stem + style[4:]), dpi=200)


@fg.styled
def draw(
    times: Floats,
    gases: list[Any],
    labels: tuple[str, ...],
    normal: float,
    colder: Floats,
    lines: dict[str, Any],
    *,
    style: Style | None = None,
) -> Figure:
    """Draw temperatures, losses and the second Sonine coefficient of the gases beside theory."""
    figure, [[cooling, loss, shape]] = fg.panels(fg.PAGE, 2.8, 1, 3)
    for k, (cooled, a2) in enumerate(gases):
        look = {"color": colors()[k], "marker": fg.MARKERS[k], "linestyle": "none", "label": labels[k]}
        cooling.errorbar(times[1::3], *cooled[:, 1::3], **look, fillstyle="none")
        if k != 1:
            shape.errorbar(times[1::3], *a2[:, 1::3], **look, fillstyle="none")
    cooling.plot(times, haff(times, normal), color=colors()[0], zorder=0)
    cooling.plot(times, lines["closure"], color=colors()[3], zorder=0)
    cooling.axhline(lines["rest"], color="0.6", linestyle=":", zorder=0)
    cooling.set(xscale="log", yscale="log", xlabel=r"$\nu_0 t$", ylabel=r"$\theta/\theta_0$")
    loss.plot(colder, lines["losses"], color=colors()[3])
    loss.axhline(normal**2, color=colors()[0])
    loss.axhline(1.0, color="0.6", linestyle=":")
    loss.set(
        xscale="log",
        xlabel=r"$\theta/\theta_0$",
        ylabel=r"$\langle v^3\varepsilon^2\rangle/\langle v^3\rangle$",
    )
    shape.axhline(sonine(normal), color=colors()[0], zorder=0)
    shape.set(xscale="log", xlabel=r"$\nu_0 t$", ylabel="$a_2$")
    for axes, name in ((cooling, "a"), (loss, "b"), (shape, "c")):
        fg.letter(axes, f"({name})", left=axes is shape)
    figure.legend(*cooling.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "cooling.png"))
