"""Ends a calculation early: a newer one is wanted, or its time is over."""

from __future__ import annotations

import threading
import time
from typing import Final

from conveyor.errors import NoSolutionError

MOST_SECONDS: Final = 60.0
"""Time limit of one calculation [s]."""


class CalculationStopped(Exception):  # noqa: N818 no error: nobody waits for the answer any more
    """A calculation ended early, as its page has asked for a newer one."""


class StopSignal:
    """Stops a calculation at its next step: where a newer one is wanted, or its time is over."""

    def __init__(self, seconds: float = MOST_SECONDS) -> None:
        self._stopped = threading.Event()
        self._seconds = seconds
        self.told: tuple[object, ...] = ()
        self._end = time.monotonic() + seconds

    def stop(self) -> None:
        """Stop the calculation."""
        self._stopped.set()

    def check(self, *told: object) -> None:
        """Raise if the calculation is to stop; keeps what callbacks of progress are given in `told`.

        Raises
        ------
        CalculationStopped
            Nobody waits for the answer.
        NoSolutionError
            The time limit is over.
        """
        self.told = told or self.told
        if self._stopped.is_set():
            raise CalculationStopped
        if time.monotonic() > self._end:
            raise NoSolutionError(
                f"stopped after {self._seconds:.0f} s, the limit of the desk; conveyor power calculates it without one"
            )
