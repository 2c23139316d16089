from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = [
    "CREATES_ENERGY",
    "NumericalError",
    "Solid",
    "build_info",
    "dumbbell",
    "loaded_sphere",
    "mixture_draw",
    "mixture_value",
    "normal_coefficient",
    "respond",
    "simulate",
    "sincos",
    "spherocylinder",
    "spheroid",
    "statistics",
]

CREATES_ENERGY: float

class NumericalError(RuntimeError): ...

class Solid:
    @property
    def mass(self) -> float: ...
    @property
    def transverse_inertia(self) -> float: ...
    @property
    def axial_inertia(self) -> float: ...
    @property
    def centre_of_mass(self) -> float: ...
    def lowest(self, cosines: npt.NDArray[np.float64]) -> float: ...
    def farthest(self) -> float: ...

def dumbbell(radius: tuple[float, float], separation: float, density: tuple[float, float]) -> Solid: ...
def loaded_sphere(radius: float, density: float, load: float, offset: float) -> Solid: ...
def spherocylinder(radius: float, separation: float, density: float) -> Solid: ...
def spheroid(equatorial: float, polar: float, density: float) -> Solid: ...
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
    fraction_bins: npt.NDArray[np.float64] | None,
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
