"""Limits of arguments; every message names the argument, its value and what is allowed."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Final

from conveyor.errors import ConveyorError, InputError, MessageQuantity


def require(ok: bool, name: str, value: object, allowed: str | ConveyorError) -> None:
    """Refuse an argument unless `ok`; an amount is written in the reader's units."""
    if not ok:
        shown = value if isinstance(value, MessageQuantity) else repr(value)
        raise InputError("{}: got {}, allowed: {}", name, shown, allowed)


def require_number(**values: object) -> None:
    """Refuse anything but a number: text, an array."""
    for name, value in values.items():
        ok = isinstance(value, Real) and not isinstance(value, bool)
        require(ok, name, value, "a number without a unit")


def require_count(least: int, **values: object) -> None:
    """Refuse anything but a whole number of at least `least`."""
    for name, value in values.items():
        ok = isinstance(value, Integral) and not isinstance(value, bool) and int(value) >= least
        require(ok, name, value, f"a whole number >= {least}")


MOST_WORKERS: Final = 1024
"""Processes, or workers of a cluster."""


def require_workers(workers: int) -> None:
    """Refuse a number of workers that no executor has."""
    ok = isinstance(workers, Integral) and not isinstance(workers, bool) and 1 <= int(workers) <= MOST_WORKERS
    require(ok, "workers", workers, f"a whole number from 1 to {MOST_WORKERS}")


def require_finite(**values: float) -> None:
    """Refuse NaN and infinity."""
    for name, value in values.items():
        require(math.isfinite(value), name, value, "finite")


def require_positive(**values: float) -> None:
    """Refuse all but finite numbers above zero."""
    for name, value in values.items():
        require(0.0 < value < math.inf, name, value, "> 0 and finite")


def require_not_negative(**values: float) -> None:
    """Refuse all but finite numbers of at least zero."""
    for name, value in values.items():
        require(0.0 <= value < math.inf, name, value, ">= 0 and finite")


def require_angle(low: float, **values: float) -> None:
    """Refuse angles [rad] below `low` or of pi/2 and more."""
    for name, value in values.items():
        ok = low <= value < math.pi / 2.0 and value > -math.pi / 2.0
        require(ok, name, value, f">= {low:.4g} and < pi/2 rad")


def require_slope(**values: float) -> None:
    """Refuse slopes [rad] not between -pi/2 and pi/2."""
    for name, value in values.items():
        ok = -math.pi / 2.0 < value < math.pi / 2.0
        require(ok, name, value, "> -pi/2 and < pi/2 rad")
