"""Parts that the commands share: options, exit statuses, and how errors and warnings are shown."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperCommand, TyperGroup

from restitution.cli._process import ending, is_terminal, tell

FAILED, BAD_INPUT, WARNED, INTERRUPTED = 1, 2, 3, 130
"""Exit statuses: files or numbers in trouble; input that is refused; doubtful accuracy; Ctrl-C.

Other signals that end a command give 128 + their number.
"""

_RUNNING = ContextVar("command", default="restitution")
"""The command that runs, as it is typed."""

_LONGEST = 1000
"""Letters of a line of an error, which the name of a file can make longer than a terminal holds."""

RunFile = Annotated[
    Path,
    typer.Argument(
        metavar="RUN.toml",
        help="Parameters of the run; [bold]restitution template[/bold] prints them.",
    ),
]
Out = Annotated[
    Path,
    typer.Option("--out", "-o", metavar="FILE", help="The netCDF file to write, completely or not at all."),
]
Folder = Annotated[
    Path,
    typer.Option("--out", "-o", metavar="DIR", help="The directory to write, completely or not at all."),
]
Threads = Annotated[
    int | None,
    typer.Option(
        "--threads",
        "-j",
        metavar="N",
        help="Number of threads; if not given, one for each core. The result does not depend on it.",
    ),
]
Quiet = Annotated[
    bool,
    typer.Option("--quiet", "-q", help="Show no progress and no summary; errors and warnings remain."),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace files that exist.")]


class _Flags:
    """Shows flags in the help without a type: they take no value."""

    def get_params(self, ctx: Any) -> list[Any]:
        params: list[Any] = super().get_params(ctx)  # type: ignore[misc]
        for param in params:
            if getattr(param, "is_flag", False):
                param.metavar = ""
        return params


class Command(_Flags, TyperCommand):
    """A command."""

    def invoke(self, ctx: Any) -> Any:
        """Run it, and keep its name for errors that have no words."""
        _RUNNING.set(ctx.command_path)
        return super().invoke(ctx)


class Group(_Flags, TyperGroup):
    """A group of commands."""


def progress(quiet: bool) -> bool:
    """Test whether a progress bar is to be shown."""
    return not quiet and is_terminal(sys.stderr)


@contextmanager
def errors_in_a_line(*libraries: str) -> Iterator[None]:
    """Show expected errors as one line each instead of a traceback; signals end the block in the same way.

    The libraries are loaded first: the work would be lost if what writes its result could not be loaded.
    """
    with ending() as came:
        try:
            for name in libraries:
                import_module(name)
            # Of the files that Zarr reads at once the first that fails ends the command, in a line.
            logging.getLogger("asyncio").setLevel(logging.CRITICAL)
            yield
        except Kept as kept:
            raise typer.Exit(128 + (came + kept.late)[-1]) from None
        except KeyboardInterrupt:
            _interrupted(came)
        except Exception as error:
            # Libraries that are interrupted while they are imported make errors of another kind of it.
            if came and not isinstance(error, OSError | MemoryError):
                _interrupted(came)
            _failed(error)


def _interrupted(came: list[int]) -> NoReturn:
    tell("interrupted")
    raise typer.Exit(128 + came[-1] if came else INTERRUPTED) from None


def _failed(error: Exception) -> NoReturn:
    match error:
        case ValueError():
            fail(str(error), BAD_INPUT)
        case FileExistsError():
            text = str(error.strerror).partition(";")[0]  # the rest is for a call
            fail(f"{_named(error.filename)}: {text}; --overwrite replaces it", FAILED)
        case OSError():
            fail(f"{_named(error.filename)}: {error.strerror}" if error.filename else str(error), FAILED)
        case RuntimeError() | MemoryError() | ImportError():  # NumericalError is a RuntimeError
            fail(str(error) or f"{_RUNNING.get()}: out of memory", FAILED)
    raise error


def _named(path: object) -> str:
    """Write the name of a file in a line, also one that has several."""
    return "\\n".join(str(path).splitlines())


class Kept(KeyboardInterrupt):
    """A command was interrupted, has said so, and has kept what was finished."""

    def __init__(self, late: list[int]) -> None:
        super().__init__()
        self.late = late


def fail(message: str, code: int) -> NoReturn:
    """Print the error and exit."""
    for line in message.splitlines():
        long = len(line) > _LONGEST
        tell(f"error: {line[: _LONGEST // 2]} ... {line[-_LONGEST // 2 :]}" if long else f"error: {line}")
    raise typer.Exit(code)
