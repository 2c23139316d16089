"""The table of crates/core/src/collision/turning/nodes.rs, with 40 digits: `python tables.py 20`."""

import sys

from mpmath import diff, findroot, legendre, mp, mpf
from numpy.polynomial.legendre import leggauss

mp.dps = 40
N = int(sys.argv[1])

for guess in leggauss(N)[0]:
    node = findroot(lambda x: legendre(N, x), mpf(guess))
    slope = diff(lambda x: legendre(N, x), node)
    weight = 1 / ((1 - node * node) * slope**2)
    print(f"    ({float((node + 1) / 2)!r}, {float(weight)!r}),")
