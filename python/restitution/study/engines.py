"""Engines that run tasks: threads of this machine, or workers of a Dask cluster."""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any

from restitution import _core
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.resources import checked_threads


@dataclass(frozen=True)
class Engine:
    """An executor; how many calls it runs at a time, now; and the event, if any, that asks them to stop."""

    executor: Executor
    width: Callable[[], int]
    event: threading.Event | None = None

    @property
    def room(self) -> int:
        """Return how many calls should be under way: enough for no worker to wait for the next one."""
        return 2 * max(1, self.width()) + 2


@contextmanager
def engine(client: Any, threads: int | None) -> Iterator[Engine]:
    """Open the engine of a Dask client or, without one, of threads of this machine: one for each core."""
    if client is None:
        number = checked_threads(threads) or int(_core.build_info()["threads"])
        stop = threading.Event()
        with ThreadPoolExecutor(number, thread_name_prefix="restitution-sweep") as pool:
            try:
                yield Engine(pool, lambda: number, stop)
            except BaseException:
                stop.set()
                pool.shutdown(wait=True, cancel_futures=True)
                raise
        return
    if threads is not None:
        raise ValueError(f"threads = {threads!r}: is for this machine; with a client its workers decide")
    if not hasattr(client, "get_executor"):
        raise ParameterError(wrong("client", client, "a dask.distributed.Client or None"))
    executor = client.get_executor(pure=False)
    try:
        yield Engine(executor, lambda: sum(client.nthreads().values()))
    except Exception as error:
        if client.status == "running":
            raise
        text = "the scheduler is gone; what is finished is in the store, and the same command continues"
        raise RuntimeError(text) from error
    finally:
        with suppress(Exception):  # of a client that is closed
            executor.shutdown(wait=False)


@contextmanager
def client_at(address: str) -> Iterator[Any]:
    """Connect to the scheduler of a Dask cluster, at an address or with its file.

    How long a silent one is waited for is Dask's ``distributed.comm.timeouts.connect``.
    """
    try:
        from distributed import Client
    except ImportError:
        raise ImportError("--scheduler needs dask.distributed: pip install 'restitution[sweep]'") from None
    where = {"scheduler_file" if address.endswith(".json") else "address": address}
    try:
        client: Any = Client(**where, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise OSError(f"scheduler = {address!r}: no Dask scheduler answers there: {error}") from None
    try:
        yield client
    finally:
        client.close(timeout=2)
