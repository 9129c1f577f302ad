"""Compounds, temperatures and speeds on one conveyor: what the better rubber saves.

Loads and every force that no rubber changes are formed once for each compound and speed; all contacts of a compound are
solved side by side. A scene that has no answer (a compound outside its data, a contact that splits) is listed with its
reason, never filled in.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, get_args

from pydantic import TypeAdapter, ValidationError

from conveyor import shelf
from conveyor.arguments import checked
from conveyor.errors import ConveyorError, InputError
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.operation import BeltSpeed
from conveyor.models.variants import CoverChoice, distinct, with_compound
from conveyor.pipeline import Kept, Progress
from conveyor.studies.comparison_scenes import ComparedScene, Coverage, Refusal, of_compound, strands_of
from conveyor.studies.duty import CalculatedYear, analyse_duty
from conveyor.units import Quantity, quantity

__all__ = [
    "CalculatedComparison",
    "ComparedScene",
    "Coverage",
    "Refusal",
    "compare_compounds",
    "with_compound",
]

RTOL = 1e-4
"""Relative tolerance of the contacts: a hundredth of what any rubber is known to."""


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
        Name of the compound that savings are counted against.
    cover : {"bottom", "top", "both"}
        Which cover took the compounds.
    scenes, refused : tuple
        What was answered, and what was not.
    coverage : tuple of Coverage
        For each compound and temperature, whether the data cover what the rolls ask for.
    extra_costs : mapping
        Price of a belt of each compound above the base's [currency of the spec].
    years : mapping
        The year of `operation.duty` with each compound whose data reach all its bars; empty without a duty.
    """

    conveyor: Conveyor
    compounds: tuple[RubberCompound, ...]
    base: str
    cover: CoverChoice
    scenes: tuple[ComparedScene, ...]
    refused: tuple[Refusal, ...]
    coverage: tuple[Coverage, ...]
    extra_costs: Mapping[str, float]
    years: Mapping[str, CalculatedYear] = field(default_factory=dict)

    def __repr__(self) -> str:
        name, count = self.conveyor.name, len(self.compounds)
        scenes = f"{len(self.scenes)} scenes, {len(self.refused)} without an answer"
        return f'Comparison("{name}": {count} compounds, {scenes})'

    @property
    def covered(self) -> tuple[ComparedScene, ...]:
        """Scenes that the data of their compound reach: only these are averaged, ranked and priced."""
        beyond = {(row.compound, row.temperature) for row in self.coverage if not row.covered}
        return tuple(scene for scene in self.scenes if (scene.compound, scene.temperature) not in beyond)

    def common(self, speed: float) -> tuple[float, ...]:
        """Temperatures [K] that the data of every compound reach at a speed [m/s]; those that reach none left out."""
        known: dict[str, set[float]] = {}
        for scene in self.covered:
            if scene.speed == speed:
                known.setdefault(scene.compound, set()).add(scene.temperature)
        return tuple(sorted(set.intersection(*known.values()))) if known else ()

    def level_differs(self, name: str) -> bool:
        """Whether tests set the indentation of one of a compound and the base, and theory that of the other."""
        if self.conveyor.calculation.anchor != "tests":
            return False
        tested = {compound.name: bool(compound.tests) for compound in self.compounds}
        return tested[name] != tested[self.base]


@checked
def compare_compounds(
    conveyor: Conveyor,
    compounds: Iterable[str | RubberCompound],
    *,
    temperatures: Iterable[str | Quantity] | None = None,
    speeds: Iterable[str | Quantity] | None = None,
    cover: CoverChoice = "bottom",
    base: str | None = None,
    extra_costs: Mapping[str, float] | None = None,
    rtol: float = RTOL,
    shelves: Iterable[str | Path] = (),
    progress: Progress | None = None,
) -> CalculatedComparison:
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
    CalculatedComparison
        Scenes, ranking, refusals.

    Raises
    ------
    InputError
        No compound, one twice, an unknown base or name, a value without unit or outside its range.
    """
    if cover not in get_args(CoverChoice):
        raise InputError(f'cover = "{cover}": allowed are {", ".join(get_args(CoverChoice))}')
    chosen = _compounds(compounds, shelves)
    at = [conveyor.ambient.belt] if temperatures is None else _quantities(temperatures, "temperature")
    runs = [conveyor.belt.speed] if speeds is None else _quantities(speeds, "speed")
    costs = {_named(name, chosen): cost for name, cost in (extra_costs or {}).items()}
    reference = chosen[0].name if base is None else _named(base, chosen)
    studies, kept = [], Kept()
    for done, compound in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        studies.append(of_compound(conveyor, compound, at, runs, cover=cover, rtol=rtol, kept=kept))
    if progress is not None:
        progress(len(chosen), len(chosen))
    return CalculatedComparison(
        conveyor,
        chosen,
        reference,
        cover,
        tuple(one for study in studies for one in study.scenes),
        tuple(one for study in studies for one in study.refused),
        tuple(one for study in studies for one in study.coverage),
        costs,
        _years(conveyor, chosen, cover, rtol),
    )


def _years(
    conveyor: Conveyor, compounds: Sequence[RubberCompound], cover: CoverChoice, rtol: float
) -> dict[str, CalculatedYear]:
    """The year of a duty with each compound; none of one that a bar of it has no answer for, or no data."""
    years: dict[str, CalculatedYear] = {}
    if conveyor.duty:
        for compound in compounds:
            changed = with_compound(conveyor, compound, cover)
            try:
                year = analyse_duty(changed, rtol=rtol)
            except ConveyorError:
                continue  # its scenes say why; the report's remarks says that it has no year
            strands = strands_of(changed, cover)
            bands = [(row.temperature, row.excited[strand]) for row in year.rows for strand in strands]
            asked = [Coverage(compound.name, t, band, compound.frequencies(t)) for t, band in bands if band]
            if all(one.covered for one in asked):
                years[compound.name] = year
    return years


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


def _check_speed(given: Quantity) -> None:
    """Refuse a speed that no belt runs at, as its field in a spec does."""
    try:
        _SPEED.validate_python(given)
    except ValidationError as error:
        raise InputError(f"speed: {error.errors()[0]['msg']}") from None


def _quantities(given: Iterable[str | Quantity], kind: str) -> list[Quantity]:
    quantities = [quantity(item, kind) for item in given]
    if kind == "speed":
        for item in quantities:
            _check_speed(item)
    if not quantities:
        raise InputError(f"{kind}s: give at least one, or none at all for the spec's own")
    return distinct(quantities)
