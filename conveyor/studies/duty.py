"""Year of a conveyor from its duty: every bar of the histogram calculated, not scaled from full load."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from conveyor.arguments.argument_types import check_arguments
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.energy import DutyStep, DutySums, duty_emission, duty_specific_energy, duty_sums
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.line.stretches import STRANDS, Strand
from conveyor.loop.annual_energy import annual_cost
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.models import Conveyor, DutyEntry, LoadCase, Operation
from conveyor.models.variants import with_case, with_temperature
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.units import quantity


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
    excited : mapping of str to tuple or None
        Frequencies that hold 90 % of the loss of each strand's cover [Hz]; None without loss.
    """

    hours: float
    share: float
    temperature: float
    speed: float
    flow: float
    effective: float
    shaft: float
    mains: float
    excited: Mapping[Strand, tuple[float, float] | None]

    @property
    def step(self) -> DutyStep:
        """Input to the energy laws."""
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
class CalculatedYear:
    """A year of a conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    rows : tuple of DutyRow
        The bars.
    year : DutySums
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
    year: DutySums
    cost: float | None
    currency: str | None
    emission: float | None
    emission_source: str | None
    energy_per_tonne_km: float | None

    def __repr__(self) -> str:
        return f'DutyStudy("{self.conveyor.name}": {len(self.rows)} bars)'


@check_arguments
def analyse_duty(
    conveyor: Conveyor,
    *,
    take_up: TakeUpSetting | None = None,
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
) -> CalculatedYear:
    """Calculate every bar of a conveyor's duty and sum the year.

    Parameters
    ----------
    conveyor : Conveyor
        With operation; without a duty there, all its hours are at the flow and temperature of the spec.
    take_up : TakeUpSetting, optional
        Setting and side through the year, as `analyse_studies` determines them for every load; by default the least of
        each bar, as in `analyse`.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of the spec.
    progress : callable, optional
        Called with the items done and their total.

    Returns
    -------
    CalculatedYear
        Bars, energy, cost, carbon dioxide.

    Raises
    ------
    InputError
        There is no operation, or a bar is invalid (bulk that does not fit, a compound outside its data).
    NoSolutionError
        A bar has no answer.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland_10km.yaml")  # doctest: +SKIP
    >>> conveyor.analyse_duty(line).summary  # doctest: +SKIP
    """
    return sum_year(conveyor, calculate_bars(conveyor, take_up, rtol, progress))


def calculate_bars(
    conveyor: Conveyor,
    take_up: TakeUpSetting | None = None,
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
) -> tuple[CalculatedConveyor, ...]:
    """Every bar of a conveyor's duty, as `analyse_duty`.

    Raises
    ------
    InputError
        There is no operation, or a bar is invalid.
    NoSolutionError
        A bar has no answer.
    """
    entries = _duty_entries(conveyor)
    variants = [_duty_variant(conveyor, i, entry) for i, entry in enumerate(entries)]
    bars = []
    answers = calculate_many([Variant(one, take_up=take_up) for one in variants], rtol, progress)
    for i, (entry, result) in enumerate(zip(entries, answers, strict=True)):
        if not isinstance(result, CalculatedConveyor):
            raise NoSolutionError(f"operation.duty[{i}] ({entry}): {result}")
        bars.append(result)
    return tuple(bars)


def sum_year(conveyor: Conveyor, bars: Iterable[CalculatedConveyor]) -> CalculatedYear:
    """Year of a conveyor from the bars of its duty, calculated.

    Raises
    ------
    InputError
        There is no operation.
    """
    rows = tuple(_duty_row(entry, bar) for entry, bar in zip(_duty_entries(conveyor), bars, strict=True))
    operation = _operation_of(conveyor)
    year = duty_sums([row.step for row in rows])
    price, factor, saved = operation.price, operation.emission, operation.feed_in_emission
    return CalculatedYear(
        conveyor=conveyor,
        rows=rows,
        year=year,
        cost=annual_cost(operation, year),
        currency=None if price is None else price.currency,
        emission=None
        if factor is None
        else duty_emission(year, factor=factor.amount, credit_factor=0.0 if saved is None else saved.amount),
        emission_source=operation.emission_source,
        energy_per_tonne_km=duty_specific_energy(year, length=conveyor.route.length) if year.mass > 0.0 else None,
    )


def _operation_of(conveyor: Conveyor) -> Operation:
    """Operation of a conveyor, refused where there is none."""
    if conveyor.operation is None:
        raise InputError("operation: missing; hours_per_year or duty say how the conveyor is used")
    return conveyor.operation


def _duty_entries(conveyor: Conveyor) -> tuple[DutyEntry, ...]:
    """Bars of the duty; without one, all hours at full load."""
    operation = _operation_of(conveyor)
    return operation.duty or (DutyEntry(hours=operation.hours_per_year, share=quantity("100 %")),)


def _duty_variant(conveyor: Conveyor, place: int, entry: DutyEntry) -> Conveyor:
    if entry.load == 1.0:
        case = LoadCase(name="duty")
    elif entry.load == 0.0:
        case = LoadCase(name="duty", loading="empty")
    else:
        case = LoadCase(name="duty", loading="part load", share=entry.share)
    try:
        variant = with_case(conveyor, case, speed=entry.speed)
        return variant if entry.temperature is None else with_temperature(variant, entry.temperature)
    except InputError as error:
        raise InputError(f"operation.duty[{place}] ({entry}): {error}") from None


def _duty_row(entry: DutyEntry, result: CalculatedConveyor) -> DutyRow:
    power = result.balance.power
    return DutyRow(
        hours=entry.seconds / 3600.0,
        share=entry.load,
        temperature=result.temperature,
        speed=result.line.speed,
        flow=result.line.flow,
        effective=result.balance.forces.total,
        shaft=power.motor,
        mains=power.mains,
        excited={strand: result.contacts.excited_band(strand) for strand in STRANDS},
    )
