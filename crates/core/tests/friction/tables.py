"""Tables of src/law/coulomb/turning.rs, with 40 digits: `python tables.py`."""

from mpmath import atanh, cos, diff, findroot, legendre, mp, mpf, pi, sqrt
from numpy.polynomial.legendre import leggauss

mp.dps = 40
NODES, TERMS, LARGEST = 20, 13, mpf("0.45")


def gauss(number: int) -> list[tuple[mpf, mpf]]:
    """Give nodes and weights of Gauss and Legendre's quadrature on [0, 1]."""
    table = []
    for guess in leggauss(number)[0]:
        node = findroot(lambda x: legendre(number, x), mpf(guess))
        slope = diff(lambda x: legendre(number, x), node)
        table.append(((node + 1) / 2, 1 / ((1 - node * node) * slope**2)))
    return table


def artanh(terms: int, largest: mpf) -> list[mpf]:
    """Expand artanh(s)/s in Chebyshev's polynomials of s² up to a largest |s|; as powers of s²."""
    end, points = largest**2, 60
    angles = [(k + mpf(1) / 2) * pi / points for k in range(points)]
    squares = [(cos(angle) + 1) / 2 * end for angle in angles]
    values = [atanh(sqrt(square)) / sqrt(square) for square in squares]
    shares = [
        2 * sum(f * cos(j * t) for f, t in zip(values, angles, strict=True)) / points for j in range(terms)
    ]
    shares[0] /= 2
    # T₀, T₁ and Tⱼ₊₁ = 2xTⱼ − Tⱼ₋₁ in powers of s², x = 2s²/end − 1.
    polynomials = [[mpf(1)], [mpf(-1), 2 / end]]
    for _ in range(2, terms):
        last, before = polynomials[-1], polynomials[-2]
        lower = [*(-2 * a for a in last), mpf(0)]
        raised = [mpf(0), *(4 * a / end for a in last)]
        earlier = [*before, mpf(0), mpf(0)]
        polynomials.append([a + b - c for a, b, c in zip(lower, raised, earlier, strict=True)])
    return [
        sum(share * p[power] for share, p in zip(shares, polynomials, strict=True) if power < len(p))
        for power in range(terms)
    ]


for node, weight in gauss(NODES):
    print(f"    ({float(node)!r}, {float(weight)!r}),")
for term in artanh(TERMS, LARGEST):
    print(f"    {float(term)!r},")
