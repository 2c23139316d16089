"""The tables of crates/core/src/collision/turning/nodes.rs, with 60 digits: `python tables.py 20`."""

import sys

from mpmath import findroot, legendre, matrix, mp, mpf
from numpy.polynomial.legendre import leggauss

mp.dps = 60
N = int(sys.argv[1])
M = N // 2

nodes = []
for x0 in leggauss(N)[0]:
    if x0 > 0:
        nodes.append(findroot(lambda x: legendre(N, x), mpf(x0)))
# even functions: f_e(x)=sum_k a_k x^{2k}, a = Ve^{-1} f ; f_e=(f(+)+f(-))/2
V = matrix(M, M)
for i in range(M):
    for k in range(M):
        V[i, k] = nodes[i] ** (2 * k)
Vi = V**-1
# CE[k][j]: coefficient of xi^{2k+1} from sums
CE = [[Vi[k, j] / 2 / (2 * k + 1) for j in range(M)] for k in range(M)]
VO = matrix(M, M)
for i in range(M):
    for k in range(M):
        VO[i, k] = nodes[i] ** (2 * k + 1)
Voi = VO**-1
CO = [[Voi[k, j] / 2 / (2 * k + 2) for j in range(M)] for k in range(M)]
pts = [*nodes, mpf(1)]


def cheb(n):
    a, b = [1], [0, 1]
    if n == 0:
        return a
    for _ in range(n - 1):
        c = [0] + [2 * x for x in b]
        for i, x in enumerate(a):
            c[i] -= x
        a, b = b, c
    return b


TO = matrix(M, M)
TE = matrix(M, M)
for k in range(M):
    for i, x in enumerate(cheb(2 * k + 1)):
        if i % 2:
            TO[(i - 1) // 2, k] = x
    for i, x in enumerate(cheb(2 * k + 2)):
        if i % 2 == 0 and i > 0:
            TE[i // 2 - 1, k] = x
TOi = TO**-1
TEi = TE**-1
COM = [[sum(TOi[k, i] * CE[i][j] for i in range(M)) for j in range(M)] for k in range(M)]
CEM = [[sum(TEi[k, i] * CO[i][j] for i in range(M)) for j in range(M)] for k in range(M)]
IO = [[sum(CE[k][j] * x ** (2 * k + 1) for k in range(M)) for j in range(M)] for x in pts]
IE = [[sum(CO[k][j] * x ** (2 * k + 2) for k in range(M)) for j in range(M)] for x in pts]


def rust(x):
    f = float(x)
    return repr(f)


def table(name, t, doc):
    print(f"/// {doc}")
    print(f"pub(super) const {name}: [[f64; {len(t[0])}]; {len(t)}] = [")
    for r in t:
        print("    [" + ", ".join(rust(x) for x in r) + "],")
    print("];")


print(f"pub(super) const NODES: [f64; {M}] = [" + ", ".join(rust(x) for x in nodes) + "];")
table(
    "ODD_COEFFICIENTS",
    COM,
    "Coefficients of the Chebyshev polynomials T₁, T₃, ... in the integral, "
    "from the sums over pairs of nodes ±ξ.",
)
table("EVEN_COEFFICIENTS", CEM, "Those of T₂, T₄, ..., from the differences.")
table("ODD_VALUES", IO, "Its odd part at the nodes ξ > 0 and at 1, from the sums.")
table("EVEN_VALUES", IE, "Its even part there, from the differences.")
table(
    "ODD_POWERS",
    [[TO[i, k] for k in range(M)] for i in range(M)],
    "Coefficient of ξ²ⁱ⁺¹ in T₁, T₃, ...; a row for each i.",
)
table(
    "EVEN_POWERS",
    [[TE[i, k] for k in range(M)] for i in range(M)],
    "Coefficient of ξ²ⁱ⁺² in T₂, T₄, ....",
)
