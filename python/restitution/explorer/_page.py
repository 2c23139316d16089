"""The page and its links: what follows # in its address is a set-up."""

from importlib.resources import files
from typing import Any
from urllib.parse import urlencode

import numpy as np

from restitution._internal.described import kebab
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import KINDS
from restitution.drop.release import RandomHeight, RandomSpin
from restitution.drop.run import Run
from restitution.laws import Law

MOST_IMPACTS = 2_000_000
"""More than these the page does not keep."""

MOST_ROWS, MOST_TRIANGLES, MOST_ASPERITIES, MOST_TEXT = 1000, 20_000, 10_000, 20_000
"""Larger bodies it does not draw, and longer tables a link does not hold: ``web/src/``, rigid.ts, link.ts."""

NUMBERS = ("release_height", "gravity", "incline", "minimum_speed")


def page() -> str:
    """Return the page: one HTML file that needs nothing else."""
    return files("restitution.explorer").joinpath("explorer.html").read_text(encoding="utf-8")


def link(run: Run) -> str:
    """Return the part after # in the address of the page that shows a run.

    Parameters
    ----------
    run : Run
        A run that the page can show: of a body of revolution that has no parameter of its own for each of
        two spheres, or of any rigid body but `Rough`, of moderate size and homogeneous, under a law with a
        constant normal coefficient, all particles with the same spin and velocity. Of a run of more than
        2 000 000 impacts the page shows the first particles.

    Raises
    ------
    ValueError
        If the page cannot show the run; the message says what of it.
    """
    if not isinstance(run, Run):
        raise ParameterError(wrong("run", run, "a run, as of a TOML file"))
    # Every value is written, for a default of the package may change, and a link shall stay.
    values: dict[str, Any] = {
        "shape": kebab(type(run.body).__name__),
        **_body(run),
        "law": kebab(type(run.law).__name__),
        **_law(run),
        **_orientation(run),
        **_motion(run),
        **{name: getattr(run, name) for name in NUMBERS},
        "impacts": run.impacts,
        "particles": max(1, min(run.particles, MOST_IMPACTS // run.impacts)),
        "seed": run.seed,
    }
    if run.seed >= 2**53:
        raise _cannot("seed", run.seed, "below 2**53")
    return urlencode(values)


def _cannot(name: str, value: object, allowed: str) -> ValueError:
    return ValueError(f"{name} = {value}: the explorer shows this only if it is {allowed}")


def _body(run: Run) -> dict[str, Any]:
    if not isinstance(run.body, KINDS):
        return _rigid(run.body)
    values = run.body.attributes()
    for name in ("wall", "inertia"):
        if name in values:
            raise _cannot(f"body.{name}", values[name], "left out")
    for name, value in values.items():
        if isinstance(value, tuple):
            values[name], other = value
            if values[name] != other:
                raise _cannot(f"body.{name}", value, "the same for both spheres")
    return values


def _rigid(body: Any) -> dict[str, Any]:
    """Write the parameters of a rigid body as the page names them."""
    if not body.entry():
        raise _cannot("body", type(body).__name__, "any other, of rough ones a RoughSphere")
    values: dict[str, Any] = {}
    for about in body.entry()["parameters"]:
        name, value = about["name"], getattr(body, about["name"])
        if about.get("default", 0.0) is None:
            if value is not None and not (name == "heights" and value == body.asperity_radius):
                raise _cannot(f"body.{name}", value, "left out")
        elif about["type"] == "several":
            values |= zip(about["names"], value, strict=True)
        elif about["type"] == "rows":
            most = {"vertices": 3 * MOST_TRIANGLES, "triangles": MOST_TRIANGLES}.get(name, MOST_ROWS)
            values[about["link"]] = _table(name, value, most)
        elif name == "inertia":
            if value != about["default"]:
                raise _cannot("body.inertia", "another", "that of homogeneous matter")
        else:
            most = {"asperities": MOST_ASPERITIES, "seed": 2**53 - 1}.get(name, 2**64)
            if about["type"] == "whole" and value > most:
                raise _cannot(f"body.{name}", value, f"at most {most}")
            values[about["link"]] = value
    if "triangles" in values:
        values["mesh"] = f"{values.pop('vertices')}*{values.pop('triangles')}"
        if len(values["mesh"]) > MOST_TEXT:
            raise _cannot("body.vertices", f"{len(body.vertices)} of them", "fewer")
    return values


def _table(name: str, rows: Any, most: int) -> str:
    """Write a table as a link has it."""
    text = "_".join(str(number) for row in rows for number in row)
    if len(rows) > most or len(text) > MOST_TEXT:
        raise _cannot(f"body.{name}", f"{len(rows)} rows", f"at most {most} rows and {MOST_TEXT} characters")
    return text


def _law(run: Run) -> dict[str, Any]:
    if not isinstance(run.law, Law) or not run.law.entry():
        raise _cannot("law", repr(run.law), "a law of the core")
    values = run.law.model_dump()
    if not isinstance(values["normal"], float | int):
        raise _cannot("law.normal", type(run.law.normal).__name__, "a number")
    return values


def _orientation(run: Run) -> dict[str, Any]:
    if run.orientations is None:
        return {"orientation": run.orientation}
    if run.angles is None:
        raise _cannot("orientation", "quaternions", "a name")
    if run.angles.size != 1 or np.ndim(run.orientation) != 1:
        raise _cannot("orientation", "an array", "a name, or the one angle of one particle")
    return {"orientation": "given", "angle": float(run.angles[0])}


def _motion(run: Run) -> dict[str, Any]:
    if isinstance(run.release_height, RandomHeight):
        raise _cannot("release_height", "of each particle its own", "the same for all")
    if isinstance(run.spin, RandomSpin) or run.spins is not None:
        raise _cannot("spin", "of each particle its own", "the same for all")
    x, y, z = run.spin
    along, across, up = run.release_velocity
    if x or across:
        raise _cannot(
            "spin and release_velocity", (run.spin, run.release_velocity), "(0, y, z) and (x, 0, z)"
        )
    return {"spin_y": y, "spin_z": z, "velocity_x": along, "velocity_z": up}
