"""Ranking of compared compounds, with their costs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from conveyor.laws.energy import DutyStep, DutySums, duty_emission, duty_sums
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.loop.annual_energy import annual_cost
from conveyor.report.table_model import Column, PagePlacement, Table, figure_table
from conveyor.report.tables import what_if
from conveyor.studies.comparison import RankedPower
from conveyor.units.presentation import MONEY, NEVER

if TYPE_CHECKING:
    from conveyor.models import Operation
    from conveyor.studies.comparison import CalculatedComparison, ComparedScene


COSTS = (
    "energy_per_year", "cost_per_year", "saving_per_year", "saving_per_year_low", "saving_per_year_high",
    "carbon_dioxide_per_year", "extra_cost_of_the_belt", "payback", "payback_low", "payback_high", "energy_drawn",
    "energy_fed_back", "energy_drawn_at_least_saving", "energy_fed_back_at_least_saving",
    "energy_drawn_at_largest_saving", "energy_fed_back_at_largest_saving",
)  # fmt: skip


PAPER_VIEW = "paper"  # a view that no page has: columns of the workbook that it prints


COMPOUND = Column("compound", "text", "compound")
SPEED = Column("belt speed", "speed", "speed", key="speed")


def money_kind(comparison: CalculatedComparison) -> str:
    """Kind of amounts in the currency of the spec."""
    operation = comparison.conveyor.operation
    return MONEY + ("-" if operation is None or operation.price is None else operation.price.currency)


def kwh_in_joules(kwh: float | None) -> float | None:
    """Energy [J]; None where it is not known."""
    return None if kwh is None else kwh * JOULE_PER_KWH


@dataclass(frozen=True)
class RankedCompound:
    """Mean results of a compound at a speed over all temperatures, SI; energies of a year [kWh].

    Attributes
    ----------
    compound : str
        Name.
    speed : float
        Of the belt [m/s].
    temperature : float or None
        Temperature of the peak [K].
    averaged : int
        Number of temperatures averaged: those that the data of every compound reach.
    indentation, motor, low, high, peak : float or None
        Means [N, W], ends of the band [W], peak power [W]; None where its data do not reach.
    base : float or None
        Mean power of the base [W]; None if not comparable.
    apart : tuple of float or None
        90 % interval of the difference of power to the base, without what both have in common [W]; None of the base.
    year : DutySums or None
        Energy drawn and fed back.
    dearest, cheapest : DutySums or None
        The same at the upper and at the lower end of the difference to the base; of a duty that of every bar.
    most, least : float or None
        Their costs [currency].
    cost, before, emission, extra : float or None
        Cost of a year [currency]; the base's; carbon dioxide [kg]; extra cost of its belt [currency].
    why : str or None
        Reason why it is not compared with the base.
    rank : int or None
        Rank; equal for compounds whose powers do not differ significantly.
    """

    compound: str
    speed: float
    temperature: float | None
    averaged: int
    indentation: float | None
    motor: float | None
    low: float | None
    high: float | None
    peak: float | None
    base: float | None
    apart: tuple[float, float] | None
    year: DutySums | None
    dearest: DutySums | None
    cheapest: DutySums | None
    most: float | None
    least: float | None
    cost: float | None
    before: float | None
    emission: float | None
    extra: float | None
    why: str | None
    rank: int | None = None

    @property
    def change(self) -> float | None:
        """Relative difference of power to the base [-]."""
        return None if not self.motor or not self.base else self.motor / self.base - 1.0

    @property
    def band(self) -> tuple[float | None, float | None]:
        """90 % interval of the relative difference of power to the base [-]; None of the base itself."""
        if not self.base or self.apart is None:
            return None, None
        low, high = sorted(end / self.base for end in self.apart)
        return low, high

    @property
    def told_apart(self) -> bool:
        """True if its power differs from the base's by more than both may be off."""
        return self.apart is not None and not self.apart[0] <= 0.0 <= self.apart[1]

    @property
    def verdict(self) -> str | None:
        """Its power against the base's in words; None if not compared."""
        if self.base is None:
            return None
        if self.apart is None:
            return "base"
        if not self.told_apart:
            return "cannot be told apart"
        return "more" if self.apart[0] > 0.0 else "less"

    @property
    def saving(self) -> float | None:
        """Saving against the base [currency a year]."""
        return None if self.cost is None or self.before is None else self.before - self.cost

    @property
    def savings(self) -> tuple[float | None, float | None]:
        """90 % interval of the saving [currency a year]; None of the base itself."""
        if self.before is None or self.most is None or self.least is None:
            return None, None
        return self.before - self.most, self.before - self.least

    @property
    def saves_clearly(self) -> bool:
        """True if the whole interval of the saving is a saving, or a loss."""
        least, largest = self.savings
        return least is not None and largest is not None and not least <= 0.0 <= largest

    @property
    def payback(self) -> float | None:
        """Extra cost over saving [a]; None where either is not known, or the interval of the saving holds none."""
        return self._payback_of(self.saving) if self.saves_clearly else None

    @property
    def paybacks(self) -> tuple[float | None, float | None]:
        """90 % interval of the payback [a]."""
        least, largest = self.savings
        return self._payback_of(largest), self._payback_of(least)

    def _payback_of(self, saved: float | None) -> float | None:
        """Payback at a saving [a]; 0 for a belt that costs no more, infinite where nothing is saved."""
        if self.extra is None or saved is None:
            return None
        return max(self.extra, 0.0) / saved if saved > 0.0 else math.inf


def ranking_table(comparison: CalculatedComparison) -> Table:
    """Ranking by mean motor power, one row per compound and speed.

    Means are over the temperatures that the data of every compound reach at that speed, equally weighted; the peak is
    the largest power within the compound's own data. Compounds that are not comparable come last. Powers that do not
    differ significantly have one rank.
    """
    speeds = dict.fromkeys(scene.speed for scene in comparison.scenes)
    rows = tuple(row for speed in speeds for row in rank_compounds(comparison, speed))
    columns = (
        COMPOUND,
        Column("rank", "count", "rank", sparse=True),
        SPEED,
        Column("temperatures averaged", "count", "averaged", page=None),
        Column("mean indentation", "force", "indentation", page=None, sparse=True),
        Column("mean motor power", "power", "motor", sparse=True),
        Column("mean motor power, low", "power", "low", sparse=True),
        Column("mean motor power, high", "power", "high", sparse=True),
        Column("difference to base", "share", "change", json="motor power against base", sparse=True,
               key="motor_power_against_base"),
        Column("difference, low", "share", "band.0", sparse=True),
        Column("difference, high", "share", "band.1", sparse=True),
        Column("power against base", "text", "verdict", sparse=True),
        Column("peak motor power", "power", "peak", None, sparse=True),
        Column("at temperature", "temperature", "temperature", None, sparse=True),
        *_year_columns(comparison, rows),
        Column("not compared", "text", "why", sparse=True),
    )  # fmt: skip
    heading, page = (
        "Ranking by mean motor power, lowest first at each speed",
        (PagePlacement("ranking", "Ranking by mean motor power, lowest first"),),
    )
    return Table("ranking", "Ranking", heading, columns, rows, page)


def _year_columns(comparison: CalculatedComparison, rows: tuple[RankedCompound, ...]) -> Iterator[Column]:
    """Energy, cost, saving, carbon dioxide and payback, as formulas of hours and prices."""
    money, bases = (
        money_kind(comparison),
        {row.speed: i for i, row in enumerate(rows) if row.compound == comparison.base},
    )
    of = "[energy_drawn]", "[energy_fed_back]"
    shown = "" if comparison.extra_costs else None

    def where(known: str, formula: str) -> Callable[[RankedCompound], str]:
        """Formula of rows whose figure is known."""
        return lambda row: "" if getattr(row, known) is None else formula

    def saving(row: RankedCompound) -> str:
        return "" if row.saving is None else f"[cost_per_year:{bases[row.speed]}]-[cost_per_year]"

    def saving_at(end: str) -> Callable[[RankedCompound], str]:
        """Formula of the saving at an end of its interval."""
        cost = what_if.cost_formula(f"[energy_drawn_at_{end}_saving]", f"[energy_fed_back_at_{end}_saving]")
        return lambda row: "" if row.most is None else f"[cost_per_year:{bases[row.speed]}]-({cost})"

    yield Column(
        "energy per year", "energy", _energy_getter("year", "net_kwh"), sparse=True,
        formula=where("year", f"({of[0]}-{of[1]}){what_if.HOURS_RATIO}"),
    )  # fmt: skip
    yield Column("cost per year", money, "cost", sparse=True, formula=where("cost", what_if.cost_formula(*of)))
    yield Column("saving per year", money, "saving", sparse=True, formula=saving)
    yield Column("saving per year, low", money, "savings.0", sparse=True, formula=saving_at("least"))
    yield Column("saving per year, high", money, "savings.1", sparse=True, formula=saving_at("largest"))
    yield Column(
        "carbon dioxide per year", "carbon dioxide", "emission", sparse=True,
        formula=where("emission", what_if.emission_formula(*of)),
    )  # fmt: skip
    if any(row.saving is not None for row in rows):
        extra = "[extra_cost_of_the_belt]"

        def payback(saved: str) -> str:
            return f'IF({extra}="","",IF({saved}>0,MAX({extra},0)/{saved},"{NEVER}"))'

        yield Column("extra cost of the belt", money, "extra", shown, asked=True)
        yield Column(
            "payback", "years", "payback", shown,
            formula=lambda row: payback("[saving_per_year]") if row.saves_clearly else "",
        )  # fmt: skip
        yield Column(
            "payback, low", "years", "paybacks.0", shown, formula=where("most", payback("[saving_per_year_high]"))
        )
        yield Column(
            "payback, high", "years", "paybacks.1", shown, formula=where("most", payback("[saving_per_year_low]"))
        )
    for kind, of_year in (("drawn", "drawn_kwh"), ("fed back", "fed_back_kwh")):
        yield Column(f"energy {kind}", "energy", _energy_getter("year", of_year), None, sparse=True)
    for end, year in (("least", "dearest"), ("largest", "cheapest")):
        for kind, of_year in (("drawn", "drawn_kwh"), ("fed back", "fed_back_kwh")):
            yield Column(f"energy {kind} at {end} saving", "energy", _energy_getter(year, of_year), None, sparse=True)


def _energy_getter(year: str, name: str) -> Callable[[RankedCompound], float | None]:
    """Getter of an energy of a year [J]."""

    def energy(row: RankedCompound) -> float | None:
        sums = getattr(row, year)
        return None if sums is None else kwh_in_joules(getattr(sums, name))

    return energy


def what_if_table(comparison: CalculatedComparison) -> Table:
    """Hours, prices and emission factors, for the reader to change."""
    operation = comparison.conveyor.operation
    rows = () if operation is None else what_if.year_inputs(operation, operation.seconds_per_year, emission=True)
    return figure_table(
        "what_if", "Ranking", "What if: change the yellow cells, extra costs of the belts too", rows,
        note="Energy, cost, saving, carbon dioxide and payback follow; power does not.", prefix="what_if_",
    )  # fmt: skip


def cost_table(ranked: Table) -> Table:
    """Energy, cost and saving of a year; no rows where the ranking has none of them."""
    heading = "Energy, cost and saving of a year"
    columns = tuple(column for column in ranked.columns if column.key in {"compound", "speed", *COSTS})
    rows = ranked.rows if len(columns) > 2 else ()
    return Table("costs", "Ranking", heading, columns, rows, "ranking")


def rank_compounds(comparison: CalculatedComparison, speed: float) -> list[RankedCompound]:
    """Compounds at a speed [m/s], the least power first."""
    common = comparison.common(speed)
    known: dict[str, dict[float, ComparedScene]] = {
        scene.compound: {} for scene in comparison.scenes if scene.speed == speed
    }
    for scene in comparison.covered:
        if scene.speed == speed:
            known[scene.compound][scene.temperature] = scene
    means = {name: [scenes[t] for t in common] if scenes else [] for name, scenes in known.items()}
    base = means.get(comparison.base, [])
    rows = [_ranking_row(comparison, (name, speed), known[name], means[name], base) for name in known]
    places = _mean_ranks(comparison, [means[row.compound] for row in rows if row.why is None])
    rows = [replace(row, rank=places.get(row.compound)) for row in rows]
    return sorted(rows, key=lambda row: (row.motor is None, row.why is not None, row.motor or 0.0))


def _ranking_row(
    comparison: CalculatedComparison,
    key: tuple[str, float],
    scenes: dict[float, ComparedScene],
    at: list[ComparedScene],
    base: list[ComparedScene],
) -> RankedCompound:
    name, speed = key
    why = _why_not_compared(comparison, name, at, base)
    operation = comparison.conveyor.operation
    year = None if why else _year_energies(comparison, name, speed, at)
    before = None if why else _year_energies(comparison, comparison.base, speed, base)
    apart, dearest, cheapest = None, None, None
    if why is None and name != comparison.base:
        apart = comparison.difference(RankedPower.of(at), RankedPower.of(base))
        cheapest, dearest = _year_ends(comparison, name, speed, at, base)
    peak = max(scenes.values(), key=lambda scene: scene.motor) if scenes else None
    return RankedCompound(
        compound=name,
        speed=speed,
        temperature=None if peak is None else peak.temperature,
        averaged=len(at),
        indentation=_mean_or_none([s.indentation for s in at]),
        motor=_mean_or_none([s.motor for s in at]),
        low=_mean_or_none([s.motor_low for s in at]),
        high=_mean_or_none([s.motor_high for s in at]),
        peak=None if peak is None else peak.motor,
        base=None if why else _mean_or_none([s.motor for s in base]),
        apart=apart,
        year=year,
        dearest=dearest,
        cheapest=cheapest,
        most=_energy_cost(operation, dearest),
        least=_energy_cost(operation, cheapest),
        cost=_energy_cost(operation, year),
        before=_energy_cost(operation, before),
        emission=_year_emission(operation, year),
        extra=comparison.extra_costs.get(name),
        why=why,
    )


def _mean_ranks(comparison: CalculatedComparison, scenes: Sequence[list[ComparedScene]]) -> dict[str, int]:
    """Rank of each compound by the mean of its scenes; equal where they do not differ significantly."""
    places: dict[str, int] = {}
    for group in comparison.groups(map(RankedPower.of, scenes)):
        places |= dict.fromkeys((one.compound for one in group), len(places) + 1)
    return places


def _why_not_compared(
    comparison: CalculatedComparison, name: str, at: list[ComparedScene], base: list[ComparedScene]
) -> str | None:
    """Reason why a compound is not compared with the base; None if it is."""
    if not at:
        return "its data do not reach"
    if not base:
        return "the base's data do not reach"
    if comparison.test_basis_differs(name):
        return "only one of the two is tested"
    return None


def _year_energies(
    comparison: CalculatedComparison, name: str, speed: float, at: list[ComparedScene], change: float = 0.0
) -> DutySums | None:
    """Energies of a year: from the duty at the spec's speed if there is one, else from all hours at the mean power.

    Without a duty, with a change of the mean power [W].
    """
    operation = comparison.conveyor.operation
    if comparison.conveyor.duty:
        study = comparison.years.get(name) if speed == comparison.conveyor.belt_speed else None
        return None if study is None else study.year
    net = [
        scene.energy_per_year * (1.0 + change / scene.motor if scene.motor else 1.0)
        for scene in at
        if scene.energy_per_year is not None
    ]
    if operation is None or not net:
        return None
    drawn, fed_back = (math.fsum(max(sign * kwh, 0.0) for kwh in net) / len(net) for sign in (1.0, -1.0))
    return DutySums(operation.seconds_per_year, drawn, fed_back, 0.0)


def _year_ends(
    comparison: CalculatedComparison, name: str, speed: float, at: list[ComparedScene], base: list[ComparedScene]
) -> list[DutySums | None]:
    """Energies of a year at the lower and at the upper end of the difference to the base.

    Of a duty every bar has the ends of its own difference, at its own load, speed and temperature.
    """
    if not comparison.conveyor.duty:
        changes = _difference_errors(comparison, RankedPower.of(at), RankedPower.of(base))
        return [_year_energies(comparison, name, speed, at, change) for change in changes]
    years = [comparison.years.get(one) for one in (name, comparison.base)]
    if speed != comparison.conveyor.belt_speed or years[0] is None or years[1] is None:
        return [None, None]
    steps: list[list[DutyStep]] = [[], []]
    for row, mine, theirs in zip(years[0].rows, comparison.bars[name], comparison.bars[comparison.base], strict=True):
        errors = _difference_errors(comparison, RankedPower.of([mine]), RankedPower.of([theirs]))
        for end, change in zip(steps, errors, strict=True):
            share = change / mine.motor if mine.motor else 0.0
            end.append(replace(row.step, power=row.mains * (1.0 + share)))
    return [duty_sums(end) for end in steps]


def _difference_errors(comparison: CalculatedComparison, mine: RankedPower, theirs: RankedPower) -> tuple[float, float]:
    """Ends of the 90 % interval of a difference of power, less the difference [W]."""
    low, high = comparison.difference(mine, theirs)
    return low - (mine.motor - theirs.motor), high - (mine.motor - theirs.motor)


def _energy_cost(operation: Operation | None, year: DutySums | None) -> float | None:
    """Cost of a year's energy [currency]; None without hours or price."""
    return None if operation is None or year is None else annual_cost(operation, year)


def _year_emission(operation: Operation | None, year: DutySums | None) -> float | None:
    """Carbon dioxide of a year [kg]; None without hours or factor."""
    if operation is None or year is None or operation.emission is None:
        return None
    saved = operation.feed_in_emission
    credit = 0.0 if saved is None else saved.amount
    return duty_emission(year, factor=operation.emission.amount, credit_factor=credit)


def _mean_or_none(values: list[float] | list[float | None]) -> float | None:
    """Mean; None if empty or if a value is not known."""
    known = [value for value in values if value is not None]
    return math.fsum(known) / len(known) if known and len(known) == len(values) else None
