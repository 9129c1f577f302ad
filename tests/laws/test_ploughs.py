"""Ploughs: proportional, refused when impossible."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.laws.resistance import plough_drag


def test_plough_resistance_is_width_times_factor_times_number():
    assert plough_drag.plough_resistance(1.0, scraping_factor=1500.0, n_ploughs=3) == 4500.0
    assert plough_drag.plough_resistance(1.0, scraping_factor=1500.0, n_ploughs=0) == 0
    assert plough_drag.SCRAPING_FACTOR.general_knowledge


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"scraped_width": -1.0, "scraping_factor": 1.0}, r"scraped_width = -1\.0"),
        ({"scraped_width": 1.0, "scraping_factor": float("nan")}, r"scraping_factor = nan"),
        ({"scraped_width": 1.0, "scraping_factor": 1.0, "n_ploughs": -1}, r"n_ploughs = -1 is not allowed"),
    ],
)
def test_refusals(arguments, message):
    with pytest.raises(InputError, match=message):
        plough_drag.plough_resistance(**arguments)
