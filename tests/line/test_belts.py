"""A belt that gives on a conveyor: its limits, what is read between tensions, the closed loop, what is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conveyor.errors import InputError, NoSolutionError
from conveyor.indentation import indentation_resistance
from conveyor.line import belt_contacts
from conveyor.line.belt_contacts import STRETCH_QUADRATURE, BeltContacts
from conveyor.loop.tension_coupling import pull_per_width
from conveyor.models import Conveyor, RubberCompound
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.rubber import PronySeries
from conveyor.spec import load
from conveyor.units import quantity, si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-4


def given(carcass=None, **calculation) -> Conveyor:
    conveyor = load(SPECS / "overland.yaml")
    asked = {"support": "belt", "rtol": RTOL, "strain": "off"} | calculation
    changed = conveyor.belt.replace(carcass=conveyor.belt.carcass.replace(**(carcass or {})))
    return conveyor.replace(belt=changed, calculation=conveyor.calculation.replace(**asked))


@pytest.fixture(scope="module")
def found():
    return calculate(given())


def test_a_stiff_carcass_does_not_give():
    # a tensioned beam under a load w is curved by w/(2 sqrt(T D)), which relieves the roll's 1/R; friction changes no
    # faster than the radius: at 8.3 kN m, 90 kN/m and at most 5 kN/m under R 80 mm, 5·0.08/(2 sqrt(90·8.3)) = 0.73 %
    stiff = calculate(given({"bending_stiffness": quantity("10000 N*m^2")}))
    for give in stiff.contacts.gives:
        assert -0.0073 < give.change < 0.0


def test_a_belt_that_loses_nothing_has_no_indentation():
    """Elastic covers and carcass give and come back: every roll's indentation is zero, without a logarithm of it."""
    line = load(SPECS / "shuttle.yaml")
    elastic = RubberCompound.from_series(
        PronySeries(6e6, [], []), name="elastic", reference_temperature=line.temperature
    )
    belt = line.belt.replace(
        bottom_cover=line.belt.bottom_cover.replace(compound=elastic),
        top_cover=line.belt.top_cover.replace(compound=elastic),
    )
    gives = line.replace(belt=belt, calculation=line.calculation.replace(support="belt"))
    assert calculate(gives).balance.forces.indentation == pytest.approx(0.0, abs=1e-9)


def test_what_is_read_between_tensions_is_what_is_solved_there(found):
    contacts = found.contacts
    for rolls in (contacts.rolls[0], contacts.rolls[-1]):
        curve = rolls[0].curve
        load = 0.8 * curve.highest
        alone = indentation_resistance(curve.contact, load, 1e-6)
        assert curve.at(load).resistance == pytest.approx(float(alone.resistance), rel=RTOL)
        assert float(curve.resistance(load)) == pytest.approx(float(alone.resistance), rel=RTOL)
        assert curve.at(load).half_width == pytest.approx(float(alone.half_width), rel=10.0 * RTOL)
        read = curve.at(load)
        assert read.peak_pressure == pytest.approx(float(alone.peak_pressure), rel=read.peak_error)
        assert curve.contact.pull not in [one.contact.pull for one in curve.solved]
    assert found.error_estimate <= RTOL


def test_order_cost_and_frequencies_are_those_of_the_nearest_tension(found):
    among = found.contacts.rolls[0][0].curve.among
    assert len(among.curves) > 2
    for one, tension in zip(among.curves, among.tensions.tolist(), strict=True):
        for beside in (0.999 * tension, 1.001 * tension):
            assert among.under(beside).curve is one.curve


def test_a_stretch_feels_the_mean_over_its_tensions(found):
    # three Gauss points integrate a fifth power: what single solves at seven places give is the same
    contacts, i = found.contacts, 0
    kind = next(kind for kind in contacts.line.kinds if kind.strand == "carry")
    place = next(k for k, (stretch, _) in enumerate(kind.rolls) if stretch == i)
    nodes, weights = np.polynomial.legendre.leggauss(7)
    low, high = contacts.pulls[i, 0], contacts.pulls[i, -1]
    along = 0.5 * (low + high) + 0.5 * (high - low) * nodes / (2.0 * STRETCH_QUADRATURE[0][-1])
    curve = contacts.rolls[i][kind.rolls[place][1]].curve
    loads, across = kind.rolls[place], slice(kind.starts[place], kind.starts[place] + 8)
    each = [curve.among.under(float(tension)).resistance(kind.line_loads[across]) for tension in along]
    level = contacts.covers["carry"].test_factor.factor(kind.line_loads[across])
    expected = 0.5 * weights @ np.array(each) @ (level * kind.weights[across])
    assert contacts.rolls[i][loads[1]].resistance == pytest.approx(float(expected), rel=1e-9)


def test_tension_and_indentation_agree(found):
    assert isinstance(found.contacts, BeltContacts)
    again = pull_per_width(found.line, found.balance.equilibrium.steady, STRETCH_QUADRATURE[0])
    largest = found.balance.tensions.largest / found.line.belt.width
    assert again == pytest.approx(found.contacts.pulls, abs=RTOL * largest)
    assert found.convergence.has_converged(RTOL)
    assert found.balance.forces.indentation == pytest.approx(
        sum(give.force for give in found.contacts.gives), rel=1e-12
    )


def test_splitting_a_section_changes_nothing(found):
    route = found.conveyor.route
    old = route.sections[3]
    halves = [
        old.replace(name=name, length=quantity(f"{si(old.length) / 2.0!r} m"), lift=quantity(f"{old.rise / 2.0!r} m"))
        for name in ("one", "other")
    ]
    sections = [*route.sections[:3], *halves, *route.sections[4:]]
    split = calculate(found.conveyor.replace(route=route.replace(sections=sections)))
    assert split.balance.forces.indentation == pytest.approx(found.balance.forces.indentation, rel=RTOL)


def test_the_flexure_of_the_belt_is_in_its_indentation(found):
    forces = {force.key: force for force in found.balance.along}
    bulk = np.array([stretch.bulk_mass > 0.0 for stretch in found.line.stretches])
    assert np.all(forces["flexure"].newtons[~bulk] == 0.0)
    # at the largest sag load and sag are linear in the load: what is left is the bulk's share of it
    held = {force.key: force for force in calculate(given(support="confined")).balance.along}
    share = [stretch.bulk_mass / stretch.line_mass for stretch in found.line.stretches]
    assert forces["flexure"].at_sag_limit == pytest.approx(held["flexure"].at_sag_limit * np.array(share), rel=1e-12)


def test_a_carcass_that_loses_adds_what_it_loses(found):
    for give in found.contacts.gives:
        assert give.shares["carcass"] == 0.0
        assert sum(give.shares.values()) == pytest.approx(1.0, rel=1e-12)
    lossy = calculate(given({"bending_loss": 0.2}))
    for before, after in zip(found.contacts.gives, lossy.contacts.gives, strict=True):
        assert after.shares["carcass"] > 0.0
        # what the rubber loses hardly changes: its share of the larger whole does
        assert after.force * (1.0 - after.shares["carcass"]) == pytest.approx(before.force, rel=0.02)


def test_a_belt_turned_over_runs_on_its_bottom_cover():
    conveyor = given()
    turned = calculate(conveyor.replace(route=conveyor.route.replace(turned_over=True)))
    top = si(conveyor.belt.top_cover.thickness)
    assert {cover.opposite_cover[0] for cover in turned.contacts.covers.values()} == {top}


def test_what_stands_in_is_said(found):
    told = " | ".join(one.words for one in analysis_warnings(found, ()))
    for words in (
        "the belt gives under the carry rolls",
        "bending_stiffness not given: 15",
        "stiffness not given",
        "flexure of the belt by load and sag",
        "bending_loss is 0: no figure holds what the carcass loses",
    ):
        assert words in told


def test_what_a_belt_cannot_be_is_refused():
    with pytest.raises(InputError, match=r"flexure_share.*holds the flexure of the belt"):
        given(flexure_share=quantity("11 %"))
    with pytest.raises(InputError, match=r"carcass\.stiffness.*missing"):
        given({"strength": None, "rating": quantity("200 N/mm"), "kind": "aramid"})


def test_a_slack_belt_has_no_answer(found):
    steady = found.balance.equilibrium.steady
    slack = replace(steady, starts=steady.starts - steady.largest)
    with pytest.raises(NoSolutionError, match="no tension is left to hold the belt in section"):
        pull_per_width(found.line, slack, STRETCH_QUADRATURE[0])


def test_curves_of_two_lines_reach_over_the_loads_and_tensions_of_both():
    light, heavy = ((100.0, 200.0), (20e3, 70e3)), ((150.0, 900.0), (50e3, 60e3))
    both = ((100.0, 900.0), (20e3, 70e3))
    assert belt_contacts._joint_range(light, heavy) == belt_contacts._joint_range(heavy, light) == both
