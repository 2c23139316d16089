"""One validation for the Python call and the TOML file: frozen parameter sets with readable errors."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError


def _plain_number(value: Any) -> Any:
    """NumPy scalars and 0-d arrays become Python numbers; a bool is not a number here."""
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if isinstance(value, bool):
        raise ValueError("a number is needed, not a truth value")
    return value


Number = Annotated[float, BeforeValidator(_plain_number), Field(strict=True, allow_inf_nan=False)]
Whole = Annotated[int, BeforeValidator(_plain_number), Field(strict=True)]


class Parameters(BaseModel):
    """A frozen set of named parameters.

    Raises
    ------
    ValueError
        Naming each argument that is wrong, its value, and what is allowed.
    """

    model_config: ClassVar[ConfigDict] = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)

    def __init__(self, **values: Any) -> None:
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise ValueError("\n".join(_readable(type(self), error))) from None


def _readable(model: type[BaseModel], error: ValidationError) -> Iterator[str]:
    for problem in error.errors(include_url=False):
        name = ".".join(str(part) for part in problem["loc"]) or model.__name__
        given = problem["input"]
        match problem["type"]:
            case "missing":
                yield f"{name}: missing; {model.__name__} needs it"
            case "extra_forbidden" | "unexpected_keyword_argument":
                yield f"{name}: unknown; {model.__name__} takes {', '.join(model.model_fields)}"
            case "value_error":
                text = str(problem["ctx"]["error"])
                yield text if name == model.__name__ else f"{name} = {given!r}: {text}"
            case _:
                yield f"{name} = {given!r}: {_lower_first(problem['msg'])}{_unit(model, problem['loc'])}"


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:].replace("Input should", "input should")


def _unit(model: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    field = model.model_fields.get(str(loc[0])) if loc else None
    return f" ({field.description})" if field is not None and field.description else ""
