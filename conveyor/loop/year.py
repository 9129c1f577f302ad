"""What a year's energy costs: one rule for even hours, for a duty, and for comparisons of either."""

from __future__ import annotations

from conveyor.laws.energy import Duty, duty_cost
from conveyor.models import Operation


def year_cost(operation: Operation, year: Duty) -> float | None:
    """Cost of a year's energy; what is fed back earns the feed-in price, and nothing where the spec has none.

    Parameters
    ----------
    operation : Operation
        With the prices.
    year : Duty
        Energy drawn and fed back [kWh/a].

    Returns
    -------
    float or None
        Cost [currency/a], negative where the conveyor earns; None without a price.
    """
    if operation.price is None:
        return None
    credit = operation.feed_in_price
    return duty_cost(year, price=operation.price.amount, credit=0.0 if credit is None else credit.amount)


def earns_nothing(operation: Operation | None) -> bool:
    """Whether energy drawn has a price and energy fed back has none."""
    return operation is not None and operation.price is not None and operation.feed_in_price is None
