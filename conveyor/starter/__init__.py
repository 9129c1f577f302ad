"""Starter specs: the important fields with comments on meaning and defaults."""

from __future__ import annotations

from conveyor.starter.examples import EXAMPLES, example
from conveyor.starter.values import KINDS, Kind, values
from conveyor.starter.write import quoted, written

__all__ = ["EXAMPLES", "KINDS", "Kind", "example", "quoted", "values", "written"]
