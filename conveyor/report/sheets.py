"""The sheets of the workbook on one run of the conveyor, one function each."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from openpyxl.styles import Alignment
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import charts
from conveyor.report.cells import GREY, HEADING, put, total
from conveyor.report.places import Page, define
from conveyor.units import text

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.models import RubberCompound

_CHART_COLUMN = "F"
_CURVES_COLUMN = "H"
_NARROW = 12.0  # width of a chart on a page held upright [cm]
_PAGE_ROWS = 110  # of a compound that still fit its page
_FILLED = 1.05  # of a line's width that text takes before it breaks at a word
_PIECE = 1000  # characters of a note in one cell


def results(page: Page, _: Analysis) -> None:
    """Every figure of the whole conveyor, and the name to link to it by."""
    page.headed("results")


def inputs(page: Page, _: Analysis) -> None:
    """Every field: as entered, in SI, and whether the spec or a default gave it."""
    page.headed("inputs")


def sections(page: Page, _: Analysis) -> None:
    """Forces of every section and strand, and their sums."""
    place = page.headed("sections", frozen="C3", widest=30)
    if not place.whole:
        return
    frame = page.contents["sections"].frame
    summed = [j for j, name in enumerate(frame.columns, start=1) if str(name).endswith(("[N]", "[lbf]"))]
    sums = {j: math.fsum(frame.iloc[:, j - 1].tolist()) for j in summed}
    total(page.sheet, place.last + 1, len(frame.columns), {1: "all sections", **sums})


def resistances(page: Page, analysis: Analysis) -> None:
    """Every force and its law, adding up to the effective tension; their sums; the classical estimate."""
    place = page.headed("resistances")
    frame = page.contents["resistances"].frame
    if place.whole:
        summed = math.fsum(frame.iloc[:, 2].tolist())
        total(page.sheet, place.last + 1, len(frame.columns), {1: "effective tension", 3: summed})
    row = page.place("breakdown", place.last + 4).last + 3
    end = page.place("classical", row).last
    governed = f"governing at the drive: {analysis.balance.tensions.governed_by}"
    put(page.sheet.cell(end + 2, 1), f"{page.contents['classical'].note}; {governed}", GREY)


def rolls(page: Page, _: Analysis) -> None:
    """One row a roll of every set."""
    page.headed("rolls", frozen="D3", widest=30)


def tensions(page: Page, _: Analysis) -> None:
    """Tension at every place of the loop, with its chart."""
    place = page.headed("tensions")
    if place.whole:
        page.sheet.column_dimensions["E"].width = 3
        chart = charts.tension(page.sheet, header=place.header, last=place.last)
        page.sheet.add_chart(chart, f"{_CHART_COLUMN}4")


def indentation(page: Page, _: Analysis) -> None:
    """What every distinct contact cost, and its load curve with a chart of the curves."""
    places = page.stacked(("contact_solutions", "indentation"))
    place = places["indentation"]
    if place.whole:
        frame = page.contents["indentation"].frame
        chart = charts.indentation(page.sheet, frame, header=place.header)
        charts.sized(chart, _NARROW)
        page.sheet.add_chart(chart, f"{_CURVES_COLUMN}{place.header + 1}")


def rubber(page: Page, analysis: Analysis) -> None:
    """What the rolls ask; provenance, relaxation spectrum and moduli of every compound in use."""
    conveyor, sheet = analysis.conveyor, page.sheet
    row = page.place("rubber", 1, widest=30).last + 3
    sheet.column_dimensions["A"].width = 24
    compounds = {"carry": conveyor.carry_compound, "return": conveyor.return_compound}
    if compounds["return"] is compounds["carry"]:
        compounds.pop("return")
    for strand, compound in compounds.items():
        if strand == "return":
            sheet.row_breaks.append(Break(id=row - 1))
        row = _known(sheet, row, f"{compound.name} ({compound.kind}), {strand} strand", compound)
        moduli = page.place(f"moduli_{strand}", row)
        prony = page.place(f"prony_{strand}", moduli.last + 3)
        chart = charts.moduli(sheet, compound.name, header=moduli.header, last=moduli.last)
        charts.sized(chart, _NARROW)
        sheet.add_chart(chart, f"{_CHART_COLUMN}{moduli.header + 1}")
        row = prony.last + 3
        if len(compounds) == 1:  # one compound on both strands
            define(sheet, "table_moduli_return", moduli.cells)
            define(sheet, "table_prony_return", prony.cells)
    if row <= _PAGE_ROWS * len(compounds):
        sheet.page_setup.fitToHeight = len(compounds)
    sheet.freeze_panes = "B1"


def _known(sheet: Worksheet, row: int, heading: str, compound: RubberCompound) -> int:
    """What is known of a compound; the row its tables begin in."""
    put(sheet.cell(row, 1), heading, HEADING)
    for name, value in facts(compound).items():
        row += 1
        put(sheet.cell(row, 1), name, GREY)
        sheet.cell(row, 1).alignment = Alignment(vertical="top")
        _across(sheet, row, 2, value, columns=10)
    return row + 2


def facts(compound: RubberCompound) -> dict[str, str]:
    """What is known of a compound, in words; what is not stated is said or left out."""
    known, fit = compound.range, compound.fit
    said = {
        "description": compound.description,
        "origin": compound.source.origin,
        "licence": compound.source.licence,
        "data": compound.source.data or "not stated",
        "strain": compound.strain or "not stated",
        "Poisson's ratio": repr(compound.poisson_ratio),
        "reference temperature": text(compound.reference_temperature),
        "equilibrium modulus": text(compound.prony.equilibrium),
        "temperature shift": "none" if compound.shift is None else compound.shift.law,
        "range of frequency": "not stated" if known is None else " to ".join(map(text, known.frequency)),
        "range of temperature": "not stated" if known is None else " to ".join(map(text, known.temperature)),
        "fit": "" if fit is None else fit.method,
        "rms errors of E', E\"": ""
        if fit is None or compound.kind != "measured"
        else f"{text(fit.storage_rms)}, {text(fit.loss_rms)}",
        "not known": "; ".join(compound.missing) or "nothing listed",
    }
    return {name: value for name, value in said.items() if value}


def notes(page: Page, analysis: Analysis) -> None:
    """Checks, warnings, assumptions, the spec's notes, and what made the figures."""
    sheet = page.sheet
    row = page.place("checks", 1, widest=56).last + 3
    written = (analysis.conveyor.notes or "").splitlines()
    pieces = [line[i : i + _PIECE] for line in written for i in range(0, len(line), _PIECE)]
    for heading, lines in (
        ("Warnings", analysis.warnings),
        ("Assumptions", analysis.assumptions),
        ("Notes of the spec", pieces),
    ):
        row = paragraphs(sheet, row, heading, lines)
    page.place("provenance", row, widest=70)


def paragraphs(
    sheet: Worksheet, row: int, heading: str, lines: tuple[str, ...] | list[str], columns: int = 4
) -> int:
    """Write lines of text across columns, under a heading; the row after the next blank one."""
    put(sheet.cell(row, 1), heading, HEADING)
    for line in lines or ("none",):
        row += 1
        _across(sheet, row, 1, line, columns=columns)
    return row + 2


def _across(sheet: Worksheet, row: int, column: int, line: str, *, columns: int) -> None:
    """Write one text across columns, on as many lines as it takes."""
    cell = sheet.cell(row, column)
    put(cell, line)
    cell.alignment = Alignment(wrap_text=True, vertical="top", indent=1)
    last = column + columns - 1
    sheet.merged_cells.add(f"{cell.coordinate}:{get_column_letter(last)}{row}")
    letters = [get_column_letter(j) for j in range(column, last + 1)]
    width = sum(sheet.column_dimensions[x].width if x in sheet.column_dimensions else 8.0 for x in letters)
    sheet.row_dimensions[row].height = 15.0 * -(-len(line) // max(1, int(_FILLED * width)))
