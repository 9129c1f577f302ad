"""What the dynamics must come to: the package's own steady and quasi-static tensions, and its rigid belt."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.dynamics.cut_loop import CutLoop
from conveyor.dynamics.machines import ScenarioSetup
from conveyor.dynamics.simulation import ERROR, simulate_batch
from conveyor.forces import rubber_free_forces
from conveyor.line.contacts import Contacts
from conveyor.line.drive_scenarios import ScenarioUnit
from conveyor.models import Scenario
from tests.loop.loop_lines import BOOSTER, DATA, SECOND, TAIL_DRIVE, closed, line

MASSES = {"reduced_mass": "4 t"}


def ridden(conveyor, scenario):
    """A scenario on a conveyor without contacts."""
    found = closed(conveyor)
    steady = CalculatedConveyor(
        conveyor,
        conveyor.temperature,
        Contacts(found.line, {}, (), ()),
        found,
        rubber_free_forces(found.line.strands),
    )
    loop = CutLoop.of(steady)
    scene = ScenarioUnit.of(Scenario.from_data({"name": "test"} | scenario), conveyor)
    return ScenarioSetup(scene, loop, loop, found.equilibrium.setting)


def followed(conveyor, scenario, step=0.02):
    (found,) = simulate_batch([ridden(conveyor, scenario)], step)
    return found


def quiet(found, state):
    """Tensions of cells that no boundary of stretches touches, beside those of a state of the package."""
    loop, middles = found.setup.loop, found.middles
    size = np.diff(found.cells.at)
    starts, ends = state.starts[loop.order], state.ends[loop.order]
    for k, tension in enumerate(middles):
        i = int(np.searchsorted(loop.way, tension, side="right")) - 1
        if loop.way[i] + 2.0 * size[k] < tension < loop.way[i + 1] - 2.0 * size[k]:
            share = (tension - loop.way[i]) / (loop.way[i + 1] - loop.way[i])
            yield k, starts[i] + share * (ends[i] - starts[i])


NO_RUSH = {"speed": "4 m/s", "skirt_length": "4 m", "skirt_width": "600 mm"}
"""Bulk as fast as the belt: else what accelerates it falls with the square of the belt's speed."""
NOTHING = {"begins": "running", "events": [{"at": "1 h", "do": "power off"}], "duration": "5 s"}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"drive": {"further_drives": [BOOSTER | MASSES, TAIL_DRIVE | MASSES]}},
        {"drive": {"further_drives": [SECOND | MASSES]}},
        {"route": {"take_up": {"kind": "gravity", "position": "tail"}}},
        {"route": {"take_up": {"kind": "gravity", "position": "return", "section": "b"}}},
        {"route": {"take_up": {"kind": "fixed"}}},
        {"route": {"sections": [{"name": "a", "length": "100 m"}, {"name": "b", "length": "900 m", "lift": "-110 m"},
                                {"name": "c", "length": "80 m"}, {"name": "d", "length": "80 m"}],
                   "pulleys": DATA["route"]["pulleys"][:3]}},
    ],
)  # fmt: skip
def test_a_running_belt_keeps_its_steady_tensions(changes):
    """Everywhere the package's own, and they stay: what is left is where a pulley is within its cell."""
    drive = DATA["drive"] | MASSES | changes.get("drive", {})
    found = followed(line(**{**changes, "drive": drive}), NOTHING)
    steady = found.setup.loop.steady.balance.equilibrium.steady
    pairs = list(quiet(found, steady))
    assert len(pairs) > 0.5 * found.middles.size
    for tensions in (found.record.tensions[0], found.record.tensions[-1]):
        got = np.array([tensions[k] for k, _ in pairs])
        assert got == pytest.approx(np.array([t for _, t in pairs]), abs=2e-3 * steady.largest)
    assert np.ptp(found.record.take_up["tension"]) < 1e-6 * steady.largest
    assert found.belt_speed == pytest.approx(found.line.speed, rel=1e-9)


@pytest.mark.parametrize("step", [0.02, 0.1])
def test_a_running_belt_has_its_highest_steady_tension_at_the_pulley_however_long_its_cells(step):
    """Half of what lies along a cell stands between its middle and the pulley: 5 % of this belt's in cells of 150 m."""
    found = followed(line(drive=DATA["drive"] | MASSES), NOTHING, step)
    assert found.highest == pytest.approx(found.setup.loop.steady.balance.equilibrium.steady.largest, rel=1e-9)


def test_a_very_slow_start_has_the_quasi_static_tensions():
    """Half way up a ramp of 1 - cos the acceleration is that of the package's own start, and so are the tensions."""
    factor = 1.3
    conveyor = line(drive=DATA["drive"] | MASSES | {"start_factor": factor}, route={"feeding": NO_RUSH})
    found = closed(conveyor)
    mass = found.equilibrium.mass
    time = 0.5 * np.pi * found.line.speed * mass / ((factor - 1.0) * found.equilibrium.force)
    starter = {"kind": "inverter", "ramp": "cosine", "time": f"{time:.6f} s", "slip": "0.5 %"}
    made = followed(
        conveyor, {"begins": "at rest", "events": [{"do": "start"}], "starter": starter, "duration": f"{time:.3f} s"},
        step=0.04,
    )  # fmt: skip
    start = made.setup.loop.steady.balance.equilibrium.states["start"]
    half = int(np.argmin(np.abs(made.record.times - 0.5 * time)))
    pairs = list(quiet(made, start))
    got = np.array([made.record.tensions[half, k] for k, _ in pairs])
    # of the masses that start the pulleys have their own, 2 % here, of a quarter of the force
    assert got == pytest.approx(np.array([t for _, t in pairs]), abs=5e-3 * start.largest)


def test_a_very_stiff_belt_stops_as_a_rigid_one():
    """Time and way of the package's own coasting; of two flywheels the heavier stops it later."""
    stiff = DATA["belt"]["carcass"] | {"stiffness": "1000000 N/mm"}
    for mass in ("4 t", "40 t"):
        conveyor = line(
            belt=DATA["belt"] | {"carcass": stiff}, drive=DATA["drive"] | {"reduced_mass": mass},
            route={"feeding": NO_RUSH},
        )  # fmt: skip
        ride = ridden(conveyor, {"begins": "running", "events": [{"do": "power off"}]})
        steady = ride.loop.steady
        ride = replace(ride, scene=replace(ride.scene, duration=1.1 * steady.motions.coasting.time))
        (made,) = simulate_batch([ride], 0.02)
        pulleys = sum(lump.mass for lump in ride.loop.lumps)
        heavier = 1.0 + pulleys / (steady.motions.moving_mass + steady.motions.rotating_mass)
        # the last masses come to rest when the waves have died: a few trips of a wave
        trips = 3.0 * ride.loop.travel[-1]
        assert made.rests_at == pytest.approx(steady.motions.coasting.time * heavier, abs=trips)
        assert made.way == pytest.approx(steady.motions.coasting.distance * heavier, rel=0.01)


LONG_SKIRTS = {"speed": "1 m/s", "skirt_length": "80 m", "skirt_width": "600 mm"}
"""Their friction stands at one place."""


@pytest.mark.parametrize("take_up", [
    {"kind": "gravity", "position": "tail"}, {"kind": "fixed", "position": "tail"}, {"kind": "gravity"},
    {"kind": "gravity", "position": "return", "section": "a"},
])  # fmt: skip
@pytest.mark.parametrize("scenario", [
    {"begins": "at rest", "events": [{"do": "start"}], "starter": {"time": "3 s"}, "duration": "3 s"},
    {"begins": "running", "events": [{"do": "power off"}], "duration": "4 s"},
])  # fmt: skip
def test_peaks_hold_as_cells_get_shorter_where_friction_stands_at_one_place(take_up, scenario):
    """The mass there goes to zero, its friction does not: where it sticks and breaks away the tension stays."""
    sections = [{"name": "a", "length": "30 m"}, {"name": "b", "length": "120 m", "lift": "6 m"}]
    route = {"sections": sections, "feeding": LONG_SKIRTS, "take_up": take_up | {"tension": "40 kN"},
             "pulleys": DATA["route"]["pulleys"][:3]}  # fmt: skip
    ride = ridden(line(drive=DATA["drive"] | MASSES, route=route), scenario)
    made = [simulate_batch([ride], float(ride.loop.travel[-1]) / cells)[0] for cells in (40, 80, 160)]
    for coarse, fine in itertools.pairwise(made):
        assert fine.highest == pytest.approx(coarse.highest, rel=ERROR)
        assert fine.lowest == pytest.approx(coarse.lowest, abs=ERROR * fine.highest)
    assert max(one.missing_energy for one in made) < 1e-4


@pytest.mark.parametrize(
    "scenario",
    [
        {"begins": "at rest", "events": [{"do": "start"}], "starter": {"time": "6 s"}},
        {"begins": "running", "events": [{"do": "power off"}, {"at": "1 s", "do": "brake"}]},
        {"begins": "at rest", "events": [{"do": "start"}], "starter": {"kind": "direct"}},
    ],
)  # fmt: skip
def test_energy_is_accounted_for(scenario):
    """Motors give what belt and drives keep and what lift, friction, damping, brakes and slip take: to 1e-3."""
    drive = DATA["drive"] | MASSES | {"brake_force": "15 kN"}
    found = followed(line(drive=drive), {**scenario, "duration": "8 s"}, step=0.02)
    assert found.missing_energy < 1e-3


def test_momentum_goes_round_the_loop():
    """Every pull of the belt on itself cancels: momentum is what drives, take-up, ground and gravity give."""
    found = followed(
        line(drive=DATA["drive"] | MASSES, route={"feeding": NO_RUSH}),
        {"begins": "at rest", "events": [{"do": "start"}], "duration": "8 s", "starter": {"time": "8 s"}},
    )  # fmt: skip
    record, cells = found.record, found.cells
    momentum = record.speeds[-1].astype(float) @ cells.mass
    steps = round(record.times[-1] / record.step) + 1
    # everything moves from the first second on but for what is stuck then: the ground takes its full friction
    taken = cells.weight.sum() + cells.resisting(1.0, 1.0).sum()
    moving = (record.speeds[:, 1:-1] > 0.0).mean(axis=1) > 0.99
    since = int(np.argmax(moving))
    assert 0 < since < record.times.size // 2
    start = round(record.times[since] / record.step)
    gained = momentum - record.speeds[since].astype(float) @ cells.mass
    given = record.drives["force"][start + 1 : steps, 0].sum() * record.step
    assert gained == pytest.approx(given - taken * (record.times[-1] - record.times[since]), rel=5e-3)
