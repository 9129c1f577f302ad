"""The empty form of a maker's list: a sheet for each kind, its headings with units, and what each column means."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from openpyxl import Workbook
from openpyxl.comments import Comment
from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.arguments.argument_types import check_arguments
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.files.output_marks import program_version
from conveyor.files.workbook_bytes import workbook_bytes
from conveyor.forms.form_fields import FormField
from conveyor.forms.maker_list_reader import COLUMNS_SHEET, LIST_FORMS
from conveyor.models.maker_lists import MakerKind
from conveyor.report.cells import BOLD, GREY, INPUT_FILL, PALE, TITLE, write_value
from conveyor.starter.template_sheets import allowed_text

_ROWS: Final = 20  # of inputs drawn
_TEXTS: Final = {
    "name": "Name that a spec lists the item by; the package's own and other lists have none like it.",
    "source": "Maker, list, edition and page.",
    "note": "What else is to be said, such as part number, article; no figure uses it.",
}

_MEANINGS: Final[Mapping[tuple[MakerKind, str], str]] = {
    ("motors", "installed_power"): "Rated power of one motor.",
    ("motors", "inertia"): "Of one motor, at its shaft.",
    ("motors", "efficiency"): "Of the motor: power at its shaft over that from the mains.",
    ("gearboxes", "gear_ratio"): "Speed of its fast shaft over that of the slow one.",
    ("gearboxes", "efficiency"): "Of the gearbox alone, from its fast to its slow shaft.",
    ("gearboxes", "gear_torque"): "Rated torque at its slow shaft.",
    ("couplings", "efficiency"): "Of the coupling alone, its slip included.",
    ("couplings", "coupling_torque"): "Rated torque.",
}
"""What a column of an item means where the field of the spec says it of the whole drive."""


@check_arguments
def write_maker_list_form(path: str | Path) -> Path:
    """Write the empty form of a maker's list.

    Parameters
    ----------
    path : str or Path
        Name of the workbook, ending in ``.xlsx``.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        It cannot be written.
    """
    where = Path(path)
    check_writable(where)
    save_files({where: maker_list_form()})
    return where


def maker_list_form() -> bytes:
    """The form as bytes."""
    book = Workbook()
    book.remove(book.worksheets[0])
    explained = book.create_sheet(COLUMNS_SHEET)
    write_value(explained.cell(1, 1), "List of a maker", TITLE)
    words = (
        "Fill in the sheets that you have items for; a row an item. Units may be others: write them into the heading. "
        "Then: conveyor library add LIST.xlsx"
    )
    write_value(explained.cell(2, 1), words, GREY)
    for number, heading in enumerate(("sheet", "column", "unit", "needed", "meaning", "allowed"), start=1):
        write_value(explained.cell(4, number), heading, BOLD)
        explained.cell(4, number).fill = PALE
    row = 5
    for kind in LIST_FORMS:
        sheet = book.create_sheet(kind.capitalize())
        for number, (path, unit, needed, meaning, allowed) in enumerate(_list_columns(kind), start=1):
            heading = sheet.cell(1, number)
            write_value(heading, f"{path} [{unit}]" if unit else path, BOLD)
            heading.fill, heading.alignment = PALE, Alignment(wrap_text=True, vertical="top")
            heading.comment = Comment("\n".join(filter(None, (meaning, allowed))), "conveyor", height=110, width=280)
            sheet.column_dimensions[get_column_letter(number)].width = 30 if path in _TEXTS else max(15, len(path) + 2)
            for each in range(2, _ROWS + 2):
                sheet.cell(each, number).fill = INPUT_FILL
            about = (kind.capitalize(), path, unit, needed, meaning, allowed)
            for column, said in enumerate(about, start=1):
                write_value(explained.cell(row, column), said)
                explained.cell(row, column).alignment = Alignment(wrap_text=column > 4, vertical="top")
            row += 1
        sheet.row_dimensions[1].height = 32
        _fit_width(sheet)
        sheet.freeze_panes = "B2"
    for letter, width in zip("ABCDEF", (12, 26, 9, 8, 70, 40), strict=True):
        explained.column_dimensions[letter].width = width
    explained.freeze_panes = "A5"
    _fit_width(explained)
    book.properties.creator = program_version()
    return workbook_bytes(book)


def _fit_width(sheet: Worksheet) -> None:
    """Print a sheet across, on the width of a page."""
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)


def _list_columns(kind: MakerKind) -> Iterator[tuple[str, str, str, str, str]]:
    """Path, unit, "yes" if needed, meaning and allowed values of the columns of a kind."""
    form = LIST_FORMS[kind]
    for path in ("name", "source"):
        yield path, "", "yes", _TEXTS[path], ""
    for path, unit in form.columns.items():
        leaf: FormField = form.leaf(path)
        other = " or ".join(each for each in form.either if each != path) if path in form.either else ""
        needed = "yes" if path in form.needed else f"or {other}" if other else ""
        yield path, unit, needed, _MEANINGS.get((kind, path), leaf.doc), allowed_text(leaf)
    yield "note", "", "", _TEXTS["note"], ""
