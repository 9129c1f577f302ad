"""Curves of pipe conveyors: statics of a panel under tension, radii by hand, limits, refusals."""

from __future__ import annotations

import math

import pytest

import conveyor
from conveyor.checks.curve_checks import pipe_curves
from conveyor.checks.register import run_checks
from conveyor.laws.loading import pipe_roll_loads
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import dump
from tests.command_line import ROOT, run
from tests.loop.test_pipe import ANGLES, PANEL

SPEC = ROOT / "examples" / "specs" / "pipe.yaml"
STRAIGHT = {"name": "rest", "length": "3730.66 m", "lift": "7.6 m"}
BEND = {"name": "bend", "length": "300 m", "horizontal_radius": "400 m"}
HILL = {"name": "hill", "length": "300 m", "lift": "0 m", "curve_radius": "400 m"}


def with_section(section, **changes):
    """PC01 with a curve of its own at the head, its take-up held so that curves change no setting."""
    sections = [STRAIGHT, section]
    given = {"route.sections": sections, "route.take_up": {"kind": "gravity", "tension": "200 kN"}}
    return with_fields(conveyor.load(SPEC), given | changes)


def borne(result, strand="carry"):
    """Loads of the six rolls on the curve [N]."""
    stretch = next(s for s in result.line.stretches if s.strand == strand and s.section in {"bend", "hill"})
    return stretch, {load.name: load.force for load in stretch.loads}


@pytest.fixture(scope="module")
def left():
    return calculate(with_section(BEND | {"horizontal_curve": "left"}))


@pytest.mark.parametrize("down", [0.0, 300.0, -300.0, -2000.0])
@pytest.mark.parametrize("right", [0.0, 500.0, -500.0])
def test_the_rolls_hold_weight_and_tension_and_nothing_else(down, right):
    loads = pipe_roll_loads(**PANEL, curve_down=down, curve_right=right)
    up = math.fsum(load.force * math.cos(angle) for load, angle in zip(loads, ANGLES, strict=True))
    across = math.fsum(load.force * math.sin(angle) for load, angle in zip(loads, ANGLES, strict=True))
    assert up == pytest.approx((53.4 + 39.6) * 9.81 * 1.2 + down, abs=1e-6)
    assert across == pytest.approx(right, abs=1e-6)


def test_tension_that_holds_the_belt_is_as_a_belt_without_weight():
    straight = pipe_roll_loads(**PANEL | {"belt_line_mass": 0.0})
    held = pipe_roll_loads(**PANEL, curve_down=-39.6 * 9.81 * 1.2)
    assert [load.force for load in held] == pytest.approx([load.force for load in straight], rel=1e-9)
    lifted = {load.name: load.force for load in pipe_roll_loads(**PANEL, curve_down=-39.6 * 9.81 * 1.2 - 600.0)}
    assert lifted["top"] > {load.name: load.force for load in straight}["top"] + 50.0


def test_tension_presses_on_the_rolls_inside_the_bend(left):
    """Across the panel they hold (T - m' v²) a/R by hand; the chord's sine differs by (a/R)²/24 < 1e-6."""
    stretch, loads = borne(left)
    i = left.line.loop.stretches.index(stretch)
    steady = left.balance.equilibrium.steady
    tension = 0.5 * (steady.starts[i] + steady.ends[i])
    side = (tension - stretch.line_mass * 5.2**2) * 1.2 / 400.0
    more = math.fsum(loads[f"{name} left"] - loads[f"{name} right"] for name in ("upper", "lower"))
    assert more * math.cos(math.radians(30.0)) == pytest.approx(side, rel=2.0 * left.line.rtol)


def test_left_and_right_are_mirrored(left):
    right = calculate(with_section(BEND | {"horizontal_curve": "right"}))
    mirrored = {"left": "right", "right": "left"}
    for strand in ("carry", "return"):
        one, other = borne(left, strand)[1], borne(right, strand)[1]
        for name, force in one.items():
            place, _, side = name.partition(" ")
            beside = f"{place} {mirrored[side]}" if side else name
            assert other[beside] == pytest.approx(force, rel=2.0 * left.line.rtol)
    assert right.balance.power.belt == pytest.approx(left.balance.power.belt, rel=2.0 * left.line.rtol)


def test_a_curve_costs_power_by_the_square_of_its_pull(left):
    """What loads the rolls inside relieves those outside: a slight curve costs nothing, within the tolerance."""
    powers = [left.balance.power.belt]
    for radius in ("800 m", "100 km"):
        bent = with_section(BEND | {"horizontal_curve": "left", "horizontal_radius": radius})
        powers.append(calculate(bent).balance.power.belt)
    straight = calculate(with_section({"name": "bend", "length": "300 m"})).balance.power.belt
    assert powers[2] == pytest.approx(straight, rel=2.0 * left.line.rtol)
    assert powers[0] - straight > 2.0 * (powers[1] - straight) > 0.0


@pytest.mark.parametrize(("curve", "more", "less"), [("convex", "lower left", "upper left"),
                                                     ("concave", "upper left", "lower left")])  # fmt: skip
def test_a_hill_presses_down_and_a_valley_lifts_to_the_upper_rolls(curve, more, less):
    straight = borne(calculate(with_section({"name": "hill", "length": "300 m"})))[1]
    curved = borne(calculate(with_section(HILL | {"curve": curve})))[1]
    assert curved[more] > straight[more]
    assert curved[less] <= straight[less]


def test_the_belt_is_held_in_a_valley_in_which_a_trough_would_lift_off():
    valley = with_section(HILL | {"curve": "concave", "curve_radius": "240 m"})
    checks = run_checks(calculate(valley))
    assert "pipe_radius" in {check.key for check in checks}
    assert not any("stays down" in str(check.subject) for check in checks)


@pytest.mark.parametrize(
    ("radius", "carcass", "verdict"),
    [
        ("225 m", {}, "FAIL"),  # 600 x 380 mm = 228 m
        ("230 m", {}, "pass"),
        ("110 m", {"belt.carcass.kind": "EP", "belt.carcass.strength": "2500 N/mm"}, "FAIL"),  # 300 x 380 mm = 114 m
        ("115 m", {"belt.carcass.kind": "EP", "belt.carcass.strength": "2500 N/mm"}, "pass"),
    ],
)
def test_the_least_radius_is_that_of_the_rule(radius, carcass, verdict):
    bent = with_section(BEND | {"horizontal_curve": "left", "horizontal_radius": radius}, **carcass)
    rule = [check for check in pipe_curves(calculate(bent)) if check.key == "pipe_radius"]
    assert [check.verdict for check in rule] == [verdict] * 2  # both strands


def test_strips_of_the_pipe_are_stretched_by_their_distance_from_its_middle(left):
    """T/B ± E d/R: d = 190 mm + 8 mm of cover + half of 5 mm of carcass, E = 72 times the strength."""
    for check in left.pipe_curves:
        turned = 72.0 * 3150e3 * (0.190 + 0.008 + 0.0025) / 400.0
        assert check.most == pytest.approx(check.highest / 1.46 + turned, rel=1e-12)
        assert check.least == pytest.approx(check.lowest / 1.46 - turned, rel=1e-12)
        assert check.angle == pytest.approx(300.0 / 400.0)


def test_a_pipe_at_the_makers_radius_is_not_refused_for_its_strips():
    """600 D of a steel-cord belt: E d/R is 199 kN/m, more than T/B at the tail; the radius of the rule governs.

    To keep every strip taut asks for E d/(T/B); what is slack or above the rated tension is told.
    """
    bent = with_section(BEND | {"horizontal_curve": "left", "horizontal_radius": "228 m"})
    result = calculate(bent)
    checks = list(pipe_curves(result))
    assert [(check.key, check.verdict) for check in checks] == [("pipe_radius", "pass")] * 2  # both strands
    stretch = 72.0 * 3150e3 * (0.190 + 0.008 + 0.0025)
    rated = 3150e3 / 6.7
    for curve in result.pipe_curves:
        taut = stretch / (curve.lowest / 1.46) if curve.lowest > 0.0 else math.inf
        assert curve.buckling == pytest.approx(taut, rel=1e-12)
        spare = rated - curve.highest / 1.46
        assert curve.overstress == pytest.approx(stretch / spare if spare > 0.0 else math.inf, rel=1e-12)
    said = [one.text() for one in analysis_warnings(result, checks)]
    assert sum("inside of the pipe is slack" in one for one in said) == sum(
        curve.buckling > curve.radius for curve in result.pipe_curves
    )
    assert sum("outside of the pipe has" in one for one in said) == sum(
        curve.overstress > curve.radius for curve in result.pipe_curves
    )
    assert any("outside of the pipe has" in one for one in said)


def test_two_bends_in_one_section_make_one():
    """In the plane of 3-4-5 curvatures: 1/R² = 1/400² + 1/300²."""
    both = BEND | {"horizontal_curve": "left", "curve": "concave", "curve_radius": "300 m", "lift": "0 m"}
    for check in calculate(with_section(both)).pipe_curves:
        assert check.radius == pytest.approx(240.0, rel=1e-12)
        assert check.kind == "concave and horizontal"


def test_a_flat_return_strand_drifts_as_any_flat_belt():
    back = {"rolls": 1, "spacing": "3 m", "roll": {"diameter": "152 mm", "length": "1600 mm", "rotating_mass": "20 kg"}}
    bent = BEND | {"horizontal_curve": "left", "horizontal_radius": "60 km", "return_banking": "2 deg"}
    result = calculate(with_section(bent, **{"idlers.return": back}))
    assert [check.strand for check in result.pipe_curves] == ["carry"]
    assert [check.strand for check in result.horizontal] == ["return"]


def test_the_command_reports_the_curves(tmp_path):
    spec = tmp_path / "bend.yaml"
    spec.write_text(dump(with_section(BEND | {"horizontal_curve": "left"})), encoding="utf-8")
    code, out, err = run("power", str(spec), "-o", str(tmp_path / "bend.html"))
    assert code == 0, err
    assert "horizontal curve of the pipe, bend, carry" in " ".join(out.split())
    assert "Curves of the pipe, all cases" in (tmp_path / "bend.html").read_text(encoding="utf-8")
