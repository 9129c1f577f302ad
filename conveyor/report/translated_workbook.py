"""Tables of the workbook in the language of the report; sheets translate what they write beside them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from conveyor.languages.translator import Translator
from conveyor.report.table_model import FIGURE_NAME, Column, Figure, Table


def translate_table(part: Table, translator: Translator) -> Table:
    """Return a table with its texts in a language; keys, verdicts and what was given stay."""
    return replace(
        part,
        heading=translator.heading(part.heading),
        note=translator.text(part.note),
        foot=translator.heading(part.foot),
        columns=tuple(_translate_column(column, translator) for column in part.columns),
        rows=tuple(_translate_row(row, translator) for row in part.rows),
    )


def _translate_row(row: Any, translator: Translator) -> Any:
    return replace(row, label=translator.heading(row.label)) if isinstance(row, Figure) else row


def _translate_column(column: Column, translator: Translator) -> Column:
    label, get = translator.heading(column.label), column.get
    if column.verbatim or column.kind in {FIGURE_NAME, "verdict"}:
        return replace(column, label=label)

    def translated(row: Any) -> Any:
        value = get(row)
        return translator.text(value) if isinstance(value, str) else value

    return replace(column, label=label, get=translated)
