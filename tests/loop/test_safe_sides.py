"""Criteria are judged on their safe side: with the friction, the motors and the slope that make them worst."""

from __future__ import annotations

import math

import pytest

from conveyor.checks.belt_checks import belt_safety
from conveyor.checks.bulk_checks import bulk_slip, skirtboards
from conveyor.checks.drive_checks import coasting_time, holding_brake
from conveyor.checks.idler_checks import roll_life
from conveyor.checks.pulley_checks import pulley_diameter
from conveyor.default_bands import power_range
from conveyor.errors import InputError
from conveyor.laws.drives import backstop_torque
from conveyor.pipeline import calculate
from conveyor.spec import load
from tests.loop.loop_lines import DATA, DOWN, SECOND, SPECS
from tests.loop.test_pulley_duty import calculated

PARTS = {"pulley_diameter": "1 m", "motor_speed": "1480 rpm", "torque_factor": 1.6}


def drive(**given):
    return {"drive": DATA["drive"] | given}


def test_bulk_slips_at_the_friction_that_brakes_most():
    """Newton: force to design for and brakes over all mass; least friction alone would let it pass."""
    found = calculated(**drive(brake_force="60 kN", design_friction="140 %", least_friction="60 %"))
    moving, settled = found.motions, found.balance.equilibrium
    whole = moving.moving_mass + moving.rotating_mass
    hard = (settled.resistance(1.4) + 60e3) / whole
    assert moving.hardest[0] == pytest.approx(-hard, rel=1e-12)
    assert moving.braked.deceleration < 0.99 * hard
    check = next(check for check in bulk_slip(found) if check.key == "bulk_slip_stopping")
    assert check.calculated == pytest.approx(hard, rel=1e-12)


def test_brakes_that_grip_too_late_do_not_count():
    found = calculated(**drive(brake_force="60 kN", brake_delay="60 s", design_friction="500 %"))
    whole = found.motions.moving_mass + found.motions.rotating_mass
    assert -found.motions.hardest[0] == pytest.approx(found.balance.equilibrium.resistance(5.0) / whole, rel=1e-12)


def test_a_falling_belt_held_by_its_motor_brakes_most_at_the_least_friction():
    found = calculated(route={"sections": DOWN}, **drive(start_factor=1.4, design_friction="120 %"))
    settled = found.balance.equilibrium
    braking = 0.4 * settled.resistance(found.line.least_friction) / settled.mass
    assert braking < 0.4 * settled.force / settled.mass < 0.0
    assert found.motions.hardest[0] == pytest.approx(braking, rel=1e-12)


def test_coasting_is_shortest_with_the_friction_to_design_for():
    found = calculated(**drive(coast_time="20 s", design_friction="150 %"))
    whole = found.motions.moving_mass + found.motions.rotating_mass
    (check,) = coasting_time(found)
    assert check.calculated == pytest.approx(4.0 * whole / found.balance.equilibrium.resistance(1.5), rel=1e-12)
    assert check.calculated < found.motions.coasting.time


def test_a_backstop_bears_the_motors_of_a_drive_that_has_none():
    second = SECOND | {"pulley_diameter": "1 m"}
    alone = calculated(**drive(**PARTS, backstop=True)).drive_duty[0].stalled
    assert alone == pytest.approx(1.6 * 400e3 * 0.94 / 4.0 * 0.5, rel=1e-12)
    found = calculated(**drive(**PARTS, backstop=True, further_drives=[second]))
    assert found.drive_duty[0].stalled == pytest.approx(2.0 * alone, rel=1e-12)
    both = [second | {"backstop": True}]
    assert [duty.stalled for duty in calculated(**drive(**PARTS, backstop=True, further_drives=both)).drive_duty] == (
        pytest.approx([alone, alone], rel=1e-12)
    )
    third = SECOND | {"name": "third", "pulley_diameter": "1 m"}
    of_three = calculated(**drive(**PARTS, backstop=True, further_drives=[*both, third])).drive_duty
    more = backstop_torque(2.0 * alone, radius=0.5, count=2)
    assert of_three[0].stalled == pytest.approx(alone + more, rel=1e-12)


def test_the_belt_is_strong_enough_for_starts_too():
    """A direct start at 2.5 times the rated torque: two thirds of the steady safety is asked there."""
    direct = drive(torque_factor=2.5, installed_power="800 kW")
    found = calculated(**direct)
    steady, every = belt_safety(found)
    strength = 2000e3 * 1.0
    assert steady.required == pytest.approx(1.5 * every.required, rel=1e-12)
    assert every.calculated == pytest.approx(strength / found.balance.tensions.largest, rel=1e-12)
    weak = strength * steady.required / steady.calculated * 1.001 / 1e3
    carcass = DATA["belt"]["carcass"] | {"strength": f"{weak} N/mm"}
    belt = {"belt": DATA["belt"] | {"carcass": carcass}}
    assert [check.failed for check in belt_safety(calculated(**belt, **direct))] == [False, True]
    assert [check.failed for check in belt_safety(calculated(**belt, **drive(start_factor=1.2)))] == [False, False]


@pytest.mark.parametrize(("sections", "groups"), [(None, "ABBC"), (DOWN, "ABAC")])
def test_a_pulley_at_high_tension_is_of_group_a(sections, groups):
    """The tail of a falling belt bears the highest tension of the loop."""
    route = {} if sections is None else {"sections": sections}
    pulleys = [{**each, "section": "b"} if "section" in each else each for each in DATA["route"]["pulleys"]]
    found = calculated(route=route | {"pulleys": pulleys}, **drive(installed_power="1.2 MW"))
    checked = list(pulley_diameter(found))
    assert "".join(check.asked.text().rpartition("group ")[2][0] for check in checked) == groups


@pytest.mark.parametrize("slope", [-0.1, 0.0, 0.1, 0.2])
def test_skirts_reach_until_the_bulk_has_the_speed_of_a_belt_on_a_slope(slope):
    """Newton: g (μ cos δ - sin δ) speeds it up; a falling belt is not spared what ISO 5048 asks of a level one."""
    lift = 400.0 * math.sin(slope)
    route = {"sections": [{"name": "a", "length": "400 m", "lift": f"{lift} m"}],
             "pulleys": DATA["route"]["pulleys"][:3],
             "feeding": DATA["route"]["feeding"] | {"skirtboards": "1 m"}}  # fmt: skip
    (check,) = skirtboards(calculated(route=route))
    speeds, pull = 4.0**2 - 1.0**2, 0.5 * math.cos(slope) - math.sin(slope)
    assert check.required == pytest.approx(speeds / (2.0 * 9.81 * min(pull, 0.5)), rel=1e-9)


def test_skirts_help_no_bulk_that_slides_back():
    route = {"sections": [{"name": "a", "length": "400 m", "lift": "190 m"}],
             "pulleys": DATA["route"]["pulleys"][:3],
             "feeding": DATA["route"]["feeding"] | {"skirtboards": "50 m", "belt_friction": 0.4}}  # fmt: skip
    (check,) = skirtboards(calculated(route=route))
    assert check.failed
    assert "slides back" in check.why.text()


@pytest.mark.parametrize(
    ("cema_class", "kind", "hours"),
    [(None, "ball", 30e3), ("C", "ball", 30e3), ("C", "roller", 60e3), ("D", "ball", 60e3), ("E", "ball", 60e3)],
)
def test_the_life_of_a_set_is_that_of_its_class(cema_class, kind, hours):
    carry = DATA["idlers"]["carry"]
    bearing = {"dynamic_rating": "20 kN", "distance": "340 mm", "kind": kind}
    given = carry | {"roll": carry["roll"] | {"bearing": bearing}} | ({"cema_class": cema_class} if cema_class else {})
    (check,) = roll_life(calculated(idlers=DATA["idlers"] | {"carry": given}))
    assert check.required == pytest.approx(3600.0 * hours, rel=1e-12)


@pytest.mark.parametrize(("rolls", "angle", "coefficient"), [
    (3, 30.0, 0.4), (3, 35.0, 0.4 + 0.1 / 3.0), (3, 45.0, 0.5), (2, 10.0, math.cos(math.radians(10.0))),
])  # fmt: skip
def test_tilted_wings_drag_as_iso_5048_has_it(rolls, angle, coefficient):
    """F_ε = C_ε μ0 L (m'_belt + m'_bulk) g cos δ sin ε; of two rolls cos λ in place of C_ε."""
    given = DATA["idlers"]["carry"] | {"rolls": rolls, "trough_angle": f"{angle} deg", "tilt_angle": "1 deg"}
    given |= {"roll": given["roll"] | {"length": "600 mm" if rolls == 2 else "380 mm"}}
    route = {"sections": [{"name": "a", "length": "400 m"}], "pulleys": DATA["route"]["pulleys"][:3]}
    found = calculated(idlers=DATA["idlers"] | {"carry": given}, route=route, material={"flow": "700 t/h"})
    weight = (20.0 + 700.0 / 3.6 / 4.0) * 9.81
    (tilt,) = [force for force in found.balance.every if force.key == "tilt"]
    assert tilt.total == pytest.approx(coefficient * 0.35 * 400.0 * weight * math.sin(math.radians(1.0)), rel=1e-9)


def test_a_single_roll_has_no_wings_to_tilt():
    back = DATA["idlers"]["return"] | {"tilt_angle": "1 deg"}
    with pytest.raises(InputError, match=r"idlers\.return\.tilt_angle: got 1 deg with rolls: 1"):
        calculated(idlers=DATA["idlers"] | {"return": back})


def test_motors_that_hold_a_falling_belt_are_designed_for_the_least_friction():
    """The less friction, the more they hold."""
    falling, level = (calculate(load(SPECS / name)) for name in ("downhill.yaml", "in_plant_us.yaml"))
    motor, settled, designed = falling.balance.layout.motor, falling.balance.equilibrium, power_range(falling)
    assert designed.design == pytest.approx(motor(settled.least_force), rel=1e-12)
    assert designed.design < motor(settled.design_force) < 0.0
    assert designed.design_friction == falling.line.least_friction
    climbing = level.balance
    assert power_range(level).design == pytest.approx(
        climbing.layout.motor(climbing.equilibrium.design_force), rel=1e-12
    )


def test_a_backstop_without_its_torque_is_not_judged_by_the_brakes():
    def holding(**given):
        (check,) = [check for check in holding_brake(calculated(**drive(**given))) if check.key == "holding_brake"]
        return check.subject.text(), check.verdict

    assert holding(backstop=True, brake_force="1 kN") == ("holding backstop, loaded belt", "not checked")
    assert holding(brake_force="1 kN") == ("holding brake, loaded belt", "FAIL")
    assert holding() == ("holding backstop, loaded belt", "not checked")
    torque = {"backstop_torque": "100 kN*m", "pulley_diameter": "1 m"}
    assert holding(brake_force="1 kN", **torque) == ("holding backstop, loaded belt", "pass")
