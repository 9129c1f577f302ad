"""Unpivot tables with a column for each frequency or temperature: a row for each set point of the headers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from conveyor.laboratory.cell_grid import TextLine
from conveyor.laboratory.header_meanings import Meaning, SetPoint
from conveyor.laboratory.numbers import is_number, why_not_a_number
from conveyor.laboratory.table_layout import DataColumn, DataTable, exclude_advice

SetPointColumns: TypeAlias = Mapping[SetPoint, Sequence[DataColumn]]


def split_set_points(table: DataTable) -> DataTable:
    """Split rows so that each set point of the headers, `E'(1 Hz)`, `E'(10 Hz)`, has its own; others are unchanged.

    Cells of a further set point move to the columns of the first one, its number to a new last column. A set point
    with empty cells only makes no row.
    """
    groups = _set_point_columns(table)
    if not groups:
        return table
    first = next(iter(groups.values()))
    rows = [
        (each, block)
        for line, block in zip(table.rows, table.blocks, strict=True)
        for each in _split_row(table, line, groups)
    ]
    further = {column.index for columns in groups.values() for column in columns} - {c.index for c in first}
    quantity, _, unit = next(iter(groups))
    added = DataColumn(table.width, f"{quantity} of the headers", Meaning(quantity, unit), None)
    said = ", ".join(point.number for point in groups)
    return replace(
        table,
        columns=(*(c for c in table.columns if c.index not in further), added),
        rows=tuple(line for line, _ in rows),
        blocks=tuple(block for _, block in rows),
        notes=(*table.notes, f"a row for each {quantity} of the headers: {said} {unit}"),
    )


def _set_point_columns(table: DataTable) -> SetPointColumns:
    """Columns of each set point; none if the table also has a column of that quantity."""
    groups: dict[SetPoint, list[DataColumn]] = {}
    for column in table.columns:
        if column.meaning is not None and column.meaning.at is not None:
            groups.setdefault(column.meaning.at, []).append(column)
    shared = {c.meaning.quantity for c in table.columns if c.meaning is not None and c.meaning.at is None}
    if len({(point.quantity, point.unit) for point in groups}) != 1 or {p.quantity for p in groups} & shared:
        return {}
    first = next(iter(groups.values()))
    for point, columns in groups.items():
        if [_without_set_point(column) for column in columns] != [_without_set_point(column) for column in first]:
            what = f"{point.number} {point.unit} has other columns than the first, {len(first)} from this name on"
            raise table.refusal(first[0], f"{what}; give all the same, or remove those of {point.number} {point.unit}")
    return groups


def _split_row(table: DataTable, line: TextLine, groups: SetPointColumns) -> Sequence[TextLine]:
    """Rows of one line, one for each measured set point."""
    cells = (*line.cells, *[""] * (table.width - len(line.cells)))
    first = next(iter(groups.values()))
    rows = []
    for point, columns in groups.items():
        values = {into.index: cells[column.index] for into, column in zip(first, columns, strict=True)}
        for column in columns if any(values.values()) else ():
            if not is_number(cell := cells[column.index]):
                said = why_not_a_number(cell) if cell else "the cell is empty; complete or delete the row"
                raise table.grid.refusal(
                    line.number,
                    column.index,
                    f"{said}, or {exclude_advice(str(line.number))}",
                    header=column.header,
                )
        if any(values.values()):
            own = [values.get(index, cell) for index, cell in enumerate(cells)]
            rows.append(line._replace(cells=(*own, _without_decimal_point(point.number))))
    return rows


def _without_set_point(column: DataColumn) -> Meaning | None:
    """Meaning of a column without its set point."""
    return column.meaning and column.meaning._replace(at=None)


def _without_decimal_point(number: str) -> str:
    """Number without decimal point, 3333e-3: a table with decimal commas may have points in its headers."""
    whole, _, decimals = number.partition(".")
    return f"{whole}{decimals}e-{len(decimals)}" if decimals else number
