"""One take-up for every load: the least setting that serves all, its mass, its travel."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.loop.equilibrium import tension_suffices
from conveyor.loop.take_up_duty import at_common_setting, take_up_duty
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate
from conveyor.spec import load
from conveyor.studies.load_cases import analyse_cases
from conveyor.units import from_si
from tests.loop.loop_lines import DOWN, SPECS, TAIL_DRIVE, closed, line

LOADINGS = ("full", "empty", "inclines only", "declines only")
KINDS = ("gravity", "winch", "fixed", "screw", "locked winch")
BRAKED = {"position": "tail", "brake_force": "150 kN", "reduced_mass": "5 t"}
LINES = {
    "hilly": {},
    "hilly, two drives": {"drive": {"further_drives": [TAIL_DRIVE]}},
    "downhill, tail drive": {"route": {"sections": DOWN}, "drive": BRAKED},
}
BELT = 72.0 * 2000e3 * 1.0
"""EA of steel cord of 2000 N/mm and 1 m [N]."""


def loads(kind, changes, **take_up):
    route = changes.get("route", {}) | {"take_up": {"kind": kind, "position": "head", **take_up}}
    conveyor = line(**(changes | {"route": route}))
    return [closed(with_case(conveyor, LoadCase(name=name, loading=name))) for name in LOADINGS]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", LINES)
def test_one_setting_serves_every_state_of_every_load_and_is_the_least(name, kind):
    alone = loads(kind, LINES[name])
    found = at_common_setting(alone)
    (setting,) = {one.equilibrium.setting for one in found}
    assert all(not one.equilibrium.short for one in found)
    # more tension bends the belt harder, so that it asks for no less than the load that asks for most alone
    assert tension_suffices(setting, max(one.equilibrium.needed for one in alone))
    assert setting == pytest.approx(max(one.equilibrium.needed for one in found), rel=1e-9)
    lower = [one.held(setting * (1.0 - 1e-6)) for one in alone]
    assert any(one.equilibrium.short for one in lower)


def test_the_load_that_asks_for_most_need_not_be_the_full_one():
    empty, full = (
        closed(with_case(line(**LINES["downhill, tail drive"]), LoadCase(name=name, loading=name)))
        for name in ("empty", "full")
    )
    assert empty.equilibrium.needed > full.equilibrium.needed > 0.0
    assert full.held(empty.equilibrium.needed).tensions.largest > full.tensions.largest


@pytest.mark.parametrize("kind", KINDS)
def test_what_the_take_up_keeps_is_the_same_under_every_load(kind):
    found = at_common_setting(loads(kind, LINES["hilly"]))
    head, means = [], []
    for one in found:
        lengths = one.line.loop.length
        for state in one.equilibrium.states.values():
            head.append(state.held if kind in {"gravity", "winch"} else math.nan)
            means.append(float(0.5 * (state.starts + state.ends) @ lengths / lengths.sum()))
    if kind in {"gravity", "winch"}:
        assert np.ptp(head) == 0.0
        assert np.ptp(means) > 0.05 * max(means)
    else:
        # belt elongation, the integral of T/EA over the loop, is that of the mean
        assert means == pytest.approx([found[0].equilibrium.setting] * len(means), rel=1e-11)


def test_a_tension_that_is_given_stands():
    found = at_common_setting(loads("gravity", LINES["hilly"], tension="12 kN"))
    assert {one.equilibrium.setting for one in found} == {12e3}
    assert any(one.equilibrium.short for one in found)


def test_weight_on_four_strands():
    # 46.9 t on 4 strands: 115 kN, 20 t on 4 strands: 49.0 kN, with g 9.80665
    for mass, tension in (("46.9 t", 114.98e3), ("20 t", 49.03e3)):
        one = loads("gravity", {"calculation": {"gravity": "9.80665 m/s^2"}}, mass=mass, strands=4)[0]
        assert one.equilibrium.setting == pytest.approx(tension, rel=2e-4)
        duty = take_up_duty([one], [one.equilibrium.states.values()], [293.15])
        assert duty.mass == pytest.approx(float(mass.split()[0]) * 1e3, rel=1e-12)


def test_travel_is_the_belts_elongation_over_the_strands():
    found = at_common_setting(loads("gravity", LINES["hilly"], strands=4, reserve="50 %"))
    states = [one.equilibrium.states.values() for one in found]
    duty = take_up_duty(found, states, [253.15, 313.15, 293.15])
    lengths = found[0].line.loop.length
    steady = [
        float(0.5 * (one.equilibrium.steady.starts + one.equilibrium.steady.ends) @ lengths / lengths.sum())
        for one in found
    ]
    moved, travel = lengths.sum() / 4.0, duty.travel
    assert travel.load == pytest.approx(moved * (max(steady) - min(steady)) / BELT, rel=1e-9)
    assert travel.temperature == pytest.approx(moved * 12e-6 * 60.0, rel=1e-12)
    assert travel.permanent == pytest.approx(moved * 1e-3, rel=1e-12)
    whole = travel.tensioning + travel.load + travel.motion + travel.permanent + travel.temperature
    assert travel.reserve == pytest.approx(0.5 * whole, rel=1e-12)
    assert travel.whole == pytest.approx(1.5 * whole, rel=1e-12)
    # from slack to the highest mean tension of any state
    highest = max(state.mean(lengths) for of in states for state in of)
    assert travel.tensioning + travel.load + travel.motion == pytest.approx(moved * highest / BELT, rel=1e-9)


def test_a_held_length_only_tensions_the_belt_and_feels_its_temperature():
    found = at_common_setting(loads("screw", LINES["hilly"]))
    duty = take_up_duty(found, [one.equilibrium.states.values() for one in found], [273.15, 303.15])
    moved = found[0].line.loop.length.sum() / 2.0
    assert duty.travel.tensioning == pytest.approx(moved * duty.setting / BELT, rel=1e-9)
    assert duty.travel.load == pytest.approx(0.0, abs=1e-9 * duty.travel.tensioning)
    assert duty.mass is None
    assert duty.mean_change == pytest.approx(BELT * 12e-6 * 30.0, rel=1e-12)


@pytest.mark.parametrize(
    ("carcass", "factor", "stretch"),
    [({"kind": "EP"}, 5.0, 7.5e-3), ({"kind": "EP", "permanent_stretch": "0.4 %"}, 5.0, 4e-3),
     ({"kind": "polyamide", "stiffness": "9000 N/mm"}, 4.5, 7.5e-3), ({"kind": "cotton"}, None, None)],
)  # fmt: skip
def test_travel_of_textile_belts(carcass, factor, stretch):
    covers = {"thickness": "5 mm", "strength": "2000 N/mm"}
    one = closed(line(belt={"carcass": covers | carcass}))
    duty = take_up_duty([one], [one.equilibrium.states.values()], [293.15])
    if factor is None:
        assert duty.travel is None
        return
    moved = one.line.loop.length.sum() / 2.0
    assert duty.travel.permanent == pytest.approx(moved * stretch, rel=1e-12)
    highest = max(state.mean(one.line.loop.length) for state in one.equilibrium.states.values())
    travel = duty.travel
    assert travel.tensioning + travel.load + travel.motion == pytest.approx(
        moved * highest / (factor * 2000e3), rel=1e-9
    )


def test_cases_on_vertical_curves_are_those_of_a_conveyor_set_so():
    # curves load the rolls by tension, so the contacts follow the common setting
    given = load(SPECS / "downhill_brakes.yaml")
    open_ = given.route.take_up.replace(mass=None)
    curved = given.replace(route=given.route.replace(take_up=open_))
    cases = [LoadCase(name=name, loading=name) for name in ("empty", "full")]
    study = analyse_cases(curved, cases)
    setting = study.take_up.setting
    assert {one.found.balance.equilibrium.setting for one in study.results} == {setting}
    assert study.as_given.balance.equilibrium.setting == setting
    assert all(not one.found.balance.equilibrium.short for one in study.results)
    take_up = open_.replace(tension=from_si(setting, "force", "N"))
    fixed = curved.replace(route=curved.route.replace(take_up=take_up))
    for case, one in zip(cases, study.results, strict=True):
        there = calculate(with_case(fixed, case)).balance
        assert one.found.balance.forces.total == pytest.approx(there.forces.total, rel=1e-5)
        assert one.found.balance.tensions.largest == pytest.approx(there.tensions.largest, rel=1e-5)
