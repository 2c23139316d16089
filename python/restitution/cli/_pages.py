"""`restitution paper`, `rough`, `gas-figures` and `laws`: figures, data and reports in a folder."""

from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

from restitution.cli._common import Folder, Overwrite, Quiet, Threads, errors_in_a_line, progress
from restitution.cli._process import say


def paper(
    out: Folder,
    impacts: Annotated[
        int,
        typer.Option(
            metavar="N",
            help="Impacts for each figure and each curve of Fig. 6; at least 400000, as in the paper.",
        ),
    ] = 100_000_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**64).")] = 1,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Redraw the figures of Phys. Rev. E 90, 052204 (2014) and check its claims.

    Writes Figs. 2-7 and 9 as PNG and PDF, the data behind each as netCDF, and
    one HTML page that needs nothing else: the figures, the misprints with their
    proof, and every claim of the paper with the measured number, its standard
    error and a verdict.
    """
    _redraw("glielmo2014", out, impacts, seed, threads, quiet, overwrite=overwrite)


def rough(
    out: Folder,
    impacts: Annotated[
        int,
        typer.Option(metavar="N", help="Impacts in the map of restitution and velocity; at least 10000."),
    ] = 10_000_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**64).")] = 1,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Simulate spheres with a million asperities and check what is said of them.

    The model is that of Phys. Rev. E 84, 041306 (2011) and 89, 022205 (2014).
    Writes four figures as PNG and PDF, the data behind each as netCDF, and one
    HTML page that needs nothing else, with every claim, the measured number,
    its standard error and a verdict.
    """
    _redraw("gunkelmann2014", out, impacts, seed, threads, quiet, overwrite=overwrite)


def gas_figures(
    out: Folder,
    particles: Annotated[
        int, typer.Option(metavar="N", help="Particles in each gas; at least 100.")
    ] = 10_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**64).")] = 1,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Follow gases of aspherical grains and check what is published of them.

    Writes four figures as PNG and PDF, the data behind each as netCDF, and one
    HTML page that needs nothing else: two-stage cooling beside kinetic theory,
    the limit of round grains, spheres that draw their restitution, friction, and
    every claim with the measured number, its standard error and a verdict.
    """
    _redraw("gases", out, particles, seed, threads, quiet, overwrite=overwrite)


def _redraw(
    paper: str, out: Path, size: int, seed: int, threads: int | None, quiet: bool, *, overwrite: bool
) -> None:
    """Redraw one of `restitution.papers`, and say where its report is."""
    with errors_in_a_line("netCDF4", "scipy.stats", "matplotlib.figure"):
        redraw = import_module(f"restitution.papers.{paper}").redraw
        report = redraw(out, size, seed, threads, progress(quiet), overwrite=overwrite)
        if not quiet:
            say(str(report))


def laws(
    out: Folder,
    impacts: Annotated[
        int, typer.Option(metavar="N", help="Impacts for each body and law, on average; at least 19680.")
    ] = 10_000_000,
    seed: Annotated[int, typer.Option(metavar="S", help="Seed of the random numbers, in [0, 2**63).")] = 1,
    threads: Threads = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Compare what six collision laws make of the same bodies.

    Drops dumbbells of L/R = 0.01, 0.1, 0.5 and 2 under six laws, and writes one
    figure (PNG, PDF), its caption, its data (netCDF) and its table (Markdown):
    the density of the coefficient of restitution, its scatter, the rotational
    energy, and the impacts that create energy.
    """
    with errors_in_a_line("netCDF4", "scipy.stats", "matplotlib.figure"):
        from restitution.figures.laws import write

        how = {"seed": seed, "threads": threads, "progress": progress(quiet)}
        png, _ = write(out, impacts=impacts, overwrite=overwrite, **how)  # type: ignore[arg-type]
        if not quiet:
            say(str(png))
