"""PC01, a printed pipe conveyor: what docs/printed.md says of its nearly equal friction full and empty, by hand."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import pytest

import conveyor
from conveyor.models import LoadCase
from conveyor.models.fields import with_fields
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate

SPEC = Path(str(resources.files("conveyor") / "_reference" / "practice" / "pc01.yaml"))
FULL, EMPTY = 293_730.0, 288_731.0
"""Printed friction [N]: 297.71 kN less the lift of the bulk; 1501.4 kW over 5.2 m/s."""


@pytest.fixture(scope="module")
def spec():
    return conveyor.load(SPEC)


def calculated(spec, loading, stiffness):
    """Result with another stiffness across the belt [N m²/m]."""
    given = with_fields(spec, {"belt.transverse_stiffness": f"{stiffness} N*m"})
    return calculate(with_case(given, LoadCase(name=loading, loading=loading)))


def friction(result):
    """Effective tension less lift [N]."""
    return result.balance.forces.total - result.balance.forces.lift


def test_the_printed_bulk_adds_hardly_any_friction():
    """5.0 kN for 2,110 kN of bulk."""
    bulk = 1000.0 / 3.6 / 5.2 * 9.80665 * 4030.66
    assert bulk == pytest.approx(2.11e6, rel=1e-3)
    more, accelerating = FULL - EMPTY, 1000.0 / 3.6 * 5.2
    assert more == pytest.approx(5.0e3, abs=50.0)
    assert accelerating == pytest.approx(1.44e3, abs=10.0)


def test_no_stiffness_makes_both(spec):
    """With 8.2 N m²/m the full belt has the printed friction, the empty one 85 % of it."""
    full, empty = (friction(calculated(spec, loading, 8.2)) for loading in ("full", "empty"))
    assert full == pytest.approx(FULL, rel=0.01)
    assert empty / full == pytest.approx(0.85, abs=0.01)


def test_bulk_loads_the_lower_rolls_and_hardly_relieves_the_upper_ones(spec):
    """Not even in a belt of four times that stiffness: an elastic pipe does not lift itself from its upper rolls."""
    for stiffness in (8.2, 32.8):
        full, empty = (calculated(spec, loading, stiffness).line.stretches[0] for loading in ("full", "empty"))
        more = {one.name: one.force - bare.force for one, bare in zip(full.loads, empty.loads, strict=True)}
        bulk = 1000.0 / 3.6 / 5.2 * 9.80665 * 1.2
        assert sum(more[name] for name in ("lower left", "bottom", "lower right")) > 1.1 * bulk
        assert abs(sum(more[name] for name in ("upper left", "top", "upper right"))) < 0.05 * bulk
