"""Tables in files: text and sheets of workbooks as grids of cells."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Final

from conveyor.errors import InputError
from conveyor.files.file_bytes import file_content
from conveyor.files.workbook_cells import MAGIC
from conveyor.laboratory.cell_grid import TextGrid, cell_error
from conveyor.laboratory.delimited_text import text_grid
from conveyor.laboratory.encoding import decode_text
from conveyor.laboratory.sheet_grids import workbook_grids
from conveyor.laboratory.table_layout import EXAMPLE_HEADER, DataTable, has_table

LARGEST_FILE: Final = 50_000_000
"""Bytes; a table of a million rows has about as many."""


def matching_sheets(path: Path, pattern: str | None) -> list[str | None]:
    """Sheets with a table that match a pattern with * or ?; else the pattern itself, None for a text file."""
    if pattern is None or not {"*", "?"} & set(pattern):
        return [pattern]
    data = file_content(path, largest=LARGEST_FILE, expected="table of a laboratory")
    if not data.startswith(MAGIC):
        return [None]
    grids = workbook_grids(data, path.name)
    found: list[str | None] = [g.sheet for g in grids if fnmatchcase(g.sheet, pattern) and has_table(g)]
    if not found:
        names = ", ".join(repr(grid.sheet) for grid in grids)
        what = f"no sheet '{pattern}' holds a table; sheet (--sheet) must fit one of {names}"
        raise cell_error(path.name, 1, 0, what, lettered=True)
    return found


def load_grid(path: Path, sheet: str | None) -> TextGrid:
    """Load a text file, or the one sheet with a table."""
    if path.suffix.lower() in {".yaml", ".yml", ".json"}:
        raise InputError(f"{path}: a {path.suffix.lower()} file is no table of a laboratory; give .csv, .txt or .xlsx")
    data = file_content(path, largest=LARGEST_FILE, expected="table of a laboratory")
    if not data.startswith(MAGIC):
        if sheet is not None:
            what = f"a text file has no sheet '{sheet}'; leave out sheet (--sheet)"
            raise cell_error(path.name, 1, 0, what)
        text, note = decode_text(data, path.name)
        return text_grid(text, path.name, note)
    grids = workbook_grids(data, path.name)
    names = ", ".join(repr(grid.sheet) for grid in grids)
    tables = [grid for grid in grids if has_table(grid)] if sheet is None else [g for g in grids if g.sheet == sheet]
    if not tables:
        what = f"no table on any sheet ({names}); one of them needs {EXAMPLE_HEADER}"
        if sheet is not None:
            what = f"no sheet '{sheet}'; sheet (--sheet) must be one of {names}"
        raise cell_error(path.name, 1, 0, what, lettered=True)
    if len(tables) > 1:
        several = ", ".join(repr(grid.sheet) for grid in tables)
        first = tables[0].sheet
        what = (
            f'{len(tables)} sheets hold a table: {several}; give sheet, for example sheet="{first}" (--sheet); if all'
            " are of one rubber, conveyor fit takes them together by --sheet '*'"
        )
        raise tables[1].refusal(tables[1].lines[0].number, 0, what)
    empty = [] if sheet is not None else [repr(grid.sheet) for grid in grids if grid is not tables[0]]
    more = (f"no table on {', '.join(empty)}",) if empty else ()
    return replace(tables[0], notes=(*tables[0].notes, *more))


def source_name(path: str | Path, table: DataTable) -> str:
    """Path of a file, with the sheet of a workbook."""
    return f"{path}[{table.grid.sheet}]" if table.grid.sheet else str(path)
