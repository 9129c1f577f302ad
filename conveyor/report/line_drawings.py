"""Drawings of a conveyor as SVG from the numbers of tables, without matplotlib; their colours are classes of the page.

Lines have the classes s0, s1 …, axes and grid a and g, marks m0, m1 …; a style sheet gives them colour.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np

from conveyor.report.set_outline import Outline, SetOutline
from conveyor.report.table_model import Column, Table
from conveyor.text.markup import Html, element
from conveyor.units import System
from conveyor.units.presentation import Unit, display_unit, format_number

Points = Sequence[tuple[float, float]]

_DASHES: Final = (None, "7 3", "2 2.5", "9 3 2 3", "5 2 1 2 1 2", "12 4")
_MOST_TICKS: Final = 6
_LEFT, _RIGHT, _TOP, _BOTTOM = 54.0, 20.0, 10.0, 34.0
"""Room about the plot for numbers and labels [px]."""
_MARGIN: Final = 0.06
"""Room above and below the lines, of their range."""
_OTHER, _OTHER_DASHES = "other", "6 4"
"""Class and dashes of the lines of another variant."""
_SET_WIDTH, _SET_MARGIN = 384.0, 8.0
"""Width and margins of the drawing of the sets [px]."""
_BAND_ROW: Final = 14.0
"""Height of a bar with a band [px]."""


@dataclass(frozen=True)
class ChartLine:
    """A line of a chart: its name, points in the units of the axes, class and dashes."""

    name: str
    points: Points
    style: str = "s0"
    dashes: str | None = None


@dataclass(frozen=True)
class ChartMark:
    """Marks of one kind on a chart: name, points, class, shape."""

    name: str
    points: Points
    style: str = "m0"
    shape: str = "circle"


@dataclass(frozen=True)
class LineChart:
    """A chart of lines over one axis.

    Attributes
    ----------
    label : str
        Text alternative.
    x, y : str
        Labels of the axes with their units.
    lines : tuple of ChartLine
        Its lines.
    marks : tuple of ChartMark
        Marks on them.
    uprights : tuple of (float, str)
        Named upright lines.
    zero : bool
        Whether the vertical axis includes zero.
    width, height : float
        Size [px].
    """

    label: str
    x: str
    y: str
    lines: tuple[ChartLine, ...]
    marks: tuple[ChartMark, ...] = ()
    uprights: tuple[tuple[float, str], ...] = ()
    zero: bool = False
    width: float = 560.0
    height: float = 210.0
    _ends: tuple[float, float, float, float] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        every = [point for line in self.lines for point in line.points]
        every += [point for mark in self.marks for point in mark.points]
        x = [point[0] for point in every]
        y = [point[1] for point in every] + ([0.0] if self.zero else [])
        low, high = min(y), max(y)
        room = _MARGIN * (high - low) or 1.0
        object.__setattr__(self, "_ends", (min(x), max(x), low - room, high + room))

    def _at(self, point: tuple[float, float]) -> tuple[float, float]:
        """Place of a point on the drawing [px]."""
        left, right, low, high = self._ends
        across = (point[0] - left) / (right - left or 1.0)
        up = (point[1] - low) / (high - low)
        return (
            _LEFT + across * (self.width - _LEFT - _RIGHT),
            self.height - _BOTTOM - up * (self.height - _TOP - _BOTTOM),
        )

    def _axes(self) -> Iterator[Html]:
        left, right, low, high = self._ends
        foot, end = self.height - _BOTTOM, self.width - _RIGHT
        for tick in _round_ticks(low, high):
            y = self._at((left, tick))[1]
            yield _line_element(_LEFT, y, end, y, "a" if tick == 0.0 else "g")
            yield _label_text(_LEFT - 6.0, y + 3.5, _tick_text(tick), "end")
        for tick in _round_ticks(left, right):
            x = self._at((tick, low))[0]
            yield _line_element(x, foot, x, foot + 4.0, "a")
            yield _label_text(x, foot + 15.0, _tick_text(tick), "middle")
        yield _line_element(_LEFT, foot, end, foot, "a")
        yield _label_text(end, self.height - 4.0, self.x, "end", "t")
        for x, name in self.uprights:
            at = self._at((x, low))[0]
            yield _line_element(at, _TOP, at, foot, "u")
            yield _label_text(at + 4.0, _TOP + 8.0, name, "start", "t")

    def drawn(self) -> Html:
        """The chart as a figure: label of the vertical axis and legend above the drawing."""
        body = [*self._axes()]
        for line in self.lines:
            places = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self._at, line.points))
            body.append(
                element("polyline", points=places, class_=f"l {line.style}", stroke_dasharray=line.dashes, fill="none")
            )
        for mark in self.marks:
            body += [_drawn_mark(*self._at(point), mark) for point in mark.points]
        svg = element(
            "svg", *body, viewBox=f"0 0 {self.width:g} {self.height:g}", role="img", aria_label=self.label,
            class_="chart",
        )  # fmt: skip
        return element("figure", element("figcaption", self.y, " ", self._legend()), svg, class_="drawn")

    def _legend(self) -> Html:
        named = [(line.name, _line_sample(line)) for line in self.lines if line.name]
        named += [(mark.name, _mark_sample(mark)) for mark in self.marks]
        if not named:
            return Html()
        return element("span", *(element("span", sample, name, class_="key") for name, sample in named), class_="keys")


class PowerBand(NamedTuple):
    """A value with the low and high end of its band, if it has one [SI]; its name, and which colour it has."""

    name: str
    value: float
    low: float | None = None
    high: float | None = None
    style: int = 0


class NamedTable(NamedTuple):
    """A table of another variant, and the name of that."""

    name: str
    table: Table


def tension_chart(states: Table, system: System, beside: NamedTable | None = None) -> Html:
    """Draw the tension round the loop in every state of motion, from the head.

    Parameters
    ----------
    states : Table
        The table `tension_states`.
    system : {"SI", "US"}
        Units of the axes.
    beside : NamedTable, optional
        The same of another variant: its first state, steady running, is drawn too.
    """
    force, length = (display_unit(kind, system, large=True) for kind in ("force", "length"))

    def way_of(table: Table) -> list[float]:
        get = next(column.get for column in table.columns if column.key == "distance_from_head")
        return [float(length(get(row))) for row in table.rows]

    def line_of(table: Table, column: Column, name: str, style: str, dashes: str | None) -> ChartLine:
        values = [float(force(column.get(row))) for row in table.rows]
        return ChartLine(name, list(zip(way_of(table), values, strict=True)), style, dashes)

    lines = []
    for k, column in enumerate(_states_of_motion(states)):
        name = column.label.replace("_", " ")
        lines.append(line_of(states, column, name, f"s{k}", _DASHES[k % len(_DASHES)]))
    label = f"Tension round the loop in {len(lines)} states of motion, from the head"
    least = next(column for column in states.columns if column.key == "least_for_sag")
    lines.append(line_of(states, least, "minimum for sag", "s9", "2 3"))
    tail = (0.5 * max(way_of(states)), "tail")
    if beside is not None:
        steady = _states_of_motion(beside.table)[0]
        name = f"{beside.name}, {steady.label.replace('_', ' ')}"
        lines.append(line_of(beside.table, steady, name, _OTHER, _OTHER_DASHES))
        label += f"; {name}"
    return LineChart(
        label, length.beside("distance from the head along the loop"), force.beside("tension"), tuple(lines),
        uprights=(tail,), zero=True,
    ).drawn()  # fmt: skip


def _states_of_motion(states: Table) -> list[Column]:
    return [column for column in states.columns if column.kind == "force" and column.key != "least_for_sag"]


def profile_chart(profile: Table, system: System, beside: NamedTable | None = None) -> Html:
    """Draw the route's profile from the tail, with feeding points, drives and take-up.

    Parameters
    ----------
    profile : Table
        The table `profile`.
    system : {"SI", "US"}
        Units of the axes.
    beside : NamedTable, optional
        The same of another variant: its ground is drawn where it differs.
    """
    length = display_unit("length", system, large=True)

    def points_of(key: str, table: Table = profile) -> list[tuple[float, float]]:
        columns = {column.key: column.get for column in table.columns}
        pairs = ((columns["horizontal"](row), columns[key](row)) for row in table.rows)
        return [(float(length(x)), float(length(z))) for x, z in pairs if z is not None]

    lines = [ChartLine("", points_of("height"))]
    if beside is not None and (other := points_of("height", beside.table)) != lines[0].points:
        lines.append(ChartLine(beside.name, other, _OTHER, _OTHER_DASHES))
    others = [c for c in profile.columns if c.key not in {"behind_section", "along_the_belt", "horizontal", "height"}]
    marks = tuple(
        ChartMark(column.label.removesuffix(" at height"), points_of(column.key), f"m{k % 3}", _SHAPES[k % 3])
        for k, column in enumerate(others)
    )
    label = f"Profile of the route, {len(profile.rows) - 1} sections"
    across, up = length.beside("horizontal distance from the tail"), length.beside("height over the tail")
    return LineChart(label, across, up, tuple(lines), marks).drawn()


def set_chart(outlines: Sequence[SetOutline], unit: Unit, width: float) -> Html:
    """Draw a set of each strand with its belt and bulk, to one scale.

    Parameters
    ----------
    outlines : sequence of SetOutline
        Of the carry and the return strand.
    unit : Unit
        Unit of the width of the belt.
    width : float
        Width of the belt [m].
    """
    drawn = [(*one.rolls, one.belt, *(() if one.bulk is None else (one.bulk,))) for one in outlines]
    reach = max(float(np.max(np.abs(x))) for shapes in drawn for x, _ in shapes)
    ends = [[float(end(y for _, of in shapes for y in of)) for end in (min, max)] for shapes in drawn]
    count = len(drawn) if sum(high - low for low, high in ends) > 2.0 * reach else 1  # pipes: beside each other
    share = _SET_WIDTH / count
    scale, middle, top, bottom = 0.5 * (share - 2.0 * _SET_MARGIN) / reach, 0.5 * share, _SET_MARGIN, 0.0
    body = []
    for one, (low, high) in zip(outlines, ends, strict=True):

        def places(outline: Outline, high: float = high, top: float = top, middle: float = middle) -> str:
            pairs = zip(
                (middle + scale * outline[0]).tolist(), (top + scale * (high - outline[1])).tolist(), strict=True
            )
            return " ".join(f"{x:.1f},{y:.1f}" for x, y in pairs)

        body += [element("polygon", points=places(roll), class_="roll") for roll in one.rolls]
        body += [] if one.bulk is None else [element("polygon", points=places(one.bulk), class_="bulk")]
        body.append(element("polyline", points=places(one.belt), class_="l belt s0", fill="none"))
        bottom = max(bottom, top + scale * (high - low) + _SET_MARGIN)
        middle, top = (middle + share, top) if count > 1 else (middle, bottom + _SET_MARGIN)
    label = f"Carry and return set with belt and bulk, to scale; belt {unit.said(width, 4)}"
    box = f"0 0 {_SET_WIDTH:g} {bottom:.1f}"
    svg = element("svg", *body, viewBox=box, role="img", aria_label=label, class_="chart")
    return element(
        "figure",
        element("figcaption", f"belt {unit.said(width, 4)}: carry and return set, to scale"),
        svg,
        class_="drawn",
    )


def band_chart(
    bands: Sequence[PowerBand],
    limit: float | None,
    unit: Unit,
    label: str,
    limit_name: str,
) -> Html:
    """Draw one or two values, each with its band and on one scale, beside a limit.

    Parameters
    ----------
    bands : sequence of PowerBand
        Values [SI].
    limit : float or None
        A limit on the same scale [SI].
    unit : Unit
        Unit of the numbers.
    label : str
        Text alternative.
    limit_name : str
        Name of the limit.
    """
    width, left, right = 460.0, 10.0, 450.0

    def number(value: float | None) -> float | None:
        return None if value is None else float(unit(value))

    shown = [PowerBand(of.name, float(unit(of.value)), number(of.low), number(of.high), of.style) for of in bands]
    most_allowed = number(limit)
    values = [0.0, *(end for of in shown for end in (of.value, of.low, of.high) if end is not None)]
    values += [] if most_allowed is None else [most_allowed]
    low, high = min(values), max(values)
    high = high if high > low else low + 1.0
    room = _MARGIN * (high - low)
    high, low = high + (room if high > 0.0 else 0.0), low - (room if low < 0.0 else 0.0)

    def x_of(value: float) -> float:
        return left + (right - left) * (value - low) / (high - low)

    body = []
    foot = 16.0 + (_BAND_ROW + 6.0) * len(bands)
    for k, (name, value, least, most, style) in enumerate(shown):
        y = 16.0 + k * (_BAND_ROW + 6.0)
        body.append(
            _rectangle_element(x_of(min(0.0, value)), y, abs(x_of(value) - x_of(0.0)), _BAND_ROW, f"bar b{style}")
        )
        if least is not None and most is not None:
            body.append(
                _rectangle_element(x_of(least), y - 3.0, x_of(most) - x_of(least), _BAND_ROW + 6.0, f"band b{style}")
            )
        body.append(_line_element(x_of(value), y - 3.0, x_of(value), y + _BAND_ROW + 3.0, "at"))
        if len(bands) > 1:
            body.append(_label_text(x_of(min(0.0, value)) + 5.0, y + _BAND_ROW - 3.5, name, "start", "in"))
    if most_allowed is not None:
        at = x_of(most_allowed)
        body.append(_line_element(at, 10.0, at, foot, "limit"))
        side = "end" if at > 0.5 * width else "start"
        body.append(_label_text(at + (-4.0 if side == "end" else 4.0), 9.0, limit_name, side, "t"))
    body.append(_line_element(left, foot, right, foot, "a"))
    for tick in _round_ticks(low, high):
        body.append(_line_element(x_of(tick), foot, x_of(tick), foot + 3.0, "a"))
        body.append(_label_text(x_of(tick), foot + 14.0, _tick_text(tick), "middle"))
    return element(
        "svg", *body, viewBox=f"0 0 {width:g} {foot + 18.0:g}", role="img", aria_label=label, class_="chart bands"
    )


def share_chart(rows: Iterable[tuple[str, float, float]], unit: Unit, label: str) -> Html:
    """Draw forces as bars from one zero, with their numbers and shares.

    Parameters
    ----------
    rows : iterable of (str, float, float)
        Name, force [SI], share of the sum [-].
    unit : Unit
        Unit of the numbers.
    label : str
        Text alternative.
    """
    shown = tuple(rows)
    low = min(0.0, *(force for _, force, _ in shown))
    high = max(0.0, *(force for _, force, _ in shown))
    left, right, row = 92.0, 282.0, 19.0
    scale = (right - left) / (high - low or 1.0)
    zero = left - low * scale
    body = [_line_element(zero, 0.0, zero, row * len(shown), "a")]
    for k, (name, force, share) in enumerate(shown):
        y = k * row
        body.append(_label_text(left - 8.0, y + 13.0, name, "end"))
        body.append(
            _rectangle_element(min(zero, zero + force * scale), y + 3.0, abs(force) * scale, row - 6.0, "bar b0")
        )
        body.append(_label_text(right + 56.0, y + 13.0, format_number(float(unit(force)), 3), "end", "v"))
        body.append(_label_text(right + 98.0, y + 13.0, f"{100.0 * share:.0f} %", "end"))
    return element("svg", *body, viewBox=f"0 0 384 {row * len(shown):g}", role="img", aria_label=label, class_="chart")


def _round_ticks(low: float, high: float) -> list[float]:
    """Round numbers within a range, at most six."""
    span = high - low
    if not (math.isfinite(span) and span > 0.0):
        return []
    step = 10.0 ** math.floor(math.log10(span / _MOST_TICKS))
    step *= next(m for m in (1.0, 2.0, 5.0, 10.0, 20.0) if span / (m * step) <= _MOST_TICKS)
    first = math.ceil(low / step)
    last = math.floor(high / step)
    return [float(f"{i * step:.12g}") for i in range(first, last + 1)]


def _tick_text(value: float) -> str:
    return f"{value:,.10g}"


def _label_text(x: float, y: float, words: str, anchor: str, kind: str | None = None) -> Html:
    return element("text", words, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=kind)


def _line_element(x1: float, y1: float, x2: float, y2: float, kind: str) -> Html:
    return element("line", x1=f"{x1:.1f}", y1=f"{y1:.1f}", x2=f"{x2:.1f}", y2=f"{y2:.1f}", class_=kind)


def _rectangle_element(x: float, y: float, width: float, height: float, kind: str) -> Html:
    return element(
        "rect", x=f"{x:.1f}", y=f"{y:.1f}", width=f"{max(width, 0.0):.1f}", height=f"{height:.1f}", class_=kind
    )


def _square_mark(x: float, y: float, kind: str) -> Html:
    return _rectangle_element(x - 4.0, y - 4.0, 8.0, 8.0, f"mark {kind}")


def _circle_mark(x: float, y: float, kind: str) -> Html:
    return element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="4.5", class_=f"mark {kind}")


def _triangle_mark(x: float, y: float, kind: str) -> Html:
    return element("path", d=f"M{x - 5.0:.1f} {y - 9.0:.1f}h10l-5 8z", class_=f"mark {kind}")


_SHAPES: Final = ("triangle", "square", "circle")
_DRAW: Final[dict[str, Callable[[float, float, str], Html]]] = {
    "square": _square_mark,
    "circle": _circle_mark,
    "triangle": _triangle_mark,
}


def _drawn_mark(x: float, y: float, mark: ChartMark) -> Html:
    return _DRAW[mark.shape](x, y, mark.style)


def _line_sample(line: ChartLine) -> Html:
    """Sample of a line for a legend."""
    drawn = element("line", x1="0", y1="5", x2="24", y2="5", class_=f"l {line.style}", stroke_dasharray=line.dashes)
    return _small_svg(drawn)


def _mark_sample(mark: ChartMark) -> Html:
    return _small_svg(_DRAW[mark.shape](12.0, 9.0 if mark.shape == "triangle" else 5.0, mark.style))


def _small_svg(sample: Html) -> Html:
    return element("svg", sample, viewBox="0 0 24 10", width="24", height="10", aria_hidden="true")
