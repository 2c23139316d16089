"""A law of one's own: a Python function in place of a law of the core."""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field, StringConstraints, ValidationInfo, field_validator

from restitution import _core
from restitution._internal.parameters import Allowed
from restitution.laws._law import CollisionLaw

_FUNCTION = "a function of K and the velocity of the contact, which returns the impulse"
_NAME = "a str, not empty"


class CustomLaw(CollisionLaw):
    """A law of one's own: a function that gives the impulse of a contact.

    It is called for one contact at a time, by any thread, with arrays of its own. The run is followed in
    space, also where the release is at rest, for the function may distinguish directions in the plane. An
    exception of the function ends the run; so does, as a ValueError that names particle and seed, an impulse
    that is not three finite numbers, that pulls (P_z < 0), or after which the contact still approaches the
    plane. What is written to a file names the law, but does not hold it: files of runs and studies, and the
    explorer, refuse it.

    Parameters
    ----------
    function : callable
        ``function(K, velocity)`` with the velocity (3,) of the contact point in m/s, ``velocity[2] <= 0``,
        and the matrix K (3, 3) in 1/kg that turns an impulse into the change of that velocity. It returns
        the impulse (3,) on the body in N s. Components are along x, down the slope, y and z, the plane
        normal. The velocity afterwards is ``velocity + K @ impulse``.
    name : str, optional
        Its name in results and errors; that of the function if not given.

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

    function: Annotated[Callable[..., Any], Field(repr=False), Allowed(_FUNCTION)]
    name: Annotated[str, StringConstraints(strict=True, min_length=1), Allowed(_NAME)] = Field(
        default="", validate_default=True
    )

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(self, function: Callable[..., Any], *, name: str = "") -> None: ...

    @field_validator("name", mode="before")
    @classmethod
    def _of_the_function(cls, name: Any, about: ValidationInfo) -> Any:
        function = about.data.get("function")
        return name or getattr(function, "__name__", type(function).__name__)

    @cached_property
    def compiled(self) -> _core.Law:
        """The law as the core knows it."""
        return _core.custom(self.function, self.name)

    def attributes(self) -> dict[str, Any]:
        """Return what a result says of the law besides its kind, as plain values."""
        return {"law_name": self.name}
