"""How far `cdf_error` of random rigid bodies is from what their distribution functions are off: minutes.

``python tests/manual/lattices.py [seed [directions]]`` prints for each body and law the distance from the
distribution of ε at all directions of two lattices, the lattices' own, and the ratio of what is beyond that
to ``cdf_error``; docs/first-impact.md has the largest.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import restitution as rs
from reference.first_impacts import RANDOM, beside_lattices

LAWS = {
    "frictionless": rs.Frictionless(normal=0.7),
    "paper": rs.TangentialRestitution(normal=0.7),
    "Coulomb": rs.Coulomb(normal=0.7, friction=0.15),
    "Chatterjee-Ruina": rs.ChatterjeeRuina(normal=0.3, tangential=0.9, friction=0.5),
}


def main(seed: int = 1, number: int = 400_000) -> None:
    """Print a line for each body and law, and the largest ratio."""
    largest = 0.0
    for name, make in RANDOM.items():
        body = make(np.random.default_rng(seed))
        for law in LAWS:
            off, own, stated = beside_lattices(body, LAWS[law], number, seed)
            ratio = max(0.0, off - own) / stated
            largest = max(largest, ratio)
            print(
                f"{name:15}{law:18}off {off:.1e}  lattices {own:.1e}  stated {stated:.1e}  {ratio:.2f}",
                flush=True,
            )
    print(f"largest ratio {largest:.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
