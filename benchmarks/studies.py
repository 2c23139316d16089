"""The cost of a parameter study besides its impacts: on a cluster, with ten thousand points, when it is read.

`python -m benchmarks --rows studies` prints all of it. Overhead is CPU time of the workers that is
not spent in the call that drops the particles, so that other work on the machine is not taken for overhead.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Generator, Iterator
from importlib import import_module
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np

import restitution as rs
from restitution.study import study_of
from restitution.study._drive import Driver, Progress
from restitution.study._sweep import opened
from restitution.study._tables import TASK
from restitution.study.engines import engine

POINTS = 10_000
TASK_SECONDS, TASKS, SMALL = 1.0, 48, 200
OVERHEAD, OPENING = 0.05, 1.0
"""Largest shares and times that are allowed: of the distributed path, and to open and slice a store, in s."""
FAR = 1e12
"""Impacts whose cost is worked out."""


def tables(particles: int, impacts: int, sweep: dict[str, Any]) -> dict[str, Any]:
    return {
        "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
        "law": rs.TangentialRestitution(normal=0.98),
        "run": {"particles": particles, "impacts": impacts},
        "effort": {"batches": 4},
        "sweep": sweep,
        "statistics": {
            "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 22},
            "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 100},
        },
    }


def report() -> Iterator[str]:
    """Give the lines of docs/performance.md."""
    with tempfile.TemporaryDirectory() as folder:
        cost = yield from cluster(Path(folder), TASKS, TASK_SECONDS)
        yield from many(Path(folder), POINTS)
        yield from far(cost)


def cluster(folder: Path, tasks: int, seconds: float) -> Generator[str, None, float]:
    """Run tasks of so many seconds on two worker processes; give nanoseconds an impact, too."""
    from distributed import Client, LocalCluster

    impacts = 400
    particles = min(round(seconds / _second_each(impacts)), TASK // impacts)  # else a point is two tasks
    study = study_of(tables(particles, impacts, {"run.seed": list(range(1, tasks + 1))}))
    with (
        LocalCluster(  # type: ignore[no-untyped-call]
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as local,
        Client(local, set_as_default=False) as client,  # type: ignore[no-untyped-call]
    ):
        client.run(_watch)
        # A small study first: imports, and the first connection, belong to no task.
        rs.sweep(tables(32, 10, {"run.seed": [1, 2, 3, 4]}), folder / "warm.zarr", client)
        client.run(_taken)
        start = perf_counter()
        rs.sweep(study, folder / "cluster.zarr", client)
        elapsed = perf_counter() - start
        busy, tasks_cpu, all_cpu = np.sum(list(client.run(_taken).values()), axis=0).tolist()
        small, own = tables(32, 10, {"run.seed": list(range(1, SMALL + 1))}), process_time()
        rs.sweep(small, folder / "small.zarr", client)
        driver = (process_time() - own) / SMALL
    overhead = all_cpu / tasks_cpu - 1
    yield (
        f"cluster  {tasks} tasks of {tasks_cpu / tasks:.2f} s of CPU on two worker processes: CPU of the "
        f"workers beside them {100 * overhead:.1f} %{_verdict(overhead, OVERHEAD, '5 %')}"
    )
    yield (
        f"         by the clock, {elapsed:.1f} s from the start: {100 * busy / 2 / elapsed:.0f} % "
        f"of both workers' time in tasks; driver and scheduler {1e3 * driver:.0f} ms of CPU a task"
    )
    return float(1e9 * tasks_cpu / (tasks * particles * impacts))


def many(folder: Path, points: int) -> Iterator[str]:
    """Have many points in one store, of next to nothing each, and look whether the last take longer."""
    side = round(points**0.5)
    study = study_of(
        tables(
            32,
            20,
            {
                "body.separation": {"from": 1e-5, "to": 1e-3, "points": side, "scale": "log"},
                "law.normal": {"from": 0.5, "to": 0.98, "points": points // side},
            },
        )
    )
    path, ended = folder / "many.zarr", [(0.0, 0.0, 0)]

    def tell(progress: Progress) -> None:
        if progress.ended > ended[-1][2]:
            ended.append((perf_counter() - start, process_time() - own, progress.ended))

    start, own = perf_counter(), process_time()
    store, template = opened(path, study)
    with engine(None, None) as threads:
        Driver(study, store, threads, template, range(study.design.points), tell=tell).run(writes=True)
    clock, cpu, number = np.array(ended).T
    share = number[-1] / 5
    first, last = (
        (np.interp(n + share, number, cpu) - np.interp(n, number, cpu)) / share
        for n in (share / 5, number[-1] - share)
    )
    yield (
        f"points   {study.design.points} in one store: {clock[-1]:.0f} s, "
        f"{1e3 * cpu[-1] / number[-1]:.1f} ms of CPU each; "
        f"{1e3 * first:.1f} ms in the first fifth, {1e3 * last:.1f} ms in the last"
    )
    size = sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
    files = sum(1 for file in path.rglob("*") if file.is_file())
    yield f"         {size / 1e6:.0f} MB in {files} files, of which results {_results(path) / 1e6:.0f} MB"
    found = [_opened(path) for _ in range(5)]
    opening, slicing = np.median([one["open"] for one in found]), np.median([one["slice"] for one in found])
    both = opening + slicing
    yield (
        f"reading  open {opening:.3f} s, σ(v) along a row of points {slicing:.3f} s; together {both:.2f} s"
        f"{_verdict(float(both), OPENING, '1 s')}"
    )
    start = perf_counter()
    rs.study.status(path)
    looked = perf_counter() - start
    start = perf_counter()
    rs.sweep(study, path)
    yield (
        f"again    --status {looked:.2f} s; the same command on the finished store, every chunk checked: "
        f"{perf_counter() - start:.0f} s"
    )
    shutil.rmtree(path)


def far(cost: float) -> Iterator[str]:
    """Do the arithmetic of a large study."""
    hours = FAR * cost * 1e-9 / 3600
    tasks = FAR / 1e8
    yield (
        f"far      {FAR:.0g} impacts at {cost:.1f} ns: {hours:.0f} core hours; in tasks of 10⁸ impacts "
        f"({0.1 * cost:.2g} s) {tasks:.0f} tasks; on 1000 cores {60 * hours / 1000:.0f} min"
    )


def _second_each(impacts: int) -> float:
    """Give the CPU time of a particle of the job, in seconds."""
    bins = {"velocity_bins": np.linspace(0, 1.1, 23), "restitution_bins": np.linspace(-1, 3, 101)}
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    times = []
    for _ in range(3):
        start = process_time()
        rs.statistics(body, law, particles=20_000, impacts=impacts, threads=1, **bins)  # type: ignore[arg-type]
        times.append((process_time() - start) / 20_000)
    return min(times)


def _watch() -> None:
    """In a worker: keep the time that is spent dropping particles."""
    work: Any = import_module("restitution.study._drive")
    count, spent = work.count, [0.0, 0.0, process_time()]

    def timed(*arguments: Any) -> Any:
        start, own = perf_counter(), process_time()
        found = count(*arguments)
        spent[0] += perf_counter() - start
        spent[1] += process_time() - own
        return found

    work.count = timed
    work.spent = spent


def _taken() -> tuple[float, float, float]:
    """In a worker: give that time, by the clock and of CPU, and the CPU time of all; and begin anew."""
    work: Any = import_module("restitution.study._drive")
    found = work.spent[0], work.spent[1], process_time() - work.spent[2]
    work.spent[:] = 0.0, 0.0, process_time()
    return found


_READ = """
import json, sys, time
import xarray, zarr
xarray.DataArray([1.0]).to_dataset(name="warm")
start = time.perf_counter()
found = xarray.open_zarr(sys.argv[1], chunks=None)
opened = time.perf_counter()
found["std_restitution"].sel(normal=0.9, velocity=0.5, method="nearest").load()
found["density"].sel(normal=0.9, separation=1e-4, method="nearest").load()
print(json.dumps({"open": opened - start, "slice": time.perf_counter() - opened}))
"""


def _opened(path: Path) -> dict[str, float]:
    """Open and slice a store in a process of its own; imports are over before the clock starts."""
    done = subprocess.run(
        [sys.executable, "-c", _READ, str(path)], check=True, capture_output=True, text=True
    )
    found: dict[str, float] = json.loads(done.stdout)
    return found


def _results(path: Path) -> int:
    return sum(
        file.stat().st_size
        for file in path.rglob("*")
        if file.is_file() and (path / "tasks") not in file.parents
    )


def _verdict(value: float, most: float, text: str) -> str:
    return f" (<= {text})" + (" MISSED" if value > most else "")
