"""Compounds compared on one conveyor at several temperatures and speeds, with savings.

Loads and forces independent of the rubber are formed once per compound and speed; all contacts of a compound are solved
in one batch. A scene (compound, temperature and speed) without an answer (a compound outside its data, a contact that
splits) is listed with its reason, never filled in.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Final, Literal, NamedTuple, get_args

from pydantic import TypeAdapter, ValidationError

from conveyor import shelf
from conveyor.arguments.argument_types import check_arguments
from conveyor.arguments.limits import require_finite, require_workers
from conveyor.errors import ConveyorError, InputError
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.operation import BeltSpeed
from conveyor.models.variants import CoverChoice, distinct_values, require_rolling_contact, with_compound
from conveyor.pipeline import ProgressCallback
from conveyor.reuse import ReuseCache
from conveyor.rubber.lots import LARGEST_LOT_SCATTER, LOT_SCATTER
from conveyor.studies.comparison_scenes import (
    ComparedScene,
    CompoundStudy,
    Coverage,
    Refusal,
    affected_strands,
    calculate_compound,
    compared_scenes,
)
from conveyor.studies.duty import CalculatedYear, calculate_bars, sum_year
from conveyor.studies.worker_failures import report_lost_worker
from conveyor.units import Quantity, quantity, text

__all__ = [
    "CalculatedComparison",
    "ComparedScene",
    "Coverage",
    "Refusal",
    "compare_compounds",
    "with_compound",
]

RTOL = 1e-4
"""Relative tolerance of the contacts: a hundredth of the uncertainty of any rubber."""


_SPEED: Final[TypeAdapter[Quantity]] = TypeAdapter(BeltSpeed)


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedComparison:
    """All scenes of a comparison, in the order compound, speed, temperature.

    Attributes
    ----------
    conveyor : Conveyor
        The spec that was varied.
    compounds : tuple of RubberCompound
        In the order given; the first is the base unless another was named.
    base : str
        Name of the reference compound of the savings.
    cover : {"bottom", "top", "both"}
        Cover made of the compounds.
    scenes, refused : tuple
        Scenes with and without an answer.
    coverage : tuple of Coverage
        For each compound and temperature, the excited band against that of the data.
    lots : mapping
        Scatter of each compound's indentation from lot to lot.
    extra_costs : mapping
        Price of a belt of each compound above the base's [currency of the spec].
    years : mapping
        The year of `operation.duty` with each compound whose data cover all its bars; empty without a duty.
    bars : mapping
        The bars of these years as scenes, each at its own load, speed and temperature.
    """

    conveyor: Conveyor
    compounds: tuple[RubberCompound, ...]
    base: str
    cover: CoverChoice
    scenes: tuple[ComparedScene, ...]
    refused: tuple[Refusal, ...]
    coverage: tuple[Coverage, ...]
    lots: Mapping[str, LotScatter]
    extra_costs: Mapping[str, float]
    years: Mapping[str, CalculatedYear] = field(default_factory=dict)
    bars: Mapping[str, tuple[ComparedScene, ...]] = field(default_factory=dict)

    def __repr__(self) -> str:
        name, count = self.conveyor.name, len(self.compounds)
        scenes = f"{len(self.scenes)} scenes, {len(self.refused)} without an answer"
        return f'Comparison("{name}": {count} compounds, {scenes})'

    @property
    def covered(self) -> tuple[ComparedScene, ...]:
        """Scenes covered by their compound's data: only these are averaged, ranked and priced."""
        beyond = {(row.compound, row.temperature) for row in self.coverage if not row.covered}
        return tuple(scene for scene in self.scenes if (scene.compound, scene.temperature) not in beyond)

    def common(self, speed: float) -> tuple[float, ...]:
        """Temperatures [K] covered by all compounds at a speed [m/s], leaving out compounds that cover none."""
        known: dict[str, set[float]] = {}
        for scene in self.covered:
            if scene.speed == speed:
                known.setdefault(scene.compound, set()).add(scene.temperature)
        return tuple(sorted(set.intersection(*known.values()))) if known else ()

    def tested_alike(self, one: str, other: str) -> bool:
        """True if two compounds were tested on the same rolls and covers, at the same speeds and temperatures."""
        tests = {compound.name: {test.conditions for test in compound.tests} for compound in self.compounds}
        return bool(tests[one]) and tests[one] == tests[other]

    def difference(self, one: RankedPower, other: RankedPower) -> tuple[float, float]:
        """90 % interval of the power of one compound less that of another [W].

        The root of the squares of both errors. Of belts tested alike the common ones raise or lower both powers: what
        they have of the difference remains.
        """
        apart = one.motor - other.motor
        if self.tested_alike(one.compound, other.compound):
            common = [abs(mine - theirs) for mine, theirs in zip(one.common, other.common, strict=True)]
            below = math.hypot(one.own[0], other.own[1], common[0])
            above = math.hypot(one.own[1], other.own[0], common[1])
        else:
            below, above = math.hypot(one.whole[0], other.whole[1]), math.hypot(one.whole[1], other.whole[0])
        return apart - below, apart + above

    def differs_clearly(self, less: RankedPower, more: RankedPower) -> bool:
        """True if `more` exceeds `less` by more than both may be off, without what they have in common."""
        return self.difference(more, less)[0] > 0.0

    def groups(self, standings: Iterable[RankedPower]) -> list[list[RankedPower]]:
        """Compounds by power, the least first, grouped where they do not clearly differ from the first of the group."""
        grouped: list[list[RankedPower]] = []
        for one in sorted(standings, key=lambda standing: standing.motor):
            if grouped and not self.differs_clearly(grouped[-1][0], one):
                grouped[-1].append(one)
            else:
                grouped.append([one])
        return grouped

    def test_basis_differs(self, name: str) -> bool:
        """True if only one of a compound and the base has rolling-resistance tests that set its indentation."""
        if self.conveyor.calculation.anchor != "tests":
            return False
        tested = {compound.name: bool(compound.tests) for compound in self.compounds}
        return tested[name] != tested[self.base]


class LotScatter(NamedTuple):
    """Half-width of the 90 % interval of an indentation from lot to lot [-], and who states it."""

    half_width: float
    origin: Literal["given", "compound", "default"]


@dataclass(frozen=True)
class RankedPower:
    """Motor power of a compound, at one temperature or its mean over several, with its error.

    Attributes
    ----------
    compound : str
        Name.
    motor : float
        Motor power [W].
    whole, own : tuple of float
        Errors below and above [W]; `own` without those common to belts tested alike.
    """

    compound: str
    motor: float
    whole: tuple[float, float]
    own: tuple[float, float]

    @property
    def common(self) -> tuple[float, float]:
        """Errors below and above that belts tested alike have in common [W]."""
        low, high = (math.sqrt(max(a * a - b * b, 0.0)) for a, b in zip(self.whole, self.own, strict=True))
        return low, high

    @classmethod
    def of(cls, scenes: Sequence[ComparedScene]) -> RankedPower:
        """Mean of at least one scene of one compound.

        The error of the rubber is taken as equal at all temperatures; that of the contacts is added.
        """
        count = len(scenes)
        motor = math.fsum(scene.motor for scene in scenes) / count
        solved = math.fsum(scene.error * abs(scene.motor) for scene in scenes) / count

        def mean(ends: Iterable[float]) -> float:
            """Distance of the mean of the ends from the mean, with the error of the contacts."""
            return solved + abs(math.fsum(ends) / count - motor)

        return cls(
            scenes[0].compound,
            motor,
            (mean(scene.motor_low for scene in scenes), mean(scene.motor_high for scene in scenes)),
            (mean(scene.own_low for scene in scenes), mean(scene.own_high for scene in scenes)),
        )


@check_arguments
def compare_compounds(
    conveyor: Conveyor,
    compounds: Iterable[str | RubberCompound],
    *,
    temperatures: Iterable[str | Quantity] | None = None,
    speeds: Iterable[str | Quantity] | None = None,
    cover: CoverChoice = "bottom",
    base: str | None = None,
    extra_costs: Mapping[str, float] | None = None,
    lot_scatter: float | Mapping[str, float] | None = None,
    rtol: float = RTOL,
    shelves: Iterable[str | Path] = (),
    executor: Executor | None = None,
    workers: int = 1,
    progress: ProgressCallback | None = None,
) -> CalculatedComparison:
    """Calculate a conveyor with every compound at every temperature and speed.

    Parameters
    ----------
    conveyor : Conveyor
        The spec; its own temperature or speed is the default.
    compounds : iterable of str or RubberCompound
        Shelf names, paths of compound files, or compounds.
    temperatures, speeds : iterable of str or Quantity, optional
        Of the belt, each with its unit ("-30 degC", "5 m/s").
    cover : {"bottom", "top", "both"}
        Cover made of the compounds; the bottom cover runs on the carry rolls.
    base : str, optional
        Name of the reference compound; by default the first.
    extra_costs : mapping of str to float, optional
        Price of a belt of a compound above that of the base, in the currency of the spec's energy price.
    lot_scatter : float or mapping of str to float, optional
        Half-width of the 90 % interval of the indentation from lot to lot, of all compounds or by name [-]; by default
        what a compound's file states, else `conveyor.rubber.lots.LOT_SCATTER`.
    rtol : float
        Relative tolerance of the contacts [-].
    shelves : iterable of path
        Further folders of compounds.
    executor : concurrent.futures.Executor, optional
        Executor of groups of compounds; by default they are calculated one after the other in this process.
    workers : int
        Workers of the executor, and number of groups.
    progress : callable, optional
        Called with the number of compounds done and their total.

    Returns
    -------
    CalculatedComparison
        Scenes, ranking, refusals.

    Raises
    ------
    InputError
        No compound, one twice, an unknown base or name, a value without unit or outside its range, or a classical
        method of calculation.
    ConveyorError
        A worker was lost.
    """
    if cover not in get_args(CoverChoice):
        raise InputError(f'cover = "{cover}": allowed are {", ".join(get_args(CoverChoice))}')
    require_rolling_contact(conveyor, "compounds are compared")
    chosen = _resolve_compounds(compounds, shelves)
    require_workers(workers)
    at = [conveyor.ambient.belt] if temperatures is None else _read_quantities(temperatures, "temperature")
    runs = [conveyor.belt.speed] if speeds is None else _read_quantities(speeds, "speed")
    reference = chosen[0].name if base is None else _compound_name(base, chosen)
    costs = _read_costs(extra_costs or {}, chosen, reference)
    lots = _lots_of_compounds(chosen, lot_scatter)
    job = _ComparisonJob(conveyor, tuple(map(text, at)), tuple(map(text, runs)), cover, rtol, lots)
    answers: list[_CompoundAnswer] = []
    if progress is not None:
        progress(0, len(chosen))
    for some in _run_serially(job, chosen) if executor is None else _run_on_executor(executor, workers, job, chosen):
        answers += some
        if progress is not None:
            progress(len(answers), len(chosen))
    studies = [answer.study for answer in answers]
    years = {one.name: answer.year for one, answer in zip(chosen, answers, strict=True) if answer.year is not None}
    return CalculatedComparison(
        conveyor,
        chosen,
        reference,
        cover,
        tuple(one for study in studies for one in study.scenes),
        tuple(one for study in studies for one in study.refused),
        tuple(one for study in studies for one in study.coverage),
        lots,
        costs,
        {name: year.calculated for name, year in years.items()},
        {name: year.bars for name, year in years.items()},
    )


class _ComparedYear(NamedTuple):
    """The year of a duty with one compound, and its bars as scenes."""

    calculated: CalculatedYear
    bars: tuple[ComparedScene, ...]


class _CompoundAnswer(NamedTuple):
    """Scenes of one compound, and its year if it has one."""

    study: CompoundStudy
    year: _ComparedYear | None


@dataclass(frozen=True, eq=False)
class _ComparisonJob:
    """Inputs common to all compounds, in any process: quantities as text, as specs pickle theirs."""

    conveyor: Conveyor
    temperatures: tuple[str, ...]
    speeds: tuple[str, ...]
    cover: CoverChoice
    rtol: float
    lots: Mapping[str, LotScatter]

    def of(self, compound: RubberCompound, kept: ReuseCache) -> _CompoundAnswer:
        """Scenes and year of a compound."""
        scatter = self.lots[compound.name].half_width
        study = calculate_compound(
            self.conveyor,
            compound,
            [quantity(one, "temperature") for one in self.temperatures],
            [quantity(one, "speed") for one in self.speeds],
            cover=self.cover,
            rtol=self.rtol,
            lot_scatter=scatter,
            kept=kept,
        )
        return _CompoundAnswer(study, _duty_year(self.conveyor, compound, self.cover, self.rtol, scatter))


def _run_serially(job: _ComparisonJob, compounds: Sequence[RubberCompound]) -> Iterator[list[_CompoundAnswer]]:
    """Calculate compounds one after the other, reusing common results."""
    kept = ReuseCache()
    return ([job.of(compound, kept)] for compound in compounds)


def _run_on_executor(
    executor: Executor, workers: int, job: _ComparisonJob, compounds: Sequence[RubberCompound]
) -> Iterator[list[_CompoundAnswer]]:
    """Calculate compounds in as many groups as there are workers."""
    count = max(1, min(workers, len(compounds)))
    ends = [len(compounds) * k // count for k in range(count + 1)]
    asked = [executor.submit(_run_group, job, compounds[a:b]) for a, b in pairwise(ends)]
    try:
        with report_lost_worker("comparison"):
            for future in asked:
                yield future.result()
    finally:
        for future in asked:
            future.cancel()


def _run_group(job: _ComparisonJob, compounds: Sequence[RubberCompound]) -> list[_CompoundAnswer]:
    return [answer for some in _run_serially(job, compounds) for answer in some]


def _duty_year(
    conveyor: Conveyor, compound: RubberCompound, cover: CoverChoice, rtol: float, lot_scatter: float
) -> _ComparedYear | None:
    """The year of a duty; None without a duty, or if a bar has no answer or no data."""
    if not conveyor.duty:
        return None
    changed = with_compound(conveyor, compound, cover)
    try:
        bars = calculate_bars(changed, rtol=rtol)
    except ConveyorError:
        return None  # its scenes give the reason; the report remarks that it has no year
    year, strands = sum_year(changed, bars), affected_strands(changed, cover)
    bands = [(row.temperature, row.excited[strand]) for row in year.rows for strand in strands]
    asked = [Coverage(compound.name, t, band, compound.frequencies(t)) for t, band in bands if band]
    if not all(one.covered for one in asked):
        return None
    return _ComparedYear(year, compared_scenes(compound, bars, strands, lot_scatter))


def _resolve_compounds(
    given: Iterable[str | RubberCompound], shelves: Iterable[str | Path]
) -> tuple[RubberCompound, ...]:
    extra = tuple(shelves)
    chosen = tuple(item if isinstance(item, RubberCompound) else shelf.compound(item, extra=extra) for item in given)
    if not chosen:
        raise InputError("compounds: give at least one; `conveyor shelf` lists those at hand")
    names = [compound.name for compound in chosen]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f'compounds: "{twice}" is given twice; each one once, under its own name')
    return chosen


def _lots_of_compounds(
    compounds: Sequence[RubberCompound], given: float | Mapping[str, float] | None
) -> dict[str, LotScatter]:
    """Scatter from lot to lot of each compound: as given, as its file states, or the default."""
    by_name = given if isinstance(given, Mapping) else {} if given is None else {one.name: given for one in compounds}
    by_name = {_compound_name(name, compounds): value for name, value in by_name.items()}
    for name, value in by_name.items():
        if not 0.0 <= value <= LARGEST_LOT_SCATTER:
            raise InputError(f'lot_scatter of "{name}": got {value!r}, allowed: >= 0 and <= {LARGEST_LOT_SCATTER:g}')
    lots = {}
    for compound in compounds:
        stated = compound.stated_lot_scatter
        if compound.name in by_name:
            lots[compound.name] = LotScatter(by_name[compound.name], "given")
        elif stated is not None:
            lots[compound.name] = LotScatter(stated, "compound")
        else:
            lots[compound.name] = LotScatter(LOT_SCATTER, "default")
    return lots


def _compound_name(name: str, compounds: Sequence[RubberCompound]) -> str:
    """Name of one of the compounds, ignoring case."""
    for compound in compounds:
        if compound.name.casefold() == name.casefold():
            return compound.name
    listed = ", ".join(compound.name for compound in compounds)
    raise InputError(f'"{name}" is none of the compounds compared: {listed}')


def _read_costs(given: Mapping[str, float], compounds: Sequence[RubberCompound], base: str) -> dict[str, float]:
    """Extra cost of each compound's belt [currency]; that of the base is none by definition."""
    costs = {_compound_name(name, compounds): float(cost) for name, cost in given.items()}
    for name, cost in costs.items():
        require_finite(**{f'extra_costs of "{name}"': cost})
    if base in costs:
        raise InputError(
            f'extra_costs: got one for the base "{base}": they are above the price of its belt; give those of the '
            "others, or name another base"
        )
    return costs


def _read_quantities(given: Iterable[object], kind: str) -> list[Quantity]:
    """Temperatures or speeds, each named by its argument and place where it is refused."""
    quantities = []
    for place, item in enumerate(given):
        try:
            quantities.append(quantity(item, kind))
            if kind == "speed":
                _SPEED.validate_python(quantities[-1])
        except InputError as error:
            raise InputError(f"{kind}s[{place}]: {error}") from None
        except ValidationError as error:
            raise InputError(f"{kind}s[{place}]: {error.errors()[0]['msg']}") from None
    if not quantities:
        raise InputError(f"{kind}s: give at least one, or none at all for the spec's own")
    return distinct_values(quantities)
