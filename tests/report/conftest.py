"""Analyses and studies of the example specs, calculated once for all tests of the reports."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import conveyor
from conveyor.analysis import Analysis, Studies, studies

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"


@cache
def _studied(stem: str) -> tuple[Analysis, Studies]:
    result = conveyor.analyse(conveyor.load(SPECS / f"{stem}.yaml"))
    asked = studies(result.conveyor, result)
    return result.beside(asked), asked


@pytest.fixture(scope="session")
def studied() -> Callable[[str], tuple[Analysis, Studies]]:
    """Analysis and studies of an example spec, by its name without ending."""
    return _studied
