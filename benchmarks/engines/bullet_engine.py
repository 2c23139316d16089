"""Bullet: impulses once a step, Newton's coefficient of restitution."""

import numpy as np
import pybullet as bullet

from benchmarks.engines.problem import (
    AXIAL,
    GRAVITY,
    HEIGHT,
    MASS,
    NORMAL,
    RADIUS,
    SEPARATION,
    SPACING,
    TRANSVERSE,
    Floats,
    Motion,
    record,
)  # fmt: skip

NAME = "Bullet (pybullet 3.2.7)"
SCALE = 100.0
"""Lengths are multiplied by it, for Bullet is made for bodies of 5 cm to 10 m; times stay as they are."""


def run(angles: Floats, seconds: float, step: float, stiffness: float) -> Motion:
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
        ends = [[0, 0, end * SCALE * SEPARATION / 2] for end in (-1, 1)]
        shape = bullet.createCollisionShapeArray(
            shapeTypes=[bullet.GEOM_SPHERE] * 2, radii=[RADIUS * SCALE] * 2, collisionFramePositions=ends
        )
        bodies = []
        for i, theta in enumerate(angles):
            body = bullet.createMultiBody(
                MASS,
                shape,
                -1,
                [i * SPACING * SCALE, 0, HEIGHT * SCALE],
                [0, np.sin(theta / 2), 0, np.cos(theta / 2)],
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
                localInertiaDiagonal=[SCALE**2 * own for own in (TRANSVERSE, TRANSVERSE, AXIAL)],
                activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            )
            bodies.append(body)

        def advance(_: int) -> list[float]:
            bullet.stepSimulation()
            return [bullet.getBaseVelocity(body)[0][2] / SCALE for body in bodies]

        return record(advance, angles.size, seconds, step)
    finally:
        bullet.disconnect(client)
