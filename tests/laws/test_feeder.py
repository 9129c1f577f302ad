"""Loads of belt feeders: a printed calculation, the balance of the wedge, the column of bulk, limits."""

import math

import pytest
from scipy.integrate import quad, solve_ivp

from conveyor.errors import ConveyorError
from conveyor.laws.feeder import (
    bin_surcharge_height,
    flow_load_factor,
    gate_flow,
    hopper_load,
    hopper_skirt_resistance,
    initial_load_factor,
    mass_flow_half_angle,
)
from conveyor.laws.resistance import skirt_resistance

DEG = math.pi / 180.0
PRINTED = {"density": 900.0, "outlet_length": 2.05, "outlet_width": 0.35, "gravity": 9.81}
"""Helix delta-T, feeder load calculation, lump coal, 2020: D 3.5 m, α 40°, δ 55°, φ 15°, 0.05 m/s."""


def test_printed_calculation_after_filling():
    """q_i 5.36, Q_i 11.89 kN, F_i 9.74 kN, 0.49 kW."""
    factor = initial_load_factor(3.5, outlet_width=0.35, half_angle=40.0 * DEG)
    load = hopper_load(factor, **PRINTED)
    assert factor == pytest.approx(5.36, abs=0.005)
    assert load == pytest.approx(11.89e3, abs=5.0)
    assert math.sin(55.0 * DEG) * load == pytest.approx(9.74e3, abs=5.0)
    assert math.sin(55.0 * DEG) * load * 0.05 == pytest.approx(0.49e3, abs=5.0)


def test_printed_calculation_in_flow_lacks_the_divisor():
    """Q_f 2.12 kN is that of the same field of stress without the divisor 4 tan α of the balance."""
    factor = flow_load_factor(40.0 * DEG, internal_friction=55.0 * DEG, wall_friction=15.0 * DEG)
    assert 4.0 * math.tan(40.0 * DEG) * hopper_load(factor, **PRINTED) == pytest.approx(2.12e3, abs=5.0)


def test_after_filling_is_the_column_over_the_outlet():
    width, height, slope = 0.6, 3.0, 20.0 * DEG
    top = width + 2.0 * height * math.tan(slope)
    factor = initial_load_factor(top, outlet_width=width, half_angle=slope)
    load = hopper_load(factor, density=850.0, outlet_length=4.0, outlet_width=width, gravity=9.81)
    assert load == pytest.approx(850.0 * 9.81 * width * 4.0 * height, rel=1e-12)


def test_a_bin_presses_like_its_slices_in_balance():
    """dp/dz = ρ g - K tan φ p/R from the top down, integrated; shallow: the whole column, deep: R/(K tan φ)."""
    radius, ratio, wall = 1.5, 0.4, 20.0 * DEG
    bin_walls = {"hydraulic_radius": radius, "wall_friction": wall, "pressure_ratio": ratio}
    drag = ratio * math.tan(wall) / radius
    integrated = solve_ivp(lambda _, p: 1.0 - drag * p, (0.0, 6.0), [0.0], rtol=1e-10, atol=1e-12).y[0, -1]
    assert bin_surcharge_height(6.0, **bin_walls) == pytest.approx(integrated, rel=1e-8)
    assert bin_surcharge_height(1e-6, **bin_walls) == pytest.approx(1e-6, rel=1e-6)
    assert bin_surcharge_height(1e4, **bin_walls) == pytest.approx(1.0 / drag, rel=1e-12)
    assert bin_surcharge_height(0.0, **bin_walls) == 0.0
    with pytest.raises(ConveyorError, match="bin_height"):
        bin_surcharge_height(-1.0, **bin_walls)


def test_the_bin_stands_on_the_column_over_the_outlet():
    hopper = {"outlet_width": 0.6, "half_angle": 20.0 * DEG}
    more = initial_load_factor(3.0, surcharge_height=2.4, **hopper) - initial_load_factor(3.0, **hopper)
    assert more == pytest.approx(4.0, rel=1e-12)


def test_in_flow_the_wedge_below_the_outlet_is_in_balance():
    """Tractions of both walls, from the printed field of stress and linear from the apex, less the wedge's weight."""
    slope, wall = 40.0 * DEG, 15.0 * DEG
    field = 2.12e3 / hopper_load(1.0, **PRINTED)
    at_outlet = (field + 1.0) / (2.0 * (math.tan(slope) + math.tan(wall)))  # wall pressure over ρ g B
    side = 0.5 / math.sin(slope)  # length of a wall over B
    upward = math.sin(slope) + math.tan(wall) * math.cos(slope)
    held = 2.0 * quad(lambda s: at_outlet * s / side * upward, 0.0, side)[0]
    expected = held - 0.25 / math.tan(slope)
    found = flow_load_factor(slope, internal_friction=55.0 * DEG, wall_friction=wall)
    assert found == pytest.approx(expected, abs=0.005 / 2.12)


def test_flow_leaves_less_than_filling():
    walls = (10.0, 15.0, 20.0)
    loads = [flow_load_factor(0.35, internal_friction=50.0 * DEG, wall_friction=wall * DEG) for wall in walls]
    assert all(0.0 < load < initial_load_factor(3.0, outlet_width=0.6, half_angle=0.35) for load in loads)


def test_skirts_under_the_hopper_feel_load_and_bulk():
    """μ K of the vertical pressure, integrated from the outlet down to the belt, on both sides."""
    load, density, length, width, height = 3000.0, 850.0, 4.0, 0.6, 0.25
    side = quad(lambda z: 0.4 * (load / (width * length) + density * 9.81 * z), 0.0, height)[0]
    found = hopper_skirt_resistance(
        load, pressure_ratio=0.4, friction=0.5, density=density, outlet_length=length, outlet_width=width,
        gate_height=height, gravity=9.81,
    )  # fmt: skip
    assert found == pytest.approx(2.0 * 0.5 * length * side, rel=1e-12)


def test_skirts_without_a_hopper_are_those_of_iso_5048_at_a_pressure_ratio_of_one():
    """μ2 Q² ρ g l/(v² b²), Q the volume flow, against μ K ρ g l y² at the depth of the flow y = Q/(v b)."""
    flow, speed, width, length = 0.04, 0.3, 0.6, 2.5
    iso = skirt_resistance(
        volume_flow=flow, bulk_density=850.0, length=length, bulk_speed=speed, skirt_distance=width,
        skirt_friction=0.7, gravity=9.81,
    )  # fmt: skip
    ours = hopper_skirt_resistance(
        0.0, pressure_ratio=1.0, friction=0.7, density=850.0, outlet_length=length, outlet_width=width,
        gate_height=flow / (speed * width), gravity=9.81,
    )  # fmt: skip
    assert ours == pytest.approx(iso, rel=1e-12)


def test_gate():
    assert gate_flow(0.3, density=1000.0, gate_width=0.6, gate_height=0.25) == pytest.approx(45.0, rel=1e-12)
    slipping = gate_flow(0.3, density=1000.0, gate_width=0.6, gate_height=0.25, efficiency=0.8)
    assert slipping == pytest.approx(36.0, rel=1e-12)
    with pytest.raises(ConveyorError, match="efficiency"):
        gate_flow(0.3, density=1000.0, gate_width=0.6, gate_height=0.25, efficiency=1.2)


def test_refusals():
    with pytest.raises(ConveyorError, match="top_width"):
        initial_load_factor(0.3, outlet_width=0.35, half_angle=0.3)
    with pytest.raises(ConveyorError, match="wall_friction"):
        flow_load_factor(0.3, internal_friction=0.5, wall_friction=0.6)
    with pytest.raises(ConveyorError, match="no field of stress"):
        flow_load_factor(58.0 * DEG, internal_friction=40.0 * DEG, wall_friction=35.0 * DEG)


@pytest.mark.parametrize(("inside", "wall"), [(30.0, 10.0), (40.0, 20.0), (50.0, 20.0), (60.0, 25.0), (60.0, 30.0)])
def test_the_limit_of_mass_flow_is_that_of_another_fit(inside, wall):
    """Jenike's chart as ter Borg (1986) fits it; the chart is read to a degree or two."""
    steepest = 60.5 + math.degrees(math.atan((50.0 - inside) / 7.73)) / 15.07
    other = steepest * (1.0 - wall / (42.3 + 0.131 * math.exp(0.06 * inside)))
    found = mass_flow_half_angle(inside * DEG, wall_friction=wall * DEG) / DEG
    assert found == pytest.approx(other, abs=2.0)


def test_walls_too_rough_for_mass_flow_at_any_slope():
    assert mass_flow_half_angle(70.0 * DEG, wall_friction=55.0 * DEG) == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(ConveyorError):
        mass_flow_half_angle(50.0 * DEG, wall_friction=50.0 * DEG)
