"""The coefficient of restitution as a distribution, not a number."""

from typing import TYPE_CHECKING, Any

from restitution._core import NumericalError
from restitution._simulate import SimulationInterrupted, simulate
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution

if TYPE_CHECKING:
    from restitution import analytic, figures, fit
    from restitution._statistics import statistics

__all__ = [
    "Dumbbell",
    "NumericalError",
    "SimulationInterrupted",
    "TangentialRestitution",
    "analytic",
    "figures",
    "fit",
    "simulate",
    "statistics",
]

_LAZY_MODULES = ("analytic", "figures", "fit")


def __getattr__(name: str) -> Any:
    """Import SciPy, xarray and matplotlib only when what needs them is used."""
    from importlib import import_module

    if name in _LAZY_MODULES:
        return import_module(f"restitution.{name}")
    if name == "statistics":
        from restitution._statistics import statistics

        return statistics
    if name == "__version__":
        from importlib.metadata import version

        return version("restitution")
    raise AttributeError(f"module 'restitution' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
