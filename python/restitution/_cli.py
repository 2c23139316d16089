"""The command line: `restitution simulate`, `distribution`, `paper` and `laws`.

Nothing heavy is imported before a command needs it, so that help comes at once.
"""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

if TYPE_CHECKING:
    import xarray as xr

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130
"""Exit codes: files or numbers in trouble; input that is refused; Ctrl-C."""

app = typer.Typer(
    help="The coefficient of restitution as a distribution, not a number: "
    "bodies that are no spheres bouncing on a plane.",
    epilog="Examples: [bold]restitution paper --out paper[/bold], "
    "[bold]restitution simulate run.toml --out run.nc[/bold].\n\n"
    "Exit code: 0 done, 1 a file or the numerics failed, 2 the input is refused, 130 interrupted.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)

Threads = Annotated[
    int | None,
    typer.Option(
        metavar="N", help="Number of threads; one for each core if not given. Never changes the result."
    ),
]


def main() -> None:
    """Run the command line."""
    app(prog_name="restitution")


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"restitution {version('restitution')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and leave.")
    ] = False,
) -> None:
    pass


@app.command(
    epilog="Example: [bold]restitution simulate run.toml --out run.nc[/bold]; in Python then "
    "[bold]xarray.open_dataset('run.nc')[/bold]."
)
def simulate(
    run: Annotated[Path, typer.Argument(metavar="RUN.toml", help="The parameters, as above.")],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The netCDF file to write, whole or not at all.")],
    threads: Threads = None,
    force: Annotated[bool, typer.Option("--force", help="Replace FILE if it exists.")] = False,
) -> None:
    r"""Drop particles and write every impact to a netCDF file.

    The file holds what restitution.simulate returns for the same parameters.
    Ctrl-C ends the run early; the impacts so far are written all the same, and
    the attribute "incomplete" of the file says so.

    RUN.toml, in SI units:

    \[body]
    shape = "dumbbell"
    radius = 3e-3                    # R of either sphere, m
    separation = 3e-4                # L between the centres, m; 0: a sphere
    density = 2500.0                 # kg/m3 (default)

    \[law]
    type = "tangential-restitution"  # Eq. 9
    normal = 0.98                    # in [0, 1]
    tangential = 1.0                 # in [-1, 1] (default)

    \[run]                            # these are the defaults
    particles = 1000
    impacts = 400                    # most impacts of each particle
    release_height = 0.06            # of the centre of mass, m
    gravity = 9.81                   # m/s2
    orientation = "uniform-angle"    # or "isotropic", or a list of angles, rad
    spin = \[0.0, 0.0, 0.0]           # rad/s; or a table \[run.spin]: rate, axis
    velocity = \[0.0, 0.0, 0.0]       # of the centre of mass, m/s
    incline = 0.0                    # of the plane, falling along x, rad
    minimum_speed = 0.0              # m/s: slower particles end; 0: none does
    seed = 1
    """
    interrupted = False
    with _errors_in_a_line():
        from restitution._resources import checked_threads
        from restitution._simulate import SimulationInterrupted, simulate_run
        from restitution._toml import read

        parameters = read(run)
        checked_threads(threads)
        from restitution._dataset import check_writable, save

        check_writable(out, replace=force)
        try:
            data = simulate_run(parameters, threads=threads, progress=sys.stderr.isatty())
        except SimulationInterrupted as stop:
            data, interrupted = stop.data, True
            _tell("interrupted; writing the impacts so far")
        with _first_ctrl_c_put_off() as late:
            save(data, out)
        for line in _summary(data):
            typer.echo(line)
    if interrupted or late:
        raise typer.Exit(INTERRUPTED)


@app.command(
    epilog="Example: [bold]restitution distribution run.toml --out dist.nc --header dist.h[/bold]; in Python "
    "then [bold]restitution.FluctuatingRestitution.load('dist.nc')[/bold]."
)
def distribution(
    run: Annotated[
        Path, typer.Argument(metavar="RUN.toml", help="The parameters, as for [bold]simulate[/bold].")
    ],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The netCDF file to write, whole or not at all.")],
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
            help="Speeds to learn, m/s; 0.04 to 0.4 of the release velocity if not given.",
        ),
    ] = None,
    given: Annotated[
        str | None,
        typer.Option(
            metavar="CONDITION", help='Also learn it given "rotational_fraction" or "previous" restitution.'
        ),
    ] = None,
    threads: Threads = None,
    force: Annotated[bool, typer.Option("--force", help="Replace files that exist.")] = False,
) -> None:
    """Learn the distribution of the coefficient of restitution at given impact velocity.

    The file holds what restitution.FluctuatingRestitution.learn returns for the
    same parameters. How far the distribution is from impacts that it was not
    learned from is measured and told. Ctrl-C ends the work; nothing is written.
    """
    with _errors_in_a_line():
        from restitution._resources import checked_threads
        from restitution._toml import read

        parameters = read(run)
        checked_threads(threads)
        from restitution._dataset import check_writable
        from restitution.distribution import image_format, learn_run

        if figure is not None:
            image_format(figure)
        for path in (out, header, fortran, figure):
            if path is not None:
                check_writable(path, replace=force)
        found = learn_run(
            parameters,
            velocities=velocities,
            given=given,  # type: ignore[arg-type]  # checked there
            threads=threads,
            progress=sys.stderr.isatty(),
        )
        found.save(out, replace=force)
        if header is not None:
            found.to_c(header, replace=force)
        if fortran is not None:
            found.to_fortran(fortran, replace=force)
        if figure is not None:
            found.draw(figure, replace=force)
        for line in found.summary():
            typer.echo(line)


@app.command(
    epilog="Example: [bold]restitution paper --out paper[/bold]; open the page that it names in a browser."
)
def paper(
    out: Annotated[Path, typer.Option(metavar="DIR", help="The directory to write to, all or nothing.")],
    impacts: Annotated[
        int, typer.Option(metavar="N", help="Impacts in each of Figs. 2-7; at least 400000, as in the paper.")
    ] = 100_000_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**64).")] = 1,
    threads: Threads = None,
) -> None:
    """Redraw and judge Phys. Rev. E 90, 052204 (2014).

    Writes Figs. 2-7 and 9 as PNG and PDF, the data behind each as netCDF, and
    one HTML page that needs nothing else: the figures, the misprints with their
    proof, and every claim of the paper with the measured number, its standard
    error and a verdict.
    """
    with _errors_in_a_line():
        from restitution.paper import redraw

        report = redraw(out, impacts=impacts, seed=seed, threads=threads, progress=sys.stderr.isatty())
        typer.echo(str(report))


@app.command(epilog="Example: [bold]restitution laws --out laws[/bold].")
def laws(
    out: Annotated[Path, typer.Option(metavar="DIR", help="The directory to write to, all or nothing.")],
    impacts: Annotated[
        int, typer.Option(metavar="N", help="Impacts for each body and law, on average; at least 19680.")
    ] = 10_000_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**63).")] = 1,
    threads: Threads = None,
) -> None:
    """Show what the collision law does to the result.

    Drops dumbbells of L/R = 0.01, 0.1, 0.5 and 2 under six laws, and writes one
    figure (PNG, PDF), its caption, its data (netCDF) and its table (Markdown):
    the density of the coefficient of restitution, its scatter, the rotational
    energy, and the impacts that create energy.
    """
    with _errors_in_a_line():
        from restitution._resources import checked_threads
        from restitution.laws_figure import write

        checked_threads(threads)
        png, _ = write(out, impacts=impacts, seed=seed, threads=threads, progress=sys.stderr.isatty())
        typer.echo(str(png))


@contextmanager
def _first_ctrl_c_put_off() -> Iterator[list[int]]:
    """Let the block end before a Ctrl-C counts, which it puts into the list; a second one ends the block."""
    late: list[int] = []

    def put_off(number: int, _: object) -> None:
        late.append(number)
        _tell("interrupted; the file is being written, another Ctrl-C gives it up")
        signal.signal(signal.SIGINT, signal.default_int_handler)

    previous = signal.signal(signal.SIGINT, put_off)
    try:
        yield late
    finally:
        signal.signal(signal.SIGINT, previous)


@contextmanager
def _errors_in_a_line() -> Iterator[None]:
    """Show what is foreseen to go wrong as a line each, not as a traceback."""
    try:
        yield
    except ValueError as error:
        _fail(str(error), BAD_INPUT)
    except OSError as error:
        _fail(f"{error.filename}: {error.strerror}" if error.filename else str(error), FAILED)
    except (RuntimeError, MemoryError) as error:  # NumericalError is a RuntimeError
        _fail(str(error) or "out of memory", FAILED)
    except KeyboardInterrupt:
        _tell("interrupted")
        raise typer.Exit(INTERRUPTED) from None


def _fail(message: str, code: int) -> NoReturn:
    for line in message.splitlines():
        _tell(f"error: {line}")
    raise typer.Exit(code)


def _tell(line: str) -> None:
    typer.echo(line, err=True)


def _summary(data: "xr.Dataset") -> Iterator[str]:
    """Say what a run holds: impacts, why the particles stopped, and whether energy was created."""
    from restitution._dataset import STOP_REASONS
    from restitution._energy import factor

    impacts = int(data.impacts.sum())
    yield f"{data.sizes['particle']} particles, {impacts} impacts"
    counts = [(int((data.stop_reason == code).sum()), name) for code, name in enumerate(STOP_REASONS)]
    yield "stop reasons: " + ", ".join(f"{name} {count}" for count, name in counts if count)
    gains = data.attrs["energy_created_impacts"]
    if gains:
        largest = data.attrs["largest_energy_ratio"]
        yield f"{gains} impacts created kinetic energy, at most by a factor of {factor(largest)}"
