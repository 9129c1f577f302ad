"""Evenly spaced numbers as people write them: `from:to:step`."""

from __future__ import annotations

import math
from typing import Final

MOST: Final = 1000
"""Values of one range."""


def spaced(given: str) -> list[float]:
    """Values of `from:to:step`, the end included; none where the step leads nowhere or to more than `MOST`.

    Raises
    ------
    ValueError
        Not three numbers.

    Examples
    --------
    >>> spaced("-10:0:5"), spaced("1:2:0")
    ([-10.0, -5.0, 0.0], [])
    """
    low, high, step = (float(part) for part in given.split(":"))
    if not (math.isfinite(low + high + step) and step > 0.0 and (high - low) / step <= MOST):
        return []
    return [low + k * step for k in range(math.floor((high - low) / step + 1e-9) + 1)]
