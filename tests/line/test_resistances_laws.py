"""Flexure by laws, ploughs, the classic form of CEMA: from the spec to the tables."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from conveyor.checks import run_checks
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.resistance import belt_flexure_resistance, bulk_flexure_bound, secondary_resistance
from conveyor.line.set_loads import SetLoads
from conveyor.pipeline import calculate
from conveyor.remarks.assumptions import analysis_assumptions
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.units import si

ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
BELT = {"loss_tangent": 0.1, "bending_stiffness": "30 N*m^2"}
BULK = {"opening_angle": "0.5 deg", "friction_angle": "37 deg"}
CEMA = {"flexure_factor": 0.02, "idler_friction": "1.5 lbf"}
LBF, FT, LB = 4.4482216152605, 0.3048, 0.45359237  # exact


@pytest.fixture(scope="module")
def line():
    return load(SPECS / "overland.yaml")


@pytest.fixture(scope="module")
def result(line):
    return calculate(line)


def with_flexure(line, **flexure):
    return line.replace(calculation=line.calculation.replace(flexure=flexure))


def along(found, key):
    """A force along the belt on every stretch [N]."""
    (force,) = (force for force in found.balance.along if force.key == key)
    return force.along


def told(found):
    return [warning.text() for warning in analysis_warnings(found, run_checks(found))]


def by_hand(stretch, tension):
    effective = tension - stretch.line_mass * 5.0**2
    load = stretch.line_mass * 9.81 * math.cos(stretch.inclination)
    return stretch.sets * belt_flexure_resistance(
        load, tension=effective, spacing=stretch.spacing, bending_stiffness=30.0, loss_tangent=0.1
    )


def by_sag(found):
    """Flexure of every stretch [N]: c of one site, 11 % of 61.7 N a set under 4302 N at 0.4 % sag; Simpson over T."""
    c, count, steady = 0.11 * 61.7 / (4302.0 * 0.004), found.line.count, found.balance.equilibrium.steady
    starts, ends = np.roll(steady.starts, count), np.roll(steady.ends, count)
    places, weights = np.linspace(0.0, 1.0, 2001), np.ones(2001)
    weights[1:-1:2], weights[2:-1:2] = 4.0, 2.0
    forces = []
    for s, start, end in zip(found.line.stretches, starts, ends, strict=True):
        load, most = s.line_mass * 9.81, {"carry": 0.01, "return": 0.02}[s.strand]
        pull = start + (end - start) * places - s.line_mass * 5.0**2
        sag = np.minimum(load * s.spacing / (8.0 * np.maximum(pull, 1.0)), most)
        forces.append(c * load * math.cos(s.inclination) * s.length * (weights @ sag) / 6000.0)
    return np.array(forces)


def test_load_and_sag_are_the_default(result):
    assert along(result, "flexure") == pytest.approx(by_sag(result), rel=1e-9)
    assert any("load x sag x 0.394 (0.158 to 0.789) assumed" in w for w in told(result))
    assert any("(carry 1 %, return 2 %)" in a for a in analysis_assumptions(result.conveyor))
    whole = math.fsum(force.total for force in result.balance.every)
    assert result.balance.equilibrium.force == pytest.approx(whole, rel=1e-12)


def test_wider_spacing_flexes_more_and_a_tighter_belt_less(line, result):
    carry = line.idlers.carry
    wide = calculate(line.replace(idlers=line.idlers.replace(carry=carry.replace(spacing="4 m"))))
    assert along(wide, "flexure") == pytest.approx(by_sag(wide), rel=1e-9)
    assert wide.balance.forces.parts["flexure"] > 1.5 * result.balance.forces.parts["flexure"]
    taut = result.balance.held(3.0 * result.balance.equilibrium.setting)
    assert taut.forces.parts["flexure"] < 0.6 * result.balance.forces.parts["flexure"]
    again = taut.held(result.balance.equilibrium.setting)
    assert again.forces.total == pytest.approx(result.balance.forces.total, rel=1e-12)


def test_a_slack_belt_flexes_at_most_at_the_largest_sag(line):
    loose = calculate(line.replace(route=line.route.replace(take_up={"kind": "gravity", "tension": "1 N"})))
    most = next(force.at_sag_limit for force in loose.balance.along if force.key == "flexure")
    assert np.all(along(loose, "flexure") <= most * (1.0 + 1e-12))
    assert along(loose, "flexure") == pytest.approx(by_sag(loose), rel=1e-6)  # Simpson across the kink


def test_the_length_coefficient_follows_the_flexure():
    line = load(SPECS / "in_plant_us.yaml")
    made = calculate(line.replace(calculation=line.calculation.replace(secondary="C")))
    main, by_length = made.balance.forces.main, made.balance.forces.secondary
    assert by_length == pytest.approx(secondary_resistance(main, length=made.line.length), rel=1e-12)
    assert made.balance.equilibrium.force == pytest.approx(made.balance.forces.total, rel=1e-12)
    again = made.balance.held(2.0 * made.balance.equilibrium.setting)
    assert again.forces.secondary < by_length
    assert again.equilibrium.force == pytest.approx(again.forces.total, rel=1e-12)


def test_the_default_follows_neither_rubber_nor_drag(result):
    """Cold rubber, heavier rolls: flexure at the largest sag stays as it is."""
    line = result.conveyor
    roll = line.idlers.carry.roll.replace(drag="6 N")
    changed = line.replace(
        ambient=line.ambient.replace(temperature="5 degC"),
        idlers=line.idlers.replace(carry=line.idlers.carry.replace(roll=roll)),
    )
    other = calculate(changed)
    assert other.balance.forces.indentation != pytest.approx(result.balance.forces.indentation, rel=0.01)
    at_limit = [next(f.at_sag_limit for f in one.balance.along if f.key == "flexure") for one in (other, result)]
    assert at_limit[0] == pytest.approx(at_limit[1], rel=1e-14)


def test_an_empty_belt_flexes_under_its_own_weight(line):
    empty = calculate(line.replace(material=line.material.replace(flow="0 t/h")))
    assert all(stretch.bulk_mass == 0.0 for stretch in empty.line.stretches)
    assert along(empty, "flexure") == pytest.approx(by_sag(empty), rel=1e-9)


def test_a_share_is_one_on_request(line):
    made = line.replace(calculation=line.calculation.replace(flexure_share="11 %"))
    found = calculate(made)
    assert all(stretch.span_flexure is None for stretch in found.line.stretches)
    others = along(found, "indentation") + along(found, "idler_rotation")
    assert along(found, "flexure") == pytest.approx(0.11 / 0.89 * others, rel=1e-12)
    assert not any("calculation.flexure not given" in w for w in told(found))
    assert any("Flexure of belt and bulk is 11 % of the main resistance" in a for a in analysis_assumptions(made))


def test_flexure_of_the_belt_at_the_least_tension(line):
    found = calculate(with_flexure(line, belt=BELT))
    expected = [by_hand(stretch, stretch.least_tension) for stretch in found.line.stretches]
    assert along(found, "flexure") == pytest.approx(np.array(expected), rel=1e-12)
    (flexure,) = (force for force in found.balance.every if force.name == "flexure of belt and bulk")
    assert flexure.source == "calculation.flexure, laws"
    whole = math.fsum(force.total for force in found.balance.every)
    assert whole == pytest.approx(found.balance.forces.total, rel=1e-12)


def test_more_tension_less_flexure(line):
    least = calculate(with_flexure(line, belt=BELT)).balance.forces.parts["flexure"]
    taut = calculate(with_flexure(line, belt=BELT | {"tension": "150 kN"}))
    assert taut.balance.forces.parts["flexure"] < least
    expected = [by_hand(stretch, 150e3) for stretch in taut.line.stretches]
    assert along(taut, "flexure") == pytest.approx(np.array(expected), rel=1e-12)


def test_flexure_of_the_bulk_adds_to_the_loaded_strand_only(line):
    belt = calculate(with_flexure(line, belt=BELT))
    both = calculate(with_flexure(line, belt=BELT, bulk=BULK))
    wing = SetLoads(line, line.idlers.carry).wing_contact(si(line.material.flow) / 5.0)
    assert 0.0 < wing < (1.03 - 0.465) / 2.0  # less than the usable width of a 1.2 m belt leaves
    bound = bulk_flexure_bound(
        math.radians(0.5),
        bulk_density=850.0,
        friction_angle=math.radians(37.0),
        wing_contact=wing,
        trough_angle=math.radians(45.0),
        gravity=9.81,
    )
    added = [s.sets * bound if s.strand == "carry" else 0.0 for s in both.line.stretches]
    assert along(both, "flexure") == pytest.approx(along(belt, "flexure") + np.array(added), rel=1e-12)


# by sag the tension is taken linear along a section, though the flexure is not even there: second order, flexure of the
# section over tension (15 N/140 kN) times the section's change of tension over tension (4 %)
@pytest.mark.parametrize(("laws", "rtol"), [({"belt": BELT, "bulk": BULK}, 1e-11), (None, 5e-6)])
def test_splitting_a_section_changes_no_flexure(line, laws, rtol):
    made = line if laws is None else with_flexure(line, **laws)
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = made.replace(route=made.route.replace(sections=sections))
    before, after = (calculate(each).balance.forces.parts["flexure"] for each in (made, split))
    assert after == pytest.approx(before, rel=rtol)


def test_the_laws_say_how_far_to_trust_them(line):
    made = with_flexure(line, belt=BELT)
    assert any("at the least tension that the sag allows, on the safe side" in a for a in analysis_assumptions(made))
    said = told(calculate(made))
    assert "calculation.flexure.bulk not given: flexure of the bulk is not in the figures" in said
    assert not any("flexure_share" in w for w in said)
    bound = told(calculate(with_flexure(line, bulk=BULK)))
    assert any("an upper bound; its opening angle is the spec's" in w for w in bound)


def test_a_tension_below_the_belts_momentum_is_refused(line):
    slack = with_flexure(line, belt=BELT | {"tension": "3 kN"})
    with pytest.raises(NoSolutionError, match=r"m' v² is .* give a larger calculation\.flexure\.belt\.tension"):
        calculate(slack)


@pytest.mark.parametrize(
    ("calculation", "message"),
    [
        ({"flexure": {}}, r"flexure\.belt: missing: give belt, bulk or both"),
        ({"flexure": {"belt": BELT}, "flexure_share": "10 %"}, r"flexure: given beside flexure_share 10 %"),
        ({"flexure": {"belt": BELT | {"loss_tangent": 2}}}, r"loss_tangent: "),
    ],
)
def test_contradictions_are_refused(line, calculation, message):
    with pytest.raises(InputError, match=message):
        line.calculation.replace(**calculation)


def test_five_rolls_have_no_law_for_the_bulk(line):
    roll = line.idlers.carry.roll.replace(length="300 mm")
    five = line.idlers.carry.replace(rolls=5, inner_trough_angle="20 deg", roll=roll, share_rule="cross-section")
    made = line.replace(idlers=line.idlers.replace(carry=five))
    with pytest.raises(InputError, match=r"calculation\.flexure\.bulk: given, but the wings of 5 rolls"):
        with_flexure(made, bulk=BULK)


def test_ploughs_are_special_resistances_at_their_place(line, result):
    plough = {"count": 2, "width": "1 m", "position": "carry", "section": "plateau"}
    made = line.replace(route=line.route.replace(ploughs=[plough, {"width": "0.8 m", "scraping_factor": "2 kN/m"}]))
    found = calculate(made)
    singles = {single.name: single for single in found.balance.singles if single.name.startswith("plough")}
    assert {name: (single.total, single.place) for name, single in singles.items()} == {
        "plough 1 (x2)": (3000.0, "behind plateau, carry"),
        "plough 2 (x1)": (pytest.approx(1600.0, rel=1e-14), "head"),
    }
    added = found.balance.forces.special - result.balance.forces.special
    assert added == pytest.approx(4600.0, rel=1e-9)
    points = found.balance.tension_points
    assert points[-1].tension - points[0].tension == pytest.approx(found.balance.forces.total, rel=1e-9)
    assert any("route.ploughs: scraping factor 1500 N/m assumed" in w for w in told(found))
    empty = calculate(made.replace(material=made.material.replace(flow="0 t/h")))
    assert not any(single.name.startswith("plough") for single in empty.balance.singles)


@pytest.mark.parametrize(
    ("plough", "message"),
    [
        (
            {"width": "1 m", "position": "carry"},
            r'ploughs\[0\]\.section: missing: position "carry" stands behind',
        ),
        ({"width": "1 m", "section": "plateau"}, r'got "plateau" with position "head"; remove section'),
        (
            {"width": "1 m", "position": "carry", "section": "moon"},
            r'got "moon", which is none of the sections',
        ),
        ({"width": "1 m", "position": "return"}, r"position"),
    ],
)
def test_ploughs_out_of_place_are_refused(line, plough, message):
    with pytest.raises(InputError, match=message):
        line.route.replace(ploughs=[plough])


def test_ploughs_are_no_wider_than_the_belt(line):
    with pytest.raises(InputError, match=r"route\.ploughs\[0\]\.width: got 1\.3 m, wider than the belt"):
        line.replace(route=line.route.replace(ploughs=[{"width": "1.3 m"}]))


def test_cema_stands_beside_only_where_its_factors_are_given(line, result):
    assert result.balance.cema is None
    found = calculate(line.replace(calculation=line.calculation.replace(cema=CEMA)))
    assert found.balance.forces.parts == pytest.approx(result.balance.forces.parts, rel=ROUNDING)
    cema = found.balance.cema
    parts = cema.main + cema.secondary + cema.special + cema.lift
    assert cema.total == pytest.approx(parts, rel=1e-12)
    assert any("CEMA classic form: formulas and figures as commonly reproduced" in w for w in told(found))


def test_cema_by_hand_in_its_own_units(line):
    found = calculate(
        line.replace(calculation=line.calculation.replace(cema=CEMA | {"temperature_factor": 1.2}))
    ).balance
    belt = 27.0 * 1.2 / LB * FT  # lb/ft
    bulk = 2400.0 / 3.6 / 5.0 / LB * FT
    main = 0.0
    for section in line.route.sections:
        length = si(section.length) / FT
        spacing = 1.5 if section.carry_spacing is None else si(section.carry_spacing)
        kx = 0.00068 * (belt + bulk) + 1.5 / (spacing / FT)
        main += length * 1.2 * (kx + 0.02 * belt + 0.015 * belt) + bulk * length * 0.02
    assert found.cema.main / LBF == pytest.approx(main, rel=1e-12)
    assert found.cema.lift / LBF == pytest.approx(bulk * line.route.rise / FT, rel=1e-12)
    # take-up and tail on the slack side, 150 lbf each; the head is driven; Tam with g = 32.2 ft/s²
    tons, speeds = 2400.0 / 3.6 / (2000.0 * LB / 3600.0), (5.0 - 1.5) / (FT / 60.0)
    assert found.cema.secondary / LBF == pytest.approx(300.0 + 2.8755e-4 * tons * speeds, rel=1e-12)
    # seals at 6 lbf/ft of skirts in the zone of acceleration, μ1 0.5, and 6 m beyond, two cleaners of 1.1 m at
    # 5 lbf/in: its own, whatever this calculation has
    own = 6.0 * ((5.0**2 - 1.5**2) / 9.81 + 6.0) / FT + 5.0 * 2.0 * 1.1 / (FT / 12.0)
    assert found.cema.special / LBF == pytest.approx(own, rel=1e-12)
    assert found.layout.motor(found.cema.total) == pytest.approx(found.cema.total * 5.0 / 0.94, rel=1e-12)
    assert found.cema.friction_factor == pytest.approx(found.cema.main / found.unit_main, rel=1e-12)
    whole = calculate(line).balance
    assert found.unit_main == pytest.approx(whole.forces.main / whole.friction_factor, rel=1e-12)


def test_cema_is_the_same_for_a_split_section(line):
    made = line.replace(calculation=line.calculation.replace(cema=CEMA))
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = made.replace(route=made.route.replace(sections=sections))
    before, after = (calculate(each).balance.cema.total for each in (made, split))
    assert after == pytest.approx(before, rel=1e-12)


def test_pulleys_of_little_wrap_count_less(line):
    made = line.replace(calculation=line.calculation.replace(cema=CEMA))
    pulleys = [p.replace(wrap_angle="90 deg") if p.name == "tail" else p for p in line.route.pulleys]
    less = made.replace(route=made.route.replace(pulleys=pulleys))
    saved = calculate(made).balance.cema.secondary - calculate(less).balance.cema.secondary
    assert saved == pytest.approx(50.0 * LBF, rel=1e-9)
