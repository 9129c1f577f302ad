"""Checks as a reader sees them: their words in a system of units."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from conveyor.checks import Check, governing_by_subject
from conveyor.results.analysis import Analysis, Studies


@dataclass(frozen=True)
class Told:
    """A check in words."""

    subject: str
    found: str
    asked: str
    verdict: str


def told(found: Iterable[Check], system: str = "SI") -> list[Told]:
    """Checks in words."""
    return [Told(c.name.text(system), c.found.text(system), c.asked.text(system), c.verdict) for c in found]


def checks(result: Analysis, system: str = "SI", studies: Studies | None = None) -> list[Told]:
    """Those that govern, of a result and of its load cases."""
    cases = () if studies is None or studies.cases is None else studies.cases.checks
    return told(governing_by_subject((*result.checks, *cases)), system)
