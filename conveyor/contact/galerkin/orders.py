"""The ladder of Galerkin orders."""

from __future__ import annotations

ORDERS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
LOW_ORDER_FROM = 1e-5
"""rtol that the first order may meet."""
_CONVERGENCE_POWER = 3.3
"""Power of the order that errors fall with: 3.4 by order and 3.2 to 3.5 by energy in the median of 96 covers under
rolls, from 16 to 24 to 96; 2.9 and 2.7 to 3.0 in nine tenths, edge layers 2.4."""
_LARGEST_STEP = 2.0  # times the order, in one step


def lowest_order(rtol: float) -> int:
    """First order: at 1e-6 half of a conveyor's contacts need order 32, which costs hardly more than 24."""
    return ORDERS[0 if rtol >= LOW_ORDER_FROM else 2]


def next_order(n: int, excess: float) -> int:
    """Next order where the error exceeds the tolerance by this factor, at most twice n; the last one stays.

    The error is assumed to fall as in the median.
    """
    enough = n * min(excess ** (1.0 / _CONVERGENCE_POWER), _LARGEST_STEP)
    return next((order for order in ORDERS if n < order and order >= 0.999 * enough), ORDERS[-1])
