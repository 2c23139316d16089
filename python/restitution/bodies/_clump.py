"""Clumps of spheres, as discrete-element codes have them."""

import os
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from restitution._internal import files
from restitution._internal.arrays import FloatArray, flag
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies import _clump_files
from restitution.bodies._rigid import (
    LARGEST,
    SMALLEST,
    Centre,
    Density,
    RigidBody,
    Rows,
    ask_of_scale,
    rows,
    scale_of,
    tensor_of,
)

_SPHERES = f"rows (x, y, z, radius) in m, one or more, |x| to {LARGEST:g}, radius >= {SMALLEST:g}"
_INERTIA = '"union", "sum" or a symmetric matrix, shape (3, 3), in kg m²'


def _within(spheres: FloatArray) -> NDArray[np.bool_]:
    return np.asarray((np.abs(spheres) <= LARGEST) & (spheres >= [*3 * [-LARGEST], SMALLEST]))


def _inertia(value: Any) -> str | Rows:
    if isinstance(value, str) and value in ("union", "sum"):
        return value
    return tensor_of(value, _INERTIA)


class Clump(RigidBody):
    """Spheres that are fixed to each other, overlapping or not: the multisphere of discrete-element codes.

    Parameters
    ----------
    spheres : array_like, shape (n, 4)
        Centre and radius (x, y, z, r) of each sphere, in m; r > 0.
    density : float, default 2500
        Density in kg/m³; finite and > 0.
    inertia : {"union", "sum"} or array_like, shape (3, 3)
        The matter: that of the union of the spheres, or of each sphere by itself, so that overlaps count
        several times, as in some codes. Or the tensor of inertia about the centre of mass, in kg m², in the
        axes of the spheres; the mass is then that of the union.
    centre : array_like, shape (3,), optional
        The centre of mass in m, where a tensor of inertia is given; that of the union if it is left out.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Clump(spheres=[(0, 0, 1.5e-4, 3e-3), (0, 0, -1.5e-4, 3e-3)])
    >>> round(body.mass / rs.Dumbbell(radius=3e-3, separation=3e-4).mass, 12)
    1.0
    """

    spheres: Annotated[Any, Allowed(_SPHERES), rows(_SPHERES, 4, 1, _within), Field(description="m")]
    density: Density = 2500.0
    inertia: Annotated[Any, Allowed(_INERTIA), BeforeValidator(_inertia), Field(description="kg m²")] = (
        "union"
    )
    centre: Centre = None

    @property
    def apart(self) -> str:
        """Where for more than the largest diameter along x, y or z no sphere is, in words; else empty."""
        spheres = np.asarray(self.spheres)
        largest = float(spheres[:, 3].max())
        for axis, place in zip("xyz", spheres.T[:3], strict=True):
            order = np.argsort(place - spheres[:, 3])
            reach = np.maximum.accumulate((place + spheres[:, 3])[order])
            gaps = (place - spheres[:, 3])[order][1:] - reach[:-1]
            if gaps.size and gaps.max() > 2.0 * largest:
                gap, behind = float(gaps.max()), int(order[gaps.argmax() + 1])
                radii = f"{gap:.3g} m ({gap / largest:.3g} radii)"
                return f"spheres[{behind}] is {radii} away from others along {axis}"
        return ""

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        format: _clump_files.Format | None = None,
        *,
        scale: float = 1.0,
        density: float = 2500.0,
        inertia: Any = "union",
        centre: Any = None,
    ) -> Self:
        """Read the spheres from a file of another code.

        Parameters
        ----------
        path : str or path-like
            A text file. What follows a ``#`` is a comment.
        format : {"rows", "csv", "lammps", "liggghts"}, optional
            Rows ``x y z r`` with spaces or commas between, after which a type may stand, and which ``&``
            continues on the next line (LIGGGHTS, CLUMP, MercuryDPM); a table whose header names columns x, y,
            z and r (DEM-Engine); a molecule of LAMMPS, its ``Coords`` and ``Diameters``; or a script of
            LIGGGHTS with a ``particletemplate/multisphere`` that has its spheres in it. None finds out.
        scale : float, default 1
            What a unit of the file is in m: 1e-3 for millimetres. > 0.
        density, inertia, centre
            As those of the body.

        Raises
        ------
        ValueError
            If the file is none of these, or a row is malformed; the message names its line.
        OSError
            If the file cannot be read.
        """
        unit = scale_of(scale)
        place = files.path_from("path", path)
        spheres = np.array(_clump_files.read(place, format))
        with np.errstate(over="ignore"):
            scaled = unit * spheres
        if not _within(scaled).all():
            raise ParameterError(wrong("scale", scale, f"such that the spheres are {_SPHERES}"))
        ask_of_scale(place, unit, spheres)
        return cls(spheres=scaled, density=density, inertia=inertia, centre=centre)

    def to_csv(self, path: str | os.PathLike[str], *, replace: bool = False) -> None:
        """Write a table with the columns x, y, z and r, in m; an existing file only with ``replace``."""
        lines = ["x,y,z,r", *(",".join(map(repr, sphere)) for sphere in self.spheres)]
        files.write(files.path_from("path", path), "\n".join(lines) + "\n", replace=flag("replace", replace))
