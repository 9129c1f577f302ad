"""Quantities that a spec may leave out, in SI."""

from __future__ import annotations

from conveyor.units import Quantity, si


def si_or_none(value: Quantity | None) -> float | None:
    """Value in SI; None without one."""
    return None if value is None else si(value)


def si_or_default(value: Quantity | None, default: float) -> float:
    """Value in SI, or a default [SI]."""
    return default if value is None else si(value)
