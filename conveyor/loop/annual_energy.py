"""Annual energy and its cost, for constant load or a duty."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.laws.energy import DutyStep, DutySums, duty_cost, duty_sums
from conveyor.models import Operation


@dataclass(frozen=True)
class AnnualEnergy:
    """Net energy of a year from the mains [kWh], its cost [currency]; None without a price."""

    energy: float
    cost: float | None
    currency: str | None


def annual_energy(operation: Operation, mains: float, flow: float) -> AnnualEnergy:
    """Annual energy at one power from the mains [W] and one mass flow [kg/s]."""
    sums = duty_sums([DutyStep(time=operation.seconds_per_year, power=mains, mass_flow=flow)])
    currency = None if operation.price is None else operation.price.currency
    return AnnualEnergy(sums.net_kwh, annual_cost(operation, sums), currency)


def annual_cost(operation: Operation, year: DutySums) -> float | None:
    """Cost of a year's energy; energy fed back earns the feed-in price, or nothing without one.

    Parameters
    ----------
    operation : Operation
        Operation, with the prices.
    year : DutySums
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


def lacks_feed_in_price(operation: Operation | None) -> bool:
    """True if energy drawn has a price and energy fed back has none."""
    return operation is not None and operation.price is not None and operation.feed_in_price is None
