"""E' and E'' from whatever a file states: shear moduli, |E*|, tan delta, phase angle."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from conveyor.laboratory.columns import Series, column_label
from conveyor.laboratory.layout import DataTable
from conveyor.laboratory.table import FloatArray

TAN_DELTA_AGREEMENT = 0.05
"""Relative difference allowed between tan delta and E''/E' of one row: two printed digits."""
TAN_DELTA_DIGIT = 0.01
"""Absolute difference allowed besides: tan delta printed with two decimals."""
_SHEAR_WORDS = re.compile(
    r"\b(shear\w*|torsion\w*|rheom\w*|parallel plates?|plate[- ]plate|cone|ares|rpa|mcr|scher\w*|schub\w*)\b|전단|비틀",
    re.IGNORECASE,
)
"""Words of shear tests and of instruments that make only those (general knowledge)."""
_NEEDED = {"storage": "E'", "loss": "E'' (or tan delta)"}


@dataclass(frozen=True)
class Moduli:
    """Tensile storage and loss modulus [Pa], with the columns they came from."""

    storage: FloatArray
    loss: FloatArray
    storage_from: Series
    loss_from: Series
    notes: tuple[str, ...]


def dynamic_moduli(table: DataTable, series: Mapping[str, Series]) -> Moduli | None:
    r"""E' and E'', still with the letter of the file (see `to_tensile`).

    Parameters
    ----------
    table : Table
        Header and rows [-].
    series : mapping of Series
        By quantity, SI [-].

    Returns
    -------
    Moduli or None
        None if the columns do not give both [-].

    Raises
    ------
    InputError
        If tan delta beside E' and E'' contradicts them.

    Notes
    -----
    E'' = E' tan delta; E' = \|E*\| cos delta; E'' = \|E*\| sin delta (definitions of the complex modulus).
    """
    storage, loss, whole = (series.get(q) for q in ("storage", "loss", "complex"))
    angle = series.get("tan_delta") or series.get("phase")
    tangent = None
    if angle is not None:
        is_phase = angle.meaning.quantity == "phase"
        tangent = np.tan(angle.values) if is_phase else angle.values
    if storage is not None and loss is not None:
        note = [] if tangent is None or angle is None else [_agrees(table, storage, loss, angle, tangent)]
        return Moduli(storage.values, loss.values, storage, loss, tuple(note))
    if angle is None or tangent is None:
        return None
    name = "tan(phase)" if angle.meaning.quantity == "phase" else "tan delta"
    if storage is not None:
        return Moduli(
            storage.values, storage.values * tangent, storage, angle, (f"E'' = E' {name} from each row",)
        )
    if loss is not None:
        return Moduli(loss.values / tangent, loss.values, angle, loss, (f"E' = E''/{name} from each row",))
    if whole is not None:
        cosine = 1.0 / np.sqrt(1.0 + tangent**2)
        return Moduli(
            whole.values * cosine,
            whole.values * cosine * tangent,
            whole,
            angle,
            (f"E' and E'' from |E*| and {name} of each row",),
        )
    return None


def _agrees(table: DataTable, storage: Series, loss: Series, angle: Series, tangent: FloatArray) -> str:
    apart = np.abs(loss.values / storage.values - tangent) - TAN_DELTA_AGREEMENT * tangent
    worst = int(np.argmax(apart))
    if apart[worst] > TAN_DELTA_DIGIT:
        raise table.grid.refusal(
            table.rows[worst].number,
            angle.column.index,
            f"tan delta is {tangent[worst]:.4g}, but E''/E' = {loss.values[worst] / storage.values[worst]:.4g}:"
            " are columns or units mixed up? correct them, or rename the column that is wrong",
            header=angle.column.header,
        )
    return f"{column_label(table.grid, angle.column)} agrees with E''/E' and is not needed"


def to_tensile(
    table: DataTable, used: tuple[Series, ...], poisson_ratio: float, answer: str | None = None
) -> tuple[float, str]:
    """Factor from the moduli of the file to tensile ones.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    used : tuple of Series
        The modulus columns [-].
    poisson_ratio : float
        Of the rubber, 0 to 0.5 [-].
    answer : str or None
        "E" or "G", where the names have no letter [-].

    Returns
    -------
    tuple
        1 or 2 (1 + nu) [-], and the sentence that says why [-].

    Raises
    ------
    InputError
        If E and G are mixed, the answer contradicts the names, or a modulus without a letter comes with words of a
        shear test.

    Notes
    -----
    E = 2 (1 + nu) G, isotropic elasticity; by the correspondence principle also for moduli of time or
    frequency if nu is constant. 3 G at nu = 0.5.
    """
    letters = {s.meaning.letter for s in used if s.meaning.letter}
    first = used[0].column
    if len(letters) > 1:
        other = next(s.column for s in used if s.meaning.letter == "G")
        raise table.grid.refusal(
            table.header_row,
            other.index,
            "a shear modulus beside a tensile one; keep two E or two G and rename the rest",
            header=other.header,
        )
    if answer is not None and letters and letters != {answer}:
        raise table.grid.refusal(
            table.header_row,
            first.index,
            f"the name says {''.join(letters)}, not {answer}; rename the column, or leave out letter (--moduli)",
            header=first.header,
        )
    if not letters and answer is not None:
        letters = {answer}
    if letters == {"G"}:
        factor = 2.0 * (1.0 + poisson_ratio)
        return factor, f"shear moduli: E = 2 (1 + nu) G = {factor:g} G with nu = {poisson_ratio:g}"
    if letters == {"E"}:
        return 1.0, "the moduli are tensile (E)"
    for line in table.grid.lines[: table.grid.lines.index(table.rows[0])]:
        word = _SHEAR_WORDS.search(line.text)
        if word is not None:
            raise table.grid.refusal(
                table.header_row,
                first.index,
                f"E or G? the name has no letter and row {line.number} speaks of '{word[0]}'; give letter"
                ' "E" or "G" (--moduli E, --moduli G), or name the columns so (G is converted with poisson_ratio,'
                " --poisson)",
                header=first.header,
            )
    return 1.0, "the moduli are taken as tensile (E): a shear modulus is named G' or shear"


def equivalent_strain(shear: FloatArray, poisson_ratio: float) -> tuple[FloatArray, str]:
    """Tensile strain that stores as much energy as a shear strain.

    Parameters
    ----------
    shear : numpy.ndarray
        Amplitude gamma, shape `(n,)` [-].
    poisson_ratio : float
        Of the rubber, 0 to 0.5 [-].

    Returns
    -------
    tuple
        gamma/sqrt(2 (1 + nu)), shape `(n,)` [-], and the sentence that says why [-].

    Notes
    -----
    E epsilon^2 = G gamma^2 with E = 2 (1 + nu) G. At nu = 0.5 it is gamma/sqrt(3), the equivalent strain
    sqrt(2/3 e:e) of simple shear, in which `conveyor.contact.interior` counts the strain of a cover.
    """
    factor = 1.0 / np.sqrt(2.0 * (1.0 + poisson_ratio))
    note = f"shear strain: the tensile one of equal energy is gamma/sqrt(2 (1 + nu)) = {factor:.4g} gamma"
    return factor * shear, note
