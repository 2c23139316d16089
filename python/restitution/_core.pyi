from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = [
    "NumericalError",
    "build_info",
    "dumbbell_inertia",
    "mixture_draw",
    "mixture_value",
    "simulate",
    "sincos",
    "statistics",
]

class NumericalError(RuntimeError): ...

def dumbbell_inertia(radius: float, separation: float, density: float) -> tuple[float, float, float]: ...
def sincos(x: float) -> tuple[float, float]: ...
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
def mixture_value(
    table: Mapping[str, Any],
    what: str,
    x: npt.NDArray[np.float64],
    v: npt.NDArray[np.float64],
    z: npt.NDArray[np.float64],
    threads: int,
) -> tuple[npt.NDArray[np.float64], bool]: ...
def mixture_draw(
    table: Mapping[str, Any],
    v: npt.NDArray[np.float64],
    z: npt.NDArray[np.float64],
    size: int,
    seed: int,
    threads: int,
) -> tuple[npt.NDArray[np.float64], bool]: ...
