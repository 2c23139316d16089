"""p(ε | v) in a code of soft spheres: what a spring and a dashpot make of each ε, and a gas of them.

`python examples/dem/soft_spheres.py` prints the numbers of docs/soft-spheres.md; a C++ compiler is needed.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

import restitution as rs

CONTACT = 1e-4  # s, an elastic contact
SEEDS = 24  # gases of each kind


def rebound(epsilon: np.ndarray, steps: int, *, pulls: bool = True) -> np.ndarray:
    """ε that a linear spring and dashpot give where `epsilon` is asked; steps in an elastic contact."""
    k, log = (np.pi / CONTACT) ** 2, np.log(epsilon)  # of m* = 1
    damping = -2.0 * log / np.hypot(np.pi, log) * np.sqrt(k)
    overlap, rate = np.zeros_like(epsilon), np.ones_like(epsilon)
    left, step = np.full_like(epsilon, np.nan), CONTACT / steps
    for _ in range(10 * steps):
        force = k * overlap + damping * rate
        rate = rate - step * (force if pulls else np.maximum(force, 0.0))
        overlap = overlap + step * rate
        left = np.where(np.isnan(left) & (overlap <= 0.0), -rate, left)
    return left


def main() -> None:
    """Print the tables of the page."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Frictionless(normal=0.9)
    grain = rs.FluctuatingRestitution.learn(body, law, particles=6000, velocities=(0.05, 0.8))
    print("created:", grain.data.attrs["energy_created_share"])
    for v in (0.1, 0.2, 0.4, 0.8):
        e = grain.rvs(v, size=10**6, random_state=1)
        shares = f"{np.mean(e <= 0.0):.3f} below 0, {np.mean(e > 1.0):.3f} above 1"
        means = f"mean {e.mean():.3f}, from 0.05 on {e.clip(0.05).mean():.3f}"
        squares = [f"{np.mean(cut**2):.3f}" for cut in (e, e.clip(0.05), e.clip(0.05, 1.0))]
        print(f"{v} m/s: {shares}; {means}; mean squares {', '.join(squares)}")
    asked = np.array([0.05, 0.3, 0.9, 1.2, 2.0, 4.0])
    print("asked", asked)
    for steps in (10, 20, 40, 80, 160):
        print(steps, rebound(asked, steps).round(3))
    print("no pull", rebound(asked, 160, pulls=False).round(3))
    with tempfile.TemporaryDirectory() as folder:
        grain.to_c(Path(folder) / "grain.h", name="grain")
        source = Path(__file__).with_name("soft_spheres.cpp")
        program = Path(folder) / "soft_spheres"
        subprocess.run(["g++", "-O3", "-std=c++17", f"-I{folder}", "-o", program, source], check=True)
        for mode, speed in (("drawn", "0.4"), ("drawn", "0.1"), ("clipped", "0.4"), ("0.9", "0.4")):
            gases = []
            for seed in range(1, SEEDS + 1):
                how = [program, mode, speed, "2", str(seed)]
                told = subprocess.run(how, check=True, capture_output=True, text=True).stdout
                gases.append([line.split() for line in told.splitlines()])
            rows = np.array(gases, dtype=float)
            print(f"{mode} from {speed} m/s: s, m/s, contacts of a sphere, share below 0.05; of seed 1")
            print(rows[0])
            print("means of all seeds, and the standard errors of the last three")
            error = rows.std(axis=0, ddof=1) / np.sqrt(SEEDS)
            print(np.column_stack([rows.mean(axis=0), error[:, 1:]]).round(4))


if __name__ == "__main__":
    main()
