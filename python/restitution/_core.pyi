from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = [
    "NumericalError",
    "build_info",
    "dumbbell_inertia",
    "normal_coefficient",
    "respond",
    "simulate",
    "sincos",
    "statistics",
]

class NumericalError(RuntimeError): ...

def dumbbell_inertia(radius: float, separation: float, density: float) -> tuple[float, float, float]: ...
def sincos(x: float) -> tuple[float, float]: ...
def normal_coefficient(
    normal: float | Mapping[str, Any], speeds: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]: ...
def respond(
    law: Mapping[str, Any],
    slip: tuple[float, float, float],
    arm: tuple[float, float],
    inertia: float,
    across: float,
) -> tuple[tuple[float, float, float], float]: ...
def simulate(
    run: Mapping[str, Any],
    threads: int,
    progress: Callable[[int], None] | None,
) -> tuple[dict[str, npt.NDArray[Any]], bool]: ...
def statistics(
    run: Mapping[str, Any],
    velocity_bins: npt.NDArray[np.float64] | None,
    restitution_bins: npt.NDArray[np.float64],
    fraction_bins: npt.NDArray[np.float64],
    threads: int,
    progress: Callable[[int], None] | None,
) -> tuple[dict[str, npt.NDArray[Any]], bool]: ...
def build_info() -> dict[str, Any]: ...
