"""The bouncing dumbbell as an initial value problem: the Newton-Euler equations and a general integrator.

Nothing here knows that the flight has a closed form. The attitude is a unit quaternion (w, x, y, z) from
the body's frame to the laboratory's, the angular velocity is kept in the body's frame, and an impact is the
nine linear equations for v', ω' and P at once. Double precision, SI units, per unit mass.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
Event = Callable[[float, Array], float]
# the layout of a state: height of the centre of mass, v_G, quaternion, angular velocity in the body's frame
HEIGHT, VELOCITY, ATTITUDE, SPIN = 0, slice(1, 4), slice(4, 8), slice(8, 11)
TURN_PER_STEP = 0.1  # radians; the integrator sees a sphere dip below the plane only at the ends of its steps


class Impact(NamedTuple):
    """One impact, under the names of the variables that `restitution.simulate` returns."""

    time: float
    impact_velocity: float
    rebound_velocity: float
    restitution: float
    rotational_fraction: float
    energy_ratio: float
    angle: float
    contact: int


def released(
    angle: float,
    height: float,
    velocity: Array | None = None,
    spin: Array | None = None,
    azimuth: float = 0.0,
) -> Array:
    """The axis leans by `angle` from the vertical towards +x, and is turned about the vertical by `azimuth`.

    `velocity` and `spin` are the laboratory's.
    """
    turned = Rotation.from_euler("ZY", [azimuth, angle])
    attitude = turned.as_quat(scalar_first=True)
    state = np.concatenate([[height], np.zeros(3), attitude, np.zeros(3)])
    if velocity is not None:
        state[VELOCITY] = velocity
    if spin is not None:
        state[SPIN] = frame(state).T @ spin
    return state


def frame(state: Array) -> Array:
    """Columns: the body's axes in the laboratory; the last one is the symmetry axis."""
    return np.asarray(Rotation.from_quat(state[ATTITUDE], scalar_first=True).as_matrix())


class Problem:
    """Body (with L < 2R, where one integral covers it), law, gravity, and the integrator's tolerance.

    The law is the paper's, or without `tangential` the frictionless one. `gravity` points down, or, over a
    plane inclined by `incline`, also along +x.
    """

    def __init__(
        self,
        radius: float,
        separation: float,
        normal: float,
        tangential: float | None,
        gravity: float = 9.81,
        tolerance: float = 1e-12,
        incline: float = 0.0,
    ) -> None:
        self.radius, self.arm, self.tolerance = radius, separation / 2, tolerance
        self.gravity, self.along = gravity * np.cos(incline), gravity * np.sin(incline)
        self.normal, self.tangential = normal, tangential

        def over_slices(weight: Callable[[float, float], float]) -> float:
            def integrand(z: float) -> float:
                return weight(radius**2 - (z - self.arm) ** 2, z)  # (A2)

            return float(quad(integrand, 0.0, radius + self.arm, epsabs=0.0, epsrel=1e-13)[0])

        mass = over_slices(lambda rho2, z: rho2)  # (A3)
        across = over_slices(lambda rho2, z: rho2**2 / 4 + z**2 * rho2)  # (A6)
        along = over_slices(lambda rho2, z: rho2**2 / 2)  # (A5)
        self.moments = np.array([across, across, along]) / mass

    def derivative(self, time: float, state: Array) -> Array:
        """Newton: dv/dt = g. Euler: J dω/dt = Jω × ω in the body's frame. dq/dt = qω/2."""
        w, x, y, z = state[ATTITUDE].tolist()
        p, q, r = state[SPIN].tolist()
        a, b, c = self.moments.tolist()
        attitude = [
            -x * p - y * q - z * r,
            w * p + y * r - z * q,
            w * q + z * p - x * r,
            w * r + x * q - y * p,
        ]
        spin = [(b - c) * q * r / a, (c - a) * r * p / b, (a - b) * p * q / c]
        return np.array([state[3], self.along, 0.0, -self.gravity, *(0.5 * rate for rate in attitude), *spin])

    def gap(self, sign: int) -> Event:
        """Distance of sphere +1 or -1 from the plane, as an event that ends the integration at 0."""

        def event(time: float, state: Array) -> float:
            w, x, y, z = state[ATTITUDE].tolist()
            lift = sign * self.arm * (w * w - x * x - y * y + z * z) / (w * w + x * x + y * y + z * z)
            return float(state[HEIGHT] + lift - self.radius)

        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        return event

    def flight(self, state: Array, hit: int) -> tuple[float, Array, int]:
        """Duration of the flight, state at its end, and the sphere (+1 or -1) that touches.

        `hit` is the sphere that has just rebounded, 0 at the release. Its gap is 0 at the start up to
        rounding, so it is not watched before it is certainly above the plane: its centre rises at u and is
        accelerated by at most g + (L/2)ω², so it is up for at least 2u/(g + (L/2)ω²).
        """
        # |ω| stays below this in the flight: the rotational energy is conserved.
        fastest = float(np.sqrt(self.moments @ state[SPIN] ** 2 / self.moments.min()))
        elapsed = 0.0
        if hit:
            spin = frame(state) @ state[SPIN]
            rise = state[VELOCITY][2] + np.cross(spin, hit * self.arm * frame(state)[:, 2])[2]
            first = rise / (self.gravity + self.arm * fastest**2)
            end, state, touched = self.integrate(state, first, (-hit,), fastest)
            if touched:
                return end, state, touched
            elapsed = first
        up, fall = state[VELOCITY][2], 2 * self.gravity * state[HEIGHT]
        longest = (up + np.sqrt(up**2 + fall)) / self.gravity  # to z = 0, deeper than any contact
        end, state, touched = self.integrate(state, longest, (1, -1), fastest)
        if not touched:
            raise ArithmeticError("the body fell through the plane")
        return elapsed + end, state, touched

    def integrate(
        self, state: Array, duration: float, signs: tuple[int, ...], fastest: float
    ) -> tuple[float, Array, int]:
        """The motion for `duration` or until one of the spheres `signs` touches (0 for none)."""
        path = solve_ivp(
            self.derivative,
            (0.0, duration),
            state,
            method="DOP853",
            rtol=self.tolerance,
            atol=1e-18,
            events=[self.gap(sign) for sign in signs],
            max_step=TURN_PER_STEP / fastest if fastest else np.inf,
        )
        for sign, touches in zip(signs, path.t_events or (), strict=True):
            if touches.size:
                return float(path.t[-1]), path.y[:, -1], sign
        return duration, path.y[:, -1], 0

    def collide(self, state: Array, sign: int) -> Array:
        """The state after an impact of sphere `sign`: Eqs. 9 to 11 as nine equations for v', ω' and P/m."""
        axes = frame(state)
        tensor = axes @ np.diag(self.moments) @ axes.T
        spin = axes @ state[SPIN]
        x, y, z = sign * self.arm * axes[:, 2] - np.array([0.0, 0.0, self.radius])  # r_c (6)
        skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])  # [r]ω = r × ω
        contact = state[VELOCITY] - skew @ spin  # v_c (7)
        eye, nothing = np.eye(3), np.zeros((3, 3))
        last = np.block([eye, -skew, nothing])  # v_c'
        if self.tangential is None:
            wanted = np.array([0.0, 0.0, -self.normal * contact[2]])
            last[:2] = np.eye(9)[6:8]  # P_t = 0
        else:
            wanted = np.array([self.tangential, self.tangential, -self.normal]) * contact  # v_c' (9)
        left = np.block([[eye, nothing, -eye], [nothing, tensor, -skew], [last]])
        right = np.concatenate([state[VELOCITY], tensor @ spin, wanted])
        solution = np.linalg.solve(left, right)
        after = state.copy()
        after[VELOCITY], after[SPIN] = solution[:3], axes.T @ solution[3:6]
        after[HEIGHT] = self.radius - sign * self.arm * axes[2, 2]
        return after

    def bounce(self, state: Array) -> Iterator[Impact]:
        """All impacts from `state` on, without end."""
        time, hit = 0.0, 0
        while True:
            duration, before, hit = self.flight(state, hit)
            time += duration
            state = self.collide(before, hit)
            fall, rebound = -before[VELOCITY][2], state[VELOCITY][2]
            rotation, translation = self.moments @ before[SPIN] ** 2, before[VELOCITY] @ before[VELOCITY]
            left = self.moments @ state[SPIN] ** 2 + state[VELOCITY] @ state[VELOCITY]
            axis = frame(before)[:, 2]
            yield Impact(
                time,
                float(fall),
                float(rebound),
                float(rebound / fall),  # (1)
                float(rotation / (rotation + translation)),  # (12)
                float(left / (rotation + translation)),
                float(np.arctan2(np.hypot(axis[0], axis[1]), axis[2])),
                1 if hit > 0 else 2,
            )
