"""A law of one's own: a Python function in place of a law of the core."""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, StringConstraints, ValidationInfo, field_validator

from restitution import _core
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.laws._laws import CollisionLaw, Law, check_steady

_FUNCTION = "a function of K and the velocity of the contact, which returns the impulse, or a law"
_NAME = "a str, not empty"
_PULL = "'stop', 'clip' or None"


class CustomLaw(CollisionLaw):
    """A law of one's own: a function that gives the impulse of a contact, or a law with a rule for pulling.

    It is called for one contact at a time, by any thread, with arrays of its own. The run is followed in
    space, also where the release is at rest, for the function may distinguish directions in the plane. An
    exception of the function ends the run; so does, as a ValueError that names particle and seed, an impulse
    that is not three finite numbers, or after which the contact still approaches the plane. What is written
    to a file names the law, but does not hold it: files of runs and studies, and the explorer, refuse it.

    An impulse may pull, P_z < 0. That of any law then acts as it is; `simulate` counts such impacts in the
    attribute ``pulling_impacts`` and warns of them (PullWarning). ``pull`` is another rule, also for a law of
    the package.

    Parameters
    ----------
    function : callable or law
        A law whose coefficient does not scatter, or ``function(K, velocity)`` with the velocity (3,) of the
        contact point in m/s, ``velocity[2] <= 0``, and the matrix K (3, 3) in 1/kg that turns an impulse into
        the change of that velocity. It returns the impulse (3,) on the body in N s. Components are along x,
        down the slope, y and z, the plane normal. The velocity afterwards is ``velocity + K @ impulse``.
    name : str, optional
        Its name in results and errors; that of the function if not given.
    pull : {"stop", "clip"}, optional
        Of an impulse that pulls: "stop" ends the run by a ValueError that names particle and seed, "clip"
        leaves P_z out, so that the contact leaves the plane faster than the law says.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> def sticking(K, velocity):
    ...     return np.linalg.solve(K, [-velocity[0], -velocity[1], -1.9 * velocity[2]])
    >>> law = rs.CustomLaw(sticking)
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> data = rs.simulate(body, law, particles=3, impacts=4)
    >>> same = rs.simulate(body, rs.TangentialRestitution(normal=0.9, tangential=0.0), particles=3, impacts=4)
    >>> bool(np.allclose(data.restitution, same.restitution))
    True
    """

    by_place: ClassVar[tuple[str, ...]] = ("function",)

    function: Annotated[Any, Field(repr=False), Allowed(_FUNCTION)]
    name: Annotated[str, StringConstraints(strict=True, min_length=1), Allowed(_NAME)] = Field(
        default="", validate_default=True
    )
    pull: Annotated[Literal["stop", "clip"] | None, Allowed(_PULL)] = None

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(
            self,
            function: Callable[..., Any] | Law,
            *,
            name: str = "",
            pull: Literal["stop", "clip"] | None = None,
        ) -> None: ...

    @field_validator("function", mode="before")
    @classmethod
    def _steady(cls, function: Any) -> Any:
        if isinstance(function, Law):
            check_steady(function)
        elif not callable(function):
            raise ParameterError(wrong("function", function, _FUNCTION))
        return function

    @field_validator("name", mode="before")
    @classmethod
    def _of_the_function(cls, name: Any, about: ValidationInfo) -> Any:
        function = about.data.get("function")
        return name or getattr(function, "__name__", type(function).__name__)

    @cached_property
    def compiled(self) -> _core.Law:
        """The law as the core knows it."""
        law = self.function.compiled if isinstance(self.function, Law) else self.function
        return _core.custom(law, self.name, self.pull)

    def attributes(self) -> dict[str, Any]:
        """Return what a result says of the law besides its kind, as plain values."""
        rule = {} if self.pull is None else {"pull": self.pull}
        own = self.function.attributes() if isinstance(self.function, Law) else {}
        return {"law_name": self.name, **own, **rule}
