"""When the next sphere touches the plane: the first root of Eq. 2, by branch and bound with fifty digits."""

from reference.arithmetic import Real, cross, dot, mp, scaled, vector
from reference.top import Body, State


class Flight:
    """The heights of both sphere centres between two impacts, and the first moment one of them is R (Eq. 2).

    `sign` = +1 is the sphere at +L/2 of the axis, -1 the other one.
    """

    def __init__(self, body: Body, start: State, gravity: Real) -> None:
        self.body, self.start, self.gravity = body, start, gravity
        turn = start.precession(body)
        self.rate = mp.sqrt(dot(turn, turn))
        unit = scaled(1 / self.rate, turn) if self.rate else vector((0, 0, 0))
        # e_z(t) = mean + cosine cos Ωt + sine sin Ωt, the z component of Eq. 3
        self.mean = unit[2] * dot(unit, start.axis)
        self.cosine = start.axis[2] - self.mean
        self.sine = cross(unit, start.axis)[2]
        amplitude = mp.hypot(self.cosine, self.sine)
        self.highest = body.arm * (abs(self.mean) + amplitude)
        self.bend = gravity + body.arm * amplitude * self.rate**2  # no gap is ever bent more than this

    def height(self, time: Real) -> Real:
        """Height of the centre of mass above the lowest place where it is sure to touch, z = R."""
        return (
            self.start.height - self.body.radius + (self.start.velocity[2] - self.gravity / 2 * time) * time
        )

    def gaps(self, time: Real) -> dict[int, tuple[Real, Real]]:
        """Distance of each sphere from the plane, and its rate of change."""
        cosine, sine = mp.cos_sin(self.rate * time)
        lift = self.body.arm * (self.mean + self.cosine * cosine + self.sine * sine)
        lift_rate = self.body.arm * self.rate * (self.sine * cosine - self.cosine * sine)
        height, rate = self.height(time), self.start.velocity[2] - self.gravity * time
        return {sign: (height + sign * lift, rate + sign * lift_rate) for sign in (1, -1)}

    def first_contact(self) -> tuple[Real, int]:
        """Time and sphere of the next contact, from a state where no sphere is below the plane.

        Branch and bound: an interval is bisected until Taylor's theorem says, for both spheres, that the
        gap has no zero in it or is monotonic. A gap that is zero at the start and rises (the sphere just
        hit) is no contact.
        """
        fall = self.start.velocity[2]
        latest = (fall + mp.sqrt(fall**2 + 2 * self.gravity * self.height(0))) / self.gravity
        pending = [(mp.mpf(0), latest * (1 + mp.mpf(2) ** -10))]
        while pending:
            begin, end = pending.pop()
            if self.highest < min(self.height(begin), self.height(end)):
                continue  # the parabola is concave: above both spheres' reach at the ends, so in between
            if end - begin < latest * mp.mpf(10) ** -40:
                raise ArithmeticError("a contact grazes the plane within the precision of the reference")
            falling = self._falling(begin, end)
            if falling is None:
                middle = (begin + end) / 2
                pending += [(middle, end), (begin, middle)]
                continue
            crossings = [(self._crossing(sign, begin, end), sign) for sign in falling]
            if crossings:
                return min(crossings)
        raise ArithmeticError("no contact: a gap was negative at the start")

    def _falling(self, begin: Real, end: Real) -> list[int] | None:
        """The spheres whose gap falls through zero between `begin` and `end`; None where undecided."""
        half = (end - begin) / 2
        at_end = self.gaps(end)
        falling = []
        for sign, (gap, rate) in self.gaps(begin + half).items():
            if gap > abs(rate) * half + self.bend * half**2 / 2 or rate > self.bend * half:
                continue
            if rate >= -self.bend * half:
                return None
            if at_end[sign][0] <= 0:
                falling.append(sign)
        return falling

    def _crossing(self, sign: int, begin: Real, end: Real) -> Real:
        """Newton's method, guarded by bisection, on a bracket where the gap falls all the way."""
        start = self.start
        highest = start.height + start.velocity[2] ** 2 / (2 * self.gravity)
        resolution = highest * mp.mpf(10) ** -48  # the gap is a difference of heights up to this one
        time = end
        for _ in range(200):
            gap, rate = self.gaps(time)[sign]
            if abs(gap) <= resolution:
                return time
            begin, end = (time, end) if gap > 0 else (begin, time)
            time -= gap / rate
            if not begin <= time <= end:
                time = (begin + end) / 2
        raise ArithmeticError("Newton's method did not settle")
