"""The knowledge of an experiment besides its recording."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from restitution import flight
from restitution._internal.parameters import Allowed, Number, ParameterError, wrong
from restitution.bodies import Wall, from_roundness
from restitution.experiment.flight.setting import Gravity, Length

_HEAVIEST = 23_000.0
"""In kg/m³: no matter is denser, so that a mass beyond it was in g."""
_LARGEST = 1.0
"""Diameter in m of balls that are bounced; beyond it was in mm."""
_OR_NONE = Allowed("a finite number > 0 (SI units), or None")
_CONTACT_OR_NONE = Allowed("a finite number >= 0 (s), or None")
_TIME_OR_NONE = Allowed("a finite number > 0 (s), or None")


class Setting(Gravity):
    """Knowledge of the experiment besides the recording.

    Parameters
    ----------
    diameter : float
        Of the ball, in m.
    mass : float, optional
        In kg; then air drag is taken into account.
    drop, drop_uncertainty : float, optional
        Height of the fall before the first impact heard, and its standard error, in m.
    time_uncertainty : float, optional
        Standard error of the times of a table that does not give it, in s.
    gravity, gravity_uncertainty : float
        g and its standard error, in m/s²; left out 3e-3 of g, which covers the surface of the Earth, 9.78 to
        9.83.
    clock_uncertainty : float
        Standard error of the clock over what it shows.
    out_of_roundness, roughness : float, optional
        Of the ball, the second as Ra, in m, where they were measured.
    wall : float, optional
        Thickness of the wall of a hollow ball, in m.
    contact_time, contact_uncertainty : float, optional
        How long ball and plate touch at 1 m/s, and its standard error, in s. Left out, it may be anything up
        to what it is for hard plastics.
    doubtful : bool
        Whether impacts that are in doubt count.
    """

    diameter: Annotated[Number, Field(gt=0, description="m")]
    mass: Annotated[Number | None, Field(gt=0, description="kg"), _OR_NONE] = None
    drop: Annotated[Number | None, Field(gt=0, description="m"), _OR_NONE] = None
    drop_uncertainty: Annotated[Number, Field(ge=0, description="m")] = 0.0
    time_uncertainty: Annotated[Number | None, Field(gt=0, description="s"), _TIME_OR_NONE] = None
    out_of_roundness: Length = None
    roughness: Length = None
    wall: Wall = None
    contact_time: Annotated[Number | None, Field(ge=0, description="s"), _CONTACT_OR_NONE] = None
    contact_uncertainty: Annotated[Number, Field(ge=0, description="s")] = 0.0
    doubtful: bool = False

    @model_validator(mode="after")
    def _plausible(self) -> Self:
        if self.diameter >= _LARGEST:
            asked = f"in m, below {_LARGEST:g}; {self.diameter:g} mm are {1e-3 * self.diameter:g}"
            raise ParameterError(wrong("diameter", self.diameter, asked))
        if self.mass is not None:
            density = self.mass / from_roundness(self.diameter, 0.0, density=1.0).mass
            if density > _HEAVIEST:
                asked = (
                    f"in kg, of a density up to {_HEAVIEST:g} kg/m³; {self.mass:g} g are {1e-3 * self.mass:g}"
                )
                raise ParameterError(wrong("mass", self.mass, asked))
        if self.out_of_roundness is not None or self.wall is not None:
            from_roundness(self.diameter, self.out_of_roundness or 0.0, wall=self.wall)
        return self

    @property
    def contact(self) -> flight.ContactTime:
        """Time of contact, with a standard error; of what it may be where it is not known."""
        if self.contact_time is None:
            return flight.ContactTime.possible(diameter=self.diameter, mass=self.mass, wall=self.wall)
        return flight.ContactTime(at_1_m_s=self.contact_time, uncertainty=self.contact_uncertainty)

    @property
    def drag(self) -> flight.Drag | None:
        """Air drag of a sphere, where the mass is known."""
        if self.mass is None:
            return None
        return flight.Drag.of_sphere(diameter=self.diameter, mass=self.mass, gravity=self.gravity)


def checked(setting: object) -> None:
    """Refuse what is no setting."""
    if not isinstance(setting, Setting):
        raise ParameterError(wrong("setting", setting, "a Setting"))
