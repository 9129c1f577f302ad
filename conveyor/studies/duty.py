"""A year of a conveyor from its duty: every bar of the histogram calculated, not scaled from full load."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from conveyor.arguments import checked
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.energy import Duty, DutyStep, duty_cost, duty_emission, duty_specific_energy, duty_sums
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.loop.curved import Run
from conveyor.models import Conveyor, DutyEntry, LoadCase
from conveyor.studies.cases import mains_power, shaft_power
from conveyor.studies.scenes import Progress, Scene, runs
from conveyor.studies.variants import with_case, with_temperature
from conveyor.units import quantity, si, text

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class DutyRow:
    """One bar of the histogram, calculated.

    Attributes
    ----------
    hours : float
        In a year [h].
    share : float
        Mass flow over that of the spec [-].
    temperature, speed : float
        Of the belt [K], [m/s].
    flow : float
        Mass flow [kg/s].
    effective : float
        Drive force F_U [N].
    shaft, mains : float
        Power at the motors' shafts and from the mains [W], negative when fed back.
    """

    hours: float
    share: float
    temperature: float
    speed: float
    flow: float
    effective: float
    shaft: float
    mains: float

    @property
    def step(self) -> DutyStep:
        """As the laws of energy take it."""
        return DutyStep(time=3600.0 * self.hours, power=self.mains, mass_flow=self.flow)

    @property
    def energy(self) -> float:
        """From the mains in a year [kWh], negative when fed back."""
        return self.mains * 3600.0 * self.hours / JOULE_PER_KWH

    @property
    def mass(self) -> float:
        """Conveyed in a year [kg]."""
        return self.flow * 3600.0 * self.hours


@dataclass(frozen=True, eq=False, repr=False)
class DutyStudy:
    """A year of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    rows : tuple of DutyRow
        The bars.
    year : Duty
        Their sums.
    cost : float or None
        Of the energy, less the credit for what is fed back [currency]; None without a price.
    currency : str or None
        Its three-letter code.
    emission : float or None
        Carbon dioxide [kg]; None without a factor.
    emission_source : str or None
        Where the factor comes from.
    energy_per_tonne_km : float or None
        Net energy per mass and distance [kWh/(t km)]; None where nothing is conveyed.
    """

    conveyor: Conveyor
    rows: tuple[DutyRow, ...]
    year: Duty
    cost: float | None
    currency: str | None
    emission: float | None
    emission_source: str | None
    energy_per_tonne_km: float | None

    def __repr__(self) -> str:
        return f'DutyStudy("{self.conveyor.name}": {len(self.rows)} bars)'

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a bar; units in the names."""
        from conveyor.report import case_tables

        return case_tables.duty(self)

    @cached_property
    def summary(self) -> pd.Series:
        """Sums of the year; units in the names."""
        from conveyor.report import case_tables

        return case_tables.year(self)

    def _repr_html_(self) -> str:
        from conveyor.report.representations import of_duty

        return of_duty(self)


@checked
def analyse_duty(
    conveyor: Conveyor, *, rtol: float | None = None, progress: Progress | None = None
) -> DutyStudy:
    """Calculate every bar of a conveyor's duty and sum up the year.

    Parameters
    ----------
    conveyor : Conveyor
        With operation; without a duty there, all its hours are at the flow and temperature of the spec.
    rtol : float, optional
        Relative tolerance of the contacts [-]; that of the spec without it.
    progress : callable, optional
        Called with what is done and the whole.

    Returns
    -------
    DutyStudy
        Bars, energy, cost, carbon dioxide.

    Raises
    ------
    InputError
        There is no operation, or a bar is refused (bulk that does not fit, a compound not known there).
    NoSolutionError
        A bar has no answer: a year with a hole has no energy.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland_duty.yaml")  # doctest: +SKIP
    >>> conveyor.analyse_duty(line).summary  # doctest: +SKIP
    """
    operation = conveyor.operation
    if operation is None:
        raise InputError("operation: missing; hours_per_year or duty say how the conveyor is used")
    entries = operation.duty or (DutyEntry(hours=operation.hours_per_year, share=quantity("100 %")),)
    variants = [_variant(conveyor, i, entry) for i, entry in enumerate(entries)]
    rows = []
    done = runs([Scene(variant) for variant in variants], rtol, progress)
    for i, (entry, variant, found) in enumerate(zip(entries, variants, done, strict=True)):
        if not isinstance(found, Run):
            raise NoSolutionError(f"operation.duty[{i}] ({_described(entry)}): {found}")
        rows.append(_row(entry, variant, found))
    year = duty_sums([row.step for row in rows])
    price, credit = operation.price, operation.feed_in_price
    factor, saved = operation.emission, operation.feed_in_emission
    return DutyStudy(
        conveyor=conveyor,
        rows=tuple(rows),
        year=year,
        cost=None
        if price is None
        else duty_cost(year, price=price.amount, credit=0.0 if credit is None else credit.amount),
        currency=None if price is None else price.currency,
        emission=None
        if factor is None
        else duty_emission(year, factor=factor.amount, credit_factor=0.0 if saved is None else saved.amount),
        emission_source=operation.emission_source,
        energy_per_tonne_km=duty_specific_energy(year, length=conveyor.route.length)
        if year.mass > 0.0
        else None,
    )


def _variant(conveyor: Conveyor, place: int, entry: DutyEntry) -> Conveyor:
    share = si(entry.share)
    if share == 1.0:
        case = LoadCase(name="duty")
    elif share == 0.0:
        case = LoadCase(name="duty", loading="empty")
    else:
        case = LoadCase(name="duty", loading="part load", share=entry.share)
    try:
        variant = with_case(conveyor, case, speed=entry.speed)
        return variant if entry.temperature is None else with_temperature(variant, entry.temperature)
    except InputError as error:
        raise InputError(f"operation.duty[{place}] ({_described(entry)}): {error}") from None


def _described(entry: DutyEntry) -> str:
    """The bar in words, for messages."""
    parts = [text(entry.hours), f"share {text(entry.share)}"]
    parts += [text(value) for value in (entry.temperature, entry.speed) if value is not None]
    return ", ".join(parts)


def _row(entry: DutyEntry, conveyor: Conveyor, found: Run) -> DutyRow:
    force = found.balance.forces.total
    return DutyRow(
        hours=si(entry.hours) / 3600.0,
        share=si(entry.share),
        temperature=si(conveyor.ambient.belt),
        speed=si(conveyor.belt.speed),
        flow=si(conveyor.material.flow),
        effective=force,
        shaft=shaft_power(conveyor, force),
        mains=mains_power(conveyor, force),
    )
