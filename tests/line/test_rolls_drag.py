"""Drag of the rolls by load, speed and temperature; their bearings' life; what the tables and remarks say of it."""

from __future__ import annotations

import math
from dataclasses import astuple
from pathlib import Path

import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.laws.resistance import bearing_roll_drag, oil_viscosity
from conveyor.laws.roll_life import heavier_bearing_load
from conveyor.line.roll_lives import roll_life, set_life
from conveyor.line.stretches import roll_at, stretches
from conveyor.units import quantity, si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16
MAKER = {"law": "maker", "drag": "2 N", "load_slope": 0.001, "rotation_slope": "0.001 N/rpm"}
BEARING = {
    "law": "bearing",
    "mean_diameter": "51 mm",
    "static_rating": "16 kN",
    "first_viscosity": "100 mm^2/s",
    "second_viscosity": "11 mm^2/s",
    "seal_moment": "0.01 N*m",
}
LIFE = {"dynamic_rating": "19.5 kN", "distance": "440 mm"}


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "overland.yaml")


def carry_roll(line, **changes):
    carry = line.idlers.carry
    return line.replace(idlers=line.idlers.replace(carry=carry.replace(roll=carry.roll.replace(**changes))))


def carry_stretches(line):
    return [s for s in stretches(line) if s.strand == "carry"]


def test_one_figure_is_the_drag_of_every_roll(line):
    for stretch in carry_stretches(carry_roll(line, drag="1.9 N")):
        assert stretch.drags == (1.9, 1.9, 1.9)


def test_a_flat_line_is_one_figure(line):
    one = conveyor.analyse(carry_roll(line, drag="2 N")).balance
    flat = conveyor.analyse(carry_roll(line, drag_law={"law": "maker", "drag": "2 N"})).balance
    assert astuple(flat.forces) == pytest.approx(astuple(one.forces), rel=ROUNDING)


def test_the_makers_line_takes_each_rolls_own_load_and_the_belts_speed(line):
    # n = v/(π D) = 5/(π 0.159) 1/s
    rpm = 60.0 * 5.0 / (math.pi * 0.159)
    for stretch in carry_stretches(carry_roll(line, drag_law=MAKER)):
        for load, drag in zip(stretch.loads, stretch.drags, strict=True):
            expected = 2.0 + 0.001 * (load.force - 250.0) + 0.001 * (rpm - 650.0)
            assert drag == pytest.approx(expected, rel=1e-12)
    wing, middle, _ = stretch.drags
    assert middle > wing


def test_rotation_is_the_sum_of_all_rolls_and_splits_with_the_section(line):
    made = carry_roll(line, drag_law=MAKER)
    found = conveyor.analyse(made)
    for r in found.stretches:
        assert r.rotation == pytest.approx(r.stretch.sets * math.fsum(r.stretch.drags), rel=1e-12)
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = conveyor.analyse(made.replace(route=made.route.replace(sections=sections)))
    before, after = found.balance.forces.idler_rotation, split.balance.forces.idler_rotation
    assert after == pytest.approx(before, rel=1e-11)


def test_the_bearing_law_takes_load_speed_and_the_airs_temperature(line):
    cold = line.replace(ambient=line.ambient.replace(temperature="5 degC", belt_temperature="20 degC"))
    for made, kelvin in ((line, 293.15), (cold, 278.15)):
        stretch = carry_stretches(carry_roll(made, drag_law=BEARING))[0]
        oil = oil_viscosity(
            kelvin,
            first_temperature=313.15,
            first_viscosity=100e-6,
            second_temperature=373.15,
            second_viscosity=11e-6,
        )
        for load, drag in zip(stretch.loads, stretch.drags, strict=True):
            expected = bearing_roll_drag(
                load.force,
                belt_speed=5.0,
                roll_diameter=0.159,
                mean_diameter=0.051,
                viscosity=oil,
                static_rating=16e3,
                f0=2.0,
                f1_factor=0.0009,
                f1_exponent=0.55,
                seal_moment=0.01,
            ).force
            assert drag == pytest.approx(expected, rel=1e-12)
    warmed = carry_stretches(carry_roll(cold, drag_law=BEARING | {"warming": "15 K"}))[0]
    same = carry_stretches(carry_roll(line, drag_law=BEARING))[0]
    assert warmed.drags == pytest.approx(same.drags, rel=1e-9)


def test_middle_and_wings_have_their_own_laws(line):
    carry = line.idlers.carry
    mixed = carry.replace(
        roll=carry.roll.replace(drag="1 N"),
        middle_roll=carry.roll.replace(drag_law={"law": "maker", "drag": "3 N"}),
    )
    stretch = carry_stretches(line.replace(idlers=line.idlers.replace(carry=mixed)))[0]
    assert stretch.drags == (1.0, 3.0, 1.0)
    assert roll_at(mixed, 1).drag_law.law == "maker"


def test_the_third_of_five_rolls_is_the_middle_one(line):
    carry = line.idlers.carry
    short = carry.roll.replace(length="300 mm", drag="1 N")
    five = carry.replace(
        rolls=5, roll=short, middle_roll=short.replace(drag="3 N"), load_shares=[0.1, 0.2, 0.4, 0.2, 0.1]
    )
    stretch = carry_stretches(line.replace(idlers=line.idlers.replace(carry=five)))[0]
    assert stretch.drags == pytest.approx((1.0, 1.0, 3.0, 1.0, 1.0), rel=1e-15)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"drag": "2 N", "drag_law": MAKER}, r"drag_law: given beside drag 2 N; give one of the two"),
        (
            {"drag_law": BEARING | {"second_viscosity": "120 mm^2/s"}},
            r"second_viscosity: got 120 mm\^2/s at 100 degC and 100 mm\^2/s at 40 degC; the hotter oil is the thinner",
        ),
        (
            {"drag_law": BEARING | {"second_temperature": "40 degC"}},
            r"second_temperature: got 40 degC, that of the first viscosity; two are needed",
        ),
        (
            {"drag_law": BEARING | {"mean_diameter": "200 mm"}},
            r"mean_diameter: got 200 mm, but the roll's diameter is 159 mm; the bearings sit inside",
        ),
        ({"drag_law": MAKER | {"load": "250"}}, r'load: got "250" without a unit'),
        ({"drag_law": MAKER | {"rotation": "10 Hz"}}, r"rotation: .*expected a rotational speed"),
    ],
)
def test_contradictions_are_refused(line, changes, message):
    with pytest.raises(InputError, match=message):
        carry_roll(line, **changes)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (
            MAKER | {"load": "2500 N", "load_slope": 0.01},
            r"idlers\.carry\.roll\.drag_law: reference_drag = 2\.0 .* its line gives -",
        ),
        (
            BEARING | {"first_viscosity": "5000 mm^2/s", "second_viscosity": "5 mm^2/s"},
            r"idlers\.carry\.roll\.drag_law: temperature = .* the oil is solid there",
        ),
    ],
)
def test_a_law_that_fails_names_its_field(line, law, message):
    frost = line.replace(ambient=line.ambient.replace(temperature="-30 degC", belt_temperature="20 degC"))
    with pytest.raises(InputError, match=message):
        stretches(carry_roll(frost, drag_law=law))


def test_remarks_follow_the_law(line):
    plain = conveyor.analyse(line)
    assert "Roll drag does not depend on speed, load or temperature." in plain.assumptions
    assert any("idlers.carry: roll drag not given, 2.45 N" in w for w in plain.warnings)
    cold = line.replace(ambient=line.ambient.replace(temperature="-10 degC", belt_temperature="20 degC"))
    told = conveyor.analyse(carry_roll(cold, drag_law=BEARING))
    assert any(
        "Roll drag: carry over load, speed and air temperature by Palmgren" in a for a in told.assumptions
    )
    assert any("f0, f1_factor, f1_exponent not given" in w for w in told.warnings)
    assert any("mm²/s at -10 degC: bearings warm themselves" in w for w in told.warnings)
    assert not any("idlers.carry: roll drag not given" in w for w in told.warnings)


def test_bearing_loads_by_moments():
    # shell 0.5 m, bearings 0.4 m apart, 0.05 m from its ends
    sides = {"loaded_length": 0.5, "bearing_distance": 0.4, "inset": 0.05}
    even = heavier_bearing_load(60.0, belt_force=40.0, triangular=False, **sides)
    assert even == pytest.approx(50.0, rel=1e-14)
    # triangle: centre 0.5/3 m from the end, 0.11667 m from the inner bearing
    wing = heavier_bearing_load(60.0, belt_force=0.0, triangular=True, **sides)
    assert wing == pytest.approx(60.0 * (1.0 - (0.5 / 3.0 - 0.05) / 0.4), rel=1e-14)
    with pytest.raises(InputError, match=r"inset = -0\.3 is not allowed: above -bearing_distance/2"):
        heavier_bearing_load(1.0, belt_force=0.0, triangular=True, **sides | {"inset": -0.3})


def test_life_falls_with_the_cube_of_the_load_and_adds_up(line):
    made = carry_roll(line, bearing=LIFE)
    stretch = carry_stretches(made)[0]
    lives = [roll_life(stretch, place, 5.0) for place in range(3)]
    for life, load in zip(lives, stretch.loads, strict=True):
        assert life.heavier + life.lighter == pytest.approx(load.force, rel=1e-12)
    middle, wing = lives[1], lives[0]
    assert middle.heavier == pytest.approx(middle.lighter, rel=1e-12)
    assert wing.heavier > wing.lighter
    assert middle.hours / wing.hours == pytest.approx((wing.heavier / middle.heavier) ** 3, rel=1e-12)
    # L10h = (C/P)³ 1e6/(3600 n)
    by_hand = (19.5e3 / middle.heavier) ** 3 * 1e6 / (3600.0 * 5.0 / (math.pi * 0.159))
    assert middle.hours == pytest.approx(by_hand, rel=1e-12)
    # two equal bearings: 2^(-9/10) of one's life (Weibull slope 10/9)
    assert middle.both == pytest.approx(middle.hours * 2.0**-0.9, rel=1e-12)
    assert set_life(stretch, 5.0) < min(life.both for life in lives)
    assert set_life(carry_stretches(line)[0], 5.0) is None


def test_roller_bearings_and_single_rolls(line):
    made = carry_roll(line, bearing=LIFE | {"kind": "roller"})
    stretch = carry_stretches(made)[0]
    ball = roll_life(carry_stretches(carry_roll(line, bearing=LIFE))[0], 1, 5.0)
    roller = roll_life(stretch, 1, 5.0)
    assert roller.hours / ball.hours == pytest.approx((19.5e3 / ball.heavier) ** (1.0 / 3.0), rel=1e-12)
    flat = line.idlers.return_.replace(
        rolls=1,
        trough_angle="0 deg",
        roll=line.idlers.return_.roll.replace(length="1400 mm", bearing=LIFE | {"distance": "1360 mm"}),
    )
    alone = line.replace(idlers=line.idlers.replace(**{"return": flat}))
    life = roll_life(stretches(alone)[-1], 0, 5.0)
    assert life.heavier == pytest.approx(life.lighter, rel=1e-14)


def test_tables_show_drag_and_life_where_bearings_are_given(line):
    plain = conveyor.analyse(line)
    assert list(plain.rolls.columns[-2:]) == ["rim drag [N]", "rotation [rpm]"]
    assert "idler set L10 life [h]" not in plain.sections
    found = conveyor.analyse(carry_roll(line, bearing=LIFE, drag_law=MAKER))
    carry = found.rolls[found.rolls["strand"] == "carry"]
    assert list(carry["rim drag [N]"][:3]) == list(found.stretches[0].stretch.drags)
    assert carry["rotation [rpm]"].to_numpy() == pytest.approx(60.0 * 5.0 / (math.pi * 0.159), rel=1e-12)
    assert carry["roll L10 life [h]"].notna().all()
    assert found.sections["idler set L10 life [h]"].notna().sum() == len(line.route.sections)


def test_a_short_life_is_warned_of(line):
    weak = conveyor.analyse(carry_roll(line, bearing=LIFE | {"dynamic_rating": "6 kN"}))
    assert any(
        "carry rolls: L10 of the middle in " in w and "less than the 30,000 h" in w for w in weak.warnings
    )
    strong = conveyor.analyse(carry_roll(line, bearing=LIFE))
    assert not any("L10" in w for w in strong.warnings)


def test_units_of_the_law_change_nothing(line):
    given = carry_stretches(carry_roll(line, drag_law=MAKER | {"load": "250 N"}))[0]
    other = carry_stretches(carry_roll(line, drag_law=MAKER | {"load": "0.25 kN", "drag": "0.002 kN"}))[0]
    assert other.drags == pytest.approx(given.drags, rel=1e-12)
    assert si(quantity("650 rpm")) == pytest.approx(650.0 / 60.0, rel=1e-15)
