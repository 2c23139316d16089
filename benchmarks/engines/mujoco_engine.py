"""MuJoCo: contacts are springs and dampers in the space of constraints, integrated with the motion."""

import mujoco
import numpy as np

from benchmarks.engines.problem import (
    GRAVITY,
    HEIGHT,
    SPACING,
    Floats,
    Motion,
    Solid,
    damping,
    record,
)

NAME = f"MuJoCo {mujoco.__version__}"


def sprung(solid: Solid) -> float:
    """Give the mass in the unit of the stiffness, which is that of a unit mass."""
    return 1.0


def run(solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; `stiffness` is that of MuJoCo's ``solref``, in 1/s², the damping follows from ε_n."""
    contact = (
        f'condim="1" solref="{-stiffness} {-damping(stiffness)}" solimp="0.9999 0.9999 0.001" margin="0"'
    )
    parts = "".join(
        f'<geom type="{solid.kind}" size="{_words(size)}" pos="{_words(place)}" mass="0" contype="1" '
        f'conaffinity="0" {contact}/>'
        for size, place in zip(solid.sizes, solid.places, strict=True)
    )
    bodies = [
        f'<body pos="{i * SPACING} 0 {HEIGHT}" quat="{_words(attitude)}"><freejoint/>'
        f'<inertial pos="0 0 0" mass="{solid.mass}" diaginertia="{_words(solid.moments)}"/>'
        f"{parts}</body>"
        for i, attitude in enumerate(attitudes)
    ]
    plane = f'<geom type="plane" size="0 0 1" contype="0" conaffinity="1" {contact}/>'
    option = f'<option timestep="{step}" gravity="0 0 {-GRAVITY}" integrator="Euler" tolerance="0"/>'
    size = '<size memory="200M"/>'
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco>{option}{size}<worldbody>{plane}{''.join(bodies)}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    return record(
        lambda _: mujoco.mj_step(model, data),
        lambda: np.asarray(data.qvel[2::6]),
        len(attitudes),
        seconds,
        step,
    )


def _words(numbers: Floats | tuple[float, ...]) -> str:
    return " ".join(str(float(number)) for number in numbers)
