"""Masses and drags of idlers as people have them: each roll's, a set's, per length; belts by rating or strength."""

from __future__ import annotations

import copy

import pytest

from conveyor.line.line import Line
from conveyor.loop.belt_duty import belt_duty
from conveyor.spec import from_data
from tests.loop.loop_lines import DATA, balanced, closed, told

ROUNDING = 1e-12


def idlers(**carry):
    """The sets with the carry set given as a whole: its rolls have neither mass nor drag of their own."""
    made = copy.deepcopy(DATA["idlers"])
    if {"rotating_mass", "reduced_mass"} & set(carry):
        del made["carry"]["roll"]["rotating_mass"]
    if "drag" in carry:
        del made["carry"]["roll"]["drag"]
    made["carry"] |= carry
    return made


@pytest.mark.parametrize("mass", ["12 kg", "10 kg/m", "26.455471462185307 lb"])
def test_a_set_given_as_a_whole_is_its_rolls_together(mass):
    """Three rolls of 4 kg every 1.2 m: 12 kg a set, 10 kg/m, 12/0.45359237 lb; three drags of 1.5 N."""
    rolls, whole = balanced(), balanced(idlers=idlers(rotating_mass=mass, drag="4.5 N"))
    for name in ("total", "main"):
        assert getattr(whole.forces, name) == pytest.approx(getattr(rolls.forces, name), rel=ROUNDING)
    assert whole.line.loop.mass == pytest.approx(rolls.line.loop.mass, rel=ROUNDING)


def test_a_reduced_mass_lightens_the_start_only():
    """9 of 12 kg every 1.2 m over 1000 m of carry strand are 2500 kg less to accelerate, and no newton less to pull."""
    rolls = balanced()
    reduced = balanced(idlers=idlers(rotating_mass="12 kg", reduced_mass="9 kg"))
    assert reduced.forces.main == pytest.approx(rolls.forces.main, rel=ROUNDING)
    less = rolls.line.loop.mass.sum() - reduced.line.loop.mass.sum()
    assert less == pytest.approx(3.0 / 1.2 * 1000.0, rel=1e-9)  # of a difference of sums a thousand times larger


def test_a_section_with_its_own_spacing_has_the_same_sets():
    """10 kg/m at 1.2 m are 12 kg a set, also where the sets stand 0.6 m apart."""
    sections = [section | ({"carry_spacing": "0.6 m"} if i == 0 else {}) for i, section in
                enumerate(DATA["route"]["sections"])]  # fmt: skip
    conveyor = from_data(
        DATA | {"idlers": idlers(rotating_mass="10 kg/m"), "route": DATA["route"] | {"sections": sections}}
    )
    assert [stretch.set_mass for stretch in Line.of(conveyor).stretches[:2]] == pytest.approx(
        [12.0, 12.0], rel=ROUNDING
    )


def test_a_reduced_mass_alone_stands_for_all_and_says_so():
    from conveyor.remarks.part_warnings import _mass_warnings

    conveyor = from_data(DATA | {"idlers": idlers(reduced_mass="12 kg")})
    assert closed(conveyor).forces.main == pytest.approx(balanced().forces.main, rel=ROUNDING)
    (warning,) = _mass_warnings(conveyor)
    assert "rotating_mass not given, reduced_mass (12 kg) stands for it" in warning.text()


def rated(**carcass):
    given = {name: value for name, value in DATA["belt"]["carcass"].items() if name != "strength"}
    return from_data(DATA | {"belt": DATA["belt"] | {"carcass": given | carcass}})


def test_a_rated_belt_is_judged_by_the_tension_it_works_at():
    """600 lbf/in are 600 × 4.4482216 N / 25.4 mm = 105.076 N/mm; tensions per width are those of the loop over 1 m."""
    conveyor = rated(rating="600 PIW")
    found = closed(conveyor)
    duty = belt_duty(found)
    assert duty.rating == pytest.approx(600 * 4.4482216152605 / 0.0254, rel=ROUNDING)
    assert duty.per_width_steady == pytest.approx(found.equilibrium.steady.largest / 1.0, rel=ROUNDING)
    assert (duty.safety, duty.strength_needed) == (None, {})
    assert not any("rated for" in why for why in told(conveyor, found))


def test_a_rating_below_the_tension_fails_and_up_to_half_as_much_again_may_start():
    steady = belt_duty(closed(rated(rating="600 PIW"))).per_width_steady / 1e3
    tight, over = rated(rating=f"{0.99 * steady} N/mm"), rated(rating=f"{1.01 * steady} N/mm")
    assert sum("the belt is rated for" in why for why in told(tight, closed(tight))) == 1  # steady; starts within 1.5
    assert not any("the belt is rated for" in why for why in told(over, closed(over)))


def test_a_rated_belt_on_a_curve_is_allowed_its_rating():
    """The same curve with a strength ten times the rating (safety 10 for textile belts) gives the same radius."""
    curve = {"curve": "convex", "curve_radius": "500 m"}
    sections = [section | (curve if i == 1 else {}) for i, section in enumerate(DATA["route"]["sections"])]
    carcass = {"kind": "EP", "thickness": "5 mm", "stiffness": "8000 N/mm"}

    def radius(**given):
        made = DATA | {
            "belt": DATA["belt"] | {"carcass": carcass | given},
            "route": DATA["route"] | {"sections": sections},
        }
        return belt_duty(closed(from_data(made))).curves[0].overstress

    from conveyor.laws.belt_strength import CLASSIC_SAFETY

    strength = CLASSIC_SAFETY["textile"] * 150.0
    assert radius(rating="150 N/mm") == pytest.approx(radius(strength=f"{strength} N/mm"), rel=1e-9)
