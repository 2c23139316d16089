"""Commands in hostile environments: what must hold of their processes, and of what they leave."""

import contextlib
import os
import random
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from reference.commands import COMMANDS, inputs
from reference.contract import SLOW
from reference.environments import ENVIRONMENTS, Environment, become_ordinary, full_disk

ENDLESS = {"explore"}
STATUSES = (0, 1, 2, 3)
_START = "import os; from restitution.cli import main; os.write(BEGUN, b'.'); os.close(BEGUN); main()"


@dataclass
class Ended:
    """How a process ended."""

    status: int
    said: str
    seconds: float


@contextlib.contextmanager
def place(environment: str) -> Iterator[Path | None]:
    """Make an empty folder to work in, full where the disk is to be; None where that cannot be made."""
    top = Path(tempfile.mkdtemp(prefix="place-"))
    top.chmod(0o755)
    folder = top / "work"
    folder.mkdir()
    folder.chmod(0o777)
    try:
        with contextlib.ExitStack() as stack:
            if environment == "a full disk" and not stack.enter_context(full_disk(folder)):
                yield None
                return
            yield folder
    finally:
        folder.chmod(0o777)
        shutil.rmtree(top, ignore_errors=True)


@cache
def imported() -> int:
    """Address space of a process that has imported what commands import."""
    code = "import xarray, netCDF4, scipy.stats, matplotlib.figure, restitution.cli, typer, tqdm\n"
    code += "print(open('/proc/self/statm').read().split()[0])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return int(done.stdout) * os.sysconf("SC_PAGESIZE")


def forked(act: Callable[[int], object], environment: Environment, delay: float) -> Ended:
    """Run `act` in a process of its own, which says when it has begun, and send it its signals."""
    begun, say = os.pipe()
    heard, speak = os.pipe()
    started = time.monotonic()
    child = os.fork()
    if child == 0:
        code = 128 + signal.SIGINT  # of a KeyboardInterrupt, wherever a second one comes
        try:
            os.close(begun)
            os.close(heard)
            os.set_inheritable(say, True)
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            os.dup2(speak, 1)
            os.dup2(speak, 2)
            os.close(speak)
            act(say)
        except Exception:
            code = 99
            with contextlib.suppress(Exception):
                traceback.print_exc()
                sys.stderr.flush()
        finally:
            os._exit(code)
    os.close(say)
    os.close(speak)
    os.set_blocking(heard, False)
    said = b""
    select.select([begun], [], [], SLOW)
    os.close(begun)
    for number in environment.signals:
        time.sleep(delay)
        if os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            os.kill(child, number)
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        with contextlib.suppress(BlockingIOError):
            said += os.read(heard, 100_000)
        seconds = time.monotonic() - started
        if done:
            code = os.waitstatus_to_exitcode(status)
            os.close(heard)
            return Ended(code, said.decode("utf-8", errors="replace"), seconds)
        if seconds > 4 * SLOW:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            os.close(heard)
            return Ended(-signal.SIGKILL, "hung", seconds)
        time.sleep(0.005)


def command(name: str, surroundings: str, draw: random.Random) -> str | None:
    """Run a command in an environment; say what is wrong with what happens, if anything is."""
    environment = ENVIRONMENTS[surroundings]
    words, files = COMMANDS[name]
    base = imported()
    if name in ENDLESS and not environment.signals:
        environment = Environment(**(vars(environment) | {"signals": (signal.SIGINT,)}))
    with place(surroundings) as folder:
        if folder is None:
            return None
        before = _filled(folder, words)
        environment.prepare(folder)

        def act(say: int) -> None:
            os.chdir(folder)
            if environment.ordinary:
                become_ordinary()
            # Of the files that the new program does not have none counts for it.
            os.closerange(3, say)
            os.closerange(say + 1, 1000)
            environment.enter(base)
            if os.environ.get("PATH") is None:
                os.environ["PATH"] = "/usr/bin:/bin"
            code = _START.replace("BEGUN", str(say))
            os.execv(sys.executable, [sys.executable, "-c", code, *words.split()])

        ended = forked(act, environment, draw.uniform(0.0, 1.5))
        found = _judged(ended, environment, {*map(int, environment.signals)})
        after = {file.name for file in folder.iterdir()}
        if found is None:
            found = _left(ended, before, after, set(files.split()), 1 in environment.lost)
        return found and f"{found}; status {ended.status}: {ended.said[-1500:]}"


def _filled(folder: Path, words: str) -> set[str]:
    """Put what a command reads into the folder; where the disk is full, a link does."""
    for word in words.split():
        source = inputs() / word
        if source.is_file():
            (folder / word).symlink_to(source)
        elif source.is_dir():
            with contextlib.suppress(OSError, shutil.Error):
                shutil.copytree(source, folder / word)
            for file in (folder / word).rglob("*"):
                file.chmod(0o777 if file.is_dir() else 0o666)
    return {file.name for file in folder.iterdir()}


def _judged(ended: Ended, environment: Environment, signals: set[int]) -> str | None:
    if ended.said == "hung" or ended.seconds > 4 * SLOW:
        return f"took {ended.seconds:.0f} s"
    # A signal may meet a process that has ended its work and handles signals no more; a shell gives the same.
    killed = {-number for number in environment.signals}
    if ended.status not in {*STATUSES, *(128 + number for number in signals), *killed}:
        return "ends otherwise"
    # Where a signal meets a callback of Python's own, of an import say, Python prints it and goes on:
    # a signal is not promised to be heard at every line.
    if "Traceback" in ended.said and not (signals and "Exception ignored in" in ended.said):
        return "shows a traceback"
    # Help that nobody reads ends as other programs' does.
    if ended.status in (1, 2) and not {1, 2} & set(environment.lost) and "rror" not in ended.said:
        return "does not say why"
    return None


def _left(ended: Ended, before: set[str], after: set[str], files: set[str], mute: bool) -> str | None:
    if strange := after - before - files:
        return f"leaves {', '.join(sorted(strange))}"
    if ended.status in (0, 3) and not files <= after:
        return f"writes no {', '.join(sorted(files - after))}"
    kept = files & (after - before)
    # What could not be said of files that are there is an error; a study keeps what was computed.
    if ended.status in (1, 2) and kept and not mute and not kept & {"study.zarr"}:
        return f"fails, and writes {', '.join(sorted(kept))}"
    return None
