"""Native charts of the workbook, each over cells that are already written."""

from __future__ import annotations

from typing import Any

import pandas as pd
from openpyxl.chart import BarChart, Reference, ScatterChart, Series
from openpyxl.chart.legend import Legend
from openpyxl.worksheet.worksheet import Worksheet

_WIDTH, _HEIGHT = 17.0, 9.0  # [cm]


def _axes(chart: Any, title: str, x: str, y: str) -> None:
    chart.title, chart.x_axis.title, chart.y_axis.title = title, x, y
    chart.x_axis.delete = chart.y_axis.delete = False  # recent Excel hides axes otherwise
    chart.width, chart.height = _WIDTH, _HEIGHT


def breakdown(sheet: Worksheet, *, header: int, last: int, label: int, value: int) -> BarChart:
    """Bars of the resistances of a table with labels and forces in two columns."""
    chart = BarChart()
    chart.type = "bar"
    _axes(chart, "Resistance breakdown", "", "force [N]")
    chart.add_data(Reference(sheet, min_col=value, min_row=header, max_row=last), titles_from_data=True)
    chart.set_categories(Reference(sheet, min_col=label, min_row=header + 1, max_row=last))
    chart.legend = None
    chart.gapWidth = 60
    chart.x_axis.scaling.orientation = "maxMin"
    chart.x_axis.tickLblPos = "low"  # beside negative bars too
    chart.y_axis.number_format = "#,##0"
    return chart


def tension(sheet: Worksheet, *, header: int, last: int) -> ScatterChart:
    """Tension and least tension for sag against the way round the loop (columns 2, 3, 4)."""
    chart = _scatter("Tension round the loop", "distance from the drive [m]", "tension [N]")
    way = Reference(sheet, min_col=2, min_row=header + 1, max_row=last)
    for column in (3, 4):
        _line(chart, Reference(sheet, min_col=column, min_row=header, max_row=last), way)
    chart.x_axis.number_format = chart.y_axis.number_format = "#,##0"
    return chart


def indentation(sheet: Worksheet, frame: pd.DataFrame, *, header: int) -> ScatterChart:
    """Indentation against line load, a curve for each block of equal first column (columns 2, 3)."""
    chart = _scatter("Indentation against line load", "line load [N/m]", "indentation resistance [N/m]")
    row = header + 1
    for label, block in frame.groupby("contact", sort=False):
        end = row + len(block) - 1
        loads = Reference(sheet, min_col=2, min_row=row, max_row=end)
        _line(chart, Reference(sheet, min_col=3, min_row=row, max_row=end), loads, str(label))
        row = end + 1
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "0.0"
    return chart


def moduli(sheet: Worksheet, name: str, *, header: int, last: int) -> ScatterChart:
    """E' and E'' against frequency, both axes logarithmic (columns 5, 6, 7)."""
    chart = _scatter(f"Moduli of {name}", "frequency [Hz]", "modulus [MPa]")
    frequency = Reference(sheet, min_col=5, min_row=header + 1, max_row=last)
    for column in (6, 7):
        _line(chart, Reference(sheet, min_col=column, min_row=header, max_row=last), frequency)
    chart.x_axis.scaling.logBase = chart.y_axis.scaling.logBase = 10
    chart.x_axis.number_format = chart.y_axis.number_format = "0E+0"
    chart.x_axis.tickLblPos = chart.y_axis.tickLblPos = "low"
    chart.x_axis.crosses = chart.y_axis.crosses = "min"
    return chart


def _scatter(title: str, x: str, y: str) -> ScatterChart:
    chart = ScatterChart()
    chart.style, chart.scatterStyle = 2, "lineMarker"
    _axes(chart, title, x, y)
    chart.legend = Legend(legendPos="b")
    return chart


def _line(chart: ScatterChart, values: Reference, at: Reference, title: str | None = None) -> None:
    series = Series(values, at, title=title, title_from_data=title is None)
    series.marker.symbol = "none"
    series.smooth = False
    chart.series.append(series)
