"""Take-up: statics of the carriage, the mean tension of a belt of given length, refusals."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.laws import take_up

ROUNDING = 1e-13
LENGTHS = [300.0, 500.0, 200.0]


def test_weight_in_the_loop_carries_both_strands():
    assert take_up.take_up_mass(9810.0, reeving=1.0, gravity=9.81) == 2000.0
    assert take_up.take_up_mass(9810.0, reeving=4.0, gravity=9.81) == 500.0


def test_splitting_a_section_changes_no_mean():
    whole = take_up.mean_tension([10e3, 30e3], lengths=[300.0, 100.0])
    parts = take_up.mean_tension([10e3, 10e3, 30e3], lengths=[120.0, 180.0, 100.0])
    assert parts == pytest.approx(whole, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: take_up.take_up_mass(-1.0, reeving=1.0, gravity=9.81), r"tension: got -1\.0"),
        (lambda: take_up.take_up_mass(1.0, reeving=0.0, gravity=9.81), r"reeving: got 0\.0"),
        (lambda: take_up.mean_tension([1.0], lengths=[1.0, 2.0]), r"lengths: got .* one for each of 1 sections"),
        (lambda: take_up.mean_tension([1.0], lengths=[0.0]), r"lengths: got \[0\.0\], .*a loop longer than 0"),
        (lambda: take_up.mean_tension([1.0], lengths=[-1.0]), r"lengths: got -1\.0"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
