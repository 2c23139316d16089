"""Colours that stay apart for everybody, by a simulation of colour vision without one kind of cone."""

from itertools import combinations
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from restitution.figures import COLORMAP, COLORS
from restitution.figures.style import _COLORMAP_ON_DARK, ON_DARK

Array = np.ndarray[Any, Any]

VISION = {
    "all cones": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
"""Of linear RGB, severity 1: Machado, Oliveira, Fernandes: IEEE Trans. Vis. Comput. Graph. 15, 1291, 2009"""

XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
"""Of linear sRGB: IEC 61966-2-1."""


def lab(colors: Any, vision: Any = VISION["all cones"]) -> Array:
    """Colours as they are seen, in CIELAB with the white of D65."""
    rgb = np.asarray(colors)
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = np.clip(linear @ np.transpose(vision), 0.0, 1.0) @ XYZ.T / XYZ.sum(axis=1)
    x, y, z = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * 841 / 108 + 4 / 29).T
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def test_the_space_of_colours() -> None:
    """White, black, and the lightness of a grey; red as in Lindbloom's tables."""
    np.testing.assert_allclose(lab([[1, 1, 1], [0, 0, 0]]), [[100, 0, 0], [0, 0, 0]], atol=1e-6)
    np.testing.assert_allclose(lab([[1.0, 0.0, 0.0]]), [[53.24, 80.09, 67.20]], atol=0.05)


@pytest.mark.parametrize("vision", VISION.values(), ids=VISION)
@pytest.mark.parametrize(
    ("colors", "ground"), [(COLORS, "#FFFFFF"), (ON_DARK, "#14181E")], ids=["light", "dark"]
)
def test_no_two_lines_look_alike(colors: tuple[str, ...], ground: str, vision: Any) -> None:
    """A difference of 2.3 is just noticed (Mahy et al. 1994); lines differ by five times that."""
    seen = lab([to_rgb(one) for one in colors], vision)
    for (i, one), (j, other) in combinations(enumerate(seen), 2):
        assert np.linalg.norm(one - other) > 12.0, (colors[i], colors[j])
    assert np.linalg.norm(seen - lab(to_rgb(ground), vision), axis=1).min() > 30.0


@pytest.mark.parametrize("vision", VISION.values(), ids=VISION)
@pytest.mark.parametrize("name", [mpl.colormaps[COLORMAP], _COLORMAP_ON_DARK], ids=["light", "dark"])
def test_more_is_lighter(name: Any, vision: Any) -> None:
    """In sixteen steps each is lighter than that before it, and all span most of the scale."""
    lightness = lab(name(np.linspace(0.0, 1.0, 17))[:, :3], vision)[:, 0]
    assert np.diff(lightness).min() > 0.3
    assert np.ptp(lightness) > 45.0
