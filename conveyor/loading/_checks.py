"""Refusals of the loading laws: every message names the argument, its value and what is allowed."""

from __future__ import annotations

import math

from conveyor.errors import InputError


def require(ok: bool, name: str, value: object, allowed: str) -> None:
    if not ok:
        raise InputError(f"{name} = {value!r} is not allowed: {allowed}")


def require_positive(**values: float) -> None:
    for name, value in values.items():
        require(0.0 < value < math.inf, name, value, "a finite number greater than 0 is needed")


def require_not_negative(**values: float) -> None:
    for name, value in values.items():
        require(0.0 <= value < math.inf, name, value, "a finite number of at least 0 is needed")


def require_angle(low: float, **values: float) -> None:
    for name, value in values.items():
        ok = low <= value < math.pi / 2.0 and value > -math.pi / 2.0
        require(ok, name, value, f"an angle in rad from {low:.4g} to below pi/2 is needed")
