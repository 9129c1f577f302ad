"""Cells of the rows to numbers and labels; what is missing, too many or no number is refused by its place."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from conveyor.laboratory.cells import TextGrid
from conveyor.laboratory.decimals import decimal_mark, is_number, why_not_a_number
from conveyor.laboratory.layout import DataColumn, DataTable
from conveyor.laboratory.table import FloatArray, IntArray


def check_width(table: DataTable) -> None:
    """Refuse rows longer than the header.

    Parameters
    ----------
    table : Table
        Header and rows [-].

    Raises
    ------
    InputError
        At the first cell without a name.
    """
    width = len(table.columns)
    for line in table.rows:
        if len(line.cells) > width:
            comma = table.grid.notes[-1].endswith("comma") and len(line.cells) == 2 * width
            advice = (
                "decimal commas in a table separated by commas? export it with semicolons or decimal points"
                if comma
                else "name every column in the header, or remove the extra cell"
            )
            raise table.grid.refusal(
                line.number, width, f"{len(line.cells)} cells, the header names {width}; {advice}"
            )


def column_cells(table: DataTable, column: DataColumn) -> list[str]:
    """Cells of one column, none empty.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    column : Column
        The column [-].

    Returns
    -------
    list of str
        Shape `(n,)` [-].

    Raises
    ------
    InputError
        At the first empty cell.
    """
    index = column.index
    found = []
    for line in table.rows:
        cell = line.cells[index] if index < len(line.cells) else ""
        if not cell:
            hint = " (a formula without a stored value?)" if table.grid.sheet else " (a line cut short?)"
            raise table.grid.refusal(
                line.number,
                index,
                f"the cell is empty{hint}; complete or delete the row",
                header=column.header,
            )
        found.append(cell)
    return found


def table_mark(table: DataTable, columns: list[DataColumn], cells: Mapping[int, list[str]]) -> str:
    """Decimal mark of all number columns together.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    columns : list of Column
        The used columns [-].
    cells : mapping of list
        Cells of the rows by the index of the column [-].

    Returns
    -------
    str
        `"."` or `","` [-].

    Raises
    ------
    InputError
        At the first cell that is no number, or that leaves the mark open.
    """
    for column in columns:
        for line, cell in zip(table.rows, cells[column.index], strict=True):
            if not is_number(cell):
                raise table.grid.refusal(
                    line.number,
                    column.index,
                    why_not_a_number(cell if any(map(is_number, line.cells)) else line.text),
                    header=column.header,
                )
    mark, doubtful = decimal_mark(cell for column in columns for cell in cells[column.index])
    if doubtful is None:
        return mark
    for column in columns:
        if doubtful in cells[column.index]:
            line = table.rows[cells[column.index].index(doubtful)]
            point = any("." in cell for c in columns for cell in cells[c.index])
            why = (
                "a comma here and decimal points elsewhere"
                if point
                else "a decimal comma or a thousands separator cannot be told apart"
            )
            raise table.grid.refusal(
                line.number,
                column.index,
                f"'{doubtful}': {why}; export the table with decimal points and no thousands separators",
                header=column.header,
            )
    raise AssertionError(doubtful)


def check_finite(table: DataTable, column: DataColumn, numbers: FloatArray, cells: list[str]) -> None:
    """Refuse numbers too large for a double.

    Parameters
    ----------
    table : Table
        Header and rows [-].
    column : Column
        The column [-].
    numbers : numpy.ndarray
        Shape `(n,)`, in the unit of the file [unit].
    cells : list of str
        As written [-].

    Raises
    ------
    InputError
        At the first one.
    """
    bad = np.flatnonzero(~np.isfinite(numbers))
    if bad.size:
        raise table.grid.refusal(
            table.rows[bad[0]].number,
            column.index,
            f"'{cells[bad[0]]}' is too large for a number; repair or delete the row",
            header=column.header,
        )


def run_labels(
    grid: TextGrid, table: DataTable, column: DataColumn, cells: Mapping[int, list[str]]
) -> IntArray:
    """Whole numbers as they are, other labels numbered in the order of their appearance.

    Parameters
    ----------
    grid : Grid
        Where it stands [-].
    table : Table
        Header and rows [-].
    column : Column
        The column [-].
    cells : mapping of list
        Cells of the rows by the index of the column [-].

    Returns
    -------
    numpy.ndarray
        Shape `(n,)` [-].

    Raises
    ------
    InputError
        If every row has a label of its own.
    """
    text = cells[column.index]
    plain = [cell.removesuffix(".0") for cell in text]
    if all(cell.lstrip("-").isdigit() for cell in plain):
        return np.array([int(cell) for cell in plain], dtype=np.int64)
    order = {label: number for number, label in enumerate(dict.fromkeys(text))}
    if len(order) == len(table.rows) > 1:
        raise grid.refusal(
            table.rows[0].number,
            column.index,
            "every row has a label of its own, so they tell no runs apart; rename the column if it is not a run",
            header=column.header,
        )
    return np.array([order[label] for label in text], dtype=np.int64)
