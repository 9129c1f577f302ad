"""Starts by the motors, drives' masses, brakes, a power failure, trippers: all by hand."""

from __future__ import annotations

import copy
import math

import pytest

from conveyor.laws.motion import run_up_time
from conveyor.loop.start_and_stop import start_and_stop
from conveyor.loop.tensions import STEADY
from tests.loop.loop_lines import BOOSTER, DATA, DOWN, balanced, closed, line, told

ROUNDING = 1e-11
RATED = 400e3 * 0.94 / 4.0
"""Force of the motors at the belt: 400 kW through 94 % at 4 m/s [N]."""


def started(found):
    return found.equilibrium.states["start"]


def test_an_uncontrolled_start_brings_all_torque_to_the_belt_but_what_the_drive_keeps():
    """1.8 × 94 kN less 10 t times the acceleration that it makes of belt and drive together."""
    found = balanced(drive={"torque_factor": 1.8, "reduced_mass": "10 t"})
    mass, steady = found.line.loop.mass.sum(), found.equilibrium.force
    acceleration = (1.8 * RATED - steady) / (mass + 10e3)
    start = start_and_stop(found).start
    assert start.acceleration == pytest.approx(acceleration, rel=ROUNDING)
    assert started(found).force == pytest.approx(1.8 * RATED - 10e3 * acceleration, rel=ROUNDING)
    assert started(found).force == pytest.approx(steady + mass * acceleration, rel=ROUNDING)  # Newton, of the belt
    assert start.torque_factor == pytest.approx(1.8, rel=ROUNDING)
    assert start.time == pytest.approx(4.0 / acceleration, rel=ROUNDING)
    assert found.tensions.tight_start - found.tensions.tight > 0.5 * (1.8 * RATED - steady)


def test_a_controlled_start_is_limited_by_the_motors():
    """3 times the steady force is more than 1.2 times the rated: the factor solves k F = f W + m (f - 1) W/M."""
    drive = {"start_factor": 3.0, "torque_factor": 1.2, "reduced_mass": "10 t"}
    conveyor = line(drive=drive)
    found = closed(conveyor)
    mass, steady = found.line.loop.mass.sum(), found.equilibrium.force
    factor = (1.2 * RATED / steady + 10e3 / mass) / (1.0 + 10e3 / mass)
    assert 1.0 < factor < 3.0
    start = start_and_stop(found).start
    assert start.factor == pytest.approx(factor, rel=ROUNDING)
    assert started(found).force == pytest.approx(factor * steady, rel=ROUNDING)
    assert start.asked == pytest.approx(3.0 * steady + 10e3 * 2.0 * steady / mass, rel=ROUNDING)
    assert any("it is limited to" in why for why in told(conveyor, found))
    free = balanced(drive={"start_factor": 3.0, "reduced_mass": "10 t"})
    assert started(free).force == pytest.approx(3.0 * free.equilibrium.force, rel=ROUNDING)
    assert start_and_stop(free).start.least is None  # what its motors give over speed is not known


def test_the_weakest_of_several_motors_limits_a_controlled_start():
    """Shares by hand, 400 and 200 kW: the second has to give half the force with a third of the power."""
    booster = BOOSTER | {"share": "50 %"}
    drive = {"start_factor": 4.0, "torque_factor": 1.5, "share": "50 %", "further_drives": [booster]}
    conveyor = line(drive=drive)
    found = closed(conveyor)
    weak = 1.5 * RATED / 2.0
    forces = [side.force for side in started(found).drives]
    assert forces == pytest.approx([weak, weak], rel=ROUNDING)
    assert start_and_stop(found).start.least == pytest.approx(2.0 * weak, rel=ROUNDING)
    assert any("it is limited to" in why for why in told(conveyor, found))


def test_uncontrolled_drives_share_by_their_torque_not_by_their_shares():
    booster = BOOSTER | {"share": "50 %"}
    found = balanced(drive={"torque_factor": 1.5, "share": "50 %", "further_drives": [booster]})
    first, second = started(found).drives
    assert (first.force, second.force) == pytest.approx((1.5 * RATED, 1.5 * RATED / 2.0), rel=ROUNDING)


CURVE = [{"speed": "0 %", "torque": 1.5}, {"speed": "40 %", "torque": 1.3}, {"speed": "85 %", "torque": 2.4}]


def test_a_torque_curve_starts_with_its_peak_in_the_tensions_and_its_run_up_in_the_time():
    """The time by a Riemann sum of m dv/F over the curve drawn by hand; its error is below the width of a step."""
    conveyor = line(drive={"torque_curve": CURVE, "reduced_mass": "10 t"})
    found = closed(conveyor)
    mass, steady = found.line.loop.mass.sum() + 10e3, found.equilibrium.force
    start = start_and_stop(found).start
    assert start.available == pytest.approx(2.4 * RATED, rel=ROUNDING)
    assert start.least == pytest.approx(1.3 * RATED, rel=ROUNDING)
    assert start.acceleration == pytest.approx((2.4 * RATED - steady) / mass, rel=ROUNDING)
    assert start.standstill == pytest.approx(1.5 * RATED - 10e3 * (1.5 * RATED - steady) / mass, rel=ROUNDING)

    def torque(over):
        if over < 0.4:
            return 1.5 - 0.5 * over
        return 1.3 + 1.1 * (over - 0.4) / 0.45 if over < 0.85 else 2.4

    steps = 20000
    middles = [(i + 0.5) / steps for i in range(steps)]
    time = math.fsum(mass * 4.0 / steps / (torque(over) * RATED - steady) for over in middles)
    assert start.time == pytest.approx(time, rel=1e-6)  # the midpoint rule's error goes with the step squared
    assert not any("run-up" in why for why in told(conveyor, found))


def test_motors_that_get_stuck_on_their_way_fail():
    weak = [
        {"speed": "0 %", "torque": 1.5},
        {"speed": "40 %", "torque": 0.3},
        {"speed": "90 %", "torque": 2.4},
    ]
    conveyor = line(drive={"torque_curve": weak})
    found = closed(conveyor)
    assert start_and_stop(found).start.time is None
    assert any("during run-up" in why for why in told(conveyor, found))


def test_run_up_under_a_falling_force_is_the_exponential_of_a_viscous_drag():
    """F = F0 - c v: v = F0/c (1 - exp(-c t/m)), so that t = m/c ln(F0/(F0 - c v))."""
    time = run_up_time([0.0, 2.0], [10e3, 4e3], mass=30e3)
    assert time == pytest.approx(30e3 / 3e3 * math.log(10.0 / 4.0), rel=ROUNDING)
    halves = run_up_time([0.0, 1.0, 2.0], [10e3, 7e3, 4e3], mass=30e3)
    assert halves == pytest.approx(time, rel=ROUNDING)


def test_masses_of_a_drive_not_given_are_typical_of_its_power_and_flagged():
    """2 × 0.25 s × 400 kW/(4 m/s)² = 12.5 t."""
    given = copy.deepcopy(DATA["drive"])
    del given["reduced_mass"]
    conveyor = line()
    conveyor = conveyor.replace(drive=given)
    found = closed(conveyor)
    assert found.line.drives[0].reduced_mass == pytest.approx(12.5e3, rel=ROUNDING)
    assert start_and_stop(found).rotating_mass == pytest.approx(12.5e3, rel=ROUNDING)
    assert not found.line.drives[0].mass_given


def test_an_inertia_acts_by_the_gear_and_the_pulley():
    """3 kg m² × (20/0.5 m)² = 4.8 t; the pulley is the 1000 mm one of the route at the head."""
    given = {name: value for name, value in DATA["drive"].items() if name != "reduced_mass"}
    made = DATA | {"drive": given | {"inertia": "3 kg*m^2", "gear_ratio": 20.0}}
    from conveyor.spec import from_data

    assert closed(from_data(made)).line.drives[0].reduced_mass == pytest.approx(4.8e3, rel=ROUNDING)


def downhill(**drive):
    return line(route={"sections": DOWN}, drive={"installed_power": "1 MW", "reduced_mass": "5 t"} | drive)


def test_without_power_a_downhill_belt_runs_away_and_its_brakes_stop_it_after_their_delay():
    conveyor = downhill(brake_force="400 kN", brake_delay="2 s")
    found = closed(conveyor)
    moving, mass = start_and_stop(found), found.line.loop.mass.sum() + 5e3
    least = found.equilibrium.least_force
    assert least < 0.0
    assert moving.coasting_least is None
    assert moving.runaway == pytest.approx(-least / mass, rel=ROUNDING)
    fast = 4.0 + moving.runaway * 2.0
    assert moving.gripping_speed == pytest.approx(fast, rel=ROUNDING)
    slowing = (400e3 + least) / mass
    assert moving.braked.time == pytest.approx(2.0 + fast / slowing, rel=ROUNDING)
    assert moving.braked.distance == pytest.approx(0.5 * (4.0 + fast) * 2.0 + fast**2 / (2.0 * slowing), rel=ROUNDING)
    # energy: the brakes take what the belt had when they gripped, and what gravity gave less friction on the way
    energy = 0.5 * mass * fast**2 - least * fast**2 / (2.0 * slowing)
    assert moving.braking_heat == pytest.approx(energy, rel=ROUNDING)
    assert not any("runs away" in why for why in told(conveyor, found))
    free = downhill()
    assert any("runs away" in why for why in told(free, closed(free)))


def test_a_level_belt_rests_before_slow_brakes_grip():
    found = balanced(drive={"brake_force": "10 kN", "brake_delay": "60 s"})
    moving = start_and_stop(found)
    assert moving.gripping_speed == 0.0
    assert moving.braking_heat == 0.0
    assert moving.braked == moving.coasting_least


TRIPPER = {
    "section": "c",
    "speed": "1 m/s",
    "skirt_length": "3 m",
    "skirt_width": "600 mm",
    "tripper_lift": "4 m",
}
UP = {"name": "up", "position": "carry", "section": "b", "diameter": "800 mm", "shaft_diameter": "160 mm",
      "mass": "1 t"}  # fmt: skip


def test_a_tripper_lifts_its_bulk_before_the_booster_and_speeds_it_up_behind():
    """1200 t/h at 4 m/s are 83.3 kg/m: 4 m of lift 3.27 kN; from 1 to 4 m/s 1 kN."""
    without = balanced(drive={"further_drives": [BOOSTER]})
    route = {"further_feeding": [TRIPPER]}
    found = balanced(route=route, drive={"further_drives": [BOOSTER]})
    added = {force.name: force for force in found.singles if "tripper" in force.name or force.name.endswith(", c")}
    gravity, flow = found.line.gravity, 1200.0 / 3.6
    assert added["lift over the tripper, c"].total == pytest.approx(flow / 4.0 * gravity * 4.0, rel=ROUNDING)
    assert added["acceleration of the bulk, c"].total == pytest.approx(flow * 3.0, rel=ROUNDING)
    lift = found.forces.lift - without.forces.lift
    assert lift == pytest.approx(flow / 4.0 * gravity * 4.0, rel=1e-9)  # of a difference of larger sums
    assert [s.bulk_mass for s in found.line.stretches[:4]] == pytest.approx([flow / 4.0] * 4, rel=ROUNDING)
    # at rest too the bulk hangs on the tripper's slope; what accelerates it is gone
    assert start_and_stop(found).brake_to_hold > start_and_stop(without).brake_to_hold


def test_the_tension_round_a_tripper_closes_by_hand():
    """Arriving at the booster: the end of section b and the bulk's lift; leaving: less its force; then acceleration."""
    found = balanced(route={"further_feeding": [TRIPPER], "pulleys": []}, drive={"further_drives": [BOOSTER]})
    state = found.equilibrium.states[STEADY]
    singles = {force.name: force.total for force in found.singles}
    names = [(s.section, s.strand) for s in found.line.loop.stretches]
    end, start = state.ends[names.index(("b", "carry"))], state.starts[names.index(("c", "carry"))]
    booster = state.drives[1]
    assert booster.arriving == pytest.approx(end + singles["lift over the tripper, c"], rel=ROUNDING)
    assert booster.leaving == pytest.approx(booster.arriving - booster.force, rel=ROUNDING)
    behind = math.fsum(value for name, value in singles.items() if name.endswith(", c") and "lift" not in name)
    assert start == pytest.approx(booster.leaving + behind, rel=ROUNDING)


def test_bulk_that_leaves_a_turning_belt_and_lands_whole_is_the_same_bulk():
    """Given with a share of 100 % behind a pulley on the carry strand, as with tripper_lift; elsewhere refused."""
    share = {name: value for name, value in TRIPPER.items() if name != "tripper_lift"} | {"share": "100 %"}
    pulleys = [*DATA["route"]["pulleys"], UP]
    first = DATA["route"]["feeding"] | {"share": "100 %"}
    conveyor = line(route={"feeding": first, "further_feeding": [share], "pulleys": pulleys})
    found = closed(conveyor)
    plain = closed(line(route={"further_feeding": [TRIPPER | {"tripper_lift": "0 m"}], "pulleys": pulleys}))
    assert found.forces.total == pytest.approx(plain.forces.total, rel=ROUNDING)
    with pytest.raises(
        Exception, match=r"got a sum of 2, .* of a tripper that feeds back the same bulk give tripper_lift"
    ):
        line(route={"feeding": first, "further_feeding": [share]})
    with pytest.raises(Exception, match="a tripper feeds back all that comes; remove share"):
        line(route={"further_feeding": [TRIPPER | {"share": "50 %"}]})


def test_a_tripper_behind_a_section_without_bulk_has_none():
    sections = [
        section | ({"loaded": False} if section["name"] == "b" else {}) for section in DATA["route"]["sections"]
    ]
    found = balanced(route={"sections": sections, "further_feeding": [TRIPPER]})
    assert not [force for force in found.singles if force.key == "tripper_lift"]
