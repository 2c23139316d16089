"""Impacts with turning slip to 28 digits: Taylor series of the equation of the slip in tau, dp = |s| dtau.

`python reference.py SEED NUMBER` prints a line an impact: hypothesis, contact, law and impulse. Those of
random.txt have seed 1 and 110 contacts; those of reference.txt were picked because they are hard: the last 20
because a change of one condition in the core makes another impulse of them, the seven before these because
poles of the hodograph are near, or its fixed points.
"""

import random
import sys

from mpmath import mp, mpf, sqrt

mp.dps = 28
ORD = 34


def taylor(u0, w0, nu, ma, mb):
    u = [u0]
    w = [w0]
    s = [sqrt(u0 * u0 + w0 * w0)]
    for n in range(ORD):
        u.append((nu * s[n] - ma * u[n]) / (n + 1))
        w.append(-mb * w[n] / (n + 1))
        t = mpf(0)
        for i in range(n + 2):
            t += u[i] * u[n + 1 - i] + w[i] * w[n + 1 - i]
        for i in range(1, n + 1):
            t -= s[i] * s[n + 1 - i]
        s.append(t / (2 * s[0]))
    return u, w, s


def ev(c, t):
    r = mpf(0)
    for x in reversed(c):
        r = r * t + x
    return r


def integ(c, c0):
    return [c0] + [x / (i + 1) for i, x in enumerate(c)]


def mul(a, b):
    return [sum(a[i] * b[n - i] for i in range(n + 1)) for n in range(min(len(a), len(b)))]


def bis(f, a, b):
    # f(a)<0<=f(b)
    fa = f(a)
    if fa >= 0:
        return a
    # Newton-ish: secant with bisection safeguard
    fb = f(b)
    side = 0
    for _ in range(400):
        m = (a * fb - b * fa) / (fb - fa)
        fm = f(m)
        if abs(b - a) <= mpf(10) ** -25 * abs(b):
            break
        if fm >= 0:
            b, fb = m, fm
            if side == 1:
                fa /= 2
            side = 1
        else:
            a, fa = m, fm
            if side == -1:
                fb /= 2
            side = -1
        if fm == 0:
            break
    return m


def solve(v, u, w, J, n, a, ww, mu, e, hyp):
    v, u, w, J, n, a, ww, mu, e = map(mpf, (v, u, w, J, n, a, ww, mu, e))
    nn, nu, uu = 1 + a * a / J, -n * a / J, 1 + n * n / J
    vn = -v
    p = mpf(0)
    pu = mpf(0)
    pw = mpf(0)
    W = mpf(0)
    comp = True
    pc = mpf(0)
    bal = mpf(0)
    taken = mpf(0)
    due = mpf(0)
    scale = v + abs(u) + abs(w)
    ma, mb = mu * uu, mu * ww
    fast = max(ma, mb) + abs(nu)

    def surplus(vn, p, W):
        if hyp == "newton":
            return vn - e * v
        if hyp == "poisson":
            return p - (1 + e) * pc
        return W - due

    def compressed():
        # The end of a compression; the work of the restitution that follows is due.
        nonlocal vn, W, bal, taken, due, pc, comp
        bal += W
        taken = max(taken, -bal)
        due = e * e * taken - (taken + bal)
        vn, W, pc, comp = mpf(0), mpf(0), p, False

    guard = 0
    while True:
        guard += 1
        s = sqrt(u * u + w * w)
        if s <= scale * mpf(10) ** -21 or guard > 100_000:
            # end in closed form
            fr = max(-mu, min(mu, -nu / uu))
            m = nn + nu * fr
            p0 = p
            if comp:
                d = -vn / m
                W += vn * d / 2
                p += d
                compressed()
            if hyp == "newton":
                vf = max(vn, e * v)
            elif hyp == "poisson":
                vf = vn + m * max(mpf(0), (1 + e) * pc - p)
            else:
                vf = sqrt(vn * vn + 2 * m * max(mpf(0), due - W))
            p += (vf - vn) / m
            pu += fr * (p - p0)
            return p, pu, pw, vf
        U, Wc, S = taylor(u / s, w / s, nu, ma, mb)
        h = mpf("0.35") / fast
        # dp = |s| dtau ; scaled
        slope = [s * (nn * S[i] - mu * nu * U[i]) for i in range(ORD + 1)]
        V = integ(slope, vn)
        P = integ([s * x for x in S], p)
        PU = integ([-mu * s * x for x in U], pu)
        PW = integ([-mu * s * x for x in Wc], pw)
        WW = integ(mul(V[: ORD + 1], [s * x for x in S]), W)

        def sl(t):
            return ev(slope, t)

        crest = h
        if sl(mpf(0)) * sl(h) < 0:
            sg = sl(mpf(0))
            crest = bis(lambda t: -sl(t) * (1 if sg > 0 else -1), mpf(0), h)
        t = h
        for lo, hi in ((mpf(0), crest), (crest, h)):
            if hi <= lo:
                continue
            f = None
            if comp:
                if ev(V, hi) >= 0:
                    t = bis(lambda t: ev(V, t), lo, hi)
                    f = "c"
            else:
                falls = ev(V, hi) < 0
                hh = hi
                if falls:
                    hh = bis(lambda t: -ev(V, t), lo, hi)

                def g(t):
                    return surplus(ev(V, t), ev(P, t), ev(WW, t))

                if g(hh) >= 0:
                    t = bis(g, lo, hh)
                    f = "o"
                elif falls:
                    t = hh
                    f = "a"
            if f:
                break
        else:
            f = None
        vn, p, pu, pw, W = ev(V, t), ev(P, t), ev(PU, t), ev(PW, t), ev(WW, t)
        u, w = s * ev(U, t), s * ev(Wc, t)
        if f == "o":
            return p, pu, pw, vn
        if f == "c":
            compressed()
        if f == "a":
            vn = mpf(0)
            comp = True


def draw(R):
    J = 10 ** R.uniform(-1, 1.5)
    reach = 2 * J**0.5
    n = -R.uniform(0, 1) * reach
    a = R.uniform(-reach, reach)
    return {
        "v": R.uniform(0.01, 2),
        "u": R.uniform(-2, 2),
        "w": R.uniform(-2, 2),
        "J": J,
        "n": n,
        "a": a,
        "ww": 1 + R.uniform(0, 4),
        "mu": R.uniform(0, 1.5) if R.random() < 0.8 else 10 ** R.uniform(-3, 1.5),
        "e": R.choice([R.random(), R.random(), 1.0, 0.0, 10 ** R.uniform(-6, 0)]),
    }


if __name__ == "__main__":
    seed, n = int(sys.argv[1]), int(sys.argv[2])
    R = random.Random(seed)
    for _ in range(n):
        c = draw(R)
        if R.random() < 0.1:
            c["w"] = 10 ** R.uniform(-12, 0)
        if R.random() < 0.1:
            c["v"] = 10 ** R.uniform(-12, 0)
        if R.random() < 0.1:
            c["u"] = 10 ** R.uniform(-12, 0)
        for h in ("stronge", "poisson", "newton"):
            r = solve(hyp=h, **c)
            print(
                h[0],
                *(repr(c[k]) for k in ("v", "u", "w", "J", "n", "a", "ww", "mu", "e")),
                *(mp.nstr(x, 20) for x in r),
                flush=True,
            )
