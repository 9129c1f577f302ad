"""Read one laboratory file, with notes on every decision; ambiguous files are refused with a question."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.laboratory.arrange import Arrangement, arrange_rows, check_trend
from conveyor.laboratory.cell_grid import AnswerableError, TextGrid
from conveyor.laboratory.column_units import ColumnUnit
from conveyor.laboratory.column_values import ColumnSeries, Question, TableValues, check_units, read_columns
from conveyor.laboratory.dma_data import DmaData, FloatArray
from conveyor.laboratory.header_meanings import DIMENSIONS
from conveyor.laboratory.header_points import split_set_points
from conveyor.laboratory.measurement_kinds import NEEDED_COLUMNS, decide_kind, possible_kinds
from conveyor.laboratory.moduli import ModulusLetter, dynamic_moduli, equivalent_strain, modulus_letter, tensile_factor
from conveyor.laboratory.ramp import isotherms_of_ramp
from conveyor.laboratory.stated_values import STATED_QUANTITIES, sheet_temperature, stated_value
from conveyor.laboratory.table_file import load_grid, source_name
from conveyor.laboratory.table_layout import (
    EXAMPLE_HEADER,
    DataTable,
    find_table,
    names_column,
    row_numbers,
    row_spans,
    with_column_names,
    without_columns,
    without_rows,
)
from conveyor.laboratory.value_checks import TEMPERATURE_RANGE, check_possible, doubtful_values

_COMPLIANCE: Final = re.compile(r"^\W*[DJ]\W*['′″\"(12*]|compliance|nachgiebigkeit", re.IGNORECASE)
"""Names of compliances: D', J'', J(t), |D*|, storage compliance."""


KINDS: Final = tuple(NEEDED_COLUMNS)
"""Kinds of measurement in a file."""


_MOST_FINDINGS: Final = 8
"""Most repeated readings without the rows and columns at fault; each reports all of one kind."""


_PER_FILE_ANSWERS: Final = frozenset({"sheet", "kind", "instantaneous", "exclude", "columns", "ignore"})
"""Answers that hold for one file only."""


T = TypeVar("T", bound=np.generic)


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
    exclude: str | None = None,
    columns: Mapping[str, str] | None = None,
    ignore: Sequence[str] | None = None,
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
        "E" or "G", if the file does not say whether its moduli are tensile or shear ones, or contradicts itself [-].
    instantaneous : float or None
        Tensile modulus at time 0 of a Prony series of shares, if the file does not say [Pa].
    exclude : str or None
        Rows to leave out unread, by their number in the file: "12-15,20" [-].
    columns : mapping of str to str or None
        New names of columns, as read here: ``{"Modul A [MPa]": "E'"}`` [-].
    ignore : sequence of str or None
        Columns to leave aside, by their name, number or letter [-].

    Returns
    -------
    DmaData
        In SI, with `understood`, a note on how each column was read [-].

    Raises
    ------
    InputError
        As `file:row: column n "name": what; remedy`, for anything doubtful; a line for each of several findings.

    Notes
    -----
    Units given as options override the file, noted in `understood`. Moduli must lie between 1e4 and 1e11 Pa,
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
    _check_options(poisson_ratio, temperature, kind, letter)
    units = {
        "frequency": frequency_unit,
        "modulus": modulus_unit,
        "temperature": temperature_unit,
        "strain": strain_unit,
    }
    given = check_units(units)
    whole = load_grid(Path(path), sheet)
    grid = with_column_names(whole, columns or {})
    asked = _Answers(given, temperature, poisson_ratio, kind, letter, instantaneous)
    findings: list[AnswerableError] = []
    rows, aside = exclude, tuple(ignore or ())
    for _ in range(_MOST_FINDINGS):
        try:
            data, table = _read_grid(grid, rows, aside, asked)
        except AnswerableError as finding:
            findings.append(finding)
            if finding.option == "exclude":
                rows = ",".join(filter(None, [rows, finding.value]))
            else:
                aside = (*aside, finding.value)
        except InputError as error:
            if not findings:
                raise
            raise _join_findings([*findings, error]) from None
        else:
            if findings:
                raise _join_findings(findings)
            return replace(data, source=source_name(path, table))
    raise _join_findings(findings)


class _Answers(NamedTuple):
    """Answers of the user to ambiguities of a file."""

    units: Mapping[str, ColumnUnit]
    temperature: float | None
    poisson_ratio: float
    kind: str | None
    letter: str | None
    instantaneous: float | None


def _join_findings(findings: Sequence[InputError]) -> InputError:
    """Join findings into one error, a line each, with the options that settle them in a last line."""
    if len(findings) == 1:
        return findings[0]
    lines = [str(finding) for finding in findings]
    settled = [finding for finding in findings if isinstance(finding, AnswerableError)]
    if len(settled) > 1:
        ranges = ",".join(each.value for each in settled if each.option == "exclude")
        rows = f"--exclude {row_spans(sorted(row_numbers(ranges)))}" if ranges else ""
        columns = [f"--ignore {each.value}" for each in settled if each.option == "ignore"]
        lines.append(f"these at once: {' '.join(filter(None, [rows, *columns]))}")
    return InputError("\n".join(lines))


def _read_grid(
    grid: TextGrid, exclude: str | None, ignore: Sequence[str], asked: _Answers
) -> tuple[DmaData, DataTable]:
    """Read the table of a grid without some rows and columns; `source` is still empty."""
    if exclude is not None:
        grid = without_rows(grid, exclude)
    table = split_set_points(without_columns(find_table(grid), ignore))
    read = read_columns(table, asked.units)
    columns, derived, shear = _si_quantities(table, read, asked)
    notes = [*table.grid.notes, *table.notes, *read.notes]
    for dimension, unit in asked.units.items():
        if not any(s.explicit and s.unit == unit for s in read.series.values()):
            notes.append(f"{dimension}_unit {unit.name} was given, but the file has no such column")
    labels = read.labels
    if labels is None and table.blocks[-1] > 0:
        labels = np.array(table.blocks, dtype=np.int64)
        notes.append("each block of the file is a run of its own")
    kind, reason = _table_kind(table, columns, read, labels, asked.kind)
    for quantity in STATED_QUANTITIES.get(kind, ()):
        if quantity not in columns and (stated := stated_value(table, quantity)) is not None:
            columns[quantity] = np.full(len(table.rows), stated.value)
            derived.append(stated.note)
    ramp = isotherms_of_ramp(columns) if kind == "temperature sweep" and asked.kind is None else None
    if ramp is not None:
        kind, reason, columns, labels = "isotherms", ramp.note, ramp.columns, ramp.group
        table = replace(table, rows=tuple(table.rows[row] for row in ramp.rows.tolist()))
    arranged = arrange_rows(kind, columns, labels)
    check_trend(table, kind, columns, arranged)
    notes += [*derived, f"{kind}: {reason}", *(_order_notes(table, kind, arranged) if ramp is None else [])]
    data = _assemble_data(table, kind, columns, arranged)
    return replace(data, understood=tuple(notes), shear=shear), table


def read_with_answers(path: Path, answers: Mapping[str, Any], *, poisson_ratio: float, several: bool) -> DmaData:
    """Read a file with the answers of a command, keywords of `read_dma`.

    With several files, answers on units, temperatures and column names that this file contradicts or lacks are not
    applied to it.

    Raises
    ------
    InputError
        As `read_dma`, for the reading with all answers.
    """
    answers = answers_for_file(path, answers) if several else answers
    try:
        return read_dma(path, poisson_ratio=poisson_ratio, **answers)
    except InputError:
        kept = {key: value for key, value in answers.items() if key != "temperature"}
        own = {key: value for key, value in answers.items() if key in _PER_FILE_ANSWERS}
        for fewer in (kept, own | {"temperature": answers.get("temperature")}, own) if several else ():
            with suppress(InputError):
                return read_dma(path, poisson_ratio=poisson_ratio, **fewer)
        raise


def answers_for_file(path: Path, answers: Mapping[str, Any]) -> dict[str, Any]:
    """Answers of a command for one of several files, reduced to the columns that it has."""
    own = dict(answers)
    if not answers.get("columns") and not answers.get("ignore"):
        return own
    grid = load_grid(path, answers.get("sheet"))
    own["columns"] = {k: v for k, v in (answers.get("columns") or {}).items() if names_column(grid, k)}
    own["ignore"] = [name for name in answers.get("ignore") or () if names_column(grid, name)]
    return own


def _check_options(poisson_ratio: float, temperature: float | None, kind: str | None, letter: str | None) -> None:
    low, high = TEMPERATURE_RANGE
    if not 0.0 <= poisson_ratio <= 0.5:
        raise InputError(f"poisson_ratio = {poisson_ratio:g} (--poisson) must be 0 to 0.5")
    if temperature is not None and not low <= temperature <= high:
        raise InputError(
            f"temperature = {temperature:g} K (--temperature) must be {low:g} to {high:g} K; 20 degC are 293.15 K"
        )
    if kind is not None and kind not in KINDS:
        raise InputError(f'kind = "{kind}" (--kind) is not known; allowed: {", ".join(KINDS)}')
    if letter not in {None, "E", "G"}:
        raise InputError(f'letter = "{letter}" (--moduli) must be E or G')


def _si_quantities(
    table: DataTable, read: TableValues, asked: _Answers
) -> tuple[dict[str, FloatArray], list[str], bool]:
    """SI arrays by their names in `DmaData`, notes on derivation, True for shear; raises open questions."""
    series, temperature = read.series, asked.temperature
    check_possible(table, series)
    open_ = {question.column for question in read.questions}
    clear = {q: s for q, s in series.items() if s.column not in open_}
    moduli = dynamic_moduli(table, clear)
    letter = _table_letter(table, series, asked.letter)
    _raise_questions(
        table,
        [
            *read.questions,
            *doubtful_values(table, clear, moduli),
            *([letter.question] if letter and letter.question else []),
        ],
    )
    direct = {"frequency", "temperature", "strain", "time"}
    columns = {q: s.values for q, s in series.items() if q in direct}
    if {"term", "share"} & series.keys():
        columns |= {
            name: series[q].values for name, q in (("tau", "time"), ("tau", "tau"), ("share", "share")) if q in series
        }
        columns.pop("time", None)
    arrays = {name: series[q].values for name, q in _OTHER_MODULI.items() if q in series}
    notes: list[str] = []
    if moduli is not None:
        arrays |= {"storage": moduli.storage, "loss": moduli.loss}
        notes += [moduli.note] if moduli.note else []
    shear = letter is not None and letter.letter == "G"
    if letter is not None:
        factor, note = tensile_factor(letter, asked.poisson_ratio)
        columns |= {name: factor * values for name, values in arrays.items()}
        notes.append(note)
    if "strain" in columns and moduli is not None and _is_shear_strain(series["strain"], shear):
        columns["strain"], note = equivalent_strain(columns["strain"], asked.poisson_ratio)
        notes.append(note)
    for quantity in ("a_T", "b_T"):
        if quantity in series:
            column = series[quantity]
            linear = column.meaning.log_base is None
            columns[f"log10_{quantity}"] = np.log10(column.values) if linear else column.values
    if temperature is not None:
        if "temperature" in series:
            what = "the file has its temperatures; leave out temperature (--temperature)"
            raise table.refusal(series["temperature"].column, what)
        columns["temperature"] = np.full(len(table.rows), temperature)
        notes.append(f"temperature of every row {temperature:g} K as given")
    elif "temperature" not in series and (named := sheet_temperature(table)) is not None:
        columns["temperature"] = np.full(len(table.rows), named.value)
        notes.append(named.note)
    return columns, notes + _apply_shares(table, series, columns, asked.instantaneous), shear


def _table_letter(table: DataTable, series: Mapping[str, ColumnSeries], answer: str | None) -> ModulusLetter | None:
    """Letter of the moduli of a table, tensile or shear; None without moduli."""
    used = [s for s in series.values() if DIMENSIONS[s.meaning.quantity] == "modulus"]
    return modulus_letter(table, used, series.get("strain"), answer) if used else None


def _is_shear_strain(strain: ColumnSeries, shear: bool) -> bool:
    """True for a shear strain, by its name or else by the letter of the moduli."""
    return strain.meaning.letter == "G" or (shear and strain.meaning.letter != "E")


_OTHER_MODULI: Final = {"modulus": "relaxation", "term": "term", "instant": "instant"}
"""Moduli other than E' and E'', by their names in `DmaData`."""


def _apply_shares(
    table: DataTable,
    series: Mapping[str, ColumnSeries],
    columns: dict[str, FloatArray],
    instantaneous: float | None,
) -> list[str]:
    """Replace the shares of a Prony series by moduli; returns notes."""
    shares = columns.pop("share", None)
    if shares is not None and float(np.sum(shares)) >= 1.0:
        what = f"the shares add up to {np.sum(shares):.6g}; less than 1 is needed, the rest is the equilibrium modulus"
        raise table.refusal(series["share"].column, what, len(table.rows) - 1)
    if "tau" not in columns:
        return [] if instantaneous is None else ["instantaneous was given, but the file is no Prony table"]
    if instantaneous is not None:
        if not 0.0 < instantaneous < math.inf:
            raise InputError(f"instantaneous: got {instantaneous:g} Pa (--instantaneous), allowed: > 0 Pa")
        columns["instant"] = np.full(len(table.rows), instantaneous)
    if shares is None:
        return []
    if "term" in columns:
        return ["E_i of each row; the shares are not needed"]
    if "instant" not in columns:
        what = "shares of which modulus? add a column 'E_0 [MPa]', or give instantaneous (--instantaneous)"
        raise table.refusal(series["share"].column, what)
    columns["term"] = shares * columns["instant"]
    return ["E_i = share times E_0"]


def _raise_questions(table: DataTable, questions: list[Question]) -> None:
    """Raise all questions in one line, at the place of the first; one text for each dimension."""
    if not questions:
        return
    text, asked = "", set[str]()
    for column, said, _ in questions:
        dimension = "" if column.meaning is None else DIMENSIONS[column.meaning.quantity]
        label = table.label(column)
        if not text:
            text = said
        else:
            text += f"; likewise {label}" if dimension in asked else f"; and {label}: {said}"
        asked.add(dimension)
    raise table.refusal(questions[0].column, text, questions[0].row)


def _table_kind(
    table: DataTable,
    columns: Mapping[str, FloatArray],
    read: TableValues,
    labels: NDArray[np.int64] | None,
    kind: str | None,
) -> tuple[str, str]:
    """Kind of the table, given or decided, and the reason."""
    present = set(columns)
    choices = possible_kinds(present)
    if kind is not None:
        missing = [name for name in NEEDED_COLUMNS[kind] if name not in present]
        if missing:
            raise _missing_columns_error(table, present, f"a {kind} needs {' and '.join(missing)}")
        return kind, "as given"
    if not choices:
        raise _missing_columns_error(table, present, "these columns make no measurement read here")
    reduced = "frequency" in read.series and read.series["frequency"].meaning.reduced
    decided, reason = decide_kind(columns, labels, reduced=reduced)
    if not decided:
        what = f'{reason}; else give kind, for example kind="{choices[0]}" (--kind), one of {", ".join(choices)}'
        raise table.refusal(table.columns[0], what)
    return decided, reason


def _missing_columns_error(table: DataTable, present: set[str], what: str) -> InputError:
    unknown = next((c for c in table.columns if c.meaning is None), table.columns[-1])
    compliance = next((c for c in table.columns if c.meaning is None and _COMPLIANCE.search(c.header)), None)
    if compliance is not None:
        return table.refusal(compliance, "compliances are not read; give moduli: E' = D'/(D'^2 + D''^2), E'' likewise")
    have = ", ".join(sorted(present | {c.meaning.quantity for c in table.columns if c.meaning is not None}))
    advice = "; give temperature (--temperature)" if {"storage", "loss", "frequency"} <= present else ""
    return table.refusal(
        unknown,
        f"{what} (found: {have}{advice}); beside E' stands E'' or tan delta; name the"
        f" missing column as in {EXAMPLE_HEADER}, with temperature_degC, strain_%,"
        " 't [s]' and 'E(t) [MPa]', or a_T",
    )


def _order_notes(table: DataTable, kind: str, arrangement: Arrangement) -> list[str]:
    """Notes on sorting, duplicate runs and the number of sweeps."""
    notes = []
    rows = table.row_numbers
    moved = np.flatnonzero(np.diff(np.argsort(arrangement.order)) < 0)
    if moved.size:
        notes.append(f"rows sorted; the file is not in order from row {rows[moved[0] + 1]} on")
    if arrangement.duplicates is not None:
        repeated = rows[arrangement.duplicates > 0]
        notes.append(
            f"duplicate runs: {repeated.size} row(s) repeat a set point of their sweep, first row {repeated[0]};"
            f" up to {int(arrangement.duplicates.max()) + 1} runs are kept apart"
        )
    if arrangement.group is not None and kind in {"isotherms", "strain sweep"}:
        notes.append(f"rows grouped by temperature: {np.unique(arrangement.group).size}")
    return notes


def _assemble_data(table: DataTable, kind: str, columns: Mapping[str, FloatArray], arrangement: Arrangement) -> DmaData:
    """Sort and freeze the columns; `understood` is still empty."""

    def ordered(values: NDArray[T]) -> NDArray[T]:
        made: NDArray[T] = values[arrangement.order]
        made.setflags(write=False)
        return made

    def column(name: str) -> FloatArray | None:
        return ordered(columns[name]) if name in columns else None

    series = kind == "Prony series"
    return DmaData(
        kind=kind,
        frequency=column("frequency"),
        temperature=column("temperature"),
        strain=column("strain"),
        time=column("tau" if series else "time"),
        storage=column("storage"),
        loss=column("loss"),
        modulus=column("term" if series else "modulus"),
        log10_a_T=column("log10_a_T"),
        log10_b_T=column("log10_b_T"),
        run=None if arrangement.run is None else ordered(arrangement.run),
        group=None if arrangement.group is None else ordered(arrangement.group),
        row_numbers=ordered(table.row_numbers),
        metadata=MappingProxyType({key: value for key, (value, _) in table.metadata.items()}),
        metadata_rows=MappingProxyType({key: row for key, (_, row) in table.metadata.items()}),
        understood=(),
        source="",
        instantaneous=float(columns["instant"][0]) if "instant" in columns else None,
    )
