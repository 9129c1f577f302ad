"""Loops closed side by side: each is what it is alone, to the last bit, whatever stands in the rows beside it."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.errors import NoSolutionError
from conveyor.loop.balance import OpenLoop, close_loops
from tests.loop.loop_lines import DOWN, FRICTION, SECOND, closed, line
from tests.loop.test_loop import CASES

EVERY = (
    *CASES.values(),
    {"drive": {"further_drives": [SECOND], "installed_power": "600 kW", "start_factor": 1.3}},
    {"belt": {"speed": "3 m/s"}},
    {"belt": {"speed": "5 m/s"}, "drive": {"torque_factor": 2.0, "reduced_mass": "10 t"}},
    {"calculation": {"secondary": "C"}},
    {"route": {"sections": DOWN, "pulleys": []}},
)


@pytest.fixture(scope="module")
def loops():
    """Loops of many plans, several of each under other forces and speeds."""
    alone = [closed(line(**case), share * FRICTION) for case in EVERY for share in (0.4, 1.0, 2.5)]
    return [OpenLoop(one.layout, one.along, one.unit_main) for one in alone]


def figures(found):
    settled = found.equilibrium
    states = [
        figure
        for state in settled.states.values()
        for figure in (
            state.force,
            state.acceleration,
            state.largest,
            state.smallest,
            *state.starts,
            *state.spots,
        )
    ]
    return [settled.force, settled.least_force, settled.setting, *settled.bends, *states]


def test_a_loop_does_not_depend_on_those_beside_it(loops):
    """What a study promises: the same table for any number of workers, however it is cut. So equal, not close."""
    alone = [figures(one) for one in (close_loops([loop])[0] for loop in loops)]
    order = np.random.default_rng(3).permutation(len(loops))
    for part in (order, order[: len(order) // 3], order[-7:]):
        together = close_loops([loops[i] for i in part])
        assert [figures(one) for one in together] == [alone[i] for i in part]


def test_a_slack_loop_leaves_the_others_alone(loops):
    slack = loops[0]._replace(setting=-20e3)
    first, middle, last = close_loops([loops[1], slack, loops[2]])
    assert middle.tensions.smallest < -20e3 < 0.0
    assert figures(middle) == figures(close_loops([slack])[0])
    assert [figures(one) for one in (first, last)] == [figures(one) for one in close_loops(loops[1:3])]


@pytest.mark.parametrize("factor", [200.0, 1e8])
def test_wraps_that_grow_faster_than_the_tension_they_need_are_refused(loops, factor):
    """Two newtons of wrap a newton of tension have no answer above zero; the rows beside it do not feel it."""
    layout = loops[0].layout.scaled(lambda force: force)
    layout.bends = tuple(bend.times(factor) for bend in layout.bends)
    refused, other = close_loops([loops[0]._replace(layout=layout.scaled(lambda force: force)), loops[1]])
    assert isinstance(refused, NoSolutionError)
    assert "do not settle" in str(refused)
    assert figures(other) == figures(close_loops([loops[1]])[0])
