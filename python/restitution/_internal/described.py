"""Parameters of what the core makes: the bodies, laws and materials of its tables."""

import re
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Self

from pydantic import model_validator

from restitution import _core
from restitution._internal.parameters import ParameterError, Parameters, Problem, shown

_TABLE = {entry["name"]: entry for table in (_core.BODIES, _core.LAWS, _core.MATERIALS) for entry in table}


def one_of(table: Sequence[Mapping[str, Any]]) -> str:
    """Name the entries of a table in words."""
    *others, last = (entry["name"] for entry in table)
    return f"a {', '.join(others)} or {last}"


def kebab(name: str) -> str:
    """Write a name as files and links do: `tangential-restitution` for TangentialRestitution."""
    return re.sub(r"(?<!^)(?=[A-Z])", "-", name).lower()


class Described(Parameters):
    """A body, a law or a material, under the name and with the parameters that the core describes."""

    @cached_property
    @abstractmethod
    def compiled(self) -> Any:
        """Make it as the core knows it, checked, once."""

    @classmethod
    def entry(cls) -> Mapping[str, Any]:
        """Return what the core says of it; nothing of one that the core does not know."""
        return _TABLE.get(cls.__name__, {})

    @classmethod
    def example(cls, **others: Any) -> Self:
        """Make one with the usual values of the core's table, and without what is usually left out."""
        given = (about for about in cls.entry()["parameters"] if about.get("default", 0.0) is not None)
        return cls(**{about["name"]: about["example"] for about in given} | others)

    def _arguments(self) -> list[Any]:
        """Return all parameters in the order in which the core takes them."""
        return [getattr(self, about["name"]) for about in self.entry()["parameters"]]

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        try:
            _ = self.compiled
        except _core.ParameterError as error:
            # Of which values it depends: of all if a number overflows, else of those that the text names.
            among = [name for name in self._given() if name != error.name]
            if not isinstance(error, _core.MagnitudeError):
                among = [name for name in among if re.search(rf"\b{name}\b", error.allowed)]
            values = "".join(f", {name} = {shown(getattr(self, name))}" for name in among)
            text = f" = {shown(getattr(self, error.name, error.value))}{values}: must be "
            raise ParameterError(Problem(error.name, text, error.allowed)) from None
        return self
