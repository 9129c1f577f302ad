"""Pipe conveyors: statics of a panel by hand, fill, lumps, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

import conveyor
from conveyor.checks.bulk_checks import belt_filling, pipe_lumps
from conveyor.errors import InputError
from conveyor.laws.loading import PIPE_ROLLS, pipe_area, pipe_roll_loads
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.report.tables.study_tables import flooded_belt as flooded_table
from conveyor.studies.flooding import flooded_belt
from tests.command_line import ROOT, run

SPEC = ROOT / "examples" / "specs" / "pipe.yaml"
ANGLES = tuple(math.radians(60.0 * (place - 2)) for place in range(6))  # from below, by PIPE_ROLLS
PANEL = {
    "bulk_line_mass": 53.4, "belt_line_mass": 39.6, "spacing": 1.2, "diameter": 0.38, "roll_length": 0.23,
    "forming_load": 80.0, "inclination": 0.0, "gravity": 9.81,
}  # fmt: skip


@pytest.fixture(scope="module")
def spec():
    return conveyor.load(SPEC)


@pytest.mark.parametrize("slope", [0.0, 0.2])
@pytest.mark.parametrize("forming", [0.0, 80.0])
def test_the_rolls_hold_the_weight_and_nothing_else(slope, forming):
    loads = pipe_roll_loads(**PANEL | {"inclination": slope, "forming_load": forming})
    up = math.fsum(load.force * math.cos(angle) for load, angle in zip(loads, ANGLES, strict=True))
    across = math.fsum(load.force * math.sin(angle) for load, angle in zip(loads, ANGLES, strict=True))
    assert up == pytest.approx((53.4 + 39.6) * 9.81 * 1.2 * math.cos(slope), rel=1e-12)
    assert across == pytest.approx(0.0, abs=1e-9)


def test_a_belt_without_stiffness_leaves_the_upper_rolls_alone():
    loads = {load.name: load.force for load in pipe_roll_loads(**PANEL | {"forming_load": 0.0})}
    assert tuple(loads) == PIPE_ROLLS
    assert [loads[name] for name in ("upper left", "top", "upper right")] == pytest.approx([0.0] * 3)
    assert loads["lower left"] == pytest.approx(loads["lower right"])


def test_bulk_of_a_full_pipe_stands_by_columns_on_the_bottom_roll():
    """Columns across a full pipe, summed by the midpoint rule: its error falls with the square of the step."""
    edges = np.linspace(-1.0, 1.0, 200_001)
    x = 0.5 * (edges[1:] + edges[:-1])
    column = np.sqrt(1.0 - x**2)
    below = np.clip(1.0 - np.abs(np.degrees(np.arcsin(x))) / 60.0, 0.0, None)
    share = np.sum(column * below) / np.sum(column)
    bottom = pipe_roll_loads(**PANEL | {"belt_line_mass": 0.0, "forming_load": 0.0})[2].force
    assert bottom / (53.4 * 9.81 * 1.2) == pytest.approx(share, abs=1e-6)


def test_it_is_filled_up_to_three_quarters(spec):
    (check,) = belt_filling(calculate(spec))
    assert check.required == pytest.approx(0.75 * math.pi * 0.38**2 / 4.0)
    assert check.calculated == pytest.approx(1000e3 / 3600 / 5.2 / 850.0)
    assert check.verdict == "pass"
    assert pipe_area(0.38) == pytest.approx(spec.flooded_section)
    over = with_fields(spec, {"material.flow": "1500 t/h"})
    assert next(belt_filling(calculate(over))).verdict == "FAIL"
    with pytest.raises(InputError, match="filling the whole pipe"):
        with_fields(spec, {"material.flow": "2000 t/h"})


@pytest.mark.parametrize(("lump", "verdict"), [("120 mm", "pass"), ("130 mm", "FAIL")])
def test_lumps_are_a_third_of_it(spec, lump, verdict):
    (check,) = pipe_lumps(calculate(with_fields(spec, {"belt.wear": {"lump": lump, "loading": "low"}})))
    assert check.verdict == verdict


def test_a_stiffer_belt_costs_power_and_both_strands_run_on_the_bottom_cover(spec):
    stiff = with_fields(spec, {f"idlers.{s}.pipe.forming_load": "120 N" for s in ("carry", "return")})
    assert calculate(stiff).balance.power.belt > calculate(spec).balance.power.belt
    assert spec.return_cover_thickness == spec.belt.bottom_cover.thickness


@pytest.mark.parametrize(
    ("changes", "field", "why"),
    [
        ({"idlers.carry.trough_angle": "35 deg"}, "trough_angle", "has no trough"),
        ({"idlers.carry.share_rule": "cross-section"}, "share_rule", "troughs"),
        ({"idlers.carry.rolls": 3}, "pipe", "a pipe has rolls: 6"),
        ({"idlers.carry.pipe.diameter": "480 mm"}, "diameter", "does not close"),
        ({"idlers.return.pipe.diameter": "300 mm"}, "diameter", "the same pipe"),
        ({"route.sections.0.horizontal_curve": "left", "route.sections.0.horizontal_radius": "5000 m",
          "route.sections.0.carry_banking": "3 deg"}, "carry_banking", "held by its rolls"),
        ({"route.sections.0.horizontal_curve": "left", "route.sections.0.horizontal_radius": "5000 m",
          "route.sections.0.return_skew": "1 deg"}, "return_skew", "held by its rolls"),
        ({"idlers.carry.pipe.diameter": "230 mm", "idlers.return.pipe.diameter": "230 mm"}, "diameter", "laps more"),
        ({"idlers.carry.cema_class": "C"}, "cema_class", "no set of 6"),
    ],
)  # fmt: skip
def test_what_is_no_pipe_is_refused_by_field(spec, changes, field, why):
    with pytest.raises(InputError, match=why) as refused:
        with_fields(spec, changes)
    assert field in str(refused.value)


def test_six_rolls_without_a_pipe_are_refused(spec):
    with pytest.raises(InputError, match="panel around a pipe"):
        with_fields(spec, {"idlers.carry.pipe": None})


def test_the_command_reports_it(tmp_path):
    code, out, err = run("power", str(SPEC), "-o", str(tmp_path / "pipe.html"))
    assert code == 0, err
    assert "FAIL" not in out
    assert "idlers.carry.pipe.filling" in out
    assert "around a pipe of 380 mm" in (tmp_path / "pipe.html").read_text(encoding="utf-8")


def test_a_flooded_pipe_is_full_and_no_more(spec):
    flooded = flooded_belt(calculate(spec))
    assert flooded.section == pytest.approx(math.pi * 0.38**2 / 4.0, rel=1e-12)
    assert flooded.found.line.flow == pytest.approx(flooded.section * 850.0 * 5.2, rel=1e-9)
    note = flooded_table(flooded).note
    assert "filling the whole pipe" in note
    assert "edge to edge" not in note


def test_one_place_knows_the_shape(spec):
    pipe, trough = spec.idlers.carry.shape, conveyor.load(SPEC.with_name("overland.yaml")).idlers.carry.shape
    assert pipe.closed
    assert not trough.closed
    assert pipe.largest_section(1.46, 0.3).on_slope(0.4, surcharge_angle=0.3) == pytest.approx(
        0.75 * pipe.most_calculated(1.46, 0.3)
    )
    assert trough.most_calculated(1.4, 0.3) >= 1.5 * trough.largest_section(1.4, 0.3).area
