"""The commands without gravity: `pair` and `gas`."""

from collections.abc import Callable, Iterator
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from restitution.cli._common import Out, Overwrite, Quiet, RunFile, Threads, errors_in_a_line, progress
from restitution.cli._runs import written

if TYPE_CHECKING:
    import xarray as xr

_Encounters = Annotated[
    str,
    typer.Option("--record", metavar="WHAT", help='"encounters"; or "state" or "contacts", which have more.'),
]
_Moments = Annotated[
    str,
    typer.Option("--record", metavar="WHAT", help='"moments", or "state": also each particle at the end.'),
]

_Checkpoint = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Keep there, as netCDF, how far the run has come; the same command goes on from it.",
    ),
]

_BESIDES = ("body", "other", "law", "state", "states", "record", "threads", "progress", "checkpoint")
"""Arguments that have tables or options of their own, or none."""


def _written(
    name: str,
    summary: Callable[["xr.Dataset"], Iterator[str]],
    run: Path,
    out: Path,
    *,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    **options: Any,
) -> None:
    """Call the function of a command with the bodies and the law of a file and the arguments in its table."""
    with errors_in_a_line("netCDF4"):
        import restitution as rs
        from restitution._internal.parameters import ParameterError
        from restitution.drop.toml import Reader, tables_in
        from restitution.pair import Plane

        meets = name == "pair"
        function: Callable[..., Any] = rs.pair.encounters if meets else rs.gas.cool
        reader = Reader(tables_in(run), ("body", *(["other"] if meets else []), "law", name))
        bodies = list(reader.several("body", single=meets).values()) or [None]
        several = isinstance(reader.tables.get("body"), list) and not meets
        parts: list[Any] = [bodies if several else bodies[0]]
        if meets:
            other = reader.table("other")
            plane = other == {"shape": "plane"}
            parts.append(Plane() if plane else reader.chosen("other", other) if other else bodies[0])
        parts.append(reader.chosen("law", reader.table("law")))
        table = reader.table(name)
        keys = [key for key in signature(function).parameters if key not in _BESIDES]
        reader.only(name, table, keys)
        reader.finish(str(run))
        how = {"threads": threads, "progress": progress(quiet), **options}

        def work() -> Any:
            try:
                return function(*parts, **table, **how)
            except ParameterError as error:
                own = (p._replace(name=f"{name}.{p.name}") if p.name in keys else p for p in error.problems)
                raise ValueError("\n".join(f"{run}: {problem}" for problem in own)) from None

        written(work, summary, run, out, overwrite=overwrite, quiet=quiet)


def pair(
    run: RunFile,
    out: Out,
    record: _Encounters = "encounters",
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    r"""Follow encounters of two bodies in free flight, or of a body with a plane.

    RUN.toml has tables \[body] and \[law] as for simulate, \[other] for the second
    body if it is another, or with shape = "plane", and a table \[pair] with the
    arguments of restitution.pair.encounters: translational_temperature or speed,
    rotational_temperature or spin, encounters, impact_parameter, seed. The file
    holds what that returns.
    """
    how: dict[str, Any] = {"threads": threads, "overwrite": overwrite, "quiet": quiet, "record": record}
    _written("pair", _pairs, run, out, **how)


def gas(
    run: RunFile,
    out: Out,
    record: _Moments = "moments",
    checkpoint: _Checkpoint = None,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    r"""Follow a dilute gas of bodies that collide, without gravity.

    RUN.toml has tables \[body], or \[\[body]] for each species, and \[law] as for
    simulate, and a table \[gas] with the arguments of restitution.gas.cool:
    translational_temperature, rotational_temperature, particles, collisions,
    number_density, heating, seed and others. The file holds what that returns.
    """
    how: dict[str, Any] = {"threads": threads, "overwrite": overwrite, "quiet": quiet, "record": record}
    _written("gas", _gas, run, out, checkpoint=checkpoint, **how)


def _pairs(data: "xr.Dataset") -> Iterator[str]:
    from restitution._core import PAIR_ENDINGS

    met, count = int((data.contacts > 0).sum()), data.sizes["encounter"]
    yield f"{met} of {count} encounters have {int(data.contacts.sum())} contacts."
    if collapsed := int((data.ending == PAIR_ENDINGS.index("collapse")).sum()):
        yield f"{collapsed} ended because contacts accumulate or last (collapse)."


def _gas(data: "xr.Dataset") -> Iterator[str]:
    warm = data["translational_temperature"]
    kept = ", ".join(f"{part:.4g}" for part in (warm.isel(time=-1) / warm.isel(time=0)).values.ravel())
    yield f"After {float(data.collisions[-1]):.4g} collisions of a particle T_tr is {kept} of what it was."
    for name, what in (("energy_created_share", "created energy"), ("collapse_share", "ended as a collapse")):
        if share := data.attrs[name]:
            yield f"{100 * share:.3g} % of the collisions {what}."
