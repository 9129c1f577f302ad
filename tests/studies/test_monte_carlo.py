"""Draws on the exact model: moments and correlation of a linear toy, ranks of percentiles, refusals."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtri

from conveyor.errors import InputError, NoSolutionError
from conveyor.models import Uncertainty
from conveyor.spec import load
from conveyor.studies.input_ranges import BAND_END, analyse_ranges
from conveyor.studies.monte_carlo import PERCENTILE_CONFIDENCE, power_percentiles

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-3
"""Of the contacts: draws of the drag alone share them."""
DRAWS = 1024


@pytest.fixture(scope="module")
def line():
    return load(SPECS / "shuttle.yaml")


def exact(line, **ranges):
    return analyse_ranges(line, Uncertainty.from_data(ranges), rtol=RTOL)


def test_of_a_linear_input_draws_and_first_order_agree(line):
    # the power is linear in the drag of the rolls: normal, its 5 % and 95 % percentiles at the ends of the range
    found = exact(line, roll_drag="30 %", draws=DRAWS, seed=1)
    (effect,) = found.effects
    last = found.monte_carlo.convergence[-1]
    assert last.draws == DRAWS == len(found.monte_carlo.power)
    # scatter of an empirical quantile: sqrt(p(1-p)/n)/density = 2.1 sigma/sqrt(n); 4 of them
    sigma = (effect.motor_high - effect.motor_low) / (2.0 * BAND_END)
    assert found.monte_carlo.band == pytest.approx((effect.motor_low, effect.motor_high), abs=4 * 2.1 * sigma / 32)
    assert last.low_between[0] <= last.low <= last.low_between[1] < last.high_between[0] <= last.high
    assert found.monte_carlo.power.std() == pytest.approx(sigma, rel=4.0 / math.sqrt(2 * DRAWS))


def test_correlation_widens_what_adds_up_and_the_seed_draws_the_same(line):
    cleaner = {"count": 4, "width": "400 mm", "thickness": "10 mm", "pressure": "30 kPa"}
    line = line.replace(route=line.route.replace(cleaners=[cleaner]))
    ranges = {"roll_drag": "40 %", "cleaner_pressure": "40 %", "draws": 64, "seed": 3}
    alone = exact(line, **ranges).monte_carlo
    pair = [{"between": ["roll_drag", "cleaner_pressure"], "coefficient": 0.9}]
    together = exact(line, **ranges, correlations=pair).monte_carlo
    opposed = exact(line, **ranges, correlations=[pair[0] | {"coefficient": -0.9}]).monte_carlo
    assert opposed.power.std() < alone.power.std() < together.power.std()
    assert np.array_equal(alone.power, exact(line, **ranges).monte_carlo.power)


def test_percentiles_lie_between_their_ranks_as_often_as_they_say():
    rng, true = np.random.default_rng(0), float(ndtri(0.05))
    held = [
        low <= true <= high
        for low, high in (power_percentiles(rng.standard_normal(64)).low_between for _ in range(400))
    ]
    # a binomial share: at least SURE, as ranks are whole; 4 standard deviations below
    assert np.mean(held) > PERCENTILE_CONFIDENCE - 4.0 * math.sqrt(
        PERCENTILE_CONFIDENCE * (1.0 - PERCENTILE_CONFIDENCE) / 400
    )


def test_replicas_of_the_rubber_are_drawn():
    line = load(SPECS / "overland_10km.yaml")
    line = line.replace(route={"sections": [{"name": "one", "length": "1000 m"}]}, cases=(), operation=None)
    found = exact(line, rubber=True, draws=64)
    assert any("not drawn" in note for note in found.notes) is False
    assert len(np.unique(found.monte_carlo.power.round(3))) > 10


def test_contradictions_are_refused(line):
    pairs = [("roll_drag", "flow", 0.9), ("flow", "density", 0.9), ("roll_drag", "density", -0.9)]
    ranges = {"roll_drag": "30 %", "flow": "1 %", "density": "1 %", "draws": 64}
    given = [{"between": [a, b], "coefficient": c} for a, b, c in pairs]
    with pytest.raises(InputError, match="contradict each other"):
        exact(line, **ranges, correlations=given)
    with pytest.raises(InputError, match="correlations: only draws take them: give draws"):
        Uncertainty.from_data({"flow": "5 %", "skirt_friction": "20 %", "correlations": given[:1]})
    with pytest.raises(InputError, match=r"correlations\[0\].between: temperature has no range here"):
        Uncertainty.from_data(ranges | {"correlations": [given[0] | {"between": ["flow", "temperature"]}]})
    with pytest.raises(InputError, match="expected at least 64"):
        Uncertainty.from_data(ranges | {"draws": 10})
    with pytest.raises(NoSolutionError, match="of 64 draws have an answer: roll drag: a draw"):
        exact(line, roll_drag="99 %", draws=64)
