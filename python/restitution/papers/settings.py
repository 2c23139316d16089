"""Settings of a redrawn paper: every number it depends on, each marked as the paper's or as ours."""

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


@dataclass(frozen=True)
class Settings:
    """Base of a paper's settings: a frozen dataclass of fields that are `stated` or `chosen`."""

    def rows(self) -> Iterator[Setting]:
        """Yield every setting with its unit, source and meaning, in the order of declaration."""
        for item in fields(self):
            about = item.metadata
            yield Setting(item.name, getattr(self, item.name), about["unit"], about["source"], about["text"])
