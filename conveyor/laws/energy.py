"""A year's duty as a histogram: energy, cost, carbon dioxide; the chain of efficiencies and the motor to buy.

Sources: definitions; IEC 60072-1 (outputs in customary steps). Prices and emission factors are the user's, with
their source.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive
from conveyor.errors import RangeError
from conveyor.laws.drives import HORSEPOWER
from conveyor.laws.power import JOULE_PER_KWH, TONNE_KM

YEAR: Final = 8784.0 * 3600.0  # [s], a leap year: no duty is longer

# [W], IEC 60072-1 in the steps makers list; the standard has further ones between from 132 kW on
# fmt: off
MOTOR_SERIES: Final = tuple(1e3 * kilowatt for kilowatt in (
    0.37, 0.55, 0.75, 1.1, 1.5, 2.2, 3.0, 4.0, 5.5, 7.5, 11.0, 15.0, 18.5, 22.0, 30.0, 37.0, 45.0, 55.0, 75.0,
    90.0, 110.0, 132.0, 160.0, 200.0, 250.0, 315.0, 355.0, 400.0, 450.0, 500.0, 560.0, 630.0, 710.0, 800.0,
    900.0, 1000.0,
))
# [W], NEMA: to 500 hp the motors of NFPA 70, table 430.250 (wiresizecalculator.net), beyond general knowledge (MG 1)
NEMA_MOTORS: Final = tuple(HORSEPOWER * horses for horses in (
    0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 75.0, 100.0, 125.0, 150.0,
    200.0, 250.0, 300.0, 350.0, 400.0, 450.0, 500.0, 600.0, 700.0, 800.0, 900.0, 1000.0, 1250.0,
))
# fmt: on


@dataclass(frozen=True, slots=True)
class DutyStep:
    """One bar of the histogram.

    Parameters
    ----------
    time : float
        Time in a year [s], at least 0.
    power : float
        From the mains [W], negative when fed back.
    mass_flow : float
        Q [kg/s], at least 0.
    """

    time: float
    power: float
    mass_flow: float

    def __post_init__(self) -> None:
        require_not_negative(time=self.time, mass_flow=self.mass_flow)
        require_finite(power=self.power)


@dataclass(frozen=True, slots=True)
class DutySums:
    """Sums of a year.

    Parameters
    ----------
    time : float
        In operation [s/a].
    drawn_kwh : float
        Drawn from the mains [kWh/a], at least 0.
    fed_back_kwh : float
        Fed back to it [kWh/a], at least 0.
    mass : float
        Conveyed [kg/a].
    """

    time: float
    drawn_kwh: float
    fed_back_kwh: float
    mass: float

    @property
    def net_kwh(self) -> float:
        """Drawn less fed back [kWh/a]."""
        return self.drawn_kwh - self.fed_back_kwh


def duty_sums(steps: Sequence[DutyStep]) -> DutySums:
    """Energy and mass of a year, sums of P t and Q t, drawn and fed back apart.

    Parameters
    ----------
    steps : sequence of DutyStep
        Bars of the histogram [s, W, kg/s]: hours at each load and temperature; together at most a year.

    Returns
    -------
    DutySums
        Sums of the year.

    Raises
    ------
    InputError
        There is no step, or they are longer than a year.

    Examples
    --------
    >>> duty = duty_sums(
    ...     [
    ...         DutyStep(time=3000 * 3600.0, power=100e3, mass_flow=200.0),
    ...         DutyStep(time=1000 * 3600.0, power=-20e3, mass_flow=50.0),
    ...     ]
    ... )
    >>> round(duty.drawn_kwh), round(duty.fed_back_kwh), round(duty.mass / 1e3)
    (300000, 20000, 2340000)
    """
    require(len(steps) > 0, "steps", list(steps), "at least one step")
    time = math.fsum(step.time for step in steps)
    require(time <= YEAR, "steps", list(steps), f"<= 8784 h, a year; these are {time / 3600.0:.6g} h")
    return DutySums(
        time=time,
        drawn_kwh=math.fsum(step.time * step.power for step in steps if step.power > 0.0) / JOULE_PER_KWH,
        fed_back_kwh=math.fsum(-step.time * step.power for step in steps if step.power < 0.0) / JOULE_PER_KWH,
        mass=math.fsum(step.time * step.mass_flow for step in steps),
    )


def duty_cost(duty: DutySums, *, price: float, credit: float) -> float:
    """Cost of a year's energy, drawn × price - fed back × credit.

    Parameters
    ----------
    duty : DutySums
        Sums of the year [kWh/a], see `duty_sums`.
    price : float
        For energy drawn [currency/kWh], at least 0.
    credit : float
        For energy fed back [currency/kWh], at least 0; 0 if it is burnt in resistors.

    Returns
    -------
    float
        Cost [currency/a]; negative: the conveyor earns.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> year = DutySums(time=3.6e6, drawn_kwh=300e3, fed_back_kwh=20e3, mass=1e9)
    >>> duty_cost(year, price=0.2, credit=0.05)
    59000.0
    """
    require_not_negative(price=price, credit=credit)
    return duty.drawn_kwh * price - duty.fed_back_kwh * credit


def duty_emission(duty: DutySums, *, factor: float, credit_factor: float) -> float:
    """Carbon dioxide of a year's energy, drawn × factor - fed back × credit factor.

    Parameters
    ----------
    duty : DutySums
        Sums of the year [kWh/a], see `duty_sums`.
    factor : float
        Of energy drawn [kg/kWh], at least 0, from the user with its source: it depends on grid and year.
    credit_factor : float
        Of energy fed back [kg/kWh], at least 0; 0 counts no credit.

    Returns
    -------
    float
        Carbon dioxide [kg/a].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> year = DutySums(time=3.6e6, drawn_kwh=300e3, fed_back_kwh=20e3, mass=1e9)
    >>> duty_emission(year, factor=0.4, credit_factor=0.0)
    120000.0
    """
    require_not_negative(factor=factor, credit_factor=credit_factor)
    return duty.drawn_kwh * factor - duty.fed_back_kwh * credit_factor


def duty_specific_energy(duty: DutySums, *, length: float) -> float:
    """Net energy of a year per mass and distance conveyed.

    Parameters
    ----------
    duty : DutySums
        Sums of the year [kWh/a, kg/a], with some mass, see `duty_sums`.
    length : float
        L of the conveyor [m], positive.

    Returns
    -------
    float
        Energy [kWh/(t km)].

    Raises
    ------
    InputError
        The length is not positive, or no mass was conveyed.

    Examples
    --------
    >>> year = DutySums(time=3.6e6, drawn_kwh=300e3, fed_back_kwh=20e3, mass=1e9)
    >>> round(duty_specific_energy(year, length=2000.0), 9)
    0.14
    """
    require_positive(length=length)
    require(duty.mass > 0.0, "duty.mass", duty.mass, "> 0: some mass conveyed")
    return duty.net_kwh / (duty.mass * length) * TONNE_KM


def next_motor(shaft_power: float, *, reserve: float = 1.0, series: Sequence[float] = MOTOR_SERIES) -> float:
    """Rated power of the next larger motor of a series, reserve included (IEC 60072-1, customary steps).

    Parameters
    ----------
    shaft_power : float
        Needed at the motor's shaft [W], of either sign: a generator is sized by its amount.
    reserve : float
        Rated power over needed [-], at least 1.
    series : sequence of float
        Rated outputs, the least first [W], shape (n,): those of IEC 60072-1, or `NEMA_MOTORS`.

    Returns
    -------
    float
        Rated output [W].

    Raises
    ------
    InputError
        An argument is outside its range.
    RangeError
        More than the largest of the series, 1000 kW of IEC: share it or take a motor made to order.

    Notes
    -----
    Cooling at altitude or above 40 degC, and the start, are checks of their own.

    Examples
    --------
    >>> next_motor(68.93e3), next_motor(68.93e3, reserve=1.15), next_motor(-90e3)
    (75000.0, 90000.0, 90000.0)
    """
    require_finite(shaft_power=shaft_power)
    require(1.0 <= reserve < math.inf, "reserve", reserve, ">= 1")
    needed = round(abs(shaft_power) * reserve, 3)  # products of decimals: 100 kW · 1.1 is 110 kW
    for rated in series:
        if round(rated, 3) >= needed:
            return rated
    raise RangeError(
        f"{needed / 1e3:.6g} kW is more than the largest motor of the series, {series[-1] / 1e3:.4g} kW: "
        "share it between more drives or give the rated power"
    )
