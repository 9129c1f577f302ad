"""One counterweight: what reports, studies and scenarios of a conveyor have is set for every load of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.calculated_conveyor import Variant
from conveyor.dynamics.simulation import prepare_setups, standard_scenarios
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate_many
from conveyor.results.analysis import analyse, analyse_studies
from conveyor.spec import load
from conveyor.studies.loads import every_load
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-6
"""Of the loop's settling where tension acts on rolls; without curves settings agree to rounding."""


@pytest.fixture(scope="module")
def line():
    """A load state asks for more of the take-up than the load that is given."""
    given = load(SPECS / "in_plant_us.yaml")
    return given.replace(
        operation={"duty": [{"hours": "2000 h", "share": "100 %"}, {"hours": "1000 h", "share": "50 %"}]},
        uncertainty={"roll_drag": "30 %", "draws": 64},
    )


@pytest.fixture(scope="module")
def found(line):
    return analyse_studies(line)


def test_one_setting_serves_every_load(line, found):
    alone = analyse(line)
    assert every_load(line).take_up > 1.05 * alone.balance.equilibrium.setting
    told = alone.to_dict(found)["take_up"]
    assert told["setting_N"] == pytest.approx(every_load(line).take_up, rel=RTOL)
    assert told["least_setting_N"] == pytest.approx(told["setting_N"], rel=2e-9)  # the least, both ways
    assert told["governed_by"].startswith("load state inclines only")
    assert found.to_dict()["take_up"] == told


def test_studies_of_one_report_have_its_power(found):
    own = found.states.own.balance.power
    assert found.uncertainty.motor == pytest.approx(own.motor, rel=RTOL)
    assert found.uncertainty.monte_carlo.power.min() < own.motor < found.uncertainty.monte_carlo.power.max()
    assert found.duty.rows[0].shaft == pytest.approx(own.motor, rel=RTOL)


def test_scenarios_begin_with_the_weight_of_the_report(line, found):
    rides, given = prepare_setups(line, standard_scenarios(line))
    assert {ride.setting for ride in rides} == {given.balance.equilibrium.setting}
    assert given.balance.equilibrium.setting == pytest.approx(found.states.setting, rel=RTOL)


def test_travel_of_the_carriage_counts_every_load(line, found):
    own = analyse(line)
    alone, told = own.take_up.travel, own.to_dict(found)["take_up"]
    lowest = min(state.balance.equilibrium.steady.mean(state.balance.line.loop.length) for state in found.states.states)
    assert lowest < own.balance.equilibrium.steady.mean(own.line.loop.length)
    assert told["travel_m"] > alone.whole


def test_a_weight_that_is_given_stands(line):
    heavy = line.replace(route=line.route.replace(take_up={"kind": "gravity", "tension": "40 kN"}))
    assert every_load(heavy).take_up == pytest.approx(si(heavy.route.take_up.tension), rel=RTOL)


def test_the_own_load_is_no_load_state_beside_itself(found):
    assert not [load.name for load in found.states.loads if load.name.startswith("load state full")]


def test_rolls_bear_the_tension_of_the_one_setting_in_every_load_state(line):
    """Where tension acts on the rolls, the full belt is the same conveyor as given and as a load state."""
    gives = line.replace(calculation=line.calculation.replace(support="belt"), uncertainty=None)
    loads = every_load(gives)
    full = loads.states.state("full")
    assert full.balance.power.motor == pytest.approx(loads.own.balance.power.motor, rel=RTOL)
    empty = loads.states.state("empty")
    (again,) = calculate_many(
        [Variant(with_case(gives, LoadCase(name="empty", loading="empty")), take_up=loads.states.take_up)]
    )
    assert empty.balance.power.motor == pytest.approx(again.balance.power.motor, rel=gives.calculation.rtol)


def test_the_load_as_given_is_among_those_that_govern():
    """Of a spec whose cases leave out the full belt the motors are for it all the same."""
    given = load(SPECS / "downhill.yaml").replace(cases=[{"name": "empty", "loading": "empty"}])
    found = analyse_studies(given)
    own, (motor,) = found.states.own, found.motors
    every = [own, *(load.found for load in (*found.states.loads, *found.cases.results))]
    held = min(one.governing_motor_power for one in every)
    assert motor.needed == pytest.approx(held, rel=RTOL)
    assert motor.rated * motor.count >= -held
    level = load(SPECS / "curved.yaml").replace(cases=[{"name": "empty", "loading": "empty"}])
    found = analyse_studies(level)
    assert [row.result.name for row in found.governing if row.key.startswith("largest_motor")] == ["as given"]
    assert found.motors[0].needed == pytest.approx(found.states.own.governing_motor_power, rel=RTOL)


def test_of_two_loads_that_are_one_the_same_governs_everywhere():
    """The empty belt as a load case and as a load state, which asks for most of motors and take-up."""
    given = load(SPECS / "downhill.yaml")
    route = given.route.replace(sections=[{"name": "slope", "length": "1800 m", "lift": "-54 m"}])
    given = given.replace(route=route, cases=[{"name": "bare", "loading": "empty"}])
    found = analyse_studies(given)
    told = analyse(given).to_dict(found)
    by_figure = {row.key: row.result.name for row in found.governing}
    assert by_figure["largest_tension_asked_of_the_take_up"] == "bare"
    assert told["take_up"]["governed_by"].startswith("bare, 18 °C: ")
    assert found.motors[0].case.text("US") == "bare, 64.4 °F"


def test_motor_power_of_all_loads_is_that_of_the_report():
    """A belt that drives its motors asks more of them than the empty one does of its own power."""
    given = load(SPECS / "downhill.yaml")
    loads, found = every_load(given), analyse(given)
    asked = analyse_studies(given)
    told = next(c for c in found.to_dict(asked)["checks"] if c["key"] == "motor_power" and c["governs"])
    assert told["where"] == "least friction"
    assert loads.motor_power == pytest.approx(1e3 * told["calculated"], rel=RTOL)
    rows = {row.key: row for row in found.contents(asked)["what_if"].rows}
    assert rows["what_if_maximum_motor_power"].label == "maximum motor power, driving or braking"
    assert rows["what_if_maximum_motor_power"].value == pytest.approx(loads.motor_power, rel=RTOL)


@pytest.fixture(scope="module")
def braked():
    """Downhill with brakes: the belt drives under its own load and is driven empty; no take-up is given."""
    given = load(SPECS / "downhill.yaml")
    return given.replace(drive=given.drive.replace(brake_force="200 kN"))


def test_a_take_up_on_the_slack_side_has_one_place_under_every_load(braked):
    loads = every_load(braked)
    force = [one.balance.equilibrium.force for one in loads.designing]
    assert force[0] < 0.0 < max(force)
    for one in loads.designing:
        (drive,) = one.balance.equilibrium.steady.drives
        assert drive.arriving == pytest.approx(loads.take_up, rel=1e-9)


@pytest.mark.parametrize("number", [1, 3])
def test_a_section_cut_in_seven_asks_for_the_same_take_up(braked, number):
    """A loading that hardly drives the belt asked for another setting than one that hardly holds it."""
    route = braked.route
    cut = route.sections[number]
    if cut.lift is None:
        parts = [cut.replace(name=f"{cut.name} {k}", length=cut.length / 7) for k in range(7)]
    else:
        parts = [cut.replace(name=f"{cut.name} {k}", length=cut.length / 7, lift=cut.lift / 7) for k in range(7)]
    sections = [*route.sections[:number], *parts, *route.sections[number + 1 :]]
    pieces = every_load(braked.replace(route=route.replace(sections=sections)))
    assert pieces.take_up == pytest.approx(every_load(braked).take_up, rel=1e-6)
