"""Indentation loss of compounds under single rolls over line load, temperature, roll, cover and speed, for tests.

Rows as laboratories measure them (DIN 22123, AS 1334.13, CEMA-7 test one roll under line loads at temperatures and
speeds), computed like the rolls of a conveyor, all contacts in one batch.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Final, TypeAlias

from pydantic import TypeAdapter, ValidationError

from conveyor import shelf
from conveyor.arguments.argument_types import check_arguments
from conveyor.calculated_conveyor import CalculatedConveyor, StretchResult, Variant
from conveyor.errors import ConveyorError, InputError, NoSolutionError, RangeError
from conveyor.indentation import IndentationCurve, RollContact, indentation_curves
from conveyor.indentation.softening import SofteningCover, soften_or_raise
from conveyor.line.rolling_test_theory import compound_test_factor
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.operation import BeltSpeed, EarthTemperature
from conveyor.models.variants import with_compound
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.rubber import PronySeries
from conveyor.rubber.rolling_test_factor import RollingTestFactor
from conveyor.units import Bounds, Length, LineForce, Quantity, Thickness, read_si, text

Given: TypeAlias = Iterable[str | Quantity]
LINE_LOADS: Final = ("1 N/mm", "2 N/mm", "4 N/mm", "6 N/mm", "8 N/mm")
TEMPERATURES: Final = ("-20 degC", "-10 degC", "0 degC", "10 degC", "20 degC", "30 degC", "40 degC")
ROLL_DIAMETERS: Final = ("159 mm", "194 mm", "219 mm")
SPEEDS: Final = ("2.5 m/s", "5 m/s", "7.5 m/s")
COVERS: Final = ("6 mm", "7 mm", "8 mm")
"""Usual test and design values: rolls of ISO 1537; loads, temperatures and covers of the published tests of
low-resistance covers (219 mm roll, 7 mm cover, 1 to 8 N/mm, 20 degC: CEMA-7)."""
SPACING: Final = 1.2
"""Roll spacing [m]; a confined cover recovers within a few thicknesses, so it hardly matters."""
MOST_POINTS: Final = 100_000
_AXES: Final[dict[str, tuple[str, TypeAdapter[Any]]]] = {
    "line_loads": ("line force", TypeAdapter(Annotated[LineForce, Bounds(ge="1 N/m", le="100 kN/m")])),
    "temperatures": ("temperature", TypeAdapter(EarthTemperature)),
    "roll_diameters": ("length", TypeAdapter(Annotated[Length, Bounds(ge="20 mm", le="1 m")])),
    "speeds": ("speed", TypeAdapter(BeltSpeed)),
    "covers": ("thickness", TypeAdapter(Annotated[Thickness, Bounds(ge="1 mm", le="100 mm")])),
}
"""Kind and range of every axis: as fields of a spec, line loads to ten times those of the heaviest roll."""


@dataclass(frozen=True)
class VerificationRow:
    """Loss of a compound under a roll at a temperature and speed, by line load, or the reason why it is unknown.

    Attributes
    ----------
    compound : str
        Its name.
    cover, diameter, speed, temperature : float
        Thickness, roll [m]; belt speed [m/s]; of the cover [K].
    resistances : tuple of float or None
        Indentation resistance per width at every line load [N/m].
    reason : str
        Reason if there is none.
    """

    compound: str
    cover: float
    diameter: float
    speed: float
    temperature: float
    resistances: tuple[float | None, ...]
    reason: str = ""


@dataclass(frozen=True)
class SetRow:
    """Loss of a compound under the most loaded idler set of a conveyor [N], or the reason why it is unknown.

    Attributes
    ----------
    compound, section : str
        Its name; section of the set.
    temperature, load : float or None
        Of the cover [K]; of all rolls of the set [N].
    resistance : float or None
        Indentation resistance of the set [N].
    reason : str
        Reason if there is none.
    """

    compound: str
    section: str
    temperature: float
    load: float | None
    resistance: float | None
    reason: str = ""


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedVerification:
    """Losses of compounds, for comparison with a maker's tests.

    Attributes
    ----------
    compounds : tuple of RubberCompound
        In the order given.
    line_loads : tuple of float
        Of the columns [N/m].
    rows : tuple of VerificationRow
        By compound, cover, roll, speed, temperature.
    sets : tuple of SetRow
        Of the conveyor, if one is given.
    conveyor : Conveyor or None
        Conveyor of the sets.
    softened : bool
        True if moduli are those at the strain of each roll, for compounds with strain dependence.
    """

    compounds: tuple[RubberCompound, ...]
    line_loads: tuple[float, ...]
    rows: tuple[VerificationRow, ...]
    sets: tuple[SetRow, ...]
    conveyor: Conveyor | None
    softened: bool

    def __repr__(self) -> str:
        names = ", ".join(compound.name for compound in self.compounds)
        return f"VerificationSheet({names}: {len(self.rows)} rows at {len(self.line_loads)} line loads)"


@check_arguments
def verify_compounds(
    compounds: Iterable[str | RubberCompound],
    *,
    line_loads: Iterable[str | Quantity] = LINE_LOADS,
    temperatures: Iterable[str | Quantity] | None = None,
    roll_diameters: Iterable[str | Quantity] = ROLL_DIAMETERS,
    speeds: Iterable[str | Quantity] = SPEEDS,
    covers: Iterable[str | Quantity] = COVERS,
    conveyor: Conveyor | None = None,
    softened: bool = False,
    shelves: Iterable[str | Path] = (),
    rtol: float = 1e-6,
    progress: ProgressCallback | None = None,
) -> CalculatedVerification:
    """Calculate the losses of compounds under single rolls, and under an idler set of a conveyor.

    Parameters
    ----------
    compounds : iterable of str or RubberCompound
        Shelf names, paths of compound files, or compounds.
    line_loads, roll_diameters, speeds, covers : iterable of str or Quantity
        Each with its unit ("4 N/mm", "194 mm", "5 m/s", "7 mm").
    temperatures : iterable of str or Quantity, optional
        Of the cover; by default -20 to 40 degC as far as each compound is known.
    conveyor : Conveyor, optional
        Its most loaded carry set is calculated at the temperatures with each compound as its bottom cover.
    softened : bool
        Take moduli at the strain of every roll and load, for compounds with strain dependence (half a second per
        figure), not at that of the master curve.
    shelves : iterable of path
        Further folders of compounds.
    rtol : float
        Relative tolerance of the contacts [-].
    progress : callable, optional
        Called with the rows done and their total.

    Returns
    -------
    CalculatedVerification
        Rows; those without an answer with the reason.

    Raises
    ------
    InputError
        No compound, a value without unit or outside its range, more than 100,000 figures.

    Examples
    --------
    >>> import conveyor
    >>> found = conveyor.verify_sheet(
    ...     ["s100"],
    ...     line_loads=["2 N/mm"],
    ...     temperatures=["20 degC"],
    ...     roll_diameters=["219 mm"],
    ...     speeds=["5 m/s"],
    ...     covers=["7 mm"],
    ... )
    >>> round(found.rows[0].resistances[0], 2)
    7.24
    """
    extra = tuple(shelves)
    chosen = tuple(c if isinstance(c, RubberCompound) else shelf.compound(c, extra=extra) for c in compounds)
    if not chosen:
        raise InputError("compounds: give at least one; `conveyor shelf` lists those at hand")
    scenes = tuple(
        product(
            _axis_values("covers", covers),
            _axis_values("roll_diameters", roll_diameters),
            _axis_values("speeds", speeds),
        )
    )
    loads = _axis_values("line_loads", line_loads)
    warmth = _axis_values("temperatures", TEMPERATURES if temperatures is None else temperatures)
    count = len(chosen) * len(loads) * len(warmth) * len(scenes)
    if count > MOST_POINTS:
        raise InputError(f"{count:,} figures are requested, at most {MOST_POINTS:,} are calculated; give fewer values")
    rows: list[VerificationRow] = []
    sets: list[SetRow] = []
    for done, compound in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        known = {at: _compound_series(compound, at) for at in warmth}
        if temperatures is None:
            known = {at: series for at, series in known.items() if isinstance(series, PronySeries)}
        rows += _verification_rows(compound, known, scenes, loads, softened=softened, rtol=rtol)
        if conveyor is not None:
            sets += _set_rows(conveyor, compound, tuple(known))
    if progress is not None:
        progress(len(chosen), len(chosen))
    return CalculatedVerification(chosen, loads, tuple(rows), tuple(sets), conveyor, softened)


def _axis_values(name: str, given: Given) -> tuple[float, ...]:
    """Sorted distinct values of an axis in SI."""
    kind, allowed = _AXES[name]
    values = []
    for item in given:
        try:
            value: Quantity = allowed.validate_python(item)
        except ValidationError as error:
            raise InputError(f"{name}: {error.errors()[0]['msg']}") from None
        values.append(read_si(text(value), kind))
    if not values:
        raise InputError(f"{name}: give at least one")
    return tuple(sorted(set(values)))


def _compound_series(compound: RubberCompound, temperature: float) -> PronySeries | RangeError:
    try:
        return compound.series(temperature)
    except RangeError as error:
        return error


def _verification_rows(
    compound: RubberCompound,
    known: Mapping[float, PronySeries | RangeError],
    scenes: Sequence[tuple[float, float, float]],
    loads: tuple[float, ...],
    *,
    softened: bool,
    rtol: float,
) -> Iterator[VerificationRow]:
    """Rows of a compound, all contacts in one batch."""
    asked: list[tuple[VerificationRow, list[RollContact], list[tuple[float, float]]]] = []
    for (cover, diameter, speed), (temperature, series) in product(scenes, known.items()):
        row = VerificationRow(compound.name, cover, diameter, speed, temperature, (None,) * len(loads))
        if isinstance(series, RangeError):
            asked.append((replace(row, reason=str(series)), [], []))
            continue
        roll = RollContact(diameter / 2.0, SPACING, cover, speed, series, compound.poisson_ratio)
        if not softened or compound.strain_dependence is None:
            asked.append((row, [roll], [(loads[0], loads[-1])]))
            continue
        try:
            each = _soften_contacts(roll, loads, compound, temperature)
            asked.append((row, each, [(load, load) for load in loads]))
        except (NoSolutionError, RangeError) as error:
            asked.append((replace(row, reason=str(error)), [], []))
    contacts = [contact for _, each, _ in asked for contact in each]
    lowest, highest = ([span[end] for _, _, each in asked for span in each] for end in (0, 1))
    curves = iter(indentation_curves(contacts, lowest, highest, rtol) if contacts else ())
    level = compound_test_factor(compound, softened=softened)
    for row, each, _ in asked:
        yield _fill_row(row, [next(curves) for _ in each], loads, level)


def _soften_contacts(
    roll: RollContact, loads: Sequence[float], compound: RubberCompound, temperature: float
) -> list[RollContact]:
    """Roll contacts with the cover softened at each line load."""
    factors = compound.amplitude_factors()
    if factors is None:
        return [roll for _ in loads]
    swept = compound.swept_series(temperature)
    works = [SofteningCover(roll, load, factors, temperature, swept) for load in loads]
    return [replace(roll, series=series) for series, _ in soften_or_raise(works)]


def _fill_row(
    row: VerificationRow,
    curves: Sequence[IndentationCurve | NoSolutionError],
    loads: tuple[float, ...],
    level: RollingTestFactor | None,
) -> VerificationRow:
    """Row with the resistances of its curves (one for all loads or one for each) times the test factor."""
    drawn: list[IndentationCurve] = []
    for curve in curves:
        if isinstance(curve, NoSolutionError):
            return replace(row, reason=str(curve))
        drawn.append(curve)
    if not drawn:
        return row
    each = drawn * len(loads) if len(drawn) == 1 else drawn
    factors = [1.0 if level is None else float(level.factor(w, row.temperature)) for w in loads]
    lost = (f * float(c.resistance(w)) for f, c, w in zip(factors, each, loads, strict=True))
    return replace(row, resistances=tuple(lost))


def _set_rows(conveyor: Conveyor, compound: RubberCompound, temperatures: Sequence[float]) -> Iterator[SetRow]:
    """Loss of the most loaded carry set of a conveyor on a compound at every temperature."""
    try:
        made = with_compound(conveyor, compound, "bottom")
    except ConveyorError as error:
        yield from (SetRow(compound.name, "", at, None, None, str(error)) for at in temperatures)
        return
    answers = calculate_many([Variant(made, temperature=at) for at in temperatures])
    for at, answer in zip(temperatures, answers, strict=True):
        if not isinstance(answer, CalculatedConveyor):
            yield SetRow(compound.name, "", at, None, None, str(answer))
            continue
        carry = [stretch for stretch in answer.stretches if stretch.stretch.strand == "carry"]
        heaviest = max(carry, key=_set_load)
        lost = math.fsum(roll.resistance for roll in heaviest.rolls)
        yield SetRow(compound.name, heaviest.stretch.section, at, _set_load(heaviest), lost)


def _set_load(stretch: StretchResult) -> float:
    return math.fsum(roll.load.force for roll in stretch.rolls)
