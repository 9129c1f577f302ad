"""Rods on pulleys: what slips, brakes, is switched on late, by closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conveyor.dynamics.belt_chain import Machines
from conveyor.dynamics.simulation import _peak_error, _Peaks
from conveyor.dynamics.wave import simulate_belts
from tests.dynamics.rods import EA, LENGTH, LINE_MASS, PULL, WAVE, begun, clamped, follow, idle, rod
from tests.dynamics.scenarios import START, checks_of_one, slipping_late
from tests.loop.loop_lines import DATA, line
from tests.validation.test_start_stop_limits import MASSES, followed

SPECS = Path(__file__).parents[2] / "examples" / "specs"
GRIP = 1.5
SLOW = 0.05  # of a winch: its waves, c m' v, stay within its band
HEAVY = 2e6
CELLS = 10
SPAN = LENGTH * (CELLS - 1) / CELLS


def pulled(force, steps, *, time, cells=CELLS, grip=1e9, rim=HEAVY, **changes):
    """A rod clamped at its far end whose pulley is pulled back by a force that grows over a time."""
    clamp = clamped(cells, 1)
    chain = rod(
        cells, nodes=np.array([[cells]]), rim=np.array([[rim]]), grip=np.array([[grip]]),
        backstop=np.array([[False]]), **(clamp | changes),
    )  # fmt: skip
    step = chain.longest_step
    share = np.clip(step * np.arange(steps) / time, 0.0, 1.0)[:, None, None]
    driving = Machines(
        np.array([[1e9]]), np.full((steps, 1, 1), 1e6), share, np.zeros((steps, 1, 1)),
        np.full((1, 1, 65), force), 1.0, np.zeros((1, 1)),
    )  # fmt: skip
    return simulate_belts(chain, driving, begun(chain), step=step, samples=steps)


@pytest.mark.parametrize("share", [0.3, 0.7, 1.5])
def test_a_ramp_of_force_leaves_what_the_book_says(share):
    """One mode, a heavy drum on the rod: peak over static is 1 + |sin(pi x)/(pi x)|, x the ramp over the period."""
    omega = np.sqrt(EA / SPAN / (HEAVY * (1.0 + 40.0 * SPAN / 3.0 / HEAVY)))
    period, force = 2.0 * np.pi / omega, -30e3
    steps = round((1.2 + share) * period / (LENGTH / CELLS / WAVE))
    found = pulled(-force, steps, time=share * period)
    tension = PULL - found.tensions[:, 0, CELLS // 2].astype(float)
    peak = 1.0 + abs(np.sin(np.pi * share) / (np.pi * share))
    assert np.abs(tension).max() / abs(force) == pytest.approx(peak, rel=0.01)


def test_a_slipping_belt_bears_what_it_grips():
    """Beyond (e^(mu alpha) - 1) T2 the belt slips; the force stays there, the tensions in Euler's ratio."""
    found = pulled(400e3, 400, time=20.0, grip=GRIP, rim=2e6, retardation=0.5)
    drives = {name: values[-1, 0, 0] for name, values in found.drives.items()}
    assert found.slipped[0, 0] > 1.0
    assert drives["force"] == pytest.approx(GRIP * drives["leaving"], rel=1e-9)
    assert drives["arriving"] / drives["leaving"] == pytest.approx(1.0 + GRIP, rel=1e-3)
    assert found.heat[0, 0] == pytest.approx(found.work["slip"][0], rel=0.05)


def test_backstop_and_brake_hold_what_pulls_back():
    """A belt pulled backward by its own tension stands on its backstop or a strong brake, not on a weak one."""
    for backstop, force, stands in ((True, 0.0, True), (False, 60e3, True), (False, 10e3, False)):
        chain = rod(
            20, nodes=np.array([[20]]), rim=np.array([[1e3]]), grip=np.array([[1e9]]),
            backstop=np.array([[backstop]]), **clamped(20, 0),
        )  # fmt: skip
        machines = replace(idle(400, 1), brake=np.full((400, 1, 1), force))
        start = begun(chain, tension=np.full((1, 20), PULL + 40e3))
        found = simulate_belts(chain, machines, start, step=chain.longest_step)
        assert bool(np.abs(found.drives["rim"]).max() == 0.0) is stands
        if stands:
            assert found.drives["holding"][-1, 0, 0] == pytest.approx(-40e3, rel=1e-9)


@pytest.mark.parametrize("cells", [100, 400])
def test_the_tension_at_a_pulley_falls_after_a_power_cut_as_a_damped_rod_says(cells):
    """A heavy rim gives way by F t/M: the tension falls by z F/M √(τ t)/Γ(3/2), z = c m', while t is short of τ."""
    force, rim, tau, node = 20e3, 4e5, 0.1, cells // 2
    chain = rod(
        cells, retardation=tau, nodes=np.array([[node]]), rim=np.array([[rim]]), grip=np.full((1, 1), 1e9),
        backstop=np.zeros((1, 1), bool), **clamped(cells, 0, cells),
    )  # fmt: skip
    tension = np.full((1, cells), PULL)
    tension[:, :node] += force
    step = 0.95 * chain.longest_step
    found = simulate_belts(chain, idle(2, 1), begun(chain, tension=tension, driving=np.array([[force]])), step=step)
    falls = PULL + force - found.drives["arriving"][0, 0, 0]
    assert found.drives["leaving"][0, 0, 0] - PULL == pytest.approx(falls, rel=1e-9)
    # the mean over a step of a root, 2/3 of its end; a cell resolves that to some per cent
    closed_form = WAVE * LINE_MASS * force / rim * math.sqrt(tau * step) / math.gamma(1.5)
    assert falls == pytest.approx(2.0 / 3.0 * closed_form, rel=0.08)


LIGHT = 16.0
"""Of the masses before and behind a pulley, whose impedances are as 1 to 4."""


def slips_at_once(cells, retardation, direction, *, steps):
    """A rod on a pulley that slips at the first step, and the closed form of its tensions before and behind.

    T - z v on the slack side, T + z v on the other one. Cells of equal travel time: the light belt's are four times
    longer than the heavy one's.
    """
    grip, node = 1.5, cells // 2
    mass, stiffness = np.full((1, cells + 1), 4e4 / cells), np.full((1, cells), 1e4 * cells)
    mass[:, node + 1 :] *= 4.0
    stiffness[:, node:] *= 4.0
    before = np.zeros((6, 1, 1))
    before[0] = 0.5 * mass[:, node, None]
    mass[:, node] *= 2.5
    chain = rod(
        cells, mass=mass, stiffness=stiffness, retardation=retardation, nodes=np.array([[node]]), before=before,
        rim=np.array([[1.0]]), grip=np.array([[grip]]), backstop=np.array([[False]]), **clamped(cells, 0, cells),
    )  # fmt: skip
    step = 0.95 * chain.longest_step
    driving = Machines(
        np.array([[1e9]]), direction * np.full((steps, 1, 1), 1e6), np.ones((steps, 1, 1)), np.zeros((steps, 1, 1)),
        np.full((1, 1, 65), 1e7), 1e6, np.zeros((1, 1)),
    )  # fmt: skip
    found = simulate_belts(chain, driving, begun(chain), step=step)
    ratio = 0.25 if direction > 0.0 else 4.0
    slack = PULL * (1.0 + ratio) / (1.0 + grip + ratio)
    taut = (1.0 + grip) * slack
    return found, node, (taut, slack) if direction > 0.0 else (slack, taut)


@pytest.mark.parametrize("cells", [10, 40, 160])
@pytest.mark.parametrize("retardation", [0.0, 0.1])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_tensions_beside_a_pulley_that_slips_at_once_are_split_by_impedances(cells, retardation, direction):
    """T1 = T + z1 v, T2 = T - z2 v, T1/T2 = e^(mu alpha): at the first step, however long the cells, damped or not."""
    found, node, sides = slips_at_once(cells, retardation, direction, steps=3)
    assert found.drives["arriving"][:, 0, 0] == pytest.approx(sides[0], rel=1e-6)
    assert found.drives["leaving"][:, 0, 0] == pytest.approx(sides[1], rel=1e-6)
    beside, slack = found.lowest[0, node if direction > 0.0 else node - 1], min(sides)
    # at 0.95 of the longest step something swings from cell to cell; a jump at the begin of a step swings by 80 %
    assert slack - 0.2 * (PULL - slack) < beside <= slack * (1.0 + 1e-6)


@pytest.mark.parametrize("retardation", [0.0, 0.02, 0.1])
def test_the_error_told_of_a_tension_that_falls_at_once_holds_against_its_closed_form(retardation):
    """Undamped the belt beside the pulley swings by a quarter of the jump in all cells: 0.7 % was told for 12 %."""
    peaks = []
    for cells in (26, 50, 100, 200, 400):
        found, _, (taut, slack) = slips_at_once(cells, retardation, 1.0, steps=cells // 4)
        highest, lowest = float(found.highest.max()), float(found.lowest.min())
        swing = float(found.drives["leaving"].min()) - lowest
        peaks.append(_Peaks(highest, lowest, float(found.step[0]), swing))
        told = _peak_error(peaks)
        off = max(abs(highest - taut), abs(lowest - slack))
        assert told is None or told * highest >= off * (1.0 - 1e-9)
    assert (told > 0.1) is (retardation == 0.0)


def test_the_error_told_beside_a_drive_switched_on_late_holds_against_finer_cells():
    """On a belt that sags, with friction and bulk; and a smooth start has no jump."""
    sizes = [slipping_late(0.1 * 0.5**k) for k in range(5)]
    assert all(one.jump is not None for one in sizes)
    peaks = [_Peaks.of(one) for one in sizes]
    told = _peak_error(peaks[:4])
    assert abs(peaks[4].lowest - peaks[3].lowest) <= told * peaks[3].highest < 0.01 * peaks[3].highest
    assert followed(line(drive=DATA["drive"] | MASSES), START, step=0.1).jump is None


@pytest.mark.parametrize("step", [0.1, 0.05, 0.02])
def test_the_lowest_tension_beside_a_drive_switched_on_late_is_that_of_its_closed_form(step):
    """(T1 + r T2)/(e^(mu alpha) + r) of the tensions before it, r the impedance sqrt(m' EA) before over that behind."""
    found = slipping_late(step)
    cells, drives, drive = found.cells, found.record.drives, found.setup.drives[1]
    k, loop = int(cells.nodes[1]), found.setup.loop
    carry = int(np.argmax(loop.order == found.line.count))  # the first stretch behind the tail
    before, behind = (loop.mass / np.diff(loop.way))[[carry - 1, carry]]
    on = int(np.argmax(drives["motor"][:, 1] > 0.0))
    arriving, leaving = (float(drives[name][on - 1, 1]) for name in ("arriving", "leaving"))
    ratio = math.sqrt(before / behind)
    slack = (arriving + ratio * leaving) / (math.exp(drive.friction * drive.wrap_angle) + ratio)
    # friction of half a cell, 2.3 kN at most, turns as the belt breaks loose: it was 22.7, 18.4 and 14.1 kN of 25.0
    assert drives["leaving"][on, 1] == pytest.approx(slack, abs=0.2 * float(cells.sticking(1.0)[k]) + 0.01 * slack)
    assert found.lowest == pytest.approx(slack, rel=0.02)  # it was 31.2, 32.2 and 33.2 kN


def test_the_highest_speed_is_looked_for_on_the_whole_belt_from_its_begin_on():
    """Running it begins at full speed; all that moves at any time is seen, a mass away from the drives too."""
    off = {"begins": "running", "events": [{"do": "power off"}], "duration": "4 s"}
    stop = followed(line(drive=DATA["drive"] | MASSES), off, step=0.05)
    assert stop.top_speed == (pytest.approx(stop.line.speed, rel=1e-12), stop.place(0), 0.0)
    assert np.abs(stop.record.drives["belt"]).max() < 0.99 * stop.line.speed  # what was called the highest
    (over,) = (check for check in checks_of_one(stop) if check.key == "dynamic_overspeed")
    assert over.calculated == pytest.approx(stop.line.speed, rel=1e-12)
    direct = {"begins": "at rest", "starter": {"kind": "direct"}, "duration": "5 s",
              "events": [{"do": "start"}, {"at": "1 s", "do": "power off"}]}  # fmt: skip
    late = followed(line(drive=DATA["drive"] | MASSES), direct, step=0.05)
    every = np.abs(late.record.speeds)  # as many samples as steps
    speed, place, at = late.top_speed
    assert speed > 1.02 * np.abs(late.record.drives["belt"]).max()
    assert speed == pytest.approx(float(every.max()), rel=1e-6)  # samples have 24 bits
    i, k = np.unravel_index(int(every.argmax()), every.shape)
    assert at == pytest.approx(float(late.record.times[i]), abs=1e-9)
    assert place in {late.place(max(0, int(k) - 1)), late.place(min(int(k), late.middles.size - 1))}
    loop, stretches = late.setup.loop, late.line.loop.stretches
    for i, middle in enumerate(late.middles.tolist()):
        (here,) = (
            stretches[order]
            for order, begin, end in zip(loop.order, loop.way[:-1], loop.way[1:], strict=True)
            if begin < middle < end
        )
        assert late.place(i) == f"{here.section}, {here.strand}"


def test_a_free_end_runs_twice_as_fast_as_the_pulley_that_pulls_it():
    """A wave comes to a weight without mass: there the belt has 2 v, at no driven pulley."""
    chain = rod(
        CELLS, nodes=np.array([[CELLS]]), rim=np.array([[1e15]]), grip=np.array([[1e12]]),
        backstop=np.array([[False]]),
    )  # fmt: skip
    for speed in (0.5, -0.5):
        found = follow(chain, begun(chain, rims=np.array([[speed]])), 1.5 * LENGTH / WAVE)
        most, at = (found.highest_speed, found.highest_speed_at) if speed > 0.0 else (
            found.lowest_speed, found.lowest_speed_at)  # fmt: skip
        assert most[0, 0] == pytest.approx(2.0 * speed, rel=1e-5)
        assert at[0, 0] == pytest.approx(LENGTH / WAVE, abs=2.0 * float(found.step[0]))
        assert most[0, -1] == pytest.approx(speed, rel=1e-5)
