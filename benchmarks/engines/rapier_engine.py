"""Rapier: impulses once a step or more often, Newton's coefficient of restitution, single precision."""

import rapier3d as rapier

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

NAME = "Rapier (rapier3d 0.36.1)"


def run(angles: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; contacts are nearly rigid, and `stiffness` is left at what the engine chooses."""
    world = rapier.PhysicsWorld(gravity=(0.0, 0.0, -GRAVITY))
    world.integration_parameters.dt = step
    world.integration_parameters.length_unit = RADIUS
    ground = rapier.RigidBody.fixed().build()
    world.add_body(
        ground, [rapier.Collider.halfspace((0.0, 0.0, 1.0)).friction(0.0).restitution(NORMAL).build()]
    )
    properties = rapier.MassProperties((0.0, 0.0, 0.0), MASS, (TRANSVERSE, TRANSVERSE, AXIAL))
    handles = []
    for i, theta in enumerate(angles):
        body = (
            rapier.RigidBody.dynamic()
            .translation((i * SPACING, 0.0, HEIGHT))
            .rotation((0.0, float(theta), 0.0))
            .additional_mass_properties(properties)
            .can_sleep(False)
            .build()
        )
        spheres = [
            rapier.Collider.ball(RADIUS)
            .translation((0.0, 0.0, end * SEPARATION / 2))
            .density(0.0)
            .friction(0.0)
            .restitution(NORMAL)
            .build()
            for end in (-1, 1)
        ]
        handles.append(world.add_body(body, spheres))

    def advance(_: int) -> list[float]:
        world.step()
        return [world.rigid_bodies[handle].linvel.z for handle in handles]

    return record(advance, angles.size, seconds, step)
