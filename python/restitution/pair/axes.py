"""The axes about which contacts turn a body."""

from restitution.bodies import AnyBody, Body, Dumbbell, LoadedSphere
from restitution.laws import CollisionLaw, Frictionless


def turned_axes(body: AnyBody, law: CollisionLaw) -> tuple[bool, bool, bool]:
    """Return for each principal axis, the last that of a body of revolution, whether contacts turn it.

    Without friction an impulse passes through the axis of a body of revolution, and through the centre of a
    sphere.
    """
    if not isinstance(law, Frictionless) or not isinstance(body, Body):
        return (True, True, True)
    round_body = isinstance(body, Dumbbell) and body.separation == 0.0
    centred = isinstance(body, LoadedSphere) and body.centre_of_mass == 0.0
    across = not (round_body or centred)
    return (across, across, False)
