"""The ladder of Galerkin orders."""

from __future__ import annotations

ORDERS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
LOW_ORDER_FROM = 1e-5
"""rtol that the first order may meet."""
_CONVERGENCE_POWER = 3.3
"""Power of the order that errors fall with: 3.4 by order and 3.2 to 3.5 by energy in the median of 96 covers under
rolls, from 16 to 24 to 96; 2.9 and 2.7 to 3.0 in nine tenths, edge layers 2.4."""
_FAR_OFF = 100.0  # of the tolerance: then a rung is left out


def lowest_order(rtol: float) -> int:
    """First order: at 1e-6 half of a conveyor's contacts need order 32, which costs hardly more than 24."""
    return ORDERS[0 if rtol >= LOW_ORDER_FROM else 2]


def predicted_order(n: int, excess: float, excess_energy: float, farthest: float) -> int:
    """Next order where error and energy error exceed the tolerance by these factors, at most `farthest` times n.

    Both are assumed to fall as in the median.
    """
    enough = n * min(max(excess, excess_energy) ** (1.0 / _CONVERGENCE_POWER), farthest)
    return next((order for order in ORDERS if n < order and order >= 0.999 * enough), ORDERS[-1])


def next_order(n: int, error: float, rtol: float) -> int:
    """Next order, or the one after it where the error is more than two decades off; the last one stays."""
    place = ORDERS.index(n) + (2 if error > _FAR_OFF * rtol else 1)
    return ORDERS[min(place, len(ORDERS) - 1)]
