"""Which engines, steps and stiffnesses."""

from benchmarks.engines.problem import Kind

SETTINGS: dict[str, tuple[tuple[float, float], ...]] = {
    "mujoco_engine": (
        (2e-3, 1e4),
        (2e-4, 1e4),
        (1e-3, 1e5),
        (1e-4, 1e5),
        (1e-4, 1e6),
        (2e-5, 1e6),
        (2e-5, 1e7),
    ),
    "bullet_engine": ((1 / 240, 0.0), (1e-3, 0.0), (1e-4, 0.0)),
    "rapier_engine": ((1 / 240, 0.0), (1e-3, 0.0), (2.5e-4, 0.0)),
    "lammps_engine": ((5e-5, 1e4), (2e-5, 1e5), (1e-5, 1e6)),
}
"""Steps in s, and stiffnesses: of MuJoCo in 1/s², of LAMMPS in N/m; 0 where contacts are rigid."""
SHAPES: dict[str, tuple[Kind, ...]] = {
    "mujoco_engine": ("sphere", "ellipsoid", "box"),
    "bullet_engine": ("sphere", "box"),
    "rapier_engine": ("sphere", "box"),
    "lammps_engine": ("sphere", "box"),
}
"""Of bodies that an engine has as they are, not as meshes."""
STEPS = (2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)
LONGEST = {"lammps_engine": 2e-4}
"""Of steps, in s: with longer ones bodies leave the box."""
LASTING = (3, 5, 10, 20, 50)
"""Steps that a contact of springs lasts head-on."""
TITLES = {
    "mujoco_engine": "MuJoCo",
    "bullet_engine": "Bullet",
    "rapier_engine": "Rapier",
    "lammps_engine": "LAMMPS",
}
