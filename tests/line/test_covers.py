"""Working strains read among three speeds, and what compounds compared on one conveyor share."""

from __future__ import annotations

import pytest

from conveyor import shelf
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.indentation import resolved_relaxation_times, softening
from conveyor.indentation.softening import STRAIN_RTOL
from conveyor.line import covers
from conveyor.models.variants import crossed_settings, with_compound
from conveyor.pipeline import calculate_many
from conveyor.reuse import ReuseCache
from conveyor.spec import load
from conveyor.units import quantity

SPEEDS = ("4.5 m/s", "5 m/s", "5.6 m/s", "6.3 m/s", "7.2 m/s")


@pytest.fixture(scope="module")
def line():
    given = load("examples/specs/overland.yaml")
    return given.replace(calculation=given.calculation.replace(anchor="off"))  # tests have covers of their own


@pytest.fixture
def solved(monkeypatch):
    """How many covers are solved at their own strain, call by call."""
    counts = []

    def counted(works):
        counts.append(len(works))
        return softening.soften_covers(works)

    monkeypatch.setattr(covers, "soften_covers", counted)
    return counts


def calculated(line, speeds, *, runs=(), kept=None):
    at = [quantity("0 degC", "temperature")]
    settings = crossed_settings(line, at, [quantity(speed, "speed") for speed in speeds])
    answers = calculate_many([Variant(one.conveyor, one.temperature) for one in settings], 1e-4, runs=runs, kept=kept)
    assert all(isinstance(one, CalculatedConveyor) for one in answers)
    return answers


def strains(results, strand):
    return [one.contacts.covers[strand].strain for one in results]


def test_strains_between_three_speeds_are_those_found_at_each(line, solved):
    alone = calculated(line, SPEEDS)
    assert sum(solved) == 2 * len(SPEEDS)  # two strands
    solved.clear()
    read = calculated(line, SPEEDS, runs=[range(len(SPEEDS))])
    assert sum(solved) == 2 * 3
    for strand in ("carry", "return"):
        for one, other in zip(strains(read, strand), strains(alone, strand), strict=True):
            assert one.strain == pytest.approx(other.strain, rel=STRAIN_RTOL)
            assert one.frequency == pytest.approx(other.frequency, rel=STRAIN_RTOL)
            assert one.line_load == other.line_load
    for one, other in zip(read, alone, strict=True):  # indentation goes as a small power of the strain
        assert one.balance.forces.indentation == pytest.approx(other.balance.forces.indentation, rel=1e-3)


def test_few_speeds_and_speeds_far_apart_have_each_their_own_strain(line, solved):
    calculated(line, SPEEDS[:4], runs=[range(4)])
    assert sum(solved) == 2 * 4
    solved.clear()
    calculated(line, ("4.5 m/s", "5 m/s", "6 m/s", "9.1 m/s", "9.5 m/s"), runs=[range(5)])
    assert sum(solved) == 2 * 5


def test_a_strain_that_bends_too_much_is_found_at_each_speed(line, solved, monkeypatch):
    monkeypatch.setattr(covers, "STRAIN_INTERPOLATION_TOLERANCE", 1e-9)  # of what a parabola may miss
    calculated(line, SPEEDS, runs=[range(len(SPEEDS))])
    assert sum(solved) == 2 * len(SPEEDS)


def test_compounds_of_the_bottom_cover_share_the_line_and_the_return_rolls(line):
    kept = ReuseCache()
    one, other = (
        calculated(with_compound(line, shelf.compound(name), "bottom"), SPEEDS[:1], kept=kept)[0]
        for name in ("standard-cover", "low-rolling-resistance-cover")
    )
    assert one.line.strands is other.line.strands
    assert one.contacts.covers["return"] is other.contacts.covers["return"]
    assert set(one.contacts.curves_of("return")) == set(other.contacts.curves_of("return"))
    assert not set(one.contacts.curves_of("carry")) & set(other.contacts.curves_of("carry"))
    assert one.contacts.covers["carry"].series is not other.contacts.covers["carry"].series


def test_the_fastest_time_resolved_is_that_of_the_roll_that_resolves_most(line):
    """Of the middle roll and of the wings, each at its least load: none may lose terms of its rubber."""
    (found,) = calculated(line, SPEEDS[1:2])
    cover = found.contacts.covers["carry"]
    work = covers.CoverLoading(found.line, "carry", cover, line.belt.bottom_cover.compound, found.temperature)
    each = [
        resolved_relaxation_times(
            covers.roll_contact(found.line, kind, cover), kind.lowest, covers.TERM_MERGE_SHARE * 1e-4
        )
        for kind in work.kinds
    ]
    fastest, slowest = covers.resolved_time_range(work, 1e-4)
    assert len({first for first, _ in each}) > 1
    assert fastest == pytest.approx(min(first for first, _ in each), rel=1e-12)
    assert slowest == pytest.approx(each[0][1], rel=1e-12)  # by the cover and the speed, alike for all
