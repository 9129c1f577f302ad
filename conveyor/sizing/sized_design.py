"""A sized design within every rule: its parts, calculations and cost; and the shortfall of a candidate."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.models import Conveyor
from conveyor.sizing.design_choice import DesignChoice, SelectedParts
from conveyor.sizing.screen import Limit
from conveyor.studies.costs import Costs
from conveyor.studies.loads import EveryLoad, every_load
from conveyor.units.presentation import format_figure, format_number
from conveyor.units.sentences import Message


@dataclass(frozen=True)
class Shortfall:
    """Reason for the rejection of a calculated candidate.

    Attributes
    ----------
    rule : str
        Rule or check not kept, without figures.
    why : Message
        Message with figures and the remedy.
    over : float
        Needed over allowed by series and rules [-]; infinite without a figure.
    uses : mapping of str to float
        Use of each limit of series and rules, as far as known [-].
    """

    rule: str
    why: Message
    over: float
    uses: Mapping[Limit, float]


@dataclass(frozen=True, eq=False)
class SizedDesign:
    """A design within every rule.

    Attributes
    ----------
    choice, chosen : DesignChoice, SelectedParts
        Its parts.
    found : CalculatedConveyor
        Result at the temperature of the duty; its spec is `found.conveyor`.
    coldest : CalculatedConveyor
        Result at the lowest temperature, for motors and strength; `found` if the duty has none lower.
    costs : Costs
        Capital and yearly costs.
    estimate : float
        Yearly cost by the closed estimate [currency/a].
    roll_life : float
        Shortest L10 of the bearings of any set [s].
    uses : mapping of str to float
        Use of each limit of series and rules [-].
    """

    choice: DesignChoice
    chosen: SelectedParts
    found: CalculatedConveyor
    coldest: CalculatedConveyor
    costs: Costs
    estimate: float
    roll_life: float
    uses: Mapping[Limit, float]

    def __repr__(self) -> str:
        line, motor = self.found.line, self.found.balance.power.motor
        return (
            f"SizedDesign(belt {format_figure(line.belt.width, 'length')} at {format_figure(line.speed, 'speed')}, "
            f"motor {format_figure(motor, 'power')}, cost of a year {format_number(self.year)})"
        )

    @property
    def conveyor(self) -> Conveyor:
        """Its spec."""
        return self.found.conveyor

    @property
    def year(self) -> float:
        """Yearly cost [currency/a]."""
        return float(self.costs.year)

    @property
    def safety(self) -> float:
        """Belt safety in steady running at the lowest temperature [-]."""
        return self.chosen.carcass.strength * self.found.line.belt.width / highest_tension(self.pair)

    @cached_property
    def every_load(self) -> EveryLoad:
        """Its spec in every load, at the coldest and at the temperature of the duty, as `conveyor power` judges it."""
        return every_load(self.conveyor, self.found)

    @property
    def pair(self) -> tuple[CalculatedConveyor, CalculatedConveyor]:
        """Both calculations."""
        return self.found, self.coldest


def highest_tension(pair: Iterable[CalculatedConveyor]) -> float:
    """Highest belt tension in steady running [N]."""
    return max(one.belt_duty.largest_steady for one in pair)
