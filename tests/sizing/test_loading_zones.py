"""Closer sets where the bulk lands: how far they reach, and that the spec of a design has and counts them."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from conveyor import shelf
from conveyor.models.sizing import SizingDuty
from conveyor.pipeline import calculate
from conveyor.sizing.design_choice import SelectedParts
from conveyor.sizing.design_spec import design_spec
from conveyor.sizing.screen import Candidates
from conveyor.sizing.sizing_task import SizingTask
from conveyor.studies.costs import conveyor_parts
from conveyor.studies.study_file import read_duty
from conveyor.units import si

DUTIES = Path(__file__).parents[2] / "examples" / "duties"
FIRST = {"name": "feed", "length": "12 m"}
SECOND = {"name": "incline", "length": "150 m", "lift": "25 m"}


def sized_spec(*sections, rules=None, **route):
    """Spec of a candidate with carry sets 1.2 m apart at 2.5 m/s."""
    duty = SizingDuty.from_data({
        "name": "fed",
        "material": {"name": "stone", "density": "1600 kg/m^3", "flow": "600 t/h", "surcharge_angle": "20 deg"},
        "lump": "100 mm",
        "route": {"sections": list(sections or (FIRST, SECOND)), **route},
        "ambient": {"temperature": "20 degC"},
        "operation": {"hours_per_year": "4000 h", "price": "0.12 EUR/kWh"},
        "covers": [shelf.compound("standard-cover")],
        "rules": {"widths": ["800 mm"], "speeds": ["2.5 m/s"], "carry_spacings": ["1.2 m"], **(rules or {})},
    })  # fmt: skip
    task = SizingTask(duty)
    carcass = task.carcasses["EP"][3]
    parts = SelectedParts(carcass, *task.covers(Candidates.of(task)[0], carcass), (90e3,), 0.0)
    return design_spec(task, Candidates.of(task)[0], parts, "fed")


def spaced(spec):
    """Name, length and carry spacing of each section [m]."""
    even = si(spec.idlers.carry.spacing)
    return [
        (one.name, si(one.length), even if one.carry_spacing is None else si(one.carry_spacing))
        for one in spec.route.sections
    ]


def test_without_a_loading_point_the_zone_is_that_of_usual_skirtboards():
    """0.6 m for each 0.5 m/s: 3 m at 2.5 m/s, five sets 0.6 m apart."""
    assert spaced(sized_spec()) == [
        ("feed, skirts", pytest.approx(3.0), pytest.approx(0.6)),
        ("feed", pytest.approx(9.0), pytest.approx(1.2)),
        ("incline", pytest.approx(150.0), pytest.approx(1.2)),
    ]


def test_the_zone_of_given_skirts_begins_where_the_bulk_is_accelerated():
    """v²/(2 g μ1) = 6.25/(2 · 9.81 · 0.5) = 0.637 m and 2 m of skirts, in whole sets 3 m; skirtboards of 4.2 m."""
    skirts = {"skirt_length": "2 m", "skirt_width": "450 mm", "belt_friction": 0.5}
    assert spaced(sized_spec(feeding=skirts))[0][1] == pytest.approx(3.0)
    assert spaced(sized_spec(feeding=skirts | {"skirtboards": "4.2 m"}))[0][1] == pytest.approx(4.2)


@pytest.mark.parametrize("slope", [{"lift": "8 m"}, {"slope": "10 deg"}, {}])
def test_a_divided_section_is_as_long_and_rises_as_before(slope):
    whole = sized_spec(FIRST | slope, SECOND, rules={"loading_spacing": "1.2 m"})
    parts = sized_spec(FIRST | slope, SECOND)
    assert len(whole.route.sections) == 2
    assert len(parts.route.sections) == 3
    front, rest = parts.route.sections[:2]
    assert si(front.length) + si(rest.length) == pytest.approx(12.0)
    assert front.rise + rest.rise == pytest.approx(whole.route.sections[0].rise, abs=1e-6)
    assert front.rise / si(front.length) == pytest.approx(rest.rise / si(rest.length), abs=1e-6)


def test_sets_and_their_drag_count():
    """Five sets of three rolls instead of two and a half, in cost and power."""
    close, even = (calculate(sized_spec(rules=rules)) for rules in ({}, {"loading_spacing": "1.2 m"}))
    closer, evenly = conveyor_parts(close), conveyor_parts(even)
    assert closer.sets - evenly.sets == pytest.approx(3.0 / 0.6 - 3.0 / 1.2)
    assert closer.rolls - evenly.rolls == pytest.approx(7.5)

    def drag(one, *names):
        return math.fsum(
            stretch.forces["idler_rotation"] for stretch in one.stretches if stretch.stretch.section in names
        )

    assert drag(close, "feed, skirts") / 3.0 > 1.4 * drag(even, "feed") / 12.0
    assert close.balance.power.motor > even.balance.power.motor


def test_a_short_section_is_close_throughout_and_the_next_has_the_rest():
    """Three sets 0.6 m apart on 1.8 m; 1.2 m, two sets, are left of 3 m for the next section."""
    assert spaced(sized_spec({"name": "tail", "length": "1.8 m"}, FIRST, SECOND)) == [
        ("tail", pytest.approx(1.8), pytest.approx(0.6)),
        ("feed, skirts", pytest.approx(1.2), pytest.approx(0.6)),
        ("feed", pytest.approx(10.8), pytest.approx(1.2)),
        ("incline", pytest.approx(150.0), pytest.approx(1.2)),
    ]


@pytest.mark.parametrize("kept", [{"loaded": False}, {"curve": "concave", "curve_radius": "100 m"}])
def test_curves_and_sections_without_bulk_keep_their_sets(kept):
    assert {apart for *_, apart in spaced(sized_spec(FIRST | kept, SECOND))} == {1.2}


def test_loading_points_and_scales_stand_where_they_stood():
    point = {"skirt_length": "2 m", "skirt_width": "450 mm", "section": "incline"}
    scale = {"section": "incline", "distance": "60 m"}
    spec = sized_spec(FIRST, SECOND, feeding=point, belt_scales=[scale])
    assert [name for name, *_ in spaced(spec)] == ["feed", "incline, skirts", "incline"]
    assert spec.route.feeding.section == "incline, skirts"
    assert spec.route.belt_scales[0].section == "incline"
    assert si(spec.route.belt_scales[0].distance) == pytest.approx(57.0)


def test_each_loading_point_has_its_zone():
    skirts = {"skirt_length": "2 m", "skirt_width": "450 mm"}
    spec = sized_spec(
        FIRST, SECOND, feeding=skirts | {"share": "60 %"},
        further_feeding=[skirts | {"share": "40 %", "section": "incline"}],
    )  # fmt: skip
    assert [name for name, *_ in spaced(spec)] == ["feed, skirts", "feed", "incline, skirts", "incline"]


def test_the_zone_of_the_us_is_in_whole_sets_of_its_series():
    """2 ft for each 100 fpm: 12 ft at 600 fpm, six sets 2 ft apart."""
    rules = {"widths": ["36 in"], "speeds": ["600 fpm"], "carry_spacings": ["4 ft"]}
    task = SizingTask(read_duty(DUTIES / "in_plant_us.yaml").replace(rules=rules))
    choice = Candidates.of(task)[0]
    carcass = task.carcasses["EP"][3]
    spec = design_spec(task, choice, SelectedParts(carcass, 6e-3, 2e-3, (150e3,), 0.0), "fed")
    assert str(spec.route.sections[0].length) == "12.0 ft"
    assert str(spec.route.sections[0].carry_spacing) == "2.0 ft"
