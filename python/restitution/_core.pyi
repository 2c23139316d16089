from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

__all__ = [
    "AXES",
    "BODIES",
    "CREATES_ENERGY",
    "LARGEST_RESTITUTION",
    "LAWS",
    "MATERIALS",
    "MOST_FRICTION",
    "MOST_RADIANS",
    "ORIENTATIONS",
    "PADE",
    "PAIR_CONTACT",
    "PAIR_ENCOUNTER",
    "PAIR_ENDINGS",
    "PULLS",
    "STOP_REASONS",
    "Counter",
    "Histogram",
    "Law",
    "Levels",
    "MagnitudeError",
    "Material",
    "Mixture",
    "NumericalError",
    "ParameterError",
    "Rigid",
    "Solid",
    "body",
    "build_info",
    "bytes_per_impact",
    "clears",
    "columns",
    "custom",
    "encounters",
    "faces",
    "hull",
    "law",
    "material",
    "rough",
    "scattered",
    "simulate",
    "simulate_series",
    "sincos",
    "statistics",
    "turned",
]

CREATES_ENERGY: float
PULLS: float
LARGEST_RESTITUTION: float
MOST_RADIANS: float
ORIENTATIONS: list[str]
AXES: list[str]
BODIES: list[dict[str, Any]]
LAWS: list[dict[str, Any]]
MATERIALS: list[dict[str, Any]]
STOP_REASONS: list[str]
PAIR_CONTACT: dict[str, int]
PAIR_ENCOUNTER: dict[str, int]
PAIR_ENDINGS: list[str]

MOST_FRICTION: float
PADE: tuple[list[float], list[float]]

_Table: TypeAlias = dict[str, tuple[tuple[str, ...], npt.NDArray[Any], dict[str, Any]]]
_Edges: TypeAlias = Mapping[str, npt.NDArray[np.float64] | None]

class NumericalError(RuntimeError): ...

class ParameterError(ValueError):
    name: str
    value: float | int | str
    allowed: str

class MagnitudeError(ParameterError): ...

class Solid:
    @property
    def mass(self) -> float: ...
    @property
    def transverse_inertia(self) -> float: ...
    @property
    def axial_inertia(self) -> float: ...
    @property
    def centre_of_mass(self) -> float: ...
    @property
    def outline(self) -> list[list[float]]: ...
    def lowest(self, cosines: npt.NDArray[np.float64]) -> float: ...
    def farthest(self) -> float: ...

class Rigid:
    @property
    def mass(self) -> float: ...
    @property
    def centre(self) -> list[float]: ...
    @property
    def inertia_tensor(self) -> list[list[float]]: ...
    @property
    def principal_moments(self) -> list[float]: ...
    @property
    def principal_axes(self) -> list[float]: ...
    @property
    def rims(self) -> list[list[float]]: ...
    def lowest(self, attitudes: npt.NDArray[np.float64]) -> float: ...
    def farthest(self) -> float: ...
    def supports(self, normals: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...
    def balls(self) -> npt.NDArray[np.float64]: ...

class Material:
    @property
    def beta(self) -> float | None: ...
    def at(self, speeds: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...

class Law:
    def respond(
        self,
        slip: tuple[float, float, float],
        arm: tuple[float, float],
        inertia: float,
        across: float,
    ) -> tuple[tuple[float, float, float], float]: ...

class Mixture:
    def __init__(
        self,
        speeds: npt.NDArray[np.float64],
        first: npt.NDArray[np.int64],
        conditions: npt.NDArray[np.float64],
        start: npt.NDArray[np.int64],
        edges: npt.NDArray[np.float64],
        cumulative: npt.NDArray[np.float64],
    ) -> None: ...
    def value(
        self,
        what: str,
        x: npt.NDArray[np.float64],
        v: npt.NDArray[np.float64],
        z: npt.NDArray[np.float64],
        threads: int,
    ) -> tuple[npt.NDArray[np.float64], KeyboardInterrupt | None]: ...
    def draw(
        self,
        v: npt.NDArray[np.float64],
        z: npt.NDArray[np.float64],
        size: int,
        seed: int,
        threads: int,
    ) -> tuple[npt.NDArray[np.float64], KeyboardInterrupt | None]: ...

class Counter:
    def __init__(
        self,
        speeds: npt.NDArray[np.float64],
        first: npt.NDArray[np.int64],
        conditions: npt.NDArray[np.float64],
        start: npt.NDArray[np.int64],
        edges: npt.NDArray[np.float64],
        batches: int,
    ) -> None: ...
    def add(
        self,
        velocity: npt.NDArray[np.float64],
        restitution: npt.NDArray[np.float64],
        condition: npt.NDArray[np.float64] | None,
        first: int,
        threads: int,
    ) -> KeyboardInterrupt | None: ...
    def table(self) -> dict[str, npt.NDArray[np.float64]]: ...

class Levels:
    def __init__(self, nodes: int, batches: int) -> None: ...
    def add(
        self,
        mixture: Mixture,
        point: float,
        velocity: npt.NDArray[np.float64],
        restitution: npt.NDArray[np.float64],
        first: int,
        threads: int,
    ) -> KeyboardInterrupt | None: ...
    def fine(self, interval: int) -> npt.NDArray[np.int64]: ...
    def coarse(self, interval: int) -> npt.NDArray[np.float64]: ...

def body(name: str, given: Sequence[Any]) -> Any: ...
def law(name: str, normal: float | Material, arguments: Sequence[Any]) -> Law: ...
def material(name: str, arguments: Sequence[Any]) -> Material: ...
def turned(
    moments: Sequence[float],
    axes: Sequence[float],
    attitudes: npt.NDArray[np.float64],
    spins: npt.NDArray[np.float64],
    times: npt.NDArray[np.float64],
) -> list[npt.NDArray[np.float64]]: ...
def clears(height: float, lowest: float) -> bool: ...
def faces(name: str, given: Sequence[Any]) -> tuple[list[list[float]], list[list[int]]]: ...
def hull(points: Sequence[Sequence[float]]) -> list[list[int]]: ...
def rough(
    spheres: Sequence[Sequence[float]],
    barrel: bool,
    inertia: Mapping[str, Any],
    asperities: int,
    asperity_radius: float,
    heights: float | tuple[str, list[float]] | npt.NDArray[np.float64] | None,
    seed: int,
) -> Rigid: ...
def scattered(normal: float | Material, deviation: float) -> Material: ...
def custom(function: Callable[..., Any] | Law, name: str, pull: str | None) -> Law: ...
def sincos(x: float) -> tuple[float, float]: ...
def simulate(
    run: Mapping[str, Any],
    threads: int,
    progress: Callable[[int], None] | None,
    part: tuple[int, int] | None = None,
    columns: Sequence[str] | None = None,
) -> tuple[_Table, KeyboardInterrupt | None]: ...
def simulate_series(
    runs: Sequence[tuple[Mapping[str, Any], tuple[int, int]]],
    threads: int,
    columns: Sequence[str],
) -> tuple[_Table, KeyboardInterrupt | None]: ...

GAS_WHOLE: tuple[str, ...]
GAS_KIND: tuple[str, ...]
GAS_BINS: tuple[int, float]

def cool(
    kinds: Sequence[tuple[Solid | Rigid, int, float, tuple[float, float, float], tuple[bool, bool, bool]]],
    law: Law,
    course: Mapping[str, Any],
    threads: int,
    given: npt.NDArray[np.float64] | None,
    progress: Callable[[int], None] | None,
    store: npt.NDArray[np.float64] | None = None,
) -> tuple[
    tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64] | None],
    KeyboardInterrupt | None,
]: ...
def columns(body: Solid | Rigid, law: Law, state: bool = False) -> list[str]: ...
def bytes_per_impact(columns: Sequence[str]) -> int: ...

class Histogram:
    @staticmethod
    def read(run: Mapping[str, Any], edges: _Edges, words: npt.NDArray[np.uint64]) -> Histogram: ...
    def words(self) -> npt.NDArray[np.uint64]: ...
    def merged(self, others: Sequence[Histogram]) -> Histogram: ...
    def table(self) -> dict[str, npt.NDArray[Any]]: ...

def histogram(
    run: Mapping[str, Any],
    edges: _Edges,
    threads: int,
    progress: Callable[[int], None] | None,
    part: tuple[int, int] | None = None,
) -> tuple[Histogram, KeyboardInterrupt | None]: ...
def statistics(
    run: Mapping[str, Any],
    edges: _Edges,
    threads: int,
    progress: Callable[[int], None] | None,
    parts: Sequence[tuple[int, int]],
) -> tuple[dict[str, npt.NDArray[Any]], list[dict[str, npt.NDArray[Any]]], KeyboardInterrupt | None]: ...
def build_info() -> dict[str, Any]: ...
def encounters(
    body: Solid | Rigid,
    other: Solid | Rigid | None,
    law: Law,
    drawn: Mapping[str, Any],
    given: npt.NDArray[np.float64] | None,
    wanted: tuple[bool, bool],
    threads: int,
    progress: Callable[[int], None] | None,
) -> tuple[list[_Table], float, KeyboardInterrupt | None]: ...
