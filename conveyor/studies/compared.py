"""The scenes of a comparison: one compound on the conveyor at every temperature and speed.

Loads, and every force that no rubber changes, are formed once for each speed; all contacts of a compound are solved
side by side. A scene that has no answer (a compound outside its data, a contact that splits) is listed with its reason.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from conveyor.contact import solve_many
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.indentation import to_problem
from conveyor.line.stretches import Strand
from conveyor.line.walk import (
    RollResult,
    StretchResult,
    Surface,
    Track,
    fastest_excited,
    indented,
    slowest_excited,
    surfaces,
    worked_surfaces,
    worst_error,
)
from conveyor.loop.balance import Balance, balance
from conveyor.loop.curved import Run
from conveyor.loop.data import loop_data
from conveyor.models import Conveyor, RubberCompound
from conveyor.studies import scenes
from conveyor.studies.scenes import runs
from conveyor.studies.variants import with_temperature
from conveyor.units import Quantity, si

Cover = Literal["bottom", "top", "both"]

_BAND_RTOL = 1e-3  # of the contacts that the band is formed from: a tenth of the narrowest band
_BAND = (0.05, 0.95)  # quantiles of the replicas: nine tenths lie between


@dataclass(frozen=True)
class Scene:
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
    motor_low, motor_high : float or None
        Band in which nine tenths of the fit's replicas leave it [W]; None where the compound carries none.
    largest_tension : float
        Of the belt, start included [N].
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
    motor_low: float | None
    motor_high: float | None
    largest_tension: float
    energy_per_tonne_km: float | None
    energy_per_year: float | None
    cost_per_year: float | None
    error: float


@dataclass(frozen=True)
class Coverage:
    """What the rolls ask of a compound at a temperature, slowest to fastest speed, and what its data hold; SI.

    Attributes
    ----------
    compound : str
        Name.
    temperature : float
        Of the belt [K].
    excited : tuple of float
        Frequencies between which nine tenths of the loss lie [Hz].
    data : tuple of float or None
        Band of the data at this temperature [Hz]; None where the compound does not state it.
    """

    compound: str
    temperature: float
    excited: tuple[float, float]
    data: tuple[float, float] | None

    @property
    def covered(self) -> bool:
        """Whether the data hold all of it; not where they are not stated."""
        return self.data is not None and self.data[0] <= self.excited[0] and self.excited[1] <= self.data[1]


@dataclass(frozen=True)
class Refusal:
    """A scene without an answer, and why; SI."""

    compound: str
    temperature: float
    speed: float
    reason: str


@dataclass(frozen=True)
class Grid:
    """Temperatures and speeds to cross, the cover that changes, and the tolerance of the contacts [-]."""

    temperatures: tuple[Quantity, ...]
    speeds: tuple[Quantity, ...]
    cover: Cover
    rtol: float


@dataclass(frozen=True)
class Found:
    """What a comparison has found so far; lists that grow."""

    scenes: list[Scene]
    refused: list[Refusal]
    coverage: list[Coverage]


def with_compound(conveyor: Conveyor, compound: RubberCompound, cover: Cover) -> Conveyor:
    """The conveyor with a cover, or both, of another compound.

    A top cover without a compound of its own follows the bottom cover, as the spec says of it: where only the bottom
    cover changes, it is given the old one first.

    Raises
    ------
    InputError
        The belt's mass does not fit the compound's density.
    """
    belt = conveyor.belt
    top, bottom = belt.top_cover, belt.bottom_cover
    above = (top.compound or bottom.compound) if cover == "bottom" else compound
    below = bottom.compound if cover == "top" else compound
    return conveyor.replace(
        belt=belt.replace(top_cover=top.replace(compound=above), bottom_cover=bottom.replace(compound=below))
    )


@dataclass(frozen=True, eq=False)
class _Answer:
    """A conveyor at one speed, its stretches and the whole."""

    conveyor: Conveyor
    stretches: tuple[StretchResult, ...]
    balance: Balance


_Answers = dict[tuple[float, float], _Answer]


def of_compound(conveyor: Conveyor, compound: RubberCompound, grid: Grid, found: Found) -> None:
    """Every temperature and speed of one compound; all its contacts in one batch."""
    changed = with_compound(conveyor, compound, grid.cover)
    tracks = _tracks(changed, compound, grid, found)
    answered = (
        _in_full(compound, grid, tracks, found)
        if _follows_the_temperature(changed)
        else _by_rubber(changed, compound, (grid, tracks), found)
    )
    strands = _strands(changed, grid.cover)
    temperatures = dict.fromkeys(at for _, at in answered)
    bands = {
        t: _band(compound, t, [one.stretches for (_, at), one in answered.items() if at == t], strands)
        for t in temperatures
    }
    found.scenes.extend(
        _scene(compound.name, temperature, one, strands, bands[temperature])
        for (_, temperature), one in answered.items()
    )
    found.coverage.extend(_coverage(compound, temperatures, answered, strands))


def _follows_the_temperature(conveyor: Conveyor) -> bool:
    """Whether more than the rubber changes from scene to scene: roll drag with the air, loads with the tension."""
    rolls = [
        roll for each in (conveyor.idlers.carry, conveyor.idlers.return_) for roll in (each.roll, each.middle)
    ]
    return any(roll.drag_law is not None for roll in rolls) or any(
        section.curve is not None for section in conveyor.route.sections
    )


def _in_full(compound: RubberCompound, grid: Grid, tracks: Mapping[float, Track], found: Found) -> _Answers:
    """Every scene as a conveyor of its own; the air keeps its distance to the belt."""
    variants: dict[tuple[float, float], Conveyor] = {}
    for speed, track in tracks.items():
        for given in grid.temperatures:
            try:
                variants[speed, si(given)] = with_temperature(track.conveyor, given)
            except (InputError, RangeError) as error:
                found.refused.append(Refusal(compound.name, si(given), speed, str(error)))
    answered: _Answers = {}
    walked = runs([scenes.Scene(variant) for variant in variants.values()], grid.rtol)
    for ((speed, temperature), variant), run in zip(variants.items(), walked, strict=True):
        if isinstance(run, Run):
            answered[speed, temperature] = _Answer(variant, run.stretches, run.balance)
        else:
            found.refused.append(Refusal(compound.name, temperature, speed, str(run)))
    return answered


def _by_rubber(
    conveyor: Conveyor, compound: RubberCompound, work: tuple[Grid, Mapping[float, Track]], found: Found
) -> _Answers:
    """Only the rubber follows the temperature: loads and all other forces are those of the speed."""
    grid, tracks = work
    covers = _covers(conveyor, compound, grid, found)
    jobs: dict[tuple[float, float], dict[Strand, Surface]] = {}
    for speed, track in tracks.items():
        for temperature, cover in covers.items():
            try:
                jobs[speed, temperature] = worked_surfaces(track, cover, temperature)
            except (NoSolutionError, RangeError) as error:
                found.refused.append(Refusal(compound.name, temperature, speed, str(error)))
    answered: _Answers = {}
    walked = indented([tracks[speed] for speed, _ in jobs], list(jobs.values()))
    for (speed, temperature), results in zip(jobs, walked, strict=True):
        if isinstance(results, NoSolutionError):
            found.refused.append(Refusal(compound.name, temperature, speed, str(results)))
        else:
            at = tracks[speed].conveyor
            answered[speed, temperature] = _Answer(at, results, balance(at, results))
    return answered


def _covers(
    conveyor: Conveyor, compound: RubberCompound, grid: Grid, found: Found
) -> dict[float, dict[Strand, Surface]]:
    """Both covers at every temperature at which their compounds are known."""
    covers = {}
    for temperature in map(si, grid.temperatures):
        try:
            covers[temperature] = surfaces(conveyor, temperature)
        except RangeError as error:
            found.refused.extend(Refusal(compound.name, temperature, si(v), str(error)) for v in grid.speeds)
    return covers


def _tracks(conveyor: Conveyor, compound: RubberCompound, grid: Grid, found: Found) -> dict[float, Track]:
    """The conveyor at every speed at which it can run."""
    tracks = {}
    for speed in grid.speeds:
        try:
            tracks[si(speed)] = Track(conveyor.replace(belt=conveyor.belt.replace(speed=speed)), grid.rtol)
        except InputError as error:
            found.refused.extend(
                Refusal(compound.name, si(t), si(speed), str(error)) for t in grid.temperatures
            )
    return tracks


def _strands(conveyor: Conveyor, cover: Cover) -> frozenset[Strand]:
    """Strands whose rolls run on a changed cover."""
    if cover == "both":
        return frozenset(("carry", "return"))
    if cover == "bottom":
        return frozenset(("carry", "return") if conveyor.route.turned_over else ("carry",))
    return frozenset(() if conveyor.route.turned_over else ("return",))


def _scene(
    name: str,
    temperature: float,
    one: _Answer,
    strands: frozenset[Strand],
    band: tuple[float, float] | None,
) -> Scene:
    conveyor, found = one.conveyor, one.balance
    forces, power = found.forces, found.power
    low = high = None
    if band is not None:
        share = si(conveyor.calculation.flexure_share)
        changed = math.fsum(r.indentation for r in one.stretches if r.stretch.strand in strands) / (
            1.0 - share
        )
        motor = loop_data(conveyor).motor
        low, high = sorted(motor(forces.total + (factor - 1.0) * changed) for factor in band)
    return Scene(
        compound=name,
        temperature=temperature,
        speed=si(conveyor.belt.speed),
        indentation=forces.indentation,
        effective=forces.total,
        friction_factor=found.friction_factor,
        motor=power.motor,
        motor_low=low,
        motor_high=high,
        largest_tension=found.tensions.largest,
        energy_per_tonne_km=power.energy_per_tonne_km,
        energy_per_year=power.energy_per_year,
        cost_per_year=power.cost_per_year,
        error=worst_error(one.stretches),
    )


def _heaviest(results: Sequence[StretchResult], strands: frozenset[Strand]) -> RollResult | None:
    """The roll that loses most, of the strands whose cover is compared."""
    rolls = [roll for result in results if result.stretch.strand in strands for roll in result.rolls]
    return max(rolls, key=lambda roll: roll.resistance) if rolls else None


def _band(
    compound: RubberCompound,
    temperature: float,
    runs: Sequence[tuple[StretchResult, ...]],
    strands: frozenset[Strand],
) -> tuple[float, float] | None:
    """Factors on the indentation between which nine tenths of the fit's replicas lie, by the roll that loses most.

    Of the middle one of the speeds; other rolls and speeds excite nearly the same band of the rubber. Fit and replicas
    are both taken at the strain of the master curve: softening changes all alike.
    """
    replicas = compound.replicas(temperature)
    roll = _heaviest(runs[len(runs) // 2], strands) if runs else None
    if not replicas or roll is None:
        return None
    base = compound.series(temperature)
    contact, load = roll.curve.contact, roll.load.peak_line_load
    problems = [to_problem(replace(contact, rubber=rubber), load) for rubber in (base, *replicas)]
    friction = np.array([solution.friction for solution in solve_many(problems, _BAND_RTOL, throw=True)])
    low, high = np.quantile(friction[1:] / friction[0], _BAND)
    return float(low), float(high)


def _coverage(
    compound: RubberCompound,
    temperatures: Iterable[float],
    answered: Mapping[tuple[float, float], _Answer],
    strands: frozenset[Strand],
) -> Iterable[Coverage]:
    for temperature in temperatures:
        speeds = [speed for speed, t in answered if t == temperature]
        if not speeds:
            continue
        slowest, fastest = (answered[speed, temperature].stretches for speed in (min(speeds), max(speeds)))
        lows = [f for strand in strands if (f := slowest_excited(slowest, strand)) is not None]
        highs = [f for strand in strands if (f := fastest_excited(fastest, strand)) is not None]
        if lows and highs:
            data = compound.frequencies(temperature)
            yield Coverage(compound.name, temperature, (min(lows), max(highs)), data)
