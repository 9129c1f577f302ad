"""A first spec to start from: every field that matters, what it means, and what happens without it."""

from __future__ import annotations

from conveyor.starter.examples import EXAMPLES, example
from conveyor.starter.values import KINDS, Kind, values
from conveyor.starter.write import quoted, written

__all__ = ["EXAMPLES", "KINDS", "Kind", "example", "quoted", "values", "written"]
