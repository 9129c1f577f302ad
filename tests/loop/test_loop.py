"""The loop closes in every state; every drive grips; take-ups hold; nothing depends on how it is written."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from conveyor.laws import tension
from conveyor.laws.resistance import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.loop.start_and_stop import motion_states, start_and_stop
from conveyor.units import quantity, si
from tests.loop.loop_lines import BOOSTER, DATA, DOWN, SECOND, TAIL_DRIVE, along, balanced, closed, line, told

CLOSED = 1e-9
"""Of the largest tension: the figure the package promises; rounding alone leaves about 1e-14."""

ROUNDING = 1e-11
"""Of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16."""

ROUTE, DRIVE = DATA["route"], DATA["drive"]
CASES = {
    "one drive": {},
    "tail drive alone": {"drive": {"position": "tail"}},
    "drive on the return strand": {"drive": {"position": "return", "section": "d"}},
    "brake and flywheel": {"drive": {"brake_force": "60 kN", "reduced_mass": "20 t"}},
    "two at the head": {"drive": {"further_drives": [SECOND]}},
    "head, booster, tail": {"drive": {"further_drives": [BOOSTER, TAIL_DRIVE]}},
    "gravity at the tail": {"route": {"take_up": {"kind": "gravity", "position": "tail"}}},
    "fixed": {"route": {"take_up": {"kind": "fixed"}}, "drive": {"further_drives": [BOOSTER]}},
    "winch on the return strand": {"route": {"take_up": {"kind": "winch", "position": "return", "section": "b"}}},
    "downhill": {"route": {"sections": DOWN, "pulleys": ROUTE["pulleys"][:3]}, "drive": {"brake_force": "120 kN"}},
    "downhill, head and tail": {
        "route": {
            "sections": DOWN, "pulleys": ROUTE["pulleys"][:3],
            "take_up": {"kind": "gravity", "position": "head"},
        },
        "drive": {"further_drives": [TAIL_DRIVE | {"brake_force": "90 kN"}], "reduced_mass": "8 t"},
    },
    "two feeding points": {
        "route": {
            "feeding": ROUTE["feeding"] | {"share": 0.7},
            "further_feeding": [ROUTE["feeding"] | {"section": "c", "share": 0.3}],
        },
    },
}  # fmt: skip


@pytest.fixture(scope="module", params=CASES, ids=list(CASES))
def case(request):
    conveyor = line(**CASES[request.param])
    return conveyor, closed(conveyor)


def _boundary(conveyor, position, section):
    names = [s.name for s in conveyor.route.sections]
    n = len(names)
    return {"head": 2 * n, "tail": n, "carry": n + 1 + names.index(section or names[0]),
            "return": n - names.index(section or names[0])}[position]  # fmt: skip


def test_a_state_of_motion_is_there_once(case):
    _, found = case
    names = [state.name for state in motion_states(found, start_and_stop(found))]
    assert len(names) == len(set(names))
    assert {"steady", "brakes on"} <= set(names) or not any(found.line.brakes)


def test_the_loop_closes_in_every_state(case):
    """Resistances, masses and drives, summed anew from what went in, bring the tension back to where it began."""
    _, found = case
    moving, results = start_and_stop(found), along(found)
    n = len(results) // 2
    order = (*results[n:], *results[:n])
    for state in (*found.equilibrium.states.values(), *moving.states.values()):
        level = state.leaving
        for i, result in enumerate(order):
            roll_mass = 12.0 / 1.2 if result.stretch.strand == "carry" else 9.0 / 3.0
            mass = result.stretch.length * (result.stretch.line_mass + roll_mass)
            step = result.lift + state.friction * (result.total - result.lift) + state.acceleration * mass
            assert state.ends[i] - state.starts[i] == pytest.approx(step, rel=CLOSED, abs=CLOSED * state.largest)
            level += step
        level += sum(
            single.total * (1.0 if "acceleration" in single.name else state.friction) for single in found.singles
        )
        level -= sum(side.force for side in state.drives)
        assert level == pytest.approx(state.leaving, abs=CLOSED * state.largest), state.name
        assert state.force == pytest.approx(sum(side.force for side in state.drives), rel=1e-14)


def test_the_points_follow_the_belt_round_the_loop(case):
    _, found = case
    steady, last = found.equilibrium.steady, found.layout.boundaries[-1]
    tensions = {point.place: point.tension for point in found.tension_points}
    assert len(tensions) == len(found.tension_points)
    assert (np.diff([point.distance for point in found.tension_points]) >= 0.0).all()
    for stretch, start, end in zip(found.line.loop.stretches, steady.starts, steady.ends, strict=True):
        name = f"{stretch.section}, {stretch.strand}"
        assert (tensions[f"{name}, start"], tensions[f"{name}, end"]) == (start, end)
    at_head = []
    for drive, side in zip(found.line.drives, steady.drives, strict=True):
        if drive.spot.boundary == last:
            at_head.append(side.arriving)
        else:
            taken = tensions[f"{drive.name}, arriving"] - tensions[f"{drive.name}, leaving"]
            assert taken == pytest.approx(side.force, abs=CLOSED * steady.largest)
    # nothing stands between the end of the carry strand and a head pulley that is not driven
    assert (found.tension_points[-1].place, found.tension_points[-1].tension) == (
        ("drive, arriving", pytest.approx(at_head[0], rel=CLOSED))
        if at_head
        else ("head, arriving", pytest.approx(steady.ends[-1], rel=CLOSED))
    )


def test_drives_give_what_the_conveyor_takes(case):
    conveyor, found = case
    sides = found.equilibrium.steady.drives
    taken = math.fsum(r.total for r in along(found)) + math.fsum(s.total for s in found.singles)
    assert found.forces.total == pytest.approx(taken, rel=1e-12)
    assert sum(side.force for side in sides) == pytest.approx(found.forces.total, rel=1e-12)
    assert found.power.belt == pytest.approx(sum(s.force for s in sides) * si(conveyor.belt.speed), rel=1e-12)
    for side in sides:
        assert side.arriving - side.leaving == pytest.approx(side.force, rel=1e-9)


def test_every_drive_grips_no_stretch_sags_and_nothing_is_given_away(case):
    _, found = case
    settled = found.equilibrium
    for state in settled.states.values():
        for drive, side in zip(found.line.drives, state.drives, strict=True):
            assert side.tight / side.slack <= math.exp(drive.friction * drive.wrap_angle) * (1.0 + 1e-12)
        if state.acceleration == 0.0:
            lowest = np.minimum(state.starts, state.ends)
            assert np.all(lowest >= found.line.loop.least * (1.0 - 1e-12))
    # the least setting: one condition holds exactly, and the figure is that condition's
    margins = [settled.setting - needed for needed in settled.conditions.values()]
    assert min(margins) == pytest.approx(0.0, abs=1e-9 * settled.setting)
    governing = settled.conditions[settled.governing]
    assert governing == pytest.approx(settled.needed, rel=ROUNDING)


def test_the_take_up_holds_what_it_holds(case):
    conveyor, found = case
    settled = found.equilibrium
    take_up = conveyor.route.take_up
    length = found.line.loop.length
    for state in (*settled.states.values(), *start_and_stop(found).states.values()):
        if take_up is None:
            # behind all drives at the first one's place, before them where they brake in steady running: in every state
            first = found.line.drives[0].spot
            pairs = zip(found.line.drives, state.drives, strict=True)
            beside = [side for drive, side in pairs if drive.spot == first]
            held = beside[-1].leaving if found.forces.total >= 0.0 else beside[0].arriving
        elif take_up.kind == "fixed":
            held = float((0.5 * (state.starts + state.ends)) @ length / length.sum())
        else:
            boundary = _boundary(conveyor, take_up.position, take_up.section)
            held = float(state.starts[boundary % len(state.starts)])
            if take_up.position == "tail":  # the bulk lands behind it
                held -= sum(
                    s.total * (1.0 if "acceleration" in s.name else state.friction)
                    for s in found.singles
                    if "bulk" in s.name or "skirts" in s.name
                )
        assert held == pytest.approx(settled.setting, rel=1e-12), state.name


def test_one_drive_is_the_law():
    found = balanced()
    law = tension.drive_tensions(
        found.forces.total, friction=0.35, wrap_angle=math.radians(200.0), start_factor=1.3, slack_for_sag=0.0
    )
    assert (found.tensions.slack, found.tensions.tight_start) == pytest.approx((law.slack, law.tight), rel=1e-12)
    assert found.tensions.governed_by == "grip"
    assert found.equilibrium.governing == "grip, drive, start"


def test_two_drives_at_the_head_are_the_law_of_the_row():
    """Euler-Eytelwein drive by drive: slack behind the last one is the most of F_i/(e^(μα) - 1) less what is behind."""
    found = balanced(drive={"further_drives": [SECOND]})
    force = 1.3 * 0.5 * found.forces.total
    first, second = (force / math.expm1(grip) for grip in (0.35 * math.radians(200.0), 0.3 * math.pi))
    assert second > first - force
    assert found.equilibrium.governing == "grip, second, start"
    # without a take-up the first drive's slack side, the second's tight one, is held
    start = found.equilibrium.states["start"]
    assert start.drives[1].leaving == pytest.approx(second, rel=1e-12)


def test_force_is_shared_by_power_or_as_told():
    by_power = balanced(drive={"further_drives": [BOOSTER, TAIL_DRIVE]})
    forces = [side.force for side in by_power.equilibrium.steady.drives]
    assert forces == pytest.approx([by_power.forces.total * s for s in (4 / 7, 2 / 7, 1 / 7)], rel=1e-12)
    told = balanced(drive={"share": 0.25, "further_drives": [BOOSTER | {"share": "75 %"}]})
    assert told.equilibrium.steady.drives[0].force == pytest.approx(0.25 * told.forces.total, rel=1e-12)


def test_a_booster_takes_tension_out_of_the_belt():
    alone, helped = balanced(), balanced(drive={"further_drives": [BOOSTER]})
    assert helped.tensions.largest < alone.tensions.largest
    # its wrap apart, which the lower tension changes, the force is that of the conveyor
    assert helped.forces.main == pytest.approx(alone.forces.main, rel=ROUNDING)
    assert helped.forces.total == pytest.approx(alone.forces.total, rel=5e-3)


@pytest.mark.parametrize("name", list(CASES))
def test_splitting_a_section_renaming_and_units_change_nothing(name):
    conveyor = line(**CASES[name])
    before = closed(conveyor)
    old = conveyor.route.sections[0]
    halves = [old.replace(name=n, length=quantity("60 m" if len(conveyor.route.sections) == 4 else "50 m"))
              for n in ("new one", "new two")]  # fmt: skip
    route = conveyor.route.replace(sections=[*halves, *conveyor.route.sections[1:]])
    belt = conveyor.belt.replace(width="1 m", speed="14.4 km/h")
    split = conveyor.replace(route=route, belt=belt, material=conveyor.material.replace(flow="1200000 kg/h"))
    after = closed(split)
    assert after.forces.total == pytest.approx(before.forces.total, rel=1e-12)
    assert after.equilibrium.setting == pytest.approx(before.equilibrium.setting, rel=1e-11)
    assert after.tensions.largest == pytest.approx(before.tensions.largest, rel=1e-11)
    for state, same in zip(after.equilibrium.states.values(), before.equilibrium.states.values(), strict=True):
        assert state.acceleration == pytest.approx(same.acceleration, rel=1e-10, abs=1e-15)
        assert state.smallest == pytest.approx(same.smallest, rel=1e-11)


def test_a_belt_that_drives_gives_its_motor_what_the_train_leaves():
    found = balanced(**CASES["downhill"] | {"drive": {"regeneration_efficiency": "88 %"}})
    assert found.power.motor == pytest.approx(0.88 * found.power.belt, rel=1e-14)
    same = balanced(**CASES["downhill"] | {"drive": {}}).power
    assert same.motor == pytest.approx(0.94 * found.power.belt, rel=1e-14)
    driven = balanced(drive={"regeneration_efficiency": "88 %"}).power.motor
    assert driven == pytest.approx(balanced().power.motor, rel=ROUNDING)


def test_bulk_lies_behind_its_feeding_points_only():
    conveyor = line(**CASES["two feeding points"])
    whole = 1200.0 / 3.6 / 4.0
    found = closed(conveyor)
    carry = found.line.stretches[:4]
    assert [s.bulk_mass / whole for s in carry] == pytest.approx([0.7, 0.7, 1.0, 1.0], rel=1e-15)
    inertia = {s.name: s.total for s in found.singles if "acceleration" in s.name}
    one = next(s.total for s in balanced().singles if "acceleration" in s.name)
    assert inertia["acceleration of the bulk, first"] == pytest.approx(0.7 * one, rel=1e-14)
    assert inertia["acceleration of the bulk, c"] == pytest.approx(0.3 * one, rel=1e-14)
    late = line(route={"feeding": ROUTE["feeding"] | {"section": "c"}})
    assert [s.bulk_mass for s in closed(late).line.stretches[:4]] == pytest.approx([0.0, 0.0, whole, whole], rel=1e-15)


def test_least_friction_is_on_the_safe_side():
    conveyor = line(**CASES["downhill"])
    found = closed(conveyor)
    lift = math.fsum(r.lift for r in along(found))
    certain = next(s.total for s in found.singles if "acceleration" in s.name)
    expected = lift + certain + 0.6 * (found.forces.total - lift - certain)
    assert found.equilibrium.least_force == pytest.approx(expected, rel=1e-12)
    assert found.equilibrium.least_force < found.forces.total < 0.0
    full = balanced(**CASES["downhill"] | {"drive": {"least_friction": 1.0}})
    assert full.tensions.slack < found.tensions.slack
    assert set(full.equilibrium.states) == {"steady", "braking"}


def test_a_given_take_up_is_held_and_judged():
    needed = balanced(route={"take_up": {"kind": "gravity", "position": "head"}}).equilibrium.needed
    for factor, short in ((1.05, False), (0.9, True)):
        conveyor = line(route={"take_up": {"kind": "gravity", "position": "head", "tension": f"{factor * needed} N"}})
        found = closed(conveyor)
        assert found.equilibrium.steady.starts[0] == pytest.approx(factor * needed, rel=1e-12)
        held = [w for w in told(conveyor, found) if w.startswith("the take-up holds")]
        assert bool(held) == short
        if short:
            assert any("grip, drive, start" in w and "requires" in w for w in held)
    mass = line(route={"take_up": {"kind": "gravity", "position": "head", "mass": "10 t", "reeving": 2.0}})
    assert closed(mass).equilibrium.setting == pytest.approx(10e3 * 9.81, rel=1e-15)


def slack_line(tension, **changes):
    """The line of these tests with a winch at the tail that holds too little."""
    return line(route={"take_up": {"kind": "winch", "position": "tail", "tension": f"{tension} N"}, **changes})


def test_a_slack_belt_is_calculated_and_fails_with_what_would_cure_it():
    found = closed(slack_line(100.0), 0.03)
    lowest = min(state.smallest for state in motion_states(found, start_and_stop(found)))
    assert lowest < 0.0
    (words,) = {w for w in told(slack_line(100.0), found) if w.startswith("the belt goes slack") and '"start"' in w}
    cured = float(re.search(r"from 100 N to about ([\d.]+) kN", words).group(1)) * 1e3
    start = found.equilibrium.states["start"].smallest
    assert cured == pytest.approx(100.0 - start, rel=5e-3)  # three digits
    # there nothing is slack but by what the tension adds to the resistance of the pulleys, which a start raises by 1.3
    added = 1.3 * sum(bend.wrap[1] + 2.0 * (bend.bearings or 0.0) for bend in found.layout.bends)
    again = closed(slack_line(cured), 0.03).equilibrium.states["start"].smallest
    assert abs(again) < (added + 5e-3) * cured


def test_tensions_of_a_slack_belt_are_straight_lines():
    """Without wraps and bearings a loop is linear in the setting, above and below no tension."""
    found = balanced(calculation={"secondary": "C"}, route={"take_up": {"kind": "winch", "position": "tail"}})

    def tensions(setting):
        steady = found.held(setting).equilibrium.steady
        return np.append(steady.starts, steady.ends)

    taut, slack = tensions(200e3), tensions(100.0)
    assert slack.min() < 0.0 < taut.min()
    assert slack == pytest.approx(taut - 199.9e3, abs=CLOSED * 200e3)


def test_a_slack_belt_loads_its_pulleys_as_one_without_tension():
    """At -1 MN the belt is slack everywhere: each pulley has the wrap of no tension and bears its own weight."""
    found = balanced().held(-1e6)
    assert found.tensions.largest < 0.0
    for pulley, resistance in zip(found.line.pulleys, found.equilibrium.bends, strict=True):
        # ISO 5048, steel cord: 12 B (200 + 0.01 F/B) d/D [N, m], F = 0; F_t = 0.005 d0/D G
        wrap = 12.0 * 1.0 * 200.0 * 0.015 / pulley.diameter
        turn = 0.0 if pulley.driven else 0.005 * pulley.shaft_diameter / pulley.diameter * pulley.mass * 9.81
        assert resistance == pytest.approx(wrap + turn, rel=ROUNDING), pulley.name


def test_the_numbers_follow_the_conveyor_not_its_predecessor():
    """Numbers kept for a conveyor serve that one only, and stretches made anew are read anew."""
    one, other = line(), line(drive={"friction": 0.2})
    first = closed(one).tensions.slack
    assert closed(other).tensions.slack > first
    assert closed(one).tensions.slack == pytest.approx(first, rel=ROUNDING)


def test_start_and_stop_are_newton():
    conveyor = line(drive={"reduced_mass": "20 t", "torque_factor": 1.5, "start_factor": 1.4})
    found = closed(conveyor)
    moving = start_and_stop(found)
    mass = sum(s.length * (s.line_mass + (10.0 if s.strand == "carry" else 3.0)) for s in found.line.stretches)
    assert moving.moving_mass == pytest.approx(mass, rel=1e-12)
    force = found.forces.total
    assert moving.start.acceleration == pytest.approx(0.4 * force / mass, rel=1e-12)
    motors = (1.4 * force + 20e3 * moving.start.acceleration) * 4.0 / (0.94 * 400e3)
    assert moving.start.torque_factor == pytest.approx(motors, rel=1e-12)
    assert moving.coasting is not None
    assert moving.coasting.deceleration == pytest.approx(force / (mass + 20e3), rel=1e-12)
    # rolls that have stood turn harder
    stuck = (ROLL_DRAG_STANDSTILL_FACTOR - 1.0) * found.forces.parts["idler_rotation"]
    assert moving.start.breakaway == pytest.approx(force + stuck, rel=1e-12)
    # energy: what moved is spent on the way
    kinetic = 0.5 * (mass + 20e3) * 4.0**2
    assert force * moving.coasting.distance == pytest.approx(kinetic, rel=1e-12)
    # the drives' masses push the belt while it slows down
    push = moving.states["drives off"].drives[0].force
    assert push == pytest.approx(20e3 * moving.coasting.deceleration, rel=1e-12)


def test_brakes_hold_and_stop_a_downhill_conveyor():
    wanted = {"stop_deceleration": "0.2 m/s^2", "reduced_mass": "8 t"}
    none = line(**CASES["downhill"] | {"drive": wanted})
    moving = start_and_stop(closed(none))
    assert moving.coasting is None
    assert moving.coasting_least is None
    assert not moving.rolls_back
    assert moving.brake_to_stop is not None
    said = told(none, closed(none))
    assert any(w.startswith("the conveyor does not stop by itself and has no brake") for w in said)
    assert any("needs a brake of" in w for w in said)
    held = line(**CASES["downhill"] | {"drive": {"brake_force": f"{moving.brake_to_stop} N", **wanted}})
    stopped = start_and_stop(closed(held)).braked
    assert stopped is not None
    # the brake's own grip asks for tension, wraps for 1e-4 of force with it
    assert stopped.deceleration == pytest.approx(0.2, rel=1e-3)
    weak = line(**CASES["downhill"] | {"drive": {"brake_force": "10 kN"}})
    assert "brakes of 10 kN do not stop the conveyor" in told(weak, closed(weak))


def test_bulk_slides_where_friction_ends():
    steep = line(route={"sections": [{"name": "s", "length": "50 m", "slope": "20 deg"}], "pulleys": []},
                 drive={"start_factor": 2.5})  # fmt: skip
    found = closed(steep)
    slip = start_and_stop(found).slip
    assert slip is not None
    grip, pull = 0.5 * 9.81 * math.cos(math.radians(20.0)), 9.81 * math.sin(math.radians(20.0))
    assert (slip.braking, slip.starting) == pytest.approx((-grip - pull, grip - pull), rel=1e-9)
    assert any(w.startswith("the material slips on starting") for w in told(steep, found))
    steeper = line(route={"sections": [{"name": "s", "length": "50 m", "slope": "30 deg"}], "pulleys": []})
    assert (start_and_stop(closed(steeper)).slip.braking, start_and_stop(closed(steeper)).slip.starting) == (
        0.0,
        0.0,
    )
    said = told(steeper, closed(steeper))
    assert 'the material slips on the belt in section "s" at any speed: too steep for its friction' in said
