"""The worst loading by superposition is that of a search through all of them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from conveyor import load as load_spec
from conveyor.loop.balance import with_take_up_at
from conveyor.loop.load_superposition import (
    DRIVE_FORCE,
    HOLDING_BACK,
    HOLDING_DOWN,
    LEAST_FORCE,
    TAKE_UP,
    TENSION,
    SectionLoadings,
)
from conveyor.loop.start_and_stop import start_and_stop
from conveyor.loop.take_up_duty import at_common_setting
from conveyor.models import Conveyor, LoadCase
from conveyor.models.variants import with_case
from tests.loop.loop_lines import BOOSTER, DATA, TAIL_DRIVE, closed, line

CLOSED = 1e-11
"""Sums of 100 forces in whatever order, the drives' forces ten times the belt's smallest: 1e5 of 2e-16."""
FEEDING = DATA["route"]["feeding"]


def route(rng, count):
    """A conveyor that rises and falls, with drives, take-up, brakes and feeding points by chance; no pulleys.

    Without pulleys and flexure by sag nothing depends on the tensions, so that sums of forces are exact.
    """
    sections = [
        {"name": f"s{i}", "length": f"{rng.uniform(50, 600):.3f} m", "lift": f"{rng.uniform(-40, 40):.3f} m"}
        for i in range(count)
    ]
    drive = {"position": str(rng.choice(["head", "tail"]))}
    further = [BOOSTER | {"section": f"s{rng.integers(count - 1)}"}] if rng.random() < 0.5 else []
    further += [TAIL_DRIVE] if rng.random() < 0.3 else []
    if further:
        drive["further_drives"] = further
    if rng.random() < 0.5:
        drive |= {
            "brake_force": f"{rng.uniform(20, 200):.1f} kN",
            "reduced_mass": f"{rng.uniform(1, 20):.1f} t",
        }
    if rng.random() < 0.5:  # else all that the motors give
        drive["start_factor"] = 1.4
    made = {"sections": sections, "pulleys": []}
    kind = str(rng.choice(["gravity", "fixed", ""]))
    if kind:
        made["take_up"] = {"kind": kind, "position": str(rng.choice(["head", "tail"]))}
    if rng.random() < 0.3:
        made["feeding"] = FEEDING | {"share": 0.6}
        made["further_feeding"] = [FEEDING | {"section": "s1", "share": 0.4}]
    secondary = "C" if rng.random() < 0.2 else "itemised"
    return line(route=made, drive=drive, calculation={"secondary": secondary, "not_given": "nothing"})


def bearing(conveyor, loading):
    """The conveyor with bulk on those sections."""
    names = [s.name for s, on in zip(conveyor.route.sections, loading, strict=True) if on]
    if not names:
        flagged = [section.replace(loaded=False) for section in conveyor.route.sections]
        return conveyor.replace(route=conveyor.route.replace(sections=flagged, feeding=None, further_feeding=()))
    return with_case(conveyor, LoadCase(name="some", loading="sections", sections=names))


def added(conveyor):
    ends = [closed(with_case(conveyor, LoadCase(name=name, loading=name))) for name in ("full", "empty")]
    return SectionLoadings(*at_common_setting(ends))


def looked_for(found):
    """The figures by the loop itself."""
    settled = found.equilibrium
    grips = {
        drive.name: max(asked for name, asked in settled.conditions.items() if name.startswith(f"grip, {drive.name}, "))
        for drive in found.line.drives
    }
    moving = start_and_stop(found)
    figures = {
        DRIVE_FORCE: settled.force, LEAST_FORCE: -settled.least_force,
        TENSION: found.tensions.largest, TAKE_UP: settled.needed,
        HOLDING_BACK: moving.brake_to_hold if moving.rolls_back else 0.0,
        HOLDING_DOWN: 0.0 if moving.rolls_back else moving.brake_to_hold,
    }  # fmt: skip
    return figures | ({f"grip, {name}": grip for name, grip in grips.items()} if len(grips) > 1 else {})


@pytest.mark.parametrize("seed", range(12))
def test_figures_of_a_loading_are_those_of_its_loop(seed):
    rng = np.random.default_rng(seed)
    conveyor = route(rng, 6)
    found = added(conveyor)
    for loading in rng.random((4, 6)) < 0.5:
        alone = closed(bearing(conveyor, loading)).held(found.setting)
        scale = CLOSED * alone.tensions.largest
        expected = looked_for(alone)
        assert found.figures(loading) == pytest.approx(expected, rel=CLOSED, abs=scale)
        assert looked_for(*found.loaded([loading])) == pytest.approx(expected, rel=CLOSED, abs=scale)


@pytest.mark.parametrize("loading", list(itertools.product([False, True], repeat=4)))
def test_the_lift_over_a_tripper_goes_with_its_bulk(loading):
    tripper = FEEDING | {"section": "c", "tripper_lift": "5 m"}
    conveyor = line(route={"further_feeding": [tripper], "pulleys": []}, calculation={"not_given": "nothing"})
    found = added(conveyor)
    alone = closed(bearing(conveyor, loading)).held(found.setting)
    expected = looked_for(alone)
    scale = CLOSED * alone.tensions.largest
    assert found.figures(np.array(loading)) == pytest.approx(expected, rel=CLOSED, abs=scale)
    assert looked_for(*found.loaded([np.array(loading)])) == pytest.approx(expected, rel=CLOSED, abs=scale)


@pytest.mark.parametrize("kind", ["screw", "gravity"])
@pytest.mark.parametrize("loading", [(False,) * 3, *itertools.product([True], [False, True], [False, True])])
def test_the_pull_under_a_hopper_goes_with_its_bulk(kind, loading):
    """Filled, in flow and run out: its outlet ends within the second of three sections."""
    given = load_spec("examples/specs/feeder.yaml").as_data()
    (section,) = given["route"].pop("sections")
    sections = [
        section | {"name": name, "length": length} for name, length in zip("abc", ("3 m", "2 m", "3 m"), strict=True)
    ]
    take_up = {"kind": kind, "position": "tail" if kind == "screw" else "head"}
    route = given["route"] | {"sections": sections, "take_up": take_up, "pulleys": []}
    conveyor = Conveyor.from_data(given | {"route": route, "calculation": {"not_given": "nothing"}})
    found = added(conveyor)
    alone = closed(bearing(conveyor, loading)).held(found.setting)
    assert ("hopper filled" in alone.equilibrium.states) == loading[0]
    expected = looked_for(alone)
    scale = CLOSED * alone.tensions.largest
    assert found.figures(np.array(loading)) == pytest.approx(expected, rel=CLOSED, abs=scale)
    assert looked_for(*found.loaded([np.array(loading)])) == pytest.approx(expected, rel=CLOSED, abs=scale)


def test_no_loading_beats_the_worst_of_a_belt_with_a_tripper():
    tripper = FEEDING | {"section": "c", "tripper_lift": "5 m"}
    _never_beaten(added(line(route={"further_feeding": [tripper], "pulleys": []})))


@pytest.mark.parametrize("seed", range(15))
def test_no_loading_of_all_beats_the_worst(seed):
    rng = np.random.default_rng(100 + seed)
    count = int(rng.integers(2, 10))
    _never_beaten(added(route(rng, count)))


@pytest.mark.parametrize("seed", [901, *range(905, 911)])
def test_where_flexure_follows_the_tension_a_loading_is_closed_in_full_and_none_is_worse_by_more_than_it(seed):
    """Superposition takes the flexure of the full and the empty belt: the worst is off by no more than all of it."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 7))
    conveyor = route(rng, count)
    ends = [closed(with_case(conveyor, LoadCase(name=name, loading=name)), by_sag=True) for name in ("full", "empty")]
    found = SectionLoadings(*at_common_setting(ends))
    every = [np.array(on) for on in itertools.product([False, True], repeat=count)]
    alone = [closed(bearing(conveyor, loading), by_sag=True) for loading in every]
    alone = list(map(looked_for, with_take_up_at(alone, found.full.equilibrium.take_up)))
    for one, expected in zip(found.loaded(every), alone, strict=True):
        scale = CLOSED * one.tensions.largest
        assert looked_for(one) == pytest.approx(expected, rel=CLOSED, abs=scale)
    flexure = max(one.forces.parts["flexure"] for one in (found.full, found.empty))
    for figure, loading in found.worst().items():
        (worst,) = found.loaded([loading])
        assert looked_for(worst)[figure] >= max(one[figure] for one in alone) - flexure, figure


def test_no_loading_of_twelve_sections_beats_the_worst():
    _never_beaten(added(route(np.random.default_rng(7), 12)))


def _never_beaten(found):
    every = [found.figures(np.array(on)) for on in itertools.product([False, True], repeat=found.count)]
    worst = found.worst()
    assert {DRIVE_FORCE, TENSION, TAKE_UP} <= set(worst)
    for figure, loading in worst.items():
        most = max(figures[figure] for figures in every)
        assert found.figures(loading)[figure] == pytest.approx(most, rel=CLOSED), figure
    for figure in (LEAST_FORCE, HOLDING_BACK, HOLDING_DOWN):
        assert (figure in worst) == (max(figures[figure] for figures in every) > 0.0)


@pytest.mark.parametrize("seed", range(20, 28))
def test_estimates_at_constant_speed_are_the_extremes_of_every_loading(seed):
    """With one drive and a weight tensions are linear in the loading: sums of what every section adds are exact."""
    rng = np.random.default_rng(seed)
    conveyor = route(rng, int(rng.integers(2, 7)))
    alone = conveyor.drive.replace(further_drives=(), position="head" if seed % 2 else "tail")
    unit = {"kind": "gravity", "position": "tail" if seed % 4 < 2 else "head"}
    simple = conveyor.route.replace(feeding=None, further_feeding=(), take_up=unit)
    calculation = conveyor.calculation.replace(secondary="itemised")
    found = added(conveyor.replace(drive=alone, route=simple, calculation=calculation))
    state = found._states[0]
    every = []
    for on in itertools.product([False, True], repeat=found.count):
        loading = np.array(on)
        offsets = found._offsets(state, loading, *found._moved(state, loading))
        every.append(offsets - found._anchor @ offsets)
    scale, ends = CLOSED * np.abs(every).max(), found.stretch_at + 1
    tight, low = found._estimates(state)
    assert tight[ends] == pytest.approx(np.max(every, axis=0)[ends], rel=CLOSED, abs=scale)
    sag = np.maximum(found.least, found.least + found.more_least)
    assert np.all(low[ends] >= sag - np.min(every, axis=0)[ends] - scale)


@pytest.mark.parametrize("seed", range(30, 34))
def test_at_constant_speed_the_belt_comes_back_with_the_tension_it_left_with(seed):
    """What resists round the loop the drives give, by brakes and with least friction too."""
    rng = np.random.default_rng(seed)
    found = added(route(rng, 5))
    for loading in rng.random((4, 5)) < 0.5:
        for state in (one for one in found._states if one.over == 1.0):
            acceleration, forces = found._moved(state, loading)
            offsets = found._offsets(state, loading, acceleration, forces)
            assert acceleration == pytest.approx(0.0, abs=CLOSED)
            assert offsets[0] == pytest.approx(offsets[-1], abs=CLOSED * np.abs(offsets).max())


def test_signs_by_hand():
    # a level, b up, c steeply down: bulk on c drives, on the others it drags
    sections = [{"name": "a", "length": "300 m"}, {"name": "b", "length": "400 m", "lift": "20 m"},
                {"name": "c", "length": "200 m", "lift": "-20 m"}]  # fmt: skip
    found = added(line(route={"sections": sections, "pulleys": [], "take_up": {"kind": "gravity", "position": "head"}}))
    worst = found.worst()
    assert worst[DRIVE_FORCE].tolist() == [True, True, False]
    # the belt is tightest at the end of the climb; behind it bulk on c pulls towards the head and relieves nothing
    assert worst[TENSION][:2].tolist() == [True, True]
    assert found.figures(worst[DRIVE_FORCE])[DRIVE_FORCE] > found.figures(np.ones(3, bool))[DRIVE_FORCE]
