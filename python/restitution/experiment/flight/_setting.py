"""Values that are measured once in a series: g, the drop, the terminal velocity, the contact time."""

from typing import Annotated, NamedTuple

import xarray as xr
from pydantic import Field

from restitution._internal.parameters import Number, Parameters, renamed
from restitution.experiment.flight.contact import ContactTime
from restitution.experiment.flight.drag import Drag
from restitution.experiment.flight.times import LARGEST, LEAST


class Errors(Parameters):
    """g, and the standard errors of g and of the height of the drop."""

    gravity: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m/s²")]
    gravity_uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="m/s²")] = 0.0
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
        given = Errors(**{each: attrs[each] for each in Errors.model_fields if each in attrs})
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
    return Setting((given.gravity, given.gravity_uncertainty), drop, drag, contact)
