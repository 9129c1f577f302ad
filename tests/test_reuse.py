"""The cache of parts: what is found in it is what would be made anew."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.calculated_conveyor import Variant
from conveyor.errors import ConveyorError
from conveyor.line.known_test_factors import KnownTestFactors
from conveyor.line.stretches import CurveLoads
from conveyor.models import Conveyor
from conveyor.models.base import Model
from conveyor.models.fields import with_fields
from conveyor.preparation import Preparation, PreparedLine
from conveyor.reuse import ReuseCache
from conveyor.starter.format_reference import example_value, format_fields
from conveyor.units import is_quantity

SPECS = Path(__file__).parents[1] / "examples" / "specs"


def changes(part: Model, path: str = ""):
    """Every number and switch of a spec by its path, changed a little."""
    for name in type(part).model_fields:
        value, at = getattr(part, name), f"{path}.{name}".lstrip(".")
        if name == "compound":
            continue
        for i, item in enumerate(value if isinstance(value, tuple) else [value]):
            below = f"{at}[{i}]" if isinstance(value, tuple) else at
            if isinstance(item, Model):
                yield from changes(item, below)
            elif is_quantity(item):
                yield below, type(item)(item.magnitude * 1.01 + 1e-6, item.units)
            elif isinstance(item, bool):
                yield below, not item
            elif isinstance(item, float):
                yield below, item * 1.01 + 1e-6


def figures(value):
    """What a line holds, as it can be compared."""
    if dataclasses.is_dataclass(value):
        return [figures(getattr(value, each.name)) for each in dataclasses.fields(value)]
    if isinstance(value, tuple | list):
        return [figures(each) for each in value]
    if isinstance(value, dict):
        return [(key, figures(each)) for key, each in value.items()]
    if type(value).__module__.startswith("conveyor"):
        return [figures(each) for name, each in vars(value).items() if not hasattr(type(value), name)]
    return value.tolist() if isinstance(value, np.ndarray) else value


def line(given, kept):
    (one,) = dict(Preparation(kept).prepare({0: (Variant(given), CurveLoads())})).values()
    return figures(one.line) if isinstance(one, PreparedLine) else str(one)


@pytest.mark.parametrize("name", ["curved", "downhill_brakes"])
def test_a_line_found_is_the_line_made_anew(name):
    """Else a line reads what its key does not hold."""
    spec, kept, tried = conveyor.load(SPECS / f"{name}.yaml"), ReuseCache(), 0
    line(spec, kept)
    for path, value in changes(spec):
        try:
            changed = with_fields(spec, {path: value})
        except ConveyorError:
            continue
        tried += 1
        assert line(changed, kept) == line(changed, ReuseCache()), path
    assert tried > 40


def test_a_field_given_for_the_first_time_makes_a_line_anew():
    """A field that is in none of the parts of a key must be added to it, in `Preparation._line_without_drag`."""
    spec, kept, tried = conveyor.load(SPECS / "curved.yaml"), ReuseCache(), 0
    line(spec, kept)
    for path in format_fields(Conveyor):
        value = None if "[]" in path else example_value(Conveyor, path)
        if value is None:
            continue
        try:
            changed = with_fields(spec, {path: value})
        except ConveyorError:
            continue
        tried += 1
        assert line(changed, kept) == line(changed, ReuseCache()), f"{path}: not in the key of a part"
    assert tried > 150


def test_equal_specs_share_their_parts():
    kept = ReuseCache()
    one, other = (conveyor.load(SPECS / "overland.yaml") for _ in range(2))
    assert one.fingerprint == other.fingerprint
    first, second = (
        dict(Preparation(kept).prepare({0: (Variant(each), CurveLoads())}))[0].line for each in (one, other)
    )
    assert first is second


def test_a_fingerprint_follows_every_change():
    spec = conveyor.load(SPECS / "overland.yaml")
    other = spec.replace(name="other")
    assert other.fingerprint != spec.fingerprint
    assert spec.model_copy(update={"name": "other"}).fingerprint == other.fingerprint
    same = with_fields(spec, {"belt.width": "1.2 m"})
    assert same.belt.fingerprint != spec.belt.fingerprint  # entered in mm
    assert same.replace(belt=spec.belt).fingerprint == spec.fingerprint


def test_a_test_factor_is_solved_once(monkeypatch):
    solved = []

    def solve(compounds, *, softened):
        solved.extend(compounds)
        return [None for _ in compounds if softened in {True, False}]

    monkeypatch.setattr("conveyor.line.known_test_factors.compound_test_factors", solve)
    monkeypatch.setattr(KnownTestFactors, "MOST", 2)
    rubber = conveyor.load(SPECS / "overland.yaml").carry_compound
    known, (one, two, three) = KnownTestFactors(), (rubber.replace(name=name) for name in ("one", "two", "three"))
    known.solve([one, one.replace(name="one"), two], softened=True)
    assert known.of(one, softened=True) is None
    assert [each.name for each in solved] == ["one", "two"]
    known.of(three, softened=True)
    known.of(one, softened=True)
    known.of(two, softened=True)  # the third took its place, as the first was used since
    assert [each.name for each in solved] == ["one", "two", "three", "two"]
    known.of(two, softened=False)
    assert len(solved) == 5


def test_the_cache_holds_the_last_used(monkeypatch):
    monkeypatch.setattr(ReuseCache, "MOST", 2)
    kept, made = ReuseCache(), []
    for part in ("a", "b", "a", "c"):
        kept.once(lambda part=part: made.append(part), "kind", (part,))
    kept.begin()
    for part in ("a", "c", "b"):
        kept.once(lambda part=part: made.append(part), "kind", (part,))
    assert made == ["a", "b", "c", "b"]
