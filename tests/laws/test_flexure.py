"""Flexure: the series against the pull of the lagging belt, both limits, scaling; Rankine; the bulk's bound."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from conveyor.errors import InputError
from conveyor.laws.resistance import flexure

ROUNDING = 1e-13
SPAN = {"tension": 50e3, "spacing": 1.2, "loss_tangent": 0.1}
BULK = {
    "bulk_density": 850.0,
    "friction_angle": math.radians(37),
    "wing_contact": 0.3,
    "trough_angle": math.radians(35),
    "gravity": 9.81,
}


@pytest.mark.parametrize("stiffness", [5.0, 30.0, 1e3, 1e6])
def test_belt_flexure_is_the_pull_of_the_support_on_the_lagging_belt(stiffness):
    # steady solution with the stiffness D (1 + i tan δ): the support pushes q a, normal to a belt whose slope over
    # it is -Im Σ κ_n/k_n; for a small loss the pull must equal the dissipation of the series
    loss, load = 1e-6, 1500.0
    pull = 0.0
    for n in range(1, 40001):
        k = 2 * math.pi * n / 1.2
        pull -= load * 1.2 * (2 * load / (50e3 + stiffness * (1 + 1j * loss) * k**2) / k).imag
    law = flexure.belt_flexure_resistance(
        load, tension=50e3, spacing=1.2, bending_stiffness=stiffness, loss_tangent=loss
    )
    # this sum is cut at N = 40000: its rest is at most 1/(2 ε⁴ N²), against 1/(2 ε²) for small ε, ζ(3)/ε⁴ for large
    epsilon = 2 * math.pi * math.sqrt(stiffness / 50e3) / 1.2
    cut = max(1 / (epsilon * 40000) ** 2, 1 / 40000**2)
    assert law == pytest.approx(pull, rel=2 * cut + 1e-10, abs=0)


def test_soft_belt_needs_no_stiffness_and_is_the_sag():
    limit = flexure.belt_flexure_resistance(1500.0, bending_stiffness=0.0, **SPAN)
    sag = 1500.0 * 1.2 / (8 * 50e3)
    assert limit / (1500.0 * 1.2) == pytest.approx(4 / math.pi * 0.1 * sag, rel=ROUNDING)
    # first term left out of the limit: ε²/6, from Σ n → ∫ - 1/12
    for stiffness in (1e-3, 1e-1):
        epsilon = 2 * math.pi * math.sqrt(stiffness / 50e3) / 1.2
        near = flexure.belt_flexure_resistance(1500.0, bending_stiffness=stiffness, **SPAN)
        assert 1 - near / limit == pytest.approx(epsilon**2 / 6, rel=0.01)


def test_the_measured_coefficient_gives_the_site_its_share():
    # belt 39.5 kg/m and 1764 N/m of coal, sets 2 m apart: 11 % of 61.7 N a set; 4302 N a set is printed to 0.5 N
    load = 1764.0 + 39.5 * 9.80665
    span = {"spacing": 2.0, "relative_sag": 0.004, "coefficient": flexure.FLEXURE_COEFFICIENT.value}
    assert flexure.sag_flexure_resistance(load, **span) == pytest.approx(0.11 * 61.7, rel=1.0 / 4302.0)
    # its band: a sag there of 1 and of 0.2 % instead of 0.4 %
    low, high = flexure.FLEXURE_COEFFICIENT.low, flexure.FLEXURE_COEFFICIENT.high
    for sag, coefficient in ((0.01, low), (0.002, high)):
        at = {"spacing": 2.0, "relative_sag": sag, "coefficient": coefficient}
        assert flexure.sag_flexure_resistance(load, **at) == pytest.approx(0.11 * 61.7, rel=1.0 / 4302.0)


def test_the_sag_of_the_assumed_tensions_at_the_site():
    # ST 1600 of 1.6 m: 1 % sag, and safety 6.7; the sag at their geometric mean, T - m' v² taken as T
    load = 1764.0 + 39.5 * 9.80665
    least, most = load * 2.0 / (8.0 * 0.01), 1600.0 * 1600.0 / 6.7
    assert (least / 1e3, most / 1e3) == (pytest.approx(55.0, abs=2.0), pytest.approx(380.0, abs=3.0))
    assert load * 2.0 / (8.0 * math.sqrt(least * most)) == pytest.approx(flexure.SITE_SAG.value, abs=0.0005)


@pytest.mark.parametrize(
    ("start", "end", "limit"),
    [
        (2e4, 5e4, 1e4),
        (5e4, 2e4, 1e4),
        (-1e4, 3e4, 1e4),
        (1e3, 9e3, 1e4),
        (2e4, 2e4 * (1 + 1e-9), 1e4),
        (1e4, 1e4, 1e4),
    ],
)
def test_the_mean_sag_is_the_integral_along_the_stretch(start, end, limit):
    def ratio(s):
        return limit / max(start + (end - start) * s, limit)

    kink = [(limit - start) / (end - start)] if start < limit < end else None
    whole = quad(ratio, 0.0, 1.0, points=kink, epsabs=1e-13, epsrel=1e-13)[0]
    mean = flexure.mean_sag_ratio(np.array(start), np.array(end), limit=np.array(limit))
    assert float(mean) == pytest.approx(whole, rel=1e-11)


def test_the_mean_sag_of_halves_is_that_of_the_whole():
    starts, ends, limit = np.array([3e4, -5e3]), np.array([1.2e4, 4e4]), np.full(2, 1e4)
    middle = 0.5 * (starts + ends)
    halves = [flexure.mean_sag_ratio(*pair, limit=limit) for pair in ((starts, middle), (middle, ends))]
    assert 0.5 * sum(halves) == pytest.approx(flexure.mean_sag_ratio(starts, ends, limit=limit), rel=1e-13)
    with pytest.raises(InputError, match="limit"):
        flexure.mean_sag_ratio(starts, ends, limit=np.array([1.0, -1.0]))


def test_a_belt_carried_everywhere_is_the_limit_of_no_tension_for_sag():
    """T_0 ln(T/T_0)/T falls to 0: what is taut has no sag, what is not is the share below 0."""
    starts, ends = np.array([3e4, 0.0, -1e4, 2e4, 0.0]), np.array([1e4, 2e4, 3e4, 2e4, 0.0])
    none = flexure.mean_sag_ratio(starts, ends, limit=np.zeros(5))
    assert none == pytest.approx([0.0, 0.0, 0.25, 0.0, 1.0], abs=1e-15)
    for limit in (1.0, 1e-3, 1e-6):
        near = flexure.mean_sag_ratio(starts, ends, limit=np.full(5, limit))
        bound = limit / 1e4 * (1.0 + np.log(3e4 / limit))  # T_0/T_max (1 + ln(T_max/T_0)) over the shortest rise
        assert np.all(np.abs(near - none) <= bound), limit


def test_load_and_sag_are_the_soft_belt_with_its_loss_as_coefficient():
    # h/a = q a/(8 T), c = 4 tan δ/π
    sag, c = 1500.0 * 1.2 / (8 * 50e3), 4 / math.pi * 0.1
    law = flexure.sag_flexure_resistance(1500.0, spacing=1.2, relative_sag=sag, coefficient=c)
    assert law == pytest.approx(flexure.belt_flexure_resistance(1500.0, bending_stiffness=0.0, **SPAN), rel=ROUNDING)
    for refused in ({"relative_sag": 0.2}, {"spacing": 0.0}, {"coefficient": -1.0}):
        with pytest.raises(InputError, match=next(iter(refused))):
            flexure.sag_flexure_resistance(1.0, **{"spacing": 1.0, "relative_sag": 0.01, "coefficient": 0.1} | refused)


def test_stiff_belt_is_the_continuous_beam():
    # T → 0: 4 π tan δ q² a⁴/(16 π⁴ D) ζ(3)
    zeta3 = 1.2020569031595942
    force = flexure.belt_flexure_resistance(1500.0, bending_stiffness=1e9, **SPAN)
    beam = 0.1 * 1500.0**2 * 1.2**4 * zeta3 / (4 * math.pi**3 * 1e9)
    # tension adds relative 2 T a²/(4π² D) ~ 4e-6; Euler-Maclaurin 1e-9
    assert force == pytest.approx(beam, rel=1e-5)


def test_belt_flexure_falls_with_tension_and_grows_with_the_square_of_the_load():
    soft = {"spacing": 1.2, "loss_tangent": 0.1, "bending_stiffness": 0.0}
    one = flexure.belt_flexure_resistance(1500.0, tension=50e3, **soft)
    assert flexure.belt_flexure_resistance(1500.0, tension=100e3, **soft) == pytest.approx(one / 2, rel=ROUNDING)
    stiff = SPAN | {"bending_stiffness": 30.0}
    ratio = flexure.belt_flexure_resistance(3000.0, **stiff) / flexure.belt_flexure_resistance(1500.0, **stiff)
    assert ratio == pytest.approx(4, rel=ROUNDING)


@pytest.mark.parametrize("stiffness", [0.0, 30.0])
def test_no_load_or_no_loss_no_flexure(stiffness):
    assert flexure.belt_flexure_resistance(0.0, bending_stiffness=stiffness, **SPAN) == 0
    lossless = SPAN | {"loss_tangent": 0.0}
    assert flexure.belt_flexure_resistance(1500.0, bending_stiffness=stiffness, **lossless) == 0


def test_rankine_states_are_reciprocal_and_meet_in_a_fluid():
    assert flexure.rankine_coefficients(0.0) == (1.0, 1.0)
    active, passive = flexure.rankine_coefficients(math.radians(37))
    assert active * passive == pytest.approx(1, rel=ROUNDING)
    assert active == pytest.approx(math.tan(math.radians(45 - 37 / 2)) ** 2, rel=ROUNDING)


def test_bulk_bound_is_the_moment_of_the_pressure_times_the_angle():
    active, passive = flexure.rankine_coefficients(BULK["friction_angle"])
    n = 2000
    step = 0.3 / n
    moment = sum(
        850.0 * 9.81 * (0.3 - s) * math.sin(math.radians(35)) * s * step for s in ((i + 0.5) * step for i in range(n))
    )
    law = flexure.bulk_flexure_bound(0.02, **BULK)
    # midpoint rule: relative error of ∫(b-s)s of n points is 1/(2 n²)
    assert law == pytest.approx(2 * (passive - active) * moment * 0.02, rel=1 / n**2)


@pytest.mark.parametrize("changed", [{"friction_angle": 0.0}, {"trough_angle": 0.0}, {"wing_contact": 0.0}])
def test_a_fluid_a_flat_belt_and_empty_wings_cost_nothing(changed):
    assert flexure.bulk_flexure_bound(0.02, **BULK | changed) == 0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: flexure.belt_flexure_resistance(1.0, bending_stiffness=0.0, **SPAN | {"tension": 0.0}),
            r"tension: got 0\.0",
        ),
        (
            lambda: flexure.belt_flexure_resistance(1.0, bending_stiffness=0.0, **SPAN | {"loss_tangent": 1.1}),
            r"loss_tangent: got 1\.1, allowed: >= 0 and <= 1",
        ),
        (
            lambda: flexure.belt_flexure_resistance(1.0, bending_stiffness=-1.0, **SPAN),
            r"bending_stiffness: got -1\.0",
        ),
        (lambda: flexure.rankine_coefficients(37.0), r"friction_angle: got 37\.0, allowed: .* pi/2 rad"),
        (lambda: flexure.bulk_flexure_bound(-0.1, **BULK), r"opening_angle: got -0\.1"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(InputError, match=message):
        call()
