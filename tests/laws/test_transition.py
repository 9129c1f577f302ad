"""Lengths of transitions: strips of straight way by hand, by quadrature, and where the standard's formula holds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from conveyor.errors import InputError
from conveyor.laws.transition import cema_transition_length, transition_length, transition_stretch

WIDTH, MIDDLE, ANGLE = 1.2, 0.4, math.radians(35.0)


def strips(height, length, count=200_001):
    """Place over the belt and elongation of strips of exactly straight way."""
    wing = (WIDTH - MIDDLE) / 2.0
    place = np.linspace(0.0, WIDTH / 2.0, count)
    along = np.maximum(place - MIDDLE / 2.0, 0.0)
    rise = along * math.sin(ANGLE) - height * wing * math.sin(ANGLE)
    inward = along * (1.0 - math.cos(ANGLE))
    return np.sqrt(length**2 + rise**2 + inward**2) / length - 1.0


@pytest.mark.parametrize("height", [0.0, 0.3, 0.5, 0.8, 1.0])
def test_strips_are_those_of_straight_lines(height):
    """At 60 m the square of (w/L)² is 1e-9 of the elongation's 1e-5; trapezoids are good to 1e-10 of their sum."""
    length = 60.0
    found = transition_stretch(WIDTH, middle_roll_length=MIDDLE, trough_angle=ANGLE, pulley_height=height)
    exact = strips(height, length) * length**2
    mean = float(np.mean((exact[:-1] + exact[1:]) / 2.0))
    assert found.edge == pytest.approx(exact[-1] - mean, abs=1e-6)
    assert found.middle == pytest.approx(exact[0] - mean, abs=1e-6)
    assert found.least == pytest.approx(float(exact.min()) - mean, abs=1e-6)


def test_a_pulley_of_half_depth_halves_the_way_and_eases_the_edge():
    full, half = (
        transition_stretch(WIDTH, middle_roll_length=MIDDLE, trough_angle=ANGLE, pulley_height=height)
        for height in (0.0, 0.5)
    )
    # full: the middle is the strip stretched least; the edge over it is 2 w² sin²(λ/2)
    assert full.least == full.middle
    assert full.edge - full.middle == pytest.approx(2.0 * 0.4**2 * math.sin(ANGLE / 2.0) ** 2, rel=1e-12)
    assert half.edge < full.edge / 4.0
    assert half.least > full.least
    # middle and edge alike at 1/(1 + cos λ) of the depth
    alike = transition_stretch(
        WIDTH, middle_roll_length=MIDDLE, trough_angle=ANGLE, pulley_height=1.0 / (1.0 + math.cos(ANGLE))
    )
    assert alike.edge == pytest.approx(alike.middle, rel=1e-12)


def test_a_flat_belt_needs_no_transition():
    for middle, angle in ((WIDTH, ANGLE), (MIDDLE, 0.0)):
        found = transition_stretch(WIDTH, middle_roll_length=middle, trough_angle=angle, pulley_height=0.5)
        assert (found.edge, found.middle, found.least) == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
    assert transition_length(1e5, stretch=0.0, stiffness_per_width=72e6, limit_per_width=0.0) == 0.0


def test_the_strip_bears_its_limit_at_the_length_found():
    """36 MN/m · 0.01 m²/L² = 90 - 50 kN/m gives L = 3 m; slackened: 40 kN/m lost of 40."""
    assert transition_length(50e3, stretch=0.01, stiffness_per_width=36e6, limit_per_width=90e3) == pytest.approx(
        3.0, rel=1e-14
    )
    assert transition_length(40e3, stretch=-0.01, stiffness_per_width=36e6, limit_per_width=0.0) == pytest.approx(
        3.0, rel=1e-14
    )
    for tension, stretch, limit in ((90e3, 0.01, 90e3), (0.0, -0.01, 0.0)):
        assert math.isinf(transition_length(tension, stretch=stretch, stiffness_per_width=36e6, limit_per_width=limit))


def test_refusals():
    with pytest.raises(InputError, match=r"pulley_height: got 1\.5, allowed: >= 0 and <= 1"):
        transition_stretch(WIDTH, middle_roll_length=MIDDLE, trough_angle=ANGLE, pulley_height=1.5)
    with pytest.raises(InputError, match="middle_roll_length"):
        transition_stretch(WIDTH, middle_roll_length=2.0, trough_angle=ANGLE, pulley_height=0.0)
    with pytest.raises(InputError, match="tension_per_width"):
        transition_length(-1.0, stretch=0.01, stiffness_per_width=36e6, limit_per_width=0.0)


@pytest.mark.parametrize(
    ("angle", "utilisation", "steel", "height", "widths"),
    [
        (35.0, 0.4, False, 0.0, 1.8), (35.0, 0.75, False, 0.0, 2.4), (35.0, 0.95, False, 0.0, 3.2),
        (20.0, 0.6, True, 0.0, 2.8), (45.0, 1.2, True, 0.0, 8.0), (45.0, 0.9, False, 0.49, 3.2),
        (35.0, 0.61, True, 0.5, 2.6), (20.0, 0.0, False, 1.0, 0.6),
    ],
)  # fmt: skip
def test_transitions_by_cema_are_those_of_its_tables(angle, utilisation, steel, height, widths):
    found = cema_transition_length(
        WIDTH,
        trough_angle=math.radians(angle),
        utilisation=utilisation,
        carcass="steel cord" if steel else "EP",
        pulley_height=height,
    )
    assert found == pytest.approx(widths * WIDTH, rel=1e-12)


def test_cemas_tables_are_longer_for_more_tension_steeper_troughs_and_steel():
    def length(angle, utilisation, steel, height):
        return cema_transition_length(
            1.0,
            trough_angle=math.radians(angle),
            utilisation=utilisation,
            carcass="steel cord" if steel else "EP",
            pulley_height=height,
        )

    for height in (0.0, 0.5):
        for steel in (False, True):
            every = [[length(angle, use, steel, height) for use in (0.5, 0.8, 1.0)] for angle in (20.0, 35.0, 45.0)]
            assert (np.diff(every, axis=0) > 0.0).all()
            assert (np.diff(every, axis=1) > 0.0).all()
    assert length(35.0, 0.5, True, 0.0) > length(35.0, 0.5, False, 0.0) > length(35.0, 0.5, False, 0.5)
    assert length(30.0, 0.5, False, 0.0) is None


@pytest.mark.parametrize(("name", "value"), [("belt_width", 0.0), ("utilisation", -0.1), ("pulley_height", 1.1)])
def test_transitions_by_cema_refuse_what_is_no_transition(name, value):
    given = {"belt_width": 1.0, "trough_angle": 0.6, "utilisation": 0.5, "carcass": "EP", "pulley_height": 0.0}
    with pytest.raises(InputError, match=name):
        cema_transition_length(**given | {name: value})
