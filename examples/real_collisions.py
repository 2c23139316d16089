"""Laws of collision beside impacts that were measured: an ellipse in a plane, a cube in space.

`python docs/pages.py real-collisions` makes the table and the figure of docs/real-collisions.md.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import wasserstein_distance

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors, ink

DATA = Path(__file__).parents[1] / "docs" / "data"
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Impacts:
    """Impacts of one body, whose mass is 1 and whose moment of inertia is the same about any axis that turns.

    Arrays (impacts, 3): the arm from the centre of mass to the contact, velocity and spin before and after.
    """

    arm: Floats
    velocity: Floats
    spin: Floats
    velocity_after: Floats
    spin_after: Floats

    def __getitem__(self, part: Any) -> "Impacts":
        return Impacts(*(array[part] for array in vars(self).values()))

    @property
    def restitution(self) -> Floats:
        """ε of the centre of mass."""
        return -self.velocity_after[:, 2] / self.velocity[:, 2]


def load(name: str) -> Impacts:
    """Read the impacts of docs/data that carry no flag."""
    table = np.genfromtxt(DATA / f"{name}.csv", delimiter=",", names=True)
    table = table[table["flagged"] == 0] if "flagged" in table.dtype.names else table
    zero = np.zeros(table.size)
    known = set(table.dtype.names)
    columns = [[table[a + b] if a + b in known else zero for b in "xyz"] for a in "rvwVW"]
    return Impacts(*np.array(columns).transpose(0, 2, 1))


def balance(impacts: Impacts) -> tuple[float, float]:
    """Fit the moment of inertia over the mass (m²), without any law: k Δω = r × Δv.

    Returns also the mean distance of the measured change from the nearest one that an impulse at the contact
    can make, in the norm of `distance` (m/s): no law can be better.
    """
    kick, turn = impacts.velocity_after - impacts.velocity, impacts.spin_after - impacts.spin
    torque = np.cross(impacts.arm, kick)
    scale = np.mean(np.sum(impacts.arm**2, axis=1))

    def left(k: float) -> Floats:
        r = impacts.arm
        rest = k * turn - torque
        # In the norm the impulse does best that takes (k + r²)⁻¹ of the rest across the arm, all along it.
        along = np.sum(rest * r, axis=1) ** 2 / np.sum(r**2, axis=1)
        across = np.sum(rest**2, axis=1) - along
        return np.sqrt(across / (k + np.sum(r**2, axis=1)) + along / k)

    inertias = scale * np.linspace(0.05, 1.5, 581)
    k = inertias[int(np.argmin([left(one).mean() for one in inertias]))]
    return float(k), float(left(k).mean())


def distance(impacts: Impacts, velocity: Floats, spin: Floats, k: float) -> Floats:
    """Return how far a prediction is from what was measured: √(2 E/m) of the difference, in m/s."""
    v, w = velocity - impacts.velocity_after, spin - impacts.spin_after
    return np.sqrt(np.sum(v**2, axis=1) + k * np.sum(w**2, axis=1))


def whittaker(normal: float, friction: float) -> rs.CustomLaw:
    """Return a law of one's own, that of Whittaker: Newton's coefficient, friction against the first slip.

    The impulse along the plane is the one that stops the slip, if it is at most μ P_n.
    """

    def function(K: Floats, velocity: Floats) -> Floats:
        target = -velocity * (1.0, 1.0, 1.0 + normal)
        impulse = np.linalg.solve(K, target)
        if np.hypot(*impulse[:2]) > friction * impulse[2]:
            slip = velocity[:2] / np.hypot(*velocity[:2])
            impulse = np.append(-friction * slip, 1.0)
            impulse *= target[2] / (K[2] @ impulse)
        return impulse

    return rs.CustomLaw(function, name="Whittaker")


SCATTERED = "the same, ε_n scattered"
LAWS: dict[str, tuple[Callable[..., Any], tuple[str, ...]]] = {
    "`Frictionless`": (rs.Frictionless, ("normal",)),
    "`TangentialRestitution`": (rs.TangentialRestitution, ("normal", "tangential")),
    **{
        f"`Coulomb`, {name.title()}": (partial(rs.Coulomb, hypothesis=name), ("normal", "friction"))
        for name in ("newton", "stronge", "poisson")
    },
    "`ChatterjeeRuina`": (rs.ChatterjeeRuina, ("normal", "friction", "tangential")),
    "Whittaker, a `CustomLaw`": (whittaker, ("normal", "friction")),
}
"""The constructor of a law, and the names of its parameters."""
GUESS = {"normal": (0.5, 0.0, 1.0), "friction": (0.2, 0.0, 3.0), "tangential": (0.2, -1.0, 1.0)}
"""Where a fit begins, and between what it looks."""


def predict(law: Any, impacts: Impacts, k: float) -> tuple[Floats, Floats]:
    """Return velocity and spin after each impact; one law for all, or one for each."""
    laws = law if isinstance(law, list) else [law] * len(impacts.arm)
    at_contact = impacts.velocity + np.cross(impacts.spin, impacts.arm)
    impulses = np.empty_like(at_contact)
    for one, law, r, u in zip(range(len(laws)), laws, impacts.arm, at_contact, strict=True):
        if isinstance(law, rs.CustomLaw):
            K = np.eye(3) * (1 + r @ r / k) - np.outer(r, r) / k
            impulses[one] = law.function(K, u)
            continue
        length = np.hypot(r[0], r[1])
        x = np.array([r[0] / length, r[1] / length, 0.0]) if length else np.array([1.0, 0.0, 0.0])
        y = np.array([-x[1], x[0], 0.0])
        arm, across = (r[2], length), 1 + r @ r / k
        (along_z, along_x, along_y), _ = law.compiled.respond((u[2], u @ x, u @ y), arm, k, across)
        impulses[one] = along_x * x + along_y * y + (0.0, 0.0, along_z)
    return impacts.velocity + impulses, impacts.spin + np.cross(impacts.arm, impulses) / k


def fit(name: str, impacts: Impacts, k: float) -> tuple[Any, dict[str, float]]:
    """Fit the parameters of a law to the least mean distance; return the law with them."""
    make, names = LAWS[name]
    first, low, high = np.array([GUESS[one] for one in names]).T

    def law(x: Floats) -> Any:
        return make(**dict(zip(names, np.clip(x, low, high).tolist(), strict=True)))

    found = minimize(
        lambda x: float(distance(impacts, *predict(law(x), impacts, k), k).mean()),
        first,
        method="Nelder-Mead",
        bounds=list(zip(low, high, strict=True)),
        options={"xatol": 1e-4, "fatol": 1e-6},
    )
    return law(found.x), dict(zip(names, found.x.tolist(), strict=True))


def scattered(law: rs.Coulomb, half: Impacts, other: Impacts, k: float) -> tuple[list[rs.Coulomb], float]:
    """Return laws for `other` whose normal coefficients scatter by as much as ε of `half` tells.

    What ε differs from that of the law is divided by what it changes with the coefficient.
    """

    def laws(normals: Floats) -> list[rs.Coulomb]:
        return [law.model_copy(update={"normal": one}) for one in normals.tolist()]

    step, fixed = 1e-3, np.full(len(half.arm), float(law.normal))
    at, beside = (-predict(laws(n), half, k)[0][:, 2] / half.velocity[:, 2] for n in (fixed, fixed + step))
    off = (half.restitution - at) * step / (beside - at)
    width = float(np.diff(np.quantile(off, (0.16, 0.84)))[0] / 2)
    drawn = law.normal + width * np.random.default_rng(1).normal(size=len(other.arm))
    return laws(np.clip(drawn, 0.0, 1.0)), width


@cache
def judge(name: str, share: int = 1) -> tuple[list[list[str]], dict[str, Floats]]:
    """Fit every law to one half of the impacts and compare it with the other: rows, and ε of each."""
    impacts = load(name)[::share]
    k, floor = balance(impacts)
    known, other = impacts[::2], impacts[1::2]
    measured = other.restitution
    rows, found = [], {"measured": measured}

    def add(name: str, law: Any, texts: dict[str, str]) -> None:
        velocity, spin = predict(law, other, k)
        off, epsilon = distance(other, velocity, spin, k), -velocity[:, 2] / other.velocity[:, 2]
        found[name] = epsilon
        explained = 1 - np.mean((epsilon - measured) ** 2) / np.var(measured)
        numbers = (epsilon.mean(), epsilon.std(), wasserstein_distance(epsilon, measured))
        error = f"{off.mean():.3f} ± {off.std() / np.sqrt(off.size):.3f}"
        cells = [error, *(f"{x:.3f}" for x in numbers), f"{explained:.2f}"]
        rows.append([name, *(texts.get(one, "") for one in GUESS), *cells])

    for one in LAWS:
        law, x = fit(one, known, k)
        add(one, law, {key: f"{value:.2f}" for key, value in x.items()})
        if one.endswith("Poisson"):
            laws, width = scattered(law, known, other, k)
            add(SCATTERED, laws, {"normal": f"± {width:.2f}"})
    rows.append(["any impulse at the contact", *3 * [""], f"{floor:.3f}", *4 * [""]])
    numbers = [f"{measured.mean():.3f}", f"{measured.std():.3f}"]
    rows.append(["measured", *4 * [""], *numbers, "", ""])
    return rows, found


def table(share: int = 1) -> str:
    """Write the tables of docs/real-collisions.md, from one impact in `share`."""
    texts = []
    for name, title in BODIES.items():
        head = (
            f"| {title} | ε_n | μ | ε_t or e_t | error (m/s) | mean of ε | σ of ε | distance of p(ε) | R² |"
        )
        rows = [f"| {' | '.join(row)} |" for row in judge(name, share)[0]]
        texts.append("\n".join([head, "|---" * 9 + "|", *rows]))
    return "\n\n".join(texts)


BODIES = {"ellipse": "ellipse in a plane", "cube": "cube in space"}


def draw(path: Path) -> None:
    """Draw measured ε against predicted, and the densities of both."""
    both = {name: judge(name)[1] for name in BODIES}
    for style in SITE:
        _draw(both, style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)


@fg.styled
def _draw(both: dict[str, Any], *, style: Style | None = None) -> Figure:
    figure, axes = fg.panels(fg.PAGE, 5.4, 2, 2)
    for row, (name, letters) in zip(axes, {"ellipse": "ab", "cube": "cd"}.items(), strict=True):
        found = both[name]
        measured, best = found["measured"], "`Coulomb`, Poisson"
        ends = measured.min() - 0.05, measured.max() + 0.05
        row[0].plot(ends, ends, color="0.6", linewidth=0.8, zorder=0)
        for law, color in (("`Frictionless`", colors()[1]), (best, colors()[0])):
            row[0].plot(found[law], measured, ".", markersize=2.5, color=color, label=law.replace("`", ""))
        row[0].set(
            xlabel=r"predicted $\varepsilon$", ylabel=r"measured $\varepsilon$", ylim=(ends[0], ends[1] + 0.1)
        )
        row[0].legend(loc="upper left", markerscale=3)
        edges = np.linspace(*ends, 36 if len(measured) > 500 else 19)
        row[1].hist(measured, edges, density=True, color=ink(0.2), label=f"measured, {BODIES[name]}")
        for law, color in (("`Frictionless`", 1), (best, 0), (SCATTERED, 2)):
            label = "Coulomb, $\\varepsilon_n$ scattered" if law == SCATTERED else law.replace("`", "")
            row[1].hist(found[law], edges, density=True, histtype="step", color=colors()[color], label=label)
        row[1].set(xlabel=r"$\varepsilon$", ylabel=r"$p(\varepsilon)$")
        row[1].legend(loc="upper left", fontsize="x-small")
        for one, letter in zip(row, letters, strict=True):
            fg.letter(one, f"({letter})", left=False)
    return figure
