"""The commands `restitution sweep STUDY.toml` and `restitution sweep merge`."""

from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Annotated, Any

import typer

from restitution.cli._common import Command, Group, Quiet, Threads, errors_in_a_line, progress
from restitution.cli._process import say, tell


class _RunUnlessNamed(Group):
    """A group that takes a study where others take the name of a command."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        names = (*self.commands, *ctx.help_option_names)
        if args and args[0] not in names:
            args = ["run", *args]
        left: list[str] = super().parse_args(ctx, args)
        return left


app = typer.Typer(
    cls=_RunUnlessNamed,
    no_args_is_help=True,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Vary parameters of a run, on one machine or many: [bold]restitution sweep STUDY.toml --out "
    "STORE.zarr[/bold], which is short for [bold]sweep run[/bold].",
)

Out = Annotated[
    Path, typer.Option("--out", "-o", metavar="STORE", help="The Zarr store; created if it does not exist.")
]


@app.command(
    cls=Command,
    epilog="Example: [bold]restitution sweep study.toml --out study.zarr[/bold]; in Python then "
    "[bold]xarray.open_zarr('study.zarr')[/bold].",
)
def run(
    study: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="A run, what is varied and what is measured.")
    ],
    out: Out,
    threads: Threads = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="A Dask cluster: tcp://host:8786, or its scheduler file."),
    ] = None,
    shard: Annotated[
        str | None,
        typer.Option(
            metavar="I/N", help="Compute part I of N, as one job of an array; [bold]merge[/bold] joins them."
        ),
    ] = None,
    dry_run: Annotated[
        bool,
        typer.Option(
            "--dry-run", help="Time a few particles, print the estimated cost of the study, and exit."
        ),
    ] = False,
    status: Annotated[
        bool, typer.Option("--status", help="Show how much of the store is done, and exit.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    r"""Run a study, or resume it.

    Every task is kept in the store as soon as it is done. If the command is
    stopped, the same command continues: what is missing is computed, and the
    result has the same bits as that of an undisturbed study. What is damaged is
    named; delete it, and the same command continues. Ctrl-C leaves a store that
    can be read.

    STUDY.toml is a run as for [bold]restitution simulate[/bold] and:

    \[sweep]
    "body.separation" = \[3e-5, 1e-4, 3e-4]
    "law.normal" = { from = 0.5, to = 0.98, points = 8 }

    \[statistics]
    velocity_bins = { from = 0.0, to = 1.1, bins = 110 }
    restitution_bins = { from = -1.0, to = 3.0, bins = 200 }

    \[effort]                         # may be left out
    until = { std = 0.01 }            # add particles up to this standard error
    """
    with errors_in_a_line("xarray"):
        from restitution.study import estimate, study_of, sweep
        from restitution.study import status as status_of
        from restitution.study.engines import client_at

        if status:
            say(str(status_of(out)))
            return
        if dry_run:
            from restitution import build_info
            from restitution._internal.resources import checked_threads

            number = checked_threads(threads) or build_info()["threads"]
            say(str(estimate(study_of(study), number)))
            return
        part = None if shard is None else _shard(shard)
        try:
            with nullcontext() if scheduler is None else client_at(scheduler) as client:
                sweep(study, out, client, threads=threads, shard=part, progress=progress(quiet))
        except KeyboardInterrupt:
            with suppress(ValueError, OSError):  # it may not be there yet
                tell(f"{out}: {status_of(out)} The same command continues.")
            raise
        if not quiet:
            say(f"{out}: {status_of(out)}")


@app.command(cls=Command, epilog="Example: [bold]restitution sweep merge --out study.zarr part*.zarr[/bold].")
def merge(
    out: Out,
    parts: Annotated[
        list[Path] | None,
        typer.Argument(metavar="PART", help="Stores of the same study; none, if all shards wrote to STORE."),
    ] = None,
    threads: Threads = None,
    quiet: Quiet = False,
) -> None:
    """Merge the shards of a study.

    What is missing is left out and reported; the command that made the shards,
    without --shard, computes it.
    """
    with errors_in_a_line("xarray"):
        from restitution.study import merge as merge_stores

        found = merge_stores(out, parts or [], threads=threads)
        complete = found.finished == found.points
        if not (quiet and complete):
            say(f"{out}: {found}")
    if not complete:
        raise typer.Exit(1)


def _shard(text: str) -> tuple[int, int]:
    number, _, total = text.partition("/")
    try:
        return int(number), int(total)
    except ValueError:
        raise ValueError(f"shard = {text!r}: must be I/N, as 3/64") from None
