"""Values measured once in a series: g, the drop, the terminal velocity, the contact time, and the clock."""

from typing import Annotated, TypeVar

import xarray as xr
from pydantic import Field

from restitution._internal.parameters import Allowed, Number, Parameters, renamed
from restitution.experiment.flight.contact import ContactTime
from restitution.experiment.flight.drag import Drag
from restitution.experiment.flight.times import LARGEST, LEAST

_EARTH = 3e-3
"""Standard error of g over g where it is not given: on the surface of the Earth 9.78 to 9.83 m/s²."""
QUARTZ = 1e-4
"""Relative standard error of a clock: telephones and sound cards keep to 100 parts in a million."""
_ERROR_OR_NONE = Allowed("a finite number in [0, 1e30] (m/s²), or None")
_HEIGHT_OR_NONE = Allowed("a real number in [1e-30, 1e+30] (m), or None")
Length = Annotated[Number | None, Field(ge=0, description="m"), Allowed("a finite number >= 0 (m), or None")]
"""Out-of-roundness or roughness of a ball; None where it was not measured."""
T = TypeVar("T", bound=Parameters)


class Gravity(Parameters):
    """g, and the standard errors of g and, over what it shows, of the clock."""

    gravity: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m/s²")] = 9.81
    gravity_uncertainty: Annotated[Number | None, Field(ge=0, le=LARGEST), _ERROR_OR_NONE] = None
    clock_uncertainty: Annotated[Number, Field(ge=0, lt=1)] = QUARTZ

    @property
    def gravity_error(self) -> float:
        """Standard error of g in m/s², that of a g that was not measured where it is not given."""
        given = self.gravity_uncertainty
        return _EARTH * self.gravity if given is None else given


class Once(Gravity):
    """These, and the distance that the ball fell from rest to the first impact, with its standard error."""

    drop_height: Annotated[Number | None, Field(ge=LEAST, le=LARGEST), _HEIGHT_OR_NONE] = None
    drop_height_uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="m")] = 0.0


_ATTRIBUTES: dict[type[Parameters], dict[str, str]] = {
    Drag: {"terminal_velocity": "terminal_velocity", "uncertainty": "terminal_velocity_uncertainty"},
    ContactTime: {"at_1_m_s": "contact_time", "uncertainty": "contact_time_uncertainty"},
}
"""Of a Dataset: by field, what says in it what drag and contact were."""


def attributes(*given: Drag | ContactTime | None) -> dict[str, float]:
    """Return the attributes of a Dataset that say what drag and contact were, for those that are given."""
    return {
        name: getattr(one, field)
        for one in given
        if one is not None
        for field, name in _ATTRIBUTES[type(one)].items()
    }


def setting_of(name: str, data: xr.Dataset) -> tuple[Once, Drag | None, ContactTime | None]:
    """Read the attributes of a Dataset that `flight.restitution` returned; errors that are not there are 0.

    Raises
    ------
    ParameterError
        If one is missing, or is not as `flight.restitution` takes it.
    """

    def read(kind: type[T]) -> T | None:
        """Make what has these attributes, by the names of its fields; None where there are none."""
        own = _ATTRIBUTES[kind]
        given = {field: data.attrs[each] for field, each in own.items() if each in data.attrs}
        with renamed(lambda field: f"{name}.{own.get(field, field)}"):
            return kind(**given) if given else None

    none = {"gravity_uncertainty": 0.0, "clock_uncertainty": 0.0}
    with renamed(lambda field: f"{name}.{field}"):
        once = Once(**none | {each: data.attrs[each] for each in Once.model_fields if each in data.attrs})
    return once, read(Drag), read(ContactTime)
