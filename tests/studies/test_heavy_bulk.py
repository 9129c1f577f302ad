"""Two densities of the bulk: one fills the cross-section, one weighs."""

from __future__ import annotations

import json

import pytest

import conveyor
from conveyor.checks.bulk_checks import belt_filling
from conveyor.errors import InputError
from conveyor.laws.idler_sets import lump_load_factor
from conveyor.line.set_limits import SetLimits
from conveyor.models import LoadCase
from conveyor.models.fields import with_fields
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate
from conveyor.report.tables.document_tables import identity_table
from conveyor.studies.flooding import flooded_belt
from conveyor.units import si
from tests.command_line import ROOT, run

SPEC = ROOT / "examples" / "specs" / "transfer.yaml"
HEAVY = {"material.density": "1860 kg/m^3", "material.weight_density": "2200 kg/m^3"}
OVER = 2200.0 / 1860.0


@pytest.fixture(scope="module")
def spec():
    return with_fields(conveyor.load(SPEC), HEAVY)


@pytest.fixture(scope="module")
def own(spec):
    return calculate(spec)


@pytest.fixture(scope="module")
def heavy(spec):
    return calculate(with_case(spec, LoadCase(name="heavy", loading="heavy bulk")))


def _filling(result):
    (check,) = belt_filling(result)
    return check.calculated


def test_heavy_bulk_fills_as_before_and_weighs_more(own, heavy):
    """By hand: the same m³/s, each of 2200 instead of 1860 kg."""
    assert _filling(heavy) == pytest.approx(_filling(own), rel=1e-12)
    flow, speed = si(own.conveyor.material.flow), si(own.conveyor.belt.speed)
    assert _filling(own) == pytest.approx(flow / (speed * 1860.0), rel=1e-12)
    assert heavy.line.stretches[0].bulk_mass == pytest.approx(flow / speed * OVER, rel=1e-12)
    lifts = [result.balance.forces.lift for result in (own, heavy)]
    assert lifts[1] == pytest.approx(lifts[0] * OVER, rel=1e-9)


def test_the_flow_is_a_mass_whatever_the_bulk_weighs_at_its_heaviest(own):
    alone = calculate(with_fields(own.conveyor, {"material.weight_density": None}))
    assert alone.balance.forces.total == pytest.approx(own.balance.forces.total, rel=1e-12)


def test_the_flooded_belt_weighs_at_the_heaviest(own):
    """Its section knows no density; its mass is that section of 2200 kg/m³."""
    flooded = flooded_belt(own)
    bulk = flooded.line_mass - own.line.stretches[0].belt_mass
    assert bulk == pytest.approx(own.conveyor.flooded_section * 2200.0, rel=1e-12)
    assert flooded.found.line.density == pytest.approx(2200.0)


def test_lumps_and_wear_are_those_of_the_heaviest(spec):
    wear = {"belt.wear": {"lump": "250 mm", "abrasiveness": "high", "loading": "medium"}}
    heavy = calculate(with_fields(spec, wear)).line
    limits = SetLimits.of(heavy.stretches[0], heavy, tension=0.0)
    assert limits.lump_factor == pytest.approx(lump_load_factor(0.25, density=2200.0))
    light = calculate(with_fields(spec, wear | {"material.density": "1000 kg/m^3"})).line
    lone = {"material.density": "1000 kg/m^3", "material.weight_density": None}
    without = calculate(with_fields(spec, wear | lone)).line
    assert light.belt.covers[0].wear > without.belt.covers[0].wear


def test_both_stand_in_the_report(own):
    said = {row.label: row.value for row in identity_table(own.conveyor, "SI").rows}["material"]
    assert said.endswith("1,860 kg/m³ (at its heaviest 2,200 kg/m³)")


def test_less_than_what_fills_is_refused(spec):
    with pytest.raises(InputError, match=r"less than the density 1860 kg/m\^3 that fills the belt.*exchange the two"):
        with_fields(spec, {"material.weight_density": "1.5 t/m^3"})


def test_heavy_bulk_needs_its_density(spec):
    bare = {"material.weight_density": None, "cases": [{"name": "heavy", "loading": "heavy bulk"}]}
    with pytest.raises(InputError, match=r'got "heavy bulk" without material\.weight_density'):
        with_fields(spec, bare)


def test_a_case_of_heavy_bulk_in_us_units(tmp_path):
    """100 and 120 lb/ft³: the case's belt is as full as the spec's, its motors drive more."""
    spec = tmp_path / "spec.yaml"
    given = SPEC.read_text(encoding="utf-8").replace(
        "density: 1800 kg/m^3", "density: 100 lb/ft^3\n  weight_density: 120 lb/ft^3"
    )
    cases = "cases:\n  - {name: heavy, loading: heavy bulk}\nreport: {units: US}\n"
    spec.write_text(given + cases, encoding="utf-8")
    done = run("power", spec, "--json", cwd=tmp_path)
    assert done.returncode in {0, 1}, done.stderr
    data = json.loads(done.stdout)
    (case,) = data["load_cases"]["cases"]
    assert case["mass flow [t/h]"] == pytest.approx(1.2 * data["flow_t_per_h"], rel=1e-9)
    governing = {row["figure"]: row["case"] for row in data["load_cases"]["governing"]}
    assert governing["maximum motor power"] == "heavy"
