"""Shares of the rolls in the bulk: by rule, by cross-section at the filling, as given; and along the roll."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.checks import run_checks
from conveyor.errors import InputError
from conveyor.laws.loading import (
    Wing,
    cross_section,
    filled_width,
    shares_by_area,
    spread_bulk,
    surcharge_from_slope,
)
from conveyor.line.line import Line
from conveyor.line.set_loads import SetLoads
from conveyor.line.stretches import masses_on_rolls
from conveyor.pipeline import calculate
from conveyor.remarks.assumptions import analysis_assumptions
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.units import quantity, si

ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
TROUGH = {"middle_roll_length": 0.465, "trough_angle": math.radians(35), "surcharge_angle": math.radians(20)}


@pytest.fixture(scope="module")
def line():
    return load(SPECS / "overland.yaml")


def with_carry(line, **changes):
    return line.replace(idlers=line.idlers.replace(carry=line.idlers.carry.replace(**changes)))


def loads_of(line, section=1):
    return Line.of(line).stretches[section].loads


def warned(line):
    found = calculate(line)
    return [warning.text() for warning in analysis_warnings(found, run_checks(found))]


def middle_share(loads):
    return loads[1].bulk_force / math.fsum(load.bulk_force for load in loads)


@pytest.mark.parametrize("width", [0.01, 0.3, 0.465, 0.47, 0.8, 1.03, 1.2])
def test_filled_width_is_the_inverse_of_the_cross_section(width):
    middle = min(width, TROUGH["middle_roll_length"])
    area = cross_section(width, **TROUGH | {"middle_roll_length": middle}).area
    assert filled_width(area, **TROUGH) == pytest.approx(width, rel=1e-13)


def test_filled_width_of_a_v_without_a_heap():
    # two triangles: A = (b/2)² cos λ sin λ
    width = filled_width(0.02, middle_roll_length=0.0, trough_angle=0.5, surcharge_angle=0.0)
    assert width == pytest.approx(2.0 * math.sqrt(0.02 / (math.cos(0.5) * math.sin(0.5))), rel=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"area": 0.0}, r"area: got 0\.0"),
        ({"middle_roll_length": -1.0}, r"middle_roll_length: got -1\.0"),
        ({"trough_angle": 2.0}, r"trough_angle: got 2\.0"),
        ({"trough_angle": 0.0, "surcharge_angle": 0.0}, r"a flat belt carries a heap only"),
    ],
)
def test_filled_width_refuses(change, message):
    given = TROUGH | {"area": 0.1} | change
    with pytest.raises(InputError, match=message):
        filled_width(given.pop("area"), **given)


SETS = {
    "flat": {"middle_roll_length": 1.2, "trough_angle": 0.0},
    "V": {"middle_roll_length": 0.0, "trough_angle": math.radians(20.0)},
    "three": {"middle_roll_length": 0.465, "trough_angle": math.radians(45.0)},
    "five": {
        "middle_roll_length": 0.28,
        "trough_angle": math.radians(60.0),
        "inner_wing": Wing(0.28, math.radians(30.0)),
    },
}


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("over", [0.5, 0.999, 1.001, 1.3])
def test_bulk_spreads_to_the_edges_and_then_heaps(name, over):
    """Its width and slope hold the very area; never wider than the belt, steeper only where it is as wide."""
    trough, surcharge = SETS[name], math.radians(15.0)
    area = over * cross_section(1.2, surcharge_angle=surcharge, **trough).area
    width, slope = spread_bulk(area, belt_width=1.2, surcharge_angle=surcharge, **trough)
    middle = min(width, trough["middle_roll_length"])
    held = cross_section(width, surcharge_angle=slope, **trough | {"middle_roll_length": middle}).area
    assert held == pytest.approx(area, rel=1e-12)
    assert (width < 1.2, slope == surcharge) == ((True, True) if over < 1.0 else (False, False))


def by_columns(area, belt_width):
    """Middle share of three rolls by columns of a millimetre: the bulk's height over the belt, summed up."""
    middle, angle = 0.465, math.radians(45.0)
    half = 0.5 * middle + 0.5 * (belt_width - middle) * math.cos(angle)
    edge = 0.5 * (belt_width - middle) * math.sin(angle)
    n = 20000
    x = (np.arange(n) + 0.5) * half / n
    belt = np.maximum(0.0, x - 0.5 * middle) * math.tan(angle)
    # parabola through the edge: what the trough does not hold has the heap (half² - x²)
    trough, heap = edge - belt, half**2 - x**2
    heap *= (0.5 * area - trough.sum() * half / n) / (heap.sum() * half / n)
    height = trough + heap
    return float(height[x < 0.5 * middle].sum() / height.sum())


@pytest.mark.parametrize("over", [1.0, 1.2, 1.5])
def test_the_share_of_an_overfull_belt_is_that_of_the_bulk_over_its_roll(line, over):
    """Bulk does not lie beyond the belt's edges: columns over the whole belt, whatever stands on them."""
    made = with_carry(line, share_rule="cross-section")
    belt_width = si(made.belt.width)
    flooded = made.flooded_section
    loads = SetLoads(made, made.idlers.carry)
    bulk = over * flooded * si(made.material.density)
    shares = [
        load.bulk_force
        for load in loads.of(spacing=1.2, inclination=0.0, belt_mass=20.0, bulk_mass=bulk, flow_mass=bulk)
    ]
    # columns at a bend: two of 20,000 are cut there
    assert shares[1] / sum(shares) == pytest.approx(by_columns(over * flooded, belt_width), rel=2e-4)
    assert shares[0] == pytest.approx(shares[2], rel=1e-15)


def test_vdi_2341_is_the_default(line):
    assert middle_share(loads_of(line)) == pytest.approx(0.5 + 0.005 * 45.0, rel=1e-12)


def test_each_wing_bears_half_of_what_lies_beside_the_middle_roll(line):
    loads = SetLoads(line, line.idlers.carry)
    # 2400 t/h at 5 m/s: 133.3 kg/m
    covered = loads.spread(400.0 / 3.0).width
    assert loads.wing_contact(400.0 / 3.0) == pytest.approx((covered - 0.465) / 2.0, rel=1e-12)
    # so little that it lies on the middle roll alone
    assert loads.wing_contact(1.0) == pytest.approx(0.0, abs=1e-15)
    # a flat belt has no wings
    carry = line.idlers.carry
    flat = carry.replace(rolls=1, trough_angle="0 deg", roll=carry.roll.replace(length="1400 mm"))
    assert SetLoads(line, flat).wing_contact(400.0 / 3.0) == 0.0


def test_what_a_valley_leaves_on_the_rolls_may_be_little():
    # 20 kg/m of belt, 80 kg/m of bulk, lifted like 99.5 kg/m
    assert masses_on_rolls(20.0, 80.0, -99.5, radius=300.0, where="dip") == pytest.approx((0.0, 0.5), rel=1e-12)


def test_by_cross_section_the_share_is_that_of_the_area_at_the_filling(line):
    made = with_carry(line, share_rule="cross-section")
    loads = loads_of(made)
    area = si(line.material.flow) / si(line.belt.speed) / si(line.material.density)
    trough = TROUGH | {"trough_angle": math.radians(45)}
    width = filled_width(area, **trough)
    assert middle_share(loads) == pytest.approx(shares_by_area(width, **trough)[0], rel=1e-12)
    assert loads[0].bulk_force == loads[2].bulk_force
    before = math.fsum(load.force for load in loads_of(line))
    assert math.fsum(load.force for load in loads) == pytest.approx(before, rel=1e-12)


def test_a_small_flow_lies_on_the_middle_roll_alone(line):
    little = line.replace(material=line.material.replace(flow="40 t/h"))
    loads = loads_of(with_carry(little, share_rule="cross-section"))
    assert middle_share(loads) == 1.0
    empty = line.replace(material=line.material.replace(flow="0 t/h"))
    assert all(load.bulk_force == 0.0 for load in loads_of(with_carry(empty, share_rule="cross-section")))


def test_the_share_falls_as_the_trough_fills(line):
    shares = []
    for flow in ("500 t/h", "1000 t/h", "1800 t/h", "2400 t/h"):
        made = line.replace(material=line.material.replace(flow=flow))
        shares.append(middle_share(loads_of(with_carry(made, share_rule="cross-section"))))
    assert shares == sorted(shares, reverse=True)
    assert shares[-1] < shares[0]


def test_the_conventions_of_the_heap_hold_the_same_bulk(line):
    slope = math.atan(2.0 / 3.0 * math.tan(math.radians(20.0)))
    din = line.material.replace(surcharge_convention="DIN 22101", surcharge_angle=f"{slope!r} rad")
    assert din.surcharge == pytest.approx(math.radians(20.0), rel=1e-14)
    assert surcharge_from_slope(slope) == pytest.approx(din.surcharge, rel=1e-14)
    other = line.replace(material=din)
    total = calculate(line).balance.forces.total
    assert calculate(other).balance.forces.total == pytest.approx(total, rel=ROUNDING)
    # by area the same width is covered; the triangle has more of its heap over the middle
    iso = SetLoads(with_carry(line, share_rule="cross-section"), line.idlers.carry)
    triangle = SetLoads(with_carry(other, share_rule="cross-section"), line.idlers.carry)
    assert triangle.spread(100.0).width == pytest.approx(iso.spread(100.0).width, rel=1e-13)
    by_din = middle_share(loads_of(with_carry(other, share_rule="cross-section")))
    by_iso = middle_share(loads_of(with_carry(line, share_rule="cross-section")))
    assert by_din > by_iso
    assert by_din == pytest.approx(by_iso, rel=0.05)  # they differ in the heap's top only


def test_as_din_slope_the_same_angle_holds_more(line):
    steep = line.material.replace(surcharge_convention="DIN 22101")
    more = with_carry(line.replace(material=steep), share_rule="cross-section")
    assert SetLoads(more, more.idlers.carry).spread(100.0) < SetLoads(line, line.idlers.carry).spread(100.0)


def test_an_even_load_on_the_wings_keeps_the_force_and_lowers_the_peak(line):
    even, falling = loads_of(with_carry(line, wing_load="uniform")), loads_of(line)
    for one, other in zip(even, falling, strict=True):
        assert one.force == other.force
    assert even[0].peak_line_load < falling[0].peak_line_load
    assert even[0].peak_line_load == pytest.approx(even[0].force / even[0].length, rel=1e-14)
    # indentation grows like w^(4/3): an even load loses less
    saved = calculate(with_carry(line, wing_load="uniform")).balance.forces.indentation
    assert saved < calculate(line).balance.forces.indentation


def test_an_offset_changes_no_load_and_says_so(line):
    made = with_carry(line, offset="150 mm")
    plain = calculate(line).balance.forces.parts
    assert calculate(made).balance.forces.parts == pytest.approx(plain, rel=ROUNDING)
    assert any("idlers.carry.offset: the loads of the rolls are those of a set in one plane" in w for w in warned(made))


def test_five_rolls_with_their_shares(line):
    shares = ["5 %", "15 %", "60 %", "15 %", "5 %"]
    roll = line.idlers.carry.roll.replace(length="300 mm")
    made = with_carry(line, rolls=5, inner_trough_angle="20 deg", roll=roll, load_shares=shares)
    loads = loads_of(made)
    total = math.fsum(load.bulk_force for load in loads)
    assert [load.bulk_force / total for load in loads] == pytest.approx([0.05, 0.15, 0.6, 0.15, 0.05], rel=1e-12)
    assert len(Line.of(made).roll_drags[1]) == 5


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"share_rule": "cross-section", "load_shares": ["20 %", "60 %", "20 %"]},
            r'share_rule: got "cross-section" beside load_shares; give one of the two',
        ),
        ({"offset": "1.6 m"}, r"offset: got 1\.6 m, but the sets are 1\.5 m apart"),
        (
            {
                "offset": "0.1 m",
                "rolls": 2,
                "roll": {"diameter": "159 mm", "length": "670 mm", "rotating_mass": "6 kg"},
            },
            r"offset: got 0\.1 m, but rolls: 2 has no middle ones; remove it",
        ),
    ],
)
def test_contradictions_are_refused(line, changes, message):
    with pytest.raises(InputError, match=message):
        with_carry(line, **changes)


def test_the_assumptions_name_the_rule(line):
    def told(made):
        return next(a for a in analysis_assumptions(made) if a.startswith("Load shares"))

    assert (
        told(line) == "Load shares of the rolls after VDI 2341; bulk uniform on inner rolls, triangular on outer ones."
    )
    by_area = with_carry(line, share_rule="cross-section")
    assert "area of bulk above each roll at the section's filling, the heap a parabola (ISO 5048)" in told(by_area)
    given = with_carry(line, load_shares=["20 %", "60 %", "20 %"])
    assert "after the spec (idlers.carry.load_shares)" in told(given)


def test_spacings_beyond_practice_are_warned_of(line):
    wide = with_carry(line, spacing=quantity("3.5 m"))
    told = warned(wide)
    assert any("idlers.carry: sets 3.5 m apart, the widest in use on overland conveyors are 3 m" in w for w in told)
