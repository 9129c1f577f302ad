"""The heap: both conventions hold the same area, the share is an integral, limits, refusals."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.laws import loading
from conveyor.laws.loading import heap

TROUGH = {
    "middle_roll_length": 0.436,
    "trough_angle": math.radians(45),
    "surcharge_angle": math.radians(20),
}


@pytest.mark.parametrize("shape", ["parabola", "triangle"])
def test_share_is_the_area_above_the_roll(shape):
    n, lam, theta, middle = 20000, math.radians(45), math.radians(20), 0.436
    across = (1.03 - middle) / 2 * math.cos(lam)
    half = middle / 2 + across
    step = 2 * half / n

    def height(x):
        belt = max(abs(x) - middle / 2, 0.0) * math.tan(lam)
        if shape == "parabola":
            top = math.tan(theta) * (half**2 - x**2) / (2 * half)
        else:
            top = 2 / 3 * math.tan(theta) * (half - abs(x))
        return across * math.tan(lam) - belt + top

    xs = [-half + (i + 0.5) * step for i in range(n)]
    inside = math.fsum(height(x) for x in xs if abs(x) < middle / 2) * step
    whole = math.fsum(height(x) for x in xs) * step
    # a strip on the roll's end is counted wholly or not: 2 strips of n, each end
    middle, wing = heap.shares_by_area(1.03, **TROUGH, heap=shape)
    assert middle + 2.0 * wing == pytest.approx(1.0, rel=1e-13)
    assert middle == pytest.approx(inside / whole, abs=4 / n)
    assert whole == pytest.approx(loading.cross_section(1.03, **TROUGH).area, rel=1e-6)


def test_the_whole_heap_on_one_roll_and_none_on_no_roll():
    flat = {"trough_angle": 0.3, "surcharge_angle": 0.3}
    for shape in ("parabola", "triangle"):
        assert heap.shares_by_area(1.0, middle_roll_length=1.0, **flat, heap=shape) == pytest.approx((1, 0), rel=1e-13)
        assert heap.shares_by_area(1.0, middle_roll_length=0.0, **flat, heap=shape) == (0, 0.5)


def test_a_pointed_heap_puts_more_on_the_middle():
    pointed = heap.shares_by_area(1.03, **TROUGH, heap="triangle")
    assert pointed[0] > heap.shares_by_area(1.03, **TROUGH)[0]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: heap.surcharge_from_slope(-0.1), r"slope = -0\.1"),
        (
            lambda: heap.shares_by_area(1.0, middle_roll_length=1.1, trough_angle=0.3, surcharge_angle=0.3),
            r"middle_roll_length = 1\.1 is not allowed: 0 to the width 1\.0 m",
        ),
        (
            lambda: heap.shares_by_area(1.0, middle_roll_length=0.4, trough_angle=0.0, surcharge_angle=0.0),
            r"surcharge_angle = 0\.0 is not allowed: a flat belt carries a heap only",
        ),
        (
            lambda: heap.shares_by_area(1.03, **TROUGH, heap="cone"),
            r"heap = 'cone' .* one of parabola, triangle",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
