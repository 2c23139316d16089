"""Write reference.txt: attitudes of bodies that rotate freely, to 50 digits.

Rotation matrices and spins are followed by Taylor series in integers, units of 2^-200:
python reference.py > reference.txt
"""

import random
from fractions import Fraction
from math import isqrt

BITS = 200
ONE = 1 << BITS
ORDER = 60
STEP = ONE // 5  # times the spin; the series then loses (0.2/sqrt(3))^60 = 1e-56


def fixed(x):
    """Return a number in units of 2^-200."""
    return int(Fraction(x) * ONE)


def value(terms, part):
    """Return three power series at a place."""
    total = [0, 0, 0]
    for term in reversed(terms):
        total = [(entry * part >> BITS) + added for entry, added in zip(total, term, strict=True)]
    return total


def follow(moments, spin, time):
    """Return the rotation matrix at a time, its rows the axes of space in the body, from the identity."""
    rows = [[ONE * (i == j) for j in range(3)] for i in range(3)]
    factors = [((moments[(i + 1) % 3] - moments[(i + 2) % 3]) << BITS) // moments[i] for i in range(3)]
    while time > 0:
        size = isqrt(sum(part * part for part in spin))
        step = min(time, (STEP << BITS) // size)
        spins, series = [spin], [[row] for row in rows]
        for n in range(ORDER):
            change = [
                sum(spins[k][i - 2] * spins[n - k][i - 1] for k in range(n + 1)) >> BITS for i in range(3)
            ]
            spins.append([(factors[i] * change[i] >> BITS) // (n + 1) for i in range(3)])
            for row in series:  # row' = row x spin
                change = [
                    sum(
                        row[k][i - 2] * spins[n - k][i - 1] - row[k][i - 1] * spins[n - k][i - 2]
                        for k in range(n + 1)
                    )
                    >> BITS
                    for i in range(3)
                ]
                row.append([entry // (n + 1) for entry in change])
        spin, rows, time = value(spins, step), [value(row, step) for row in series], time - step
    return rows


def quaternion(rows):
    """Return the quaternion of a rotation matrix, by its largest component."""
    trace = sum(rows[i][i] for i in range(3))
    squares = [ONE + trace, *(ONE + 2 * rows[i][i] - trace for i in range(3))]
    largest = max(range(4), key=lambda i: squares[i])
    part = isqrt(squares[largest] << BITS)  # twice it
    result = [0] * 4
    result[largest] = part >> 1
    for i in range(3):
        if largest == 0:
            result[1 + i] = ((rows[i - 1][i - 2] - rows[i - 2][i - 1]) << BITS) // (2 * part)
    if largest:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        result[0] = ((rows[k][j] - rows[j][k]) << BITS) // (2 * part)
        result[1 + j] = ((rows[i][j] + rows[j][i]) << BITS) // (2 * part)
        result[1 + k] = ((rows[i][k] + rows[k][i]) << BITS) // (2 * part)
    return result


def main():
    """Write one motion a line: moments, spin, time, quaternion, 1 + growth of a change of the spin."""
    source = random.Random(1)
    for number in range(24):
        kind = number % 6
        uniform = source.uniform
        second = {
            0: [uniform(0.05, 1), uniform(0.05, 1), uniform(0.05, 1)],
            1: [1.0, 1.0, uniform(0.99, 1.01)],
            2: [1.0, uniform(0.2, 1), 0.0],
            3: [1.0, 10 ** uniform(-4, -2), 10 ** uniform(-4, -2)],
        }.get(kind, [uniform(0.05, 1), uniform(0.05, 1), uniform(0.05, 1)])
        moments = sorted([second[1] + second[2], second[2] + second[0], second[0] + second[1]])
        if kind >= 4:  # on the separatrix, or 1e-9 beside it
            a, b, c = moments
            beside = 1.0 if kind == 4 else 1 + 1e-9
            spin = [(c * (c - b)) ** 0.5 * beside, uniform(-1, 1), (a * (b - a)) ** 0.5]
        else:
            spin = [source.gauss(0, 1) for _ in range(3)]
        time = uniform(1, 10) / sum(part**2 for part in spin) ** 0.5
        exact = [[fixed(part) for part in parts] for parts in (moments, spin)]
        found = quaternion(follow(*exact, fixed(time)))
        changed = [exact[1][0] + (exact[1][0] >> 80), *exact[1][1:]]
        other = quaternion(follow(exact[0], changed, fixed(time)))
        sign = 1 if sum(a * b for a, b in zip(found, other, strict=True)) > 0 else -1
        off = isqrt(sum((a - sign * b) ** 2 for a, b in zip(found, other, strict=True)))
        growth = 1.0 + float(Fraction(off << 80, ONE))
        numbers = [*moments, *spin, time, *(float(Fraction(part, ONE)) for part in found), growth]
        print(*(repr(number) for number in numbers), flush=True)


if __name__ == "__main__":
    main()
