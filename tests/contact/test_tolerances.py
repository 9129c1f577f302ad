"""A finer tolerance never makes an answer worse: the best contact found is returned whatever ends the search."""

from __future__ import annotations

import numpy as np
import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, Status, solve
from conveyor.contact.solvers import many_strips as module

TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
# a memory far longer, and one far shorter than the passage: the energy of high orders loses its digits
LONG_MEMORY = CreepSpectrum(5.059200254283971e-06, [0.33565186, 0.664343080799746], [2.1617015e5, 7.35118832e-10])
SPLIT = ContactProblem("free", 0.3, 0.13, CreepSpectrum(0.1, [0.9], [3.0]), 1.0)
SCENES = {
    "paper": ContactProblem("free", 0.4, 0.05, CreepSpectrum(0.1, [0.9], [1.0]), 1.0),
    "split": SPLIT,
    "elastic": ContactProblem("confined", 0.1, 1e-3, CreepSpectrum(1.0), 0.1),
    "sharp": ContactProblem("half-space", 0.05, 1e-3, CreepSpectrum(1e-3, [0.999], [1e-3])),
    "conveyor": ContactProblem("confined", 0.066, 0.004, CreepSpectrum(0.05, [0.5, 0.45], [1e-4, 0.1]), 0.03),
    "long memory": ContactProblem("free", 0.27695970276, 5.846829e-09, LONG_MEMORY, 570.28979, 0.1034),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_true_error_never_rises_by_more_than_its_estimate(name):
    found = [solve(SCENES[name], rtol, throw=False) for rtol in TOLERANCES]
    told = np.array([one.error_estimate for one in found])
    best = found[int(told.argmin())]
    scale = abs(best.friction) or 1.0
    off = np.array([abs(one.friction - best.friction) for one in found]) / scale
    assert np.all(off <= told + told.min())
    assert np.all(np.diff(off) <= told[1:] + told.min())
    # nor does the estimate, but for tolerances that were met with more than was asked for
    for k, one in enumerate(found):
        assert one.status is Status.OK or told[k] <= 2.0 * told[:k].min()


def test_an_answer_that_misses_the_tolerance_says_how_far_it_is_known():
    found = solve(SCENES["long memory"], 1e-9, throw=False)
    assert found.status is Status.NOT_CONVERGED
    assert f"friction is known to {found.error_estimate:.1e} of itself" in found.message


def test_strips_of_a_lower_order_are_kept_where_a_higher_one_has_none(monkeypatch):
    three = ContactProblem("free", 0.3, 0.03, CreepSpectrum(0.1, [0.9], [0.3]), 0.3)
    exact = solve(three, 1e-10)
    balance = module.balance_strips

    def only_low_orders(scene, n, *place, **given):
        return balance(scene, n, *place, **given) if n <= 24 else None

    monkeypatch.setattr(module, "balance_strips", only_low_orders)
    found = solve(three, 1e-10, throw=False)
    assert found.status is Status.NOT_CONVERGED
    assert found.stats.way == "strips"
    assert abs(found.friction / exact.friction - 1.0) <= found.error_estimate < 1e-4


def test_strips_whose_orders_agree_to_the_last_digit_have_no_power_to_fall_by():
    # the logarithm of a change of zero ended in an exception
    assert module.convergence_power((24, 0.0), (16, 1e-15)) == 0.0
    assert module.convergence_power((32, 1e-6), (16, 1e-3)) == pytest.approx(np.log(1e3) / np.log(2.0))
