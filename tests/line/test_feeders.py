"""Belts that pull bulk out of hoppers: forces by hand, start after filling, every method, refusals."""

import math
from pathlib import Path

import pytest

import conveyor
import conveyor.models
from conveyor.dynamics.simulation import simulate_scenarios
from conveyor.errors import InputError
from conveyor.report.tables.feeder_tables import hopper_state_table
from conveyor.units import si
from tests.command_line import run

SPEC = Path("examples/specs/feeder.yaml")


@pytest.fixture(scope="module")
def feeder():
    return conveyor.load(SPEC)


def with_hopper(spec, **changes):
    feeding = spec.route.feeding
    return spec.replace(route=spec.route.replace(feeding=feeding.replace(hopper=feeding.hopper.replace(**changes))))


def forces(result):
    return {each.key: each.total for each in result.balance.every}


def checks(result):
    return {each.key: each for each in result.checks}


def cells_of(result):
    """Columns of the table of the states of a feeder, by their names."""
    table = hopper_state_table(result)
    return {column.label: [column.get(row) for row in table.rows] for column in table.columns}


def filled_grip(result):
    """The check of the grip at the start under the filled hopper."""
    (found,) = (each for each in result.checks if each.key == "drive_grip" and "hopper filled" in str(each.subject))
    return found


def test_forces_by_hand(feeder):
    """Given load factors: 4 m x (0.6 m)² of coal, sine of 50 deg, plate 0.3."""
    found = forces(conveyor.analyse(with_hopper(feeder, flow_factor=0.5, initial_factor=2.0)))
    load = 0.5 * 850.0 * si(feeder.calculation.gravity) * 4.0 * 0.6**2
    assert found["hopper_pull"] == pytest.approx(math.sin(math.radians(50.0)) * load, rel=1e-12)
    assert found["hopper_load"] == pytest.approx(0.3 * load, rel=1e-12)


def test_start_after_filling_breaks_the_initial_load_away(feeder):
    """Two initial factors differ by their load times shear and plate, at the friction to design for."""
    low, high = (conveyor.analyse(with_hopper(feeder, flow_factor=0.5, initial_factor=factor)) for factor in (2.0, 3.0))
    load = 850.0 * si(feeder.calculation.gravity) * 4.0 * 0.6**2
    more = (math.sin(math.radians(50.0)) + 0.3) * load
    friction = low.line.design_friction
    assert high.line.design_friction == pytest.approx(friction, rel=1e-12)
    parted = high.motions.design_start.breakaway - low.motions.design_start.breakaway
    assert parted == pytest.approx(friction * more, rel=1e-9)
    assert forces(high) == pytest.approx(forces(low), rel=1e-12)
    assert filled_grip(high).required > filled_grip(low).required


def test_a_filled_hopper_takes_three_eighths_of_its_pull_off_the_slack_side_of_a_screw_take_up(feeder):
    """4 m of outlet at the tail, drive at the head, 8 m: of the 16 m of belt 8 have no pull, 4 half of it, 4 all of it.

    A loop of fixed length keeps its mean: (4 x 1/2 + 4 x 1)/16 of the pull goes off everywhere.
    """
    result = conveyor.analyse(with_hopper(feeder, flow_factor=0.5, initial_factor=2.0))
    filled, flow, run_out = result.hopper_states
    load = 850.0 * si(feeder.calculation.gravity) * 4.0 * 0.6**2
    pull = result.line.design_friction * (math.sin(math.radians(50.0)) + 0.3) * load
    assert filled.motion.force - flow.motion.force == pytest.approx(1.5 * pull, rel=1e-9)
    assert flow.motion.force - run_out.motion.force == pytest.approx(0.5 * pull, rel=1e-9)
    (during,), (before,), (after,) = (state.motion.drives for state in (filled, flow, run_out))
    assert during.slack - before.slack == pytest.approx(-0.375 * 1.5 * pull, rel=1e-9)
    assert during.tight - before.tight == pytest.approx(0.625 * 1.5 * pull, rel=1e-9)
    assert after.slack - before.slack == pytest.approx(0.375 * 0.5 * pull, rel=1e-9)


def test_the_outlet_may_end_within_a_section_or_reach_over_several(feeder):
    """7.5 of 8 m: (7.5/2 + 0.5)/16 of the pull; the same cut in sections of 3 and 5 m gives the same tensions."""
    long = with_hopper(feeder, outlet_length="7.5 m", flow_factor=0.5, initial_factor=2.0)
    (section,) = long.route.sections
    cut = [section.replace(name="rear", length="3 m"), section.replace(length="5 m")]
    parted = long.replace(route=long.route.replace(sections=cut))
    one, other = conveyor.analyse(long), conveyor.analyse(parted)
    filled, flow, _ = (state.motion for state in one.hopper_states)
    more = filled.force - flow.force
    assert filled.drives[0].slack - flow.drives[0].slack == pytest.approx(-4.25 / 16.0 * more, rel=1e-9)
    for here, there in zip(one.hopper_states, other.hopper_states, strict=True):
        assert there.motion.drives[0].tight == pytest.approx(here.motion.drives[0].tight, rel=1e-4)  # flexure of more
    load = 850.0 * si(feeder.calculation.gravity) * 7.5 * 0.6**2
    pull = one.line.design_friction * (math.sin(math.radians(50.0)) + 0.3) * 1.5 * load
    rise = [end - start for start, end in zip(flow.starts, flow.ends, strict=True)]
    for_filled = [end - start for start, end in zip(filled.starts, filled.ends, strict=True)]
    assert for_filled[1] - rise[1] == pytest.approx(pull, rel=1e-9)  # on the carry strand, none before it
    assert for_filled[0] == pytest.approx(rise[0], rel=1e-9)


def test_belt_pulleys_and_transitions_bear_the_start_under_the_filled_hopper(feeder):
    """Torque of the head pulley is the drive force times its radius; the head's transition has the highest tension."""
    pulleys = [
        {
            "name": place,
            "mass": "600 kg",
            "position": place,
            "diameter": "630 mm",
            "shaft_diameter": "125 mm",
            "wrap_angle": "180 deg",
        }
        for place in ("head", "tail")
    ]
    transition = {"length": "2 m", "pulley_height": 0.5}
    route = feeder.route.replace(pulleys=pulleys, head_transition=transition)
    carcass = feeder.belt.carcass.replace(stiffness="8000 N/mm")
    result = conveyor.analyse(feeder.replace(route=route, belt=feeder.belt.replace(carcass=carcass)))
    filled = result.hopper_states[0].motion
    head = next(duty for duty in result.pulley_duty if duty.pulley.driven)
    assert head.torque == pytest.approx(filled.force * 0.315, rel=1e-12)
    assert head.largest.state == filled.name == "hopper filled"
    (zone,) = result.belt_duty.transitions
    torques = cells_of(result)["torque at the drive shaft"]
    assert torques == pytest.approx([state.motion.force * 0.315 for state in result.hopper_states], rel=1e-12)
    assert zone.highest == pytest.approx(float(filled.ends[-1]) / 1.2, rel=1e-12)
    assert result.balance.tensions.largest == pytest.approx(filled.largest, rel=1e-12)
    assert result.belt_duty.largest_steady < 0.75 * filled.largest
    assert "run-out" in {load.state for load in head.loads}


def test_a_weight_keeps_the_slack_side(feeder):
    take_up = {"kind": "gravity", "position": "head", "tension": "60 kN"}
    found = conveyor.analyse(feeder.replace(route=feeder.route.replace(take_up=take_up))).hopper_states
    slack = [state.motion.drives[0].slack for state in found]
    assert slack == pytest.approx([slack[0]] * 3, rel=1e-9)


def test_the_slack_side_needed_under_the_filled_hopper(feeder):
    """e^(μ α) - 1 of the drive; what the message asks for passes, a little less fails."""
    loose = feeder.replace(
        route=feeder.route.replace(take_up={"kind": "screw", "position": "tail", "tension": "60 kN"})
    )
    result = conveyor.analyse(loose)
    grip = filled_grip(result)
    filled = result.hopper_states[0].motion
    assert grip.failed
    assert grip.required == pytest.approx(filled.force / math.expm1(0.35 * math.radians(210.0)), rel=1e-12)
    needed = 60e3 + grip.required - grip.calculated
    for tension, fails in ((1.02 * needed, False), (0.96 * needed, True)):
        taut = {"kind": "screw", "position": "tail", "tension": f"{tension:.6g} N"}
        assert filled_grip(conveyor.analyse(feeder.replace(route=feeder.route.replace(take_up=taut)))).failed is fails
    safety = checks(result)["belt_safety"]
    assert safety.calculated == pytest.approx(800e3 * 1.2 / filled.largest, rel=1e-12)


@pytest.mark.parametrize("kind", [{"kind": "screw", "position": "tail"}, {"kind": "gravity", "position": "head"}])
def test_the_take_up_suits_the_start_under_the_filled_hopper(feeder, kind):
    """Without a setting the least is found with which no drive slips, and asked for by name where one is given.

    Filled, the drive pulls 1.5 loads more than in flow; a weight leaves the slack side, a screw takes 3/8 off.
    """
    half_and_two = with_hopper(feeder, flow_factor=0.5, initial_factor=2.0)
    found = conveyor.analyse(half_and_two.replace(route=half_and_two.route.replace(take_up=kind)))
    grip = filled_grip(found)
    assert not grip.failed
    assert grip.calculated == pytest.approx(grip.required, rel=1e-9)
    setting = found.balance.equilibrium.setting
    asked = found.balance.equilibrium.conditions["grip, drive, hopper filled"]
    assert found.balance.equilibrium.governing == "grip, drive, hopper filled"
    assert setting == pytest.approx(asked, rel=1e-12)
    slack = found.hopper_states[1].motion.drives[0].slack
    load = 850.0 * si(feeder.calculation.gravity) * 4.0 * 0.6**2
    more = found.line.design_friction * (math.sin(math.radians(50.0)) + 0.3) * 1.5 * load
    taken = 0.375 * more if kind["kind"] == "screw" else 0.0
    assert slack - grip.calculated == pytest.approx(taken, rel=0.02, abs=1.0)
    for share, fails in ((1.0, False), (0.9, True)):
        given = {**kind, "tension": f"{share * asked!r} N"}
        again = conveyor.analyse(half_and_two.replace(route=half_and_two.route.replace(take_up=given)))
        taken_up = next(one for one in again.checks if one.key == "take_up_tension")
        assert taken_up.failed is filled_grip(again).failed is fails
        assert "hopper filled" in str(taken_up.where)
        assert taken_up.required == pytest.approx(asked, rel=0.02)  # a given setting is one default less


def test_a_start_that_stalls_says_what_torque_it_needs(feeder):
    """5.5 kW give 16.9 kN at the belt, the filled hopper holds some 90 kN."""
    weak = conveyor.analyse(feeder.replace(drive=feeder.drive.replace(installed_power="5.5 kW")))
    start = checks(weak)["breakaway"]
    rated = 5.5e3 * 0.92 / 0.3
    assert start.failed
    assert f"{start.required / rated:.2f} times the rated torque breaks it away" in str(start.why)
    times = {state.name: state.start_time for state in weak.hopper_states}
    assert times["filled, after standing"] is None
    assert times["in flow"] is not None


def test_a_start_through_time_breaks_the_initial_load_away(feeder):
    """Motors too weak for the filled hopper, strong enough for the flow: only the start from rest stalls."""
    weak = feeder.replace(drive=feeder.drive.replace(installed_power="5.5 kW"))  # 1.6 x 16.9 kN at the belt
    start = {"name": "s", "begins": "at rest", "loading": "full", "events": [{"do": "start"}], "duration": "4 s"}
    scenario = conveyor.models.Scenario.from_data(start)
    stalled = simulate_scenarios(weak, [scenario], step=0.02).followed[0]
    light = simulate_scenarios(with_hopper(weak, initial_factor=0.5), [scenario], step=0.02).followed[0]
    assert abs(stalled.belt_speed[-1]) < 0.01 * 0.3  # the belt before the drive gives way, then all stands
    assert light.belt_speed[-1] > 0.9 * 0.3


def test_an_empty_belt_has_no_hopper(feeder):
    found = conveyor.analyse(feeder.replace(material=feeder.material.replace(flow="0 t/h")))
    assert not {"hopper_pull", "hopper_load"} & set(forces(found))
    assert not found.hopper_states


def test_the_same_pull_by_every_method(feeder):
    by_contact = forces(conveyor.analyse(feeder))
    cema = {"flexure_factor": 0.02, "idler_friction": "6.7 N"}
    for method in ("din 22101", "cema classic"):
        given = feeder.replace(calculation=feeder.calculation.replace(method=method, cema=cema))
        assert forces(conveyor.analyse(given))["hopper_pull"] == pytest.approx(by_contact["hopper_pull"], rel=1e-12)


def test_on_sets_the_load_costs_f(feeder):
    section = feeder.route.sections[0].replace(bed=None)
    on_sets = feeder.replace(route=feeder.route.replace(sections=[section]))
    plate, sets = (forces(conveyor.analyse(one))["hopper_load"] for one in (feeder, on_sets))
    assert sets / plate == pytest.approx(0.02 / 0.3, rel=1e-9)


def test_weight_density_loads_and_density_fills(feeder):
    heavy = feeder.replace(material=feeder.material.replace(weight_density="1020 kg/m^3"))
    one, other = conveyor.analyse(feeder), conveyor.analyse(heavy)
    assert forces(other)["hopper_pull"] / forces(one)["hopper_pull"] == pytest.approx(1.2, rel=1e-12)
    assert checks(other)["feeder_flow"].required == pytest.approx(checks(one)["feeder_flow"].required, rel=1e-12)


def test_gate_and_speed_are_checked(feeder):
    assert checks(conveyor.analyse(with_hopper(feeder, gate_height="200 mm")))["feeder_flow"].failed
    fast = feeder.replace(belt=feeder.belt.replace(speed="0.8 m/s"))
    assert checks(conveyor.analyse(fast))["feeder_speed"].failed


@pytest.mark.parametrize(
    ("slope", "fails"),
    [
        ("34 deg", False),
        ("45 deg", True),  # Jenike's limit for δ 50 deg, φ 20 deg: 45.85 = e^(3.75 x 1.0201), (45.85 - 20)/0.7509
        ("55 deg", True),
    ],
)
def test_a_hopper_beyond_mass_flow_fails_unless_its_load_is_given(feeder, slope, fails):
    flat = {"half_angle": slope, "top_width": "4 m"}
    found = checks(conveyor.analyse(with_hopper(feeder, **flat)))["mass_flow"]
    assert found.failed is fails
    assert math.degrees(found.required) == pytest.approx(34.42, abs=0.01)
    assert not fails or "funnel flow is likely" in str(found.why)
    assert "mass_flow" not in checks(conveyor.analyse(with_hopper(feeder, **flat, flow_factor=0.9)))


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"top_width": "0.5 m"}, "top_width"),
        ({"wall_friction": "55 deg"}, "wall_friction"),
        ({"half_angle": "59 deg", "wall_friction": "45 deg"}, "half_angle"),
        ({"outlet_width": "900 mm"}, "wider than the skirts"),
        ({"top_width": "600 mm"}, "top_width: got 600 mm, not wider than the outlet"),
        ({"top_width": "610 mm"}, "gate_height: got 250 mm, higher than the hopper, 13.74 mm"),
        ({"half_angle": "60 deg", "top_width": "1400 mm", "flow_factor": 0.2}, "got 250 mm, higher than the hopper"),
        ({"outlet_length": "9 m"}, "outlet_length: got 9 m, longer than the 8 m of belt to the head"),
        ({"flow_factor": 0.5, "initial_factor": 0.4}, "initial_factor: the load factor after filling, 0.4 given"),
        ({"flow_factor": 6.0}, "top_width: the load factor after filling, 5.49 of its shape, is below the 6 of flow"),
    ],
)
def test_what_a_hopper_cannot_be(feeder, changes, match):
    with pytest.raises((InputError, ValueError), match=match):
        with_hopper(feeder, **changes)


def test_a_fast_belt_and_a_fall_are_refused(feeder):
    with pytest.raises(InputError, match="the bulk under the hopper does not follow"):
        feeder.replace(belt=feeder.belt.replace(speed="5 m/s"))
    with pytest.raises((InputError, ValueError), match="drop_height: given with hopper"):
        feeder.route.feeding.replace(drop_height="1 m")
    with pytest.raises((InputError, ValueError), match="from rest"):
        feeder.route.feeding.replace(speed="0.1 m/s")


def test_what_a_belt_under_a_hopper_cannot_be(feeder):
    feeding, (section,) = feeder.route.feeding, feeder.route.sections
    share = {"share": "50 %"}
    with pytest.raises(InputError, match="skirt_width: got 1300 mm, wider than the belt"):
        feeder.replace(route=feeder.route.replace(feeding=feeding.replace(skirt_width="1300 mm")))
    pipe = conveyor.load("examples/specs/pipe.yaml")
    with pytest.raises(InputError, match=r"hopper: given, but the belt closes to a pipe"):
        feeder.replace(idlers=pipe.idlers, material=feeder.material.replace(flow="60 t/h"))
    twice = {"feeding": feeding.replace(**share), "further_feeding": [feeding.replace(**share)]}
    with pytest.raises(InputError, match="stands where another hopper does"):
        feeder.replace(route=feeder.route.replace(**twice))
    curved = section.replace(bed=None, curve="convex", curve_radius="100 m")
    with pytest.raises(InputError, match='given on the curve of section "feeder"'):
        feeder.replace(route=feeder.route.replace(sections=[curved]))
    head = section.replace(name="head", length="2 m")
    at_head = feeder.route.replace(sections=[head.replace(name="tail"), head], feeding=feeding.replace(section="head"))
    with pytest.raises(InputError, match="longer than the 2 m of belt to the head"):
        feeder.replace(route=at_head)
    short = feeding.replace(section="head", hopper=feeding.hopper.replace(outlet_length="1 m"))
    behind = feeder.replace(route=at_head.replace(feeding=short))
    with pytest.raises(InputError, match="the gate of a hopper stands at one end of its outlet"):
        behind.replace(cases=[{"name": "back", "reversed": True}])


def test_a_bin_adds_to_the_start_and_nothing_to_flow(feeder):
    """3 m wide, 6 m of coal on 20 deg walls: h_s of Janssen over the outlet, sheared and carried."""
    drag = 0.4 * math.tan(math.radians(20.0)) / 1.5
    column = (1.0 - math.exp(-6.0 * drag)) / drag
    one, other = conveyor.analyse(feeder), conveyor.analyse(with_hopper(feeder, bin_height="6 m"))
    assert forces(other) == pytest.approx(forces(one), rel=1e-12)
    load = 850.0 * si(feeder.calculation.gravity) * 4.0 * 0.6 * column
    more = one.line.design_friction * (math.sin(math.radians(50.0)) + 0.3) * load
    before, after = (each.motions.design_start.breakaway for each in (one, other))
    assert after - before == pytest.approx(more, rel=1e-9)
    assert any("bin_pressure_ratio not given" in line for line in map(str, other.warnings))
    with pytest.raises((InputError, ValueError), match="bin_pressure_ratio: given without bin_height"):
        with_hopper(feeder, bin_pressure_ratio=0.5)
    with pytest.raises((InputError, ValueError), match="bin_height: given with initial_factor"):
        with_hopper(feeder, bin_height="6 m", initial_factor=9.0)


def test_skirts_under_the_hopper(feeder):
    """2 μ K y/B of the load and the weight of the bulk between, in flow; the start shears what filling adds."""
    given = {"flow_factor": 0.5, "initial_factor": 2.0}
    bare, between = (with_hopper(feeder, **given, **more) for more in ({}, {"skirt_pressure_ratio": 0.4}))
    one, other = conveyor.analyse(bare), conveyor.analyse(between)
    unit, gravity = 0.4 * feeder.route.feeding.skirt_friction * 0.25 / 0.6, si(feeder.calculation.gravity)
    load, weight = 850.0 * gravity * 4.0 * 0.6**2, 850.0 * gravity * 4.0 * 0.6 * 0.25
    assert forces(other)["hopper_skirts"] == pytest.approx(unit * (2.0 * 0.5 * load + weight), rel=1e-12)
    assert "hopper_skirts" not in forces(one)

    def added(result):
        design = result.motions.design_start.breakaway - result.balance.equilibrium.design_force
        return design / result.line.design_friction

    assert added(other) - added(one) == pytest.approx(unit * 2.0 * 1.5 * load, rel=1e-9)
    cema = {"flexure_factor": 0.02, "idler_friction": "6.7 N"}
    by_cema = conveyor.analyse(between.replace(calculation=feeder.calculation.replace(cema=cema))).balance.cema
    items = {item[1]: item[2] for item in by_cema.items}
    assert items["hoppers"] == pytest.approx(
        sum(forces(other)[key] for key in ("hopper_pull", "hopper_load", "hopper_skirts")), rel=1e-12
    )


def test_two_hoppers_add_up_and_the_first_has_room_to_the_second(feeder):
    """Each as alone, with the same load: their pulls are not shared by the flow."""
    feeding, (section,) = feeder.route.feeding.replace(share="50 %"), feeder.route.sections
    sections = [section, section.replace(name="second")]
    second = feeding.replace(section="second")
    both = feeder.replace(
        route=feeder.route.replace(sections=sections, feeding=feeding, further_feeding=[second]),
        material=feeder.material.replace(flow="120 t/h"),
    )
    pulls = [each.total for each in conveyor.analyse(both).balance.every if each.key == "hopper_pull"]
    alone = forces(conveyor.analyse(feeder))["hopper_pull"]
    assert pulls == pytest.approx([alone, alone], rel=1e-12)
    with pytest.raises(InputError, match="longer than the 3 m of belt to the next hopper"):
        both.replace(route=both.route.replace(sections=[section.replace(length="3 m"), sections[1]]))


def test_the_same_feeder_in_us_units(feeder):
    feet = {
        "outlet_length": f"{4 / 0.3048!r} ft",
        "outlet_width": f"{600 / 25.4!r} in",
        "top_width": f"{3 / 0.3048!r} ft",
    }
    us = with_hopper(feeder, **feet, gate_height=f"{250 / 25.4!r} in")
    one, other = conveyor.analyse(feeder), conveyor.analyse(us)
    assert forces(other)["hopper_pull"] == pytest.approx(forces(one)["hopper_pull"], rel=1e-12)
    assert checks(other)["feeder_flow"].required == pytest.approx(checks(one)["feeder_flow"].required, rel=1e-12)
    assert filled_grip(other).required == pytest.approx(filled_grip(one).required, rel=1e-9)


def skirted(spec, **of_feeding):
    """The feeder of twice the flow, between skirts from the rear of the hopper to the head."""
    between = {"skirt_length": "4 m", "skirt_width": "600 mm"} | of_feeding
    feeding = spec.route.feeding.replace(**between, hopper=spec.route.feeding.hopper.replace(gate_height="500 mm"))
    route = spec.route.replace(feeding=feeding)
    return spec.replace(route=route, material=spec.material.replace(flow="240 t/h"))


def test_bulk_between_skirts_is_held_by_them(feeder):
    """Middle roll and flat belt: 600 mm x 500 mm over a trough whose wings 600 - 465 mm of belt reach into."""
    result = conveyor.analyse(skirted(feeder, skirt_height="500 mm"))
    filling = checks(result)["filling"]
    wing = 0.5 * (0.6 - 0.465)
    trough = (0.465 + wing * math.cos(math.radians(20.0))) * wing * math.sin(math.radians(20.0))
    assert filling.calculated == pytest.approx(240e3 / 3600.0 / 0.3 / 850.0, rel=1e-12)
    assert filling.required == pytest.approx(0.6 * 0.5 + trough, rel=1e-9)
    assert filling.verdict == "pass"
    assert "between the skirts" in str(filling)


def test_without_height_or_length_of_skirts_the_open_section_holds(feeder):
    with pytest.raises(InputError, match=r"material\.flow: got 240 t/h"):
        skirted(feeder)
    with pytest.raises(InputError, match=r"material\.flow: got 240 t/h"):
        skirted(feeder, skirt_height="500 mm", skirt_length="3.9 m")
    with pytest.raises(InputError, match=r"material\.flow: got 240 t/h"):  # 1.5 times what they hold
        skirted(feeder, skirt_height="250 mm")
    assert checks(conveyor.analyse(skirted(feeder, skirt_height="400 mm")))["filling"].failed


def test_slip_under_the_gate_takes_flow(feeder):
    slipping = conveyor.analyse(with_hopper(feeder, gate_efficiency="80 %"))
    full = checks(conveyor.analyse(feeder))["feeder_flow"].required
    assert checks(slipping)["feeder_flow"].required == pytest.approx(0.8 * full, rel=1e-12)
    assert checks(slipping)["feeder_flow"].failed


@pytest.mark.parametrize("units", ["SI", "US"])
def test_report(units, tmp_path):
    done = run("power", SPEC, "--set", f"report.units={units}", "-o", tmp_path / "a.xlsx", "-o", tmp_path / "a.html")
    assert "belt speed under a hopper" in done.stdout
    assert "Hoppers over the belt" in (tmp_path / "a.html").read_text(encoding="utf-8")
