"""Compounds, temperatures and speeds on one conveyor: what the better rubber saves.

Loads and every force that no rubber changes are formed once for each compound and speed; all contacts of a compound are
solved side by side. A scene that has no answer (a compound outside its data, a contact that splits) is listed with its
reason, never filled in.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from conveyor import shelf
from conveyor.balance import balance
from conveyor.contact import solve_many
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.indentation import to_problem
from conveyor.line import (
    RollResult,
    StretchResult,
    Surface,
    Track,
    fastest_excited,
    indented,
    slowest_excited,
    surfaces,
    worked_surfaces,
)
from conveyor.models import Conveyor, RubberCompound
from conveyor.power import belt_power, motor_power
from conveyor.stretches import Strand
from conveyor.units import Quantity, quantity, si

if TYPE_CHECKING:
    import pandas as pd

Cover = Literal["bottom", "top", "both"]
Progress = Callable[[int, int], None]

RTOL = 1e-4
"""Relative tolerance of the contacts: a hundredth of what any rubber is known to."""
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


@dataclass(frozen=True, eq=False)
class Comparison:
    """All scenes of a comparison, in the order compound, speed, temperature.

    Attributes
    ----------
    conveyor : Conveyor
        The spec that was varied.
    compounds : tuple of RubberCompound
        In the order given; the first is the base unless another was named.
    base : str
        Name of the compound that savings are counted against.
    cover : {"bottom", "top", "both"}
        Which cover took the compounds.
    scenes, refused : tuple
        What was answered, and what was not.
    coverage : tuple of Coverage
        For each compound and temperature, whether the data cover what the rolls ask for.
    extra_costs : mapping
        Price of a belt of each compound above the base's [currency of the spec].
    """

    conveyor: Conveyor
    compounds: tuple[RubberCompound, ...]
    base: str
    cover: Cover
    scenes: tuple[Scene, ...]
    refused: tuple[Refusal, ...]
    coverage: tuple[Coverage, ...]
    extra_costs: Mapping[str, float]

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a scene; units in the names."""
        from conveyor.report import comparing

        return comparing.scenes(self)

    @cached_property
    def ranking(self) -> pd.DataFrame:
        """One row a compound and speed, the least mean power first; savings and payback against the base."""
        from conveyor.report import comparing

        return comparing.ranking(self)

    def to_excel(self, path: str | Path) -> Path:
        """Write the workbook.

        Raises
        ------
        InputError
            The path cannot be written.
        """
        from conveyor.report.excel import write_comparison

        return write_comparison(self, Path(path))


def compare(conveyor: Conveyor, compounds: Iterable[str | RubberCompound], **options: Any) -> pd.DataFrame:
    """The table of `compare_compounds`, one row a scene; its options are those of `compare_compounds`.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
    >>> conveyor.compare(line, ["s100", "s120"], temperatures=["0 degC", "20 degC"])  # doctest: +SKIP
    """
    return compare_compounds(conveyor, compounds, **options).table


def compare_compounds(
    conveyor: Conveyor,
    compounds: Iterable[str | RubberCompound],
    *,
    temperatures: Iterable[str | Quantity] | None = None,
    speeds: Iterable[str | Quantity] | None = None,
    cover: Cover = "bottom",
    base: str | None = None,
    extra_costs: Mapping[str, float] | None = None,
    rtol: float = RTOL,
    shelves: Iterable[str | Path] = (),
    progress: Progress | None = None,
) -> Comparison:
    """Calculate a conveyor with every compound at every temperature and speed.

    Parameters
    ----------
    conveyor : Conveyor
        The spec; where temperatures or speeds are not given, its own.
    compounds : iterable of str or RubberCompound
        Shelf names, paths of compound files, or compounds.
    temperatures, speeds : iterable of str or Quantity, optional
        Of the belt, each with its unit ("-30 degC", "5 m/s").
    cover : {"bottom", "top", "both"}
        Which cover is made of the compounds: the bottom cover runs on the carry rolls.
    base : str, optional
        Name of the compound that the others are compared with; the first without it.
    extra_costs : mapping of str to float, optional
        What a belt of a compound costs more than one of the base, in the currency of the spec's energy price.
    rtol : float
        Relative tolerance of the contacts [-].
    shelves : iterable of path
        Further folders of compounds.
    progress : callable, optional
        Called with the number of compounds done and their total.

    Returns
    -------
    Comparison
        Scenes, ranking, refusals.

    Raises
    ------
    InputError
        No compound, one twice, an unknown base or name, a value without unit or outside its range.
    """
    chosen = _compounds(compounds, shelves)
    at = [conveyor.ambient.belt] if temperatures is None else _quantities(temperatures, "temperature")
    runs = [conveyor.belt.speed] if speeds is None else _quantities(speeds, "speed")
    costs = {_named(name, chosen): cost for name, cost in (extra_costs or {}).items()}
    reference = chosen[0].name if base is None else _named(base, chosen)
    found = _Found([], [], [])
    for done, compound in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        _of_compound(conveyor, compound, _Grid(tuple(at), tuple(runs), cover, rtol), found)
    if progress is not None:
        progress(len(chosen), len(chosen))
    return Comparison(
        conveyor,
        chosen,
        reference,
        cover,
        tuple(found.scenes),
        tuple(found.refused),
        tuple(found.coverage),
        costs,
    )


def _compounds(
    given: Iterable[str | RubberCompound], shelves: Iterable[str | Path]
) -> tuple[RubberCompound, ...]:
    extra = tuple(shelves)
    chosen = tuple(
        item if isinstance(item, RubberCompound) else shelf.compound(item, extra=extra) for item in given
    )
    if not chosen:
        raise InputError("compounds: give at least one; `conveyor shelf` lists those at hand")
    names = [compound.name for compound in chosen]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f'compounds: "{twice}" is given twice; each one once, under its own name')
    return chosen


def _named(name: str, compounds: Sequence[RubberCompound]) -> str:
    """Name of one of the compounds, in any case."""
    for compound in compounds:
        if compound.name.casefold() == name.casefold():
            return compound.name
    listed = ", ".join(compound.name for compound in compounds)
    raise InputError(f'"{name}" is none of the compounds compared: {listed}')


def _quantities(given: Iterable[str | Quantity], kind: str) -> list[Quantity]:
    found = [quantity(item, kind) for item in given]
    if not found:
        raise InputError(f"{kind}s: give at least one, or none at all for the spec's own")
    return list({si(item): item for item in found}.values())


@dataclass(frozen=True)
class _Grid:
    temperatures: tuple[Quantity, ...]
    speeds: tuple[Quantity, ...]
    cover: Cover
    rtol: float


@dataclass(frozen=True)
class _Found:
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


def _of_compound(conveyor: Conveyor, compound: RubberCompound, grid: _Grid, found: _Found) -> None:
    """Every temperature and speed of one compound; all its contacts in one batch."""
    changed = with_compound(conveyor, compound, grid.cover)
    covers, tracks = _covers(changed, compound, grid, found), _tracks(changed, compound, grid, found)
    jobs: dict[tuple[float, float], dict[Strand, Surface]] = {}
    for speed, track in tracks.items():
        for temperature, cover in covers.items():
            try:
                jobs[speed, temperature] = worked_surfaces(track, cover, temperature)
            except (NoSolutionError, RangeError) as error:
                found.refused.append(Refusal(compound.name, temperature, speed, str(error)))
    walked = indented([tracks[speed] for speed, _ in jobs], list(jobs.values()))
    strands = _strands(changed, grid.cover)
    answered: dict[tuple[float, float], tuple[StretchResult, ...]] = {}
    for (speed, temperature), results in zip(jobs, walked, strict=True):
        if isinstance(results, NoSolutionError):
            found.refused.append(Refusal(compound.name, temperature, speed, str(results)))
        else:
            answered[speed, temperature] = results
    bands = {
        t: _band(compound, t, [results for (_, at), results in answered.items() if at == t], strands)
        for t in covers
    }
    found.scenes.extend(
        _scene(compound.name, temperature, (tracks[speed].conveyor, results), strands, bands[temperature])
        for (speed, temperature), results in answered.items()
    )
    found.coverage.extend(_coverage(compound, covers, answered, strands))


def _covers(
    conveyor: Conveyor, compound: RubberCompound, grid: _Grid, found: _Found
) -> dict[float, dict[Strand, Surface]]:
    """Both covers at every temperature at which their compounds are known."""
    covers = {}
    for temperature in map(si, grid.temperatures):
        try:
            covers[temperature] = surfaces(conveyor, temperature)
        except RangeError as error:
            found.refused.extend(Refusal(compound.name, temperature, si(v), str(error)) for v in grid.speeds)
    return covers


def _tracks(conveyor: Conveyor, compound: RubberCompound, grid: _Grid, found: _Found) -> dict[float, Track]:
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
    run: tuple[Conveyor, tuple[StretchResult, ...]],
    strands: frozenset[Strand],
    band: tuple[float, float] | None,
) -> Scene:
    conveyor, results = run
    found = balance(conveyor, results)
    forces, power = found.forces, found.power
    low = high = None
    if band is not None:
        share = si(conveyor.calculation.flexure_share)
        changed = math.fsum(r.indentation for r in results if r.stretch.strand in strands) / (1.0 - share)
        low, high = sorted(_motor(conveyor, forces.total + (factor - 1.0) * changed) for factor in band)
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
        error=max(roll.curve.curve.error for result in results for roll in result.rolls),
    )


def _motor(conveyor: Conveyor, force: float) -> float:
    belt = belt_power(force, belt_speed=si(conveyor.belt.speed))
    return motor_power(belt, efficiency=si(conveyor.drive.efficiency))


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
    covers: Mapping[float, object],
    answered: Mapping[tuple[float, float], tuple[StretchResult, ...]],
    strands: frozenset[Strand],
) -> Iterable[Coverage]:
    for temperature in covers:
        speeds = [speed for speed, t in answered if t == temperature]
        if not speeds:
            continue
        slowest, fastest = (answered[speed, temperature] for speed in (min(speeds), max(speeds)))
        lows = [f for strand in strands if (f := slowest_excited(slowest, strand)) is not None]
        highs = [f for strand in strands if (f := fastest_excited(fastest, strand)) is not None]
        if lows and highs:
            data = compound.frequencies(temperature)
            yield Coverage(compound.name, temperature, (min(lows), max(highs)), data)
