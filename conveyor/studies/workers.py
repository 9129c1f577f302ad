"""A process that was lost, said in one line."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, CancelledError
from contextlib import contextmanager

from conveyor.errors import ConveyorError


@contextmanager
def workers_of(what: str, then: str = "") -> Iterator[None]:
    """Say that a worker of something was lost, and what to do.

    Raises
    ------
    ConveyorError
        The executor is broken, or what was asked of it cancelled.
    """
    try:
        yield
    except (BrokenExecutor, CancelledError, BrokenPipeError):
        raise ConveyorError(f"a worker of the {what} was lost (out of memory, or stopped){then}") from None
