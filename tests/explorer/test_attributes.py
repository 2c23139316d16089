"""A run is made again from the attributes of its Dataset; one that is wrong is named as what it is."""

from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution import explorer

RUN = rs.simulate(
    rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9), particles=3, impacts=4
)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("particles", None),
        ("particles", 2.5),
        ("impacts", np.ma.masked),
        ("seed", -1),
        ("spin", 1.0),
        ("release_velocity", "up"),
        ("radius", -1.0),
        ("normal", 2.0),
    ],
)
def test_a_wrong_attribute(name: str, value: Any) -> None:
    """No number was rounded, and none taken from a mask: the page would show another run."""
    pytest.importorskip("anywidget")
    with pytest.raises(ValueError, match=rf"^data\.{name} = .*: must be "):
        explorer.explore(RUN.assign_attrs({name: value}))
