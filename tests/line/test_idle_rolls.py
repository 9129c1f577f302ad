"""Rolls that the belt does not touch: no contact, no indentation; the others as with the least load beside them."""

from __future__ import annotations

import pytest

import conveyor
from conveyor.models.fields import with_fields
from conveyor.pipeline import calculate
from conveyor.report.tables.idler_tables import roll_table
from tests.command_line import ROOT

SPEC = ROOT / "examples" / "specs" / "overland.yaml"


def with_middle_roll_loaded(wing):
    """Both wings of the carry sets with a share of all load, by `load_shares` and `belt_shares`."""
    shares = [wing, 1.0 - 2.0 * wing, wing]
    return calculate(
        with_fields(conveyor.load(SPEC), {f"idlers.carry.{kind}_shares": shares for kind in ("load", "belt")})
    )


@pytest.fixture(scope="module")
def idle():
    return with_middle_roll_loaded(0.0)


def test_a_roll_without_load_has_no_contact(idle):
    for stretch in idle.stretches:
        names = [roll.load.name for roll in stretch.rolls]
        assert names == (["middle"] if stretch.stretch.strand == "carry" else [r.name for r in stretch.stretch.loads])
        assert all(stretch.stretch.loads[roll.place] is roll.load for roll in stretch.rolls)


def test_it_is_the_limit_of_a_vanishing_load(idle):
    """A millionth of the load on each wing changes indentation, as the load to 4/3, by less than its estimate."""
    little = with_middle_roll_loaded(1e-6)
    of = [
        sum(sum(force.newtons) for force in one.balance.along if force.key == "indentation") for one in (idle, little)
    ]
    assert of[0] == pytest.approx(of[1], rel=idle.error_estimate + little.error_estimate + 1e-5)


def test_its_drag_is_counted(idle):
    """At no load: less than that of the loaded middle roll, not nothing. The safe side."""
    left, middle, right = idle.line.roll_drags[0]
    assert 0.0 < left < middle
    assert left == pytest.approx(right)


def test_the_report_lists_the_loaded_rolls(idle):
    carry = [row for row in roll_table(idle).rows if row[0].stretch.strand == "carry"]
    assert {row[1].load.name for row in carry} == {"middle"}
