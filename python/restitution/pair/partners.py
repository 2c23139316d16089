"""The material, the axes and the states of bodies that meet, in encounters and in gases."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, check_each, reals
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.bodies import AnyBody, Body, Dumbbell, LoadedSphere
from restitution.laws import CollisionLaw, Frictionless, Law, Viscoelastic


def between(law: CollisionLaw, mass_ratio: float = 1.0) -> CollisionLaw:
    """Return the law of two spheres of a material, instead of one sphere and a rigid plane.

    Hertz' ρ/m is (4/3)√R Y/((1 - ν²) m) of the sphere on the plane, and half of it with R_eff and m_eff of
    two spheres, the second `mass_ratio`^(1/3) times as large as the first. β ∝ A(ρ/m)^(2/5).
    """
    if not isinstance(law, Law) or not isinstance(law.normal, Viscoelastic):
        return law
    own = law.normal.model_dump()
    size = mass_ratio ** (1.0 / 3.0)
    softer = 0.5 * (size / (1.0 + size)) ** 0.5 * (1.0 + mass_ratio) / mass_ratio
    normal = Viscoelastic(**own | {"dissipation": own["dissipation"] * softer**0.4})
    return law.model_copy(update={"normal": normal})


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


def read_states(what: str, states: Any, parts: Mapping[str, int], **sizes: int | None) -> list[FloatArray]:
    """Take these variables of states, the last a unit quaternion, over dimensions of these sizes."""
    if not isinstance(states, xr.Dataset):
        raise ParameterError(wrong(what, states, "a Dataset of " + ", ".join(parts)))
    columns = []
    for name, count in parts.items():
        if name not in states:
            raise ParameterError(Problem(what, f" lacks {name}: must have {', '.join(parts)}"))
        needed = (*sizes, "component" if count == 3 else "quaternion")
        if set(states[name].dims) != set(needed):
            text = f" has dimensions {states[name].dims}: must be ({', '.join(needed)})"
            raise ParameterError(Problem(f"{what}.{name}", text))
        values = states[name].transpose(*needed).to_numpy()
        shape = (*sizes.values(), count)
        if values.size == 0 or any(b not in (None, a) for a, b in zip(values.shape, shape, strict=True)):
            text = ", ".join(f"{dim}s" if b is None else str(b) for dim, b in zip(needed, shape, strict=True))
            problem = f" has the shape {values.shape}: must be ({text})"
            raise ParameterError(Problem(f"{what}.{name}", problem))
        columns.append(reals(f"{what}.{name}", values, "finite numbers"))
    lengths = np.linalg.norm(columns[-1], axis=-1)
    check_each(f"{what}.attitude", lengths, np.abs(lengths - 1.0) < 1e-9, "unit quaternions, of length 1")
    columns[-1] = columns[-1] / lengths[..., np.newaxis]
    return columns
