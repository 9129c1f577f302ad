"""Flexure by laws, ploughs, the classic form of CEMA: from the spec to the tables."""

from __future__ import annotations

import math
from dataclasses import astuple
from pathlib import Path

import pytest

import conveyor
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.resistance import belt_flexure_resistance, bulk_flexure_bound
from conveyor.line.set_loads import SetLoads
from conveyor.report import tables
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16
BELT = {"loss_tangent": 0.1, "bending_stiffness": "30 N*m^2"}
BULK = {"opening_angle": "0.5 deg", "friction_angle": "37 deg"}
CEMA = {"flexure_factor": 0.02, "idler_friction": "1.5 lbf"}
LBF, FT, LB = 4.4482216152605, 0.3048, 0.45359237  # exact


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "overland.yaml")


@pytest.fixture(scope="module")
def result(line):
    return conveyor.analyse(line)


def with_flexure(line, **flexure):
    return line.replace(calculation=line.calculation.replace(flexure=flexure))


def by_hand(stretch, tension):
    effective = tension - stretch.line_mass * 5.0**2
    load = stretch.line_mass * 9.81 * math.cos(stretch.inclination)
    return stretch.sets * belt_flexure_resistance(
        load, tension=effective, spacing=stretch.spacing, bending_stiffness=30.0, loss_tangent=0.1
    )


def test_the_share_is_the_default(result):
    for r in result.stretches:
        assert r.stretch.span_flexure is None
        assert r.flexure == pytest.approx(0.11 / 0.89 * (r.indentation + r.rotation), rel=1e-12)


def test_flexure_of_the_belt_at_the_least_tension(line):
    found = conveyor.analyse(with_flexure(line, belt=BELT))
    for r in found.stretches:
        assert r.flexure == pytest.approx(by_hand(r.stretch, r.stretch.least_tension), rel=1e-12)
    table = found.resistances.set_index("resistance")
    assert table.loc["flexure of belt and bulk, carry", "source"] == "calculation.flexure, laws"
    assert found.resistances["force [N]"].sum() == pytest.approx(found.balance.forces.total, rel=1e-12)


def test_more_tension_less_flexure(line):
    least = conveyor.analyse(with_flexure(line, belt=BELT)).balance.forces.flexure
    taut = conveyor.analyse(with_flexure(line, belt=BELT | {"tension": "150 kN"}))
    assert taut.balance.forces.flexure < least
    for r in taut.stretches:
        assert r.flexure == pytest.approx(by_hand(r.stretch, 150e3), rel=1e-12)


def test_flexure_of_the_bulk_adds_to_the_loaded_strand_only(line):
    belt = conveyor.analyse(with_flexure(line, belt=BELT))
    both = conveyor.analyse(with_flexure(line, belt=BELT, bulk=BULK))
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
    for before, after in zip(belt.stretches, both.stretches, strict=True):
        added = after.stretch.sets * bound if after.stretch.strand == "carry" else 0.0
        assert after.flexure == pytest.approx(before.flexure + added, rel=1e-12)


def test_splitting_a_section_changes_no_flexure(line):
    made = with_flexure(line, belt=BELT, bulk=BULK)
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = made.replace(route=made.route.replace(sections=sections))
    before, after = (conveyor.analyse(each).balance.forces.flexure for each in (made, split))
    assert after == pytest.approx(before, rel=1e-11)


def test_the_laws_say_how_far_to_trust_them(line):
    told = conveyor.analyse(with_flexure(line, belt=BELT))
    assert any("at the least tension that the sag allows, on the safe side" in a for a in told.assumptions)
    assert "calculation.flexure.bulk not given: flexure of the bulk is not in the figures" in told.warnings
    assert not any("flexure_share" in w for w in told.warnings)
    bound = conveyor.analyse(with_flexure(line, bulk=BULK))
    assert any("an upper bound; its opening angle is the spec's" in w for w in bound.warnings)


def test_a_tension_below_the_belts_momentum_is_refused(line):
    slack = with_flexure(line, belt=BELT | {"tension": "3 kN"})
    with pytest.raises(
        NoSolutionError, match=r"m' v² is .* give a larger calculation\.flexure\.belt\.tension"
    ):
        conveyor.analyse(slack)


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
    five = line.idlers.carry.replace(rolls=5, roll=roll, load_shares=["5 %", "15 %", "60 %", "15 %", "5 %"])
    made = line.replace(idlers=line.idlers.replace(carry=five))
    with pytest.raises(InputError, match=r"calculation\.flexure\.bulk: given, but the wings of 5 rolls"):
        with_flexure(made, bulk=BULK)


def test_ploughs_are_special_resistances_at_their_place(line, result):
    plough = {"count": 2, "width": "1 m", "position": "carry", "section": "plateau"}
    made = line.replace(
        route=line.route.replace(ploughs=[plough, {"width": "0.8 m", "scraping_factor": "2 kN/m"}])
    )
    found = conveyor.analyse(made)
    singles = {single.name: single for single in found.balance.singles if single.name.startswith("plough")}
    assert {name: (single.force, single.place) for name, single in singles.items()} == {
        "plough 1 (x2)": (3000.0, "behind plateau, carry"),
        "plough 2 (x1)": (pytest.approx(1600.0, rel=1e-14), "head"),
    }
    added = found.balance.forces.special - result.balance.forces.special
    assert added == pytest.approx(4600.0, rel=1e-9)
    points = found.balance.points
    assert points[-1].tension - points[0].tension == pytest.approx(found.balance.forces.total, rel=1e-9)
    assert any("route.ploughs: scraping factor 1500 N/m assumed" in w for w in found.warnings)
    empty = conveyor.analyse(made.replace(material=made.material.replace(flow="0 t/h")))
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
    assert list(tables.comparison(result.balance).columns) == ["this calculation", "classical, given f"]
    found = conveyor.analyse(line.replace(calculation=line.calculation.replace(cema=CEMA)))
    assert astuple(found.balance.forces) == pytest.approx(astuple(result.balance.forces), rel=ROUNDING)
    table = tables.comparison(found.balance)["CEMA classic, given Ky"]
    parts = table["main [N]"] + table["secondary [N]"] + table["special [N]"] + table["lift [N]"]
    assert table["effective tension [N]"] == pytest.approx(parts, rel=1e-12)
    told = found.to_dict()["cema"]
    assert told["total_N"] == pytest.approx(table["effective tension [N]"], rel=1e-14)
    assert told["motor_kW"] == pytest.approx(table["motor power [kW]"], rel=1e-14)
    assert result.to_dict()["cema"] is None
    assert any("CEMA classic form: formulas as commonly reproduced" in w for w in found.warnings)


def test_cema_by_hand_in_its_own_units(line):
    found = conveyor.analyse(
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
    skirts_and_cleaners = math.fsum(
        single.force for single in found.singles if single.name.startswith(("skirts", "cleaner"))
    )
    assert found.cema.special == pytest.approx(skirts_and_cleaners, rel=1e-12)
    assert found.cema.motor == pytest.approx(found.cema.total * 5.0 / 0.94, rel=1e-12)
    unit_main = math.fsum(r.unit_main for r in conveyor.analyse(line).stretches)
    assert found.cema.friction_factor == pytest.approx(found.cema.main / unit_main, rel=1e-12)


def test_cema_is_the_same_for_a_split_section(line):
    made = line.replace(calculation=line.calculation.replace(cema=CEMA))
    halves = [made.route.sections[1].replace(name=f"half {i}", length="170 m", lift="0.75 m") for i in (1, 2)]
    sections = [made.route.sections[0], *halves, *made.route.sections[2:]]
    split = made.replace(route=made.route.replace(sections=sections))
    before, after = (conveyor.analyse(each).balance.cema.total for each in (made, split))
    assert after == pytest.approx(before, rel=1e-12)


def test_pulleys_of_little_wrap_count_less(line):
    made = line.replace(calculation=line.calculation.replace(cema=CEMA))
    pulleys = [p.replace(wrap_angle="90 deg") if p.name == "tail" else p for p in line.route.pulleys]
    less = made.replace(route=made.route.replace(pulleys=pulleys))
    saved = conveyor.analyse(made).balance.cema.secondary - conveyor.analyse(less).balance.cema.secondary
    assert saved == pytest.approx(50.0 * LBF, rel=1e-9)
