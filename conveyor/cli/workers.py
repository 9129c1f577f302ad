"""Where the work of a command is done: here, in processes of this machine, or on a cluster."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.errors import ConveyorError, InputError

if TYPE_CHECKING:
    from concurrent.futures import Executor

Workers = Annotated[
    int, typer.Option(metavar="N", help="Processes, or workers of the cluster.", min=1, max=1024)
]
Scheduler = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Of a Dask cluster (package distributed); else this machine."),
]


@contextmanager
def executor_of(scheduler: str | None, workers: int) -> Iterator[Executor | None]:
    """Processes of this machine, or a cluster; this process alone where one is enough."""
    if scheduler is None:
        from concurrent.futures import ProcessPoolExecutor
        from multiprocessing import get_context

        if workers == 1:
            yield None
            return
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            yield pool
        return
    try:
        from distributed import Client, KilledWorker
    except ImportError:
        raise InputError('--scheduler: needs distributed (pip install "conveyor[cluster]")') from None
    try:
        client = Client(scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler: {scheduler}: no cluster answers ({error})") from None
    with client:
        try:
            yield client.get_executor()
        except KilledWorker as error:
            raise ConveyorError(f"{error}; what is done is kept: run it again to go on") from None
