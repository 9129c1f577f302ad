"""Rolling-resistance tests of a compound: rows or a law, refused where a unit is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import InputError, SpecError
from conveyor.models.rolling_tests import LAW_POINTS, RollingTest

GIVEN = {
    "source": "laboratory",
    "roll_diameter": "219 mm",
    "cover_thickness": "7 mm",
    "speed": "5 m/s",
    "temperature": "20 degC",
}
ROWS = {"line_load": ["1 N/mm", "4 N/mm"], "resistance": ["6.59 N/m", "0.039 N/mm"]}


def test_rows_in_si():
    points = RollingTest.model_validate(GIVEN | ROWS).points()
    assert points.line_load == pytest.approx([1e3, 4e3])
    assert points.resistance == pytest.approx([6.59, 39.0])
    assert (points.radius, points.cover_thickness) == pytest.approx((0.1095, 0.007))
    assert (points.speed, points.temperature) == pytest.approx((5.0, 293.15))


def test_the_published_law():
    law = {"a": 6.59e-3, "b": 1.28, "line_load": ["1 N/mm", "8 N/mm"]}
    points = RollingTest.model_validate(GIVEN | {"law": law}).points()
    assert points.line_load.size == LAW_POINTS
    assert points.line_load[[0, -1]] == pytest.approx([1e3, 8e3])
    # 6.59e-3 N/mm at 1 N/mm; 8^1.28 = 14.3204 times that at 8 N/mm
    assert points.resistance[[0, -1]] == pytest.approx([6.59, 6.59 * 14.3204], rel=1e-5)
    assert np.diff(np.log(points.resistance)) / np.diff(np.log(points.line_load)) == pytest.approx(1.28)


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({}, "give either rows, line_load and resistance, or a law"),
        (ROWS | {"law": {"a": 6.59e-3, "b": 1.28, "line_load": ["1 N/mm", "8 N/mm"]}}, "give either rows"),
        (ROWS | {"resistance": ["6.59 N/m"]}, "got 1 values for 2 of line_load"),
        (ROWS | {"resistance": ["6.59 N/mm", "39 N/m"]}, "is 6.59 of its line load"),
        (ROWS | {"resistance": ["6.59 N/m", "0.039 N/m"]}, "is 9.75e-06 of its line load"),
        ({"law": {"a": 6.59, "b": 1.28, "line_load": ["1 N/mm", "8 N/mm"]}}, "less than or equal to 1|<= 1"),
        ({"law": {"a": 0.5, "b": 1.28, "line_load": ["1 N/mm", "8 N/mm"]}}, "is 0.5 of its line load"),
        (
            {"law": {"a": 6.59e-3, "b": 1.28, "line_load": ["8 N/mm", "1 N/mm"]}},
            "expected the lower value first",
        ),
        (ROWS | {"roll_diameter": "219 m"}, "roll_diameter"),
        (
            ROWS | {"uncertainty": "5 %", "shared_uncertainty": "6 %"},
            "is a part of uncertainty, at most as much; uncertainty is 5 %",
        ),
        (ROWS | {"shared_uncertainty": "11 %"}, "uncertainty is 10 %"),
        (ROWS | {"line_load": ["1 N", "4 N"]}, "line_load"),
    ],
)
def test_wrong_tests_are_refused(changes, match):
    with pytest.raises((InputError, SpecError), match=match):
        RollingTest.model_validate(GIVEN | changes)


def test_a_carrier_needs_tests():
    with pytest.raises((InputError, SpecError), match=r"tests: missing; with a carrier's spectrum"):
        shelf.compound("s100").replace(carrier="standard-cover")


def test_tests_survive_the_file(tmp_path):
    compound = shelf.compound("s100").replace(tests=[GIVEN | ROWS | {"uncertainty": "8 %"}], carrier="s120")
    path = tmp_path / "mine.yaml"
    path.write_text(shelf.dump(compound), encoding="utf-8")
    assert shelf.compound(path) == compound
    (test,) = shelf.compound(path).tests
    assert test.relative_uncertainty == pytest.approx(0.08)
