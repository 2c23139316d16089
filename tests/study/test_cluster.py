"""Studies on a Dask cluster of processes: the bits of one thread, whoever of the cluster is killed."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TypeAlias

import pytest

from reference.command import Command
from reference.studies import bits, chunks, when, written
from restitution.study import status, sweep

Process: TypeAlias = "subprocess.Popen[bytes]"

# What a worker runs first: each batch takes longer, so that it can be killed at work.
SLOWLY = """
import time
import restitution.study._drive as work
if not hasattr(work, "plain_count"):  # a preload is run twice
    work.plain_count = work.count
def slow_count(*arguments):
    time.sleep(0.05)
    return work.plain_count(*arguments)
work.count = slow_count
"""


# A scheduler that does not answer is waited for as long as Dask is told, half a minute unless told.
IMPATIENT = "import os; os.environ['DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT'] = '{}s'"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The bits of the study of 12 points on threads, undisturbed."""
    folder = tmp_path_factory.mktemp("undisturbed")
    sweep(written(folder, normals=4), folder / "study.zarr")
    return bits(folder / "study.zarr")


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[str, Process, list[Process]]]:
    """Start a scheduler and workers as processes of their own, and tell where the scheduler is."""
    file, preload = folder / "scheduler.json", folder / "slowly.py"
    preload.write_text(SLOWLY)

    def start(*words: object) -> Process:
        command = [sys.executable, "-m", "dask", *map(str, words), "--scheduler-file", str(file)]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)

    here = ("--host", "127.0.0.1", "--no-dashboard")
    scheduler = start("scheduler", *here, "--port", 0)
    alone = ("--nthreads", 1, "--no-nanny", "--death-timeout", 60)
    crew = [start("worker", *here, *alone, "--preload", preload) for _ in range(workers)]
    try:
        when(file.exists, None)
        yield str(file), scheduler, crew
    finally:
        for process in (*crew, scheduler):
            process.kill()
            process.wait()


def test_a_client_of_a_local_cluster(whole: dict[str, str], tmp_path: Path) -> None:
    """Two worker processes of two threads each."""
    import dask
    from distributed import Client, LocalCluster

    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    with (
        dask.config.set({"distributed.worker.multiprocessing-method": "forkserver"}),
        LocalCluster(  # type: ignore[no-untyped-call]
            n_workers=2, threads_per_worker=2, processes=True, dashboard_address=":0"
        ) as local,
        Client(local, set_as_default=False) as client,  # type: ignore[no-untyped-call]
    ):
        found = sweep(study, store, client)
        assert (found["status"] == 1).all()
        with pytest.raises(ValueError, match=r"threads = 2: is for this machine"):
            sweep(study, store, client, threads=2)
    assert bits(store) == whole
    with pytest.raises(ValueError, match=r"client = 'me': must be a dask\.distributed\.Client"):
        sweep(study, store, "me")


@pytest.mark.slow
def test_workers_and_the_scheduler_are_killed(whole: dict[str, str], tmp_path: Path) -> None:
    """A worker first, which the other makes up for; then the scheduler, and the command says how to go on."""
    if sys.platform == "win32":
        pytest.skip("nothing is killed by a signal")
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    with cluster(tmp_path, 2) as (address, scheduler, workers):
        driver = Command(
            "sweep",
            study,
            "--out",
            store,
            "--scheduler",
            address,
            before=partial(exec, IMPATIENT.format(5), {}),
        )
        when(lambda: len(chunks(store)) >= 2, driver)
        os.kill(workers[0].pid, signal.SIGKILL)
        when(lambda: len(chunks(store)) >= 5, driver)
        os.kill(scheduler.pid, signal.SIGKILL)
        code, _, error = driver.finished(120.0)
        assert code == 1, error
        assert "the same command continues" in error
    assert 5 <= len(chunks(store)) < 12
    (tmp_path / "scheduler.json").unlink()
    with cluster(tmp_path, 1) as (address, _, _):
        code, out, error = Command("sweep", study, "--out", store, "--scheduler", address).finished()
        assert code == 0, error
        assert "12 of 12 points are finished" in out
    assert bits(store) == whole
    assert status(store).finished == 12


def test_a_scheduler_that_is_not_there(tmp_path: Path) -> None:
    nobody = ("--scheduler", "tcp://127.0.0.1:9")
    driver = Command(
        "sweep",
        written(tmp_path),
        "--out",
        tmp_path / "s.zarr",
        *nobody,
        before=partial(exec, IMPATIENT.format(1), {}),
    )
    code, _, error = driver.finished()
    assert code == 1
    assert "no Dask scheduler answers there" in error
