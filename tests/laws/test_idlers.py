"""Idler sets: CEMA's ratings and its formula of raised sets, the string that moves along itself, refusals."""

from __future__ import annotations

import contextlib
import math
from itertools import pairwise

import pytest

from conveyor.errors import InputError, RangeError
from conveyor.laws import idler_sets

ROUNDING = 1e-12
INCH, POUND = 0.0254, 4.4482216152605
SPAN = {"line_mass": 20.0, "spacing": 3.0}


def rated(name, inches, degrees, rolls):
    return (
        idler_sets.rated_set_load(name, belt_width=inches * INCH, trough_angle=math.radians(degrees), rolls=rolls)
        / POUND
    )


@pytest.mark.parametrize(
    ("name", "inches", "degrees", "rolls", "pounds"),
    [
        ("B", 18, 20, 3, 410), ("B", 36, 45, 3, 396), ("B", 48, 0, 1, 125), ("C", 42, 35, 3, 791),
        ("C", 60, 45, 3, 630), ("C", 48, 10, 2, 500), ("D", 54, 35, 3, 1116), ("D", 48, 0, 1, 425),
        ("D", 60, 10, 2, 850),
    ],
)  # fmt: skip
def test_ratings_as_printed(name, inches, degrees, rolls, pounds):
    assert rated(name, inches, degrees, rolls) == pytest.approx(pounds, rel=ROUNDING)


def test_a_width_and_an_angle_count_to_the_next_column():
    assert rated("D", 1400 / 25.4, 35, 3) == rated("D", 54, 35, 3)  # 55.1 in: within 6 %
    assert rated("C", 1000 / 25.4, 30, 3) == rated("C", 42, 35, 3)
    assert rated("B", 36, 30, 3) >= rated("B", 36, 45, 3)


@pytest.mark.parametrize(
    ("name", "inches", "degrees", "rolls", "message"),
    [
        ("B", 72, 35, 3, "CEMA class B has no set of 3"), ("C", 54, 0, 1, "CEMA class C has no set of 1"),
        ("B", 36, 10, 2, "CEMA class B has no set of 2"), ("D", 12, 20, 3, "CEMA class D has no set of 3"),
        ("D", 36, 60, 3, "troughs of up to 45 deg, not 60 deg"), ("D", 36, 35, 5, "no set of 5"),
    ],
)  # fmt: skip
def test_what_a_class_has_not_is_said(name, inches, degrees, rolls, message):
    with pytest.raises(RangeError, match=message):
        rated(name, inches, degrees, rolls)


def test_a_raised_set_by_the_formula_of_the_book():
    # IML = D T/(6 Si): 0.1 in, 1000 lbf, 4 ft
    load = idler_sets.raised_set_load(1000.0 * POUND, height=0.1 * INCH, spacing=4 * 12 * INCH)
    assert load / POUND == pytest.approx(0.1 * 1000.0 / (6 * 4), rel=ROUNDING)


def test_a_belt_at_rest_swings_as_a_string():
    at_rest = idler_sets.flap_frequency(32e3, **SPAN, belt_speed=0.0)
    assert at_rest == pytest.approx(math.sqrt(32e3 / 20.0) / 6.0, rel=ROUNDING)
    assert idler_sets.flap_frequency(32e3, **SPAN, belt_speed=0.0, mode=3) == pytest.approx(3 * at_rest, rel=ROUNDING)


def test_a_wave_goes_there_and_back_in_a_period():
    # c + v with the belt, c - v against it
    wave, speed = math.sqrt(32e3 / 20.0), 6.0
    period = 3.0 / (wave + speed) + 3.0 / (wave - speed)
    assert 1.0 / idler_sets.flap_frequency(32e3, **SPAN, belt_speed=speed) == pytest.approx(period, rel=ROUNDING)


def test_near_its_waves_speed_the_belt_has_no_frequency():
    speed = math.sqrt(32e3 / 20.0)
    assert idler_sets.flap_frequency(32e3 * (1 + 1e-9), **SPAN, belt_speed=speed) < 1e-7
    with pytest.raises(InputError, match=r"> m' v² = 32000 N"):
        idler_sets.flap_frequency(32e3, **SPAN, belt_speed=speed)


def test_the_second_mode_counts():
    # first modes at 5 to 6 Hz: second at 10 to 12
    assert idler_sets.resonance_margin(11.0, lowest=5.0, highest=6.0) == 0.0
    assert idler_sets.resonance_margin(8.0, lowest=5.0, highest=6.0) == pytest.approx(0.25, rel=ROUNDING)
    assert idler_sets.resonance_margin(20.0, lowest=5.0, highest=6.0) == pytest.approx(0.4, rel=ROUNDING)


@pytest.mark.parametrize("margin", [0.0, 0.15, 0.5])
def test_the_still_spacing_is_as_far_from_resonance_as_wanted(margin):
    low = idler_sets.flap_frequency(32e3, **SPAN, belt_speed=5.0)
    spacing = idler_sets.resonance_free_spacing(9.0, lowest=low, spacing=3.0, margin=margin)
    there = idler_sets.flap_frequency(32e3, line_mass=20.0, spacing=spacing, belt_speed=5.0)
    assert idler_sets.resonance_margin(9.0, lowest=there, highest=2 * there) == pytest.approx(margin, abs=1e-12)


@pytest.mark.parametrize("density", [800.0, 1200.0, 1600.0, 2000.0, 2400.0, 2800.0, 3200.0])
def test_the_edge_of_a_column_in_pounds_is_that_edge(density):
    """1600 kg/m³ come to 1600.0000000000011 by lb/ft³."""
    pound_per_foot = density / (0.45359237 / 0.3048**3)
    again = pound_per_foot * 0.45359237 / 0.3048**3 * (1.0 + 1e-15)
    for lump in (0.1, 0.3, 0.5):
        factors = [idler_sets.lump_load_factor(lump, density=one) for one in (density, again)]
        assert factors[0] == factors[1]


@pytest.mark.parametrize("name", idler_sets.CEMA_CLASSES)
def test_no_wider_or_steeper_set_of_a_class_bears_more(name):
    widths = [18, 24, 30, 36, 42, 48, 54, 60, 72, 84, 96]
    table = []
    for inches in widths:
        with contextlib.suppress(RangeError):
            table.append([rated(name, inches, degrees, 3) for degrees in (20, 35, 45)])
    assert len(table) >= 6
    for narrow, wide in pairwise(table):
        assert all(w <= n * (1.0 + ROUNDING) for n, w in zip(narrow, wide, strict=True))
    for row in table:
        assert all(steep <= flat * (1.0 + ROUNDING) for flat, steep in pairwise(row))
