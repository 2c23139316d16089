"""The xarray face of a run: names, units, flags, and files that are written whole or not at all."""

import errno
import os
import tempfile
from collections.abc import Iterable
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from restitution._energy import ledger_of
from restitution._run import Run

BYTES_PER_IMPACT = 57
"""Seven doubles and a byte."""

STOP_REASONS = ("impacts_reached", "speed_below_threshold", "collapse", "never_lands", "interrupted")


def _flags(values: Iterable[int], meanings: Iterable[str]) -> dict[str, Any]:
    """CF attributes of a variable whose numbers stand for words."""
    return {"flag_values": np.array(list(values), dtype=np.int8), "flag_meanings": " ".join(meanings)}


_PER_IMPACT: dict[str, dict[str, Any]] = {
    "time": {"long_name": "time since release", "units": "s"},
    "impact_velocity": {
        "long_name": "normal velocity of the centre of mass towards the plane, before the impact",
        "units": "m s-1",
        "symbol": "v_G^n",
    },
    "rebound_velocity": {
        "long_name": "normal velocity of the centre of mass away from the plane, after the impact",
        "units": "m s-1",
    },
    "restitution": {
        "long_name": "coefficient of restitution: rebound velocity over impact velocity (Eq. 1)",
        "units": "1",
        "symbol": "ε",
    },
    "rotational_fraction": {
        "long_name": "rotational over total kinetic energy, before the impact (Eq. 12)",
        "units": "1",
        "symbol": "E_rot/E_tot",
    },
    "energy_ratio": {"long_name": "total kinetic energy after over before the impact", "units": "1"},
    "angle": {
        "long_name": "angle between symmetry axis and plane normal at the impact",
        "units": "rad",
        "symbol": "θ",
    },
    "contact": {
        "long_name": "sphere or half that touched; the axis points to 1",
        **_flags(range(3), ("none", "sphere_1", "sphere_2")),
    },
}

_PER_PARTICLE: dict[str, dict[str, Any]] = {
    "impacts": {"long_name": "number of impacts"},
    "stop_reason": {"long_name": "why the trajectory ended", **_flags(range(5), STOP_REASONS)},
    "release_angle": {"long_name": "angle between symmetry axis and plane normal at release", "units": "rad"},
}

# Where particles are let go with spin or velocity, or over an inclined plane.
_IN_SPACE: dict[str, tuple[tuple[str, ...], dict[str, Any]]] = {
    "release_azimuth": (
        ("particle",),
        {
            "long_name": "azimuth of the symmetry axis at release, from x towards y",
            "units": "rad",
            "symbol": "φ",
        },
    ),
    "release_spin": (
        ("particle", "component"),
        {"long_name": "angular velocity at release", "units": "rad s-1", "symbol": "ω"},
    ),
}


def dataset(run: Run, table: dict[str, Any]) -> xr.Dataset:
    """Turn the records of the core into a Dataset of dimensions (particle, impact)."""
    variables: dict[str, Any] = {}
    for name, attrs in _PER_IMPACT.items():
        variables[name] = (("particle", "impact"), table[name], attrs)
    for name, attrs in _PER_PARTICLE.items():
        variables[name] = (("particle",), table[name], attrs)
    for name, (dimensions, attrs) in _IN_SPACE.items():
        if name in table:
            variables[name] = (dimensions, table[name], attrs)
            variables["component"] = (("component",), ["x", "y", "z"], {"long_name": "z: the plane normal"})
    attrs = attributes(run, "Impacts of bouncing aspherical particles")
    attrs |= ledger_of(table["energy_ratio"])
    cut_short = np.count_nonzero(table["stop_reason"] == STOP_REASONS.index("interrupted"))
    done = len(table["stop_reason"]) - cut_short
    if done < run.particles:
        attrs["incomplete"] = (
            f"interrupted: {done} of {run.particles} particles are finished, {cut_short} cut short"
        )
    return xr.Dataset(variables, attrs=attrs)


@cache
def _version() -> str:
    """Tell the version; looking it up takes as long as a small run."""
    return version("restitution")


def attributes(run: Run, title: str) -> dict[str, Any]:
    """Give what every result carries: title, conventions, version, all parameters and the seed."""
    return {
        "title": title,
        "Conventions": "CF-1.11",
        "source": f"restitution {_version()}",
        "version": _version(),
        "references": "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)",
        **run.attributes(),
    }


def check_writable(path: Path, *, replace: bool) -> None:
    """Find out before the work begins whether `save` can write there; raises the OSError if it cannot."""
    target = path.resolve()
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "not a file that can be written", str(path))
    if target.exists() and not replace:
        raise FileExistsError(errno.EEXIST, "exists already", str(path))
    try:
        os.unlink(part(target))
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path.parent)) from None


def save(data: xr.Dataset, path: Path) -> None:
    """Write a netCDF file whole or not at all: nobody ever sees a half-written one under `path`."""
    target = path.resolve()
    name = part(target)
    try:
        data.to_netcdf(name, engine="netcdf4")
        os.chmod(name, 0o666 & ~umask())
        os.replace(name, target)
    except BaseException as error:
        os.unlink(name)
        if isinstance(error, RuntimeError):  # of netCDF, which does not say where
            raise OSError(errno.EIO, f"cannot be written: {error}", str(path)) from error
        raise


def part(target: Path) -> str:
    """Make an empty file beside `target`, so that it can take its place in one step."""
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
    os.close(handle)
    return name


def umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
