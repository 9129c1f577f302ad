"""Tensions, torques and powers that parts are sized by, against statics by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from conveyor import shelf
from conveyor.models.sizing import SizingDuty
from conveyor.sizing import design_search, part_sizing
from conveyor.sizing.screen import Candidates, first_calibration, screen_candidates
from conveyor.sizing.sizing_task import SizingTask


@pytest.fixture
def task():
    return SizingTask(
        SizingDuty.from_data({
            "name": "rising",
            "material": {
                "name": "coal", "density": "850 kg/m^3", "flow": "400 t/h", "surcharge_angle": "20 deg"
            },
            "lump": "100 mm",
            "length": "300 m",
            "lift": "40 m",
            "ambient": {"temperature": "20 degC"},
            "operation": {"hours_per_year": "4000 h", "price": "0.12 EUR/kWh"},
            "covers": [shelf.compound("standard-cover")],
            "rules": {"drives": ["head"], "carcasses": ["EP"], "carry_sag": "5 %", "return_sag": "5 %",
                      "take_up_travel": "100 m"},
        })
    )  # fmt: skip


def test_the_estimated_belt_bears_what_grip_and_force_ask(task):
    """Eytelwein at the head of a rising belt: T1 = F (1 + 1.3/(e^(0.35 × 210°) - 1)); 5 % of sag asks for less."""
    every = Candidates.of(task)
    found = screen_candidates(task, every, first_calibration(1))
    pull = found.design_force * (1.0 + 1.3 / math.expm1(0.35 * math.radians(210.0)))
    width = every.runs(lambda on: on.trough.width.belt)
    strongest = task.carcasses["EP"][-1]
    assert found.uses["belt strength"] == pytest.approx(8.0 * pull / width / strongest.strength, rel=1e-9)
    assert np.all(found.design_force > 0.0)


def test_estimated_indentation_goes_with_rolls_and_spans_as_that_of_a_roll(task):
    """(h/D²)^(1/3) p^(4/3) of each set: a belt on larger rolls loses (D1/D2)^(2/3), on wider spans (a2/a1)^(1/3)."""
    every = Candidates.of(task)
    found = screen_candidates(task, every, first_calibration(1))
    diameter = every.runs(lambda on: on.roll.diameter)
    known = list(dict.fromkeys((on.trough, on.speed) for on in every.running))
    running = every.runs(lambda on: known.index((on.trough, on.speed)))
    spans = np.array([np.array(apart)[every.numbers[:, 1 + k]] for k, apart in enumerate(task.spacings)])
    alike = np.column_stack([running, every.numbers[:, 3:], found.carcass])
    seen = 0
    for one in np.unique(alike, axis=0):
        rows = np.flatnonzero((alike == one).all(axis=1))
        seen += np.unique(diameter[rows]).size > 1 and np.unique(spans[1, rows]).size > 1
        for k in range(2):
            law = found.scaled_forces[rows, k] * diameter[rows] ** (2.0 / 3.0) / np.cbrt(spans[k, rows])
            assert law == pytest.approx(law[0], rel=1e-9)
    assert seen


def held(force: float, *, rolls_back: bool = True) -> SimpleNamespace:
    """A load whose belt is held by a force [N]."""
    return SimpleNamespace(motions=SimpleNamespace(rolls_back=rolls_back, brake_to_hold=force))


@pytest.mark.parametrize(("force", "torque"), [(10e3, 3.15e3), (20e3, 6.3e3), (19e3, 6.3e3)])
def test_a_backstop_holds_over_the_radius_of_its_pulley(force, torque):
    """1.3 × 10 kN × 0.48/2 m ... 3.12 kN m for a pulley of 0.48 m: the next of R10 is 3.15 kN m."""
    assert part_sizing._backstop_torque(0.48, [held(force), held(9e9, rolls_back=False)]) == pytest.approx(torque)
    assert part_sizing._backstop_torque(0.48, [held(force, rolls_back=False)]) == 0.0


def test_the_take_up_gives_the_slackest_load_what_it_lacks():
    """20 kN of tension and 4.2 kN too little: 24.5 kN in steps of 500 N; who asks for less has nothing to say."""

    def load(setting: float, needed: float, *smallest: float) -> SimpleNamespace:
        settled = SimpleNamespace(setting=setting, needed=needed)
        states = [SimpleNamespace(smallest=one) for one in smallest]
        return SimpleNamespace(balance=SimpleNamespace(equilibrium=settled), motion_states=states)

    task = SimpleNamespace(take_up_step=500.0)
    slack, taut = load(20e3, 18e3, 3e3, -4.2e3), load(12e3, 12e3, 1e3)
    for loads in ([slack, taut], [taut, slack]):
        assert part_sizing._take_up_setting(task, 0.0, loads, written=False) == pytest.approx(24.5e3)
        assert part_sizing._take_up_setting(task, 26e3, loads, written=True) == pytest.approx(26e3)  # it is enough
    assert part_sizing._take_up_setting(task, 0.0, [taut], written=False) == 0.0
    assert part_sizing._take_up_setting(task, 0.0, [taut], written=True) == pytest.approx(12e3)


def test_motors_break_the_belt_away_with_their_rated_power(monkeypatch):
    """50 kN × 2.5 m/s / 0.94 by two drives is 66.49 kW each, for which the reserve of 1.1 need not be added again."""
    monkeypatch.setattr(part_sizing, "_drive_powers", lambda _: [20e3, 20e3])
    monkeypatch.setattr(part_sizing, "_powers_by_basis", lambda *_: ())

    def load(force: float) -> SimpleNamespace:
        start = SimpleNamespace(force=force, breakaway=50e3)
        line = SimpleNamespace(speed=2.5, efficiency=0.94, drives=(1, 2))
        return SimpleNamespace(motions=SimpleNamespace(design_start=start), line=line)

    rules = SimpleNamespace(rules=SimpleNamespace(motor_reserve=1.1))
    assert part_sizing._required_power(rules, [load(40e3)]) == pytest.approx(66.489e3 / 1.1, rel=1e-5)
    assert part_sizing._required_power(rules, [load(60e3)]) == pytest.approx(20e3)  # the start itself breaks it away


@pytest.mark.parametrize(("best", "tried"), [(1, 3), (3, 3), (5, 5), (9, 6)])
def test_three_designs_at_least_are_tried_with_graduated_spacings(monkeypatch, best, tried):
    """The best one must not depend on how many are wanted: a list of one looks at three, a longer one at all of it."""
    seen, lacking = [], []
    monkeypatch.setattr(design_search, "_graduated_designs", lambda _, designs: seen.extend(designs) or [])
    monkeypatch.setattr(design_search, "foresee_parts", lambda *_: None)
    monkeypatch.setattr(design_search, "size_parts", lambda _, begin, **__: ["too weak"] * len(begin))
    task = SimpleNamespace(rules=SimpleNamespace(graduated=True), sections=(1, 2))
    search = SimpleNamespace(task=task, failed=lambda design, _: lacking.append(design.year))
    designs = [SimpleNamespace(year=year, choice=None, estimate=0.0) for year in (5.0, 2.0, 6.0, 1.0, 4.0, 3.0)]
    assert design_search._final_designs(search, designs, best) == []
    assert [design.year for design in seen] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0][:tried]
    assert lacking == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
