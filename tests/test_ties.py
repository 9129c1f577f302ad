from __future__ import annotations

import math

import pytest

from conveyor.loop.ties import first_maximum, first_minimum


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_of_equals_the_first_whatever_rounding_says(scale: float) -> None:
    rising = [scale * (1.0 + k * 2.0**-52) for k in range(4)]
    assert first_maximum(range(4), rising.__getitem__) == 0
    assert first_maximum(reversed(range(4)), rising.__getitem__) == 3
    assert first_minimum(reversed(range(4)), rising.__getitem__) == 3


def test_a_difference_that_is_none_of_rounding_decides() -> None:
    assert first_maximum([1.0, 1.0 + 1e-7], float) == 1.0 + 1e-7
    assert first_minimum([1.0, 1.0 - 1e-7], float) == 1.0 - 1e-7
    assert first_maximum([-math.inf, -5.0, math.inf], float) == math.inf
    assert first_minimum([-2.0, -1.0], float) == -2.0


def test_nothing_has_no_largest() -> None:
    with pytest.raises(ValueError, match="empty"):
        first_maximum([], float)
