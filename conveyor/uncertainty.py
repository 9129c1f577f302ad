"""Uncertainty of the power from ranges of the inputs: `conveyor.uncertainty.study(line).table`."""

from __future__ import annotations

from conveyor.results.analysis import UncertaintyStudy
from conveyor.results.analysis import study_ranges as study

__all__ = ["UncertaintyStudy", "study"]
