"""Contacts of extreme numbers end with a status or are refused in words: no other exception, no warning of NumPy."""

from __future__ import annotations

from collections import Counter

import pytest

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.errors import InputError
from tests.contact.extreme import ending

_BLOCKS, _EACH = 6, 10


@pytest.mark.parametrize("block", range(_BLOCKS))
def test_a_contact_of_extreme_numbers_ends_in_a_status_or_in_words(block):
    endings = Counter(ending(seed) for seed in range(block, _BLOCKS * _EACH, _BLOCKS))
    assert endings["OK"] >= 1


@pytest.mark.parametrize("instantaneous", [5e-324, 1e-300, 1e-31])
def test_rubber_that_stiffens_beyond_any_number_is_refused(instantaneous):
    with pytest.raises(InputError, match=r"allowed: >= 1e-30 and <= 1 \(j∞ = E0/E∞\)"):
        CreepSpectrum(instantaneous, [1.0], [1.0])


@pytest.mark.parametrize(
    ("instantaneous", "last"), [(1.0 - 0.06521329 - 0.84350269 - 0.08245453, 0.08245453), (0.008829480476255203, None)]
)
def test_strips_that_would_reach_beyond_the_roll_are_left_to_the_grid(instantaneous, last):
    """A tiny roll pressed far into a thin bonded layer of three times: too sharp for any order, and said so."""
    weights = [0.06521329, 0.84350269]
    weights.append(1.0 - instantaneous - sum(weights) if last is None else last)
    creep = CreepSpectrum(instantaneous, weights, [0.00029006, 0.00104923, 0.16154])
    found = solve(
        ContactProblem("confined", 0.0017710503790067855, 1.727622276596642, creep, 0.09193471275396253),
        throw=False,
    )
    assert found.status.name != "OK"
    assert "far outside small strain" in found.message


def test_weights_as_printed_with_eight_digits_are_refused_by_their_sum():
    """Those of the roll above: 1e-8 is no rounding of numbers, and which of them is wrong is not ours to say."""
    with pytest.raises(InputError, match=r"instantaneous \+ sum\(weights\) = 0\.99999999\d*: must be 1"):
        CreepSpectrum(0.008829480476255203, [0.06521329, 0.84350269, 0.08245453], [0.00029006, 0.00104923, 0.16154])
