"""Worker processes of a command: none, on this machine, or on a cluster."""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING, Annotated

from conveyor.arguments.limits import MOST_WORKERS
from conveyor.cli.application import option
from conveyor.errors import ConveyorError, InputError

if TYPE_CHECKING:
    from concurrent.futures import Executor

LOCAL = "local"
"""Scheduler address of a cluster on this machine only."""
Workers = Annotated[int, option("Processes, or workers of the cluster.", "N", min=1, max=MOST_WORKERS)]
Scheduler = Annotated[
    str | None,
    option("Of a Dask cluster (package distributed), or local for one that ends with the command.", "ADDRESS"),
]


def preload_workers(scheduler: str | None, workers: int) -> None:
    """Start the fork server, which imports the program while the command reads its files."""
    if scheduler is None and workers > 1 and _start_method() == "forkserver":
        from multiprocessing import forkserver

        forkserver.set_forkserver_preload(["conveyor.studies.worker_imports"])
        forkserver.ensure_running()


def _start_method() -> str:
    """Start method of processes: safe with threads; fork server where available, which imports only once."""
    from multiprocessing import get_all_start_methods

    return "forkserver" if "forkserver" in get_all_start_methods() else "spawn"


def _exit_with_parent() -> None:
    """End this process when its parent ends."""
    from multiprocessing import parent_process
    from threading import Thread

    parent = parent_process()
    if parent is not None:

        def watch() -> None:
            parent.join()
            os._exit(1)

        Thread(target=watch, daemon=True).start()


@contextmanager
def _report_broken_pipes() -> Iterator[None]:
    """Get errors from pipes to lost workers; SIGPIPE would end this process silently."""
    if not hasattr(signal, "SIGPIPE"):
        yield
        return
    before = signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGPIPE, before)


@contextmanager
def open_executor(scheduler: str | None, workers: int) -> Iterator[Executor | None]:
    """Executor of local processes or a cluster; None for one process."""
    if scheduler is None:
        from concurrent.futures import ProcessPoolExecutor
        from multiprocessing import get_context

        if workers == 1:
            yield None
            return
        context = get_context(_start_method())
        with (
            _report_broken_pipes(),
            ProcessPoolExecutor(workers, mp_context=context, initializer=_exit_with_parent) as pool,
        ):
            yield pool
        return
    try:
        from distributed import Client, KilledWorker, LocalCluster
    except ImportError:
        raise InputError('--scheduler: needs distributed (pip install "conveyor[cluster]")') from None
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)  # a lost scheduler is reported below
    try:
        alone = scheduler == LOCAL
        cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) if alone else None
        client = Client(scheduler if cluster is None else cluster, timeout="10s")
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler: {scheduler}: no cluster answers ({error})") from None
    with _report_broken_pipes(), nullcontext() if cluster is None else cluster, client:
        try:
            yield client.get_executor()
        except KilledWorker as error:
            raise ConveyorError(f"{error}; what is done is kept: run it again to go on") from None
