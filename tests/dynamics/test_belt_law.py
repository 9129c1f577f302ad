"""The belt between its idlers, and its carcass: never pushes, softens as its parabola, relaxes as a standard solid."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from conveyor.dynamics.wave import simulate_belts
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.waves import sag_factor
from conveyor.models.belt import Carcass
from tests.dynamics.rods import EA, LENGTH, LINE_MASS, PULL, WAVE, begun, clamped, follow, idle, rod

CELLS = 40
HANGING = sag_factor(100.0, spacing=1.5, inclination=0.0, gravity=9.81)


def hanging(**changes):
    return rod(CELLS, sag=np.full((1, CELLS), HANGING * LENGTH / CELLS), **changes)


def swing(chain, pull, size=0.01, periods=12.0):
    """Times and displacement of the first mode of a rod clamped at both ends, from a bent tension."""
    shape = np.cos(np.pi * (np.arange(CELLS) + 0.5) / CELLS)
    start = begun(chain, tension=pull * (1.0 + size * shape[None]))
    found = follow(chain, start, periods * LENGTH / WAVE)
    tension = (found.tensions[:, 0].astype(float) - pull) @ shape / (shape @ shape)
    return found.times[:, 0], tension / tension[0]


@pytest.mark.parametrize("pull", [20e3, 40e3, 400e3])
def test_a_hanging_belt_softens_as_its_parabola(pull):
    """Small swings of a clamped belt have the period 2 L/c, c of 1/EA + 2 S/T³: up to four times longer than taut."""
    chain = replace(hanging(**clamped(CELLS, 0, CELLS)), held=np.array([pull]))
    soft = 1.0 / (1.0 / EA + 2.0 * HANGING / pull**3)
    period = 2.0 * LENGTH / np.sqrt(soft / LINE_MASS)
    times, tension = swing(chain, pull, periods=3.0 * period * WAVE / LENGTH)
    down = np.flatnonzero((tension[:-1] > 0.0) & (tension[1:] <= 0.0))
    crossed = times[down] + np.diff(times[:2]) * tension[down] / (tension[down] - tension[down + 1])
    assert np.diff(crossed).mean() == pytest.approx(period, rel=2e-3)


def test_a_slack_belt_never_pushes_and_no_energy_is_lost():
    """Two halves run into each other: the tension falls to what the hanging belt weighs, and comes back."""
    speed = np.where(np.arange(CELLS + 1) < CELLS // 2, 1.0, -1.0)[None]
    chain = hanging(**clamped(CELLS, 0, CELLS))
    speed[:, [0, -1]] = 0.0
    found = follow(chain, begun(chain, speed=speed), 3.0 * LENGTH / WAVE)
    lowest = float(found.lowest.min())
    assert 0.0 < lowest < 0.3 * PULL  # a straight belt would push with c m' v, 40 kN, less its pull
    pushed = WAVE * LINE_MASS - PULL
    straight = follow(replace(chain, sag=np.zeros((1, CELLS))), begun(chain, speed=speed), 1.0)
    assert float(straight.lowest.min()) < -0.5 * abs(pushed) + PULL
    # an impact is of first order in the step
    assert abs(found.work["missing"][0]) < 1.0 / CELLS * 0.5 * LINE_MASS * LENGTH


def test_a_belt_pulled_taut_has_the_same_peaks_in_long_cells():
    """Damping follows the tangent of the sag at once: peaks of 50 m are those of 12.5 m to some parts in a thousand."""
    peaks = []
    for cells in (CELLS, 4 * CELLS):
        chain = rod(
            cells, sag=np.full((1, cells), HANGING * LENGTH / cells), retardation=0.3, held=np.array([5e3]),
            **clamped(cells, 0, cells),
        )  # fmt: skip
        speed = -np.sin(2.0 * np.pi * np.arange(cells + 1) / cells)[None]
        found = follow(chain, begun(chain, tension=np.full((1, cells), 5e3), speed=speed), 3.0)
        peaks.append((found.highest.max(), found.lowest.min()))
    # of first order: four times shorter cells leave a quarter of the error; a step late it was 3 % and 9 %
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-2)


def test_a_slack_begin_is_refused_where_the_belt_hangs():
    chain = hanging()
    with pytest.raises(NoSolutionError, match="bears tension only"):
        simulate_belts(chain, idle(3), begun(chain, tension=np.zeros((1, CELLS))), step=chain.longest_step)


@pytest.mark.parametrize(("share", "time"), [(0.3, 0.2), (1.0, 1.0), (0.5, 10.0)])
def test_a_standard_solid_swings_as_its_cubic_says(share, time):
    """m λ² + k (1 + r λ τ/(1 + λ τ)) = 0 for a mode of a clamped rod: frequency and decay of its swinging root."""
    chain = rod(CELLS, relaxing=(share, time), **clamped(CELLS, 0, CELLS))
    omega = np.pi * WAVE / LENGTH
    roots = np.roots([time, 1.0, omega**2 * time * (1.0 + share), omega**2])
    swinging = roots[np.argmax(roots.imag)]
    creeping = roots[np.argmin(np.abs(roots.imag))].real
    times, tension = swing(chain, PULL, periods=6.0)
    basis = np.stack([
        np.exp(swinging.real * times) * np.cos(swinging.imag * times),
        np.exp(swinging.real * times) * np.sin(swinging.imag * times), np.exp(creeping * times),
    ], axis=1)  # fmt: skip
    left = tension - basis @ np.linalg.lstsq(basis, tension, rcond=None)[0]
    assert np.abs(left).max() < 0.02  # of first order in the step at clamps
    assert np.abs(tension[-1]) < 1.0


def test_relaxing_stiffness_and_its_time_go_together():
    given = {"kind": "EP", "thickness": "5 mm", "strength": "1000 N/mm", "relaxing_stiffness": "30 %"}
    with pytest.raises(InputError, match="relaxing_stiffness is given and needs it"):
        Carcass.from_data(given)
    assert Carcass.from_data(given | {"relaxation_time": "2 s"}).retardation_time is None
