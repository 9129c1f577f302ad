"""Horizontal curves: potential energy of the drifted belt, flat and straight limits, mirror symmetry, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from conveyor.errors import InputError
from conveyor.laws import horizontal_curve as curve
from conveyor.laws.loading import RollLoad

ROUNDING = 1e-12
ROLL = 0.38
TROUGH = {"trough_angle": math.radians(35), "banking_angle": math.radians(4)}
BULK = (
    RollLoad("left wing", 150.0, 60.0, 0.31, "triangular"),
    RollLoad("middle", 700.0, 80.0, ROLL, "uniform"),
    RollLoad("right wing", 150.0, 60.0, 0.31, "triangular"),
)
V = (RollLoad("left", 0.0, 100.0, 0.5, "uniform"), RollLoad("right", 0.0, 100.0, 0.5, "uniform"))


def _belt(per_width):
    """An empty belt on three rolls."""
    return [RollLoad("", 0.0, per_width * width, width, "uniform") for width in (0.31, ROLL, 0.31)]


def _height(place):
    """Of the banked trough at a place along its rolls from the middle, inside positive."""
    beyond = abs(place) - 0.5 * ROLL
    inside, outside = (TROUGH["trough_angle"] + side * TROUGH["banking_angle"] for side in (1, -1))
    level = math.copysign(min(abs(place), 0.5 * ROLL), place) * math.sin(TROUGH["banking_angle"])
    return level + max(0.0, beyond) * math.sin(inside if place > 0 else outside)


@pytest.mark.parametrize("drift", [-0.31, -0.1, 0.0, 0.2, 0.31])
def test_without_friction_the_force_is_the_slope_of_the_potential_energy(drift):
    """d/ds of w ∫ z(y + s) dy over the belt is w times the difference of its edges' heights (Leibniz)."""
    pushes = curve.outward_force_factors((0.0, 0.0, 0.0), **TROUGH)
    edges = _height(0.5 + drift) - _height(-0.5 + drift)
    law = curve.DriftLaw.of(_belt(250.0), pushes)
    assert law.force(drift) == pytest.approx(250.0 * edges, rel=ROUNDING, abs=250.0 * ROUNDING)


@pytest.mark.parametrize("loads", [BULK, V, _belt(20.0)])
def test_drift_keeps_the_sum_and_comes_back(loads):
    for drift in (0.1, -0.25):
        moved = curve.drifted_loads(loads, drift, roll_length=10.0)
        for part in ("bulk_force", "belt_force", "length"):
            whole = math.fsum(getattr(load, part) for load in loads)
            assert math.fsum(getattr(load, part) for load in moved) == pytest.approx(whole, rel=ROUNDING)
        mirrored = curve.drifted_loads(loads[::-1], -drift, roll_length=10.0)
        assert [one.force for one in mirrored[::-1]] == pytest.approx([one.force for one in moved], rel=ROUNDING)
    assert curve.drifted_loads(loads, 0.0, roll_length=10.0) == tuple(loads)


@pytest.mark.parametrize("loads", [BULK, _belt(20.0)])
@pytest.mark.parametrize("frictions", [(0.0, 0.0, 0.0), (0.3, 0.0, -0.3), (0.2, 0.1, -0.05)])
def test_the_drift_balances_the_pull(loads, frictions):
    """At the drift the moved loads push as much out as is pulled in; the parabolas are exact."""
    pushes = curve.outward_force_factors(frictions, **TROUGH)
    law = curve.DriftLaw.of(loads, pushes)
    weight = math.fsum(load.force for load in loads)
    for share in (-0.05, 0.0, 0.03, 0.1, 0.2):
        drift = law.drift(share * weight)
        held = curve.outward_force(curve.drifted_loads(loads, drift, roll_length=10.0), pushes)
        assert held == pytest.approx(share * weight, rel=1e-9, abs=1e-9 * weight)
        assert law.force(drift) == pytest.approx(held, rel=1e-9, abs=1e-9 * weight)


def test_an_empty_v_drifts_by_the_pull_over_weight_and_slope():
    """W sin λ s/w = P on two rolls without banking."""
    lam, pull = math.radians(15), 12.0
    law = curve.DriftLaw.of(V, curve.outward_force_factors((0.0, 0.0), trough_angle=lam, banking_angle=0.0))
    assert law.drift(pull) == pytest.approx(0.5 * pull / (200.0 * math.sin(lam)), rel=ROUNDING)
    assert law.drift(-pull) == pytest.approx(-law.drift(pull), rel=ROUNDING)
    assert law.drift(0.0) == 0.0
    most = 200.0 * math.sin(lam)  # one wing bare, all of the belt on the other
    assert law.drift(0.99 * most) < 0.5
    assert law.drift(1.01 * most) == math.inf
    assert law.drift(-1.01 * most) == -math.inf


def test_a_flat_belt_is_held_by_banking_and_friction_alone():
    """As λ goes to 0 every roll pushes with sin β + μ cos β: none holds more by drift, a pull beyond runs off."""
    mu, beta = 0.3, math.radians(5)
    pushes = curve.outward_force_factors((mu, mu, mu), trough_angle=1e-15, banking_angle=beta)
    assert pushes == pytest.approx([math.sin(beta) + mu * math.cos(beta)] * 3, rel=ROUNDING)


def test_a_flat_set_holds_the_course_of_its_belt():
    """There and back; at small angles W 3 μ s/(ε_s L); at all what rolls in a trough of no depth push."""
    law = curve.FlatDrift(
        200.0,
        banking_angle=math.radians(2),
        skew=0.002,
        friction=0.35,
        full_slip=0.05,
        length=40.0,
        reach=0.7,
    )
    for drift in (-0.3, 0.0, 0.1, 0.6):
        assert law.drift(law.force(drift)) == pytest.approx(drift, abs=1e-12)
    slope = 200.0 * math.cos(law.banking_angle) * 3.0 * 0.35 / (0.05 * 40.0)
    middle = -0.002 * 40.0  # where the belt runs square to its rolls
    assert law.force(middle + 1e-6) - law.force(middle) == pytest.approx(slope * 1e-6, rel=1e-4)
    assert law.force(middle) == pytest.approx(200.0 * math.sin(law.banking_angle))
    assert law.most == pytest.approx(200.0 * (math.sin(law.banking_angle) + 0.35 * math.cos(law.banking_angle)))
    assert law.drift(1.001 * law.most) == math.inf
    assert law.drift(-law.most) == -math.inf


def test_guiding_friction_rises_from_nothing_to_all():
    given = {"friction": 0.4, "full_slip": 0.05}
    small = 1e-9
    assert curve.guide_friction(small, **given) == pytest.approx(3.0 * 0.4 * small / 0.05, rel=1e-6)
    assert curve.guide_friction(-small, **given) == -curve.guide_friction(small, **given)
    assert curve.guide_friction(0.05, **given) == curve.guide_friction(0.3, **given) == 0.4
    assert curve.guide_friction(0.0, **given) == 0.0


def test_a_wing_bears_no_more_than_its_roll_is_long():
    moved = curve.drifted_loads(BULK, 0.2, roll_length=ROLL)
    assert [load.length for load in moved] == pytest.approx([ROLL, ROLL, 0.11])


def test_refusals():
    with pytest.raises(InputError, match=r"<= 0\.31 m, the belt on the wing"):
        curve.drifted_loads(BULK, 0.32, roll_length=ROLL)
    with pytest.raises(InputError, match="two to five rolls"):
        curve.drifted_loads((*BULK, *BULK), 0.1, roll_length=ROLL)
    with pytest.raises(InputError, match="two to five rolls"):
        curve.outward_force_factors((0.0,), **TROUGH)
    with pytest.raises(InputError, match="trough_angle"):
        curve.outward_force_factors((0.0, 0.0), trough_angle=0.0, banking_angle=0.1)
    with pytest.raises(InputError, match="sum_of_trough_and_banking"):
        curve.outward_force_factors((0.0, 0.0), trough_angle=1.0, banking_angle=0.7)
    law = curve.DriftLaw.of(BULK, curve.outward_force_factors((0.0, 0.0, 0.0), **TROUGH))
    with pytest.raises(InputError, match=r"drift: got 0\.4"):
        law.force(0.4)
    with pytest.raises(ValueError, match="shorter"):
        curve.outward_force(BULK, (0.1, 0.2))


def test_given_loads_need_not_be_even():
    """More bulk on the inside wing pushes the centred belt out."""
    pushes = curve.outward_force_factors((0.0, 0.0, 0.0), trough_angle=0.6, banking_angle=0.0)
    uneven = (replace(BULK[0], bulk_force=200.0), *BULK[1:])
    assert curve.DriftLaw.of(uneven, pushes).drift(0.0) < 0.0
