"""Whether the arrays of a store are those of its study: nothing can be read from others."""

from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from restitution.study._identity import readable
from restitution.study._study import Study


def check_layout(path: Path, group: Any, study: Study, width: int) -> None:
    """Refuse a store whose tasks, marks or axes have another shape or type than those of the study.

    Parameters
    ----------
    path, group : Path, zarr.Group
        The store.
    study : Study
        The study.
    width : int
        Words of a batch, with its digest.
    """
    effort, design = study.effort, study.design
    wanted = {
        "tasks/words": ((design.points, effort.blocks * effort.batches, width), np.uint64),
        "status": (design.shape, np.uint8),
        **{axis.name: ((len(axis.values),), np.float64) for axis in design.axes},
    }
    with readable(path):
        for name, (shape, kind) in wanted.items():
            check_array(group, name, shape, kind, "equiv")
        chunks = group["tasks/words"].chunks
        if chunks != (1, effort.task_batches, width):
            raise ValueError(f"the chunks of tasks/words are {chunks}")


def check_array(
    group: Any,
    name: str,
    shape: tuple[int, ...],
    kind: npt.DTypeLike,
    casting: Literal["equiv", "same_kind"],
) -> None:
    """Raise a ValueError for an array that has another shape, or does not take numbers of a kind."""
    array = group[name]
    if array.shape != shape or not np.can_cast(kind, array.dtype, casting):
        about = f"{array.dtype} of shape {array.shape} instead of {np.dtype(kind)} of shape {shape}"
        raise ValueError(f"{name} is {about}")
