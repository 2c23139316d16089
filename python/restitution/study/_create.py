"""A new store of a study: its axes, the marks of its points and room for its tasks, in place in one step."""

import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np

from restitution._internal.files import draft_of
from restitution._internal.parameters import unit_of
from restitution._internal.process import undisturbed
from restitution.drop.dataset import version_here
from restitution.study._identity import attribute, check, threads_for
from restitution.study._layout import check_layout
from restitution.study._store import DIGEST, Store, fast
from restitution.study._study import Study


def create_or_open(path: Path, study: Study, words: int) -> tuple[Store, bool]:
    """Open the store of a study, or create it; return whether it existed.

    Raises
    ------
    Refused
        If what is there is another study, another version of the physics, or no store; it says what differs.
    """
    made = False
    if not path.exists():
        # Zarr writes on a thread of its own, which goes on where a signal has ended this one.
        with undisturbed():
            made = _make(path, study, words)
    check(path, study)
    store = Store(path, study.digest)
    check_layout(store.path, store.group, study, words + DIGEST)
    return store, not made


def _make(path: Path, study: Study, words: int) -> bool:
    """Put a new store in its place, unless another has taken it meanwhile."""
    target = Path(os.path.realpath(path))
    draft = draft_of(target)
    try:
        draft.mkdir(parents=True)
        with threads_for(path):
            _create(draft, study, words)
            os.rename(draft, target)
    except OSError as error:
        if not path.exists():
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        return False
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return True


def _create(path: Path, study: Study, words: int) -> None:
    import zarr

    effort, design = study.effort, study.design
    about = {
        "title": "Parameter study of the coefficient of restitution of bouncing aspherical bodies",
        "Conventions": "CF-1.11",
        "source": f"restitution {version_here()}",
        "references": "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)",
        **attribute(study),
    }
    group = zarr.create_group(str(path), zarr_format=3, attributes=about)
    for axis in design.axes:
        values = np.array(axis.values, dtype=np.float64)
        dims = (axis.name,) if design.kind == "grid" else ("point",)
        array = group.create_array(
            axis.name,
            shape=values.shape,
            chunks=values.shape,
            dtype=values.dtype,
            dimension_names=dims,
            attributes={"long_name": axis.parameter, "units": _unit(study, axis.parameter)},
            fill_value=np.nan,
        )
        array[...] = values
    group.create_array(
        "status",
        shape=design.shape,
        chunks=design.shape,
        dtype=np.uint8,
        dimension_names=design.dims,
        attributes={
            "long_name": "state of the point",
            "flag_values": [0, 1],
            "flag_meanings": "unfinished finished",
        },
        fill_value=0,
    )[...] = 0
    batches = effort.blocks * effort.batches
    group.create_group("tasks").create_array(
        "words",
        shape=(design.points, batches, words + DIGEST),
        chunks=(1, effort.task_batches, words + DIGEST),
        dtype=np.uint64,
        dimension_names=("point", "batch", "word"),
        compressors=fast(8),
        attributes={"long_name": "what each batch of particles counted, and its digest"},
        fill_value=0,
    )
    Store(path, study.digest).consolidate()


def _unit(study: Study, parameter: str) -> str:
    """Give the unit of a parameter, as its description has it."""
    target: Any = study.base
    *parts, last = parameter.split(".")
    for part in parts:
        target = target if part == "run" else getattr(target, part)
    return unit_of(type(target), last)
