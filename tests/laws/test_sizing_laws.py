"""First choices: rules by hand, masses beside listed belts, an annuity that pays its sum."""

from __future__ import annotations

import math

import pytest

from conveyor.errors import InputError
from conveyor.files import libraries
from conveyor.laws import preliminary_sizing
from conveyor.units import read_si


def test_payments_of_an_annuity_are_worth_their_sum():
    """The present value of n payments is 1: the sum of a geometric series, by hand."""
    rate, years = 0.07, 12
    paid = float(preliminary_sizing.annuity(years, interest=rate))
    assert math.fsum(paid / (1.0 + rate) ** k for k in range(1, years + 1)) == pytest.approx(1.0, rel=1e-12)


def test_without_interest_a_sum_is_paid_in_equal_parts():
    assert preliminary_sizing.annuity([4.0, 10.0], interest=0.0).tolist() == pytest.approx([0.25, 0.1])
    assert float(preliminary_sizing.annuity(4.0, interest=1e-9)) == pytest.approx(0.25, rel=1e-8)


@pytest.mark.parametrize(
    ("surcharge", "share", "lumps"),
    [(20.0, "mixed", 3.0), (20.0, "sized", 5.0), (30.0, "mixed", 6.0), (25.0, "sized", 7.5)],
)
def test_widths_for_lumps_are_those_of_cema(surcharge, share, lumps):
    found = preliminary_sizing.least_width_for_lumps(0.1, surcharge_angle=math.radians(surcharge), share=share)
    assert found == pytest.approx(0.1 * lumps)


def test_cover_against_wear_goes_by_points():
    """5 points of the easiest duty, 10 of the middle one, 15 of the hardest."""
    easy = {"lump": 0.0, "density": 500.0, "round_time": 1e3, "abrasiveness": "low", "loading": "low"}
    middle = {
        "lump": 0.1,
        "density": 1500.0,
        "round_time": 30.0,
        "abrasiveness": "medium",
        "loading": "medium",
    }
    hard = {"lump": 0.5, "density": 2500.0, "round_time": 5.0, "abrasiveness": "high", "loading": "high"}
    assert [preliminary_sizing.wear_addition(**duty) for duty in (easy, middle, hard)] == [
        0.5e-3,
        4.5e-3,
        10e-3,
    ]


@pytest.mark.parametrize(("name", "covers"), [("ST4000", 24.0), ("EP630/4", 7.0)])
def test_carcasses_weigh_what_listed_belts_do(name, covers):
    """Listed mass less 1.15 kg/m² for each millimetre of cover; the rule is good to 6 % of it."""
    fields = libraries.library_entry("belts", name).fields
    carcass = fields["carcass"]
    listed = read_si(fields["mass"].replace("kg/m ", "kg/m^2 "), "belt mass") - 1.15 * covers
    made = preliminary_sizing.carcass_mass(
        read_si(carcass["strength"], "line force"),
        thickness=read_si(carcass["thickness"], "thickness"),
        steel_cord=carcass["kind"] == "steel cord",
    )
    assert made == pytest.approx(listed, rel=0.06)


def test_a_tube_weighs_its_area_times_its_length():
    outer, wall, length = 0.133, 0.004, 0.38
    area = math.pi / 4.0 * (outer**2 - (outer - 2.0 * wall) ** 2)
    assert preliminary_sizing.roll_shell_mass(outer, wall=wall, length=length) == pytest.approx(7850.0 * area * length)


def test_recommended_speeds_rise_with_width_and_fall_with_wear():
    for severity in preliminary_sizing.SEVERITIES:
        speeds = [preliminary_sizing.recommended_speed(width, abrasiveness=severity) for width in (0.5, 0.8, 1.2, 2.0)]
        assert speeds == sorted(speeds)
    assert preliminary_sizing.recommended_speed(1.2, abrasiveness="high") == pytest.approx(600 * 0.3048 / 60)


def test_what_is_out_of_range_is_refused():
    with pytest.raises(InputError, match="abrasiveness"):
        preliminary_sizing.recommended_speed(1.0, abrasiveness="some")
    with pytest.raises(InputError, match="thickness"):
        preliminary_sizing.carcass_mass(5e6, thickness=2e-3, steel_cord=True)


@pytest.mark.parametrize(("lump", "density"), [(0.05, 1000.0), (0.15, 2000.0)])
def test_a_border_in_inches_and_pounds_is_that_border(lump, density):
    rest = {"round_time": 30.0, "abrasiveness": "medium", "loading": "medium"}
    on, by_inch = (
        preliminary_sizing.wear_addition(lump=k * lump, density=k * density, **rest) for k in (1.0, 1.0 + 1e-15)
    )
    assert on == by_inch
