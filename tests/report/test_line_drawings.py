"""Drawings from the numbers of tables: each point stands where its value says."""

from __future__ import annotations

import math
import subprocess
import sys
from itertools import pairwise
from xml.etree import ElementTree as ET

import pytest

from conveyor.report.line_drawings import ChartLine, LineChart, PowerBand, band_chart, profile_chart, tension_chart
from conveyor.report.tables.analysis_contents import AnalysisTables
from conveyor.units.presentation import display_unit
from tests.worked_examples import worked_example

PIXEL = 0.1
"""Places are written to a tenth of a pixel: half of it for the point, half for the ends of the scale."""


def parsed(markup: str) -> ET.Element:
    return ET.fromstring(f"<div>{markup}</div>")  # noqa: S314 made here


def points(line: ET.Element) -> list[tuple[float, float]]:
    return [tuple(map(float, pair.split(","))) for pair in line.attrib["points"].split()]


def scale_of(places: list[float], values: list[float]) -> tuple[float, float]:
    """Zero and pixels of a unit, from the two points furthest apart."""
    low, high = min(range(len(values)), key=values.__getitem__), max(range(len(values)), key=values.__getitem__)
    size = (places[high] - places[low]) / (values[high] - values[low])
    return places[low] - size * values[low], size


@pytest.fixture(scope="module")
def tables():
    result, studies = worked_example("overland")
    return AnalysisTables(result.assess(studies))


@pytest.mark.parametrize("system", ["SI", "US"])
def test_every_tension_is_drawn_on_one_scale(tables, system):
    figure = parsed(tension_chart(tables["tension_states"], system))
    lines = list(figure.iter("polyline"))
    columns = [c for c in tables["tension_states"].columns if c.kind == "force" and c.key != "least_for_sag"]
    assert len(lines) == len(columns) + 1  # and the least for sag
    force = display_unit("force", system, large=True)
    drawn, wanted = [], []
    for line, column in zip(lines, columns, strict=False):
        drawn += [y for _, y in points(line)]
        wanted += [float(force(column.get(row))) for row in tables["tension_states"].rows]
    zero, size = scale_of(drawn, wanted)
    assert size < 0.0  # upward
    assert drawn == pytest.approx([zero + size * value for value in wanted], abs=PIXEL)
    words = [text.text for text in figure.iter("text")] + [caption.text for caption in figure.iter("figcaption")]
    assert any(force.sign in word for word in words if word)


def test_the_profile_is_the_route(tables):
    figure = parsed(profile_chart(tables["profile"], "SI"))
    (line,) = figure.iter("polyline")
    columns = {column.key: column.get for column in tables["profile"].columns}
    for axis, key in ((0, "horizontal"), (1, "height")):
        drawn, wanted = [p[axis] for p in points(line)], [columns[key](row) for row in tables["profile"].rows]
        zero, size = scale_of(drawn, wanted)
        assert drawn == pytest.approx([zero + size * value for value in wanted], abs=PIXEL)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_band_and_its_limit_are_on_one_scale(sign):
    unit = display_unit("power", large=True)
    band = PowerBand("A", sign * 1.2e6, *sorted((sign * 1.0e6, sign * 1.5e6)))
    figure = parsed(band_chart([band], sign * 1.6e6, unit, "power", "installed"))
    band_box = next(r for r in figure.iter("rect") if "band" in r.attrib["class"])
    limit = next(line for line in figure.iter("line") if line.attrib["class"] == "limit")
    at = next(line for line in figure.iter("line") if line.attrib["class"] == "at")
    low, high = sorted((float(band_box.attrib["x"]), float(band_box.attrib["x"]) + float(band_box.attrib["width"])))
    ends = (low, high) if sign > 0.0 else (high, low)
    assert float(band_box.attrib["width"]) > 0.0
    per_megawatt = (ends[1] - ends[0]) / 0.5
    assert float(at.attrib["x1"]) == pytest.approx(ends[0] + 0.2 * per_megawatt, abs=0.2)
    assert float(limit.attrib["x1"]) == pytest.approx(ends[0] + 0.6 * per_megawatt, abs=0.2)


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (-3.0, 1e-3), (1e6, 3.7e6), (12.0, 12.4)])
def test_ticks_are_round_and_few(low, high):
    chart = LineChart("test", "x", "y", (ChartLine("", [(low, low), (high, high)]),))
    texts = [
        text
        for text in parsed(chart.drawn()).iter("text")
        if text.attrib["text-anchor"] == "end" and not text.get("class")
    ]
    ticks = [float(text.text.replace(",", "")) for text in texts]
    assert 3 <= len(ticks) <= 7
    steps = [after - before for before, after in pairwise(ticks)]
    assert steps == pytest.approx([steps[0]] * len(steps))
    mantissa = steps[0] / 10.0 ** math.floor(math.log10(steps[0]) + 1e-9)
    assert min(abs(mantissa - one) for one in (1.0, 2.0, 5.0)) < 1e-6
    assert ticks[0] / steps[0] == pytest.approx(round(ticks[0] / steps[0]), abs=1e-6)


def test_a_level_line_is_drawn_in_the_middle():
    (line,) = parsed(LineChart("test", "x", "y", (ChartLine("", [(0.0, 5.0), (1.0, 5.0)]),)).drawn()).iter("polyline")
    heights = {y for _, y in points(line)}
    assert len(heights) == 1


def test_drawing_needs_no_matplotlib():
    code = "import sys; import conveyor.report.line_drawings; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
