from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["NumericalError", "dumbbell_inertia", "simulate", "sincos"]

class NumericalError(RuntimeError): ...

def dumbbell_inertia(radius: float, separation: float, density: float) -> tuple[float, float, float]: ...
def sincos(x: float) -> tuple[float, float]: ...
def simulate(
    *,
    radius: float,
    separation: float,
    density: float,
    normal: float,
    tangential: float,
    particles: int,
    impacts: int,
    release_height: float,
    gravity: float,
    orientation: str | npt.NDArray[np.float64],
    minimum_speed: float,
    seed: int,
    threads: int,
    progress: Callable[[int], None] | None,
) -> tuple[dict[str, npt.NDArray[Any]], bool]: ...
