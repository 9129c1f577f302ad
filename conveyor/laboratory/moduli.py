"""E' and E'' from whatever a file states: shear moduli, |E*|, tan delta, phase angle."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from conveyor.laboratory.columns import Series
from conveyor.laboratory.layout import DataTable
from conveyor.laboratory.table import FloatArray

TAN_DELTA_AGREEMENT: Final = 0.05
"""Relative difference allowed between tan delta and E''/E' of one row: two printed digits."""
TAN_DELTA_DIGIT: Final = 0.01
"""Absolute difference allowed besides: tan delta printed with two decimals."""
_NEAR: Final = (
    0.4  # of what E''/E' misses tan delta by: what it misses another reading by, where that is the right one
)
_ROUNDING: Final = 1e-6  # up to which all of them are the same
_SHEAR_WORDS: Final = re.compile(
    r"\b(shear\w*|torsion\w*|rheom\w*|parallel plates?|plate[- ]plate|cone|ares|rpa|mcr|scher\w*|schub\w*)\b|전단|비틀",
    re.IGNORECASE,
)
"""Words of shear tests and of instruments that make only those (general knowledge)."""


@dataclass(frozen=True)
class Moduli:
    """Storage and loss modulus [Pa], with the columns they came from."""

    storage: FloatArray
    loss: FloatArray
    storage_from: Series
    loss_from: Series
    note: str = ""


def dynamic_moduli(table: DataTable, series: Mapping[str, Series]) -> Moduli | None:
    r"""E' and E'', still with the letter of the file (see `to_tensile`); None if the columns do not give both.

    Notes
    -----
    E'' = E' tan delta; E' = \|E*\| cos delta; E'' = \|E*\| sin delta (definitions of the complex modulus). A tan delta
    beside E' and E'' that contradicts them is refused.
    """
    storage, loss, whole = (series.get(q) for q in ("storage", "loss", "complex"))
    angle = series.get("tan_delta") or series.get("phase")
    if angle is None:
        return _without_angle(table, storage, loss, whole)
    is_phase = angle.meaning.quantity == "phase"
    tangent = np.tan(angle.values) if is_phase else angle.values
    name = "tan(phase)" if is_phase else "tan delta"
    if storage and loss:
        note = _agrees(table, storage, loss, angle, tangent)
        return Moduli(storage.values, loss.values, storage, loss, note)
    if storage:
        made, note = storage.values * tangent, f"E'' = E' {name} from each row"
        return Moduli(storage.values, made, storage, angle, note)
    if loss:
        return Moduli(loss.values / tangent, loss.values, angle, loss, f"E' = E''/{name} from each row")
    if whole:
        made = whole.values * (1.0 / np.sqrt(1.0 + tangent**2))
        return Moduli(made, made * tangent, whole, angle, f"E' and E'' from |E*| and {name} of each row")
    return None


def _without_angle(
    table: DataTable, storage: Series | None, loss: Series | None, whole: Series | None
) -> Moduli | None:
    """E' beside E'' as it stands, else what E'' leaves of |E*|."""
    if storage and loss:
        return Moduli(storage.values, loss.values, storage, loss)
    if not (whole and loss):
        return None
    square = whole.values**2 - loss.values**2
    if (square <= 0.0).any():
        row = int((loss.values / whole.values).argmax())
        ratio = loss.values[row] / whole.values[row]
        raise table.refusal(
            whole.column, f"E'' is {ratio:.3g} times |E*|, of which it is a part: columns mixed up?", row
        )
    return Moduli(np.sqrt(square), loss.values, whole, loss, "E' from |E*| and E'' of each row")


def _agrees(table: DataTable, storage: Series, loss: Series, angle: Series, tangent: FloatArray) -> str:
    ratio = loss.values / storage.values
    _refuse_near(table, storage, angle, ratio, tangent)
    apart = np.abs(ratio - tangent) - TAN_DELTA_AGREEMENT * tangent
    worst = int(np.argmax(apart))
    if apart[worst] > TAN_DELTA_DIGIT:
        raise table.refusal(
            angle.column,
            f"tan delta is {tangent[worst]:.4g}, but E''/E' = {ratio[worst]:.4g}: are columns or units mixed up?"
            " correct them, or rename the column that is wrong",
            worst,
        )
    return f"{table.label(angle.column)} agrees with E''/E' and is not needed"


def _refuse_near(
    table: DataTable, storage: Series, angle: Series, ratio: FloatArray, tangent: FloatArray
) -> None:
    """Refuse |E*| named E', and a phase angle named tan delta, which most rows alone do not tell."""
    lossy = tangent > 0.0

    def missed(other: FloatArray) -> float:
        return float(np.sqrt(np.mean((ratio[lossy] / other[lossy] - 1.0) ** 2)))

    if not lossy.any() or (named := missed(tangent)) <= _ROUNDING:
        return
    if missed(tangent / np.sqrt(1.0 + tangent**2)) < _NEAR * named:
        raise table.refusal(
            storage.column,
            "E''/E' is sin delta of the tan delta beside it: what is named E' is |E*|; name the column |E*|",
            0,
        )
    if angle.meaning.quantity == "tan_delta" and missed(np.tan(tangent)) < _NEAR * named:
        raise table.refusal(
            angle.column,
            "E''/E' is the tangent of it: what is named tan delta is the phase angle; name the column 'phase [rad]'",
            0,
        )


def to_tensile(
    table: DataTable, used: list[Series], poisson_ratio: float, answer: str | None
) -> tuple[float, str]:
    """Factor from the moduli of the file to tensile ones, and the sentence that says why.

    Notes
    -----
    E = 2 (1 + nu) G, isotropic elasticity; by the correspondence principle also for moduli of time or
    frequency if nu is constant. 3 G at nu = 0.5. `answer` is "E" or "G" where the names have no letter.
    """
    letters = {s.meaning.letter for s in used if s.meaning.letter}
    first = used[0].column
    if len(letters) > 1:
        other = next(s.column for s in used if s.meaning.letter == "G")
        raise table.refusal(
            other, "a shear modulus beside a tensile one; keep two E or two G and rename the rest"
        )
    if answer is not None and letters and letters != {answer}:
        what = f"the name says {''.join(letters)}, not {answer}; rename the column, or leave out letter (--moduli)"
        raise table.refusal(first, what)
    letter = answer or next(iter(letters), None)
    if letter == "G":
        factor = 2.0 * (1.0 + poisson_ratio)
        return factor, f"shear moduli: E = 2 (1 + nu) G = {factor:g} G with nu = {poisson_ratio:g}"
    if letter == "E":
        return 1.0, "the moduli are tensile (E)"
    for line in table.grid.lines[: table.grid.lines.index(table.rows[0])]:
        word = _SHEAR_WORDS.search(line.text)
        if word is not None:
            raise table.refusal(
                first,
                f"E or G? the name has no letter and row {line.number} speaks of '{word[0]}'; give letter"
                ' "E" or "G" (--moduli E, --moduli G), or name the columns so (G is converted with poisson_ratio,'
                " --poisson)",
            )
    return 1.0, "the moduli are taken as tensile (E): a shear modulus is named G' or shear"


def equivalent_strain(shear: FloatArray, poisson_ratio: float) -> tuple[FloatArray, str]:
    """Tensile strain that stores as much energy as a shear strain, and the sentence that says so.

    Notes
    -----
    E epsilon^2 = G gamma^2 with E = 2 (1 + nu) G. At nu = 0.5 it is gamma/sqrt(3), the equivalent strain
    sqrt(2/3 e:e) of simple shear, in which `conveyor.contact.interior` counts the strain of a cover.
    """
    factor = 1.0 / np.sqrt(2.0 * (1.0 + poisson_ratio))
    note = f"shear strain: the tensile one of equal energy is gamma/sqrt(2 (1 + nu)) = {factor:.4g} gamma"
    return factor * shear, note
