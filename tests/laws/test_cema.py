"""CEMA: the formula in its own units by hand, additivity, momentum, refusals."""

from __future__ import annotations

import pytest

from conveyor.errors import InputError
from conveyor.laws import resistance
from conveyor.laws.resistance import cema

ROUNDING = 1e-13
LB_FT = cema.POUND / cema.FOOT  # [kg/m]
LBF_FT = cema.POUND_FORCE / cema.FOOT  # [N/m]

LINE = {
    "lift": 50 * cema.FOOT,
    "belt_mass": 15 * LB_FT,
    "bulk_mass": 60 * LB_FT,
    "idler_factor": 0.551 * LBF_FT,
    "flexure_factor": 0.02,
    "temperature_factor": 1.3,
    "other_forces": 700 * cema.POUND_FORCE,
}


def test_units_are_the_exact_ones():
    # lbf = lb × 9.80665 m/s²
    assert pytest.approx(cema.POUND * 9.80665, rel=1e-15) == cema.POUND_FORCE
    assert pytest.approx(0.45359237 / 0.3048, rel=1e-15) == LB_FT
    assert pytest.approx(907.18474 / 3600, rel=1e-15) == cema.SHORT_TON_PER_HOUR


def test_idler_factor_in_pounds_per_foot():
    kx = cema.cema_idler_factor(
        15 * LB_FT, bulk_mass=60 * LB_FT, idler_friction=1.5 * cema.POUND_FORCE, spacing=3 * cema.FOOT
    )
    assert kx / LBF_FT == pytest.approx(0.00068 * 75 + 0.5, rel=ROUNDING)


def test_effective_tension_in_pounds():
    te = cema.cema_effective_tension(1000 * cema.FOOT, **LINE)
    by_hand = 1000 * 1.3 * (0.551 + 0.02 * 15 + 0.015 * 15) + 60 * (1000 * 0.02 + 50) + 700
    assert te.effective / cema.POUND_FORCE == pytest.approx(by_hand, rel=ROUNDING)


def test_splitting_the_length_changes_nothing():
    whole = cema.cema_effective_tension(300.0, **LINE)
    shares = ((100.0, 1 / 3), (200.0, 2 / 3))
    parts = [
        cema.cema_effective_tension(
            length, **LINE | {"lift": LINE["lift"] * s, "other_forces": LINE["other_forces"] * s}
        )
        for length, s in shares
    ]
    assert sum(p.effective for p in parts) == pytest.approx(whole.effective, rel=ROUNDING)


def test_lift_is_the_weight_at_standard_gravity_with_its_sign():
    up = cema.cema_effective_tension(300.0, **LINE)
    down = cema.cema_effective_tension(300.0, **LINE | {"lift": -LINE["lift"]})
    assert up.lift == pytest.approx(LINE["bulk_mass"] * 9.80665 * LINE["lift"], rel=ROUNDING)
    assert down.lift == pytest.approx(-up.lift, rel=ROUNDING)
    assert (down.bulk, down.idlers) == pytest.approx((up.bulk, up.idlers), rel=ROUNDING)


def test_cold_touches_idlers_and_belt_but_not_the_bulk():
    warm = cema.cema_effective_tension(300.0, **LINE | {"temperature_factor": 1.0})
    cold = cema.cema_effective_tension(300.0, **LINE)
    for part in ("idlers", "belt_carry", "belt_return"):
        assert getattr(cold, part) == pytest.approx(1.3 * getattr(warm, part), rel=ROUNDING)
    others = (warm.bulk, warm.lift, warm.others)
    assert (cold.bulk, cold.lift, cold.others) == pytest.approx(others, rel=ROUNDING)


def test_acceleration_is_the_momentum_with_rounded_gravity():
    speeds = {"belt_speed": 4.8, "initial_speed": 1.2}
    ours = cema.cema_acceleration(600.0, **speeds)
    momentum = resistance.acceleration_resistance(600.0, **speeds)
    # 32.174049/32.2 and the 5 printed digits of 2.8755e-4
    assert ours / momentum == pytest.approx(32.174049 / 32.2, abs=2e-5)


def test_pulleys_add_up():
    assert cema.cema_pulley_friction([]) == 0
    two = cema.cema_pulley_friction(["tight", "other"])
    assert two / cema.POUND_FORCE == pytest.approx(300, rel=ROUNDING)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: cema.cema_idler_factor(1.0, bulk_mass=1.0, idler_friction=1.0, spacing=0.0),
            r"spacing: got 0\.0",
        ),
        (
            lambda: cema.cema_pulley_friction(["head"]),
            r"places: got 'head', allowed: tight, slack, other",
        ),
        (
            lambda: cema.cema_effective_tension(1.0, **LINE | {"flexure_factor": 2.0}),
            r"flexure_factor: got 2\.0, allowed: >= 0 and <= 0\.1",
        ),
        (
            lambda: cema.cema_effective_tension(1.0, **LINE | {"temperature_factor": 0.9}),
            r"temperature_factor: got 0\.9, allowed: >= 1",
        ),
        (lambda: cema.cema_effective_tension(-1.0, **LINE), r"length: got -1\.0"),
        (lambda: cema.cema_skirts(1.0, skirt_factor=0.1, depth=-1.0, seals=1.0), r"depth: got -1\.0"),
        (
            lambda: cema.cema_acceleration(1.0, belt_speed=1.0, initial_speed=2.0),
            r"initial_speed: got 2\.0, allowed: >= 0 and <= belt_speed = 1\.0",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
