"""The workbook: values, not formulas; native charts; nothing a user typed can become a formula."""

from __future__ import annotations

import math
import platform
import re
from collections.abc import Iterable
from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
from openpyxl import Workbook
from openpyxl.cell.cell import Cell, MergedCell
from openpyxl.styles import Alignment, Font, PatternFill
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.header_footer import HeaderFooterItem, _HeaderFooterPart
from openpyxl.worksheet.properties import PageSetupProperties
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.errors import InputError
from conveyor.report import charts, tables
from conveyor.report.inputs import inputs
from conveyor.spec import fingerprint
from conveyor.units import si, text

if TYPE_CHECKING:
    from conveyor.analysis import Analysis

ACCENT = "1F4E79"
_TITLE = Font(name="Calibri", size=16, bold=True, color=ACCENT)
_HEADING = Font(name="Calibri", size=12, bold=True, color=ACCENT)
_HEADER = Font(name="Calibri", bold=True, color="FFFFFF")
_FILL = PatternFill("solid", fgColor=ACCENT)
_GREY = Font(name="Calibri", italic=True, color="666666")
_WRAP = Alignment(wrap_text=True, vertical="top")
_UNSAFE = ("=", "+", "-", "@", "\t", "\r", "\n")
_WIDEST = 60
_VERSIONED = ("conveyor", "numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl")

# Number format by unit; the first pattern that the column's name matches
_FORMATS = (
    (r"estimate|energy error", "0.0E+00"),
    (r"\[(s|Hz)\]", "0.000E+00"),
    (r"share|penetration of cover", "0.0%"),
    (r"equivalent.* f \[-\]|^f \[-\]|classical f", "0.0000"),
    (r"friction \[-\]|tan delta|energy \[kWh", "0.0000"),
    (r"\[N/m\]|\[kg/m\]|\[deg\]|\[-\]|\[m/s\]", "0.00"),
    (r"\[mm\]|\[MPa\]", "0.000"),
    (r"\[m\]", "#,##0.0"),
    (r"\[(N|kW|MWh|t/h|[A-Z]{3})\]", "#,##0.0"),
)  # fmt: skip


def write(analysis: Analysis, path: Path) -> Path:
    """Write the workbook of an analysis: under a temporary name first, then renamed.

    Raises
    ------
    InputError
        The path does not end in .xlsx or cannot be written.
    """
    if path.suffix.lower() != ".xlsx":
        raise InputError(f'{path}: a workbook\'s name ends in .xlsx, got "{path.suffix}"')
    if path.is_dir() or not path.absolute().parent.is_dir():
        raise InputError(f"{path}: is a folder, or lies in a folder that does not exist")
    book = build(analysis)
    partial = path.with_name(path.name + ".part")
    try:
        book.save(partial)
        partial.replace(path)
    except OSError as error:
        partial.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    return path


def build(analysis: Analysis) -> Workbook:
    """Workbook of an analysis, not yet saved."""
    book = Workbook()
    book.remove(book.worksheets[0])
    _summary(book, analysis)
    _sheet(book, "Inputs", analysis, [("Inputs as entered and in SI", inputs(analysis.conveyor))])
    _sheet(book, "Sections", analysis, [("Forces of every section and strand", analysis.sections)])
    _resistances(book, analysis)
    _sheet(book, "Rolls", analysis, [("Rolls of a set, contact at the highest line load", analysis.rolls)])
    _tensions(book, analysis)
    _indentation(book, analysis)
    _rubber(book, analysis)
    _notes(book, analysis)
    return book


def put(cell: Cell | MergedCell, value: Any, font: Font | None = None) -> None:
    """Write one value: text as text whatever it begins with, numbers as numbers, nothing for None."""
    if isinstance(cell, MergedCell) or value is None or (isinstance(value, float) and math.isnan(value)):
        return  # pandas writes a missing number of a mixed column as NaN
    if isinstance(value, str):
        cell.value = value
        cell.data_type = "s"
        if value.startswith(_UNSAFE):
            cell.quotePrefix = True
    else:
        cell.value = value.item() if hasattr(value, "item") else value
    if font is not None:
        cell.font = font


def _number_format(column: str) -> str:
    return next((shown for pattern, shown in _FORMATS if re.search(pattern, column)), "General")


def _sheet(
    book: Workbook, title: str, analysis: Analysis, blocks: Iterable[tuple[str, pd.DataFrame]]
) -> Worksheet:
    """Sheet with headed tables under each other; the first table's header stays in view."""
    sheet: Worksheet = book.create_sheet(title)
    row = 1
    for heading, frame in blocks:
        put(sheet.cell(row, 1), heading, _HEADING)
        row = table(sheet, frame, row + 1) + 2
    sheet.freeze_panes = "A3"
    sheet.print_title_rows = "1:2"
    _print_set_up(sheet, analysis)
    return sheet


def table(sheet: Worksheet, frame: pd.DataFrame, row: int, column: int = 1) -> int:
    """Write a table with its header at (row, column); returns its last row."""
    for j, name in enumerate(frame.columns, start=column):
        header = sheet.cell(row, j)
        put(header, str(name), _HEADER)
        numeric = pd.api.types.is_numeric_dtype(frame[name]) or name == "SI value"
        side = "right" if numeric else "left"
        header.fill, header.alignment = _FILL, Alignment(wrap_text=True, vertical="center", horizontal=side)
        shown = _number_format(str(name))
        longest = 0
        for i, value in enumerate(frame[name].tolist(), start=row + 1):
            cell = sheet.cell(i, j)
            put(cell, value)
            if isinstance(value, str):
                longest = max(longest, len(value))
                cell.alignment = Alignment(horizontal="left", indent=1)
            elif name == "SI value":
                cell.number_format = "General"
            else:
                cell.number_format = shown
        letter = get_column_letter(j)
        needed = min(_WIDEST, max(11, longest + 3, max(map(len, str(name).split())) + 2))
        sheet.column_dimensions[letter].width = max(sheet.column_dimensions[letter].width or 0.0, needed)
    widths = [
        sheet.column_dimensions[get_column_letter(j)].width for j in range(column, column + frame.shape[1])
    ]
    lines = max(
        math.ceil((len(str(name)) + 4) / width) for name, width in zip(frame.columns, widths, strict=True)
    )
    sheet.row_dimensions[row].height = max(sheet.row_dimensions[row].height or 0.0, 15.0 * min(lines, 3))
    return row + len(frame)


def _print_set_up(sheet: Worksheet, analysis: Analysis) -> None:
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.paperSize = sheet.PAPERSIZE_A4
    sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight = 1, 0
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    left, right = (
        _HeaderFooterPart(text=analysis.conveyor.name.replace("&", "&&")),
        _HeaderFooterPart(text="&A"),
    )
    sheet.oddHeader = HeaderFooterItem(left=left, right=right)
    sheet.oddFooter = HeaderFooterItem(right=_HeaderFooterPart(text="&P / &N"))
    sheet.sheet_view.showGridLines = False


def _summary(book: Workbook, analysis: Analysis) -> None:
    sheet = book.create_sheet("Summary")
    conveyor, found = analysis.conveyor, analysis.balance
    put(sheet["A1"], conveyor.name, _TITLE)
    put(
        sheet["A2"],
        f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {fingerprint(conveyor)[:16]}",
        _GREY,
    )
    put(sheet["A3"], f"{len(analysis.warnings)} notes to read: sheet Checks and notes", _GREY)
    put(sheet["A5"], "Results", _HEADING)
    row = 6
    for name, value in analysis.summary.items():
        put(sheet.cell(row, 1), str(name))
        cell = sheet.cell(row, 2)
        put(cell, float(value))
        cell.number_format = _number_format(str(name))
        if name in {"motor power [kW]", "equivalent DIN f [-]", "effective tension [N]", "indentation [N]"}:
            sheet.cell(row, 1).font = cell.font = Font(name="Calibri", bold=True)
        row += 1
    put(sheet["D5"], "Resistance breakdown", _HEADING)
    breakdown = _breakdown(analysis)
    last = table(sheet, breakdown, 6, 4)
    put(sheet.cell(last + 2, 4), "Beside the classical estimate (ISO 5048 / DIN 22101, given f)", _HEADING)
    comparison = tables.comparison(found).rename_axis("quantity").reset_index()
    bottom = table(sheet, comparison, last + 3, 4)
    for i in range(last + 4, bottom + 1):
        shown = _number_format(str(sheet.cell(i, 4).value))
        sheet.cell(i, 5).number_format = sheet.cell(i, 6).number_format = shown
    note = f"classical secondary: {found.classical.secondary_by}; governing at the drive: {found.tensions.governed_by}"
    put(sheet.cell(bottom + 1, 4), note, _GREY)
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 42, 16
    sheet.column_dimensions["C"].width, sheet.column_dimensions["D"].width = 3, 24
    sheet.column_dimensions["E"].width = sheet.column_dimensions["F"].width = 19
    chart = charts.breakdown(sheet, header=6, last=last, label=4, value=5)
    sheet.add_chart(chart, f"D{bottom + 3}")
    _print_set_up(sheet, analysis)
    sheet.page_setup.fitToHeight = 1
    for i in range(1, bottom + 1):  # rows are shared by the tables left and right
        sheet.row_dimensions[i].height = None


def _breakdown(analysis: Analysis) -> pd.DataFrame:
    forces = analysis.balance.forces
    names = ("indentation", "idler_rotation", "flexure", "secondary", "special", "lift")
    values = [getattr(forces, name) for name in names]
    share = [value / forces.total for value in values] if forces.total else [None] * len(values)
    labels = [name.replace("_", " ") for name in names]
    return pd.DataFrame({"resistance": labels, "force [N]": values, "share of total [-]": share})


def _resistances(book: Workbook, analysis: Analysis) -> None:
    frame = analysis.resistances
    sheet = _sheet(book, "Resistances", analysis, [("Every force and the law it comes from", frame)])
    total = len(frame) + 3
    put(sheet.cell(total, 1), "effective tension", Font(name="Calibri", bold=True))
    put(sheet.cell(total, 3), analysis.balance.forces.total, Font(name="Calibri", bold=True))
    sheet.cell(total, 3).number_format = "#,##0.0"


def _tensions(book: Workbook, analysis: Analysis) -> None:
    frame = tables.tensions(analysis.balance)
    sheet = _sheet(
        book, "Tensions", analysis, [("Tension round the loop, steady running, from the drive", frame)]
    )
    sheet.add_chart(charts.tension(sheet, header=2, last=2 + len(frame)), "F4")


def _indentation(book: Workbook, analysis: Analysis) -> None:
    frame = tables.indentation_curves(analysis.stretches)
    sheet = _sheet(
        book, "Indentation", analysis, [("Indentation against line load, one block a contact", frame)]
    )
    sheet.add_chart(charts.indentation(sheet, frame, header=2), "H4")


def _rubber(book: Workbook, analysis: Analysis) -> None:
    sheet = book.create_sheet("Rubber")
    conveyor = analysis.conveyor
    temperature = si(conveyor.ambient.belt)
    compounds = {c.name: c for c in (conveyor.carry_compound, conveyor.return_compound)}
    row = 1
    for compound in compounds.values():
        put(
            sheet.cell(row, 1),
            f"{compound.name} ({compound.kind}) at {text(conveyor.ambient.belt)}",
            _HEADING,
        )
        facts = {
            "description": compound.description,
            "origin": compound.source.origin,
            "licence": compound.source.licence or "not stated",
            "strain": compound.strain or "not stated",
            "reference temperature": text(compound.reference_temperature),
            "measured frequency": ""
            if compound.range is None
            else " to ".join(text(f) for f in compound.range.frequency),
            "measured temperature": (
                "" if compound.range is None else " to ".join(text(t) for t in compound.range.temperature)
            ),
            "not known": "; ".join(compound.missing),
        }
        for name, value in facts.items():
            row += 1
            put(sheet.cell(row, 1), name, _GREY)
            put(sheet.cell(row, 2), value)
        moduli = tables.moduli(compound, temperature)
        top = row + 2
        end = table(sheet, tables.prony(compound, temperature), top, 1)
        bottom = table(sheet, moduli, top, 5)
        sheet.add_chart(charts.moduli(sheet, compound.name, header=top, last=bottom), f"J{top}")
        row = max(end, bottom, top + 18) + 3
    for letter, width in {"A": 22, "B": 22, "C": 22, "D": 3, "E": 16, "F": 12, "G": 12, "H": 12}.items():
        sheet.column_dimensions[letter].width = width
    _print_set_up(sheet, analysis)


def _notes(book: Workbook, analysis: Analysis) -> None:
    sheet = book.create_sheet("Checks and notes")
    row = 1
    notes = [] if analysis.conveyor.notes is None else [analysis.conveyor.notes]
    for heading, lines in (
        ("Warnings", analysis.warnings), ("Assumptions", analysis.assumptions), ("Notes of the spec", notes),
    ):  # fmt: skip
        put(sheet.cell(row, 1), heading, _HEADING)
        for line in lines or ("none",):
            row += 1
            sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=9)
            put(sheet.cell(row, 1), line)
            sheet.cell(row, 1).alignment = _WRAP
            sheet.row_dimensions[row].height = 15.0 * (1 + len(line) // 150)
        row += 2
    put(sheet.cell(row, 1), "Contact solutions, one a distinct roll, cover and spacing", _HEADING)
    row = table(sheet, tables.solver(analysis.stretches), row + 1) + 2
    put(sheet.cell(row, 1), "Provenance", _HEADING)
    facts = {
        "spec SHA-256": fingerprint(analysis.conveyor),
        "date": date.today().isoformat(),
        "python": platform.python_version(),
        **{name: version(name) for name in _VERSIONED},
    }
    for name, value in facts.items():
        row += 1
        put(sheet.cell(row, 1), name)
        put(sheet.cell(row, 2), value)
    sheet.column_dimensions["A"].width = 26
    _print_set_up(sheet, analysis)
