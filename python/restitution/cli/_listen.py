"""`restitution listen`: from a recording of a bouncing ball, or the times of its impacts, to a page."""

from pathlib import Path
from typing import Annotated

import typer

from restitution.cli._common import Overwrite, Quiet, errors_in_a_line
from restitution.cli._process import say, tell


def listen(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="A recording: WAV, FLAC, OGG, MP3, AIFF, M4A with ffmpeg; or times: CSV, TXT, XLSX. Several "
            "files, or several drops in one, are drops of one ball and are combined; files of different "
            "folders are those of the tables of a class.",
        ),
    ],
    diameter: Annotated[
        float | None, typer.Option(metavar="D", help="Diameter of the ball, m; required.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="PAGE.html", help="The page to write, with PAGE.csv and PAGE.nc beside it; required."
        ),
    ] = None,
    mass: Annotated[
        float | None, typer.Option(metavar="M", help="Mass of the ball, kg, for a correction of air drag.")
    ] = None,
    drop: Annotated[
        float | None,
        typer.Option(metavar="H", help="Fall from rest to the first impact heard, m."),
    ] = None,
    drop_error: Annotated[float, typer.Option(metavar="S", help="Standard error of the drop, m.")] = 0.0,
    time_error: Annotated[
        float | None, typer.Option(metavar="S", help="Standard error of times in a table without one, s.")
    ] = None,
    gravity: Annotated[float, typer.Option(metavar="G", help="Acceleration of gravity, m/s2.")] = 9.81,
    gravity_error: Annotated[
        float | None,
        typer.Option(metavar="S", help="Standard error of gravity, m/s2; else 3e-3 of it, as on the Earth."),
    ] = None,
    clock_error: Annotated[
        float, typer.Option(metavar="S", help="Standard error of the clock, over what it shows.")
    ] = 1e-4,
    out_of_roundness: Annotated[
        float | None, typer.Option(metavar="T", help="Out-of-roundness of the ball, m, if it was measured.")
    ] = None,
    roughness: Annotated[
        float | None, typer.Option(metavar="RA", help="Roughness Ra of the ball, m, if it was measured.")
    ] = None,
    wall: Annotated[
        float | None, typer.Option(metavar="W", help="Thickness of the wall of a hollow ball, m.")
    ] = None,
    contact_time: Annotated[
        float | None, typer.Option(metavar="T", help="Time for which ball and plate touch at 1 m/s, s.")
    ] = None,
    contact_error: Annotated[
        float, typer.Option(metavar="S", help="Standard error of the time of contact, s.")
    ] = 0.0,
    doubtful: Annotated[bool, typer.Option("--doubtful", help="Take impacts that are in doubt.")] = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    """Find the impacts of a bouncing ball in a recording, or read their times, and evaluate them.

    Writes one page that needs nothing else: the impacts marked on the waveform,
    close-ups of onsets, the coefficient of restitution against the speed with
    errors, the laws that fit it, what the times say of the ball's shape, and an
    error budget; beside it a table of all impacts (CSV) and all numbers with their
    covariance (netCDF). Several drops of a ball give one answer, with a scatter
    between them as of other plates or hands.
    """
    options = locals()

    def called(name: str) -> str:
        """Return the name of the option that gives a parameter."""
        return name.replace("uncertainty", "error")

    with errors_in_a_line("netCDF4", "restitution.experiment.listen"):
        from restitution._internal.parameters import renamed
        from restitution.experiment.listen import Setting, write

        if diameter is None or out is None:
            given = {"--diameter": diameter, "--out": out}
            absent = [option for option, value in given.items() if value is None]
            raise ValueError(f"{' and '.join(absent)}: missing; must be given")
        with renamed(called):
            setting = Setting(**{name: options[called(name)] for name in Setting.model_fields})
        analysis = write(files, out, setting, replace=overwrite)
        for warning in analysis.warnings:
            tell(f"note: {warning}")
        if not quiet:
            for sentence in analysis.sentences:
                say(sentence)
            say(str(out))
