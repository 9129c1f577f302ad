"""Drawings from the numbers of tables: each point stands where its value says."""

from __future__ import annotations

import math
import subprocess
import sys
from itertools import pairwise
from xml.etree import ElementTree as ET

import pytest

from conveyor.pipeline import calculate
from conveyor.report.line_drawings import (
    ChartLine,
    LineChart,
    NamedTable,
    PowerBand,
    band_chart,
    profile_chart,
    set_chart,
    tension_chart,
)
from conveyor.report.set_outline import set_outlines
from conveyor.report.tables.analysis_contents import AnalysisTables
from conveyor.spec import load
from conveyor.text.markup import Html
from conveyor.units.presentation import display_unit
from tests.worked_examples import SPECS, worked_example

PIXEL = 0.1
"""Places are written to a tenth of a pixel: half of it for the point, half for the ends of the scale."""


def parsed(drawn: Html) -> ET.Element:
    return ET.fromstring(f"<div>{drawn}</div>")  # noqa: S314 made here


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


def test_another_variant_is_drawn_over_it_where_it_differs(tables):
    """Steady tensions of the in-plant belt over those of the overland belt, on one scale; one ground is drawn once."""
    result, studies = worked_example("in_plant_us")
    other = AnalysisTables(result.assess(studies))
    figure = parsed(tension_chart(tables["tension_states"], "SI", NamedTable("B", other["tension_states"])))
    own, *_, line = figure.iter("polyline")
    force, drawn, wanted = display_unit("force", "SI", large=True), [], []
    for table, places in ((tables["tension_states"], own), (other["tension_states"], line)):
        steady = next(column for column in table.columns if column.label == "steady")
        drawn += [y for _, y in points(places)]
        wanted += [float(force(steady.get(row))) for row in table.rows]
    zero, size = scale_of(drawn, wanted)
    assert drawn == pytest.approx([zero + size * value for value in wanted], abs=PIXEL)
    assert "B, steady" in "".join(figure.itertext())
    count = [
        len(list(parsed(profile_chart(tables["profile"], "SI", NamedTable("B", of["profile"]))).iter("polyline")))
        for of in (tables, other)
    ]
    assert count == [1, 2]


def test_sets_are_drawn_to_one_scale():
    """Widths on the drawing over those of belt and rolls are one number; the bulk has the area of its line mass."""
    own = calculate(load(SPECS / "overland.yaml"))
    outlines = set_outlines(own.line, own.conveyor.material.surcharge)
    drawn = parsed(set_chart(outlines, display_unit("size"), own.line.belt.width))
    belts = [points(line) for line in drawn.iter("polyline")]
    lengths = [sum(math.dist(*pair) for pair in pairwise(belt)) for belt in belts]
    scale = lengths[0] / own.line.belt.width
    assert lengths[1] == pytest.approx(lengths[0], rel=PIXEL / 100.0)
    polygons = list(drawn.iter("polygon"))
    (bulk,) = (points(one) for one in polygons if one.attrib["class"] == "bulk")
    area = 0.5 * abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*bulk, bulk[0]]))) / scale**2
    mass = max(stretch.bulk_mass for stretch in own.line.stretches)
    assert area == pytest.approx(mass / own.line.density, rel=2e-3)  # a parabola by 40 chords: 1/40², and pixels
    assert len([one for one in polygons if one.attrib["class"] == "roll"]) == 5


def test_pipes_are_drawn_beside_each_other_to_one_scale():
    own = calculate(load(SPECS / "pipe.yaml"))
    outlines = set_outlines(own.line, own.conveyor.material.surcharge)
    drawn = parsed(set_chart(outlines, display_unit("size"), own.line.belt.width))
    _, _, wide, high = map(float, next(drawn.iter("svg")).attrib["viewBox"].split())
    assert high < 0.6 * wide
    belts = [points(line) for line in drawn.iter("polyline")]
    (left, right) = ([end(x for x, _ in belt) for end in (min, max)] for belt in belts)
    assert left[1] < right[0]
    assert left[1] - left[0] == pytest.approx(right[1] - right[0], abs=2.0 * PIXEL)
