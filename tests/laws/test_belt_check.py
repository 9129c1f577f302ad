"""Belt and pulleys: round trips, order of the figures, the series, refusals."""

from __future__ import annotations

import inspect
import math
from itertools import pairwise

import pytest

from conveyor.errors import InputError, RangeError
from conveyor.laws import belt_strength as belt_check

ROUNDING = 1e-13


def test_safety_times_tension_is_the_breaking_force():
    safety = belt_check.belt_safety(150e3, nominal_strength=1.25e6, belt_width=1.2)
    assert safety * 150e3 == pytest.approx(1.5e6, rel=ROUNDING)


def test_a_belt_of_the_needed_strength_has_its_safety_at_the_splice():
    strength = belt_check.required_strength(200e3, splice_strength=0.45, s0=1.1, s1=1.7)
    assert 0.45 * strength / 200e3 == pytest.approx(1.1 * 1.7, rel=ROUNDING)
    assert belt_check.required_strength(200e3, splice_strength=1.0, s0=1.0, s1=1.0) == 200e3


@pytest.mark.parametrize("table", [belt_check.SPLICE_SAFETY, belt_check.DUTY_SAFETY])
def test_worse_conditions_ask_for_more(table):
    assert 1.0 <= table["favourable"] < table["normal"] < table["unfavourable"]


def test_groups_are_steps_of_the_r10_series():
    # 10^(1/10) per step, R10 values are rounded to 1.5 %
    factors = [belt_check.pulley_group_diameter(1.0, group=group) for group in ("A", "B", "C")]
    for large, small in pairwise(factors):
        assert large / small == pytest.approx(10**0.1, rel=0.015)
    assert belt_check.pulley_group_diameter(0.5, group="B") == pytest.approx(0.4, rel=ROUNDING)


def test_sizes_are_preferred_numbers():
    """ISO 3: the numbers of R20 are its powers of 10^(1/20), rounded by at most 1.26 %."""
    for size in {*belt_check.PULLEY_DIAMETERS, *TABLE_SIZES}:
        exponent = 20.0 * math.log10(size)
        assert size == pytest.approx(10.0 ** (round(exponent) / 20.0), rel=0.0127)


@pytest.mark.parametrize("group", ["A", "B", "C"])
@pytest.mark.parametrize("size", [belt_check.pulley_group_diameter, belt_check.standard_pulley_diameter])
def test_without_a_use_the_tension_is_the_allowed_one(size, group):
    """Not above it, where no table reaches, nor at 60 % of it and less, where pulleys are a step smaller."""
    full = size(1.0, group=group)
    assert full == size(1.0, group=group, utilisation=1.0)
    assert full > size(1.0, group=group, utilisation=0.6)
    default = inspect.signature(size).parameters["utilisation"].default
    assert default == pytest.approx(1.0, rel=ROUNDING)


def test_next_pulley_is_the_first_that_is_large_enough():
    for series in (belt_check.PULLEY_DIAMETERS, belt_check.CEMA_PULLEYS):
        for small, large in pairwise(series):
            assert belt_check.next_pulley_diameter(large, series=series) == large
            assert belt_check.next_pulley_diameter(small + 1e-5, series=series) == large
    # a step of the series taken from the drive pulley stays in the series: 0.63 · 0.5 is 0.315
    assert belt_check.next_pulley_diameter(belt_check.pulley_group_diameter(0.5, group="C")) == 0.315
    with pytest.raises(RangeError, match=r"2\.1 m is more than the largest pulley of the series, 2 m"):
        belt_check.next_pulley_diameter(2.1)


# DIN 22101: groups A, B, C over 60 %, over 30 % and up to 30 % of the allowed tension [mm]
TABLE = {
    200: ((200, 160, 125), (160, 125, 100), (125, 125, 100)),
    500: ((500, 400, 315), (400, 315, 250), (315, 315, 250)),
    1400: ((1400, 1250, 1000), (1250, 1000, 800), (1000, 1000, 800)),
    1600: ((1600, 1250, 1000), (1250, 1000, 800), (1000, 1000, 800)),
    2000: ((2000, 1600, 1250), (1600, 1250, 1000), (1250, 1250, 1000)),
}


TABLE_SIZES = {size / 1e3 for rows in TABLE.values() for row in rows for size in row}


@pytest.mark.parametrize("drive", TABLE)
def test_standard_pulleys_as_printed(drive):
    for used, sizes in zip((0.61, 0.31, 0.3), TABLE[drive], strict=True):
        found = [belt_check.standard_pulley_diameter(drive / 1e3, group=group, utilisation=used) for group in "ABC"]
        assert found == pytest.approx([size / 1e3 for size in sizes], rel=ROUNDING)


def test_covers_protect_the_carcass():
    assert belt_check.least_cover(4e-3, steel_cord=True) == 4e-3
    assert belt_check.least_cover(10e-3, steel_cord=True) == pytest.approx(7e-3, rel=ROUNDING)
    assert [belt_check.fall_severity(h) for h in (0.0, 0.5, 1.5)] == ["low", "medium", "high"]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: belt_check.belt_safety(0.0, nominal_strength=1e6, belt_width=1.0),
            r"largest_tension: got 0\.0",
        ),
        (
            lambda: belt_check.required_strength(1e5, splice_strength=1.2, s0=1.1, s1=1.7),
            r"splice_strength: got 1\.2, allowed: > 0 and <= 1",
        ),
        (lambda: belt_check.required_strength(1e5, splice_strength=0.4, s0=0.9, s1=1.7), r"s0: got 0\.9"),
        (lambda: belt_check.required_strength(1e5, splice_strength=0.4, s0=1.1, s1=0.9), r"s1: got 0\.9"),
        (
            lambda: belt_check.pulley_group_diameter(1.0, group="D"),
            r"group: got 'D', allowed: A, B, C",
        ),
        (lambda: belt_check.next_pulley_diameter(0.0), r"least_diameter: got 0\.0"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
