"""Bullet: impulses once a step, Newton's coefficient of restitution."""

import numpy as np
import pybullet as bullet

from benchmarks.engines.problem import (
    GRAVITY,
    HEIGHT,
    NORMAL,
    SPACING,
    Floats,
    Motion,
    Solid,
    record,
)

NAME = "Bullet (pybullet 3.2.7)"
SCALE = 100.0
"""Lengths are multiplied by it, for Bullet is made for bodies of 5 cm to 10 m; times stay as they are."""


def sprung(solid: Solid) -> float:
    """Give no mass: contacts are rigid."""
    return 0.0


def run(solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; contacts are rigid, and there is no `stiffness`."""
    client = bullet.connect(bullet.DIRECT)
    try:
        bullet.setGravity(0, 0, -GRAVITY * SCALE)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=step,
            numSubSteps=1,
            restitutionVelocityThreshold=1e-4 * SCALE,
            deterministicOverlappingPairs=1,
        )
        ground = bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE))
        bullet.changeDynamics(ground, -1, restitution=1.0, lateralFriction=0.0)
        sizes, places = SCALE * np.array(solid.sizes), (SCALE * np.array(solid.places)).tolist()
        if solid.kind == "sphere":
            shape = bullet.createCollisionShapeArray(
                shapeTypes=[bullet.GEOM_SPHERE] * len(sizes),
                radii=sizes[:, 0].tolist(),
                collisionFramePositions=places,
            )
        else:
            shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=sizes[0].tolist())
        bodies = []
        for i, (w, x, y, z) in enumerate(attitudes):
            body = bullet.createMultiBody(
                solid.mass, shape, -1, [i * SPACING * SCALE, 0, HEIGHT * SCALE], [x, y, z, w]
            )
            bullet.changeDynamics(
                body,
                -1,
                restitution=NORMAL,
                lateralFriction=0.0,
                rollingFriction=0.0,
                spinningFriction=0.0,
                linearDamping=0.0,
                angularDamping=0.0,
                localInertiaDiagonal=[SCALE**2 * own for own in solid.moments],
                activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            )
            bodies.append(body)
        return record(
            lambda _: bullet.stepSimulation(),
            lambda: [bullet.getBaseVelocity(body)[0][2] / SCALE for body in bodies],
            len(bodies),
            seconds,
            step,
        )
    finally:
        bullet.disconnect(client)
