"""The whole design by a classical method: forces, tensions, take-up, checks and load states follow it."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.calculated_conveyor import Variant
from conveyor.checks import run_checks
from conveyor.checks.drive_checks import holding_brake
from conveyor.dynamics.simulation import simulate_scenarios
from conveyor.errors import InputError
from conveyor.models import Scenario
from conveyor.models.calculation_methods import METHOD_NAMES
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate, calculate_many
from conveyor.remarks.part_warnings import part_warnings
from conveyor.results.analysis import analyse_studies
from conveyor.studies.loads import every_load

SPECS = Path(__file__).parents[2] / "examples" / "specs"
ROUNDING = 1e-12
CEMA = {"flexure_factor": 0.022, "idler_friction": "1.5 lbf", "temperature_factor": 1.2, "accessories": "500 N",
        "skirt_factor": 0.128, "skirt_depth": "100 mm"}  # fmt: skip


def by(stem, method, **calculation):
    line = conveyor.load(SPECS / f"{stem}.yaml")
    return line.replace(calculation=line.calculation.replace(method=method, **calculation))


@pytest.mark.parametrize("method", ["iso 5048", "din 22101"])
@pytest.mark.parametrize("stem", ["in_plant_us", "downhill", "curved"])
def test_forces_are_f_and_c(stem, method):
    """Against the estimate that stands beside the rolling contact of the same spec."""
    made, beside = calculate(by(stem, method)), calculate(by(stem, "viscoelastic")).balance.classical
    forces = made.balance.forces
    for name in ("main", "secondary", "special", "lift", "total"):
        # sets that guide in curves rub by the tension of their own method
        assert getattr(forces, name) == pytest.approx(getattr(beside, name), rel=1e-5 if stem == "curved" else ROUNDING)
    assert made.balance.friction_factor == pytest.approx(made.line.friction_factors, rel=ROUNDING)
    assert list(forces.parts) == ["main_by_factor", "secondary", "special", "lift"]


def with_sections(line, **given):
    """The conveyor with fields of sections by position."""
    sections = list(line.route.sections)
    for place, fields in given.items():
        sections[int(place[1:])] = sections[int(place[1:])].replace(**fields)
    return line.replace(route=line.route.replace(sections=sections))


def test_f_is_that_of_section_strand_and_load():
    """F_H of a stretch is f L g (m'_R + (m'_G + m'_L) cos δ), each with its own f."""
    line = by("overland", "din 22101", return_friction_factor=0.016, empty_friction_factor=0.028)
    own = {"friction_factor": 0.024, "return_friction_factor": 0.013}
    line = with_sections(line, _1=own | {"loaded": False}, _2=own, _4={"friction_factor": 0.018})
    made = calculate(line)
    n = made.line.count
    expected = {0: 0.02, 1: 0.028, 2: 0.024, 4: 0.018, n + 1: 0.013, n + 2: 0.013, n + 4: 0.016}
    (main,) = (force for force in made.balance.along if force.key == "main_by_factor")
    for i, f in expected.items():
        k = i if i < n else n + (2 * n - 1 - i)  # the return strand from the head
        stretch = made.line.stretches[k]
        weighs = stretch.set_mass / stretch.spacing + stretch.line_mass * math.cos(stretch.inclination)
        assert main.newtons[k] == pytest.approx(f * stretch.length * 9.81 * weighs, rel=1e-12), stretch
    beside = calculate(line.replace(calculation=line.calculation.replace(method="viscoelastic"))).balance.classical
    assert beside.main == pytest.approx(main.total, rel=ROUNDING)
    assert beside.friction_factor == pytest.approx(made.balance.friction_factor, rel=ROUNDING)
    assert "f = 0.013 to 0.028" in main.name


def test_load_states_have_the_f_of_the_empty_belt():
    line = by("overland", "din 22101", secondary="itemised", empty_friction_factor=0.03)
    loads = every_load(line)
    settled = loads.own.balance.equilibrium
    for key, loading in (("empty", "empty"), ("inclines", "inclines only")):
        case = with_case(line, conveyor.LoadCase(name=loading, loading=loading))
        (alone,) = calculate_many([Variant(case, take_up=settled.take_up)])
        state = loads.states.state(key).balance
        assert state.forces.total == pytest.approx(alone.balance.forces.total, rel=1e-9)
    empty, full = loads.states.state("empty").balance, loads.own.balance
    assert empty.friction_factor > 0.024 > full.friction_factor  # the return strand keeps f 0.02
    # the worst loading leaves sections empty only where they resist more so: of all 2^n none is worse
    worst = loads.states.state("worst").balance.equilibrium.force
    every = itertools.product([False, True], repeat=loads.own.line.count)
    for loaded in itertools.islice(every, 0, None, 97):
        sections = {f"_{i}": {"loaded": on} for i, on in enumerate(loaded)}
        (alone,) = calculate_many([Variant(with_sections(line, **sections), take_up=settled.take_up)])
        assert alone.balance.equilibrium.force <= worst * (1.0 + 1e-4)


def test_ky_is_that_of_the_section():
    """Te of a section: L Kt (Kx + Ky Wb + 0.015 Wb) + L Ky Wm, in pounds force per foot and pounds mass alike."""
    plain = calculate(by("overland", "cema classic", cema=CEMA))
    own = calculate(with_sections(by("overland", "cema classic", cema=CEMA), _2={"flexure_factor": 0.03}))
    stretch, more = own.line.stretches[2], 0.03 - CEMA["flexure_factor"]
    expected = stretch.length * 9.80665 * more * (CEMA["temperature_factor"] * stretch.belt_mass + stretch.bulk_mass)
    for symbol in ("Tyc", "Tym", "Tyr", "Tx"):
        (before,), (after,) = ([force for force in each.balance.along if force.key == symbol] for each in (plain, own))
        changed = np.flatnonzero(np.abs(after.newtons - before.newtons) > 1e-9)
        assert set(changed.tolist()) <= {2}
        expected -= after.total - before.total
    assert expected == pytest.approx(0.0, abs=1e-6)
    with pytest.raises(InputError, match=r"sections\[2\]\.flexure_factor: got 0\.03, Ky of CEMA, without its other"):
        with_sections(conveyor.load(SPECS / "overland.yaml"), _2={"flexure_factor": 0.03})


def test_secondary_resistances_that_are_given_itemised_stay_so():
    made = calculate(by("in_plant_us", "din 22101", secondary="itemised")).balance
    assert {force.key for force in made.singles} >= {"acceleration", "cleaner", "wrap"}
    assert "secondary_by_length" not in {force.key for force in made.singles}


@pytest.mark.parametrize("stem", ["in_plant_us", "overland", "shuttle"])
def test_cema_is_the_classic_form_item_by_item(stem):
    made = calculate(by(stem, "cema classic", cema=CEMA))
    beside = calculate(by(stem, "viscoelastic", cema=CEMA)).balance.cema
    sums = {}
    for force in made.balance.every:
        sums[force.key] = sums.get(force.key, 0.0) + force.total
    items = {symbol: newtons for symbol, _, newtons in beside.items}
    for symbol, newtons in items.items():
        if symbol != "Tm":
            assert sums.get(symbol, 0.0) == pytest.approx(newtons, rel=ROUNDING), symbol
    # the book lifts with standard gravity, the conveyor with the site's
    assert made.balance.forces.lift == pytest.approx(items["Tm"] * 9.81 / 9.80665, rel=1e-9, abs=1e-6)
    assert made.balance.forces.total - made.balance.forces.lift == pytest.approx(beside.total - items["Tm"], rel=1e-9)


def test_tensions_take_up_and_motors_follow():
    """T1 - T2 is Te; the slack side is Eytelwein's at the start where grip governs; the motor gives Te v / η."""
    line = by("overland", "din 22101")
    result = calculate(line)
    drive = result.balance.equilibrium.steady.drives[0]
    assert drive.tight - drive.slack == pytest.approx(result.balance.forces.total, rel=1e-9)
    assert result.balance.equilibrium.governed_by == "grip"
    start = 1.3 * result.balance.forces.total
    slack = start / math.expm1(0.35 * math.radians(210.0))
    assert result.balance.equilibrium.states["start"].drives[0].slack == pytest.approx(slack, rel=1e-9)
    (motor,) = (check for check in run_checks(result) if check.key == "motor_power")
    assert motor.calculated == pytest.approx(result.balance.forces.total * 5.0 / 0.94, rel=1e-9)
    assert result.line.design_friction == 1.0  # f has the allowance of its standard


def test_bearings_of_drive_pulleys_are_in_the_motor_power_and_not_in_te():
    """CEMA: motors give (Te + bearings) v / η; every drive its share of both."""
    made = calculate(by("overland", "cema classic", cema=CEMA | {"drive_pulley_friction": "5 kN"}))
    plain = calculate(by("overland", "cema classic", cema=CEMA))
    assert made.balance.forces.total == pytest.approx(plain.balance.forces.total, rel=ROUNDING)
    power = (plain.balance.forces.total + 5e3) * 5.0 / 0.94
    assert made.balance.power.motor == pytest.approx(power, rel=1e-9)
    checks = [check.calculated for check in run_checks(made) if check.key == "motor_power"]
    assert math.fsum(checks) == pytest.approx(power, rel=1e-9)
    beside = calculate(by("overland", "viscoelastic", cema=CEMA | {"drive_pulley_friction": "5 kN"}))
    assert beside.line.drive_bearings == 0.0


def test_bearings_of_drive_pulleys_that_are_not_given_are_told():
    def told(line):
        return [one.text("US") for one in part_warnings(calculate(line)) if "drive_pulley_friction" in one.text()]

    (words,) = told(by("in_plant_us", "cema classic", cema=CEMA))
    assert "none in the motor power, CEMA has 200 lbf for a drive pulley" in words
    assert told(by("in_plant_us", "cema classic", cema=CEMA | {"drive_pulley_friction": "0 N"})) == []


def test_a_holdback_bears_the_lift_less_half_of_cemas_friction():
    """By hand: half of what Te is above the lift; of other methods 60 %, and what the spec says before both."""
    by_cema = by("in_plant_us", "cema classic", cema=CEMA)
    made = calculate(by_cema)
    forces = made.balance.forces
    (inertia,) = (f.total for f in made.balance.singles if f.key == "Tam")  # a belt at rest has none
    half = forces.lift - 0.5 * (forces.total - forces.lift - inertia)
    assert made.motions.brake_to_hold == pytest.approx(half, rel=1e-9)
    assert by("in_plant_us", "din 22101").certain_friction == pytest.approx(0.6)
    given = by_cema.replace(drive=by_cema.drive.replace(least_friction="40 %"))
    assert given.certain_friction == pytest.approx(0.4)
    (check,) = (one for one in holding_brake(made) if one.key == "holding_brake")
    assert "(lift less 50 % of the friction)" in check.asked.text("US")


def test_seals_of_a_loading_point_are_those_the_spec_gives():
    line = by("in_plant_us", "cema classic", cema=CEMA)
    made = line.replace(route=line.route.replace(feeding=line.route.feeding.replace(seal_drag="175 N/m")))
    before, after = calculate(line), calculate(made)
    boards = after.line.loading[0].boards(after.line.speed, after.line.gravity)
    assert boards > 3.6576  # the skirts of 12 ft and the zone of acceleration
    # seals of 6 lbf/ft, 87.56 N/m, on the same boards
    more = after.balance.forces.total - before.balance.forces.total
    assert more == pytest.approx((175.0 - 87.5634) * boards, rel=1e-4)


def test_pulleys_before_a_drive_at_the_tail_are_of_the_tight_side():
    """200 lbf each instead of 150 (CEMA): those of the return strand."""
    line = by("downhill", "cema classic", cema=CEMA)
    bend = {"name": "snub", "position": "return", "section": line.route.sections[0].name, "diameter": "500 mm",
            "shaft_diameter": "100 mm", "mass": "300 kg"}  # fmt: skip
    route = line.route.replace(pulleys=[*line.route.pulleys, bend], take_up={"kind": "gravity", "position": "head"})
    pounds = {}
    for position in ("head", "tail"):
        drive = line.drive.replace(position=position)
        forces = calculate(line.replace(drive=drive, route=route)).balance.singles
        pounds[position] = {force.name: force.total / 4.4482216 for force in forces if force.key == "Tp"}["Tp, snub"]
    assert pounds == pytest.approx({"head": 150.0, "tail": 200.0})


@pytest.mark.parametrize(
    ("method", "words"),
    [
        ("din 22101", "friction_factor: f is one for all temperatures; for -25 °C"),
        ("cema classic", "temperature_factor is 1, which holds above freezing: for -25 °C"),
    ],
)
def test_a_method_of_factors_says_that_the_cold_needs_its_own(method, words):
    cema = CEMA | {"temperature_factor": 1.0}
    line = by("overland", method, cema=cema)
    case = {"name": "winter", "temperatures": ["-25 degC"]}
    assert any(words in warning for warning in conveyor.analyse(line.replace(cases=[case])).warnings)
    for warm in (line, by("overland", "viscoelastic", cema=cema).replace(cases=[case])):
        assert not any(words in warning for warning in conveyor.analyse(warm).warnings)


@pytest.mark.parametrize("method", ["iso 5048", "din 22101", "cema classic"])
def test_scenarios_follow_the_method(method):
    """Started and stopped with the forces of the method; at rest its rolls stick by the drag they have."""
    scene = {"name": "stop", "begins": "running", "events": [{"do": "power off"}], "duration": "3 s"}
    line = by("in_plant_us", method, cema=CEMA)
    made = simulate_scenarios(line, [Scenario.from_data(scene)], error=0.05)
    steady = calculate(line).balance.equilibrium.steady
    (stopped,) = made.followed
    highest = max(stopped.record.tensions.max(), 0.0)
    assert highest == pytest.approx(steady.drives[0].arriving, rel=0.05)


def test_pulleys_that_are_driven_and_not_listed_are_named():
    line = by("overland", "viscoelastic")
    two = {"name": "drive 2", "wrap_angle": "210 deg", "friction": 0.35, "installed_power": "900 kW"}
    shared = line.replace(drive=line.drive.replace(further_drives=[two]))
    assert any("1 driven at head, the drives there turn 2" in said for said in conveyor.analyse(shared).warnings)
    assert not any("driven at" in said for said in conveyor.analyse(line).warnings)


def test_a_design_friction_is_taken_where_it_is_given():
    line = by("overland", "din 22101")
    high = calculate(line.replace(drive=line.drive.replace(design_friction="110 %")))
    plain = calculate(line)
    rubbing = plain.balance.forces.total - plain.balance.forces.lift
    certain = sum(force.total for force in plain.balance.every if force.certain and force.kind != "lift")
    expected = plain.balance.forces.total + 0.1 * (rubbing - certain)
    assert high.balance.equilibrium.design_force == pytest.approx(
        expected, rel=1e-3
    )  # of the wraps at the higher take-up


@pytest.mark.parametrize(("method", "cema"), [("din 22101", None), ("cema classic", CEMA)])
def test_load_states_are_those_of_the_method(method, cema):
    line = by("overland", method, cema=cema)
    loads = every_load(line)
    settled = loads.own.balance.equilibrium
    parts = (("empty", "empty"), ("inclines", "inclines only"), ("declines", "declines only"))
    for key, loading in parts if cema is None else parts[:1]:  # CEMA's seals stand at every point that a case feeds
        case = with_case(line, conveyor.LoadCase(name=loading, loading=loading))
        (alone,) = calculate_many([Variant(case, take_up=settled.take_up)])
        state = loads.states.state(key)
        assert state.balance.forces.total == pytest.approx(alone.balance.forces.total, rel=1e-9)
        assert state.balance.tensions.largest == pytest.approx(alone.balance.tensions.largest, rel=1e-9)
    worst = loads.states.state("worst").balance.equilibrium.force
    count = loads.own.line.count
    flags = np.array([[bool(k >> i & 1) for i in range(count)] for k in range(2**count)])
    rises = np.array([section.rise for section in loads.own.line.sections])
    assert worst >= loads.own.balance.equilibrium.force
    assert flags.shape == (1024, 10)
    assert set(np.array([s.name for s in loads.own.line.sections])[rises > 0.0]) <= set(
        loads.states.state("worst").loaded
    )


@pytest.mark.parametrize("stem", ["overland", "in_plant_us", "downhill_brakes", "curved", "transfer"])
@pytest.mark.parametrize(("method", "cema"), [("din 22101", None), ("cema classic", CEMA)])
def test_every_report_can_be_made(stem, method, cema, tmp_path):
    line = by(stem, method, cema=cema)
    analysis = conveyor.analyse(line)
    made = analyse_studies(line, analysis)
    name = METHOD_NAMES[method]
    page = analysis.to_html(tmp_path / "page.html", made).read_text(encoding="utf-8")
    assert f"this calculation, {name}" in page
    assert f"Resistances: {name} with" in page
    assert "rolling contact" in page
    analysis.to_excel(tmp_path / "book.xlsx", made)
    told = json.loads(json.dumps(analysis.to_dict(made), allow_nan=False))
    # the take-up of every load moves the wraps of pulleys that are itemised
    assert told["power_kW"]["motor"] == pytest.approx(analysis.balance.power.motor / 1e3, rel=1e-3)
    assert not [text for text in analysis.warnings if "illustrative" in text or "roll drag not given" in text]


def test_the_rolling_contact_stands_beside():
    assessed = conveyor.analyse(by("in_plant_us", "din 22101")).assess()
    other = calculate(by("in_plant_us", "viscoelastic"))
    assert assessed.by_contact.balance.power.motor == pytest.approx(other.balance.power.motor, rel=1e-9)
    assert conveyor.analyse(by("in_plant_us", "viscoelastic")).assess().by_contact is None


def test_what_a_method_does_not_know_is_refused():
    with pytest.raises(InputError, match=r"cema: missing: method cema classic needs Ky and Ai"):
        by("overland", "cema classic")
    with pytest.raises(InputError, match='secondary: got "C" beside method cema classic, which has Tp and Tam'):
        by("overland", "cema classic", cema=CEMA, secondary="C")
    with pytest.raises(InputError, match="calibration"):
        by("overland", "din 22101", calibration={"indentation": 1.2})
    with pytest.raises(InputError, match='"din 22101" knows no rubber; compounds are compared'):
        conveyor.compare(by("overland", "din 22101"), ["S100", "S120"])
    with pytest.raises(InputError, match="method"):
        by("overland", "din 22102")
    with pytest.raises(InputError, match=r'method: got "cema universal": .* take "cema classic" with Ky'):
        by("overland", "cema universal")
