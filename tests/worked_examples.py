"""Analyses and studies of the example specs, calculated once for all tests of a process."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import conveyor
from conveyor.results.analysis import Analysis, Studies, analyse_studies

SPECS = Path(__file__).parent.parent / "examples" / "specs"


@cache
def worked_example(stem: str) -> tuple[Analysis, Studies]:
    """Analysis beside its studies, as `power` shows it, and the studies, of an example by its name without ending."""
    result = conveyor.analyse(conveyor.load(SPECS / f"{stem}.yaml"))
    asked = analyse_studies(result.conveyor, result)
    return result.at_common_take_up(asked), asked
