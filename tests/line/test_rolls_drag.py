"""Drag of the rolls by load, speed and temperature; their bearings' life; what the tables and remarks say of it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from conveyor.checks import run_checks
from conveyor.errors import InputError
from conveyor.laws.resistance import bearing_roll_drag, oil_viscosity, service_roll_drag
from conveyor.laws.roll_life import heavier_bearing_load
from conveyor.line.line import Line
from conveyor.line.roll_drags import roll_drags, roll_drags_many
from conveyor.line.roll_lives import idler_set_life, roll_life
from conveyor.pipeline import calculate
from conveyor.remarks.assumptions import analysis_assumptions
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.units import quantity, si

ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
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
    return load(SPECS / "overland.yaml")


def carry_roll(line, **changes):
    carry = line.idlers.carry
    return line.replace(idlers=line.idlers.replace(carry=carry.replace(roll=carry.roll.replace(**changes))))


def carry_stretches(line):
    return [s for s in Line.of(line).stretches if s.strand == "carry"]


def carry_drags(line):
    """Drags of the rolls of a set on every carry stretch, beside the stretch."""
    made = Line.of(line)
    return [(s, drags) for s, drags in zip(made.stretches, made.roll_drags, strict=True) if s.strand == "carry"]


def told(found):
    return [warning.text() for warning in analysis_warnings(found, run_checks(found))]


def test_one_figure_is_the_drag_of_every_roll(line):
    assert all(drags == (1.9, 1.9, 1.9) for _, drags in carry_drags(carry_roll(line, drag="1.9 N")))


def test_without_drag_a_roll_is_in_service_or_at_its_limit(line):
    for stretch, drags in carry_drags(line):
        for borne, drag in zip(stretch.loads, drags, strict=True):
            expected = service_roll_drag(
                borne.force, belt_speed=5.0, roll_diameter=0.159, roll_length=0.465, air_temperature=293.15
            ).force
            assert drag == pytest.approx(expected, rel=1e-12)
    limit = line.replace(calculation=line.calculation.replace(roll_drag="acceptance limit"))
    assert all(drags == (2.45, 2.45, 2.45) for _, drags in carry_drags(limit))
    # the air counts, the covers do not; and the variants of a study know it
    frost = line.replace(ambient=line.ambient.replace(temperature="-10 degC", belt_temperature="20 degC"))
    cold, warm = (calculate(each).balance.forces for each in (frost, line))
    assert cold.parts["idler_rotation"] > 1.5 * warm.parts["idler_rotation"]
    assert cold.indentation == pytest.approx(warm.indentation, rel=1e-12)


def test_a_roll_too_small_for_a_usual_bearing_needs_its_drag(line):
    with pytest.raises(InputError, match=r"idlers\.carry\.roll: drag not given: roll_diameter: got 0\.03"):
        Line.of(carry_roll(line, diameter="30 mm"))


def test_rolls_of_many_lines_drag_as_each_by_itself(line):
    def in_air(given, air):
        made = given.replace(ambient=given.ambient.replace(temperature=air, belt_temperature="20 degC"))
        return [(made, strand) for strand in Line.of(given).strands.each]

    faster = line.replace(belt=line.belt.replace(speed="6 m/s"))
    small = carry_roll(line, drag_law=MAKER)
    asked = [*in_air(line, "-20 degC"), *in_air(faster, "20 degC"), *in_air(small, "0 degC")]
    for pair, drags in zip(asked, roll_drags_many(asked), strict=True):
        for one, alone in zip(drags, roll_drags(*pair), strict=True):
            assert one == pytest.approx(alone, rel=ROUNDING)
    # grease that is solid in one line's air leaves the others theirs
    cold, warm = roll_drags_many([in_air(line, "-90 degC")[0], asked[2]])
    assert isinstance(cold, InputError)
    assert str(cold).startswith("idlers.carry.roll: drag not given: temperature: got 183.1")
    assert warm[0] == pytest.approx(roll_drags(*asked[2])[0], rel=ROUNDING)


def test_a_flat_line_is_one_figure(line):
    one = calculate(carry_roll(line, drag="2 N")).balance
    flat = calculate(carry_roll(line, drag_law={"law": "maker", "drag": "2 N"})).balance
    assert flat.forces.parts == pytest.approx(one.forces.parts, rel=ROUNDING)


def test_the_makers_line_takes_each_rolls_own_load_and_the_belts_speed(line):
    # n = v/(π D) = 5/(π 0.159) 1/s
    rpm = 60.0 * 5.0 / (math.pi * 0.159)
    for stretch, drags in carry_drags(carry_roll(line, drag_law=MAKER)):
        for borne, drag in zip(stretch.loads, drags, strict=True):
            expected = 2.0 + 0.001 * (borne.force - 250.0) + 0.001 * (rpm - 650.0)
            assert drag == pytest.approx(expected, rel=1e-12)
    wing, middle, _ = drags
    assert middle > wing


def test_rotation_is_the_sum_of_all_rolls_and_splits_with_the_section(line):
    made = carry_roll(line, drag_law=MAKER)
    found = calculate(made)
    (rotation,) = (force.along for force in found.balance.along if force.key == "idler_rotation")
    for force, stretch, drags in zip(rotation, found.line.stretches, found.line.roll_drags, strict=True):
        assert force == pytest.approx(stretch.sets * math.fsum(drags), rel=1e-12)
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = calculate(made.replace(route=made.route.replace(sections=sections)))
    before, after = (each.balance.forces.parts["idler_rotation"] for each in (found, split))
    assert after == pytest.approx(before, rel=1e-11)


def test_the_bearing_law_takes_load_speed_and_the_airs_temperature(line):
    cold = line.replace(ambient=line.ambient.replace(temperature="5 degC", belt_temperature="20 degC"))
    for made, kelvin in ((line, 293.15), (cold, 278.15)):
        stretch, drags = carry_drags(carry_roll(made, drag_law=BEARING))[0]
        oil = oil_viscosity(
            kelvin,
            first_temperature=313.15,
            first_viscosity=100e-6,
            second_temperature=373.15,
            second_viscosity=11e-6,
        )
        for borne, drag in zip(stretch.loads, drags, strict=True):
            expected = bearing_roll_drag(
                borne.force,
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
    _, warmed = carry_drags(carry_roll(cold, drag_law=BEARING | {"warming": "15 K"}))[0]
    _, same = carry_drags(carry_roll(line, drag_law=BEARING))[0]
    assert warmed == pytest.approx(same, rel=1e-9)


def test_middle_and_wings_have_their_own_laws(line):
    carry = line.idlers.carry
    mixed = carry.replace(
        roll=carry.roll.replace(drag="1 N"),
        middle_roll=carry.roll.replace(drag_law={"law": "maker", "drag": "3 N"}),
    )
    _, drags = carry_drags(line.replace(idlers=line.idlers.replace(carry=mixed)))[0]
    assert drags == (1.0, 3.0, 1.0)
    assert mixed.roll_at(1).drag_law.law == "maker"


def test_the_third_of_five_rolls_is_the_middle_one(line):
    carry = line.idlers.carry
    short = carry.roll.replace(length="300 mm", drag="1 N")
    five = carry.replace(
        rolls=5,
        inner_trough_angle="20 deg",
        roll=short,
        middle_roll=short.replace(drag="3 N"),
        load_shares=[0.1, 0.2, 0.4, 0.2, 0.1],
    )
    _, drags = carry_drags(line.replace(idlers=line.idlers.replace(carry=five)))[0]
    assert drags == pytest.approx((1.0, 1.0, 3.0, 1.0, 1.0), rel=1e-15)


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
            r"idlers\.carry\.roll\.drag_law: reference_drag: got 2\.0, its line gives -",
        ),
        (
            BEARING | {"first_viscosity": "5000 mm^2/s", "second_viscosity": "5 mm^2/s"},
            r"idlers\.carry\.roll\.drag_law: temperature: got .* the oil is solid there",
        ),
    ],
)
def test_a_law_that_fails_names_its_field(line, law, message):
    frost = line.replace(ambient=line.ambient.replace(temperature="-30 degC", belt_temperature="20 degC"))
    with pytest.raises(InputError, match=message):
        Line.of(carry_roll(frost, drag_law=law))


def test_remarks_follow_the_law(line):
    limit = line.replace(calculation=line.calculation.replace(roll_drag="acceptance limit"))
    assert "Roll drag does not depend on speed, load or temperature." in analysis_assumptions(limit)
    assert any("usual bearings at their own temperature" in a for a in analysis_assumptions(line))
    assert any("idlers.carry: roll drag not given, 2.45 N" in w for w in told(calculate(limit)))
    assert any("a roll assumed (bearings 6305, usual grease and seals" in w for w in told(calculate(line)))
    cold = line.replace(ambient=line.ambient.replace(temperature="-10 degC", belt_temperature="20 degC"))
    made = carry_roll(cold, drag_law=BEARING)
    said = told(calculate(made))
    assert any(
        "Roll drag: carry over load, speed and air temperature by Palmgren" in a for a in analysis_assumptions(made)
    )
    assert any("f0, f1_factor, f1_exponent not given" in w for w in said)
    assert any("mm²/s at -10 °C: bearings warm themselves" in w for w in said)
    assert not any("idlers.carry: roll drag not given" in w for w in said)


def test_bearing_loads_by_moments():
    # shell 0.5 m, bearings 0.4 m apart, 0.05 m from its ends
    sides = {"loaded_length": 0.5, "bearing_distance": 0.4, "inset": 0.05}
    even = heavier_bearing_load(60.0, belt_force=40.0, triangular=False, **sides)
    assert even == pytest.approx(50.0, rel=1e-14)
    # triangle: centre 0.5/3 m from the end, 0.11667 m from the inner bearing
    wing = heavier_bearing_load(60.0, belt_force=0.0, triangular=True, **sides)
    assert wing == pytest.approx(60.0 * (1.0 - (0.5 / 3.0 - 0.05) / 0.4), rel=1e-14)
    with pytest.raises(InputError, match=r"inset: got -0\.3, allowed: > -bearing_distance/2"):
        heavier_bearing_load(1.0, belt_force=0.0, triangular=True, **sides | {"inset": -0.3})


def test_life_falls_with_the_cube_of_the_load_and_adds_up(line):
    made = carry_roll(line, bearing=LIFE)
    stretch = carry_stretches(made)[0]
    lives = [roll_life(stretch, place, 5.0) for place in range(3)]
    for life, borne in zip(lives, stretch.loads, strict=True):
        assert life.heavier + life.lighter == pytest.approx(borne.force, rel=1e-12)
    middle, wing = lives[1], lives[0]
    assert middle.heavier == pytest.approx(middle.lighter, rel=1e-12)
    assert wing.heavier > wing.lighter
    assert middle.hours / wing.hours == pytest.approx((wing.heavier / middle.heavier) ** 3, rel=1e-12)
    # L10h = (C/P)³ 1e6/(3600 n)
    by_hand = (19.5e3 / middle.heavier) ** 3 * 1e6 / (3600.0 * 5.0 / (math.pi * 0.159))
    assert middle.hours == pytest.approx(by_hand, rel=1e-12)
    # two equal bearings: 2^(-9/10) of one's life (Weibull slope 10/9)
    assert middle.both == pytest.approx(middle.hours * 2.0**-0.9, rel=1e-12)
    together = idler_set_life(stretch, 5.0)
    assert together.whole
    assert together.hours < min(life.both for life in lives) == together.weakest_hours
    assert idler_set_life(carry_stretches(line)[0], 5.0) is None


def test_roller_bearings_and_single_rolls(line):
    made = carry_roll(line, bearing=LIFE | {"kind": "roller"})
    stretch = carry_stretches(made)[0]
    ball = roll_life(carry_stretches(carry_roll(line, bearing=LIFE))[0], 1, 5.0)
    roller = roll_life(stretch, 1, 5.0)
    assert roller.hours / ball.hours == pytest.approx((19.5e3 / ball.heavier) ** (1.0 / 3.0), rel=1e-12)
    # two equal bearings: 2^(-8/9) of one's life (Weibull slope 9/8)
    assert roller.both == pytest.approx(roller.hours * 2.0 ** (-8.0 / 9.0), rel=1e-12)
    flat = line.idlers.return_.replace(
        rolls=1,
        trough_angle="0 deg",
        roll=line.idlers.return_.roll.replace(length="1400 mm", bearing=LIFE | {"distance": "1360 mm"}),
    )
    alone = line.replace(idlers=line.idlers.replace(**{"return": flat}))
    life = roll_life(Line.of(alone).stretches[-1], 0, 5.0)
    assert life.heavier == pytest.approx(life.lighter, rel=1e-14)


def test_a_short_life_is_warned_of(line):
    weak = calculate(carry_roll(line, bearing=LIFE | {"dynamic_rating": "6 kN"}))
    assert any("carry rolls: L10 of all bearings of a set in " in w and "of the middle alone" in w for w in told(weak))
    strong = calculate(carry_roll(line, bearing=LIFE))
    assert not any("L10" in w for w in told(strong))


def test_units_of_the_law_change_nothing(line):
    _, given = carry_drags(carry_roll(line, drag_law=MAKER | {"load": "250 N"}))[0]
    _, other = carry_drags(carry_roll(line, drag_law=MAKER | {"load": "0.25 kN", "drag": "0.002 kN"}))[0]
    assert other == pytest.approx(given, rel=1e-12)
    assert si(quantity("650 rpm")) == pytest.approx(650.0 / 60.0, rel=1e-15)
