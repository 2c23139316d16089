"""Impacts with Coulomb friction to 30 digits, one a line.

The slip is followed by Taylor series in the axes that K is given in, in steps of dp = rho dtheta, and its
ends are found by bisection. `python reference.py > any.txt` takes bodies of any shape: hypothesis, K,
velocity, mu, e, impulse. `python reference.py 1 110 > random.txt` takes bodies of revolution by SEED and
NUMBER: hypothesis, speed and slip, inertia and arms, K_ww, mu, e, impulse, separation speed. Those of
hard.txt have this form and were picked because they are hard: the last 20 because a change of one condition
in the core makes another impulse of them, the seven before these because poles of the hodograph are near, or
its fixed points.
"""

import random
import sys

import mpmath as mp

mp.mp.dps = 34
ORDER = 30
LEAST = mp.mpf(10) ** -28


def leaving(k, mu):
    """Return the direction in which a slip at rest starts, by bisection of its rate."""

    def direction(rate):
        a, b, c = mu * k[0][0] + rate, mu * k[0][1], mu * k[1][1] + rate
        determinant = a * c - b * b
        return (c * k[0][2] - b * k[1][2]) / determinant, (a * k[1][2] - b * k[0][2]) / determinant

    low, high = mp.mpf(0), mp.hypot(k[0][2], k[1][2]) + 1
    for _ in range(130):
        middle = (low + high) / 2
        if mp.hypot(*direction(middle)) > 1:
            low = middle
        else:
            high = middle
    x, y = direction(low)
    return x / mp.hypot(x, y), y / mp.hypot(x, y)


def first(function, high):
    """Return where a function that is negative at 0 and not at `high` rises through 0."""
    low = mp.mpf(0)
    for _ in range(115):
        middle = (low + high) / 2
        if function(middle) < 0:
            low = middle
        else:
            high = middle
    return high


def whole(series, t):
    """Return the integral of a power series from 0."""
    return t * mp.polyval([c / (n + 1) for n, c in enumerate(series)][::-1], t)


def impulse(k, velocity, mu, e, hypothesis):
    """Return the impulse, and how often the contact was pressed together."""
    k = [[mp.mpf(entry) for entry in row] for row in k]
    x, y, v = (mp.mpf(part) for part in velocity)
    mu, e = mp.mpf(mu), mp.mpf(e)
    approach = -v
    p, px, py, work = (mp.mpf(0) for _ in range(4))
    compressions, compressing, began, owed = 1, True, p, mp.mpf(0)
    balance, taken = mp.mpf(0), mp.mpf(0)  # work before this phase, and the most that was taken
    wanted = e * approach if hypothesis == "newton" else mp.mpf(0)
    while True:
        rho = mp.hypot(x, y)
        if rho <= LEAST * (p + LEAST):
            determinant = k[0][0] * k[1][1] - k[0][1] ** 2
            fx = -(k[1][1] * k[0][2] - k[0][1] * k[1][2]) / determinant
            fy = -(k[0][0] * k[1][2] - k[0][1] * k[0][2]) / determinant
            if mp.hypot(fx, fy) > mu:
                fx, fy = (-mu * part for part in leaving(k, mu))
            slope = k[2][2] + k[0][2] * fx + k[1][2] * fy
            x = y = mp.mpf(0)
            series = None
            longest = mp.inf
        else:
            xs, ys, rhos, cosines, sines = [x], [y], [rho], [], []
            for n in range(ORDER):
                cosines.append((xs[n] - mp.fsum(cosines[i] * rhos[n - i] for i in range(n))) / rho)
                sines.append((ys[n] - mp.fsum(sines[i] * rhos[n - i] for i in range(n))) / rho)
                xs.append((k[0][2] * rhos[n] - mu * (k[0][0] * xs[n] + k[0][1] * ys[n])) / (n + 1))
                ys.append((k[1][2] * rhos[n] - mu * (k[0][1] * xs[n] + k[1][1] * ys[n])) / (n + 1))
                rates = (
                    (n + 1 - i) * (cosines[i] * xs[n + 1 - i] + sines[i] * ys[n + 1 - i])
                    for i in range(n + 1)
                )
                rhos.append(mp.fsum(rates) / (n + 1))
            most = max(abs(part[n]) for part in (xs, ys, rhos) for n in (ORDER - 1, ORDER))
            longest = 2 / (mu * (k[0][0] + k[1][1]) + mp.hypot(k[0][2], k[1][2]))
            if most > 0:
                longest = min(longest, (LEAST * rho / most) ** (mp.mpf(1) / ORDER))
            rises = [
                k[2][2] * r - mu * (k[0][2] * a + k[1][2] * b) for r, a, b in zip(rhos, xs, ys, strict=True)
            ]
            speeds = [v] + [rise / (n + 1) for n, rise in enumerate(rises[:-1])]
            powers = [mp.fsum(speeds[i] * rhos[n - i] for i in range(n + 1)) for n in range(ORDER + 1)]
            series = xs, ys

        def gain(t):
            if series is None:
                return t, fx * t, fy * t, slope * t, v * t + slope * t * t / 2
            return (
                whole(rhos, t),
                -mu * whole(xs, t),
                -mu * whole(ys, t),
                whole(rises, t),
                whole(powers, t),
            )

        def lack(t):
            dp, _, _, dv, dw = gain(t)
            if compressing:
                return v + dv - wanted
            if hypothesis == "poisson":
                return p + dp - began - owed
            return work + dw - owed

        end = again = None
        if series is None:
            if compressing:
                end = (wanted - v) / slope
            elif hypothesis == "poisson":
                end = owed - (p - began)
            else:
                left = owed - work
                end = 2 * left / (v + mp.sqrt(v * v + 2 * slope * left))
        else:
            parts = 12
            for part in range(1, parts + 1):
                t = longest * part / parts
                if not compressing and v + gain(t)[3] < 0 and lack(t) < 0:
                    again = first(lambda s: -(v + gain(s)[3]), t)
                    break
                if lack(t) >= 0:
                    end = first(lack, t)
                    break
        t = end or again or longest
        dp, dx, dy, dv, dw = gain(t)
        p, px, py, v, work = p + dp, px + dx, py + dy, v + dv, work + dw
        if series is not None:
            x, y = (mp.polyval(part[::-1], t) for part in series)
        elif end is not None and mp.hypot(fx, fy) >= mu * (1 - mp.mpf(10) ** -26):
            x += (k[0][2] + k[0][0] * fx + k[0][1] * fy) * t
            y += (k[1][2] + k[0][1] * fx + k[1][1] * fy) * t
        if end is not None:
            if not compressing or hypothesis == "newton":
                return (px, py, p), compressions
            balance += work
            taken = max(taken, -balance)
            owed = e * p if hypothesis == "poisson" else e * e * taken - (taken + balance)
            if owed <= 0:
                return (px, py, p), compressions
            compressing, began, work, v = False, p, mp.mpf(0), mp.mpf(0)
        elif again is not None:
            balance += work
            compressing, began, work, v = True, p, mp.mpf(0), mp.mpf(0)
            compressions += 1


def matrix(source, kind):
    """Return K of an ellipsoid on a plane (0: thick, 1: a plate or a needle) or of any form (2)."""
    while True:
        q = [source.gauss(0, 1) for _ in range(4)]
        size = sum(part * part for part in q) ** 0.5
        w, x, y, z = (part / size for part in q)
        axes = [
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ]
        if kind == 2:
            values = [10 ** source.uniform(-2, 0) for _ in range(3)]
            rows = [
                [sum(axes[m][i] * values[m] * axes[m][j] for m in range(3)) for j in range(3)]
                for i in range(3)
            ]
        else:
            thin = 0.1 if kind == 0 else 0.02
            semi = [1.0, source.uniform(thin, 1.0), source.uniform(thin, 5 * thin if kind else 1.0)]
            square = [a * a for a in semi]
            inverse = [5 / (square[(m + 1) % 3] + square[(m + 2) % 3]) for m in range(3)]
            height = sum(square[m] * axes[m][2] ** 2 for m in range(3)) ** 0.5
            arm = [-square[m] * axes[m][2] / height for m in range(3)]  # in the axes of the body
            columns = []
            for i in range(3):
                e = [axes[m][i] for m in range(3)]
                columns.append(
                    [arm[(m + 1) % 3] * e[(m + 2) % 3] - arm[(m + 2) % 3] * e[(m + 1) % 3] for m in range(3)]
                )
            rows = [
                [
                    float(i == j) + sum(columns[i][m] * inverse[m] * columns[j][m] for m in range(3))
                    for j in range(3)
                ]
                for i in range(3)
            ]
        return [[rows[min(i, j)][max(i, j)] for j in range(3)] for i in range(3)]


def ordinary(source):
    """Return a contact of any body, with friction from little to much."""
    k = matrix(source, source.randrange(3))
    rho, phi = 10 ** source.uniform(-1, 1), source.uniform(0, 6.283)
    hypothesis = source.choice(["newton", "poisson", "stronge"])
    return k, (rho, phi), 10 ** source.uniform(-1, 1), source.uniform(0, 1), hypothesis


def jamming(source):
    """Return a contact whose slip turns into the direction of a jam at about the end of the compression."""
    stiff, normal = source.uniform(0.5, 1), source.uniform(0.8, 1.2)
    soft = stiff * source.uniform(0.05, 0.2)
    coupling = source.uniform(0.8, 0.97) * (normal * soft) ** 0.5
    other = source.uniform(-0.1, 0.1) * coupling
    mu = source.uniform(1.3, 2.5) * normal / coupling
    c, s = float(mp.cos(angle := source.uniform(0, 6.283))), float(mp.sin(angle))
    xy = (stiff - soft) * c * s
    xz, yz = other * c - coupling * s, other * s + coupling * c
    k = [
        [stiff * c * c + soft * s * s, xy, xz],
        [xy, stiff * s * s + soft * c * c, yz],
        [xz, yz, normal],
    ]
    slip = source.uniform(0.8, 1.3) * mu * stiff / normal, angle + source.uniform(-0.1, 0.1)
    return k, slip, mu, source.uniform(0.5, 1), source.choice(["poisson", "stronge"])


def of_revolution(source):
    """Return a contact in the frame of the axis: speed, slip, inertia, arms, K_ww, mu, e."""
    inertia = 10 ** source.uniform(-1, 1.5)
    reach = 2 * inertia**0.5
    height = -source.uniform(0, 1) * reach
    side = source.uniform(-reach, reach)
    speed, along, across = source.uniform(0.01, 2), source.uniform(-2, 2), source.uniform(-2, 2)
    ww = 1 + source.uniform(0, 4)
    mu = source.uniform(0, 1.5) if source.random() < 0.8 else 10 ** source.uniform(-3, 1.5)
    e = source.choice([source.random(), source.random(), 1.0, 0.0, 10 ** source.uniform(-6, 0)])
    if source.random() < 0.1:
        across = 10 ** source.uniform(-12, 0)
    if source.random() < 0.1:
        speed = 10 ** source.uniform(-12, 0)
    if source.random() < 0.1:
        along = 10 ** source.uniform(-12, 0)
    return speed, along, across, inertia, height, side, ww, mu, e


def bodies_of_revolution(seed, count):
    """Write so many contacts of bodies of revolution, each under the three hypotheses."""
    source = random.Random(seed)
    for _ in range(count):
        contact = of_revolution(source)
        speed, along, across, inertia, height, side, ww, mu, e = map(mp.mpf, contact)
        nx = -height * side / inertia
        k = [[1 + height**2 / inertia, 0, nx], [0, ww, 0], [nx, 0, 1 + side**2 / inertia]]
        for hypothesis in ("stronge", "poisson", "newton"):
            (px, py, p), _ = impulse(k, (along, across, -speed), mu, e, hypothesis)
            left = k[2][2] * p + nx * px - speed
            found = (p, px, py, left if left > speed * LEAST**0.9 else mp.mpf(0))
            numbers = *map(repr, contact), *(mp.nstr(x, 20) for x in found)
            print(hypothesis[0], *numbers, flush=True)


def any_bodies():
    """Write 26 impacts, one a line: hypothesis, K, velocity, mu, e, impulse."""
    source = random.Random(1)
    for kind, count in ((ordinary, 22), (jamming, 4)):
        while count:
            k, (rho, phi), mu, e, hypothesis = kind(source)
            velocity = [float(rho * mp.cos(phi)), float(rho * mp.sin(phi)), -1.0]
            found, compressions = impulse(k, velocity, mu, e, hypothesis)
            if kind is jamming and compressions == 1:
                continue
            entries = [k[0][0], k[1][1], k[2][2], k[0][1], k[0][2], k[1][2]]
            numbers = [*entries, *velocity, mu, e, *(float(part) for part in found)]
            print(hypothesis, *(repr(number) for number in numbers), flush=True)
            count -= 1


if __name__ == "__main__":
    if sys.argv[1:]:
        bodies_of_revolution(*map(int, sys.argv[1:]))
    else:
        any_bodies()
