"""Forming and opening of a pipe: strips against their true lengths, checks on both strands."""

from __future__ import annotations

import math

import numpy as np
import pytest

import conveyor
from conveyor.checks.pulley_checks import belt_transitions
from conveyor.errors import InputError
from conveyor.laws.pipe_geometry import pipe_transition_stretch
from conveyor.laws.transition import transition_stretch
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from tests.command_line import ROOT

SPEC = ROOT / "examples" / "specs" / "pipe.yaml"
BELT = {"belt_width": 1.46, "diameter": 0.38}


@pytest.mark.parametrize("height", [0.0, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("width", [1.25, 1.46, 2.3])
def test_strips_are_as_long_as_straight_lines_to_the_circle(height, width):
    """Lengths of straight lines at 100 m, by hand: first order leaves (s/L)² < 2e-4 of it, the mean 1e-5."""
    s, r, long = (np.arange(100_000) + 0.5) / 100_000 * width / 2.0, 0.19, 100.0
    beside, above = s - r * np.sin(s / r), r * (1.0 - np.cos(s / r)) - height * 0.38
    length = np.sqrt(long**2 + beside**2 + above**2)
    stretch = (length / length.mean() - 1.0) * long**2
    law = pipe_transition_stretch(width, diameter=0.38, pulley_height=height)
    largest = max(abs(stretch))
    assert law.edge == pytest.approx(stretch[-1], abs=3e-4 * largest)
    assert law.middle == pytest.approx(stretch[0], abs=3e-4 * largest)
    assert law.least == pytest.approx(stretch.min(), abs=3e-4 * largest)


def test_a_shallow_pipe_is_a_flat_belt():
    """Round a circle of many times its width the belt keeps flat: its edges are as long as its middle."""
    shallow = pipe_transition_stretch(1.0, diameter=1000.0, pulley_height=0.0)
    flat = transition_stretch(1.0, middle_roll_length=1.0, trough_angle=0.0, pulley_height=0.0)
    assert shallow.edge == pytest.approx(flat.edge, abs=(0.5**2 / 1000.0) ** 2)  # rise s²/D


def test_a_belt_that_laps_twice_is_refused():
    with pytest.raises(InputError, match="belt_width"):
        pipe_transition_stretch(2.4, diameter=0.38, pulley_height=0.5)


@pytest.fixture(scope="module")
def formed():
    given = {"length": "20.9 m", "pulley_height": "50 %"}
    return calculate(with_fields(conveyor.load(SPEC), {"route.head_transition": given, "route.tail_transition": given}))


def test_both_strands_form_at_both_ends_at_their_own_tensions(formed):
    found = {check.zone.name: check for check in formed.belt_duty.transitions}
    assert set(found) == {"head", "tail", "head, return", "tail, return"}
    steady, half = formed.balance.equilibrium.steady, formed.line.count
    at = {"head": steady.ends[-1], "tail": steady.starts[half],
          "head, return": steady.starts[0], "tail, return": steady.ends[half - 1]}  # fmt: skip
    for name, tension in at.items():
        assert found[name].lowest <= float(tension) / 1.46 <= found[name].highest
        assert found[name].by_rule == pytest.approx(20.9)  # 55 x 380 mm


def test_the_least_length_keeps_edge_and_middle(formed):
    """By hand: E ε = E ε L²/L² over the least length is what the limit leaves."""
    law = pipe_transition_stretch(1.46, diameter=0.38, pulley_height=0.5)
    stiffness = 72.0 * 3150e3
    for check in formed.belt_duty.transitions:
        rated = 3150e3 / 6.7
        if math.isfinite(check.stretched):
            assert check.highest + stiffness * law.edge / check.stretched**2 == pytest.approx(1.3 * rated, rel=1e-9)
        assert check.lowest + stiffness * law.least / check.slackened**2 == pytest.approx(0.0, abs=1e-6 * rated)
        assert check.most == pytest.approx(check.highest + stiffness * law.edge / 20.9**2, rel=1e-12)


def test_a_short_forming_length_fails():
    short = {"route.head_transition": {"length": "5 m"}}
    checks = list(belt_transitions(calculate(with_fields(conveyor.load(SPEC), short))))
    assert {check.verdict for check in checks} == {"FAIL"}
    assert any("head, return transition" in str(check.subject) for check in checks)


def test_a_flat_return_strand_has_no_pipe_to_form():
    flat = {"rolls": 1, "spacing": "3 m", "roll": {"diameter": "152 mm", "length": "1600 mm", "rotating_mass": "20 kg"}}
    given = {"idlers.return": flat, "route.head_transition": {"length": "20 m"}}
    result = calculate(with_fields(conveyor.load(SPEC), given))
    assert [check.zone.name for check in result.belt_duty.transitions] == ["head"]
