"""The commands that drop particles: `simulate`, `statistics`, `compare` and `distribution`."""

import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from restitution.cli._common import (
    WARNED,
    Kept,
    Out,
    Overwrite,
    Quiet,
    RunFile,
    Threads,
    errors_in_a_line,
    progress,
)
from restitution.cli._process import put_off, say, tell

if TYPE_CHECKING:
    import xarray as xr

Bins = Annotated[int | None, typer.Option(metavar="N", help="Number of bins; if not given, as in RUN.toml.")]
Record = Annotated[
    str, typer.Option(metavar="WHAT", help='"impacts", or "state": also position, axis and velocities.')
]
Until = Annotated[
    str | None,
    typer.Option(metavar="WHAT", help='"settled": a particle ends where it will come to rest as it lies.'),
]
Span = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="LOW HIGH", help="Range of these bins; if not given, as in RUN.toml."),
]


def simulate(
    run: RunFile,
    out: Out,
    record: Record = "impacts",
    until: Until = None,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Drop particles and write every impact to a netCDF file.

    The file holds what restitution.simulate returns for the same parameters; in
    Python xarray.open_dataset reads it. Ctrl-C ends the run early; the impacts so
    far are written, and the attribute "incomplete" of the file says so.
    """
    with errors_in_a_line("netCDF4"):
        from restitution.drop.simulate import simulate_run
        from restitution.drop.toml import read

        parameters = read(run)
        how: dict[str, Any] = {"record": record, "until": until, "threads": threads}
        work = partial(simulate_run, parameters, **how, progress=progress(quiet))
        written(work, _summary, run, out, overwrite=overwrite, quiet=quiet)


def statistics(
    run: RunFile,
    out: Out,
    velocity_bins: Bins = None,
    velocity_range: Span = None,
    restitution_bins: Bins = None,
    restitution_range: Span = None,
    table: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Also a table of the moments: .csv, or .parquet with pyarrow."),
    ] = None,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    r"""Count impacts by velocity and restitution, in memory that does not grow.

    The file holds what restitution.statistics returns: counts, moments and
    energy; a table has a row for each velocity bin. The bins are those of the
    table \[statistics] of RUN.toml, or of the options. Ctrl-C ends the run early;
    what was counted until then is written.
    """
    _count(run, out, locals(), threads, single=True, overwrite=overwrite, quiet=quiet, table=table)


def compare(
    run: RunFile,
    out: Out,
    velocity_bins: Bins = None,
    velocity_range: Span = None,
    restitution_bins: Bins = None,
    restitution_range: Span = None,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    r"""Count the impacts of several bodies under several laws.

    RUN.toml has a table [\[body]] for each body and a table [\[law]] for each law,
    each with a key "name" if you like, and a table \[statistics] with the bins.
    The file holds what restitution.compare returns. Ctrl-C ends the work early;
    combinations that were finished are written.
    """
    _count(run, out, locals(), threads, single=False, overwrite=overwrite, quiet=quiet)


def distribution(
    run: RunFile,
    out: Out,
    header: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A C99 and C++ header with a sampler.")
    ] = None,
    fortran: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A Fortran module with a sampler.")
    ] = None,
    figure: Annotated[Path | None, typer.Option(metavar="FILE", help="A figure: .png, .pdf or .svg.")] = None,
    velocities: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="LOW HIGH",
            help="Impact velocities, m/s; if not given, 0.04 to 0.4 of the first one.",
        ),
    ] = None,
    given: Annotated[
        str | None,
        typer.Option(
            metavar="CONDITION",
            help='Learn it given "rotational_fraction", or the "previous" restitution.',
        ),
    ] = None,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Learn the distribution of the coefficient of restitution at given impact velocity.

    The file holds what restitution.FluctuatingRestitution.learn returns for the
    same parameters. The distance of the distribution from fresh impacts is
    measured and printed; where it is larger than their statistical scatter
    explains, a warning says so, and the exit status is 3. Ctrl-C ends the work,
    and nothing is written.
    """
    with errors_in_a_line("netCDF4", "scipy.stats", "matplotlib.figure"):
        from restitution._internal.datasets import put
        from restitution._internal.files import (
            HEADER,
            MODULE,
            NETCDF,
            check,
            check_apart,
            path_for,
            whole_file,
        )
        from restitution.distribution import FluctuatingRestitution, image, image_format, sealed
        from restitution.distribution.sources import header as c_header
        from restitution.distribution.sources import module as fortran_module
        from restitution.drop.energy import EnergyWarning
        from restitution.drop.toml import read_all

        study = read_all(run, single=True)
        if figure is not None:
            image_format(figure)
        paths = [path for path in (out, header, fortran, figure) if path is not None]
        check_apart([run], paths)
        named = {"out": (out, NETCDF), "header": (header, HEADER), "fortran": (fortran, MODULE)}
        for option, (path, kind) in named.items():
            if path is not None:
                path_for(option, path, kind)
        for path in paths:
            check(path, replace=overwrite)
        options = {"velocities": velocities, "given": given}
        used = {name: value for name, value in options.items() if value is not None}
        how = study.run | study.distribution | used
        (body,), (law,) = study.bodies.values(), study.laws.values()
        with warnings.catch_warnings(record=True) as doubts:
            warnings.simplefilter("always")
            warnings.simplefilter("ignore", EnergyWarning)  # the summary says what it would
            found = FluctuatingRestitution.learn(body, law, **how, threads=threads, progress=progress(quiet))
        with ExitStack() as files:
            draft = {path: files.enter_context(whole_file(path, replace=overwrite)) for path in paths}
            put(sealed(found.data), draft[out])
            if header is not None:
                draft[header].write_text(c_header(found.data, "restitution"), encoding="ascii")
            if fortran is not None:
                draft[fortran].write_text(fortran_module(found.data, "restitution"), encoding="ascii")
            if figure is not None:
                draft[figure].write_bytes(image(found, image_format(figure)))
        if not quiet:
            say(str(found.summary()))
        for doubt in doubts:
            tell(f"warning: {doubt.message}")
    if doubts:
        raise typer.Exit(WARNED)


def _count(
    run: Path,
    out: Path,
    options: dict[str, Any],
    threads: int | None,
    *,
    single: bool,
    overwrite: bool,
    quiet: bool,
    table: Path | None = None,
) -> None:
    """Count impacts of one body under one law, or of several; options go before the table [statistics]."""
    with errors_in_a_line("netCDF4"):
        import restitution as rs
        from restitution.drop.toml import COUNTING, read_all

        study = read_all(run, single=single)
        bins = study.statistics | {name: options[name] for name in COUNTING if options.get(name) is not None}
        missing = [name for name in ("velocity_bins", "restitution_bins") if name not in bins]
        if missing:
            words = ", ".join(f"--{name.replace('_', '-')}" for name in missing)
            raise ValueError(
                f"{run}: {' and '.join(missing)}: missing; must be in a table [statistics], "
                f"as restitution template prints it, or given as {words} with a range"
            )
        how = study.run | bins | {"threads": threads, "progress": progress(quiet)}
        if single:
            (body,), (law,) = study.bodies.values(), study.laws.values()
            count = partial(rs.statistics, body, law, **how)
        else:
            count = partial(rs.compare, study.bodies, study.laws, **how)
        written(count, _counts, run, out, overwrite=overwrite, quiet=quiet, table=table)


def written(
    work: Callable[[], "xr.Dataset"],
    summary: Callable[["xr.Dataset"], Iterable[str]],
    run: Path,
    out: Path,
    *,
    overwrite: bool,
    quiet: bool,
    table: Path | None = None,
) -> None:
    """Do the work, write its result, also where Ctrl-C ended it early, and print a summary."""
    from restitution._internal.datasets import save
    from restitution._internal.files import NETCDF, check, check_apart, path_for, write
    from restitution.drop.simulate import SimulationInterrupted

    check_apart([run], [out] if table is None else [out, table])
    path_for("out", out, NETCDF)
    check(out, replace=overwrite)
    if table is not None:
        _check_table(table)
        check(table, replace=overwrite)
    interrupted: KeyboardInterrupt | None = None  # kept: what is caught has not been lost
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the summary says what they would
        try:
            found = work()
        except SimulationInterrupted as stop:
            found, interrupted = stop.data, stop
            tell("interrupted; writing the impacts so far")
    again = "interrupted; the file is being written, press Ctrl-C again to abandon it"
    with put_off(lambda: tell(again)) as late:
        save(found, out, replace=overwrite)
        if table is not None:
            write(table, _rows(found, table), replace=overwrite)
    for line in summary(found) if not quiet else ():
        say(line)
    if interrupted or late:
        raise Kept(late) from interrupted


def _check_table(path: Path) -> None:
    from restitution._internal.files import TABLE, path_for
    from restitution._internal.parameters import ParameterError, wrong

    path_for("table", path, TABLE)
    if path.suffix not in (".csv", ".parquet"):
        raise ParameterError(wrong("table", str(path), "a name that ends in .csv or .parquet"))
    if path.suffix == ".parquet" and find_spec("pyarrow") is None:
        raise ImportError("Parquet needs pyarrow: pip install 'restitution[table]'")


def _rows(found: "xr.Dataset", path: Path) -> bytes:
    """Write what there is of each row of the counts, with the edges of the velocity bins."""
    row = "velocity" if "velocity" in found.dims else "impact"
    frame = found[[name for name, one in found.data_vars.items() if one.dims == (row,)]].to_dataframe()
    if "velocity_edges" in found:
        edges = found["velocity_edges"].to_numpy()
        frame.insert(0, "velocity_from", edges[:-1])
        frame.insert(1, "velocity_to", edges[1:])
    return bytes(frame.to_parquet(None) if path.suffix == ".parquet" else frame.to_csv().encode())


def _counts(found: "xr.Dataset") -> Iterator[str]:
    inside, total = int(found["restitution_count"].sum()), int(found["number"].sum())
    yield f"The rows hold {total} impacts, and the bins of restitution {inside} of them."
    if "body" not in found.dims:
        yield from _energy(found.attrs)
        return
    for body in found["body"].values:
        for law in found["law"].values:
            here = found.sel(body=body, law=law)
            yield (
                f"{body} made {int(here['all_impacts'])} impacts under {law}; "
                f"{100 * float(here['energy_created_share']):.3g} % of them created kinetic energy."
            )


_ENDED = {
    "impacts_reached": "all impacts asked for were made",
    "speed_below_threshold": "the speed was below the minimum",
    "collapse": "impacts accumulate",
    "never_lands": "the next impact is too many turns away",
    "interrupted": "the run was interrupted",
    "settled": "no pass out of the well that it was in is so low",
}
"""Why a particle ended, by the name of the reason."""


def _number(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def _summary(data: "xr.Dataset") -> Iterator[str]:
    """Summarise a run: its impacts, the reasons why particles stopped, and any energy created."""
    from restitution._core import STOP_REASONS

    impacts = int(data.impacts.sum())
    yield f"{_number(data.sizes['particle'], 'particle')} made {_number(impacts, 'impact')}."
    for code, name in enumerate(STOP_REASONS):
        if count := int((data.stop_reason == code).sum()):
            yield f"{_number(count, 'particle')} ended because {_ENDED[name]} ({name})."
    yield from _energy(data.attrs)


def _energy(attrs: dict[str, Any]) -> Iterator[str]:
    from restitution.drop.energy import factor

    gains = attrs["energy_created_impacts"]
    if gains:
        largest = attrs["largest_energy_ratio"]
        yield f"{_number(gains, 'impact')} created kinetic energy, by a factor of {factor(largest)} at most."
    if pulls := attrs.get("pulling_impacts"):
        yield f"{_number(pulls, 'impact')} let the plane pull."
