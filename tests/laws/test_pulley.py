"""Shafts of pulleys by hand in the inches and pounds of CEMA B105.1; statics of resultant and lagging."""

from __future__ import annotations

import itertools
import math

import pytest

from conveyor.errors import InputError, RangeError
from conveyor.laws.pulley import (
    CEMA_SHAFTS,
    HUB_SLOPE,
    SHAFT_DIAMETERS,
    SHAFT_SAFETY,
    hub_moment,
    lagging_pressure,
    least_shaft_diameter,
    next_shaft_diameter,
    pulley_resultant,
    shaft_safety,
    shaft_slope,
)

INCH, POUND = 0.0254, 4.4482216152605
LOAD, BEARINGS, HUBS, SHAFT, TORQUE = 20e3, 66.0, 46.0, 5.0, 60e3
"""lbf, in and lbf in: R, B, B - 2 A, D, T."""


def test_a_shaft_in_pounds_and_inches():
    """M = R A/2, tan α = R A (B - 2 A)/(4 E I), safety by the formula as printed; the printed constants are exact."""
    arm = (BEARINGS - HUBS) / 2.0
    moment = hub_moment(LOAD * POUND, bearing_centres=BEARINGS * INCH, hub_centres=HUBS * INCH)
    assert moment / (POUND * INCH) == pytest.approx(LOAD * arm / 2.0, rel=1e-12)
    slope = shaft_slope(moment, hub_centres=HUBS * INCH, diameter=SHAFT * INCH)
    by_hand = LOAD * arm * (BEARINGS - 2.0 * arm) / (4.0 * 29e6 * math.pi * SHAFT**4 / 64.0)
    assert slope == pytest.approx(by_hand, rel=1e-12)
    fatigue = 0.8 * SHAFT**-0.19 * 0.897 * 0.63 * 41000.0
    root = math.sqrt((LOAD * arm / 2.0 / fatigue) ** 2 + 0.75 * (TORQUE / 45000.0) ** 2)
    found = shaft_safety(moment, torque=TORQUE * POUND * INCH, diameter=SHAFT * INCH, steel="C1045", keyway="profiled")
    assert found == pytest.approx(math.pi * SHAFT**3 / (32.0 * root), rel=1e-12)


@pytest.mark.parametrize(("hubs", "torque"), [(2.5, 0.0), (0.3, 2e3), (0.3, 40e3)])
def test_the_least_shaft_is_at_one_of_its_limits(hubs, torque):
    least = least_shaft_diameter(10e3, torque=torque, hub_centres=hubs, steel="C1018", keyway="sled runner")
    slope = shaft_slope(10e3, hub_centres=hubs, diameter=least)
    safety = shaft_safety(10e3, torque=torque, diameter=least, steel="C1018", keyway="sled runner")
    assert slope <= HUB_SLOPE * (1.0 + 1e-12)
    assert safety >= SHAFT_SAFETY * (1.0 - 1e-12)
    reached = slope == pytest.approx(HUB_SLOPE, rel=1e-12) or safety == pytest.approx(SHAFT_SAFETY, rel=1e-12)
    assert reached
    by_slope = least_shaft_diameter(10e3, torque=torque, hub_centres=hubs, steel=None, keyway="profiled")
    assert by_slope <= least
    assert shaft_slope(10e3, hub_centres=hubs, diameter=by_slope) == pytest.approx(HUB_SLOPE, rel=1e-12)


def test_the_weight_adds_most_where_the_belt_pulls_down():
    assert pulley_resultant(300.0, weight=100.0) == pytest.approx(400.0, rel=1e-14)
    assert pulley_resultant(300.0, weight=100.0, pull_angle=math.pi) == pytest.approx(200.0, rel=1e-14)
    assert pulley_resultant(300.0, weight=400.0, pull_angle=math.pi / 2.0) == pytest.approx(500.0, rel=1e-14)


def test_the_lagging_bears_the_belt():
    """Half a turn at even tension: pressure over the projected face is both tensions."""
    pressure = lagging_pressure(50e3, pulley_diameter=0.8, belt_width=1.2)
    assert pressure * 0.8 * 1.2 == pytest.approx(2 * 50e3, rel=1e-14)


def test_refusals_and_no_load():
    assert math.isinf(shaft_safety(0.0, torque=0.0, diameter=0.1, steel="C1018", keyway="profiled"))
    with pytest.raises(InputError, match="steel: got 'C45', allowed: C1018, C1045, C4140"):
        shaft_safety(1.0, torque=0.0, diameter=0.1, steel="C45", keyway="profiled")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"bearing_centres: got 1\.0, allowed: > hub_centres"):
        hub_moment(1.0, bearing_centres=1.0, hub_centres=1.0)
    with pytest.raises(InputError, match="pull_angle"):
        pulley_resultant(1.0, weight=1.0, pull_angle=4.0)


def test_shafts_of_both_series_are_the_next_larger():
    for series in (SHAFT_DIAMETERS, CEMA_SHAFTS):
        assert list(series) == sorted(set(series))
        for small, large in itertools.pairwise(series):
            assert next_shaft_diameter(large, series=series) == large
            assert next_shaft_diameter(small + 1e-6, series=series) == large
    with pytest.raises(RangeError, match="the largest of the series is 1 m"):
        next_shaft_diameter(1.2)
