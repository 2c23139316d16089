"""The command line; nothing heavy is imported before a command needs it, so that help comes at once."""

import os
import sys
from collections.abc import Callable
from typing import Annotated

import typer

from restitution.cli import _explore, _fit, _free_flight, _listen, _pages, _runs, _sweep, _template
from restitution.cli._common import BAD_INPUT, FAILED, INTERRUPTED, WARNED, Command, Group
from restitution.cli._process import leaving, open_missing, say, tell

__all__ = ["BAD_INPUT", "FAILED", "INTERRUPTED", "WARNED", "app", "main"]

app = typer.Typer(
    cls=Group,
    help="The coefficient of restitution as a distribution, not a number: "
    "non-spherical bodies bouncing on a plane.",
    epilog="Examples: [bold]restitution template > run.toml[/bold], "
    "[bold]restitution simulate run.toml --out run.nc[/bold].\n\n"
    "Exit status: 0 done, 1 a file or the numerics failed, 2 invalid input, "
    "3 done, with a warning about accuracy, 130 interrupted.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """Run the command line."""
    # No command multiplies large matrices; OpenBLAS interrupts a process that it cannot make a thread in.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    open_missing()
    with leaving():
        try:
            app(prog_name="restitution")
        except OSError as error:  # of standard output, as where the disk is full
            tell(f"error: {error.filename or 'standard output'}: {error.strerror}")
            raise SystemExit(FAILED) from None
        finally:
            # The command has said what there is to say: tasks of zarr that end with the interpreter, as where
            # no more files can be opened, are not told of.
            sys.unraisablehook = lambda _: None


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        say(f"restitution {version('restitution')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    pass


_EXAMPLES: dict[Callable[..., None], str] = {
    _template.template: "restitution template > run.toml",
    _runs.simulate: "restitution simulate run.toml --out run.nc",
    _runs.statistics: "restitution statistics run.toml --out statistics.nc",
    _runs.compare: "restitution compare study.toml --out compared.nc",
    _runs.distribution: "restitution distribution run.toml --out dist.nc --header dist.h",
    _free_flight.pair: "restitution pair pair.toml --out pairs.nc",
    _free_flight.gas: "restitution gas gas.toml --out gas.nc",
    _fit.fit: "restitution fit run.nc --velocity 0.38 0.42",
    _listen.listen: "restitution listen ball.wav --diameter 0.040 --mass 2.7e-3 --out ball.html",
    _pages.laws: "restitution laws --out laws",
    _pages.paper: "restitution paper --out paper",
    _pages.rough: "restitution rough --out rough",
    _pages.gas_figures: "restitution gas-figures --out gas",
    _explore.explore: "restitution explore run.toml",
}
for command, example in _EXAMPLES.items():
    app.command(cls=Command, epilog=f"Example: [bold]{example}[/bold]")(command)
app.add_typer(_sweep.app, name="sweep")
