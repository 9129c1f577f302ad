"""Horizontal curves: straight and mirrored conveyors, statics of the drift, states, wind, edges, vertical curves."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.checks.curve_checks import belt_drift, horizontal_edges, wind_lift
from conveyor.errors import InputError, NoSolutionError
from conveyor.line.strands import Strands
from conveyor.line.stretches import CurveLoads
from conveyor.loop.belt_limits import LEAST_EDGE_TENSION
from conveyor.loop.tension_coupling import belt_drifts, pressing_masses
from conveyor.pipeline import calculate
from conveyor.report.analysis_plots import cross_section as across
from conveyor.report.analysis_plots import drift_diagram as drift_drawn
from conveyor.report.analysis_plots import plan_view
from conveyor.report.tables.curve_tables import horizontal_curves
from conveyor.spec import from_data
from conveyor.studies.load_cases import Load
from conveyor.units.sentences import message
from tests.loop.loop_lines import DATA, data

_ROLL = {"diameter": "133 mm", "length": "600 mm", "rotating_mass": "5 kg", "drag": "1.5 N"}
BACK = {"return": {"rolls": 2, "spacing": "3 m", "trough_angle": "15 deg", "roll": _ROLL}}
CURVE = {"name": "bend", "length": "300 m", "horizontal_curve": "left", "horizontal_radius": "1800 m",
         "carry_banking": "3 deg", "return_banking": "3 deg"}  # fmt: skip
PULLEYS = DATA["route"]["pulleys"][:3]


def conveyor(bend=None, *, ambient=None, flow="1200 t/h"):
    """Straight, curved, straight; `bend` alters the curve, None in it removes a field."""
    middle = {key: value for key, value in (CURVE | (bend or {})).items() if value is not None}
    sections = [{"name": "a", "length": "150 m"}, middle, {"name": "c", "length": "200 m", "lift": "10 m"}]
    return from_data(
        data(
            idlers=BACK,
            route={"sections": sections, "pulleys": PULLEYS},
            ambient=ambient or {},
            material={"flow": flow},
            calculation={"strain": "off"},
        )
    )


STRAIGHT = dict.fromkeys(("horizontal_curve", "horizontal_radius", "carry_banking", "return_banking"))


@pytest.fixture(scope="module")
def found():
    return calculate(conveyor())


@pytest.fixture(scope="module")
def straight():
    return calculate(conveyor(STRAIGHT))


def test_a_straight_conveyor_has_nothing_of_it(straight):
    assert straight.horizontal == ()
    assert straight.convergence is None
    assert not horizontal_curves([Load("as given", message("as given"), straight)]).rows
    assert "guidance" not in {force.key for force in straight.balance.along}


def test_without_curvature_it_is_the_straight_conveyor(straight):
    """What differs goes with 1/R: a tenth of the difference is left at ten times the radius."""
    level = {"carry_banking": None, "return_banking": None}
    near, far = (calculate(conveyor(level | {"horizontal_radius": radius})) for radius in ("10 km", "100 km"))
    force = straight.balance.forces.indentation
    assert far.balance.forces.indentation == pytest.approx(force, rel=1e-4)
    drifts_near, drifts_far = ([c.turn.drift for c in one.horizontal] for one in (near, far))
    # the parabola of the bulk on the outer wing leaves the square of the drift over the wing
    assert drifts_far == pytest.approx([0.1 * drift for drift in drifts_near], rel=0.05)


def test_left_and_right_are_mirrors(found):
    other = calculate(conveyor({"horizontal_curve": "right"}))
    assert other.balance.power.motor == pytest.approx(found.balance.power.motor, rel=1e-12)
    for one, two in zip(found.line.stretches, other.line.stretches, strict=True):
        mirrored = [load.force for load in reversed(two.loads)]
        assert [load.force for load in one.loads] == pytest.approx(mirrored, rel=1e-12)


def test_the_drift_holds_the_pull_of_the_mean_tension(found):
    """Moved weights push out by 2 (T - m' v²) sin(a/2R), and the rolls bear weight and the pull's normal part."""
    steady = found.balance.equilibrium.steady
    for i, stretch in enumerate(found.line.loop.stretches):
        turn = stretch.turn
        if turn is None:
            continue
        pull = 0.5 * (steady.starts[i] + steady.ends[i]) - stretch.line_mass * 4.0**2
        inward = 2.0 * pull * math.sin(stretch.spacing / 3600.0)
        law = turn.law(0.0, least=False)
        assert law.force(turn.drift) == pytest.approx(inward, rel=1e-5)  # tensions of the last step
        weight = math.fsum(load.force for load in turn.weights)
        slopes = turn.slopes
        lengths = [load.length for load in (stretch.loads if turn.side == "left" else stretch.loads[::-1])]
        normal = inward * sum(s * n for s, n in zip(slopes, lengths, strict=True)) / sum(lengths)
        assert math.fsum(load.force for load in stretch.loads) == pytest.approx(weight + normal, rel=1e-5)


def test_states_of_motion_have_their_own_drift_and_radii(found):
    for curve in found.horizontal:
        states = {state.state: state for state in curve.states}
        assert states["start, design friction"].inside > states["start"].inside > states["steady"].inside
        assert curve.farthest_in is states["start, design friction"]
        for state in curve.states:
            assert state.outside <= state.inside
            assert state.lowest <= state.highest
            # on the least radius the highest tension draws the belt to the end of its roll
            least = 2.0 * math.sin(0.5 * curve_spacing(found, curve) / state.least)
            pull = state.highest - curve_mass(found, curve) * 4.0**2
            held = curve.turn.law(0.0, least=True).force(curve.turn.room)
            assert pull * least == pytest.approx(held, rel=1e-4)  # sin x for x: (3/200)²/6


def _stretch(found, curve):
    return next(s for s in found.line.stretches if (s.section, s.strand) == (curve.section, curve.strand))


def curve_spacing(found, curve):
    return _stretch(found, curve).spacing


def curve_mass(found, curve):
    return _stretch(found, curve).line_mass


def test_a_sharp_curve_fails_and_a_sharper_one_has_no_answer(found):
    assert not [check for check in belt_drift(found) if check.failed]
    sharp = calculate(conveyor({"horizontal_radius": "500 m"}))
    failing = [check for check in belt_drift(sharp) if check.failed]
    assert failing
    assert "the belt drifts by" in failing[0].why.text() or "runs off" in failing[0].why.text()
    with pytest.raises(NoSolutionError, match=r'to the inside of the horizontal curve in section "bend", .*well above'):
        calculate(conveyor({"horizontal_radius": "100 m"}))
    with pytest.raises(NoSolutionError, match=r"to the outside of .*: choose less banking or skew"):
        calculate(conveyor({"horizontal_radius": "100 km", "return_banking": "20 deg"}))


def test_banking_and_skew_bring_the_belt_out(found):
    raised = calculate(conveyor({"carry_banking": "6 deg"}))
    skewed = calculate(conveyor({"carry_skew": "0.5 deg"}))
    drift = {name: one.horizontal[0].turn.drift for name, one in (("as", found), ("raised", raised), ("skew", skewed))}
    assert drift["raised"] < drift["as"]
    assert drift["skew"] < drift["as"]
    (guidance,) = (force for force in skewed.balance.along if force.key == "guidance")
    turn = skewed.horizontal[0].turn
    sets = _stretch(skewed, skewed.horizontal[0]).sets
    inward = turn.law(0.0, least=False).force(turn.drift)
    bare = found.horizontal[0].turn.law(0.0, least=False).force(turn.drift)
    # what the skew's friction holds of the pull, over its angle
    assert guidance.total == pytest.approx(sets * (inward - bare) * math.sin(math.radians(0.5)), rel=1e-9)


def test_wind_moves_the_empty_strand_both_ways_and_none_under_bulk(found):
    windy = calculate(conveyor(ambient={"wind_speed": "8 m/s"}))
    carry, back = windy.horizontal
    assert carry == found.horizontal[0]
    calm = found.horizontal[1]
    assert back.turn.wind == pytest.approx(1.3 * 0.5 * 1.25 * 64.0 * 3.0 * (0.015 + 0.5 * math.sin(math.radians(15))))
    assert back.farthest_in.inside > calm.farthest_in.inside
    assert back.farthest_out.outside < calm.farthest_out.outside
    assert back.turn.drift == calm.turn.drift
    empty = calculate(conveyor(ambient={"wind_speed": "8 m/s"}, flow="0 t/h"))
    assert empty.horizontal[0].turn.wind > 0.0


def test_a_storm_blows_the_empty_belt_off_and_the_picture_says_so():
    stormy = calculate(conveyor(ambient={"wind_speed": "40 m/s"}))
    back = stormy.horizontal[1]
    assert (back.farthest_in.inside, back.farthest_out.outside) == (math.inf, -math.inf)
    off = [check for check in belt_drift(stormy) if check.failed]
    assert {check.found.text() for check in off} == {"runs off its rolls"}
    assert all(check.calculated is None and "no radius helps" in check.why.text() for check in off[:1])
    (axis,) = drift_drawn([("as given", stormy.horizontal)], system="SI").axes
    assert "runs off" in {text.get_text() for text in axis.texts}


def test_the_table_is_of_all_cases(found):
    """An empty carry strand drifts farther inside than the loaded one; what is not worse there stays."""
    empty = calculate(conveyor(flow="0 t/h"))
    loads = [Load(name, message(name), one) for name, one in (("as given", found), ("empty", empty))]
    table = horizontal_curves(loads).frame()
    both = zip(found.horizontal, empty.horizontal, strict=True)
    inside, outside = zip(
        *(
            (
                max(a.farthest_in.inside, b.farthest_in.inside),
                min(a.farthest_out.outside, b.farthest_out.outside),
            )
            for a, b in both
        ),
        strict=True,
    )
    assert table["farthest inside [mm]"].tolist() == pytest.approx([1e3 * x for x in inside])
    assert table["farthest outside [mm]"].tolist() == pytest.approx([1e3 * x for x in outside])
    assert inside[0] > found.horizontal[0].farthest_in.inside
    assert table["drift, steady [mm]"].tolist() == pytest.approx([1e3 * bend.turn.drift for bend in found.horizontal])


def test_the_wind_lifts_what_has_no_bulk_on_it(found):
    """m' g = c ρ v²/2 B, against the steepest part: 10 m over 200 m; nothing is said without wind, nor of bulk."""
    assert not list(wind_lift(found))
    held = math.sqrt(2.0 * 20.0 * 9.81 * math.cos(math.asin(0.05)) / (0.5 * 1.25 * 1.0))
    breeze, storm = (
        [
            check
            for flow in ("1200 t/h", "0 t/h")
            for check in wind_lift(calculate(conveyor(ambient={"wind_speed": f"{gust} m/s"}, flow=flow)))
        ]
        for gust in (0.99 * held, 1.01 * held)
    )
    assert [check.subject.text().split(", ")[1] for check in breeze] == ["return", "carry", "return"]
    assert [check.required for check in breeze] == pytest.approx([held] * 3)
    assert {check.verdict for check in breeze} == {"pass"}
    assert {check.verdict for check in storm} == {"FAIL"}
    assert "lifts the empty belt" in storm[0].why.text()


def test_the_plan_turns_by_length_over_radius(found):
    """A level curve to the left: its chord heads by half the angle turned, its end by all of it."""
    (axis,) = plan_view(found.line).axes
    bend = next(line for line in axis.lines if line.get_label() == "horizontal curve").get_xydata()
    (x0, y0), (x1, y1) = bend[0], bend[-1]
    angle = 300.0 / 1800.0
    assert math.atan2(y1 - y0, x1 - x0) == pytest.approx(0.5 * angle, rel=1e-9)
    # chords of equal turn: 24 of them for the arc
    chord = 24 * 2.0 * 1800.0 * math.sin(angle / 48.0)
    assert math.hypot(x1 - x0, y1 - y0) == pytest.approx(2.0 * 1800.0 * math.sin(0.5 * angle) * 300.0 / chord, rel=1e-9)


def test_edges_bear_the_bend_as_plane_sections_say(found):
    """E d/R beside the mean tension; at the least radius the inner edge keeps just what it must."""
    carry = found.horizontal[0]
    stiffness = found.line.belt.tensile_stiffness
    across = 0.5 * (0.38 + 0.62 * math.cos(math.radians(35)))
    lowest = min(state.lowest for state in carry.states)
    assert carry.least == pytest.approx(lowest - stiffness * across / 1800.0, rel=1e-12)
    assert stiffness * across / carry.buckling == pytest.approx(lowest - LEAST_EDGE_TENSION, rel=1e-12)
    assert {check.key for check in horizontal_edges(found)} == {"curve_radius"}


def test_a_hill_in_the_curve_presses_the_belt_into_its_trough(found):
    hill = calculate(conveyor({"curve": "convex", "curve_radius": "1500 m"}))
    steady = hill.balance.equilibrium.steady
    both = CurveLoads(pressing_masses(hill.line, steady), belt_drifts(hill.line, steady))
    assert set(both.pressing) == set(both.drift) == {("bend", "carry"), ("bend", "return")}
    flat, high = found.horizontal[0], hill.horizontal[0]
    # it stays nearer to where weight alone, without pull, would hold it
    assert high.turn.law(50.0, least=False).force(0.05) > high.turn.law(0.0, least=False).force(0.05)
    assert high.most > flat.most  # stretched by the hill before
    again = Strands.of(hill.conveyor, both)
    forces = [load.force for stretch in again.stretches for load in stretch.loads]
    assert forces == pytest.approx([load.force for s in hill.line.stretches for load in s.loads], rel=1e-5)


def test_what_presses_on_an_empty_trough_holds_as_so_much_more_belt_does(found):
    """Without bulk every force of a set goes with the belt's weight: 3 m of 20 kg/m, pressed by twice that, thrice."""
    back = found.horizontal[1].turn
    weight = 3.0 * 20.0 * found.line.gravity
    for least in (False, True):
        bare, pressed, lifted = (back.law(f * weight, least=least) for f in (0.0, 2.0, -0.5))
        for drift in (-0.04, 0.0, 0.05):
            assert pressed.force(drift) == pytest.approx(3.0 * bare.force(drift), rel=1e-9)
            assert lifted.force(drift) == pytest.approx(0.5 * bare.force(drift), rel=1e-9)


FLAT = {"return": {"rolls": 1, "spacing": "3 m", "roll": _ROLL | {"length": "1400 mm"}}}


def flat(*bends, **route):
    """A flat return strand in one or more curves, one behind the other."""
    sections = [CURVE | {"return_banking": "1.5 deg"} | bend for bend in bends]
    given = {
        "sections": [*sections, {"name": "c", "length": "200 m", "lift": "10 m"}],
        "pulleys": PULLEYS,
    } | route
    return calculate(from_data(data(idlers=FLAT, route=given, calculation={"strain": "off"})))


def of_return(found):
    return [bend for bend in found.horizontal if bend.strand == "return"]


def test_a_flat_strand_drifts_along_its_curve():
    """T a/R = W [sin β + κ(s/L) cos β]; a curve in two halves ends where the whole one does, mirrored ones too."""
    whole = flat({"length": "60 m"})
    (bend,) = of_return(whole)
    stretch, turn = _stretch(whole, bend), bend.turn
    weight = 3.0 * stretch.belt_mass * 9.81 * math.cos(stretch.inclination)
    assert math.fsum(load.force for load in turn.weights) == pytest.approx(weight, rel=1e-4)
    for state in bend.states:
        pull = 2.0 * (state.highest - stretch.line_mass * 4.0**2) * math.sin(1.5 / 1800.0)
        asked = (pull / weight - math.sin(math.radians(1.5))) / math.cos(math.radians(1.5))
        share = 0.7 if asked > 0.0 else 1.0  # the guiding friction that lets it farther in
        turned = math.radians(3.0) * (1.0 - (1.0 - abs(asked) / (share * 0.35)) ** (1.0 / 3.0))
        assert state.inside == pytest.approx(60.0 * math.copysign(turned, asked), rel=1e-3)
        assert state.outside <= state.inside
    halves = flat({"length": "30 m", "name": "one"}, {"length": "30 m", "name": "two"})
    last, first = of_return(halves)  # the return strand comes from the head
    assert (first.section, last.section) == ("one", "two")
    back = flat({"length": "30 m", "name": "one"}, {"length": "30 m", "name": "two", "horizontal_curve": "right"})
    turned, _ = of_return(back)
    for one, two, both, other in zip(last.states, first.states, bend.states, turned.states, strict=True):
        assert one.inside < two.inside <= both.inside * (1.0 + 1e-6)  # by the highest tension of each half
        assert two.inside == pytest.approx(both.inside, rel=0.1)
        ahead = back.horizontal[-1].states[first.states.index(two)].inside
        assert ahead == pytest.approx(two.inside - one.inside - other.outside, rel=1e-6)


def test_a_flat_set_is_dragged_by_the_part_of_its_guiding_force_along_the_belt():
    """W cos β κ(s/L) sin(s/L), s/L the angle of the course and the sets without skew."""
    (bend,) = of_return(flat({"length": "60 m"}))
    turn = bend.turn
    weight = math.fsum(load.force for load in turn.weights)
    course = turn.drift / 60.0
    assert 0.0 < course < math.radians(3.0)
    held = 0.35 * (1.0 - (1.0 - course / math.radians(3.0)) ** 3)
    asked = weight * math.cos(math.radians(1.5)) * held * math.sin(course)
    assert turn.guidance() == pytest.approx(asked, rel=1e-9)


def test_a_flat_strand_falls_off_a_long_curve():
    with pytest.raises(NoSolutionError, match=r"runs off its rolls to the inside .* more banking or a trough"):
        flat({"horizontal_radius": "600 m", "return_banking": "0 deg", "carry_banking": "6 deg"})


def test_a_flat_strand_that_ran_off_in_one_curve_is_off_in_the_next():
    """A storm: no radius of the second curve brings it back, whichever way that one turns."""
    for side in ("left", "right"):
        bends = [CURVE | {"return_banking": "1.5 deg", "length": "30 m", "name": name, "horizontal_curve": turned}
                 for name, turned in (("one", side), ("two", "left"))]  # fmt: skip
        route = {"sections": [*bends, {"name": "c", "length": "200 m", "lift": "10 m"}], "pulleys": PULLEYS}
        given = data(idlers=FLAT, route=route, ambient={"wind_speed": "60 m/s"}, calculation={"strain": "off"})
        second, first = sorted(of_return(calculate(from_data(given))), key=lambda bend: bend.section)
        assert (first.section, second.section) == ("two", "one")  # the return strand comes from the head
        for bend in (first, second):
            assert {(state.inside, state.outside) for state in bend.states} == {(math.inf, -math.inf)}
        assert {(state.least, state.most) for state in second.states} == {(math.inf, 0.0)}


def test_rolls_that_hold_no_belt_are_refused_in_a_curve():
    pair = {"rolls": 2, "spacing": "3 m", "roll": _ROLL}
    bad = data(idlers={"return": pair}, route={"sections": [CURVE], "pulleys": PULLEYS})
    with pytest.raises(InputError, match=r"idlers.return.trough_angle: got 0 deg, .*take a trough, or rolls: 1"):
        from_data(bad)


def garland(**changes):
    """Carry sets of five rolls in the curve."""
    roll = DATA["idlers"]["carry"]["roll"] | {"length": "230 mm"}
    carry = {
        "rolls": 5,
        "trough_angle": "55 deg",
        "inner_trough_angle": "25 deg",
        "share_rule": "cross-section",
    }
    idlers = BACK | {"carry": DATA["idlers"]["carry"] | carry | {"roll": roll} | changes}
    sections = [CURVE, {"name": "c", "length": "200 m", "lift": "10 m"}]
    return from_data(
        data(idlers=idlers, route={"sections": sections, "pulleys": PULLEYS}, calculation={"strain": "off"})
    )


def test_a_garland_of_five_holds_its_belt_in_a_curve(found):
    """Its drift balances the pull, and is less than in a flatter trough; level inner wings push as the middle does."""
    five = calculate(garland())
    bend = five.horizontal[0]
    (stretch,) = (s for s in five.line.stretches if (s.section, s.strand) == ("bend", "carry"))
    steady = five.balance.equilibrium.steady
    i = list(five.line.loop.stretches).index(stretch)
    pull = 0.5 * (steady.starts[i] + steady.ends[i]) - stretch.line_mass * 4.0**2
    held = bend.turn.law(0.0, least=False).force(bend.turn.drift)
    assert held == pytest.approx(2.0 * pull * math.sin(stretch.spacing / 3600.0), rel=1e-5)
    assert len(stretch.loads) == 5
    assert abs(bend.turn.drift) < abs(found.horizontal[0].turn.drift)  # a deeper trough
    carry, back = across(five.conveyor, five.line).axes
    assert (len(carry.patches), len(back.patches)) == (6, 2)  # five rolls and the bulk; a V
    x, y = carry.patches[-1].get_xy().T / 1e3
    area = abs(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2.0
    # 1200 t/h at 4 m/s, 1.6 t/m³; 40 chords leave 1/1600 of the heap
    assert area == pytest.approx(1200.0 / 3.6 / 4.0 / 1600.0, rel=1.0 / 1600.0)
    level = calculate(garland(inner_trough_angle="0 deg", trough_angle="35 deg"))
    assert abs(level.horizontal[0].turn.drift) > abs(bend.turn.drift)
    assert level.horizontal[0].turn.slopes[1:4] == pytest.approx([math.sin(math.radians(3.0))] * 3)


def test_more_than_half_a_turn_is_refused():
    with pytest.raises(InputError, match=r"turn by 344 deg, more than 180 deg in a section: take 95.493 m or more"):
        from_data(data(idlers=BACK, route={"sections": [CURVE | {"horizontal_radius": "50 m"}], "pulleys": PULLEYS}))


def test_before_the_drift_is_known_no_pull_presses_on_the_rolls():
    """Of 5 deg of skew the centred belt is pushed outward by more than its tension ever draws it inward."""
    made = conveyor({"carry_skew": "5 deg", "carry_banking": "0 deg"})
    lane = conveyor(dict.fromkeys(("horizontal_curve", "horizontal_radius", "carry_banking", "return_banking")))
    curved, straight = (Strands.of(one).each[0].stretches[1] for one in (made, lane))
    assert curved.loads == straight.loads
    assert min(load.force for load in calculate(made).line.stretches[1].loads) > 0.0
