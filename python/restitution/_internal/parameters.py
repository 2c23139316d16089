"""One validation for the Python call and the TOML file: frozen parameter sets with readable errors."""

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from difflib import get_close_matches
from reprlib import Repr
from typing import Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from pydantic._internal._model_construction import ModelMetaclass
from pydantic_core import PydanticCustomError

from restitution import _core
from restitution._internal import text as _text


class Problem(NamedTuple):
    """Error in one parameter; its name, the text after it and the values allowed make a sentence."""

    name: str
    text: str
    allowed: str = ""

    def __str__(self) -> str:
        return self.name + self.text + self.allowed


class ParameterError(ValueError):
    """Everything that is wrong with a set of parameters, a line for each `Problem`."""

    def __init__(self, *problems: Problem) -> None:
        super().__init__(*problems)
        self.problems = problems

    def __str__(self) -> str:
        return "\n".join(map(str, self.problems))


class TooLargeError(ParameterError, MemoryError):
    """Error for a run that needs more memory than this process can have; a ValueError and a MemoryError."""


def wrong(name: str, value: Any, allowed: str) -> Problem:
    """Say that a value is not one of those that are allowed."""
    return Problem(name, f" = {shown(value)}: must be ", allowed)


@contextmanager
def _reworded(change: Callable[[Problem], Problem]) -> Iterator[None]:
    try:
        yield
    except ParameterError as error:
        raise type(error)(*map(change, error.problems)) from None  # too large stays too large


def renamed(rename: Callable[[str], str]) -> AbstractContextManager[None]:
    """Name wrong parameters as the caller knows them."""
    return _reworded(lambda one: one._replace(name=rename(one.name)))


def in_terms_of(**given: Any) -> AbstractContextManager[None]:
    """Name the arguments from which a wrong value follows."""
    first, *others = (f"{name} = {shown(value)}" for name, value in given.items())
    name, _, value = first.partition(" = ")
    words = ", ".join([value, *others])
    return _reworded(lambda one: Problem(name, f" = {words}: gives {one}"))


def unknown(name: str, taker: str, allowed: Iterable[str], prefix: str = "") -> Problem:
    """Say that `taker` knows no such name, which it does know, and which was meant."""
    names = list(allowed)
    meant = "".join(f"did you mean {prefix}{close}? " for close in get_close_matches(name, names, n=1))
    return Problem(prefix + name, f": unknown; {meant}{taker} takes {', '.join(names)}")


_SHORT = Repr()
_SHORT.maxstring = _SHORT.maxother = 72


def shown(value: Any) -> str:
    """Write a value in at most a line, however large it is."""
    value = plain_number(value)
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"an array of shape {value.shape}"
    return " ".join(_SHORT.repr(value).split())


def plain_number(value: Any) -> Any:
    """Make a Python number of a NumPy scalar or 0-d array; what is masked, or a date, stays what it is."""
    if not isinstance(value, np.generic | np.ndarray) or value.ndim != 0 or np.ma.is_masked(value):
        return value
    if value.dtype.kind != "f":
        return value.item() if value.dtype.kind in "biu" else value
    number = float(value)
    return value if math.isinf(number) and np.isfinite(value) else number  # of extended precision


def _number_itself(value: Any) -> int | float:
    """Refuse what is made a number of: pydantic would take dates, masked and complex values."""
    value = plain_number(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PydanticCustomError("no_number", "no number")
    return value


Number = Annotated[float, BeforeValidator(_number_itself), Field(strict=True, allow_inf_nan=False)]
Whole = Annotated[int, BeforeValidator(_number_itself), Field(strict=True)]


class Allowed(NamedTuple):
    """In an annotation: says in words what a field may hold."""

    text: str


class _Shown(ModelMetaclass):
    """Classes of which `help`, `dir` and completion show what is their own, and nothing of pydantic."""

    def __dir__(cls) -> list[str]:
        hidden = {*dir(BaseModel), "by_place", "compiled", "entry", "example"}
        return [name for name in type.__dir__(cls) if name[0] != "_" and name not in hidden]


class Parameters(BaseModel, metaclass=_Shown):
    """A frozen set of named parameters.

    A ValueError names each argument that is wrong, its value, and what is allowed; a TypeError says that they
    are given by name, but for those in `by_place`.
    """

    by_place: ClassVar[tuple[str, ...]] = ()  # where the order is plain

    model_config: ClassVar[ConfigDict] = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)

    def __init__(self, *values: Any, **named: Any) -> None:
        """Check the parameters, and keep them for good."""
        if values:
            placed = dict(zip(self.by_place, values, strict=False))
            if len(values) > len(placed) or placed.keys() & named:
                kind, names = type(self).__name__, "=..., ".join(type(self).model_fields)
                raise TypeError(f"{kind}: parameters are given by name, as in {kind}({names}=...)")
            named |= placed
        try:
            super().__init__(**named)
            return
        except ValidationError as error:
            problems = tuple(_problems(type(self), error))
        # Outside of the clause: pydantic's error, which some versions cannot unpickle, is not its context.
        raise ParameterError(*problems)

    # What is worked out from the fields, compiled objects among it, is neither copied nor pickled.

    def _fields(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name in type(self).model_fields}

    def __getstate__(self) -> dict[Any, Any]:
        return super().__getstate__() | {"__dict__": self._fields()}

    def __setstate__(self, state: dict[Any, Any]) -> None:
        """Check what a pickle holds: it may be of another version, which had other fields or other bounds."""
        super().__setstate__(type(self)(**state["__dict__"]).__getstate__())

    def __copy__(self) -> Self:
        copied = type(self).__new__(type(self))
        super(Parameters, copied).__setstate__(self.__getstate__())
        return copied

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        return self.__copy__()  # nothing in it can change

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        cls.__signature__ = _text.signature(cls, cls.by_place)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{name}: {self!r} cannot be changed; make another")

    def __dir__(self) -> list[str]:
        return sorted({*dir(type(self)), *type(self).model_fields})

    def __str__(self) -> str:
        fields = (f"{name}={_text.short(value)}" for name, value in self._given().items())
        return f"{type(self).__name__}({', '.join(fields)})"

    def __repr_args__(self) -> list[tuple[str | None, Any]]:
        return [(name, value) for name, value in super().__repr_args__() if value is not None]

    def _repr_html_(self) -> str:
        return _text.table(type(self).__name__, self._rows())

    def _given(self) -> dict[str, Any]:
        """Return the fields that are not left out."""
        every = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in every.items() if value is not None}

    def _rows(self) -> Iterator[tuple[str, str]]:
        """Yield the names and values that a notebook shows."""
        for name, value in self._given().items():
            if isinstance(value, Parameters):
                yield name, type(value).__name__
                for key, text in value._rows():
                    yield f"{name}.{key}", text
            else:
                yield name, _text.value(value, type(self).model_fields[name].description)


def _problems(model: type[BaseModel], error: ValidationError) -> Iterator[Problem]:
    for problem in error.errors(include_url=False):
        name = ".".join(str(part) for part in problem["loc"])
        match problem["type"]:
            case "missing":
                yield Problem(name, ": missing; must be ", _allowed(model, name))
            case "extra_forbidden":
                yield unknown(name, model.__name__, model.model_fields)
            case "value_error" if isinstance(cause := problem["ctx"]["error"], ParameterError):
                yield from cause.problems
            case "value_error" if isinstance(cause, _core.ParameterError):
                yield wrong(cause.name, cause.value, cause.allowed)
            case _:  # also an error of the object that was given
                yield wrong(name, problem["input"], _allowed(model, name))


def _allowed(model: type[BaseModel], name: str) -> str:
    """Say in words what the field of a model may hold; every number here is bounded from below."""
    field = model.model_fields[name]
    words = ("text", "gt", "ge", "lt", "le")
    rules = {key: getattr(one, key) for one in field.metadata for key in words if hasattr(one, key)}
    if "text" in rules:
        return str(rules["text"])
    about = f" ({field.description})" if field.description else ""
    if field.annotation not in (int, float):
        return f"a {getattr(field.annotation, '__name__', field.annotation)}{about}"
    low, high = (_bound(rules.get(f"{side}e", rules.get(f"{side}t"))) for side in "gl")
    kind = "whole" if field.annotation is int else "real" if high else "finite"
    if high:
        left, right = "[" if "ge" in rules else "(", "]" if "le" in rules else ")"
        return f"a {kind} number in {left}{low}, {high}{right}{about}"
    return f"a {kind} number {'>=' if 'ge' in rules else '>'} {low}{about}"


def _bound(value: float | None) -> str:
    """Write large powers of two as such, and a right angle."""
    if value is None or value == math.pi / 2:
        return "" if value is None else "π/2"
    power = int(value).bit_length() - 1
    return f"2**{power}" if power >= 20 and value == 2**power else f"{value}"
