"""Checks as a reader sees them: their words in a system of units."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from conveyor.analysis import Analysis, CaseStudy, Studies
from conveyor.checks import Check


@dataclass(frozen=True)
class Told:
    """A check in words."""

    subject: str
    found: str
    asked: str
    verdict: str


def told(found: Iterable[Check], system: str = "SI") -> list[Told]:
    """Checks in words."""
    return [
        Told(c.subject.text(system), c.found.text(system), c.asked.text(system), c.verdict) for c in found
    ]


def checks(result: Analysis, system: str = "SI", studies: Studies | None = None) -> list[Told]:
    """Those of a result, of its load cases and of its load states."""
    cases = () if studies is None or studies.cases is None else studies.cases.checks
    states = () if studies is None or studies.states is None else studies.states.checks
    return told((*result.checks, *cases, *states), system)


def case_checks(study: CaseStudy, system: str = "SI") -> list[Told]:
    """Those of load cases."""
    return told(study.checks, system)
