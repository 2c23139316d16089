"""Rapier: impulses once a step or more often, Newton's coefficient of restitution, single precision."""

import rapier3d as rapier

from benchmarks.engines.problem import (
    GRAVITY,
    HEIGHT,
    NORMAL,
    RADIUS,
    SPACING,
    Floats,
    Motion,
    Solid,
    record,
)

NAME = "Rapier (rapier3d 0.36.1)"


def sprung(solid: Solid) -> float:
    """Give no mass: contacts are rigid."""
    return 0.0


def run(solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; contacts are nearly rigid, and `stiffness` is left at what the engine chooses."""
    world = rapier.PhysicsWorld(gravity=(0.0, 0.0, -GRAVITY))
    world.integration_parameters.dt = step
    world.integration_parameters.length_unit = RADIUS
    ground = rapier.RigidBody.fixed().build()
    world.add_body(
        ground, [rapier.Collider.halfspace((0.0, 0.0, 1.0)).friction(0.0).restitution(NORMAL).build()]
    )
    properties = rapier.MassProperties((0.0, 0.0, 0.0), solid.mass, solid.moments)
    collider = rapier.Collider.ball if solid.kind == "sphere" else rapier.Collider.cuboid
    handles = []
    for i, attitude in enumerate(attitudes):
        turn = rapier.Rotation3(*map(float, attitude))
        body = (
            rapier.RigidBody.dynamic()
            .translation((i * SPACING, 0.0, HEIGHT))
            .rotation(turn.scaled_axis)
            .additional_mass_properties(properties)
            .can_sleep(False)
            .build()
        )
        parts = [
            collider(*size).translation(place).density(0.0).friction(0.0).restitution(NORMAL).build()
            for size, place in zip(solid.sizes, solid.places, strict=True)
        ]
        handles.append(world.add_body(body, parts))
    return record(
        lambda _: world.step(),
        lambda: [world.rigid_bodies[handle].linvel.z for handle in handles],
        len(handles),
        seconds,
        step,
    )
