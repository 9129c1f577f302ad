"""The ladder of Galerkin orders."""

from __future__ import annotations

ORDERS = (16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512)
NARROW_ORDERS = (16, 24, 32, 48)
"""Those that are worth stacking: a higher one is the general solver's."""
_FAR_OFF = 100.0  # of the tolerance: then a rung is left out


def next_order(n: int, error: float, rtol: float) -> int:
    """The next order, or the one after where the error is more than two decades off; the last one stays."""
    place = ORDERS.index(n) + (2 if error > _FAR_OFF * rtol else 1)
    return ORDERS[min(place, len(ORDERS) - 1)]
