"""Native charts of the workbook, each over cells that are already written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.chart.legend import Legend
from openpyxl.chart.shapes import GraphicalProperties
from openpyxl.chart.text import RichText, Text
from openpyxl.chart.title import Title
from openpyxl.drawing.line import LineProperties
from openpyxl.drawing.text import CharacterProperties, Paragraph, ParagraphProperties, RegularTextRun
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.cells import ACCENT, legible
from conveyor.report.columns import Table
from conveyor.report.places import TablePlace
from conveyor.units import System
from conveyor.units.presentation import headed

_WIDTH, _HEIGHT = 17.0, 9.0  # [cm]
_PALETTE = (ACCENT, "C55A11", "7F7F7F", "2E8B57", "8064A2", "B8860B")
_DASHES = ("solid", "dash", "sysDot", "dashDot")
MOST_CURVES = 12
"""Curves that one chart of load curves shows legibly."""
_GRID = "D9D9D9"
_LINE_WIDTH = 22_000  # width of a series' line [EMU]: 1.7 pt


def _title(words: str, *, size: int) -> Title:
    title = Title(overlay=False)
    look = CharacterProperties(sz=100 * size, b=size > 10, solidFill="404040")
    run = RegularTextRun(t=legible(words), rPr=look)
    title.tx = Text(rich=RichText(p=[Paragraph(pPr=ParagraphProperties(defRPr=look), r=[run])]))
    return title


def _head(sheet: Worksheet, header: int, column: int) -> str:
    """What stands above a column, its unit with it."""
    return str(sheet.cell(header, column).value)


def axis_title(words: str) -> Title:
    """Words beside an axis."""
    return _title(words, size=10)


def _dress(chart: Any, title: str, x: str, y: str) -> None:
    chart.title = _title(title, size=12)
    for axis, words in ((chart.x_axis, x), (chart.y_axis, y)):
        axis.title = axis_title(words) if words else None
        axis.delete = False  # recent Excel hides axes otherwise
    chart.y_axis.majorGridlines.spPr = GraphicalProperties(ln=LineProperties(solidFill=_GRID))
    chart.width, chart.height = _WIDTH, _HEIGHT


def sized(chart: Any, width: float, height: float = _HEIGHT) -> None:
    """Give a chart another size [cm]."""
    chart.width, chart.height = width, height


def bars(sheet: Worksheet, title: str, rows: tuple[int, int], *, label: int, value: int) -> BarChart:
    """Bars of the figures of a table, labels and figures in two of its columns; `rows` are header and last."""
    header, last = rows
    chart = BarChart()
    chart.type = "bar"
    _dress(chart, title, "", _head(sheet, header, value))
    chart.add_data(Reference(sheet, min_col=value, min_row=header, max_row=last), titles_from_data=True)
    chart.set_categories(Reference(sheet, min_col=label, min_row=header + 1, max_row=last))
    chart.series[0].graphicalProperties.solidFill = ACCENT
    chart.series[0].invertIfNegative = False
    chart.legend = None
    chart.gapWidth = 60
    chart.x_axis.scaling.orientation = "maxMin"
    chart.x_axis.tickLblPos = "low"  # beside negative bars too
    chart.y_axis.crosses = "max"  # at the bottom, as the categories run downward
    chart.y_axis.number_format = "#,##0"
    return chart


def power_over_temperature(sheet: Worksheet, place: TablePlace, shown: Table, system: System) -> ScatterChart:
    """Motor power of compounds (all columns but the first) over temperature; the speed is the table's note.

    The power axis begins below the least, at a round figure: differences between compounds are what is looked for.
    """
    chart = _curves(
        sheet,
        place,
        "temperature",
        place.keys[1:],
        title=f"Motor power at {shown.note}",
        words=(f"belt {_head(sheet, place.header, 1)}", headed("motor power", "power", system)),
    )
    chart.x_axis.number_format, chart.y_axis.number_format = "0", "#,##0"
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.crosses = "min"
    cells = (value for column in shown.columns[1:] for value in shown.cells(column, system))
    least = min(value for value in cells if value is not None)
    if least > 0.0:
        step = 10.0 ** math.floor(math.log10(least))
        chart.y_axis.scaling.min = step * math.floor(0.95 * least / step * 10.0) / 10.0
    return chart


def tension(sheet: Worksheet, place: TablePlace) -> ScatterChart:
    """Tension and least tension for sag against the way round the loop."""
    chart = _curves(
        sheet, place, "distance_from_drive", ("tension", "least_for_sag"), title="Tension round the loop"
    )
    chart.x_axis.number_format = chart.y_axis.number_format = "#,##0"
    chart.x_axis.scaling.min = 0.0
    return chart


def profile(sheet: Worksheet, place: TablePlace, system: System) -> ScatterChart:
    """Height over the horizontal distance from the tail."""
    words = tuple(headed(name, "length", system) for name in ("horizontal distance from the tail", "height"))
    chart = _curves(sheet, place, "horizontal", ("height",), title="Profile of the route", words=words)
    chart.legend = None
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "#,##0"
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.crosses = "min"
    return chart


def indentation(sheet: Worksheet, shown: Table, place: TablePlace) -> ScatterChart:
    """Indentation against line load, a curve for each of the first blocks of rows with one label."""
    across, up = place.column("line_load"), place.column("indentation")
    chart = _scatter(
        "Indentation against line load", _head(sheet, place.header, across), _head(sheet, place.header, up)
    )
    ends = [
        i
        for i, row in enumerate(shown.rows)
        if shown.rows[i + 1 : i + 2] == () or _ends(row, shown.rows[i + 1])
    ]
    first = place.header + 1
    for end in ends[:MOST_CURVES]:
        last = place.header + 1 + end
        loads = Reference(sheet, min_col=across, min_row=first, max_row=last)
        label = legible(shown.rows[end][0])
        _line(chart, Reference(sheet, min_col=up, min_row=first, max_row=last), loads, label)
        first = last + 1
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "General"
    chart.x_axis.scaling.min = chart.y_axis.scaling.min = 0.0
    return chart


def _ends(row: Any, following: Any) -> bool:
    """Whether a block of a table of curves ends with a row: another label follows, or a smaller load."""
    return bool(row[0] != following[0] or row[1] > following[1])


def moduli(sheet: Worksheet, name: str, place: TablePlace, system: System) -> ScatterChart:
    """E' and E'' against frequency, both axes logarithmic."""
    words = headed("frequency", "frequency", system), headed("modulus", "pressure", system)
    chart = _curves(sheet, place, "frequency", ("storage", "loss"), title=f"Moduli of {name}", words=words)
    chart.x_axis.scaling.logBase = chart.y_axis.scaling.logBase = 10
    chart.x_axis.number_format, chart.y_axis.number_format = "0E+0", "General"
    chart.x_axis.tickLblPos = chart.y_axis.tickLblPos = "low"
    chart.x_axis.crosses = chart.y_axis.crosses = "min"
    return chart


def _curves(
    sheet: Worksheet,
    place: TablePlace,
    across: str,
    up: Sequence[str],
    *,
    title: str,
    words: tuple[str, ...] = (),
) -> ScatterChart:
    """Columns of a table over another one; axes are named as the columns unless otherwise said."""
    x, y = place.column(across), [place.column(key) for key in up]
    named = words or (_head(sheet, place.header, x), _head(sheet, place.header, y[0]))
    chart = _scatter(title, *named)
    at = Reference(sheet, min_col=x, min_row=place.header + 1, max_row=place.last)
    for column in y:
        _line(chart, Reference(sheet, min_col=column, min_row=place.header, max_row=place.last), at)
    return chart


def _scatter(title: str, x: str, y: str) -> ScatterChart:
    chart = ScatterChart()
    chart.style, chart.scatterStyle = 2, "lineMarker"
    _dress(chart, title, x, y)
    chart.x_axis.majorGridlines = None
    chart.legend = Legend(legendPos="b")
    return chart


def _line(chart: ScatterChart, values: Reference, at: Reference, title: str | None = None) -> None:
    series = Series(values, at, title=title, title_from_data=title is None)
    k = len(chart.series)
    series.marker.symbol = "none"
    series.smooth = False
    line = series.graphicalProperties.line
    line.solidFill = _PALETTE[k % len(_PALETTE)]
    line.dashStyle = _DASHES[k % len(_DASHES)]  # equal curves stay visible under each other
    line.width = _LINE_WIDTH
    chart.series.append(series)
