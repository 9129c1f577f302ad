"""Range checks of the laws: every message names the argument, its value and the allowed range."""

from __future__ import annotations

import math
from numbers import Real

from conveyor.errors import ConveyorError, InputError, MessageQuantity


def require(ok: bool, name: str, value: object, allowed: str | ConveyorError) -> None:
    """Refuse an argument unless `ok`; an amount is written in the reader's units."""
    if not ok:
        shown = value if isinstance(value, MessageQuantity) else repr(value)
        raise InputError("{} = {} is not allowed: {}", name, shown, allowed)


def require_number(**values: object) -> None:
    """Refuse anything but a number: text, an array."""
    for name, value in values.items():
        require(isinstance(value, Real), name, value, "a number in SI units is needed")


def require_finite(**values: float) -> None:
    """Refuse NaN and infinity."""
    for name, value in values.items():
        require(math.isfinite(value), name, value, "a finite number is needed")


def require_positive(**values: float) -> None:
    """Refuse all but finite numbers above zero."""
    for name, value in values.items():
        require(0.0 < value < math.inf, name, value, "a finite number greater than 0 is needed")


def require_not_negative(**values: float) -> None:
    """Refuse all but finite numbers of at least zero."""
    for name, value in values.items():
        require(0.0 <= value < math.inf, name, value, "a finite number of at least 0 is needed")


def require_angle(low: float, **values: float) -> None:
    """Refuse angles [rad] below `low` or of pi/2 and more."""
    for name, value in values.items():
        ok = low <= value < math.pi / 2.0 and value > -math.pi / 2.0
        require(ok, name, value, f"an angle in rad from {low:.4g} to below pi/2 is needed")


def require_slope(**values: float) -> None:
    """Refuse slopes [rad] not between -pi/2 and pi/2."""
    for name, value in values.items():
        ok = -math.pi / 2.0 < value < math.pi / 2.0
        require(ok, name, value, "an angle in rad between -pi/2 and pi/2 is needed")
