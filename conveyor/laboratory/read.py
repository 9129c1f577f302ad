"""`read_dma`: one laboratory file, understood aloud or refused with the question that decides it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from conveyor.errors import InputError
from conveyor.files.content import file_content
from conveyor.laboratory.arrange import Arrangement, arrange
from conveyor.laboratory.cells import TextGrid, refusal
from conveyor.laboratory.columns import Question, Series, check_units, column_label, read_columns
from conveyor.laboratory.encoding import decoded
from conveyor.laboratory.kinds import NEEDS, Decision, decide, possible_kinds
from conveyor.laboratory.layout import EXAMPLE, DataTable, find_table, has_table
from conveyor.laboratory.moduli import Moduli, dynamic_moduli, equivalent_strain, to_tensile
from conveyor.laboratory.names import DIMENSIONS
from conveyor.laboratory.plausible import TEMPERATURE_RANGE, check_possible, doubts
from conveyor.laboratory.separated import text_grid
from conveyor.laboratory.table import KINDS, DmaData, FloatArray, IntArray
from conveyor.laboratory.trend import check_trend
from conveyor.laboratory.workbook import MAGIC, workbook_grids

LARGEST_FILE: Final = 50_000_000
"""Bytes; a table of a million rows has about as many."""


def read_dma(
    path: str | Path,
    *,
    frequency_unit: str | None = None,
    modulus_unit: str | None = None,
    temperature_unit: str | None = None,
    strain_unit: str | None = None,
    temperature: float | None = None,
    sheet: str | None = None,
    poisson_ratio: float = 0.5,
    kind: str | None = None,
    letter: str | None = None,
    instantaneous: float | None = None,
) -> DmaData:
    r"""Read a measurement from CSV, TXT, TSV or XLSX.

    Parameters
    ----------
    path : str or pathlib.Path
        The file [-].
    frequency_unit : str or None
        Unit of the frequency column, Hz or rad/s, if the file does not say or errs [-].
    modulus_unit : str or None
        Unit of all moduli, if the file does not say or errs [-].
    temperature_unit : str or None
        Unit of the temperature column, if the file does not say or errs [-].
    strain_unit : str or None
        Unit of the strain column, if the file does not say or errs [-].
    temperature : float or None
        Of a file without a temperature column [K].
    sheet : str or None
        Sheet of a workbook with several tables [-].
    poisson_ratio : float
        To convert shear moduli, 0 to 0.5 [-].
    kind : str or None
        One of `KINDS`, if the columns leave it open [-].
    letter : str or None
        "E" or "G", if the file does not say whether its moduli are tensile or shear ones [-].
    instantaneous : float or None
        Tensile modulus at time 0 of a Prony series of shares, if the file does not say [Pa].

    Returns
    -------
    DmaData
        In SI, with `understood` saying how every column was read [-].

    Raises
    ------
    InputError
        As `file:row: column n "name": what; remedy`, for anything doubtful.

    Notes
    -----
    Units given as options override the file; `understood` says so. Moduli must lie between 1e4 and 1e11 Pa,
    temperatures between -160 and 250 degC and strains below 100 % unless their unit is given.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "pad.txt"
    ...     _ = file.write_text("f [Hz];E' [MPa];tan delta\n10;6,8;0,11\n1;5,6;0,10\n")
    ...     data = read_dma(file)
    >>> data.kind, data.storage, data.understood[3]
    ('master curve', array([5600000., 6800000.]), 'decimal comma')
    """
    if not (math.isfinite(poisson_ratio) and 0.0 <= poisson_ratio <= 0.5):
        raise InputError(f"poisson_ratio = {poisson_ratio:g} (--poisson) must be 0 to 0.5")
    low, high = TEMPERATURE_RANGE
    if temperature is not None and not low <= temperature <= high:
        raise InputError(
            f"temperature = {temperature:g} K (--temperature) must be {low:g} to {high:g} K; 20 degC are 293.15 K"
        )
    if kind is not None and kind not in KINDS:
        raise InputError(f'kind = "{kind}" (--kind) is not known; allowed: {", ".join(KINDS)}')
    if letter not in {None, "E", "G"}:
        raise InputError(f'letter = "{letter}" (--moduli) must be E or G')
    given = check_units(
        {
            "frequency": frequency_unit,
            "modulus": modulus_unit,
            "temperature": temperature_unit,
            "strain": strain_unit,
        }
    )
    table = find_table(_grid(Path(path), sheet))
    series, labels, notes, questions = read_columns(table, given)
    columns, derived = _quantities(table, series, questions, (poisson_ratio, letter), temperature)
    derived += _complete(table, series, columns, instantaneous)
    for dimension, unit in given.items():
        if not any(s.explicit and s.unit == unit for s in series.values()):
            notes.append(f"{dimension}_unit {unit.name} was given, but the file has no such column")
    if len(set(table.blocks)) > 1 and labels is None:
        labels = np.array(table.blocks, dtype=np.int64)
        notes.append("each block of the file is a run of its own")
    decision = _decision(table, columns, labels, series, kind)
    found = arrange(decision.kind, columns, labels)
    check_trend(table, decision.kind, columns, found)
    notes = [*table.grid.notes, *table.notes, *notes, *derived, f"{decision.kind}: {decision.reason}"]
    notes += _order_notes(table, decision.kind, found)
    return replace(_assembled(Path(path), table, decision.kind, columns, found), understood=tuple(notes))


def _grid(path: Path, sheet: str | None) -> TextGrid:
    """The text, or the one sheet with a table."""
    data = file_content(path, largest=LARGEST_FILE, expected="table of a laboratory")
    if not data.startswith(MAGIC):
        if sheet is not None:
            raise refusal(path.name, 1, 0, f"a text file has no sheet '{sheet}'; leave out sheet (--sheet)")
        text, note = decoded(data, path.name)
        return text_grid(text, path.name, (note,))
    grids = workbook_grids(data, path.name)
    names = ", ".join(repr(grid.sheet) for grid in grids)
    if sheet is not None:
        for grid in grids:
            if grid.sheet == sheet:
                return grid
        raise refusal(
            path.name, 1, 0, f"no sheet '{sheet}'; sheet (--sheet) must be one of {names}", lettered=True
        )
    tables = [grid for grid in grids if has_table(grid)]
    if len(tables) == 1:
        empty = ", ".join(repr(grid.sheet) for grid in grids if grid is not tables[0])
        more = (f"no table on {empty}",) if empty else ()
        return replace(tables[0], notes=(*tables[0].notes, *more))
    if not tables:
        raise refusal(
            path.name, 1, 0, f"no table on any sheet ({names}); one of them needs {EXAMPLE}", lettered=True
        )
    first = tables[1]
    several = ", ".join(repr(grid.sheet) for grid in tables)
    raise first.refusal(
        first.lines[0].number,
        0,
        f'{len(tables)} sheets hold a table: {several}; give sheet, for example sheet="{tables[0].sheet}" (--sheet)',
    )


def _quantities(
    table: DataTable,
    series: Mapping[str, Series],
    questions: list[Question],
    tensile_by: tuple[float, str | None],
    temperature: float | None,
) -> tuple[dict[str, FloatArray], list[str]]:
    """SI arrays by their names in `DmaData`, and how they were derived; open questions are raised here."""
    check_possible(table, series)
    open_columns = {q.column for q in questions}
    clear = {q: s for q, s in series.items() if s.column not in open_columns}
    moduli = dynamic_moduli(table, clear)
    _ask(table, [*questions, *doubts(table, clear, moduli)])
    columns = {q: series[q].values for q in ("frequency", "temperature", "strain", "time") if q in series}
    if {"term", "share"} & series.keys():
        columns |= _terms(table, series)
        columns.pop("time", None)
    tensile, notes = _tensile(table, series, moduli, tensile_by)
    columns |= tensile
    given = tensile_by[1] if moduli is None else moduli.storage_from.meaning.letter or tensile_by[1]
    if "strain" in columns and moduli is not None and given == "G":
        columns["strain"], note = equivalent_strain(columns["strain"], tensile_by[0])
        notes.append(note)
    for quantity in ("a_T", "b_T"):
        if quantity in series:
            found = series[quantity]
            linear = found.meaning.log_base is None
            columns[f"log10_{quantity}"] = np.log10(found.values) if linear else found.values
    if temperature is not None:
        if "temperature" in series:
            raise table.grid.refusal(
                table.header_row,
                series["temperature"].column.index,
                "the file has its temperatures; leave out temperature (--temperature)",
                header=series["temperature"].column.header,
            )
        columns["temperature"] = np.full(len(table.rows), temperature)
        notes.append(f"temperature of every row {temperature:g} K as given")
    return columns, notes


def _terms(table: DataTable, series: Mapping[str, Series]) -> dict[str, FloatArray]:
    """Relaxation times of a Prony series, and its shares."""
    times = series.get("tau") or series.get("time")
    found = {} if times is None else {"tau": times.values}
    if "share" in series:
        found["share"] = series["share"].values
        total = float(np.sum(found["share"]))
        if total >= 1.0:
            column = series["share"].column
            raise table.grid.refusal(
                table.rows[-1].number,
                column.index,
                f"the shares add up to {total:.6g}; less than 1 is needed, the rest is the equilibrium modulus",
                header=column.header,
            )
    return found


def _complete(
    table: DataTable,
    series: Mapping[str, Series],
    columns: dict[str, FloatArray],
    instantaneous: float | None,
) -> list[str]:
    """Moduli of a Prony series from its shares, and its instantaneous modulus."""
    if "tau" not in columns:
        return [] if instantaneous is None else ["instantaneous was given, but the file is no Prony table"]
    if instantaneous is not None:
        if not 0.0 < instantaneous < math.inf:
            raise InputError(f"instantaneous = {instantaneous:g} Pa (--instantaneous) must be > 0")
        columns["instant"] = np.full(len(table.rows), instantaneous)
    if "share" not in columns:
        return []
    shares = columns.pop("share")
    if "term" in columns:
        return ["E_i of each row; the shares are not needed"]
    if "instant" not in columns:
        column = series["share"].column
        raise table.grid.refusal(
            table.header_row,
            column.index,
            "shares of which modulus? add a column 'E_0 [MPa]', or give instantaneous (--instantaneous)",
            header=column.header,
        )
    columns["term"] = shares * columns["instant"]
    return ["E_i = share times E_0"]


def _ask(table: DataTable, questions: list[Question]) -> None:
    if not questions:
        return
    first, *others = questions
    asked = {_dimension(first)}
    more = ""
    for question in others:
        label = column_label(table.grid, question.column)
        more += f"; likewise {label}" if _dimension(question) in asked else f"; and {label}: {question.text}"
        asked.add(_dimension(question))
    raise table.grid.refusal(first.row, first.column.index, first.text + more, header=first.column.header)


def _dimension(question: Question) -> str:
    meaning = question.column.meaning
    return "" if meaning is None else DIMENSIONS[meaning.quantity]


def _tensile(
    table: DataTable, series: Mapping[str, Series], moduli: Moduli | None, by: tuple[float, str | None]
) -> tuple[dict[str, FloatArray], list[str]]:
    """Tensile moduli by their names in `DmaData`, and how they were derived."""
    used: list[Series] = []
    notes: list[str] = []
    arrays: dict[str, FloatArray] = {}
    if moduli is not None:
        used += [moduli.storage_from, moduli.loss_from]
        arrays |= {"storage": moduli.storage, "loss": moduli.loss}
        notes += moduli.notes
    if "relaxation" in series:
        used.append(series["relaxation"])
        arrays["modulus"] = series["relaxation"].values
    for quantity in ("term", "instant"):
        if quantity in series:
            used.append(series[quantity])
            arrays[quantity] = series[quantity].values
    stated = tuple(s for s in used if s.meaning.quantity not in {"tan_delta", "phase"})
    if not stated:
        return {}, notes
    factor, note = to_tensile(table, stated, *by)
    return {name: factor * values for name, values in arrays.items()}, [*notes, note]


def _decision(
    table: DataTable,
    columns: dict[str, FloatArray],
    labels: IntArray | None,
    series: Mapping[str, Series],
    kind: str | None,
) -> Decision:
    present = set(columns)
    if kind is not None:
        missing = [name for name in NEEDS[kind] if name not in present]
        if missing:
            raise _missing(table, present, f"a {kind} needs {' and '.join(missing)}")
        return Decision(kind, "as given")
    if not possible_kinds(present):
        raise _missing(table, present, "these columns make no measurement read here")
    frequency = series.get("frequency")
    if {"tau", "term"} <= present:
        return Decision("Prony series", "relaxation times with their moduli or shares")
    decision = decide(columns, labels, reduced=frequency is not None and frequency.meaning.reduced)
    if not decision.kind:
        choices = possible_kinds(present)
        raise table.grid.refusal(
            table.header_row,
            0,
            f'{decision.reason or "several kinds fit"}; else give kind, for example kind="{choices[0]}"'
            f" (--kind), one of {', '.join(choices)}",
            header=table.columns[0].header,
        )
    return decision


def _missing(table: DataTable, present: set[str], what: str) -> InputError:
    unknown = next((c for c in table.columns if c.meaning is None), table.columns[-1])
    named = {c.meaning.quantity for c in table.columns if c.meaning is not None}
    have = ", ".join(sorted(present | named))
    advice = "; give temperature (--temperature)" if {"storage", "loss", "frequency"} <= present else ""
    return table.grid.refusal(
        table.header_row,
        unknown.index,
        f"{what} (found: {have}{advice}); beside E' stands E'' or tan delta; name the"
        f" missing column as in {EXAMPLE}, with temperature_degC, strain_%,"
        " 't [s]' and 'E(t) [MPa]', or a_T",
        header=unknown.header,
    )


def _order_notes(table: DataTable, kind: str, found: Arrangement) -> list[str]:
    """Sentences on sorting, duplicate runs and the number of sweeps."""
    notes = []
    rows = _rows(table)
    order = found.order
    moved = np.flatnonzero(np.diff(np.argsort(order)) < 0)
    if moved.size:
        notes.append(f"rows sorted; the file is not in order from row {rows[moved[0] + 1]} on")
    if found.duplicates is not None:
        repeated = rows[found.duplicates > 0]
        notes.append(
            f"duplicate runs: {repeated.size} row(s) repeat a set point of their sweep, first row {repeated[0]};"
            f" up to {int(found.duplicates.max()) + 1} runs are kept apart"
        )
    if found.group is not None and kind in {"isotherms", "strain sweep"}:
        notes.append(f"rows grouped by temperature: {np.unique(found.group).size}")
    return notes


def _assembled(
    path: Path, table: DataTable, kind: str, columns: dict[str, FloatArray], found: Arrangement
) -> DmaData:
    """Sorted, frozen, without the notes."""
    order = found.order
    rows = _rows(table)
    instant = columns.get("instant")
    columns = columns | ({"time": columns["tau"], "modulus": columns["term"]} if "tau" in columns else {})

    def sorted_rows(values: FloatArray | None) -> FloatArray | None:
        return None if values is None else _frozen(values[order])

    return DmaData(
        kind=kind,
        **{
            name: sorted_rows(columns.get(name))
            for name in (
                "frequency",
                "temperature",
                "strain",
                "time",
                "storage",
                "loss",
                "modulus",
                "log10_a_T",
                "log10_b_T",
            )
        },
        run=None if found.run is None else _frozen_labels(found.run[order]),
        group=None if found.group is None else _frozen_labels(found.group[order]),
        row_numbers=_frozen_labels(rows[order]),
        instantaneous=None if instant is None else float(instant[0]),
        metadata=MappingProxyType(table.metadata),
        metadata_rows=MappingProxyType(table.metadata_rows),
        understood=(),
        source=f"{path}[{table.grid.sheet}]" if table.grid.sheet else str(path),
    )


def _rows(table: DataTable) -> IntArray:
    return np.array([line.number for line in table.rows], dtype=np.int64)


def _frozen(values: FloatArray) -> FloatArray:
    values.setflags(write=False)
    return values


def _frozen_labels(values: IntArray) -> IntArray:
    values.setflags(write=False)
    return values
