"""A box that lands flat: four corners at one instant, and ε of all orders of their impacts.

Beside the order in which the engine takes them stand all others that Newton's law allows: at every turn any
corner that approaches the plane may be next, until none does.
"""

import numpy as np

import restitution as rs

SIDES, NORMAL = np.array([20e-3, 10e-3, 10e-3]), 0.5  # m, ε_n


def net(order: np.random.Generator) -> tuple[float, int]:
    """Net ε without friction of a box that falls flat, and the number of impacts; per unit mass."""
    inertia = (np.sum(SIDES**2) - SIDES**2) / 12.0
    corners = np.array([(x, y, -1.0) for x in (-1.0, 1.0) for y in (-1.0, 1.0)]) * SIDES / 2.0
    velocity, spin, number = -1.0, np.zeros(3), 0
    turns = np.cross(corners, [0.0, 0.0, 1.0])  # r × n
    while True:
        approach = velocity + turns @ spin
        (falling,) = np.nonzero(approach < -1e-12)
        if falling.size == 0:
            return velocity, number
        k = order.choice(falling)
        impulse = -(1.0 + NORMAL) * approach[k] / (1.0 + np.sum(turns[k] ** 2 / inertia))
        velocity, spin, number = velocity + impulse, spin + impulse * turns[k] / inertia, number + 1


if __name__ == "__main__":
    box, law = rs.Box(a=SIDES[0], b=SIDES[1], c=SIDES[2]), rs.Frictionless(normal=NORMAL)
    data = rs.simulate(box, law, particles=1, impacts=12, orientation=[(1.0, 0.0, 0.0, 0.0)])
    found = rs.clusters(data)
    print(f"engine: ε = {float(found.restitution[0, 0]):.3f} of {int(found.impacts[0, 0])} impacts")
    orders = np.array([net(np.random.default_rng(seed)) for seed in range(5000)])
    low, middle, high = np.quantile(orders[:, 0], [0.0, 0.5, 1.0])
    print(f"any order: ε from {low:.3f} to {high:.3f}, half of them below {middle:.3f}")
    print(f"in {orders[:, 1].min():.0f} to {orders[:, 1].max():.0f} impacts")
