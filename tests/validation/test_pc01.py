"""PC01, a printed pipe conveyor: what docs/printed.md says of its nearly equal friction full and empty, by hand."""

from __future__ import annotations

import math
from importlib import resources
from pathlib import Path

import pytest
from scipy.optimize import brentq

import conveyor
from conveyor.models import LoadCase
from conveyor.models.fields import with_fields
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate

SPEC = Path(str(resources.files("conveyor") / "_reference" / "practice" / "pc01.yaml"))
FULL, EMPTY = 293_730.0, 288_731.0
"""Printed friction [N]: 297.71 kN less the lift of the bulk; 1501.4 kW over 5.2 m/s."""
ANGLES = tuple(math.radians(60.0 * place) for place in range(6))


@pytest.fixture(scope="module")
def spec():
    return conveyor.load(SPEC)


def friction(spec, loading, forming_load):
    """Effective tension less lift [N] with another forming load."""
    given = {f"idlers.{strand}.pipe.forming_load": f"{forming_load} N" for strand in ("carry", "return")}
    result = calculate(with_case(with_fields(spec, given), LoadCase(name=loading, loading=loading)))
    return result, result.balance.forces.total - result.balance.forces.lift


def stiff_ring(weight, forming_load):
    """Loads of six rolls on which a stiff pipe rests as on equal springs, each pressing or bare [N]."""

    def loads(moved):
        return [max(0.0, forming_load + moved * math.cos(angle)) for angle in ANGLES]

    def left(moved):
        return math.fsum(load * math.cos(angle) for load, angle in zip(loads(moved), ANGLES, strict=True)) - weight

    return loads(brentq(left, 0.0, weight))


def test_the_printed_bulk_adds_hardly_any_friction():
    """5.0 kN for 2,110 kN of bulk."""
    bulk = 1000.0 / 3.6 / 5.2 * 9.80665 * 4030.66
    assert bulk == pytest.approx(2.11e6, rel=1e-3)
    more, accelerating = FULL - EMPTY, 1000.0 / 3.6 * 5.2
    assert more == pytest.approx(5.0e3, abs=50.0)
    assert accelerating == pytest.approx(1.44e3, abs=10.0)


def test_no_forming_load_makes_both_where_bulk_loads_the_lower_rolls_alone(spec):
    """163 N is found by indentation as the load to 4/3; the contacts have it within 3 %."""
    full, empty = (friction(spec, loading, 163)[1] for loading in ("full", "empty"))
    assert full == pytest.approx(FULL, rel=0.03)
    assert empty / full == pytest.approx(0.82, abs=0.01)


def test_a_stiff_pipe_on_all_six_rolls_would_have_both(spec):
    """With the forming load that makes the full belt right the empty one comes out at 97 % of it."""
    (result, whole), (_, bare) = (friction(spec, loading, 60) for loading in ("full", "empty"))
    forces = {force.key: math.fsum(force.newtons) for force in result.balance.along}
    stretches = result.line.stretches
    here = [load.force for stretch in stretches for load in stretch.loads]
    steady = whole - forces["indentation"] - forces["misalignment"]
    weights = [math.fsum(math.cos(a) * load.force for a, load in zip(ANGLES, _from_below(s.loads), strict=True))
               for s in stretches]  # fmt: skip
    belt = weights[1]

    def of_ring(carried, forming_load, rest):
        loads = [load for weight in (carried, belt) for load in stiff_ring(weight, forming_load)]
        rolled = sum(load ** (4.0 / 3.0) for load in loads) / sum(load ** (4.0 / 3.0) for load in here)
        return rest + forces["indentation"] * rolled + forces["misalignment"] * sum(loads) / sum(here)

    found = brentq(lambda forming_load: of_ring(weights[0], forming_load, steady) - FULL, 100.0, 1000.0)
    assert found == pytest.approx(391.0, abs=5.0)
    bulk_alone = 1000.0 / 3.6 * 5.2  # acceleration, which the empty belt has none of
    assert of_ring(belt, found, steady - bulk_alone) / FULL == pytest.approx(0.97, abs=0.006)
    assert bare / whole < 0.82  # the lever, for comparison


def _from_below(loads):
    """Loads of a panel from the bottom roll round."""
    by_name = {load.name: load for load in loads}
    return [by_name[name] for name in ("bottom", "lower right", "upper right", "top", "upper left", "lower left")]
