"""Evenly spaced numbers from text: `from:to:step`."""

from __future__ import annotations

import math
from typing import Final

MOST: Final = 1000
"""Largest number of values of one range."""


def spaced(given: str) -> list[float]:
    """Values of `from:to:step`, the end included; none for an invalid step or more than `MOST`.

    Raises
    ------
    ValueError
        Not three numbers.

    Examples
    --------
    >>> spaced("-10:0:5"), spaced("1:2:0")
    ([-10.0, -5.0, 0.0], [])
    """
    if why_not_spaced(given):
        return []
    low, high, step = _ends(given)
    return [low + k * step for k in range(math.floor((high - low) / step + 1e-9) + 1)]


def why_not_spaced(given: str) -> str:
    """Error of a range `from:to:step`; empty if it is valid.

    Raises
    ------
    ValueError
        Not three numbers.

    Examples
    --------
    >>> why_not_spaced("6:1:1"), why_not_spaced("1:6:1")
    ('it ends below where it begins', '')
    """
    low, high, step = _ends(given)
    if not math.isfinite(low + high + step):
        return "expected finite numbers"
    if step <= 0.0:
        return "the step has to be above 0"
    if high < low:
        return "it ends below where it begins"
    return f"more than {MOST} values; take a larger step" if (high - low) / step > MOST else ""


def _ends(given: str) -> tuple[float, float, float]:
    low, high, step = (float(part) for part in given.split(":"))
    return low, high, step
