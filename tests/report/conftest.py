"""Analyses and studies of the example specs, calculated once for all tests of the reports."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from conveyor.results.analysis import Analysis, Studies
from tests.worked_examples import worked_example


@pytest.fixture(scope="session")
def studied() -> Callable[[str], tuple[Analysis, Studies]]:
    """Analysis and studies of an example spec, by its name without ending."""
    return worked_example
