"""Evenly spaced numbers from text: `from:to:step`."""

from __future__ import annotations

import math
from typing import Final

MOST_VALUES: Final = 1000
"""Largest number of values of one range."""


def range_values(given: str) -> list[float]:
    """Values of `from:to:step`, the end included; none for an invalid step or more than `MOST_VALUES`.

    Raises
    ------
    ValueError
        Not three numbers.

    Examples
    --------
    >>> range_values("-10:0:5"), range_values("1:2:0")
    ([-10.0, -5.0, 0.0], [])
    """
    if range_error(given):
        return []
    low, high, step = _parse_range(given)
    return [low + k * step for k in range(math.floor((high - low) / step + 1e-9) + 1)]


def range_error(given: str) -> str:
    """Error of a range `from:to:step`; empty if it is valid.

    Raises
    ------
    ValueError
        Not three numbers.

    Examples
    --------
    >>> range_error("6:1:1"), range_error("1:6:1")
    ('it ends below where it begins', '')
    """
    low, high, step = _parse_range(given)
    if not math.isfinite(low + high + step):
        return "expected finite numbers"
    if step <= 0.0:
        return "the step has to be above 0"
    if high < low:
        return "it ends below where it begins"
    return f"more than {MOST_VALUES} values; take a larger step" if (high - low) / step > MOST_VALUES else ""


def _parse_range(given: str) -> tuple[float, float, float]:
    low, high, step = (float(part) for part in given.split(":"))
    return low, high, step
