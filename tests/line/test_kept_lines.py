"""Lines are kept by the parts of a spec they are made of: what a line reads, its key holds."""

from __future__ import annotations

from pathlib import Path

import pytest

import conveyor
from conveyor.line.stretches import CurveLoads
from conveyor.models.base import Model
from conveyor.pipeline import (  # how lines are kept is nowhere to be seen but in time
    ReuseCache,
    _BatchContext,
)

SPECS = sorted((Path(__file__).parents[2] / "examples" / "specs").glob("*.yaml"))
LOOKED_INTO = ("", "belt", "belt.top_cover", "belt.bottom_cover", "idlers", "ambient")
RUBBER = {"belt.line_mass", "belt.model_dump_json"}
"""What the key reads of a belt as a whole: its mass, and every field but the compounds."""


class Spied:
    """A part of a spec that notes which of its fields are read."""

    def __init__(self, part: Model, path: str, read: set[str]) -> None:
        self._part, self._path, self._read, self._below = part, path, read, {}

    def __getattr__(self, name):
        if name in self._below:
            return self._below[name]
        kind = type(self._part)
        path = f"{self._path}.{name}".lstrip(".")
        if name not in kind.model_fields and not self._path and isinstance(vars(kind).get(name), property):
            return vars(kind)[name].fget(self)
        value = getattr(self._part, name)
        if path in LOOKED_INTO:
            value = self._below[name] = Spied(value, path, self._read)
        else:
            self._read.add(path)
        return value


@pytest.mark.parametrize("path", SPECS, ids=[path.stem for path in SPECS])
def test_a_line_reads_nothing_that_its_key_does_not_hold(path):
    """Found the second time, a line costs the reading of its key; made the first time, no more may be read."""
    read, kept = set(), ReuseCache()
    given = Spied(conveyor.load(path), "", read)
    made = _BatchContext(None, [], None, kept)._line_without_drag(given, CurveLoads())
    in_making = set(read)
    read.clear()
    again = _BatchContext(None, [], None, kept)._line_without_drag(given, CurveLoads())
    assert again is made
    fields = {one for one in in_making - read if not one.startswith("belt.")}
    assert not fields, "read by a line, not in the key of pipeline._Shared._still"
    rubber = {one for one in in_making if one.startswith("belt.") and "compound" in one}
    belt = {one for one in in_making if one.startswith("belt.")} - RUBBER
    assert not rubber
    assert belt <= {f"belt.{name}" for name in conveyor.models.Belt.model_fields} | {
        f"belt.{cover}.thickness" for cover in ("top_cover", "bottom_cover")
    }
    assert in_making & RUBBER == RUBBER
