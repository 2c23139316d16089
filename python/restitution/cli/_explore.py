"""`restitution explore`: the page with the engine in it."""

from pathlib import Path
from typing import Annotated

import typer

from restitution.cli._common import Quiet, errors_in_a_line
from restitution.cli._process import say


def explore(
    run: Annotated[
        Path | None, typer.Argument(metavar="RUN.toml", help="Parameters, as for [bold]simulate[/bold].")
    ] = None,
    port: Annotated[int, typer.Option(metavar="N", help="Port on this machine; 0 takes a free one.")] = 0,
    browser: Annotated[bool, typer.Option(help="Open the browser.")] = True,
    quiet: Quiet = False,
) -> None:
    """Show the bouncing body in the browser, with its restitution impact by impact.

    Serves one page to this machine alone, until Ctrl-C. The engine runs in the
    page, and gives the same numbers as simulate, to the last bit.
    """
    with errors_in_a_line("xarray"):
        from restitution.explorer import link, serve

        fragment = ""
        if run is not None:
            from restitution.drop.toml import read

            fragment = link(read(run))
        serve(fragment, port=port, browse=browser, tell=(lambda _: None) if quiet else say)
