"""Forces that act over a length of the belt: their shares of the stretches."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.line.loop_positions import LoopPosition
from conveyor.line.strands import LoopShape

Array = NDArray[np.float64]


class ReachShares(NamedTuple):
    """Shares of the stretches in a force that acts evenly over a length of the belt, in loop order.

    Attributes
    ----------
    shares : ndarray, shape (2n,)
        Share of the force on every stretch [-].
    ahead : ndarray, shape (2n,)
        Distance from the middle of its part on a stretch to the stretch's end over the stretch's length [-].
    early : float
        What a newton adds to the mean tension of the loop over a newton spread evenly over the same stretches [-].
    """

    shares: Array
    ahead: Array
    early: float


def reach_shares(shape: LoopShape, spot: LoopPosition, reach: float) -> ReachShares:
    """Shares of a force from a spot over a reach in running direction [m], above 0 and within the strand; derived."""
    begins, ends = shape.way[:-1], shape.way[1:]
    start = float(shape.way[spot.boundary])
    low, high = np.clip(begins, start, start + reach), np.clip(ends, start, start + reach)
    shares = (high - low) / reach
    ahead = (ends - 0.5 * (low + high)) / shape.length
    early = float((shares * (ahead - 0.5)) @ shape.length) / float(shape.way[-1])
    return ReachShares(shares, ahead, early)
