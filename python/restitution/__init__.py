"""The coefficient of restitution as a distribution, not a number."""
# ruff: noqa: F405 (names of the tables come from the modules that have them)

from typing import TYPE_CHECKING, Any

from restitution import _core

if TYPE_CHECKING:
    from restitution import analytic, figures, fit, gas, pair, study
    from restitution._core import NumericalError, build_info
    from restitution.bodies import *  # noqa: F403
    from restitution.distribution import DistanceWarning, FluctuatingRestitution
    from restitution.drop.budget import energy_budget
    from restitution.drop.clusters import ClusterWarning, clusters
    from restitution.drop.compare import compare
    from restitution.drop.energy import EnergyWarning, PullWarning
    from restitution.drop.reduce import reduce
    from restitution.drop.release import RandomHeight, RandomSpin
    from restitution.drop.resting import resting
    from restitution.drop.simulate import SimulationInterrupted, simulate
    from restitution.drop.statistics import statistics
    from restitution.drop.trajectory import trajectory
    from restitution.experiment import flight, sound
    from restitution.experiment.budget import ErrorBudget, RequiredRoundness, error_budget, required_roundness
    from restitution.experiment.inference import posterior
    from restitution.explorer import explore
    from restitution.laws import *  # noqa: F403
    from restitution.pair import PairKernel, Plane
    from restitution.study import sweep

__all__ = [
    "Box",
    "ChatterjeeRuina",
    "Clump",
    "ClusterWarning",
    "ConvexPolyhedron",
    "Coulomb",
    "CustomLaw",
    "Cylinder",
    "Die",
    "DistanceWarning",
    "Dumbbell",
    "Egg",
    "Ellipsoid",
    "EnergyWarning",
    "ErrorBudget",
    "FluctuatingRestitution",
    "Frictionless",
    "LoadedSphere",
    "Mesh",
    "NumericalError",
    "PairKernel",
    "Plane",
    "Plastic",
    "PullWarning",
    "RandomHeight",
    "RandomSpin",
    "RequiredRoundness",
    "Revolution",
    "Ring",
    "Rough",
    "RoughSphere",
    "Scattered",
    "SimulationInterrupted",
    "Spherocylinder",
    "Spheroid",
    "Superellipsoid",
    "Tabulated",
    "TangentialRestitution",
    "TruncatedCone",
    "Viscoelastic",
    "analytic",
    "ball_grade",
    "ball_roughness",
    "build_info",
    "clusters",
    "compare",
    "energy_budget",
    "error_budget",
    "explore",
    "figures",
    "fit",
    "flight",
    "from_roundness",
    "gas",
    "pair",
    "posterior",
    "reduce",
    "required_roundness",
    "resting",
    "simulate",
    "sound",
    "statistics",
    "study",
    "sweep",
    "trajectory",
]

_NAMES = {
    "_core": "NumericalError build_info",
    "bodies": "Rough ball_grade ball_roughness from_roundness",
    "distribution": "DistanceWarning FluctuatingRestitution",
    "drop.budget": "energy_budget",
    "drop.clusters": "ClusterWarning clusters",
    "drop.compare": "compare",
    "drop.energy": "EnergyWarning PullWarning",
    "drop.reduce": "reduce",
    "drop.release": "RandomHeight RandomSpin",
    "drop.resting": "resting",
    "drop.simulate": "SimulationInterrupted simulate",
    "drop.statistics": "statistics",
    "drop.trajectory": "trajectory",
    "experiment.budget": "ErrorBudget RequiredRoundness error_budget required_roundness",
    "experiment.inference": "posterior",
    "explorer": "explore",
    "laws": "CustomLaw",
    "pair": "PairKernel Plane",
    "study": "sweep",
}
"""The names that come from a module, besides those of the tables of the core."""
_HOMES = {
    **dict.fromkeys((entry["name"] for entry in _core.BODIES), "bodies"),
    **dict.fromkeys((entry["name"] for entry in (*_core.LAWS, *_core.MATERIALS)), "laws"),
    **{name: module for module, names in _NAMES.items() for name in names.split()},
}
"""The module that each public name comes from; the others are modules themselves."""
_FOLDERS = {"flight": "experiment.flight", "sound": "experiment.sound"}
"""The folders of the public modules that do not stand at the root."""


def __getattr__(name: str) -> Any:
    """Import what a name needs when it is first used, so that the command line answers at once."""
    from importlib import import_module

    if name == "__version__":
        from importlib.metadata import version

        return version("restitution")
    if name in _HOMES:
        value = getattr(import_module(f"restitution.{_HOMES[name]}"), name)
    elif name in __all__:
        value = import_module(f"restitution.{_FOLDERS.get(name, name)}")
    else:
        from difflib import get_close_matches

        meant = "".join(f"; did you mean {close}?" for close in get_close_matches(name, __all__, n=1))
        raise AttributeError(f"module 'restitution' has no attribute {name!r}{meant}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
