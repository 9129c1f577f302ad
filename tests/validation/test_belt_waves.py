"""Waves in rods: closed forms of the wave equation, of Kelvin and Voigt, and of friction."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.dynamics.published_cases import lodewijks_start
from tests.dynamics.rods import EA, LENGTH, LINE_MASS, PULL, WAVE, begun, clamped, follow, rod

IMPEDANCE = WAVE * LINE_MASS
SPEED = 0.5


def pulled(cells, **changes):
    """A rod whose end runs at a speed from the first moment: a pulley of endless mass that nothing slips on."""
    return rod(
        cells, nodes=np.array([[cells]]), rim=np.array([[1e15]]), grip=np.array([[1e12]]),
        backstop=np.array([[False]]), **changes,
    )  # fmt: skip


def test_a_step_of_speed_pulls_with_the_impedance():
    """T = c m' v behind the front, none before it: the front is exact at a step of one cell."""
    chain = pulled(100)
    found = follow(chain, begun(chain, rims=np.array([[SPEED]])), 0.5 * LENGTH / WAVE)
    tension = found.tensions[-1, 0] - PULL
    assert tension[60:] == pytest.approx(SPEED * IMPEDANCE, rel=1e-5)  # float32 samples of 70 kN
    assert np.abs(tension[:40]).max() <= 1e-5 * SPEED * IMPEDANCE


def test_a_wave_returns_with_its_sign_from_a_clamp_and_turned_from_a_free_end():
    """A clamp doubles the tension; a free end takes it back to what the weight holds."""
    whole = LENGTH / WAVE
    for far, factor in ((clamped(100, 0), 2.0), ({}, 0.0)):
        chain = pulled(100, **far)
        found = follow(chain, begun(chain, rims=np.array([[SPEED]])), 1.5 * whole)
        assert found.tensions[-1, 0, 25] - PULL == pytest.approx(
            factor * SPEED * IMPEDANCE, abs=1e-4 * SPEED * IMPEDANCE
        )


def swing(cells, waves, periods, retardation, *nodes):
    """Tension and speed of a rod in a mode, its own way off: in tension and in speed [-]."""
    chain = rod(cells, **clamped(cells, *nodes), retardation=retardation)
    step, omega = chain.longest_step, 2.0 * np.pi * waves * WAVE / LENGTH
    ratio = 0.5 * omega * retardation
    slower = np.sqrt(1.0 - ratio**2)

    def moved(times):
        """Of u, u' and the tension of a belt that is let go, over their own size."""
        fade, angle = np.exp(-ratio * omega * times), slower * omega * times
        u = fade * (np.cos(angle) + ratio / slower * np.sin(angle))
        rate = -fade * np.sin(angle) / slower
        return rate, u + retardation * omega * rate

    turn = 0.0 if nodes else -0.5 * np.pi  # free ends bear no tension of the mode
    cosine = np.cos(2.0 * np.pi * waves * (np.arange(cells) + 0.5) / cells + turn)
    sine = np.sin(2.0 * np.pi * waves * np.arange(cells + 1) / cells + turn)
    speed = 10e3 / IMPEDANCE * sine * moved(-0.5 * step)[0]  # speeds stand half a step before tensions
    start = begun(chain, tension=PULL + 10e3 * cosine[None], speed=speed[None])
    found = follow(chain, start, periods * 2.0 * np.pi / omega)
    tension = (found.tensions[:, 0].astype(float) - PULL) @ cosine / (cosine @ cosine) / 10e3
    speeds = found.speeds[:, 0].astype(float) @ sine / (sine @ sine) * IMPEDANCE / 10e3
    rate, _ = moved(found.times[:, 0] + 0.5 * step)
    return np.abs(tension - moved(found.times[:, 0])[1]).max(), np.abs(speeds - rate).max()


@pytest.mark.parametrize(("nodes", "waves"), [((0,), 0.25), ((0, -1), 0.5)])
def test_first_periods(nodes, waves):
    """4 L/c fixed and free, 2 L/c fixed at both ends; what a step of one cell leaves is the shape of a half cell."""
    assert max(swing(80, waves, 3.0, 0.0, *nodes)) < 5e-4


@pytest.mark.parametrize("nodes", [(), (0, -1)])
def test_damping_ratio_is_half_of_frequency_times_retardation_and_second_order(nodes):
    """Ratio 0.079 here, of a rod with free ends or held by friction; four times less error at half the step."""
    coarse, fine = (np.array(swing(cells, 0.5, 2.0, 0.1, *nodes)) for cells in (20, 40))
    assert np.log2(coarse / fine) == pytest.approx([2.0, 2.0], abs=0.15)
    assert fine.max() < 2e-3


def test_friction_stops_a_mode_without_chatter():
    """A rod that swings on dry ground comes to rest, stays there, and never turns back and forth."""
    cells = 40
    friction = np.zeros((3, 1, cells + 1))
    friction[0] = 150.0
    chain = rod(cells, friction=friction, sticking=friction[0] * 1.5)
    speed = np.full((1, cells + 1), 0.2)
    found = follow(chain, begun(chain, speed=speed, resisting=friction[0].copy()), 60.0)
    # of a rigid bar t = m v/R
    stops = LINE_MASS * LENGTH * 0.2 / (150.0 * (cells + 1))
    still = found.times[:, 0] > 2.0 * stops + 4.0 * LENGTH / WAVE
    assert np.all(found.speeds[still] == 0.0)
    turns = (np.diff(np.sign(found.speeds[:, 0]), axis=0) != 0).sum(axis=0)
    assert turns.max() <= 6


def test_a_take_up_at_rest_stays_at_rest():
    """Every kind, its belt too."""
    for changes in ({"carriage": np.array([np.inf])}, {"carriage": np.array([2e3])}, {}):
        chain = rod(30, retardation=0.05, **changes)
        found = follow(chain, begun(chain), 20.0)
        assert np.abs(found.take_up["belt"]).max() == 0.0
        assert np.all(found.take_up["tension"] == PULL)


def test_a_weight_with_mass_bounces_on_the_belt():
    """A weight on a light belt clamped near one end: omega = sqrt(k/w), w its mass over its strands squared."""
    cells, carriage = 20, EA / LENGTH / (2.0 * np.pi * 0.05) ** 2
    light = np.full((1, cells + 1), 1e-4 * carriage)
    chain = rod(cells, carriage=np.array([carriage]), mass=light, **clamped(cells, 10))
    start = begun(chain, tension=np.full((1, cells), 0.9 * PULL))
    found = follow(chain, start, 20.0)
    at = found.step * np.arange(len(found.take_up["belt"]))
    # both halves of the belt stretch by the way of their ends; of their mass a third swings along
    omega = 2.0 * np.pi * 0.05 / np.sqrt(1.0 + 1e-4 * cells / 12.0)
    moved = 0.1 * PULL * LENGTH / EA * (1.0 - np.cos(omega * at))
    assert found.take_up["belt"][:, 0] == pytest.approx(moved, abs=0.01 * moved.max())


@pytest.mark.parametrize(("shape", "printed"), [("linear", 0.0246), ("cosine", 0.0303)])
def test_lodewijks_peaks_lie_between_dry_and_rising_resistances(shape, printed):
    """Table 8.7 of 1996: what he does not print, how resistances rise with speed, spans his figures."""
    assert lodewijks_start(shape, rising=1.0) < printed < lodewijks_start(shape, rising=0.0)


def test_a_step_too_long_is_refused():
    from conveyor.dynamics.wave import simulate_belts
    from conveyor.errors import NoSolutionError
    from tests.dynamics.rods import idle

    chain = rod(10)
    with pytest.raises(NoSolutionError, match="unstable"):
        simulate_belts(chain, idle(3), begun(chain), step=1.1 * chain.longest_step)
