"""Belt scales: where they stand and what alignment costs, by hand."""

from __future__ import annotations

import math
import re

import pytest

import conveyor
from conveyor.checks.scale_checks import belt_scales
from conveyor.errors import InputError
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.units import si
from tests.command_line import ROOT, run

SPEC = ROOT / "examples" / "specs" / "in_plant_us.yaml"
FOOT = 0.3048
SCALE = {"section": "incline", "distance": "100 ft", "weigh_sets": 2, "alignment": "0.8 mm", "allowed_error": "0.25 %"}


@pytest.fixture(scope="module")
def spec():
    return conveyor.load(SPEC)


def _checked(spec, **changes):
    """The checks of one scale, by key."""
    scaled = with_fields(spec, {"route.belt_scales": [SCALE | changes]})
    result = calculate(scaled)
    return result, {check.key: check for check in belt_scales(result)}


def test_it_is_measured_from_the_end_of_the_skirtboards_or_to_the_head(spec):
    """160 ft from the tail on 860 ft; the boards end 12 ft beyond the zone of acceleration."""
    result, found = _checked(spec)
    zone = (si(spec.belt.speed) ** 2 - (200 / 60 * FOOT) ** 2) / (2.0 * result.line.gravity * 0.5)
    assert result.line.loading[0].belt_friction == pytest.approx(0.5)
    check = found["scale_distance"]
    assert check.calculated == pytest.approx(160 * FOOT - zone - 12 * FOOT, rel=1e-9)
    assert check.required == pytest.approx(20 * FOOT)  # 5 spacings are 20 ft, too
    assert check.verdict == "pass"
    near_head = _checked(spec, section="gallery", distance="90 ft")[1]["scale_distance"]
    assert near_head.calculated == pytest.approx(6 * FOOT, rel=1e-9)
    assert near_head.verdict == "FAIL"


def test_one_between_the_skirtboards_fails(spec):
    check = _checked(spec, section="feed", distance="5 ft")[1]["scale_distance"]
    assert check.calculated < 0.0
    assert check.verdict == "FAIL"


def test_curves_stay_forty_feet_away(spec):
    bent = with_fields(spec, {"route.sections.2.curve": "convex", "route.sections.2.curve_radius": "1000 ft"})
    assert "scale_curve" not in _checked(spec)[1]
    check = _checked(bent, distance="650 ft")[1]["scale_curve"]
    assert check.calculated == pytest.approx(46 * FOOT, rel=1e-9)  # 700 - 650 - 4
    assert check.verdict == "pass"
    assert _checked(bent, distance="680 ft")[1]["scale_curve"].verdict == "FAIL"


def test_the_error_is_the_belts_pull_out_of_line_over_the_bulk_weighed(spec):
    """Each of the two spans beside the raised sets pulls down with T d/a."""
    result, found = _checked(spec)
    line = result.line
    stretch = line.stretches[1]
    steady = result.balance.equilibrium.steady
    at = line.loop.stretches.index(stretch)
    share = 104.0 / 700.0  # the last of two weigh sets, 4 ft behind the first
    tension = steady.starts[at] + share * (steady.ends[at] - steady.starts[at])
    slope = math.asin(70.0 / 700.0)
    weighed = 2 * (line.flow / line.speed) * 4 * FOOT * line.gravity * math.cos(slope)
    pull = 2.0 * tension * 0.8e-3 / (4 * FOOT)
    assert found["scale_alignment"].calculated == pytest.approx(pull / weighed, rel=1e-9)
    assert _checked(spec, allowed_error=None)[1]["scale_alignment"].verdict == "not checked"
    empty = with_fields(spec, {"material.flow": "0 t/h"})
    assert "scale_alignment" not in _checked(empty)[1]


def test_a_scale_for_trade_asks_for_length_and_take_up(spec):
    assert "scale_longest" not in _checked(spec)[1]
    found = _checked(spec, for_trade=True)[1]
    assert found["scale_longest"].calculated == pytest.approx(860 * FOOT, rel=1e-9)
    assert [found[key].verdict for key in ("scale_shortest", "scale_longest")] == ["pass", "pass"]
    assert found["scale_take_up"].verdict == "not checked"  # the spec has none
    weight = with_fields(spec, {"route.take_up": {"kind": "gravity", "position": "head"}})
    assert _checked(weight, for_trade=True)[1]["scale_take_up"].verdict == "pass"
    screw = with_fields(spec, {"route.take_up": {"kind": "screw", "position": "tail", "tension": "30 kN"}})
    assert _checked(screw, for_trade=True)[1]["scale_take_up"].verdict == "FAIL"


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"distance": "698 ft"}, 'got 698 ft and 2 weigh_sets 4 ft apart, but section "incline" is only 700 ft long'),
        ({"section": "hill"}, 'got "hill", which is none of the sections'),
        ({"alignment": None}, "allowed_error needs it"),
    ],
)
def test_a_scale_that_does_not_fit_is_refused(spec, changes, says):
    with pytest.raises(InputError, match=re.escape(says)):
        with_fields(spec, {"route.belt_scales": [SCALE | changes]})


def test_the_report_has_it_in_us_units(tmp_path):
    text = SPEC.read_text(encoding="utf-8")
    row = "{section: incline, distance: 100 ft, weigh_sets: 2, alignment: 0.8 mm, allowed_error: 0.01 %}"
    path = tmp_path / "scale.yaml"
    path.write_text(text.replace("  cleaners:", f"  belt_scales:\n    - {row}\n  cleaners:"), encoding="utf-8")
    done = run("power", path, cwd=tmp_path)
    said = " ".join((done.stdout + done.stderr).split())
    assert 'the belt scale in "incline" errs by' in said
