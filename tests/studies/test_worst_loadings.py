"""No loading makes a criterion worse than its report says: all 2^n of a conveyor, each calculated on its own."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.calculated_conveyor import Variant, common_take_up_duty
from conveyor.checks import Check, governing_by_subject, severity_rank, unsearched_criteria
from conveyor.laws.resistance.resistance_defaults import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.loop import worst_loadings
from conveyor.loop.take_up_duty import at_common_setting
from conveyor.loop.worst_loadings import CriterionLoadings
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate_many
from conveyor.report.tables.check_tables import check_table
from conveyor.results.analysis import Studies, analyse
from conveyor.spec import from_data, load
from conveyor.studies import calculate_studies
from conveyor.studies import one_take_up as of_one_take_up
from conveyor.studies import states as of_states
from conveyor.studies.loads import every_load
from conveyor.studies.one_take_up import at_one_take_up
from conveyor.studies.states import load_states
from conveyor.units.sentences import message
from tests.loop.loop_lines import DATA, closed, data, line
from tests.studies.every_loading import (
    PULLEYS,
    bearing,
    calculated,
    calculated_many,
    every_loading,
    judged,
    route,
)

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
SUMS = 1e-7
"""Margins: sums of 100 forces, 1e5 of 2e-16, over differences that are a thousandth of them and more."""

NEARLY = 1e-3
"""Of ratios of two sums the change of one section after the other may end so far from the worst; derived by trying."""


@pytest.fixture
def without_contacts(monkeypatch):
    for module in (of_states, of_one_take_up):
        monkeypatch.setattr(module, "calculate_many", calculated_many)


def reported(conveyor):
    """States at the one take-up, and by criterion the check that governs."""
    states, _ = at_one_take_up(load_states(conveyor, calculated(conveyor)), None)
    governing = governing_by_subject((*judged(states.own), *states.checks))
    return states, {(check.key, check.subject): check for check in governing}


def never_worse(governing, loads, tolerance):
    """No check of any load ranks before the one that governs."""
    for loading, found in loads:
        for check in judged(found):
            if check.key in unsearched_criteria(found.line):
                continue
            (verdict, margin, further), here = (
                severity_rank(governing[check.key, check.subject]),
                severity_rank(check),
            )
            words = f"{check.name.text()}: {check.found.text()} with {loading}"
            assert verdict <= here[0], words
            if verdict < here[0]:
                continue
            assert margin <= here[1] or margin - here[1] <= tolerance * max(1.0, abs(here[1])), words
            if margin == here[1]:
                assert further <= here[2] or further - here[2] <= tolerance * abs(here[2]), words


@pytest.mark.parametrize(
    ("seed", "count"),
    [
        (0, 2),
        (1, 3),
        (6, 3),
        (2, 4),
        (17, 4),
        (5, 4),
        (3, 5),
        (13, 5),
        (15, 5),
        (128, 6),
        (307, 6),
        (9, 7),
        (40, 9),
    ],
)
@pytest.mark.usefixtures("without_contacts")
def test_no_loading_is_worse_for_any_criterion(seed, count):
    conveyor = route(np.random.default_rng(seed), count)
    states, governing = reported(conveyor)
    loads = list(every_loading(conveyor, states.take_up))
    never_worse(governing, loads, SUMS)
    if states.own.take_up.travel is not None:
        asked = [common_take_up_duty([states.own, *(one.found for one in of)]).travel.whole
                 for of in (states.loads, [Found(found) for _, found in loads])]  # fmt: skip
        assert asked[0] == pytest.approx(asked[1], rel=SUMS)


class Found:
    """A load as `common_take_up_duty` is given them."""

    def __init__(self, found):
        self.found = found


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.usefixtures("without_contacts")
def test_with_pulleys_no_loading_is_worse_by_more_than_what_bends_the_belt(seed):
    """Superposition takes wraps and flexure of the full and the empty belt: it is off by no more than all of them."""
    conveyor = route(np.random.default_rng(500 + seed), 4, PULLEYS)
    states, governing = reported(conveyor)
    loads = list(every_loading(conveyor, states.take_up))
    bends = max(
        math.fsum(found.balance.equilibrium.bends) + found.balance.forces.parts["flexure"] for _, found in loads
    )
    lowest = min(abs(found.balance.equilibrium.steady.smallest) for _, found in loads)
    never_worse(governing, loads, 2.0 * bends / lowest)


def loadings(conveyor):
    """Loadings between the full and the empty belt of a conveyor without contacts."""
    count = len(conveyor.route.sections)
    return CriterionLoadings(*at_common_setting([closed(bearing(conveyor, [full] * count)) for full in (True, False)]))


@pytest.mark.parametrize("seed", [0, 1, 5, 8, 12])
def test_of_long_routes_changes_of_single_sections_find_what_all_loadings_have(seed, monkeypatch):
    """But the longest stop: where the belt nearly balances, it is as long as one likes."""
    between = loadings(route(np.random.default_rng(seed), 8))
    every = between.worst_of_each()
    monkeypatch.setattr(worst_loadings, "EXHAUSTIVE_SECTIONS", 1)
    changed = between.worst_of_each()
    assert set(changed) == set(every)
    for figure, (value, _) in every.items():
        if figure not in {"coast-down stop", "stop with brakes"}:
            assert changed[figure][0] == pytest.approx(value, rel=NEARLY, abs=SUMS), figure


def test_a_route_of_hundreds_of_sections_has_its_worst_stop_and_says_what_it_leaves_out():
    found = loadings(route(np.random.default_rng(1), 200))
    assert "curve_radius" in unsearched_criteria(found.line)
    assert "curve_radius" not in unsearched_criteria(calculated(line()).line)
    worst, rng = found.worst_of_each(), np.random.default_rng(2)
    tried = found.criterion_figures(rng.random((2000, 200)) < rng.random((2000, 1)))
    for figure in (
        "slip on stopping",
        "slip on starting",
        "coasting",
        "breakaway",
        "tension, steady",
        "mean, steady",
    ):
        assert worst[figure][0] >= tried[figure].max(), figure


def test_the_backstop_holds_what_lifts_more_than_its_friction():
    """Section by section: lift of belt and bulk less the least friction, where that is positive."""
    conveyor = load(SPECS / "overland.yaml")
    loads = every_load(conveyor)
    states = loads.states
    full, empty = (states.state(key).balance for key in ("full", "empty"))
    count, share = full.line.count, full.line.least_friction

    def held(balance):
        lift = sum(force.newtons for force in balance.along if force.certain)
        rubs = sum(force.newtons for force in balance.along if not force.certain)
        points = [f for f in balance.singles if not f.certain]
        landing = [sum(f.total for f in points if f.bulk == i) for i in range(count)]
        always = sum(f.total for f in points if f.bulk is None)
        return (lift - share * rubs)[:count] - share * np.array(landing), (lift - share * rubs)[
            count:
        ].sum() - share * always

    (laden, back), (bare, _) = held(full), held(empty)
    best = np.where(laden > bare, laden, bare)
    governs = next(check for check in loads.governing if check.key == "holding_brake")
    worst = states.state("worst_holding_force_of_a_backstop")
    assert worst.loaded == tuple(s.name for s, on in zip(full.line.sections, laden > bare, strict=True) if on)
    assert worst.loaded == ("first climb", "second climb", "plant approach", "discharge")
    # the rolls of a belt so loaded strain the rubber less than those of the full one: a few per cent of the friction
    assert governs.required == pytest.approx(best.sum() + back, rel=0.03)
    assert governs.case.text() == "load state worst for holding force of a backstop, 20 °C"
    case = LoadCase(name="again", loading="sections", sections=worst.loaded)
    (again,) = calculate_many([Variant(with_case(conveyor, case), take_up=states.take_up)])
    assert governs.required == pytest.approx(again.motions.brake_to_hold, rel=1e-6)
    assert governs.required > 1.3 * states.load(states.state("inclines")).found.motions.brake_to_hold


def test_downhill_with_brakes_no_loading_calculated_in_full_is_worse():
    """All 32 with contacts of their own; superposition takes the strain of the rubber under the full and empty belt."""
    conveyor = load(SPECS / "downhill_brakes.yaml")
    loads = every_load(conveyor)
    governing = {(check.key, check.subject): check for check in loads.governing}
    names = [section.name for section in conveyor.route.sections]
    cases = [
        LoadCase(name="some", loading="sections", sections=some)
        for some in (list(itertools.compress(names, on)) for on in itertools.product([True, False], repeat=5))
        if some
    ]
    variants = [Variant(with_case(conveyor, case), take_up=loads.states.take_up) for case in cases]
    never_worse(
        governing,
        [(case.sections, found) for case, found in zip(cases, calculate_many(variants), strict=True)],
        0.01,
    )
    assert loads.states.state("worst_concave_curve_hollow_carry_empty_belt_stays_down").loaded == (
        "hollow",
        "plant",
    )
    (slip,) = (c for (key, _), c in governing.items() if key == "bulk_slip_stopping")
    assert slip.calculated == pytest.approx(1.580, abs=0.0005)  # 1.501 at the least friction alone


def test_of_criteria_without_anything_there_the_one_that_needs_most_governs():
    none = message("")

    def lacking(required, case):
        verdict = "not checked"
        return Check("holding_brake", none, 0.0, required, "force", none, none, verdict, case=case)

    few, much = lacking(2e4, message("a")), lacking(4e4, message("b"))
    assert governing_by_subject([few, much]) == (much,)
    assert governing_by_subject([much, few]) == (much,)

    def stop(seconds):
        return Check("comes_to_rest", none, seconds, None, "duration", none, none, "pass", None, "at most")

    short, long, never = stop(10.0), stop(20.0), stop(None)
    assert governing_by_subject([short, long]) == (long,)
    assert governing_by_subject([short, never, long]) == (never,)


def test_what_is_not_sought_says_so_beside_its_figure():
    conveyor = load(SPECS / "overland.yaml")
    loads = every_load(conveyor)
    table = check_table(loads.governing, "SI", unsearched_criteria(loads.own.line))
    shown = {row.subject: row.case for row in table.rows}
    assert shown["penetration of the cover, carry rolls"] == "as given; other loadings not searched"
    assert not any(
        "not sought" in case for name, case in shown.items() if "penetration" not in name and "rubber" not in name
    )
    alone = check_table(analyse(conveyor).checks, "SI", unsearched_criteria(loads.own.line))
    assert {row.case for row in alone.rows} == {"as given"}


def test_a_state_is_named_by_the_first_of_what_it_governs_and_lists_all():
    found = calculate_studies(load(SPECS / "downhill_brakes.yaml")).states
    most = max(found.states, key=lambda state: len(state.worst_for))
    first, second, *more = most.worst_for
    assert most.name == f"worst for {first}, {second} and {len(more)} more"
    told = Studies(states=found).to_dict()["worst_states"]
    assert list(most.worst_for) in [state["worst_for"] for state in told]


@pytest.mark.usefixtures("without_contacts")
def test_motors_not_given_start_the_empty_belt_with_what_the_full_one_needs():
    """Rolls that drag four times as much as the rest: 1.3 times the empty belt's force does not break it away."""
    idlers = {strand: DATA["idlers"][strand] | {"roll": DATA["idlers"][strand]["roll"] | {"drag": "60 N"}}
              for strand in ("carry", "return")}  # fmt: skip
    given = data(idlers=idlers)
    del given["drive"]["installed_power"]
    conveyor = from_data(given)
    states, governing = reported(conveyor)
    (start,) = (check for (key, _), check in governing.items() if key == "breakaway")
    needs = max(state.balance.equilibrium.force for state in states.states)
    assert start.calculated == pytest.approx(1.3 * needs, rel=1e-12)
    empty = states.load(states.state("empty")).found
    assert empty.motions.start.standstill < empty.motions.start.breakaway < 1.3 * needs
    (of_empty,) = (check for check in judged(empty) if check.key == "breakaway")
    assert of_empty.verdict == "pass"
    given["drive"]["installed_power"] = "1 kW"  # what is given is what there is
    _, weak = reported(from_data(given))
    assert {check.verdict for (key, _), check in weak.items() if key == "breakaway"} == {"FAIL"}


def test_a_start_without_control_breaks_the_belt_away_with_the_torque_at_rest():
    """Of 1.6 times 110 kW x 94 % / 4 m/s the drives' 10 t keep what accelerates them."""
    drive = {name: value for name, value in DATA["drive"].items() if name != "start_factor"}
    torques = [{"speed": "0 %", "torque": 1.6}, {"speed": "100 %", "torque": 2.4}]
    drive |= {"torque_curve": torques, "installed_power": "110 kW", "reduced_mass": "10 t", "efficiency": "94 %"}
    given = line(drive=drive, calculation={"not_given": "nothing"})
    count = len(given.route.sections)
    ends = at_common_setting([closed(bearing(given, [each] * count)) for each in (True, False)])
    balance = ends[0]
    mass, steady = balance.equilibrium.mass, balance.equilibrium.resistance(1.0)
    at_rest = steady + (1.6 * 110e3 * 0.94 / 4.0 - steady) * mass / (mass + 10e3)
    stuck = (ROLL_DRAG_STANDSTILL_FACTOR - 1.0) * float(balance.line.roll_drag_forces.sum())
    (value,) = CriterionLoadings(*ends).criterion_figures(np.ones((1, count), dtype=bool))["breakaway"]
    assert value == pytest.approx(-at_rest / (steady + stuck), rel=1e-9)
