"""A design that keeps every rule: what it is made of, its calculations, its cost."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from conveyor.line.task import Choice, Chosen
from conveyor.models import Conveyor
from conveyor.pipeline import CalculatedConveyor
from conveyor.sizing.screen import Limit
from conveyor.studies.costs import Costs
from conveyor.units.sentences import Said, figure, rounded


@dataclass(frozen=True)
class Shortfall:
    """Why a calculated candidate is no design.

    Attributes
    ----------
    rule : str
        What it does not keep, without figures.
    why : Said
        With its figures, and what to change.
    over : float
        What is needed over what series and rules allow [-]; infinite where no figure says it.
    uses : mapping of str to float
        Of what each limit of series and rules allows the share that is used, as far as known [-].
    """

    rule: str
    why: Said
    over: float
    uses: Mapping[Limit, float]


@dataclass(frozen=True, eq=False)
class SizedDesign:
    """A design that keeps every rule.

    Attributes
    ----------
    choice, chosen : Choice, Chosen
        What it is made of.
    found : CalculatedConveyor
        At the temperature of the duty; its spec is `found.conveyor`.
    coldest : CalculatedConveyor
        At the lowest temperature: motors and strength; `found` where the duty has none lower.
    costs : Costs
        Capital and a year.
    estimate : float
        Cost of a year by the closed estimate that chose it [currency/a].
    roll_life : float
        Of the set that lives shortest, L10 of its bearings [s].
    uses : mapping of str to float
        Of what each limit of series and rules allows the share that is used [-].
    """

    choice: Choice
    chosen: Chosen
    found: CalculatedConveyor
    coldest: CalculatedConveyor
    costs: Costs
    estimate: float
    roll_life: float
    uses: Mapping[Limit, float]

    def __repr__(self) -> str:
        line, motor = self.found.line, self.found.balance.power.motor
        return (
            f"SizedDesign(belt {figure(line.belt.width, 'length')} at {figure(line.speed, 'speed')}, "
            f"motor {figure(motor, 'power')}, cost of a year {rounded(self.year)})"
        )

    @property
    def conveyor(self) -> Conveyor:
        """Its spec."""
        return self.found.conveyor

    @property
    def year(self) -> float:
        """Cost of a year [currency/a]."""
        return float(self.costs.year)

    @property
    def safety(self) -> float:
        """Of the belt in steady running, at the lowest temperature [-]."""
        return self.chosen.carcass.strength * self.found.line.belt.width / highest_tension(self.pair)

    @property
    def pair(self) -> tuple[CalculatedConveyor, CalculatedConveyor]:
        """Both calculations."""
        return self.found, self.coldest


def highest_tension(pair: Iterable[CalculatedConveyor]) -> float:
    """Highest in steady running [N]."""
    return max(one.belt_duty.largest_steady for one in pair)
