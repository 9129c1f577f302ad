"""Native charts of the workbook, each over cells that are already written."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd
from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.chart.legend import Legend
from openpyxl.chart.shapes import GraphicalProperties
from openpyxl.chart.text import RichText, Text
from openpyxl.chart.title import Title
from openpyxl.drawing.line import LineProperties
from openpyxl.drawing.text import CharacterProperties, Paragraph, ParagraphProperties, RegularTextRun
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.cells import ACCENT, legible
from conveyor.report.tables import CURVE_POINTS

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


def _unit(sheet: Worksheet, header: int, column: int) -> str:
    """Unit in the header of a column, in its brackets."""
    return _head(sheet, header, column).rpartition(" ")[2]


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


def power_over_temperature(
    sheet: Worksheet, rows: tuple[int, int], *, count: int, speed: str, least: float
) -> ScatterChart:
    """Motor power of `count` compounds (columns 2 …) over temperature (column 1); `rows` are header and last.

    The power axis begins below `least`, at a round figure: differences between compounds are what is looked for.
    """
    header, last = rows
    power = f"motor power {_unit(sheet, header, 2)}"
    chart = _scatter(f"Motor power at {speed}", f"belt {_head(sheet, header, 1)}", power)
    at = Reference(sheet, min_col=1, min_row=header + 1, max_row=last)
    for column in range(2, 2 + count):
        _line(chart, Reference(sheet, min_col=column, min_row=header, max_row=last), at)
    chart.x_axis.number_format, chart.y_axis.number_format = "0", "#,##0"
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.crosses = "min"
    if least > 0.0:
        step = 10.0 ** math.floor(math.log10(least))
        chart.y_axis.scaling.min = step * math.floor(0.95 * least / step * 10.0) / 10.0
    return chart


def tension(sheet: Worksheet, *, header: int, last: int) -> ScatterChart:
    """Tension and least tension for sag against the way round the loop (columns 2, 3, 4)."""
    chart = _scatter("Tension round the loop", _head(sheet, header, 2), _head(sheet, header, 3))
    way = Reference(sheet, min_col=2, min_row=header + 1, max_row=last)
    for column in (3, 4):
        _line(chart, Reference(sheet, min_col=column, min_row=header, max_row=last), way)
    chart.x_axis.number_format = chart.y_axis.number_format = "#,##0"
    chart.x_axis.scaling.min = 0.0
    return chart


def profile(sheet: Worksheet, *, header: int, last: int) -> ScatterChart:
    """Height over the horizontal distance from the tail (columns 3, 4)."""
    across_words = f"horizontal distance from the tail {_unit(sheet, header, 3)}"
    chart = _scatter("Profile of the route", across_words, _head(sheet, header, 4))
    across = Reference(sheet, min_col=3, min_row=header + 1, max_row=last)
    _line(chart, Reference(sheet, min_col=4, min_row=header, max_row=last), across)
    chart.legend = None
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "#,##0"
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.crosses = "min"
    return chart


def indentation(sheet: Worksheet, frame: pd.DataFrame, *, header: int) -> ScatterChart:
    """Indentation against line load, a curve for each of the first blocks of rows (columns 2, 3)."""
    chart = _scatter("Indentation against line load", _head(sheet, header, 2), _head(sheet, header, 3))
    for start in range(0, min(len(frame), MOST_CURVES * CURVE_POINTS), CURVE_POINTS):
        first, last = header + 1 + start, header + start + CURVE_POINTS
        loads = Reference(sheet, min_col=2, min_row=first, max_row=last)
        label = legible(str(frame["contact"].iloc[start]))
        _line(chart, Reference(sheet, min_col=3, min_row=first, max_row=last), loads, label)
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "General"
    chart.x_axis.scaling.min = chart.y_axis.scaling.min = 0.0
    return chart


def moduli(sheet: Worksheet, name: str, *, header: int, last: int) -> ScatterChart:
    """E' and E'' against frequency, both axes logarithmic (columns 1, 2, 3)."""
    modulus = f"modulus {_unit(sheet, header, 2)}"
    chart = _scatter(f"Moduli of {name}", _head(sheet, header, 1), modulus)
    frequency = Reference(sheet, min_col=1, min_row=header + 1, max_row=last)
    for column in (2, 3):
        _line(chart, Reference(sheet, min_col=column, min_row=header, max_row=last), frequency)
    chart.x_axis.scaling.logBase = chart.y_axis.scaling.logBase = 10
    chart.x_axis.number_format, chart.y_axis.number_format = "0E+0", "General"
    chart.x_axis.tickLblPos = chart.y_axis.tickLblPos = "low"
    chart.x_axis.crosses = chart.y_axis.crosses = "min"
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
