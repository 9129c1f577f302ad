"""The sheets of the workbook, one function each."""

from __future__ import annotations

import math
import platform
from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING

import pandas as pd
from openpyxl.styles import Alignment
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.pagebreak import Break
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report import charts, tables
from conveyor.report import inputs as fields
from conveyor.report.cells import (
    BOLD,
    FIGURE,
    GREY,
    HEADING,
    LINK,
    PALE,
    TITLE,
    number_format,
    put,
    table,
    total,
)
from conveyor.spec import fingerprint
from conveyor.units import si, text

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.models import RubberCompound

_VERSIONED = ("conveyor", "numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl")
_KEY_FIGURES = (
    "motor power [kW]", "belt power [kW]", "effective tension [N]", "equivalent DIN f [-]",
    "indentation share of main resistance [-]", "energy [kWh/(t km)]",
)  # fmt: skip
_CHART_ROWS = 19
_LINE = 140  # characters of a note in one line of nine columns
_PIECE = 1000  # characters of a note in one cell


def _headed(sheet: Worksheet, heading: str, frame: pd.DataFrame, *, widest: int = 60) -> int:
    """Write a sheet's main table; its header stays in view and is printed on each page."""
    put(sheet["A1"], heading, HEADING)
    sheet.freeze_panes = "A3"
    sheet.print_title_rows = "1:2"
    return table(sheet, frame, 2, widest=widest)


def summary(sheet: Worksheet, analysis: Analysis) -> None:
    """One page: what it is, the key figures, all figures, breakdown, classical estimate, a chart."""
    conveyor, found = analysis.conveyor, analysis.balance
    put(sheet["A1"], conveyor.name, TITLE)
    stamp = f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec {fingerprint(conveyor)[:16]}"
    put(sheet["A2"], stamp, GREY)
    put(sheet["A3"], f"{len(analysis.warnings)} warnings: see Checks and notes", LINK)
    sheet["A3"].hyperlink = Hyperlink(ref="A3", location="'Checks and notes'!A1")
    sheet["A3"].font = LINK
    widths = {"A": 41, "B": 18, "C": 3, "D": 26, "E": 20, "F": 20, "G": 20}
    for letter, width in widths.items():
        sheet.column_dimensions[letter].width = width
    _tiles(sheet, analysis.summary)
    put(sheet["A8"], "Results", HEADING)
    for row, (name, value) in enumerate(analysis.summary.items(), start=9):
        font = BOLD if name in _KEY_FIGURES else None
        put(sheet.cell(row, 1), str(name), font)
        put(sheet.cell(row, 2), float(value), font, number_format(str(name)))
    put(sheet["D8"], "Resistance breakdown", HEADING)
    last = table(sheet, _breakdown(analysis), 9, 4)
    put(sheet.cell(last + 2, 4), "Beside the classical estimate (ISO 5048 / DIN 22101, given f)", HEADING)
    comparison = tables.comparison(found).rename_axis("quantity").reset_index()
    bottom = table(sheet, comparison, last + 3, 4, by_row="quantity")
    put(sheet.cell(bottom + 1, 4), _remark(analysis), GREY)
    chart = charts.breakdown(sheet, header=9, last=last, label=4, value=5)
    sheet.add_chart(chart, f"D{bottom + 3}")


def _tiles(sheet: Worksheet, figures: pd.Series) -> None:
    """Key figures, large, each under its name."""
    given = [name for name in _KEY_FIGURES if name in figures.index]
    for letter in "ABCDEFG":
        sheet[f"{letter}5"].fill = sheet[f"{letter}6"].fill = PALE
    for letter, name in zip("ABDEFG", given, strict=False):
        caption, figure = sheet[f"{letter}5"], sheet[f"{letter}6"]
        put(caption, name.replace(" of main resistance", ""), GREY)
        put(figure, float(figures[name]), FIGURE, number_format(name))
        caption.alignment = figure.alignment = Alignment(horizontal="left", vertical="center", indent=1)
    sheet.row_dimensions[5].height, sheet.row_dimensions[6].height = 18.0, 26.0


def _breakdown(analysis: Analysis) -> pd.DataFrame:
    forces = analysis.balance.forces
    names = ("indentation", "idler_rotation", "flexure", "secondary", "special", "lift")
    values = [getattr(forces, name) for name in names]
    share = [value / forces.total for value in values] if forces.total else [None] * len(values)
    labels = [name.replace("_", " ") for name in names]
    return pd.DataFrame({"resistance": labels, "force [N]": values, "share of total [-]": share})


def _remark(analysis: Analysis) -> str:
    found = analysis.balance
    return f"classical secondary: {found.classical.secondary_by}; governing at the drive: {found.tensions.governed_by}"


def inputs(sheet: Worksheet, analysis: Analysis) -> None:
    """Every field: as entered, in SI, and whether the spec or a default gave it."""
    _headed(sheet, "Inputs as entered and in SI", fields.inputs(analysis.conveyor))


def sections(sheet: Worksheet, analysis: Analysis) -> None:
    """Forces of every section and strand, and their sums."""
    frame = analysis.sections
    last = _headed(sheet, "Forces of every section and strand", frame, widest=30)
    summed = [j for j, name in enumerate(frame.columns, start=1) if str(name).endswith("[N]")]
    sums = {j: math.fsum(frame.iloc[:, j - 1].tolist()) for j in summed}
    total(sheet, last + 1, len(frame.columns), {1: "all sections", **sums})


def resistances(sheet: Worksheet, analysis: Analysis) -> None:
    """Every force and its law, adding up to the effective tension; the classical estimate."""
    frame = analysis.resistances
    last = _headed(sheet, "Every force and the law it comes from", frame)
    total(sheet, last + 1, len(frame.columns), {1: "effective tension", 3: analysis.balance.forces.total})
    comparison = tables.comparison(analysis.balance).rename_axis("quantity").reset_index()
    row = last + 4
    put(sheet.cell(row, 1), "Beside the classical estimate (ISO 5048 / DIN 22101, given f)", HEADING)
    end = table(sheet, comparison, row + 1, by_row="quantity")
    put(sheet.cell(end + 1, 1), _remark(analysis), GREY)


def rolls(sheet: Worksheet, analysis: Analysis) -> None:
    """One row a roll of every set."""
    _headed(sheet, "Rolls of a set, contact at the highest line load", analysis.rolls, widest=30)


def tensions(sheet: Worksheet, analysis: Analysis) -> None:
    """Tension at every place of the loop, with its chart."""
    frame = tables.tensions(analysis.balance)
    last = _headed(sheet, "Tension round the loop, steady running, from the drive", frame)
    sheet.column_dimensions["E"].width = 3
    sheet.add_chart(charts.tension(sheet, header=2, last=last), "F4")


def indentation(sheet: Worksheet, analysis: Analysis) -> None:
    """Load curve of every distinct contact, with its chart."""
    frame = tables.indentation_curves(analysis.stretches)
    _headed(sheet, "Indentation against line load, one block a contact", frame)
    sheet.column_dimensions["G"].width = 3
    sheet.add_chart(charts.indentation(sheet, frame, header=2), "H4")


def rubber(sheet: Worksheet, analysis: Analysis) -> None:
    """Provenance, Prony series and moduli of every compound in use, at the belt's temperature."""
    conveyor = analysis.conveyor
    temperature, at = si(conveyor.ambient.belt), text(conveyor.ambient.belt)
    compounds = {c.name: c for c in (conveyor.carry_compound, conveyor.return_compound)}
    put(sheet["A1"], "What the rolls ask of the rubber", HEADING)
    asked = analysis.rubber.astype(object).set_index("strand").T.rename_axis("quantity").reset_index()
    row = table(sheet, asked, 2, by_row="quantity") + 3
    first = row
    for compound in compounds.values():
        if row > first:
            sheet.row_breaks.append(Break(id=row - 1))
        put(sheet.cell(row, 1), f"{compound.name} ({compound.kind}) at {at}", HEADING)
        for name, value in _facts(compound).items():
            row += 1
            put(sheet.cell(row, 1), name, GREY)
            put(sheet.cell(row, 2), value)
        top = row + 2
        end = table(sheet, tables.prony(compound, temperature), top, 1)
        bottom = table(sheet, tables.moduli(compound, temperature), top, 5)
        sheet.add_chart(charts.moduli(sheet, compound.name, header=top, last=bottom), f"J{top}")
        row = max(end, bottom, top + _CHART_ROWS) + 3
    for letter, width in {"A": 22, "B": 18, "C": 18, "D": 3, "E": 14, "I": 3}.items():
        sheet.column_dimensions[letter].width = width
    sheet.page_setup.fitToHeight = len(compounds)


def _facts(compound: RubberCompound) -> dict[str, str]:
    known, fit = compound.range, compound.fit
    facts = {
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
    return {name: value for name, value in facts.items() if value}


def notes(sheet: Worksheet, analysis: Analysis) -> None:
    """Warnings, assumptions, the spec's notes, what the contacts cost, and what made the figures."""
    row = 1
    written = (analysis.conveyor.notes or "").splitlines()
    pieces = [line[i : i + _PIECE] for line in written for i in range(0, len(line), _PIECE)]
    for heading, lines in (
        ("Warnings", analysis.warnings), ("Assumptions", analysis.assumptions), ("Notes of the spec", pieces),
    ):  # fmt: skip
        put(sheet.cell(row, 1), heading, HEADING)
        for line in lines or ("none",):
            row += 1
            sheet.merge_cells(start_row=row, start_column=1, end_row=row, end_column=9)
            put(sheet.cell(row, 1), line)
            sheet.cell(row, 1).alignment = Alignment(wrap_text=True, vertical="top", indent=1)
            sheet.row_dimensions[row].height = 15.0 * -(-len(line) // _LINE)
        row += 2
    put(sheet.cell(row, 1), "Contact solutions, one a distinct roll, cover and spacing", HEADING)
    row = table(sheet, tables.solver(analysis.stretches), row + 1) + 2
    put(sheet.cell(row, 1), "Provenance", HEADING)
    facts: dict[str, object] = {
        "spec SHA-256": fingerprint(analysis.conveyor),
        "date": date.today(),
        "python": platform.python_version(),
        **{name: version(name) for name in _VERSIONED},
    }
    for name, value in facts.items():
        row += 1
        put(sheet.cell(row, 1), name)
        put(sheet.cell(row, 2), value)
        sheet.cell(row, 1).alignment = sheet.cell(row, 2).alignment = Alignment(horizontal="left", indent=1)
    sheet.column_dimensions["A"].width, sheet.column_dimensions["B"].width = 26, 13
