"""`python -m benchmarks.impulse`: how exact the impulse of Coulomb's law is where the slip turns, as a table.

The impacts and their impulses to 28 digits stand in crates/core/tests/friction/random.txt, which
`python crates/core/tests/friction/reference.py 1 110` draws and solves by Taylor series, in ten minutes.
Slip, arms, inertia, friction and restitution are random; a tenth each of the components of the slip and of
the speeds is smaller by up to twelve orders of magnitude.
"""

from pathlib import Path

import numpy as np
import numpy.typing as npt

import restitution as rs

REFERENCES = Path(__file__).parents[1] / "crates/core/tests/friction/random.txt"
HYPOTHESES = {"s": "stronge", "p": "poisson", "n": "newton"}


def errors() -> dict[str, npt.NDArray[np.float64]]:
    """Distance of the impulse from the reference, over its size, by hypothesis."""
    found: dict[str, list[float]] = {name: [] for name in HYPOTHESES.values()}
    for line in REFERENCES.read_text(encoding="utf-8").splitlines():
        name, *numbers = line.split()
        v, u, w, inertia, height, side, across, friction, normal, *expected = map(float, numbers)
        law = rs.Coulomb(normal=normal, friction=friction, hypothesis=HYPOTHESES[name])
        impulse, _ = law.compiled.respond((-v, u, w), (height, side), inertia, across)
        size = np.linalg.norm(expected[:3])
        found[HYPOTHESES[name]].append(float(np.linalg.norm(np.subtract(impulse, expected[:3])) / size))
    return {name: np.array(values) for name, values in found.items()}


def table() -> str:
    """Write the table of docs/laws.md."""
    lines = [
        "| hypothesis | impacts | median | nine in ten below | largest | above 10⁻¹⁴ |",
        "|---" * 6 + "|",
    ]
    for name, values in errors().items():
        cells = [_power(value) for value in (np.median(values), np.quantile(values, 0.9), values.max())]
        beyond = f"{100 * np.mean(values > 1e-14):.0f} %"
        lines.append(f'| `"{name}"` | {values.size} | {" | ".join(cells)} | {beyond} |')
    return "\n".join(lines)


def _power(value: float) -> str:
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}·10{str(int(exponent)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}"


if __name__ == "__main__":
    print(table())
