"""Scenes of a comparison: one compound on the conveyor at every temperature and speed.

All contacts of a compound are solved in one batch. A scene without an answer (a compound outside its data, a contact
that splits) is listed with its reason.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.contact import solve_many
from conveyor.indentation import to_problem
from conveyor.line.contacts import RollResult
from conveyor.line.stretches import Strand
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.variants import CoverChoice, crossed_settings, with_compound
from conveyor.pipeline import calculate_many
from conveyor.reuse import ReuseCache
from conveyor.rubber.rolling_test_factor import quantile_band
from conveyor.units import Quantity

_BAND_RTOL = 1e-3  # of the contacts behind the band: a tenth of the narrowest band


@dataclass(frozen=True)
class ComparedScene:
    """One compound at one temperature and speed on the conveyor, SI.

    Attributes
    ----------
    compound : str
        Name.
    temperature, speed : float
        Of the belt [K], [m/s].
    indentation, effective : float
        Indentation of both strands, effective tension [N].
    friction_factor : float
        The f that DIN 22101's main resistance would need [-].
    motor : float
        Motor power [W].
    rubber : float
        Part of the motor power that goes with the compound: indentation of the strands compared [W].
    motor_low, motor_high : float
        90 % band from lot to lot, and from the tests or the replicas of the fit where the compound has them [W].
    own_low, own_high : float
        The same without errors common to belts tested alike [W].
    largest_tension : float
        Belt tension, start included [N].
    energy_per_tonne_km, energy_per_year, cost_per_year : float or None
        [kWh/(t km)], [kWh], [currency].
    error : float
        Largest relative error estimate of the contacts [-].
    """

    compound: str
    temperature: float
    speed: float
    indentation: float
    effective: float
    friction_factor: float
    motor: float
    rubber: float
    motor_low: float
    motor_high: float
    own_low: float
    own_high: float
    largest_tension: float
    energy_per_tonne_km: float | None
    energy_per_year: float | None
    cost_per_year: float | None
    error: float


@dataclass(frozen=True)
class Coverage:
    """Frequency band excited in a compound at a temperature, slowest to fastest speed, and that of its data; SI.

    Attributes
    ----------
    compound : str
        Name.
    temperature : float
        Of the belt [K].
    excited : tuple of float
        Frequencies between which 90 % of the loss lies [Hz].
    data : tuple of float or None
        Band of the data at this temperature [Hz]; None if the compound does not state it.
    """

    compound: str
    temperature: float
    excited: tuple[float, float]
    data: tuple[float, float] | None

    @property
    def covered(self) -> bool:
        """True if the data are stated and cover the whole excited band."""
        return self.data is not None and self.data[0] <= self.excited[0] and self.excited[1] <= self.data[1]


@dataclass(frozen=True)
class Refusal:
    """A scene without an answer, and the reason; SI."""

    compound: str
    temperature: float
    speed: float
    reason: str


@dataclass(frozen=True)
class CompoundStudy:
    """One compound at every temperature and speed."""

    scenes: tuple[ComparedScene, ...]
    refused: tuple[Refusal, ...]
    coverage: tuple[Coverage, ...]


def calculate_compound(
    conveyor: Conveyor,
    compound: RubberCompound,
    temperatures: Sequence[Quantity],
    speeds: Sequence[Quantity],
    *,
    cover: CoverChoice,
    rtol: float,
    lot_scatter: float,
    kept: ReuseCache | None = None,
) -> CompoundStudy:
    """Calculate every temperature and speed of one compound.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    compound : RubberCompound
        Compound of the cover.
    temperatures, speeds : sequence of Quantity
        Of the belt.
    cover : {"bottom", "top", "both"}
        Cover that changes.
    rtol : float
        Relative tolerance of the contacts [-].
    lot_scatter : float
        Half-width of the 90 % interval of the indentation from lot to lot [-].
    kept : ReuseCache, optional
        Results shared with earlier compounds: lines, and the rolls under an unchanged cover.

    Raises
    ------
    InputError
        The belt's mass does not fit the compound's density.
    """
    changed = with_compound(conveyor, compound, cover)
    strands = affected_strands(changed, cover)
    settings = list(crossed_settings(changed, temperatures, speeds))
    going = [(s, s.conveyor) for s in settings if isinstance(s.conveyor, Conveyor)]
    runs: dict[float, list[int]] = {}
    for i, (setting, _) in enumerate(going):
        runs.setdefault(setting.temperature, []).append(i)
    variants = [Variant(c, s.temperature, design_friction=1.0) for s, c in going]
    answers = iter(calculate_many(variants, rtol, kept=kept, runs=runs.values()))
    solved: list[CalculatedConveyor] = []
    refused = []
    for setting in settings:
        answer = next(answers) if isinstance(setting.conveyor, Conveyor) else setting.conveyor
        if isinstance(answer, CalculatedConveyor):
            solved.append(answer)
        else:
            refused.append(Refusal(compound.name, setting.temperature, setting.speed, str(answer)))
    by_temperature = _by_temperature(solved)
    coverage = (_frequency_coverage(compound, at, ones, strands) for at, ones in by_temperature.items())
    return CompoundStudy(
        compared_scenes(compound, solved, strands, lot_scatter),
        tuple(refused),
        tuple(one for one in coverage if one is not None),
    )


def compared_scenes(
    compound: RubberCompound, results: Sequence[CalculatedConveyor], strands: frozenset[Strand], lot_scatter: float
) -> tuple[ComparedScene, ...]:
    """Scenes of calculated conveyors, each with the band of its compound at its own temperature."""
    bands = {
        at: tuple(_with_lots(band, lot_scatter) for band in _indentation_band(compound, at, ones, strands))
        for at, ones in _by_temperature(results).items()
    }
    return tuple(_compared_scene(compound.name, one, strands, bands[one.temperature]) for one in results)


def _by_temperature(results: Iterable[CalculatedConveyor]) -> dict[float, list[CalculatedConveyor]]:
    """Results by the temperature of the belt [K]."""
    grouped: dict[float, list[CalculatedConveyor]] = {}
    for one in results:
        grouped.setdefault(one.temperature, []).append(one)
    return grouped


def affected_strands(conveyor: Conveyor, cover: CoverChoice) -> frozenset[Strand]:
    """Strands whose rolls run on a changed cover."""
    if cover == "both":
        return frozenset(("carry", "return"))
    if cover == "bottom":
        return frozenset(("carry", "return") if conveyor.bottom_cover_on_both else ("carry",))
    return frozenset(() if conveyor.bottom_cover_on_both else ("return",))


_Bands: TypeAlias = tuple[tuple[float, float], ...]


def _with_lots(band: tuple[float, float], lot_scatter: float) -> tuple[float, float]:
    """Band of the factor on the indentation with the scatter of lots: root of the squares at both ends."""
    low, high = band
    return 1.0 - math.hypot(1.0 - low, lot_scatter), 1.0 + math.hypot(high - 1.0, lot_scatter)


def _compared_scene(name: str, one: CalculatedConveyor, strands: frozenset[Strand], bands: _Bands) -> ComparedScene:
    balance, year = one.balance, one.year
    forces, power = balance.forces, balance.power
    indented = balance.along[0].by_strand()
    changed = math.fsum(indented[strand] for strand in strands) / (1.0 - (one.line.flexure_share or 0.0))
    motor = balance.layout.motor
    powers = [sorted(motor(forces.total + (factor - 1.0) * changed) for factor in band) for band in bands]
    whole, own = ((low, high) for low, high in powers)
    return ComparedScene(
        compound=name,
        temperature=one.temperature,
        speed=one.line.speed,
        indentation=forces.indentation,
        effective=forces.total,
        friction_factor=balance.friction_factor,
        motor=power.motor,
        rubber=power.motor - motor(forces.total - changed),
        motor_low=whole[0],
        motor_high=whole[1],
        own_low=own[0],
        own_high=own[1],
        largest_tension=balance.equilibrium.largest,
        energy_per_tonne_km=power.energy_per_tonne_km,
        energy_per_year=None if year is None else year.energy,
        cost_per_year=None if year is None else year.cost,
        error=one.error_estimate,
    )


def _highest_loss_roll(result: CalculatedConveyor, strands: frozenset[Strand]) -> RollResult | None:
    """Roll with the highest loss, of the strands whose cover is compared."""
    pairs = zip(result.line.stretches, result.contacts.rolls, strict=True)
    rolls = [roll for stretch, several in pairs if stretch.strand in strands for roll in several]
    return max(rolls, key=lambda roll: roll.resistance) if rolls else None


def _indentation_band(
    compound: RubberCompound,
    temperature: float,
    results: Sequence[CalculatedConveyor],
    strands: frozenset[Strand],
) -> _Bands:
    """90 % bands of the indentation factor from the tests, else from the replicas of the fit; whole and own.

    Without both it is 1. The own band leaves out errors common to belts tested alike. Replicas are evaluated for the
    roll with the highest loss at the middle speed: other rolls and speeds excite nearly the same band. Fit and replicas
    are both taken at the strain of the master curve: softening changes all alike.
    """
    middle = results[len(results) // 2]
    roll = _highest_loss_roll(middle, strands)
    tested = [strand for strand in strands if middle.contacts.covers[strand].test_factor is not None]
    if tested:
        both = [[middle.contacts.test_factor_range(strand, own=own) for strand in tested] for own in (False, True)]
        whole, own = ((min(low for low, _ in each), max(high for _, high in each)) for each in both)
        return whole, own
    replicas = compound.replicas(temperature)
    if not replicas or roll is None:
        return (1.0, 1.0), (1.0, 1.0)
    base = compound.series(temperature)
    contact, load = roll.curve.contact, roll.load.peak_line_load
    problems = [to_problem(replace(contact, series=rubber), load) for rubber in (base, *replicas)]
    friction = np.array([solution.friction for solution in solve_many(problems, _BAND_RTOL, throw=True)])
    band = quantile_band(friction[1:] / friction[0])
    return band, band


def _frequency_coverage(
    compound: RubberCompound,
    temperature: float,
    results: Sequence[CalculatedConveyor],
    strands: Iterable[Strand],
) -> Coverage | None:
    """Band excited by the rolls from the slowest to the fastest speed; None without loss."""
    slowest, fastest = (
        min(results, key=lambda one: one.line.speed),
        max(results, key=lambda one: one.line.speed),
    )
    lows = [f for strand in strands if (f := slowest.contacts.slowest_excited(strand)) is not None]
    highs = [f for strand in strands if (f := fastest.contacts.fastest_excited(strand)) is not None]
    if not lows or not highs:
        return None
    return Coverage(compound.name, temperature, (min(lows), max(highs)), compound.frequencies(temperature))
