"""Values measured once in a series: g, the drop, the terminal velocity, the contact time, and the clock."""

from typing import Annotated, NamedTuple

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


class Errors(Gravity):
    """These, and the standard error of the height of the drop."""

    drop_height_uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="m")] = 0.0


class Drop(Parameters):
    """Give the distance that the ball fell from rest to the first impact."""

    drop_height: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m")]


class Setting(NamedTuple):
    """Numbers with their standard errors, and the drag; None of what was not measured."""

    gravity: tuple[float, float]
    drop: tuple[float, float] | None
    drag: Drag | None
    contact: ContactTime | None
    clock: float


def setting_of(name: str, data: xr.Dataset) -> Setting:
    """Read the attributes of a Dataset that `flight.restitution` returned; errors that are not there are 0.

    Raises
    ------
    ParameterError
        If one is missing, or is not as `flight.restitution` takes it.
    """
    attrs = data.attrs
    falls = "drop_height" in attrs or "drop_height_uncertainty" in attrs
    drags = "terminal_velocity" in attrs or "terminal_velocity_uncertainty" in attrs
    attributes = {"uncertainty": "terminal_velocity_uncertainty"}
    with renamed(lambda each: f"{name}.{attributes.get(each, each)}"):
        none = {"gravity_uncertainty": 0.0, "clock_uncertainty": 0.0}
        given = Errors(**none | {each: attrs[each] for each in Errors.model_fields if each in attrs})
        drop = None
        if falls:
            height = Drop(**{each: attrs[each] for each in Drop.model_fields if each in attrs})
            drop = (height.drop_height, given.drop_height_uncertainty)
        drag = None
        if drags:
            drag = Drag(
                terminal_velocity=attrs.get("terminal_velocity"),
                uncertainty=attrs.get("terminal_velocity_uncertainty", 0.0),
            )
    contact = None
    if "contact_time" in attrs or "contact_time_uncertainty" in attrs:
        named = {"at_1_m_s": "contact_time", "uncertainty": "contact_time_uncertainty"}
        with renamed(lambda each: f"{name}.{named.get(each, each)}"):
            contact = ContactTime(
                at_1_m_s=attrs.get("contact_time"), uncertainty=attrs.get("contact_time_uncertainty", 0.0)
            )
    return Setting((given.gravity, given.gravity_error), drop, drag, contact, given.clock_uncertainty)
