"""Native charts of the workbook, each over cells that are already written."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any, Literal, TypeAlias

from openpyxl.chart import BarChart, LineChart, Reference, ScatterChart, Series
from openpyxl.chart.axis import ChartLines
from openpyxl.chart.layout import Layout, ManualLayout
from openpyxl.chart.legend import Legend
from openpyxl.chart.shapes import GraphicalProperties
from openpyxl.chart.text import RichText, Text
from openpyxl.chart.title import Title
from openpyxl.drawing.line import LineProperties
from openpyxl.drawing.text import CharacterProperties, Paragraph, ParagraphProperties, RegularTextRun
from openpyxl.worksheet.worksheet import Worksheet

from conveyor.report.cells import ACCENT, cell_text
from conveyor.report.sheet_writer import TablePlace
from conveyor.report.table_model import Table
from conveyor.units import System
from conveyor.units.presentation import display_unit, label_for_people

_WIDTH, _HEIGHT, _WIDE = 17.0, 9.0, 24.0  # [cm]
_PALETTE = (ACCENT, "C55A11", "7F7F7F", "2E8B57", "8064A2", "B8860B")
_DASHES = ("solid", "dash", "sysDot", "dashDot")
_RED = "B3261E"
_STREAM = ("centre", "lower_edge", "upper_edge", "lower_edge_after_booth")
_HIGHEST_AREA = 13.0  # highest area of a chart that is drawn to scale [cm]
_MOST_STEPS = 6.0  # of the longer axis of a chart that is drawn to scale, at most
_LETTERS = 11  # [pt], as in cells
# room for axis labels, legend and frame of a chart that is drawn to scale [cm]
_AXIS_ROOM, _LEGEND_ROOM, _FRAME_ROOM = 2.4, 6.4, 3.2
_SYMBOLS = ("triangle", "circle", "square")
_GRID = "D9D9D9"
_LINE_WIDTH = 22_000  # width of a series' line [EMU]: 1.7 pt


Said: TypeAlias = Callable[[str], str]
"""Returns an English text in the language of the report."""


def _chart_title(words: str, *, size: int) -> Title:
    title = Title(overlay=False)
    look = CharacterProperties(sz=100 * size, b=size > _LETTERS, solidFill="404040")
    run = RegularTextRun(t=cell_text(words), rPr=look)
    title.tx = Text(rich=RichText(p=[Paragraph(pPr=ParagraphProperties(defRPr=look), r=[run])]))
    return title


def _column_header(sheet: Worksheet, header: int, column: int) -> str:
    """Header of a column, with its unit."""
    return str(sheet.cell(header, column).value)


def axis_title(words: str) -> Title:
    """Title of an axis."""
    return _chart_title(words, size=_LETTERS)


def _label_letters() -> RichText:
    """Letters of an axis or a legend, as large as those of cells."""
    look = ParagraphProperties(defRPr=CharacterProperties(sz=100 * _LETTERS))
    return RichText(p=[Paragraph(pPr=look, endParaRPr=CharacterProperties())])


def _place_legend(chart: Any, position: Literal["r", "b"]) -> None:
    """Place the legend of a chart."""
    chart.legend = Legend(legendPos=position)
    chart.legend.txPr = _label_letters()


def _style_chart(chart: Any, title: str, x: str, y: str) -> None:
    chart.title = _chart_title(title, size=12)
    for axis, words in ((chart.x_axis, x), (chart.y_axis, y)):
        axis.title = axis_title(words) if words else None
        axis.delete = False  # recent Excel hides axes otherwise
        axis.txPr = _label_letters()
    _place_legend(chart, "r")
    chart.y_axis.majorGridlines.spPr = GraphicalProperties(ln=LineProperties(solidFill=_GRID))
    chart.width, chart.height = _WIDTH, _HEIGHT


def resize_chart(chart: Any, width: float, height: float = _HEIGHT) -> None:
    """Set the size of a chart [cm]."""
    chart.width, chart.height = width, height


def bar_chart(sheet: Worksheet, title: str, rows: tuple[int, int], *, label: int, value: int) -> BarChart:
    """Bar chart of two columns of a table, labels and values; `rows` are its header and its last row."""
    header, last = rows
    chart = BarChart()
    chart.type = "bar"
    _style_chart(chart, title, "", _column_header(sheet, header, value))
    chart.add_data(Reference(sheet, min_col=value, min_row=header, max_row=last), titles_from_data=True)
    chart.set_categories(Reference(sheet, min_col=label, min_row=header + 1, max_row=last))
    chart.series[0].graphicalProperties.solidFill = ACCENT
    chart.series[0].invertIfNegative = False
    chart.legend = None
    chart.gapWidth = 60
    chart.x_axis.scaling.orientation = "maxMin"
    chart.x_axis.tickLblPos = "low"  # clear of negative bars
    chart.y_axis.crosses = "max"  # at the bottom, as the categories run downward
    chart.y_axis.number_format = "#,##0"
    return chart


def force_axis(axis: Any, name: str, system: System) -> None:
    """Title and format an axis of forces: kN for cells in N."""
    large = display_unit("force", system, large=True)
    axis.title = axis_title(large.beside(name))
    axis.number_format = "#,##0" if large.size == display_unit("force", system).size else "#,##0,"


def difference_chart(sheet: Worksheet, title: str, place: TablePlace, last: int, *, said: Said = str) -> LineChart:
    """Difference of every compound to the base, with its band where known."""
    chart = LineChart()
    _style_chart(chart, said(title), "", said("difference"))
    for key, symbol, size in (
        ("motor_power_against_base", "circle", 9),
        ("difference_low", "dash", 7),
        ("difference_high", "dash", 7),
    ):
        if key in place.keys:
            values = Reference(sheet, min_col=place.column(key), min_row=place.header, max_row=last)
            series = Series(values, title_from_data=True)
            series.marker.symbol, series.marker.size = symbol, size
            series.marker.graphicalProperties = GraphicalProperties(solidFill=ACCENT)
            series.graphicalProperties.line.noFill = True
            series.smooth = False
            chart.series.append(series)
    chart.set_categories(Reference(sheet, min_col=1, min_row=place.header + 1, max_row=last))
    chart.hiLowLines = ChartLines()
    chart.legend = None
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.number_format = "0 %"
    return chart


def power_over_temperature(
    sheet: Worksheet, place: TablePlace, shown: Table, system: System, *, said: Said = str
) -> ScatterChart:
    """Motor power of compounds (all columns but the first) over temperature; the speed is the table's note.

    The power axis begins below the least, at a round figure: differences between compounds are what is looked for.
    """
    chart = _column_curves(
        sheet,
        place,
        "temperature",
        place.keys[1:],
        title=said(f"Motor power at {shown.note}"),
        words=(
            said(f"belt {shown.head(shown.columns[0], system)}"),
            label_for_people(said("motor power"), "power", system),
        ),
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


def tension_chart(
    sheet: Worksheet, place: TablePlace, system: System, *, failing: Collection[str] = (), said: Said = str
) -> ScatterChart:
    """Tension round the loop in every state, and the minimum for sag; states that fail, by their keys, in red."""
    states = [key for key in place.keys[1:] if key != "distance_from_head"]
    title = said("Tension round the loop, from the head along the return strand and back")
    words = (
        _column_header(sheet, place.header, place.column("distance_from_head")),
        label_for_people(said("tension"), "force", system),
    )
    chart = _column_curves(sheet, place, "distance_from_head", states, title=title, words=words)
    for series, key in zip(chart.series, states, strict=True):
        if key in failing:
            line = series.graphicalProperties.line
            line.solidFill, line.dashStyle, line.width = _RED, "solid", 2 * _LINE_WIDTH
    chart.x_axis.number_format = "#,##0"
    force_axis(chart.y_axis, said("tension"), system)
    chart.x_axis.tickLblPos = "low"
    chart.x_axis.scaling.min = 0.0
    resize_chart(chart, _WIDE)
    return chart


def profile_chart(sheet: Worksheet, place: TablePlace, system: System, *, said: Said = str) -> ScatterChart:
    """Profile of the route, with feeding points, drives and take-up."""
    names = "horizontal distance from the tail", "height"
    words = tuple(label_for_people(said(name), "length", system) for name in names)
    first = place.keys.index("height")
    what = place.keys[first:]
    chart = _column_curves(sheet, place, "horizontal", what, title=said("Profile of the route"), words=words)
    for series, symbol in zip(chart.series[1:], _SYMBOLS, strict=False):
        ink = series.graphicalProperties.line.solidFill
        series.graphicalProperties.line.noFill = True
        series.graphicalProperties.line.solidFill = None
        series.marker.symbol, series.marker.size = symbol, 9
        series.marker.graphicalProperties = GraphicalProperties(noFill=True, ln=LineProperties(solidFill=ink))
    chart.x_axis.number_format, chart.y_axis.number_format = "#,##0", "#,##0"
    chart.x_axis.tickLblPos = "low"
    chart.y_axis.crosses = "min"
    return chart


def trajectory_chart(
    sheet: Worksheet, place: TablePlace, outline: TablePlace, system: System, *, said: Said = str
) -> ScatterChart:
    """Discharge trajectory and belt at the head pulley, both axes to one scale."""
    words = [label_for_people(said(name), "spacing", system) for name in ("forward of the axis", "over the axis")]
    chart = _scatter_chart(said("Discharge over the head pulley, to scale"), *words)
    drawn = [(outline, "belt", "belt"), *((place, name, name.replace("_", " ")) for name in _STREAM)]
    spans: list[list[float]] = [[], []]
    for at, name, title in drawn:
        columns = [at.column(f"{name}_{axis}") for axis in ("forward", "up")]
        across, up = (Reference(sheet, min_col=column, min_row=at.header + 1, max_row=at.last) for column in columns)
        _add_line(chart, up, across, said(title.replace("booth", "Booth")))
        for span, column in zip(spans, columns, strict=True):
            cells = (sheet.cell(row, column).value for row in range(at.header + 1, at.last + 1))
            span += [float(value) for value in cells if isinstance(value, int | float)]
    least = max(max(span) - min(span) for span in spans) / _MOST_STEPS
    decade = 10.0 ** math.floor(math.log10(least))
    step = decade * next(part for part in (1.0, 2.0, 5.0, 10.0) if part * decade >= least)
    ends = [(step * math.floor(min(span) / step), step * math.ceil(max(span) / step)) for span in spans]
    wide, high = (end - begin for begin, end in ends)
    scale = min(_WIDTH / wide, _HIGHEST_AREA / high)  # [cm] for one unit
    for axis, (begin, end) in zip((chart.x_axis, chart.y_axis), ends, strict=True):
        axis.scaling.min, axis.scaling.max = begin, end
        axis.majorUnit = step  # type: ignore[union-attr]
        axis.number_format, axis.tickLblPos = "General", "low"
    width, height = scale * wide + _AXIS_ROOM + _LEGEND_ROOM, scale * high + _FRAME_ROOM
    _place_legend(chart, "r")
    resize_chart(chart, width, height)
    inside = (_AXIS_ROOM - 0.6) / width, 1.2 / height, scale * wide / width, scale * high / height
    x, y, w, h = inside
    chart.layout = Layout(ManualLayout(xMode="edge", yMode="edge", layoutTarget="inner", x=x, y=y, w=w, h=h))
    return chart


def moduli_chart(sheet: Worksheet, name: str, place: TablePlace, system: System, *, said: Said = str) -> ScatterChart:
    """E' and E'' against frequency, both axes logarithmic."""
    words = (
        label_for_people(said("frequency"), "frequency", system),
        label_for_people(said("modulus"), "pressure", system),
    )
    title = said(f"Moduli of {name}")
    chart = _column_curves(sheet, place, "frequency", ("storage", "loss"), title=title, words=words)
    chart.x_axis.scaling.logBase = chart.y_axis.scaling.logBase = 10
    chart.x_axis.number_format, chart.y_axis.number_format = "0E+0", "General"
    chart.x_axis.tickLblPos = chart.y_axis.tickLblPos = "low"
    chart.x_axis.crosses = chart.y_axis.crosses = "min"
    return chart


def _column_curves(
    sheet: Worksheet,
    place: TablePlace,
    across: str,
    up: Sequence[str],
    *,
    title: str,
    words: tuple[str, ...],
) -> ScatterChart:
    """Columns of a table plotted over another; axes are titled as the columns by default."""
    x, y = place.column(across), [place.column(key) for key in up]
    named = words or (_column_header(sheet, place.header, x), _column_header(sheet, place.header, y[0]))
    chart = _scatter_chart(title, *named)
    at = Reference(sheet, min_col=x, min_row=place.header + 1, max_row=place.last)
    for column in y:
        _add_line(chart, Reference(sheet, min_col=column, min_row=place.header, max_row=place.last), at)
    return chart


def _scatter_chart(title: str, x: str, y: str) -> ScatterChart:
    chart = ScatterChart()
    chart.style, chart.scatterStyle = 2, "lineMarker"
    _style_chart(chart, title, x, y)
    chart.x_axis.majorGridlines = None
    _place_legend(chart, "b")
    return chart


def _add_line(chart: ScatterChart, values: Reference, at: Reference, title: str | None = None) -> None:
    series = Series(values, at, title=title, title_from_data=title is None)
    k = len(chart.series)
    series.marker.symbol = "none"
    series.smooth = False
    line = series.graphicalProperties.line
    line.solidFill = _PALETTE[k % len(_PALETTE)]
    line.dashStyle = _DASHES[k % len(_DASHES)]  # equal curves stay visible under each other
    line.width = _LINE_WIDTH
    chart.series.append(series)
