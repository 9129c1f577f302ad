"""Load states: the four of every report, the worst by superposition against full calculations, at one take-up."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import InputError
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate, calculate_many
from conveyor.results.analysis import Studies
from conveyor.spec import load
from conveyor.studies import calculate_studies
from conveyor.studies.states import LoadState, load_states
from conveyor.units import quantity, si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-6
"""Of the contacts: curves over different ranges of load differ by no more than twice it."""


@pytest.fixture(scope="module")
def line():
    """Five sections that rise, fall and are level; rubber without strain, so that a section's load is its own."""
    given = load(SPECS / "overland.yaml")
    sections = [
        {"name": "loading", "length": "200 m"}, {"name": "climb", "length": "900 m", "lift": "45 m"},
        {"name": "descent", "length": "800 m", "lift": "-40 m"}, {"name": "fields", "length": "1500 m"},
        {"name": "discharge", "length": "150 m", "lift": "9 m"},
    ]  # fmt: skip
    return given.replace(
        route=given.route.replace(sections=sections),
        calculation=given.calculation.replace(strain="off"),
    )


@pytest.fixture(scope="module")
def own(line):
    return calculate(line)


@pytest.fixture(scope="module")
def found(line, own):
    return load_states(line, own)


def test_the_four_are_full_calculations_at_the_take_up_of_the_report(line, own, found):
    setting = own.balance.equilibrium.setting
    for key, loading in (("full", "full"), ("empty", "empty"), ("inclines", "inclines only"),
                         ("declines", "declines only")):  # fmt: skip
        one = with_case(line, LoadCase(name=loading, loading=loading))
        take_up, friction = own.balance.equilibrium.take_up, own.line.design_friction
        (alone,) = calculate_many([Variant(one, take_up=take_up, design_friction=friction)])
        state = found.state(key)
        assert state.balance.equilibrium.setting == setting
        assert state.balance.forces.total == pytest.approx(alone.balance.forces.total, rel=2.0 * RTOL)
        assert state.balance.tensions.largest == pytest.approx(alone.balance.tensions.largest, rel=2.0 * RTOL)
        assert state.balance.equilibrium.needed == pytest.approx(alone.balance.equilibrium.needed, rel=2.0 * RTOL)


def test_sections_that_a_state_loads_are_said(found):
    words = {key: found.state(key).loaded_in_words for key in ("full", "empty", "inclines", "declines", "worst")}
    assert words == {
        "full": "all", "empty": "none", "inclines": "climb, discharge", "declines": "descent",
        "worst": "all but descent",
    }  # fmt: skip


def test_rows_of_sections_are_named_by_their_ends(own):
    balance = own.balance
    named = LoadState("some", ("loading", "climb", "descent"), 293.15, (), (), balance)
    assert named.loaded_in_words == "loading to descent"
    assert LoadState("some", ("loading", "climb"), 293.15, (), (), balance).loaded_in_words == "loading, climb"


def test_no_loading_calculated_in_full_beats_the_worst(line, found):
    names = [section.name for section in line.route.sections]
    loads = [
        LoadCase(name="some", loading="sections", sections=some)
        for count in range(1, len(names) + 1)
        for some in itertools.combinations(names, count)
    ]
    variants = [Variant(with_case(line, case), take_up=found.take_up) for case in loads]
    every = [one.balance for one in calculate_many(variants, 1e-4)]
    # contacts of 1e-4 make half of the force along the belt
    margin = 1.0 + 2e-4
    power = max(one.power.belt for one in every)
    assert found.state("worst").balance.power.belt * margin >= power
    tight = max(one.tensions.largest for one in every)
    assert found.state("worst_largest_tension").balance.tensions.largest * margin >= tight
    asked = max(one.equilibrium.needed for one in every)
    assert found.state("worst_tension_of_the_take_up").balance.equilibrium.needed * margin >= asked


def test_the_worst_may_be_what_installed_motors_do_not_give(line, own):
    power = own.balance.power.motor
    full = f"{1.02 * power:.0f} W"  # full belt, not all but the decline
    given = line.replace(drive=line.drive.replace(installed_power=full))
    checked = {check.key: check for check in load_states(given).checks}
    assert checked["motor_power"].verdict == "FAIL"
    assert "worst for drive force" in checked["motor_power"].case.text()
    assert checked["take_up_tension"].verdict == "FAIL"
    assert checked["slack_belt"].verdict == "pass"


def test_cold_cases_are_looked_at_too(line):
    cases = [
        LoadCase(name="full", loading="full", temperatures=("-20 degC", "30 degC")),
        LoadCase(name="empty", loading="empty", temperatures=("-20 degC",)),
    ]
    found = calculate_studies(line.replace(cases=cases))
    worst = found.states.state("worst")
    assert worst.temperature == pytest.approx(253.15)
    setting = found.cases.as_given.balance.equilibrium.setting
    assert {state.balance.equilibrium.setting for state in found.states.states} == {setting}
    assert {result.found.balance.equilibrium.setting for result in found.cases.results} == {setting}
    warm = found.states.state("full")
    assert warm.temperature == pytest.approx(293.15)
    assert worst.balance.power.belt > warm.balance.power.belt


def test_the_worst_at_another_temperature_may_be_the_empty_belt(line):
    """Downhill the empty belt asks most of the drives, in the cold more than at the spec's temperature."""
    sections = [{"name": "descent", "length": "800 m", "lift": "-40 m"}]
    cases = [LoadCase(name="empty", loading="empty", temperatures=("-20 degC",))]
    found = calculate_studies(line.replace(cases=cases, route=line.route.replace(sections=sections)))
    worst = found.states.state("worst")
    (empty,) = (result for result in found.cases.results if result.case.loading == "empty")
    assert (worst.loaded, worst.temperature) == ((), empty.temperature)
    assert worst.balance.forces.total == pytest.approx(empty.found.balance.forces.total, rel=2.0 * RTOL)


def test_a_case_loads_the_sections_it_names(line):
    one = with_case(line, LoadCase(name="some", loading="sections", sections=("climb", "fields")))
    assert [section.loaded for section in one.route.sections] == [False, True, False, True, False]
    with pytest.raises(InputError, match=r'load case "some": sections: got "hill", which is none of the sections'):
        with_case(line, LoadCase(name="some", loading="sections", sections=("hill",)))
    with pytest.raises(InputError, match=r'sections: missing: loading "sections" needs their names'):
        LoadCase.from_data({"name": "some", "loading": "sections"})
    with pytest.raises(InputError, match=r'sections: got 1 names with loading "full"'):
        LoadCase.from_data({"name": "some", "loading": "full", "sections": ["climb"]})
    with pytest.raises(InputError, match=r"cases\.0\.sections\.0|cases\[0\]\.sections\[0\]"):
        line.replace(cases=[{"name": "some", "loading": "sections", "sections": ["hill"]}])


def test_variants_side_by_side_have_their_own_wind_and_series() -> None:
    line = load("examples/specs/curved.yaml")
    variants = [
        line.replace(ambient=line.ambient.replace(wind_speed=quantity("10 m/s"))),
        line.replace(ambient=line.ambient.replace(wind_speed=quantity("30 m/s"))),
        line.replace(report={"units": "US"}),
    ]
    together = calculate_many([Variant(one) for one in variants])
    seen = [(one.line.wind_speed, one.line.us_sizes) for one in together if isinstance(one, CalculatedConveyor)]
    assert seen == [
        (pytest.approx(10.0), False),
        (pytest.approx(30.0), False),
        (pytest.approx(si(line.ambient.wind_speed)), True),
    ]


def test_a_loading_that_is_several_states_is_listed_once(line):
    """Nothing rises or falls on a level belt, nothing falls on one that climbs; programs find all keys."""
    route = line.route.replace(sections=[{"name": "gallery", "length": "500 m"}])
    level, climbs = map(load_states, (line.replace(route=route), load(SPECS / "in_plant_us.yaml")))
    assert [state.name for state in level.states if not state.name.startswith("worst")] == ["full", "empty"]
    assert level.state("inclines") is level.state("declines") is level.state("empty")
    assert [state.name for state in climbs.states][:3] == ["full", "empty", "inclines only"]
    assert climbs.state("declines") is climbs.state("empty")
    for found in (level, climbs):
        told = Studies(states=found).to_dict()
        assert list(told["states"]) == ["empty", "full", "inclines", "declines", "worst"]
