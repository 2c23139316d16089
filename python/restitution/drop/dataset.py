"""A run as an xarray Dataset, with the names, units and flags of the core; files."""

from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._core import STOP_REASONS
from restitution.bodies import AnyBody, RigidBody
from restitution.drop.energy import ledger_of
from restitution.drop.run import Run

# With its first index xarray imports dask, which would take its time when Ctrl-C has ended a run.
xr.Dataset(coords={"impact": [0]})


def dataset(
    run: Run, table: dict[str, tuple[tuple[str, ...], npt.NDArray[Any], dict[str, Any]]]
) -> xr.Dataset:
    """Turn the records of the core into a Dataset of dimensions (particle, impact)."""
    variables: dict[str, Any] = dict(table)
    dimensions = {name for names, _, _ in table.values() for name in names}
    if "component" in dimensions:
        variables["component"] = (("component",), ["x", "y", "z"], {"long_name": "z: the plane normal"})
    if "quaternion" in dimensions:
        about = {"long_name": "parts of a quaternion, the real one first"}
        variables["quaternion"] = (("quaternion",), ["w", "x", "y", "z"], about)
    for name, size in zip(("particle", "impact"), table["time"][1].shape, strict=True):
        about = {"long_name": f"number of the {name}, from 0"}
        variables.setdefault(name, ((name,), np.arange(size), about))
    if run.angles is not None:
        rows = variables["particle"][1]
        about = {"long_name": "angle (and azimuth) of the axis at release, as given", "units": "rad"}
        given = run.orientation[rows]
        variables["orientation"] = (("particle", "angle_and_azimuth")[: given.ndim], given, about)
    attrs = attributes(run, "Impacts of bouncing aspherical particles")
    if "axis" in table or "attitude" in table:
        attrs |= inertia_of(run.body)
    attrs |= ledger_of(*(table[name][1] for name in ("impact_velocity", "restitution", "energy_ratio")))
    reasons = table["stop_reason"][1]
    cut_short = np.count_nonzero(reasons == STOP_REASONS.index("interrupted"))
    done = len(reasons) - cut_short
    if done < run.particles:
        attrs["incomplete"] = (
            f"interrupted: {done} of {run.particles} particles are finished, {cut_short} cut short"
            + (", others that were cut short are left out" if "particle" in table else "")
        )
    return xr.Dataset(variables, attrs=attrs)


def inertia_of(body: AnyBody) -> dict[str, Any]:
    """Return mass and moments of inertia by the names of attributes, without an axis the principal ones."""
    if isinstance(body, RigidBody):
        names: tuple[str, ...] = ("mass", "principal_moments", "principal_axes")
        return {name: getattr(body.compiled, name) for name in names}
    return {name: getattr(body, name) for name in ("mass", "transverse_inertia", "axial_inertia")}


def labelled(about: Mapping[str, tuple[Any, Any, str, str | None]]) -> dict[str, Any]:
    """Return variables by name: each has dimensions, values, what it is, and its unit if it has one."""
    return {
        name: (dims, values, {"long_name": text} | ({"units": unit} if unit else {}))
        for name, (dims, values, text, unit) in about.items()
    }


PAPER = {"references": "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)"}


@cache
def version_here() -> str:
    """Return the version; looking it up takes as long as a small run."""
    return version("restitution")


def made_here(title: str) -> dict[str, Any]:
    """Return the attributes of every Dataset that says what made it."""
    return {
        "title": title,
        "Conventions": "CF-1.11",
        "source": f"restitution {version_here()}",
        "version": version_here(),
    }


def attributes(run: Run, title: str) -> dict[str, Any]:
    """Return the attributes of every result: title, conventions, version, all parameters and the seed."""
    return made_here(title) | PAPER | run.attributes()
