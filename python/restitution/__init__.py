"""The coefficient of restitution as a distribution, not a number."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from restitution import analytic, figures, fit, flight, sound, study
    from restitution._compare import compare
    from restitution._core import NumericalError, build_info
    from restitution._energy import EnergyWarning
    from restitution._reduce import reduce
    from restitution._release import RandomHeight, RandomSpin
    from restitution._simulate import SimulationInterrupted, simulate
    from restitution._statistics import statistics
    from restitution._trajectory import trajectory
    from restitution.bodies import (
        Dumbbell,
        LoadedSphere,
        Spherocylinder,
        Spheroid,
        ball_grade,
        from_roundness,
    )
    from restitution.budget import ErrorBudget, RequiredRoundness, error_budget, required_roundness
    from restitution.distribution import DistanceWarning, FluctuatingRestitution
    from restitution.explorer import explore
    from restitution.inference import posterior
    from restitution.laws import (
        ChatterjeeRuina,
        Coulomb,
        Frictionless,
        Plastic,
        Tabulated,
        TangentialRestitution,
        Viscoelastic,
    )
    from restitution.study import sweep

__all__ = [
    "ChatterjeeRuina",
    "Coulomb",
    "DistanceWarning",
    "Dumbbell",
    "EnergyWarning",
    "ErrorBudget",
    "FluctuatingRestitution",
    "Frictionless",
    "LoadedSphere",
    "NumericalError",
    "Plastic",
    "RandomHeight",
    "RandomSpin",
    "RequiredRoundness",
    "SimulationInterrupted",
    "Spherocylinder",
    "Spheroid",
    "Tabulated",
    "TangentialRestitution",
    "Viscoelastic",
    "analytic",
    "ball_grade",
    "build_info",
    "compare",
    "error_budget",
    "explore",
    "figures",
    "fit",
    "flight",
    "from_roundness",
    "posterior",
    "reduce",
    "required_roundness",
    "simulate",
    "sound",
    "statistics",
    "study",
    "sweep",
    "trajectory",
]

_HOMES = {
    "Dumbbell": "bodies",
    "LoadedSphere": "bodies",
    "Spherocylinder": "bodies",
    "Spheroid": "bodies",
    "ball_grade": "bodies",
    "from_roundness": "bodies",
    "ErrorBudget": "budget",
    "RequiredRoundness": "budget",
    "error_budget": "budget",
    "required_roundness": "budget",
    "DistanceWarning": "distribution",
    "FluctuatingRestitution": "distribution",
    "NumericalError": "_core",
    "build_info": "_core",
    "compare": "_compare",
    "explore": "explorer",
    "posterior": "inference",
    "EnergyWarning": "_energy",
    "RandomHeight": "_release",
    "RandomSpin": "_release",
    "reduce": "_reduce",
    "SimulationInterrupted": "_simulate",
    "ChatterjeeRuina": "laws",
    "Coulomb": "laws",
    "Frictionless": "laws",
    "Plastic": "laws",
    "Tabulated": "laws",
    "TangentialRestitution": "laws",
    "Viscoelastic": "laws",
    "simulate": "_simulate",
    "statistics": "_statistics",
    "sweep": "study",
    "trajectory": "_trajectory",
}
"""The module that each public name comes from; the others are modules themselves."""


def __getattr__(name: str) -> Any:
    """Import what a name needs when it is first used, so that the command line answers at once."""
    from importlib import import_module

    if name == "__version__":
        from importlib.metadata import version

        return version("restitution")
    if name in _HOMES:
        value = getattr(import_module(f"restitution.{_HOMES[name]}"), name)
    elif name in __all__:
        value = import_module(f"restitution.{name}")
    else:
        from difflib import get_close_matches

        meant = "".join(f"; did you mean {close}?" for close in get_close_matches(name, __all__, n=1))
        raise AttributeError(f"module 'restitution' has no attribute {name!r}{meant}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
