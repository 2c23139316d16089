"""Harmed files of every kind that is read, and tables of every kind, in processes of their own."""

import argparse
import faulthandler
import os
import select
import shutil
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Callable
from itertools import count
from pathlib import Path

import restitution as rs
from manual import reading, tables
from reference import measuring
from reference.calls import good
from reference.contract import SLOW


def apart(act: Callable[[], str | None]) -> str | None:
    """Act in a process of its own, which may die or hang; give what it finds."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        faulthandler.enable()
        try:
            os.write(writer, (act() or "").encode()[:60_000])
            os._exit(0)
        except BaseException as error:
            os.write(writer, f"the trial itself: {type(error).__name__}: {error}".encode()[:60_000])
        os._exit(0)
    os.close(writer)
    try:
        if not select.select([reader], [], [], 2 * SLOW)[0]:
            os.kill(child, signal.SIGABRT)  # faulthandler then says where
            os.waitpid(child, 0)
            return f"takes more than {2 * SLOW:.0f} s"
        told = os.read(reader, 65_536).decode(errors="replace")
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        return told or (f"ends with status {status}" if status else None)
    finally:
        os.close(reader)


def try_one(names: tuple[str, ...], seed: int) -> str | None:
    """Read one harmed file of a kind, or give one table to a function."""
    if len(names) == 2:
        return apart(lambda: tables.trial(names[0], names[1], seed))
    place = Path(tempfile.mkdtemp(prefix="fuzz-"))
    try:
        return apart(lambda: reading.trial(names[0], seed, place))
    finally:
        shutil.rmtree(place, ignore_errors=True)


def main() -> int:
    """Tell what breaks the contract."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--seconds", type=float, default=0.0, help="go on for so long, at least once through all"
    )
    parser.add_argument("--rounds", type=int, default=1, help="go through all so many times at least")
    parser.add_argument(
        "--every", type=int, default=1, help="of so many one, beginning with the first seed's"
    )
    parser.add_argument("--seed", type=int, default=0, help="the first")
    parser.add_argument("only", nargs="*", help="a kind of file, a function or its argument")
    asked = parser.parse_args()
    warnings.filterwarnings("ignore", category=rs.EnergyWarning)
    # The allocator of pyarrow has a thread, which stands a fork; Python tells of any from 3.12 on.
    warnings.filterwarnings("ignore", "This process .* is multi-threaded", DeprecationWarning)
    places = [(kind,) for kind in reading.KINDS] + list(tables.ARGUMENTS)
    chosen = [names for names in places if all(word in names for word in asked.only)]
    chosen = chosen[asked.seed % asked.every :: asked.every]
    good()  # once, before any process is forked; but Zarr has threads, which a fork does not copy
    apart(lambda: measuring.store().name and None)
    started, trials, failures = time.monotonic(), 0, 0
    for seed in count(asked.seed):
        if seed >= asked.seed + asked.rounds and time.monotonic() > started + asked.seconds:
            break
        for names in chosen:
            trials += 1
            found = try_one(names, seed)
            if found:
                failures += 1
                print(f"{' '.join(names)}, seed {seed}: {found}", flush=True)
    print(f"{trials} trials, {failures} break the contract")
    return min(failures, 1)


# To be run with OPENBLAS_NUM_THREADS=1: a process with threads had better not fork.
if __name__ == "__main__":
    sys.exit(main())
