"""Formulas with their values beside them: openpyxl writes formulas alone, and viewers then read nothing."""

from __future__ import annotations

import re
from collections.abc import Mapping
from io import BytesIO
from typing import Final
from zipfile import ZIP_DEFLATED, ZipFile

Values = Mapping[tuple[int, str], float | str]
"""Of formulas, numbers or words, by the number of their sheet, from 1, and their cell."""

_SHEET: Final = "xl/worksheets/sheet{}.xml"


def with_values(workbook: bytes, values: Values) -> bytes:
    """Return a workbook whose formulas have their values beside them, as a spreadsheet saves them.

    Parameters
    ----------
    workbook : bytes
        As openpyxl saves it: formulas without values.
    values : mapping
        Of every formula.
    """
    if not values:
        return workbook
    made = BytesIO()
    with ZipFile(BytesIO(workbook)) as old, ZipFile(made, "w", ZIP_DEFLATED) as new:
        for part in old.infolist():
            content = old.read(part)
            for (number, cell), value in values.items():
                if part.filename == _SHEET.format(number):
                    content = _valued(content, cell, value)
            new.writestr(part, content)
    return made.getvalue()


def _valued(sheet: bytes, cell: str, value: float | str) -> bytes:
    pattern = rf'(<c r="{cell}"[^>]*)(><f>[^<]*</f>)<v\s*/?>(?:</v>)?'.encode()
    kind, shown = (' t="str"', value) if isinstance(value, str) else ("", repr(value))
    written, count = re.subn(pattern, rf"\g<1>{kind}\g<2><v>{shown}</v>".encode(), sheet)
    if count != 1:
        raise ValueError(f"{cell}: no formula without a value")
    return written
