"""Starter specs: the important fields with comments on meaning and defaults."""

from __future__ import annotations

from conveyor.starter.full_examples import EXAMPLES, example_files
from conveyor.starter.starter_data import KINDS, Kind, starter_values
from conveyor.starter.starter_writer import quote_path, starter_text

__all__ = ["EXAMPLES", "KINDS", "Kind", "example_files", "quote_path", "starter_text", "starter_values"]
