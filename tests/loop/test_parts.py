"""Idler sets, covers, take-up and parts of drives, each by hand from the loop's own loads and tensions."""

from __future__ import annotations

import math

import pytest

from conveyor.calculated_conveyor import common_take_up_duty
from conveyor.checks.belt_checks import belt_temperature, cover_thickness, splice_strength
from conveyor.checks.drive_checks import coasting_time, drive_parts, drive_speed
from conveyor.checks.idler_checks import belt_flap, roll_axle, set_rating
from conveyor.checks.tension_checks import take_up_travel
from conveyor.errors import InputError
from conveyor.laws.drives import HORSEPOWER
from conveyor.laws.take_up import SCREW_LENGTH
from conveyor.report.tables import drive_tables
from conveyor.spec import from_data
from conveyor.studies.load_cases import analyse_cases
from conveyor.studies.loads import design_loads
from conveyor.units.sentences import message
from tests.loop.loop_lines import DATA, SECOND
from tests.loop.test_pulley_duty import calculated

BEARING = {
    "dynamic_rating": "20 kN",
    "distance": "340 mm",
    "axle_diameter": "25 mm",
    "support_distance": "390 mm",
}
PARTS = {"pulley_diameter": "1 m", "motor_speed": "1480 rpm"}


def with_carry(**given):
    carry = DATA["idlers"]["carry"]
    roll = carry["roll"] | ({"bearing": given.pop("bearing")} if "bearing" in given else {})
    return calculated(idlers=DATA["idlers"] | {"carry": carry | {"roll": roll} | given})


def only(checks):
    (check,) = checks
    return check


def test_a_conveyor_that_asks_for_nothing_has_nothing():
    plain = calculated()
    assert (plain.set_duty, plain.drive_duty) == ((), ())
    for criterion in (
        set_rating, roll_axle, belt_flap, cover_thickness, belt_temperature, splice_strength, take_up_travel,
        drive_parts, coasting_time,
    ):  # fmt: skip
        assert list(criterion(plain)) == []


@pytest.mark.parametrize(("ratio", "verdict"), [(19.38, "pass"), (18.47, "pass"), (18.45, "FAIL"), (30.0, "FAIL")])
def test_motor_gear_and_pulley_move_the_belt_at_its_speed(ratio, verdict):
    """By hand: 1480 rpm through 19.38 on 1 m are 4.0 m/s, 18.456 are 5 % more."""
    parts = PARTS | {"gear_ratio": ratio, "inertia": "5 kg*m^2", "reduced_mass": None}
    check = only(drive_speed(calculated(drive=DATA["drive"] | parts)))
    rim = math.pi * 1480.0 / 60.0 / ratio
    assert check.calculated == pytest.approx(abs(rim / 4.0 - 1.0), rel=1e-9)
    assert check.verdict == verdict
    assert check.found.text() == message("{}", (rim, "speed")).text()
    assert "fpm" in check.asked.text("US")


def test_a_load_case_of_another_speed_is_led_by_an_inverter():
    parts = PARTS | {"gear_ratio": 19.38, "inertia": "5 kg*m^2", "reduced_mass": None}
    slow = [{"name": "slow", "loading": "empty", "speeds": ["2 m/s"]}]
    made = analyse_cases(from_data(DATA | {"drive": DATA["drive"] | parts, "cases": slow}))
    (case,) = made.results
    assert "drive_speed" not in {check.key for check in case.checks}
    assert only(drive_speed(case.found)).verdict == "FAIL"


def test_the_load_of_a_set_is_belt_lumps_and_a_raised_set():
    found = with_carry(cema_class="D", lump_factor=1.2, raised="4 mm")
    assert {duty.stretch.strand for duty in found.set_duty} == {"carry"}
    steady, half = found.balance.equilibrium.steady, found.line.count
    bulk = 1200 / 3.6 / 4.0
    for k, duty in enumerate(found.set_duty):
        lifted = 2.0 * max(float(steady.starts[half + k]), float(steady.ends[half + k])) * 0.004 / 1.2
        level = duty.stretch.inclination
        on_rolls = (20.0 + 1.2 * bulk) * 9.81 * 1.2 * math.cos(level)
        assert duty.limits.load == pytest.approx(on_rolls + lifted, rel=1e-9)
    check = only(set_rating(found))
    assert check.required == pytest.approx(1200 * 4.4482216152605, rel=1e-12)  # 39.4 in: of the column of 42 in
    assert check.calculated == pytest.approx(max(duty.limits.load for duty in found.set_duty))


def test_lumps_say_the_factor_where_none_is_given():
    def of(lump, **given):
        carry = DATA["idlers"]["carry"] | {"cema_class": "D"} | given
        return calculated(
            belt=DATA["belt"] | {"wear": {"lump": lump, "loading": "low"}},
            idlers=DATA["idlers"] | {"carry": carry},
        )

    # 1600 kg/m³: 1.1 to 300 mm, 1.2 to 500 mm, none printed beyond
    factors = {lump: {duty.limits.lump_factor for duty in of(lump).set_duty} for lump in ("0.3 m", "0.5 m", "0.6 m")}
    assert factors == {"0.3 m": {1.1}, "0.5 m": {1.2}, "0.6 m": {None}}
    assert {duty.limits.lump_factor for duty in of("0.6 m", lump_factor=1.4).set_duty} == {1.4}
    first, bulk = (
        of("0.3 m").set_duty[0],
        1200 / 3.6 / 4.0,
    )  # Sandvik's factor is of belt and bulk, CEMA's of bulk alone
    along = 9.81 * 1.2 * math.cos(first.stretch.inclination)
    assert first.limits.load == pytest.approx(1.1 * (20.0 + bulk) * along, rel=1e-9)
    check = only(set_rating(of("0.6 m")))
    assert (check.verdict, check.required) == ("not checked", None)


def test_a_set_beyond_its_rating_fails_and_names_the_class_that_bears_it():
    check = only(set_rating(with_carry(cema_class="B", lump_factor=1.4, spacing="2 m")))
    assert check.failed
    # (20 + 1.4 x 83.3) kg/m x 2 m x 9.81 m/s²; 363 and 791 lbf at 35 deg, 42 in
    assert check.why.text() == "carry sets in a bear 2.68 kN, they are rated for 1.61 kN; class C bears it"


def test_an_axle_bends_between_its_supports():
    found = with_carry(bearing=BEARING)
    worst = max(found.set_duty, key=lambda duty: duty.limits.axle.slope).limits.axle
    middle = max(duty.stretch.loads[1].force for duty in found.set_duty)
    # W/2 at 25 mm from the supports, 340 mm apart: M b/(2 E I), E of CEMA B105.1
    moment, inertia = 0.5 * middle * 0.025, math.pi * 0.025**4 / 64
    modulus = 29e6 * 4.4482216152605 / 0.0254**2
    assert worst.roll == "middle"
    assert worst.slope == pytest.approx(moment * 0.34 / (2 * modulus * inertia), rel=1e-9)
    assert only(roll_axle(found)).required == pytest.approx(math.radians(0.1667))


@pytest.mark.parametrize("margin", ["5 %", "60 %"])
def test_the_spacing_that_the_check_names_is_still(margin):
    found = with_carry(flap_margin=margin, spacing="1.5 m")
    wanted, rotation = float(margin.rstrip(" %")) / 100, 4.0 / (math.pi * 0.133)
    assert found.set_duty[0].rotations == pytest.approx((rotation, rotation), rel=1e-12)
    least = min(duty.still_spacing for duty in found.set_duty)
    for duty in found.set_duty:
        low = duty.frequencies[0] * 1.5 / least
        assert low >= rotation * (1 + wanted) * (1 - 1e-12)
        assert duty.still_diameter == pytest.approx(0.133 * 1.5 / duty.still_spacing, rel=1e-12)
    assert only(belt_flap(found)).failed == (min(duty.distance for duty in found.set_duty) < wanted)


def belt(**given):
    return calculated(belt=DATA["belt"] | given)


def test_covers_need_the_carcass_and_the_wear():
    found = belt(wear={"lump": "0.3 m", "abrasiveness": "high", "loading": "high"})
    top, bottom = cover_thickness(found)
    # 1.6 t/m³ 2 points, 2 x 1000 m at 4 m/s 1, lumps, abrasiveness, loading 3 each: 12, so 8 mm; steel cords: 4 mm
    assert (top.required, bottom.required) == pytest.approx((4e-3 + 8e-3, 4e-3))
    assert (top.failed, bottom.failed) == (True, False)


def test_temperatures_of_the_belt():
    within = list(belt_temperature(belt(lowest_temperature="-20 degC", highest_temperature="60 degC")))
    assert [check.failed for check in within] == [False, False]
    assert only(belt_temperature(belt(lowest_temperature="25 degC"))).failed
    with pytest.raises(InputError, match="highest_temperature: got 5 degC, not more than lowest_temperature 10 degC"):
        belt(lowest_temperature="10 degC", highest_temperature="5 degC")


def test_a_splice_bears_strips_and_starts():
    carcass = DATA["belt"]["carcass"] | {"splice_strength": "45 %"}
    route = DATA["route"] | {"head_transition": {"length": "3 m"}}
    found = calculated(belt=DATA["belt"] | {"carcass": carcass}, route=route)
    needed = found.belt_duty.strength_needed
    factor = 1.1 * 1.7 / 0.45
    assert needed["steady"] == pytest.approx(factor * found.belt_duty.per_width_steady, rel=1e-12)
    assert needed["starting and stopping"] == pytest.approx(factor * found.belt_duty.per_width / 1.5, rel=1e-12)
    assert needed["strips of transitions and curves, steady"] > needed["steady"]
    assert len(list(splice_strength(found))) == 3


def take_up(**given):
    return calculated(route=DATA["route"] | {"take_up": given})


def test_a_carriage_has_way_and_speed():
    found = take_up(kind="winch", position="drive", travel="1 m", winch_speed="0.001 m/s")
    duty = common_take_up_duty([found])
    start, steady = found.balance.equilibrium.unsteady, found.balance.equilibrium.steady
    lengths = found.line.loop.length
    way = (start.mean(lengths) - steady.mean(lengths)) * lengths.sum() / (72 * 2000e3 * 2)
    assert duty.speed == pytest.approx(way / (0.5 * 4.0 / start.acceleration), rel=1e-9)
    travel, speed = take_up_travel(found)
    assert (travel.calculated, travel.required) == pytest.approx((duty.travel.whole, 1.0))
    assert (speed.required, speed.failed) == (pytest.approx(0.001), True)


def test_screws_are_for_short_conveyors():
    check = only(take_up_travel(take_up(kind="screw", position="tail")))
    assert (check.failed, check.required) == (True, SCREW_LENGTH)


def drives(second=None, **given):
    further = {} if second is None else {"further_drives": [SECOND | second]}
    return calculated(drive=DATA["drive"] | PARTS | given | further)


def test_gear_of_one_motor():
    (duty,) = drives(motors=2).drive_duty
    rotation = 4.0 / math.pi
    assert duty.ratio == pytest.approx(1480 / 60 / rotation, rel=1e-12)
    assert duty.standard_ratio == 20.0  # of 19.4
    torque = 1.5 * 200e3 / (2 * math.pi * rotation)
    assert torque < duty.gear == pytest.approx(40e3)


def test_a_backstop_holds_and_bears_stalled_motors():
    found = drives(backstop_torque="10 kN*m", torque_factor=1.5)
    (duty,) = found.drive_duty
    assert duty.holding == pytest.approx(found.motions.brake_to_hold * 0.5, rel=1e-12)
    assert duty.stalled == pytest.approx(1.5 * 0.94 * 400e3 / 4.0 * 0.5, rel=1e-12)
    check = only(drive_parts(found))
    assert (check.failed, check.where) == (True, "motors stalled")
    of_two = drives({"backstop": True, "pulley_diameter": "1 m"}, backstop=True)
    alone = 0.5 * of_two.motions.brake_to_hold
    assert [duty.holding for duty in of_two.drive_duty] == pytest.approx([0.7 * alone] * 2, rel=1e-12)


def test_two_brakes_share_the_heat_of_a_stop_by_their_forces():
    disc = 46e3  # J/K of 100 kg of steel
    found = drives(
        {"pulley_diameter": "1 m", "brake_force": "10 kN"},
        brake_force="30 kN", brake_disc="100 kg", brake_heat="20 kJ",
    )  # fmt: skip
    first, second = found.drive_duty
    whole = found.motions.braking_heat
    assert whole > 0.0
    assert (first.heat, second.heat) == pytest.approx((0.75 * whole, 0.25 * whole), rel=1e-12)
    assert first.disc_rise == pytest.approx(0.75 * whole / disc, rel=1e-9)
    assert second.disc_rise is None
    heat = only(check for check in drive_parts(found) if check.key == "brake_heat")
    assert (heat.calculated, heat.required, heat.failed) == (pytest.approx(0.75 * whole), 20e3, True)
    unknown = drives(brake_force="30 kN", brake_disc="100 kg")
    assert [check for check in drive_parts(unknown) if check.key == "brake_heat"] == []


def test_a_drive_without_a_brake_has_no_heat():
    (duty,) = drives(starts_per_hour=3).drive_duty
    assert (duty.heat, duty.disc_rise) == (None, None)


def test_a_backstop_that_friction_spares_has_no_size():
    sections = [{"name": name, "length": "250 m", "lift": "1 m"} for name in "abcd"]
    found = calculated(drive=DATA["drive"] | PARTS | {"backstop": True}, route={"sections": sections})
    assert [duty.holding for duty in found.drive_duty] == [0.0]
    assert "backstop size [N m]" not in drive_tables.drive_parts(found, design_loads(found, None, None)).frame().columns


def test_starts_an_hour_of_a_small_motor():
    power = 100 * HORSEPOWER
    found = drives(installed_power=f"{power} W", motors=1, starts_per_hour=3)
    (duty,) = found.drive_duty
    inertia = found.motions.moving_mass * (4.0 / (2 * math.pi * 1480 / 60)) ** 2
    assert duty.load_inertia == pytest.approx(inertia, rel=1e-12)
    product = 441 * 0.45359237 * 0.3048**2
    assert duty.allowed_starts == pytest.approx(min(5.2, product / inertia), rel=1e-6)
    beyond = only(drive_parts(drives(starts_per_hour=3)))
    assert (beyond.verdict, beyond.asked.text()) == (
        "not checked", "536.4 hp is outside NEMA's table of starts, 1 to 250 hp: ask the motor's maker",
    )  # fmt: skip


def test_a_flywheel_coasts_as_long_as_wanted():
    short = drives(coast_time="120 s")
    check = only(coasting_time(short))
    assert check.failed
    again = drives(coast_time="120 s", reduced_mass=f"{_flywheel(short)} kg")
    assert again.motions.coasting.time == pytest.approx(120.0, rel=1e-6)


def _flywheel(found):
    """Mass at the belt that lengthens coasting to the time wanted [kg]."""
    stopped, mass = found.motions.coasting, found.motions.moving_mass + found.motions.rotating_mass
    return stopped.deceleration * mass * 120.0 / 4.0 - mass


def test_uncontrolled_drives_share_the_whole_force():
    found = drives({"pulley_diameter": "1 m"}, diameter_loss="3 mm")
    first, second = found.drive_duty
    assert first.shared + second.shared == pytest.approx(found.balance.equilibrium.force, rel=1e-9)
    # alike but for the loss: the smaller pulley pulls less
    even = drives({"pulley_diameter": "1 m"}, diameter_loss="0 mm").drive_duty
    assert first.shared < even[0].shared


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"starts_per_hour": 2, "motor_speed": None},
            "motor_speed: missing: starts_per_hour is given and needs it",
        ),
        ({"brake_heat": "1 MJ"}, "brake_force: missing: brake_heat is given and needs it"),
        ({"backstop": False, "backstop_torque": "1 kN*m"}, "of a drive without a backstop"),
    ],
)
def test_refusals_of_drives(given, message):
    drive = {key: value for key, value in (DATA["drive"] | PARTS | given).items() if value is not None}
    with pytest.raises(InputError, match=message):
        calculated(drive=drive)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"cema_class": "D", "rating": "5 kN"}, "rating: got 5 kN beside cema_class D; give one of the two"),
        ({"cema_class": "B", "rolls": 2, "trough_angle": "10 deg"}, "CEMA class B has no set of 2"),
        (
            {"bearing": BEARING | {"support_distance": "300 mm"}},
            "support_distance: got 300 mm, but the bearings",
        ),
    ],
)
def test_refusals_of_sets(given, message):
    with pytest.raises(InputError, match=message):
        with_carry(**given)
