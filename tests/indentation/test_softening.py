"""Moduli at the strain the rolls work a cover at: consistent with the contact they make, visible in the report."""

from __future__ import annotations

import math

import numpy as np
import pytest

import conveyor
from conveyor import shelf
from conveyor.checks import run_checks
from conveyor.contact import interior, solve
from conveyor.errors import InputError
from conveyor.indentation import RollContact, to_problem
from conveyor.indentation.softening import SofteningCover, loss_weighted_load, soften_at_strains, soften_or_raise
from conveyor.models import RubberCompound
from conveyor.models.variants import with_compound
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load

AT = 293.15
ROUNDING = 1e-11  # of contacts of condition 100, and of sums of 100 forces in whatever order: 1e4 of 2e-16
LOAD = 2000.0


@pytest.fixture(scope="module")
def compound():
    return shelf.compound("s100")


@pytest.fixture(scope="module")
def contact(compound):
    return RollContact(0.0795, 1.2, 5e-3, 5.0, compound.series(AT))


@pytest.fixture(scope="module")
def softened(compound, contact):
    return soften_or_raise([SofteningCover(contact, LOAD, compound.amplitude_factors(), AT)])[0]


@pytest.fixture(scope="module")
def line():
    spec = load("examples/specs/overland.yaml")
    linear = shelf.compound("standard-cover").replace(strain_dependence=None)
    return with_compound(with_compound(spec, linear, "top"), shelf.compound("s100"), "bottom")


def test_strain_is_that_of_the_contact_it_makes(contact, softened):
    series, found = softened
    again = RollContact(contact.radius, contact.spacing, contact.cover_thickness, contact.speed, series)
    inside = interior(solve(to_problem(again, LOAD), 1e-6))
    # the iteration stops at a hundredth of the strain
    assert inside.working_strain == pytest.approx(found.strain, rel=0.01)
    frequency = inside.wave_number * contact.speed / contact.spacing
    assert frequency == pytest.approx(found.frequency, rel=0.02)


def test_factors_are_the_compounds_at_that_strain(compound, contact, softened):
    series, found = softened
    factors = compound.amplitude_factors()
    # factors were taken at the trial strain, a hundredth from the last
    assert found.storage_factor == pytest.approx(float(factors.storage(found.strain, AT)), rel=0.01)
    assert found.loss_factor == pytest.approx(float(factors.loss(found.strain, AT)), rel=0.01)
    omega = 2.0 * math.pi * found.frequency
    assert float(series.storage(omega)) == pytest.approx(
        found.storage_factor * float(contact.series.storage(omega)), rel=2e-3
    )
    assert float(series.loss(omega)) == pytest.approx(found.loss_factor * float(contact.series.loss(omega)), rel=1e-12)


def test_heavier_rolls_work_it_harder(compound, contact):
    factors = compound.amplitude_factors()
    found = [soften_or_raise([SofteningCover(contact, load, factors, AT)])[0][1] for load in (1000.0, 2000.0, 4000.0)]
    assert all(np.diff([f.strain for f in found]) > 0.0)
    assert all(np.diff([f.storage_factor for f in found]) < 0.0)
    # wider contacts are passed more slowly
    assert all(np.diff([f.frequency for f in found]) < 0.0)


def test_at_the_reference_strain_nothing_changes(compound, contact, softened):
    strain = softened[1].strain
    data = compound.as_data()
    data["strain_dependence"]["reference_strain"] = f"{100.0 * strain:.12g} %"
    # not quite: the contact of the unsoftened series works at a little less strain
    factors = RubberCompound.from_data(data).amplitude_factors()
    ((series, found),) = soften_or_raise([SofteningCover(contact, LOAD, factors, AT)])
    assert found.strain < strain
    assert found.storage_factor == pytest.approx(1.0, abs=0.06)
    assert found.storage_factor > 1.0
    assert float(series.equilibrium) == pytest.approx(contact.series.equilibrium, rel=0.1)


def test_strains_beyond_the_sweeps_hold_their_last_factors(compound, contact):
    factors = compound.amplitude_factors()
    found = soften_or_raise([SofteningCover(contact, 5e6, factors, AT)])[0][1]
    largest = factors.largest_strain(AT)
    assert found.strain > largest
    assert found.storage_factor == pytest.approx(float(factors.storage(10.0 * found.strain, AT)), rel=1e-12)


def test_losing_load():
    assert loss_weighted_load(np.full(3, 700.0), np.array([0.1, 0.2, 0.3])) == pytest.approx(700.0)
    # two rolls of one weight: (w1^(7/3) + w2^(7/3))/(w1^(4/3) + w2^(4/3))
    low, high = 1000.0, 3000.0
    expected = (low ** (7 / 3) + high ** (7 / 3)) / (low ** (4 / 3) + high ** (4 / 3))
    assert loss_weighted_load(np.array([low, high]), np.ones(2)) == pytest.approx(expected, rel=1e-12)


def told(result):
    return [warning.text() for warning in analysis_warnings(result, run_checks(result))]


def test_covers_know_at_which_strain_they_work(line):
    result = calculate(line)
    worked = result.contacts.covers["carry"].strain
    assert 0.004 < worked.strain < 0.03
    assert worked.storage_factor < 1.0
    assert result.contacts.covers["return"].strain is None
    assert any("working strain under the carry rolls" in warning for warning in told(result))


def test_the_report_says_which_strain(line):
    result = conveyor.analyse(line)
    carry, back = (result.rubber.set_index("strand").loc[s] for s in ("carry", "return"))
    assert 0.004 < carry["working strain [-]"] < 0.03
    assert carry["E' factor of strain [-]"] < 1.0
    assert math.isnan(back["working strain [-]"])
    assert back["E' factor of strain [-]"] == 1.0
    (row, _) = result.to_dict()["rubber"]
    assert row["working_strain"] == pytest.approx(carry["working strain [-]"], rel=1e-15)


def test_off_is_the_linear_rubber(line):
    linear = line.replace(calculation=line.calculation.replace(strain="off"))
    on, off = calculate(line), calculate(linear)
    assert on.balance.forces.indentation > 1.05 * off.balance.forces.indentation
    plain = shelf.compound("s100").replace(strain_dependence=None)
    same = calculate(with_compound(line, plain, "bottom"))
    assert off.balance.forces.indentation == pytest.approx(same.balance.forces.indentation, rel=ROUNDING)
    assert any("calculation.strain is off" in warning for warning in told(off))


def test_outside_the_sweeps_their_factors_are_held_and_it_says_so(line):
    cold = line.replace(ambient=line.ambient.replace(temperature="-20 degC"))
    result = calculate(cold)
    assert any("do not reach -20 °C: the factors at 0.02 °C are used" in warning for warning in told(result))

    # at the end of the sweeps nothing jumps: a kelvin on both sides changes it by what a kelvin of the shift does
    def at(celsius):
        ambient = line.ambient.replace(temperature=f"{celsius} degC")
        return calculate(line.replace(ambient=ambient)).balance.forces.indentation

    below, end, above = at(-1.0), at(0.0), at(1.0)
    assert abs(below / end - 1.0) < 0.05 > abs(above / end - 1.0)
    assert (below - end) * (end - above) > 0.0


def test_mean_load_weighs_by_what_rolls_lose():
    """8^(4/3) is 16: two rolls at 8 N/m and one at 1 lose 16 to 1 each; a load that all share is the mean."""
    assert loss_weighted_load(np.array([8.0, 1.0]), np.array([2.0, 1.0])) == pytest.approx(257.0 / 33.0, rel=1e-14)
    assert loss_weighted_load(np.array([5.0, 5.0, 5.0]), np.array([1.0, 2.0, 0.0])) == pytest.approx(5.0, rel=1e-14)
    with pytest.raises(InputError, match=r"^line_loads: got 0\.0, allowed: > 0: a roll that carries something"):
        loss_weighted_load(np.zeros(2), np.ones(2))


@pytest.mark.parametrize(
    ("worked", "name"),
    [((0.0, 600.0), "strain"), ((-0.01, 600.0), "strain"), ((0.01, 0.0), "angular_frequency")],
)
def test_strains_that_are_none_are_refused(compound, contact, worked, name):
    work = SofteningCover(contact, LOAD, compound.amplitude_factors(), AT)
    with pytest.raises(InputError, match=rf"^{name}: got .*, allowed: > 0 and finite"):
        soften_at_strains([work], [worked])
