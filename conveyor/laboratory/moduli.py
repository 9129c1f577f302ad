"""E' and E'' from shear moduli, |E*|, tan delta or phase angle."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from conveyor.laboratory.column_values import ColumnSeries, Question
from conveyor.laboratory.dma_data import FloatArray
from conveyor.laboratory.numbers import last_digit
from conveyor.laboratory.table_layout import DataColumn, DataTable
from conveyor.laboratory.vocabulary import find_deformations

TAN_DELTA_AGREEMENT: Final = 0.05
"""Relative difference allowed between tan delta and E''/E' of one row: two printed digits."""
TAN_DELTA_DIGIT: Final = 0.01
"""Additional absolute difference: tan delta printed with two decimals."""
BETTER_READING: Final = 0.25
"""Largest error of the right reading of columns over that of their names [-]."""
FEWEST_TELLING_ROWS: Final = 5
"""Least rows that separate two readings: with fewer, chance agrees with either."""
TELLING_SHARE: Final = 0.75
"""Share of these rows that has to agree: the rest may be misprints [-]."""
_NAMED_IN_TEXT: Final = re.compile(r"(?<!\w)([EG])(?=['′″’])|\bmodul(?:us|i|e)?\s*[:=]\s*([EG])\b")
"""A modulus in a remark: "E' and E''", "modulus: E"."""


@dataclass(frozen=True)
class Moduli:
    """Storage and loss modulus [Pa], with the columns they came from."""

    storage: FloatArray
    loss: FloatArray
    storage_from: ColumnSeries
    loss_from: ColumnSeries
    note: str = ""


def dynamic_moduli(table: DataTable, series: Mapping[str, ColumnSeries]) -> Moduli | None:
    r"""E' and E'', still with the letter of the file (see `tensile_factor`); None if the columns do not give both.

    Notes
    -----
    E'' = E' tan delta; E' = \|E*\| cos delta; E'' = \|E*\| sin delta (definitions of the complex modulus). A tan delta
    beside E' and E'' that contradicts them is refused.
    """
    storage, loss, whole = (series.get(q) for q in ("storage", "loss", "complex"))
    angle = series.get("tan_delta") or series.get("phase")
    if loss and whole and not storage:
        note = "E' from |E*| and E'' of each row"
        return _check_angle(
            table, Moduli(_storage_of_complex(table, whole, loss), loss.values, whole, loss, note), angle
        )
    if storage and loss:
        return _check_angle(table, Moduli(storage.values, loss.values, storage, loss), angle)
    return None if angle is None else _moduli_by_angle(storage or whole, loss, angle)


def _moduli_by_angle(known: ColumnSeries | None, loss: ColumnSeries | None, angle: ColumnSeries) -> Moduli | None:
    """E' and E'' of one modulus, E', |E*| or E'', and the angle."""
    tangent, name = _loss_tangent(angle)
    if loss:
        return Moduli(loss.values / tangent, loss.values, angle, loss, f"E' = E''/{name} from each row")
    if known is None:
        return None
    if known.meaning.quantity == "storage":
        return Moduli(known.values, known.values * tangent, known, angle, f"E'' = E' {name} from each row")
    made = known.values * (1.0 / np.sqrt(1.0 + tangent**2))
    return Moduli(made, made * tangent, known, angle, f"E' and E'' from |E*| and {name} of each row")


def _loss_tangent(angle: ColumnSeries) -> tuple[FloatArray, str]:
    if angle.meaning.quantity == "phase":
        return np.tan(angle.values), "tan(phase)"
    return angle.values, "tan delta"


def _storage_of_complex(table: DataTable, whole: ColumnSeries, loss: ColumnSeries) -> FloatArray:
    """E' of |E*| and E''."""
    share = loss.values / whole.values
    row = int(np.argmax(share))
    if share[row] >= 1.0:
        what = f"E'' is {share[row]:.3g} times |E*|, of which it is a part: columns mixed up?"
        raise table.refusal(whole.column, what, row)
    return np.asarray(whole.values * np.sqrt(1.0 - share**2))


def _check_angle(table: DataTable, moduli: Moduli, angle: ColumnSeries | None) -> Moduli:
    """Moduli, refused where a given angle contradicts them beyond the printed digits."""
    if angle is None:
        return moduli
    tangent, ratio = _loss_tangent(angle)[0], moduli.loss / moduli.storage
    columns = (moduli.storage_from, moduli.loss_from, angle)
    printed = np.sum([_rounding_errors(table, column) for column in columns], axis=0)
    _refuse_another_reading(table, moduli, angle, printed)
    allowed = np.maximum(TAN_DELTA_AGREEMENT * tangent + TAN_DELTA_DIGIT, printed * tangent)
    apart = np.abs(ratio - tangent) - allowed
    worst = int(np.argmax(apart))
    if apart[worst] > 0.0:
        raise table.refusal(
            angle.column,
            f"tan delta is {tangent[worst]:.4g}, but E''/E' = {ratio[worst]:.4g}: are columns or units mixed up?"
            " correct them, or rename the column that is wrong",
            worst,
        )
    note = f"{table.label(angle.column)} agrees with E''/E' and is not needed"
    return replace(moduli, note="; ".join(filter(None, (moduli.note, note))))


def _refuse_another_reading(table: DataTable, moduli: Moduli, angle: ColumnSeries, printed: FloatArray) -> None:
    """Refuse columns that another reading fits better than their names, within digits and scatter.

    Only rows count in which the other reading differs by more than twice what their digits allow.
    """
    tangent = _loss_tangent(angle)[0]
    apart = np.log(moduli.loss / moduli.storage / tangent)
    found = []
    for column, difference, advice in _other_readings(moduli, angle):
        told = np.abs(difference) > 2.0 * printed
        if np.count_nonzero(told) >= FEWEST_TELLING_ROWS:
            beyond = np.maximum(np.abs([apart - difference, apart]) - printed, 0.0)
            as_read, as_named = np.quantile(beyond[:, told], TELLING_SHARE, axis=1).tolist()
            row = int(np.argmax(np.where(told, np.abs(apart), 0.0)))
            found += [(as_read, row, column, advice)] if as_read < BETTER_READING * as_named else []
    if found:
        _, row, column, advice = min(found, key=lambda one: one[0])
        raise table.refusal(
            column,
            f"E''/E' = {moduli.loss[row] / moduli.storage[row]:.4g}, but tan delta is {tangent[row]:.4g}; row by row"
            f" they agree {advice}, or rename the column that is wrong",
            row,
        )


def _other_readings(moduli: Moduli, angle: ColumnSeries) -> Iterator[tuple[DataColumn, FloatArray, str]]:
    """Other readings of a column: its column, the change of ln(E''/E' over tan delta), and advice."""
    value = angle.values
    if moduli.storage_from.meaning.quantity == "storage":
        letter = moduli.storage_from.meaning.letter
        named = f"|{letter}*|" if letter else "complex modulus"
        advice = f"if what is named {letter or 'E'}' is |{letter or 'E'}*|; name the column '{named}'"
        yield moduli.storage_from.column, -np.log(np.hypot(1.0, _loss_tangent(angle)[0])), advice
    if angle.meaning.quantity == "tan_delta":
        for unit, factor in (("rad", 1.0), ("deg", np.pi / 180.0)):
            if value.max() * factor < np.pi / 2:
                advice = f"if what is named tan delta is the phase angle; name the column 'phase [{unit}]'"
                yield angle.column, np.log(np.tan(value * factor) / value), advice


def _rounding_errors(table: DataTable, series: ColumnSeries) -> FloatArray:
    """Largest relative rounding error of each value by its printed digits, of a phase in its tangent [-]."""
    base = series.meaning.log_base
    digit = 0.5 * np.array([last_digit(line.cells[series.column.index]) for line in table.rows])
    if base is not None:
        return np.asarray(digit * np.log(base))
    if series.meaning.quantity == "phase":
        return np.asarray(2.0 * digit * series.unit.factor / np.sin(2.0 * series.values))
    return np.asarray(digit * series.unit.factor / series.values)


class ModulusLetter(NamedTuple):
    """Letter of moduli, tensile E or shear G; the reason; the question if undecided."""

    letter: str
    why: str
    question: Question | None = None


def modulus_letter(
    table: DataTable, used: Sequence[ColumnSeries], strain: ColumnSeries | None, answer: str | None
) -> ModulusLetter:
    """Decide between tensile and shear moduli by column names, the file's description of its test, or an answer.

    `answer` is "E" or "G", where the names have no letter or the described test contradicts them.
    """
    letters = {s.meaning.letter for s in used if s.meaning.letter}
    first = used[0].column
    if len(letters) > 1:
        other = next(s.column for s in used if s.meaning.letter == "G")
        raise table.refusal(other, "a shear modulus beside a tensile one; keep two E or two G and rename the rest")
    named = next(iter(letters), "")
    said = dict(_letter_evidence(table, strain, beside=not named))
    against = said.get("G" if named == "E" else "E", "") if named and named not in said else ""
    if answer is not None:
        if named and named != answer and not against:
            what = f"the name says {named}, not {answer}; rename the column, or leave out letter (--moduli)"
            raise table.refusal(first, what)
        return ModulusLetter(answer, "as given")
    if against:
        what = (
            f'the name says {named}, but {against}: a tensile or a shear modulus? give letter "E" or "G" (--moduli E,'
            " --moduli G); G is converted with poisson_ratio (--poisson)"
        )
        return ModulusLetter(named, "", Question(first, what))
    if named or set(said) == {"E"}:
        return ModulusLetter(named or "E", "" if named else said["E"])
    known = said.get("G", "nothing in the file says whether tension or shear was measured")
    what = (
        f'E or G? the name has no letter and {known}; give letter "E" or "G" (--moduli E, --moduli G), or name the'
        " columns so (G is converted with poisson_ratio, --poisson)"
    )
    return ModulusLetter("E", "", Question(first, what))


def _letter_evidence(table: DataTable, strain: ColumnSeries | None, *, beside: bool) -> Iterator[tuple[str, str]]:
    """Letters implied by text of the file, and where; with `beside` by other columns and modulus names in text, too."""
    for line in reversed(table.grid.lines):
        before = line.number < table.rows[0].number and line.number != table.header_row
        if not (line.comment or before):
            continue
        for one in find_deformations(line.text):
            yield one.letter, f"row {line.number} speaks of '{one.words}'"
        if beside and (match := _NAMED_IN_TEXT.search(line.text)):
            yield match[1] or match[2], f"row {line.number} speaks of {match[1] or match[2]}"
    for column in table.columns if beside else ():
        for one in find_deformations(column.header, column=True):
            yield one.letter, f"{table.label(column)} speaks of '{one.words}'"
    if strain is not None and strain.meaning.letter:
        yield (
            strain.meaning.letter,
            f"{table.label(strain.column)} is a {'shear' if strain.meaning.letter == 'G' else 'tensile'} strain",
        )


def tensile_factor(letter: ModulusLetter, poisson_ratio: float) -> tuple[float, str]:
    """Factor from the moduli of the file to tensile ones, and a note on it.

    Notes
    -----
    E = 2 (1 + nu) G, isotropic elasticity; by the correspondence principle also for moduli of time or
    frequency if nu is constant. 3 G at nu = 0.5.
    """
    why = f": {letter.why}" if letter.why else ""
    if letter.letter == "G":
        factor = 2.0 * (1.0 + poisson_ratio)
        return factor, f"shear moduli: E = 2 (1 + nu) G = {factor:g} G with nu = {poisson_ratio:g}{why}"
    return 1.0, f"the moduli are tensile (E){why}"


def equivalent_strain(shear: FloatArray, poisson_ratio: float) -> tuple[FloatArray, str]:
    """Tensile strain of equal energy to a shear strain, and a note on it.

    Notes
    -----
    E epsilon^2 = G gamma^2 with E = 2 (1 + nu) G. At nu = 0.5 it is gamma/sqrt(3), the equivalent strain
    sqrt(2/3 e:e) of simple shear, the strain of a cover in `conveyor.contact.fields.interior`.
    """
    factor = 1.0 / np.sqrt(2.0 * (1.0 + poisson_ratio))
    note = f"shear strain: the tensile one of equal energy is gamma/sqrt(2 (1 + nu)) = {factor:.4g} gamma"
    return factor * shear, note
