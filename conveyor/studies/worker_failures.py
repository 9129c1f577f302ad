"""Error message for a lost worker process."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, CancelledError
from contextlib import contextmanager

from conveyor.errors import ConveyorError


@contextmanager
def report_lost_worker(what: str, then: str = "") -> Iterator[None]:
    """Report the loss of a worker as an error.

    Raises
    ------
    ConveyorError
        The executor is broken, or its work was cancelled.
    """
    try:
        yield
    except (BrokenExecutor, CancelledError, BrokenPipeError):
        raise ConveyorError(f"a worker of the {what} was lost (out of memory, or stopped){then}") from None
