"""Memory and threads that a process may not have, and Ctrl-C: errors that name what was asked for."""

import json
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import restitution as rs
from reference.command import SMALL, Command, Program

if sys.platform != "linux":
    pytest.skip("limits of a process, and /proc", allow_module_level=True)

import resource

SETUP = """
import json, mmap, os, resource, signal, sys, threading, time
import numpy as np
import restitution as rs
body = rs.Dumbbell(radius=3e-3, separation=3e-4)
law = rs.TangentialRestitution(normal=0.98)
rs.simulate(body, law, particles=2, impacts=2)
bins = {"velocity_bins": np.linspace(0, 1.2, 13), "restitution_bins": np.linspace(-1, 3, 41)}
rs.statistics(body, law, particles=2, impacts=2, **bins)
def told(call, *args, **options):
    try:
        call(*args, **options)
        print(json.dumps(["done", ""]))
    except Exception as error:
        print(json.dumps([type(error).__name__, str(error)]))
"""


def run(code: str, **environment: str) -> list[Any]:
    """Run code in a process of its own; give what it printed, line by line."""
    return [json.loads(line) for line in Program(SETUP + code, **environment).said().splitlines()]


def test_memory_that_is_not_there() -> None:
    """Under a limit on the address space: refused beforehand, naming what was asked for; the rest goes on."""
    found = run("""
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 2**29, resource.RLIM_INFINITY))
told(rs.simulate, body, law, particles=10_000, impacts=1000)
wide = bins | {"restitution_bins": np.linspace(-1, 3, 10**6), "velocity_bins": np.linspace(0, 1, 101)}
told(rs.statistics, body, law, threads=1, **wide)
told(rs.simulate, body, law, particles=100, impacts=100)
from restitution._internal import resources
from restitution.drop import statistics
resources.available_memory = statistics.available_memory = lambda: 2**60
told(rs.simulate, body, law, particles=10**6, impacts=1000)
told(rs.statistics, body, law, threads=1, **wide)
told(rs.simulate, body, law, particles=100, impacts=100)
""")
    refused, bins, done, failed, bins_failed, again = found
    assert (refused[0], bins[0]) == ("TooLargeError", "TooLargeError")
    assert refused[1].startswith("particles * impacts = 10000000: must be at most ")
    assert bins[1].startswith("velocity_bins, restitution_bins, fraction_bins: ")
    assert (failed[0], bins_failed[0]) == ("MemoryError", "MemoryError")
    assert failed[1].startswith("particles * impacts: 8.000 GB more are needed")
    assert bins_failed[1].startswith("velocity_bins or impacts, times restitution_bins and fraction_bins: ")
    assert done == again == ["done", ""]


def test_a_file_that_no_memory_holds(tmp_path: Path) -> None:
    """It is named, with what it takes, before it is read."""
    found = run(f"""
from restitution._internal import resources as _resources
from restitution._internal.datasets import load
from pathlib import Path
data = rs.simulate(body, law, particles=10, impacts=10)
data.to_netcdf("{tmp_path}/run.nc")
told(load, Path("{tmp_path}/run.nc"))
_resources.available_memory = lambda: 4000
told(load, Path("{tmp_path}/run.nc"))
print(data.nbytes)
""")
    assert found[0] == ["done", ""]
    took = f"takes {found[2] / 1e6:.0f} MB of memory, and this process can have 0 MB"
    assert found[1] == ["MemoryError", f"{tmp_path}/run.nc: {took}"]


def test_draws_that_no_memory_holds() -> None:
    found = run("""
dist = rs.FluctuatingRestitution.learn(body, law, particles=200, impacts=400, velocities=[0.2, 0.25, 0.3])
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 2**29, resource.RLIM_INFINITY))
told(dist.rvs, 0.25, size=3 * 10**8)
from restitution._internal import resources
resources.available_memory = lambda: 2**60
told(dist.rvs, 0.25, size=3 * 10**8)
told(dist.rvs, 0.25, size=10**5)
""")
    assert found[0][0] == "TooLargeError"
    assert found[0][1].startswith("size = 300000000: must be at most")
    assert found[1] == ["MemoryError", "size: 2.400 GB more are needed, which this process cannot have"]
    assert found[2] == ["done", ""]


def test_tables_that_no_memory_holds() -> None:
    """A million points of ε_n(v), with less and less room: taken or a MemoryError, never an abort."""
    found = run("""
x, e = np.linspace(0.1, 1, 10**6), np.linspace(0.9, 0.8, 10**6)
rs.Tabulated(v=x[:2], e=e[:2]).compiled
for room in range(4, 200, 32):
    child = os.fork()
    if child == 0:
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + room * 2**20, resource.RLIM_INFINITY))
        try:
            rs.Tabulated(v=x, e=e).compiled
        except MemoryError as error:
            what, _, told = str(error).partition(": ")
            os._exit(1 + (what in ("v", "e") and told.startswith("takes 120 MB of memory, and this ")))
        os._exit(0)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
""")
    assert set(found) == {0, 2}
    assert found == sorted(found, reverse=True)  # with more room it goes better


def test_a_refused_size_is_a_bad_argument_too(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    for kind in (ValueError, MemoryError):
        with pytest.raises(kind, match=r"particles \* impacts = 1000000000000000: must be at most"):
            rs.simulate(body, law, particles=10**9, impacts=10**6)


def test_the_command_line_under_a_limit(tmp_path: Path) -> None:
    """As of `ulimit -v`: a line, and no core dump."""
    text = SMALL.replace("particles = 7", "particles = 10000000").replace("impacts = 11", "impacts = 10")
    (tmp_path / "run.toml").write_text(text, encoding="utf-8")
    limited = partial(resource.setrlimit, resource.RLIMIT_AS, (4_000_000_000, resource.RLIM_INFINITY))
    words = ("simulate", tmp_path / "run.toml", "--out", tmp_path / "run.nc")
    status, _, error = Command(*words, before=limited).finished()
    assert status == 2
    assert error.startswith("error: particles * impacts = 100000000: must be at most")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["run.toml"]


def test_threads_that_the_system_does_not_give() -> None:
    """One thread needs none; more are an error of ours, which `except Exception` catches.

    Statistics count batches of particles one after the other, each of which needs work for two threads.
    """
    found = run("""
if os.geteuid() == 0:
    os.setuid(65534)  # the limit does not bind the superuser
resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))
told(rs.simulate, body, law, particles=1000, impacts=100, threads=1)
told(rs.statistics, body, law, particles=1000, impacts=100, threads=1, **bins)
told(rs.simulate, body, law, particles=1000, impacts=100, threads=4)
told(rs.statistics, body, law, particles=10_000, impacts=100, threads=4, **bins)
signal.setitimer(signal.ITIMER_REAL, 0.3)
def press(*_):
    raise KeyboardInterrupt
signal.signal(signal.SIGALRM, press)
start = time.monotonic()
try:
    rs.simulate(body, law, particles=1_000_000, impacts=100, threads=1)
except rs.SimulationInterrupted as stop:
    print(json.dumps([time.monotonic() - start, stop.data.sizes["particle"]]), flush=True)
os._exit(0)  # nobody may not remove what the superuser has put among the semaphores
""")
    assert found[:2] == [["done", ""], ["done", ""]]
    for kind, text in found[2:4]:
        assert kind == "RuntimeError"
        assert text.startswith("threads = 4: the system gives no more threads (")
        assert text.endswith("; one needs none")
    seconds, particles = found[4]
    assert seconds < 5
    assert 0 < particles < 1_000_000


def test_the_environment_does_not_decide_how_many_threads() -> None:
    """Affinity does, and nothing but the runs' own argument; `build_info` says what is used."""
    [[threads, seconds]] = run(
        """
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
start = time.monotonic()
rs.simulate(body, law, particles=5)
print(json.dumps([rs.build_info()["threads"], time.monotonic() - start]))
""",
        RAYON_NUM_THREADS="2000",
    )
    assert threads == 1
    assert seconds < 5


def test_the_environment_does_not_decide_how_large_stacks_are() -> None:
    """With a stack of a byte every thread of a run would end in a segmentation fault."""
    [found] = run("told(rs.simulate, body, law, particles=500, threads=2)", RUST_MIN_STACK="1")
    assert found == ["done", ""]


def test_few_particles_need_few_threads() -> None:
    """A thousand threads for five particles are one."""
    [most] = run("""
import pathlib
most = 0
def watch(*_):
    global most
    most = max(most, len(list(pathlib.Path("/proc/self/task").iterdir())))
from reference.signals import watched
before = len(list(pathlib.Path("/proc/self/task").iterdir()))
watched(watch)
rs.simulate(body, law, particles=5, threads=1024)
print(most - before)
""")
    assert most <= 1


@pytest.mark.parametrize(
    "call",
    [
        "rs.simulate(body, law, particles=1, impacts=10**8)",
        "rs.simulate(body, rs.TangentialRestitution(normal=0.1), particles=100, impacts=10**6)",
    ],
)
def test_ctrl_c_within_a_second(call: str) -> None:
    """However long the rows are: a second of each of two processors, for a machine may be busy otherwise."""
    [[seconds, kept]] = run(f"""
pressed = []
def press():
    pressed.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(0.5, press).start()
try:
    {call}
except rs.SimulationInterrupted as stop:
    print(json.dumps([time.process_time() - pressed[0], int(stop.data.impacts.sum())]))
""")
    assert seconds < 2.0
    assert kept > 0


@pytest.mark.parametrize(
    "bins",
    [
        (1000, 60_000),
        pytest.param((1000, 200_000), marks=pytest.mark.slow),
        pytest.param((3000, 30_000), marks=pytest.mark.slow),
    ],
)
def test_ctrl_c_in_fine_statistics(bins: tuple[int, int]) -> None:
    """Grids of 10⁸ sites or so, with impacts in parts of each row or in most, add the cost of their pages.

    That is what writing to the pages of such a grid for the first time takes, which is measured at once: it
    depends on the machine, and on the size of its pages. The rest is as long as in
    `test_ctrl_c_within_a_second`.
    """
    [[seconds, touched, kept]] = run(f"""
body = rs.Dumbbell(radius=3e-3, separation=3e-3)
fine = {{
    "velocity_bins": {bins[0]}, "velocity_range": (0, 1.2),
    "restitution_bins": {bins[1]}, "restitution_range": (-1, 3),
}}
pressed = []
def press():
    pressed.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)
threading.Timer(0.5, press).start()
try:
    rs.statistics(body, law, particles=10**7, impacts=100, threads=1, **fine)
except rs.SimulationInterrupted as stop:
    seconds, kept = time.process_time() - pressed[0], stop.data.attrs["all_impacts"]
began = time.process_time()
pages = np.frombuffer(mmap.mmap(-1, {8 * bins[0] * bins[1]}), np.uint8)
pages[::mmap.PAGESIZE] = 1
print(json.dumps([seconds, time.process_time() - began, kept]))
""")
    assert seconds < 2.0 + touched
    assert kept > 0
