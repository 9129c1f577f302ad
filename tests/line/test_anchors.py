"""A compound's tests set the test factor of its indentation, on the conveyor and wherever its result is shown."""

from __future__ import annotations

import math

import numpy as np
import pytest

import conveyor
from conveyor import shelf
from conveyor.checks import run_checks
from conveyor.errors import NoSolutionError
from conveyor.indentation import RollContact, indentation_resistance
from conveyor.line.rolling_test_theory import compound_test_factor, compound_test_factors, rolling_test_rows
from conveyor.models import Uncertainty
from conveyor.models.variants import with_compound
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.studies.input_ranges import analyse_ranges

RTOL = 1e-4  # of the theory at the tests
AT = 293.15
COVERS = ("low-rolling-resistance-cover", "standard-cover", "cold-resistant-cover")
LEVELS = dict(zip(COVERS, (1.0, 1.25, 1.12), strict=True))


def one_test(*rows: tuple[float, float], **changes: str) -> dict[str, object]:
    """A test of rows of line load [N/mm] and resistance [N/m]."""
    given = {
        "source": "made up",
        "roll_diameter": "159 mm",
        "cover_thickness": "5 mm",
        "speed": "4 m/s",
        "temperature": "20 degC",
        "line_load": [f"{load!r} N/mm" for load, _ in rows],
        "resistance": [f"{force!r} N/m" for _, force in rows],
    }
    return given | changes


@pytest.fixture(scope="module")
def line():
    return load("examples/specs/overland.yaml")


def linear(name: str):
    return shelf.compound(name).replace(strain_dependence=None, tests=())


def indentation(given) -> float:
    return calculate(given).balance.forces.indentation


def told(result):
    return [warning.text() for warning in analysis_warnings(result, run_checks(result))]


@pytest.mark.parametrize("name", COVERS)
def test_the_covers_of_the_shelf_stand_on_the_published_law(name):
    compound = shelf.compound(name)
    for softened in (True, False):
        rows = rolling_test_rows(compound, softened=softened)
        level = compound_test_factor(compound, softened=softened)
        for row in rows:
            # CEMA-7 / DIN 22123: w = 6.59e-3 W^1.28, N/mm
            law = LEVELS[name] * 6.59 * (row.line_load / 1e3) ** 1.28
            assert row.measured == pytest.approx(law, rel=1e-9)
            anchored = row.calculated * float(level.factor(row.line_load, AT))
            # a law and the theory differ in curvature over the loads: 3 % at most, within its 15 %
            assert anchored == pytest.approx(law, rel=0.03)


def test_theory_at_the_tests_is_the_contact_of_the_test():
    compound = linear("standard-cover").replace(tests=[one_test((1.0, 8.0), (3.0, 30.0))])
    first, second = rolling_test_rows(compound, softened=False)
    contact = RollContact(0.0795, 1.0, 5e-3, 4.0, compound.series(AT))
    for row, load_ in ((first, 1e3), (second, 3e3)):
        assert row.line_load == pytest.approx(load_)
        expected = float(indentation_resistance(contact, load_).resistance)
        assert row.calculated == pytest.approx(expected, rel=2.0 * RTOL)
    assert (first.measured, second.measured) == pytest.approx((8.0, 30.0))


def test_softened_theory_between_its_loads_is_the_softened_contact():
    compound = shelf.compound("s100").replace(tests=[one_test((1.0, 8.0), (2.0, 16.0), (5.0, 60.0))])
    rows = rolling_test_rows(compound, softened=True)
    alone = [
        rolling_test_rows(shelf.compound("s100").replace(tests=[one_test((load_, 10.0 * load_))]), softened=True)[0]
        for load_ in (1.0, 2.0, 5.0)
    ]
    for row, single in zip(rows, alone, strict=True):
        # the working strain is known to a hundredth, moduli fall by about 0.2 of it; a parabola adds as much
        assert row.calculated == pytest.approx(single.calculated, rel=5e-3)


def test_tests_that_are_the_theory_change_nothing(line):
    theory = linear("standard-cover")
    contact = RollContact(0.0795, 1.0, 5e-3, 4.0, theory.series(AT))
    rows = [(w, float(indentation_resistance(contact, 1e3 * w).resistance)) for w in (0.5, 2.0, 8.0)]
    plain = with_compound(line, theory, "both")
    same = with_compound(line, theory.replace(tests=[one_test(*rows)]), "both")
    twice = with_compound(line, theory.replace(tests=[one_test(*((w, 2.0 * f) for w, f in rows))]), "both")
    assert indentation(same) == pytest.approx(indentation(plain), rel=5.0 * RTOL)
    # twice the measured resistance is twice the indentation, on any roll, cover and speed
    assert indentation(twice) == pytest.approx(2.0 * indentation(plain), rel=5.0 * RTOL)
    off = twice.replace(calculation=twice.calculation.replace(anchor="off"))
    assert indentation(off) == pytest.approx(indentation(plain), rel=1e-9)
    assert any("calculation.anchor is off" in warning for warning in told(calculate(off)))


def test_the_level_is_shown_wherever_its_result_is(line):
    result = conveyor.analyse(line)
    rubber = {row["strand"]: row for row in result.to_dict()["rubber"]}
    carry = rubber["carry"]
    assert 1.5 < carry["level_factor"] < 2.5
    assert carry["level_from"] < carry["level_factor"] < carry["level_to"]
    # 15 % of the test, in the logarithm, and what its fit leaves
    assert math.log(carry["level_to"] / carry["level_factor"]) == pytest.approx(0.15, abs=0.01)
    assert any("times the theory" in warning and "rolling-resistance tests" in warning for warning in result.warnings)
    bare = calculate(with_compound(line, linear("s100"), "both"))
    assert any("no rolling-resistance tests" in warning for warning in told(bare))


def test_the_level_is_in_the_uncertainty(line):
    found = analyse_ranges(line, Uncertainty(rubber=True), rtol=1e-4)
    effects = {effect.name: effect for effect in found.effects}
    carry = effects['test factor of "low-rolling-resistance-cover"']
    middle = calculate(line)
    half = middle.contacts.test_factor_band("carry")
    assert (carry.low, carry.high) == (f"{100.0 * math.expm1(-half):+.0f} %", f"{100.0 * math.expm1(half):+.0f} %")
    along = {force.key: force for force in middle.balance.along}["indentation"].by_strand()["carry"]
    efficiency = middle.line.efficiency
    # the carry rolls' force and the pulleys' share of the tensions, less the flexure that a tighter belt loses
    force = along * (math.exp(half) - math.exp(-half))
    relief = middle.balance.forces.parts["flexure"] * force / middle.balance.tensions.smallest
    swing = carry.swing * efficiency / middle.line.speed
    assert force - relief <= swing <= 1.25 * force


def test_without_the_confined_support_the_theory_stands_alone(line):
    free = line.replace(calculation=line.calculation.replace(support="half-space"))
    result = calculate(free)
    assert all(cover.test_factor is None for cover in result.contacts.covers.values())
    assert any("the support is not confined" in warning for warning in told(result))


def test_a_test_that_no_contact_answers_says_so():
    heavy = linear("low-rolling-resistance-cover").replace(
        tests=[one_test((100.0, 1e4), roll_diameter="20 mm", cover_thickness="100 mm", temperature="40 degC")]
    )
    with pytest.raises(NoSolutionError, match="a rolling-resistance test: roll of 20 mm on a 100 mm cover"):
        compound_test_factor(heavy, softened=False)


def test_below_the_best_ever_published_it_warns(line):
    changes = {"anchor": "off", "strain": "off", "flexure_share": "5 %"}
    light = line.replace(calculation=line.calculation.replace(**changes))
    result = calculate(with_compound(light, linear("low-rolling-resistance-cover"), "both"))
    assert result.balance.friction_factor < 0.0075
    assert any("the best ever measured on a conveyor" in warning for warning in told(result))


def test_tested_and_untested_compounds_are_not_ranked_without_a_word(line):
    from conveyor.report.tables.comparison_notes import comparison_notes
    from conveyor.studies.comparison import compare_compounds

    def said(compounds):
        found = compare_compounds(line, compounds, temperatures=["20 degC"])
        return [
            remark
            for remark in comparison_notes(found)
            if "no rolling-resistance tests, which the others have" in remark
        ]

    tested, untested = shelf.compound("standard-cover"), linear("low-rolling-resistance-cover")
    (remark,) = said([tested, untested])
    assert remark.startswith('"low-rolling-resistance-cover": ')
    assert not said([untested, linear("standard-cover")])
    assert not said([tested, shelf.compound("cold-resistant-cover")])


def test_levels_side_by_side_are_each_alone():
    compounds = [shelf.compound(name) for name in ("standard-cover", "s100", "cold-resistant-cover")]
    first, none, last = compound_test_factors(compounds, softened=True)
    assert none is None  # no tests
    for compound, level in ((compounds[0], first), (compounds[2], last)):
        alone = compound_test_factor(compound, softened=True)
        # batches round otherwise, and contacts end within their tolerance
        assert level.factor(2000.0, AT) == pytest.approx(alone.factor(2000.0, AT), rel=RTOL)


def test_beyond_the_tests_the_replicas_carry_the_level(line):
    """Each replica anchored anew at 20 degC, on the whole conveyor at -25 degC: brute force for the quick range."""
    cold = line.replace(
        ambient=line.ambient.replace(temperature="-25 degC"),
        calculation=line.calculation.replace(strain="off", rtol=1e-3),
    )
    rubber = shelf.compound("standard-cover")
    middle = calculate(with_compound(cold, rubber, "both"))
    tested = middle.contacts.covers["carry"].test_factor
    factors = []
    for other in rubber.alternatives():
        carried = indentation(with_compound(cold, other, "both"))
        factors.append(carried / middle.balance.forces.indentation)
    low, high = np.log(np.quantile(factors, (0.05, 0.95), method="weibull"))
    half = middle.contacts.test_factor_band("carry")
    own = tested.rolling_tests.own_half_width
    # one roll for all, and its own roll for that of the tests: a tenth of the band
    for band, inner in (
        (middle.contacts.test_factor_range("carry"), half),
        (middle.contacts.test_factor_range("carry", own=True), own),
    ):
        assert math.log(band[0]) == pytest.approx(-math.hypot(low, inner), rel=0.1)
        assert math.log(band[1]) == pytest.approx(math.hypot(high, inner), rel=0.1)


def test_at_the_tested_temperature_the_tests_alone_are_the_range(line):
    contacts = calculate(line).contacts
    half = contacts.test_factor_band("carry")
    assert contacts.test_factor_range("carry") == pytest.approx((math.exp(-half), math.exp(half)), rel=1e-12)
    bare = calculate(with_compound(line, linear("s100"), "both"))
    assert bare.contacts.test_factor_range("carry") == (1.0, 1.0)
