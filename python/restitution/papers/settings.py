"""Settings of a redrawn paper: every number it depends on, each marked as the paper's or as ours."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple


def stated(value: Any, unit: str, text: str) -> Any:
    """Declare a setting that the paper states."""
    return field(default=value, metadata={"source": "paper", "unit": unit, "text": text})


def chosen(value: Any, unit: str, text: str) -> Any:
    """Declare a setting that we chose, the paper being silent."""
    return field(default=value, metadata={"source": "ours", "unit": unit, "text": text})


class Setting(NamedTuple):
    """One row of the table of settings: ``source`` is "paper" or "ours"."""

    name: str
    value: Any
    unit: str
    source: str
    text: str


class AtSpeeds(ABC):
    """Bins that follow from the speeds at which densities are shown."""

    speed_tolerance: float
    """Half-width of the windows, as a share of the speed."""

    @property
    @abstractmethod
    def speeds(self) -> tuple[float, ...]:
        """The speeds in m/s, in increasing order."""

    @property
    def speed_windows(self) -> tuple[tuple[float, float], ...]:
        """The half-open window of impact velocity [lo, hi) in m/s that stands for each of `speeds`."""
        return tuple((v * (1 - self.speed_tolerance), v * (1 + self.speed_tolerance)) for v in self.speeds)

    @property
    def labels(self) -> list[str]:
        """The speeds as text."""
        return [f"{v:g} m/s" for v in self.speeds]


@dataclass(frozen=True)
class Settings:
    """Base of a paper's settings: a frozen dataclass of fields that are `stated` or `chosen`."""

    def rows(self) -> Iterator[Setting]:
        """Yield every setting with its unit, source and meaning, in the order of declaration."""
        for item in fields(self):
            about = item.metadata
            yield Setting(item.name, getattr(self, item.name), about["unit"], about["source"], about["text"])
