"""The workbook's cover: one printed page of what a conveyor is, what it needs, and what it was checked for."""

from __future__ import annotations

from collections import Counter
from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING, Final

from openpyxl.styles import Alignment, Border, Side
from openpyxl.worksheet.hyperlink import Hyperlink
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.figures import belt_strength
from conveyor.report import charts
from conveyor.report.cells import (
    ACCENT,
    BOLD,
    FIGURE,
    GREY,
    HEADING,
    LINK,
    PALE,
    TITLE,
    VERDICTS,
    Look,
    header_row,
    put,
    table,
)
from conveyor.report.contents import CHECKS_AND_NOTES
from conveyor.report.formats import number_format
from conveyor.report.places import Page
from conveyor.spec import fingerprint
from conveyor.units import Quantity, convert, display, si, unit_label

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.models import Conveyor
    from conveyor.models.report import Report

_COLUMNS: Final = "ABCDEFG"
_WIDTHS: Final = {"A": 31, "B": 15, "C": 2, "D": 35, "E": 17, "F": 19, "G": 17}
_KEY_FIGURES: Final = (
    "motor_power", "belt_power", "effective_tension", "equivalent_f", "indentation_share", "specific_energy",
)  # fmt: skip
_TENSION_AND_POWER: Final = (
    "motor_power", "belt_power", "mains_power", "effective_tension", "tight_side_tension", "slack_side_tension",
    "tight_side_tension_at_start", "smallest_tension", "belt_safety_at_start", "take_up_setting", "equivalent_f",
    "specific_energy", "energy_per_year", "cost_per_year", "classical_motor_power", "contact_error_estimate",
)  # fmt: skip
_MOST_CHECKS: Final = 22
"""Checks that the page takes beside the rest; those that passed give way first."""
_CHART_ROWS: Final = 14
_HALF, _WHOLE_WIDTH, _CHART_HEIGHT = 9.2, 26.0, 7.2  # [cm]
_SMALL, _LARGE = 10.0, 1e4  # below, one decimal is too few; beyond, a figure in large type needs none
_RULE: Final = Border(bottom=Side(style="thin", color=ACCENT))
_HAIR: Final = Border(bottom=Side(style="hair", color="A6A6A6"))
_ROW: Final = 15.0  # [pt]
_GAP: Final = 7.0  # [pt]


def summary(page: Page, analysis: Analysis) -> None:
    """Head, what the conveyor is, key figures, tensions and power, breakdown, governing cases, checks."""
    sheet = page.sheet
    for letter, width in _WIDTHS.items():
        sheet.column_dimensions[letter].width = width
    row = _head(sheet, analysis)
    row = _facts(sheet, analysis.conveyor, row)
    row = _tiles(page, row)
    row = _figures(page, analysis, row)
    row = _picture(page, row)
    _checked(page, analysis, row)
    sheet.page_setup.fitToHeight = 1
    sheet.print_options.horizontalCentered = True


def _rule(sheet: Worksheet, row: int, words: str, column: int = 1, last: int = 7) -> None:
    """Heading over a line across columns."""
    put(sheet.cell(row, column), words, HEADING)
    for j in range(column, last + 1):
        sheet.cell(row, j).border = _RULE


def _gap(sheet: Worksheet, row: int) -> int:
    sheet.row_dimensions[row].height = _GAP
    return row + 1


def _head(sheet: Worksheet, analysis: Analysis) -> int:
    conveyor, report = analysis.conveyor, analysis.conveyor.report
    put(sheet["A1"], conveyor.name, TITLE)
    sheet.row_dimensions[1].height = 24.0
    stamp = f"Power and tensions of a belt conveyor; conveyor {version('conveyor')}, spec {fingerprint(conveyor)[:16]}"
    put(sheet["A2"], stamp, GREY)
    row = 3
    for k, (name, value) in enumerate([*_said(report).items(), ("date", date.today())]):
        row, column = 3 + k // 2, 1 + 3 * (k % 2)
        put(sheet.cell(row, column), name, GREY)
        put(sheet.cell(row, column + 1), value)
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left")
    return _gap(sheet, row + 1)


def _said(report: Report) -> dict[str, str]:
    names = ("project", "client", "number", "revision", "engineer")
    return {name: value for name in names if (value := getattr(report, name)) is not None}


def documented(report: Report) -> str:
    """What the spec says of the document, in one line; nothing where it says nothing.

    Examples
    --------
    >>> from conveyor.models.report import Report
    >>> documented(Report(project="Mine", revision="B"))
    'project: Mine, revision: B; '
    """
    said = ", ".join(f"{name}: {value}" for name, value in _said(report).items())
    return f"{said}; " if said else ""


def _facts(sheet: Worksheet, conveyor: Conveyor, row: int) -> int:
    """What the conveyor is: figures on the left, words on the right."""
    belt, system = conveyor.belt, conveyor.report.units
    _rule(sheet, row, "The conveyor")
    figures = (
        ("length", "length", conveyor.route.length),
        ("lift", "length", conveyor.route.rise),
        ("belt width", "thickness", si(belt.width)),
        ("belt speed", "speed", si(belt.speed)),
        ("mass flow", "mass flow", si(conveyor.material.flow)),
        ("temperature of the covers", "temperature", si(conveyor.ambient.belt)),
    )
    for i, (name, kind, value) in enumerate(figures, start=row + 1):
        label = f"{name} [{unit_label(kind, system)}]"
        shown = "0.###" if label.endswith("[m/s]") else "#,##0.##"
        _line(sheet, (i, 1), label, round(convert(value, kind, system), 9), shown)
    for i, (name, words) in enumerate(_words(conveyor), start=row + 1):
        _line(sheet, (i, 4), name, words)
    return _gap(sheet, row + 1 + len(figures))


def _words(conveyor: Conveyor) -> tuple[tuple[str, str], ...]:
    belt, material, system = conveyor.belt, conveyor.material, conveyor.report.units

    def shown(value: Quantity, kind: str) -> str:
        return display(si(value), kind, system).replace("^3", "³")

    carcass, top, bottom = belt.carcass, belt.top_cover, belt.bottom_cover
    strength = "" if carcass.strength is None else f", {belt_strength(si(carcass.strength), system)}"
    sets = [
        f"{idlers.rolls} x {shown(idlers.roll.diameter, 'thickness')}, every {shown(idlers.spacing, 'length')}"
        for idlers in (conveyor.idlers.carry, conveyor.idlers.return_)
    ]
    top_rubber = "rubber of the bottom cover" if top.compound is None else top.compound.name
    return (
        ("belt", f"{carcass.kind}{strength}"),
        ("top cover", f"{shown(top.thickness, 'thickness')}, {top_rubber}"),
        ("bottom cover", f"{shown(bottom.thickness, 'thickness')}, {bottom.compound.name}"),
        ("carry idlers", sets[0]),
        ("return idlers", sets[1]),
        ("material", f"{material.name}, {shown(material.density, 'density')}"),
    )


def _line(
    sheet: Worksheet, place: tuple[int, int], label: str, value: float | str, shown: str | None = None
) -> None:
    """One fact: its name and its value, over a thin line."""
    row, column = place
    put(sheet.cell(row, column), label)
    put(sheet.cell(row, column + 1), value, None, shown)
    if isinstance(value, str):
        sheet.cell(row, column + 1).alignment = Alignment(horizontal="left", shrink_to_fit=False)
    for j in range(column, 3 if column == 1 else 8):
        sheet.cell(row, j).border = _HAIR


def _tiles(page: Page, row: int) -> int:
    """Key figures, large, each under its name."""
    sheet, names = page.sheet, _by_name(page)
    given = [names[name] for name in _KEY_FIGURES if name in names]
    for letter in _COLUMNS:
        sheet[f"{letter}{row}"].fill = sheet[f"{letter}{row + 1}"].fill = PALE
    for letter, (name, value) in zip("ABDEFG", given, strict=False):
        caption, figure = sheet[f"{letter}{row}"], sheet[f"{letter}{row + 1}"]
        put(caption, name.replace(" of main resistance", ""), GREY)
        put(figure, value, FIGURE, _format(name, value, large="#,##0"))
        caption.alignment = Alignment(horizontal="left", vertical="center", indent=1, wrap_text=True)
        figure.alignment = Alignment(horizontal="left", vertical="center", indent=1)
    sheet.row_dimensions[row].height, sheet.row_dimensions[row + 1].height = 31.0, 26.0
    return _gap(sheet, row + 2)


def _format(name: str, value: float, *, large: str = "#,##0.0") -> str:
    """Number format of a figure by its unit; small figures with more digits, large ones with as many as asked for."""
    shown = number_format(name)
    if shown != "#,##0.0":
        return shown
    return large if abs(value) >= _LARGE else "0.000" if abs(value) < _SMALL else shown


def _by_name(page: Page) -> dict[str, tuple[str, float]]:
    """Figures by the name others link to: words with unit, value."""
    found = {}
    for key in ("results", "take_up"):
        part = page.contents[key]
        figures = part.frame[part.by_row].tolist(), part.frame["value"].tolist()
        said = "take-up " if key == "take_up" else ""
        for name, i in part.figures().items():
            found[name] = (f"{said}{figures[0][i]}", float(figures[1][i]))
    return found


def _figures(page: Page, analysis: Analysis, row: int) -> int:
    """Tensions and power on the left; breakdown and the classical estimate on the right."""
    sheet, names = page.sheet, _by_name(page)
    _rule(sheet, row, "Tensions and power", 1, 2)
    i = row
    for name in _TENSION_AND_POWER:
        if name in names:
            i += 1
            label, value = names[name]
            _line(sheet, (i, 1), label.replace(" of the contacts", ""), value, _format(label, value))
            if name == "motor_power":
                sheet.cell(i, 1).font = sheet.cell(i, 2).font = BOLD
    _rule(sheet, row, "Resistances", 4)
    last = table(sheet, page.contents["breakdown"].frame, row + 1, 4)
    sheet.row_dimensions[row + 1].height = _ROW
    part = page.contents["classical"]
    put(sheet.cell(last + 1, 4), "Beside the classical estimate", BOLD)
    head = last + 2
    last = table(sheet, part.frame, head, 4, by_row="quantity")
    sheet.row_dimensions[head].height = _ROW
    governed = f"{part.note}; governing at the drive: {analysis.balance.tensions.governed_by}"
    put(sheet.cell(last + 1, 4), governed, GREY)
    return _gap(sheet, max(i, last + 1) + 1)


def _picture(page: Page, row: int) -> int:
    """The breakdown as a chart; beside it the cases that govern, where there are any."""
    sheet, cases = page.sheet, page.contents.by_key.get("governing_cases")
    place = page.contents["breakdown"]
    first = next(i for i in range(1, row) if sheet.cell(i, 4).value == place.frame.columns[0])
    rows = first, first + len(place.frame)
    chart = charts.bars(sheet, "Resistance breakdown", rows, label=4, value=5)
    charts.sized(chart, _WHOLE_WIDTH if cases is None else _HALF, _CHART_HEIGHT)
    sheet.add_chart(chart, f"A{row}")
    end = row + _CHART_ROWS
    if cases is not None:
        _rule(sheet, row, "Governing load cases", 4)
        header_row(sheet, row + 1, 4, ("figure", "value", "case", "at"))
        sheet.cell(row + 1, 5).alignment = Alignment(horizontal="right", vertical="center")
        at = next(name for name in cases.frame.columns if str(name).startswith("temperature"))
        unit = str(at).rpartition("deg")[2].rstrip("]")
        for i, found in enumerate(cases.frame.to_dict("records"), start=row + 2):
            label = str(found["figure"])
            put(sheet.cell(i, 4), label)
            sheet.cell(i, 4).alignment = Alignment(indent=1, shrink_to_fit=True)
            put(sheet.cell(i, 5), float(found["value"]), None, number_format(label))
            put(sheet.cell(i, 6), str(found["case"]))
            put(sheet.cell(i, 7), f"{found[at]:g} °{unit}")
            for j in (6, 7):  # indents hold only where the side is named
                sheet.cell(i, j).alignment = Alignment(horizontal="left", indent=1, shrink_to_fit=True)
            for j in range(4, 8):
                sheet.cell(i, j).border = _HAIR
        end = max(end, row + 2 + len(cases.frame))
    return _gap(sheet, end)


def _checked(page: Page, analysis: Analysis, row: int) -> None:
    """The checks, what failed first where not all of them fit; the way to the warnings."""
    sheet, part = page.sheet, page.contents["checks"]
    records = part.frame.to_dict("records")
    count = Counter(str(record["verdict"]) for record in records)
    counted = ", ".join(f"{count[word]} {word}" for word in ("pass", "FAIL", "not checked") if count[word])
    _rule(sheet, row, f"Checks: {counted}")
    header_row(sheet, row + 1, 1, ("check", "", "", "found", "asked for", "", "verdict"))
    shown = records
    if len(records) > _MOST_CHECKS:
        passed = [record for record in records if record["verdict"] == "pass"]
        left_out = passed[max(0, len(passed) - (len(records) - _MOST_CHECKS)) :]
        shown = [record for record in records if record not in left_out]
    i = row + 1
    for record in shown:
        i += 1
        for column, name in ((1, "check"), (4, "found"), (5, "asked for"), (7, "verdict")):
            put(sheet.cell(i, column), str(record[name]))
        _coloured(sheet, i, VERDICTS[str(record["verdict"])])
    if len(shown) < len(records):
        i += 1
        put(
            sheet.cell(i, 1),
            f"and {len(records) - len(shown)} more that passed: see {CHECKS_AND_NOTES}",
            GREY,
        )
    words = (
        f"{len(analysis.warnings)} warnings, {len(analysis.assumptions)} assumptions: see {CHECKS_AND_NOTES}"
    )
    link = sheet.cell(i + 1, 1)
    put(link, words)
    link.hyperlink = Hyperlink(ref=link.coordinate, location=f"'{CHECKS_AND_NOTES}'!A1")
    link.font = LINK


def _coloured(sheet: Worksheet, row: int, look: Look) -> None:
    verdict = sheet.cell(row, 7)
    verdict.font, verdict.fill = look.font, look.fill
    verdict.alignment = Alignment(horizontal="center")
    for j in range(1, 8):
        sheet.cell(row, j).border = _HAIR
