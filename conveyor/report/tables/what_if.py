"""Inputs that a reader may change in the workbook (prices, hours, emissions, motor reserve), and formulas of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.models import Operation
from conveyor.report.table_model import Figure, Table, figure_table
from conveyor.studies.duty import CalculatedYear
from conveyor.studies.load_cases import MOTOR_RESERVE
from conveyor.units.presentation import MONEY

_PREFIX: Final = "what_if_"
HOURS_RATIO: Final = "*what_if_operating_hours/what_if_hours_calculated"
_TONNE: Final = 1000.0


def what_if_table(a: CalculatedConveyor, duty: CalculatedYear | None, motor: float) -> Table:
    """Table of inputs to change and their results; `motor` is the maximum motor power of all loads [W]."""
    heading = "What if: change the yellow cells"
    rows = (*_energy_figures(a, duty), *_motor_figures(motor))
    note = "Formulas over the energy and power calculated; forces and power do not follow from these cells."
    return figure_table("what_if", "Results", heading, rows, note=note, prefix=_PREFIX)


def _motor_figures(motor: float) -> Iterator[Figure]:
    needed = abs(motor)
    yield Figure("maximum motor power, driving or braking", "power", needed, key="maximum_motor_power")
    yield Figure("motor reserve", "ratio", MOTOR_RESERVE, on="input")
    formula = "what_if_maximum_motor_power*what_if_motor_reserve"
    yield Figure("required rated power", "power", needed * MOTOR_RESERVE, formula=formula)


def _energy_figures(a: CalculatedConveyor, duty: CalculatedYear | None) -> Iterator[Figure]:
    """Energy, cost and carbon dioxide of a year: of the duty, else at even load."""
    operation = a.conveyor.operation
    if operation is None:
        return
    if duty is not None:
        hours, drawn, fed_back = duty.year.time, duty.year.drawn_kwh, duty.year.fed_back_kwh
        cost, emission = duty.cost, duty.emission
    elif a.year is not None:
        hours, cost, emission = operation.seconds_per_year, a.year.cost, None
        drawn, fed_back = max(a.year.energy, 0.0), max(-a.year.energy, 0.0)
    else:
        return
    yield Figure("energy drawn", "energy", drawn * JOULE_PER_KWH)
    yield Figure("energy fed back", "energy", fed_back * JOULE_PER_KWH)
    yield from year_inputs(operation, hours, emission=emission is not None)
    of = "what_if_energy_drawn", "what_if_energy_fed_back"
    if operation.price is not None:
        yield Figure("cost", f"{MONEY}{operation.price.currency}", cost, formula=cost_formula(*of))
    if operation.emission is not None and emission is not None:
        yield Figure("carbon dioxide", "carbon dioxide", emission, formula=emission_formula(*of))


def year_inputs(operation: Operation, hours: float, *, emission: bool) -> Iterator[Figure]:
    """Hours [s], prices and emission factors of a year, for the reader to change."""
    yield Figure("hours calculated", "duration", hours)
    yield Figure("operating hours", "duration", hours, on="input")
    price, credit = operation.price, operation.feed_in_price
    if price is not None:
        per_kwh = f"{MONEY}{price.currency}/kWh"
        yield Figure("energy price", per_kwh, price.amount, on="input")
        yield Figure("feed-in price", per_kwh, 0.0 if credit is None else credit.amount, on="input")
    factor, saved = operation.emission, operation.feed_in_emission
    if factor is not None and emission:
        yield Figure("emission factor", "emission factor", factor.amount, on="input")
        less = 0.0 if saved is None else saved.amount
        yield Figure("emission factor of energy fed back", "emission factor", less, on="input")


def cost_formula(drawn: str, fed_back: str) -> str:
    """Formula of the cost of a year, from the cells of its energies [MWh]."""
    credit = f"{_TONNE:g}*{fed_back}*what_if_feed_in_price"
    return f"({_TONNE:g}*{drawn}*what_if_energy_price-{credit}){HOURS_RATIO}"


def emission_formula(drawn: str, fed_back: str) -> str:
    """Formula of the carbon dioxide of a year [t], from the cells of its energies [MWh]."""
    less = f"{fed_back}*what_if_emission_factor_of_energy_fed_back"
    return f"({drawn}*what_if_emission_factor-{less}){HOURS_RATIO}"
