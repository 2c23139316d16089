"""Given states of bodies, as an encounter or a gas begins with."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, check_each, reals
from restitution._internal.parameters import ParameterError, Problem, wrong


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
