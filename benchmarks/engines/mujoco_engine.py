"""MuJoCo: contacts are springs and dampers in the space of constraints, integrated with the motion."""

import mujoco
import numpy as np

from benchmarks.engines.problem import (
    AXIAL,
    GRAVITY,
    HEIGHT,
    MASS,
    RADIUS,
    SEPARATION,
    SPACING,
    TRANSVERSE,
    Floats,
    Motion,
    damping,
    record,
)  # fmt: skip

NAME = f"MuJoCo {mujoco.__version__}"


def run(angles: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; `stiffness` is that of MuJoCo's ``solref``, in 1/s², the damping follows from ε_n."""
    contact = (
        f'condim="1" solref="{-stiffness} {-damping(stiffness)}" solimp="0.9999 0.9999 0.001" margin="0"'
    )
    bodies = []
    for i, theta in enumerate(angles):
        quaternion = f"{np.cos(theta / 2)} 0 {np.sin(theta / 2)} 0"
        spheres = "".join(
            f'<geom type="sphere" size="{RADIUS}" pos="0 0 {end * SEPARATION / 2}" mass="0" contype="1" '
            f'conaffinity="0" {contact}/>'
            for end in (-1, 1)
        )
        bodies.append(
            f'<body pos="{i * SPACING} 0 {HEIGHT}" quat="{quaternion}"><freejoint/>'
            f'<inertial pos="0 0 0" mass="{MASS}" diaginertia="{TRANSVERSE} {TRANSVERSE} {AXIAL}"/>'
            f"{spheres}</body>"
        )
    plane = f'<geom type="plane" size="0 0 1" contype="0" conaffinity="1" {contact}/>'
    option = f'<option timestep="{step}" gravity="0 0 {-GRAVITY}" integrator="Euler" tolerance="0"/>'
    size = '<size memory="200M"/>'
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco>{option}{size}<worldbody>{plane}{''.join(bodies)}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)

    def advance(_: int) -> Floats:
        mujoco.mj_step(model, data)
        return np.asarray(data.qvel[2::6])

    return record(advance, angles.size, seconds, step)
