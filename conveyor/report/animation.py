"""Animated curves as SVG: no script, nothing fetched, played on a click."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.report.plots import curve_colour
from conveyor.text.markup import Html, element, join_html

Array = NDArray[np.float64]

_WIDTH, _LEFT, _RIGHT, _TOP, _GAP, _FOOT = 660, 62, 10, 8, 20, 62  # [px]
_HEIGHTS = (170, 90)
_TICKS = 4
_SHORTEST_PLAY = 8.0  # seconds that a run takes at least
_LONGEST_PLAY = 20.0  # and at most
_SPEED_UP = 10.0  # over life between them


@dataclass(frozen=True)
class Panel:
    """A curve over the place at every time, shape (m, n), in the unit of its label; `band` its extremes over time."""

    label: str
    values: Array
    band: tuple[Array, Array]


def animated_curves(
    name: str, x: tuple[str, Array], time: tuple[str, Array], panels: Sequence[Panel], *, mark: float
) -> Html:
    """Draw curves over the place, animated in time, above a time bar.

    Parameters
    ----------
    name : str
        Begins every identifier in it, unique in the page: letters, digits and "_" (timing reads "-" as minus).
    x, time : tuple of str and ndarray
        Labels with their units; places ascending, shape (n,), times in even steps, shape (m,).
    panels : sequence of Panel
        From the top, at most two.
    mark : float
        A place to mark by a line.
    """
    (x_label, places), (time_label, times) = x, time
    right, last = _WIDTH - _RIGHT, float(times[-1])
    lasts = f"{min(_LONGEST_PLAY, max(_SHORTEST_PLAY, last / _SPEED_UP)):.1f}s"
    begin = {"begin": f"{name}_play.click", "dur": lasts, "fill": "freeze"}

    def across(values: Array) -> Array:
        return np.asarray(_LEFT + (right - _LEFT) * (values - places[0]) / (places[-1] - places[0]))

    top, parts = _TOP, []
    at = float(across(np.array(mark)))
    for panel, height in zip(panels, _HEIGHTS, strict=False):
        parts.append(_panel_svg(panel, across(places), (top, height), begin, at))
        top += height + _GAP
    parts += [
        _text_element(float(across(np.array(value))), top - 4, f"{value:,.0f}", "middle")
        for value in _round_ticks(float(places[0]), float(places[-1]))
    ]
    parts.append(_text_element(right, top + 12, x_label, "end"))
    line = top + 34
    parts.append(element("path", d=f"M{_LEFT} {line}H{right}", stroke="#5F6670", stroke_width=2))
    dot = element("animate", attributeName="cx", values=f"{_LEFT};{right}", **begin)
    parts.append(element("circle", dot, cx=_LEFT, cy=line, r=6, fill=curve_colour(0)))
    parts += [
        _text_element(_LEFT + (right - _LEFT) * value / last, line + 20, f"{value:,.0f}", "middle")
        for value in _round_ticks(0.0, last)
    ]
    parts.append(_text_element(_LEFT - 10, line + 4, time_label, "end"))
    drawn = element(
        "svg", *parts, xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {_WIDTH} {line + 28}", role="img",
        font_family="sans-serif", font_size="12", aria_label=", ".join(panel.label for panel in panels),
    )  # fmt: skip
    play = element("button", "▶ play", id=f"{name}_play", type="button")
    return element("div", play, drawn, class_="moving")


def _round_ticks(low: float, high: float) -> list[float]:
    """Round tick values between two ends."""
    step = 10.0 ** math.floor(math.log10((high - low) / _TICKS))
    step *= next(times for times in (1.0, 2.0, 5.0, 10.0) if (high - low) / (times * step) <= _TICKS + 1.0)
    return [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _panel_svg(panel: Panel, across: Array, room: tuple[float, float], begin: dict[str, str], mark: float) -> Html:
    """Scale, band and animated curve of a panel; `room` is its top and height [px]."""
    top, height = room
    low, high = min(0.0, float(panel.band[0].min())), float(panel.band[1].max())
    high = high if high > low else low + 1.0

    def up(values: Array) -> Array:
        return np.asarray(top + height * (high - values) / (high - low))

    frames = [_pixel_path(across, up(row)) for row in panel.values]
    band = _pixel_path(
        np.concatenate([across, across[::-1]]), np.concatenate([up(panel.band[0]), up(panel.band[1])[::-1]])
    )
    right = float(across[-1])
    scale = []
    for value in _round_ticks(low, high):
        y = float(up(np.array(value)))
        scale.append(element("path", d=f"M{_LEFT} {y:.0f}H{right:.0f}", stroke="#D5D9DE"))
        scale.append(_text_element(_LEFT - 6, y + 4, f"{value:,g}", "end"))
    moves = element("animate", attributeName="d", values=";".join(frames), **begin)
    return join_html([
        *scale,
        element("path", d=f"M{mark:.0f} {top}v{height}", stroke="#9AA1AA", stroke_dasharray="3 3"),
        element("path", d=f"{band}Z", fill=curve_colour(0), fill_opacity="0.13"),
        element("path", moves, d=frames[0], fill="none", stroke=curve_colour(0), stroke_width=2),
        _text_element(_LEFT + 4, top + 12, panel.label),
    ])  # fmt: skip


def _pixel_path(x: Array, y: Array) -> str:
    """SVG path in whole pixels."""
    points = np.rint([x, y]).astype(int).T
    first, steps = points[0].tolist(), np.diff(points, axis=0).tolist()
    return f"M{first[0]} {first[1]}l" + " ".join(f"{a} {b}".replace(" -", "-") for a, b in steps)


def _text_element(x: float, y: float, words: str, anchor: str = "start") -> Html:
    return element("text", words, x=f"{x:.0f}", y=f"{y:.0f}", text_anchor=anchor, fill="#30363D")
