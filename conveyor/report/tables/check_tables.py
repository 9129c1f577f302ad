"""Checks, as given and in every load case, and remarks."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Final, NamedTuple

from conveyor.assessment import Assessment
from conveyor.checks import Check, governing_by_criterion
from conveyor.remarks.assumptions import method_summary
from conveyor.report.json_keys import JsonObject, choice_key, number_key, text_key, value_key
from conveyor.report.table_model import Column, PagePlacement, Table, remark_table
from conveyor.studies.load_cases import AS_GIVEN
from conveyor.units import System
from conveyor.units.presentation import display_unit
from conveyor.units.quantity_kinds import NO_UNIT


class CheckRow(NamedTuple):
    """A check as text; `leads` if it governs its criterion."""

    subject: str
    found: str
    asked: str
    margin: float | None
    case: str
    verdict: str
    leads: bool

    @classmethod
    def of(cls, check: Check, system: System, *, leads: bool = False, not_sought: bool = False) -> CheckRow:
        """Write a check in a system of units; `not_sought`: no worse loading was searched for."""
        name, calculated, asked = (said.text(system) for said in (check.name, check.found, check.asked))
        case = AS_GIVEN if check.case is None else check.case.text(system)
        if not_sought:
            case += "; other loadings not searched"
        margin = None if check.verdict == "not checked" else check.margin
        return cls(name, calculated, asked, margin, case, check.verdict, leads)


_CHECK_COLUMNS: Final = (
    Column("check", "text", "subject"),
    Column("calculated", "text", "found", key="found"),
    Column("required", "text", "asked", key="asked"),
    Column("margin", "margin", "margin"),
)
_CASE_COLUMN: Final = Column("case", "text", "case")
_VERDICT_COLUMN: Final = Column("verdict", "verdict", "verdict")


def check_table(checks: tuple[Check, ...], system: System, not_sought: Collection[str] = ()) -> Table:
    """Checks of the governing case: calculated, required, verdict.

    `not_sought`: keys for which no worse loading was searched for.
    """
    first = governing_by_criterion(checks)
    unsought = not_sought if any(check.case is not None for check in checks) else ()
    rows = tuple(
        CheckRow.of(check, system, leads=any(check is one for one in first), not_sought=check.key in unsought)
        for check in checks
    )
    caption = "Calculated against required; of all calculated cases the least margin"
    note = "margin: reserve over the limit; least of all calculated cases"
    of_case = (_CASE_COLUMN,) if any(row.case != AS_GIVEN for row in rows) else ()
    page, columns = (PagePlacement("checks", caption),), (*_CHECK_COLUMNS, *of_case, _VERDICT_COLUMN)
    return Table("checks", "Checks and notes", "Checks", columns, rows, page, note)


_OF_CASES: Final = (_CASE_COLUMN, *_CHECK_COLUMNS, _VERDICT_COLUMN)


def case_checks(every: tuple[Check, ...], system: System) -> Table:
    """Every criterion in every load case."""
    rows = tuple(CheckRow.of(check, system) for check in every if check.case is not None)
    heading = "Every criterion in every load case"
    return Table("case_checks", "Case checks", heading, _OF_CASES, rows, named=2, printed=False)


def case_failures(every: tuple[Check, ...], system: System) -> Table:
    """Criteria that fail in a load case, for the page."""
    rows = tuple(CheckRow.of(check, system) for check in every if check.case is not None and check.failed)
    return Table("case_failures", "", "Failed checks by case", _OF_CASES, rows, "load-cases", named=2)


def analysis_remarks(assessment: Assessment) -> Table:
    """Warnings, method, assumptions, and the notes of the spec."""
    own = assessment.own
    return remark_table({
        "warning": [line.text(assessment.system) for line in assessment.warnings],
        "method": method_summary(own),
        "assumption": assessment.assumptions,
        "note of the spec": [line for line in (own.conveyor.notes or "").splitlines() if line.strip()],
    })  # fmt: skip


def _shown_figure(name: str) -> Callable[[tuple[Check, bool]], float | None]:
    """Figure of a check in the unit of reports; None where it is not finite."""

    def shown(pair: tuple[Check, bool]) -> float | None:
        figure: float | None = display_unit(pair[0].kind).shown(_finite_or_none(getattr(pair[0], name)))
        return figure

    return shown


def _finite_or_none(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


CHECK_KEYS: Final = JsonObject(
    lambda pair: pair,
    keys={
        "key": text_key("0.key", "of the criterion, for programs"),
        "subject": text_key(lambda pair: pair[0].subject.text(), "what is checked; the same in every case"),
        "where": text_key(
            lambda pair: pair[0].where or None, "what decides in it: a state of motion, a section", known=False
        ),
        "case": text_key(
            lambda pair: None if pair[0].case is None else pair[0].case.text(),
            "load case and its temperature; null: the conveyor as its spec gives it", known=False,
        ),
        "calculated": number_key(_shown_figure("calculated"), "in `unit`", known=False),
        "relation": choice_key("0.relation", "at least", "at most", of="how calculated must stand to required"),
        "required": number_key(
            _shown_figure("required"), "in `unit`; null where the spec does not say or nothing helps", known=False
        ),
        "unit": text_key(lambda pair: display_unit(pair[0].kind).spelled or NO_UNIT, "- of ratios"),
        "margin": number_key(
            lambda pair: _finite_or_none(pair[0].margin), "over what is required, negative where it fails", known=False
        ),
        "verdict": choice_key(lambda pair: pair[0].verdict.lower(), "pass", "fail", "not checked"),
        "why": text_key(
            lambda pair: None if pair[0].why is None or pair[0].verdict == "pass" else pair[0].why.text(),
            "what to say where it does not pass", known=False,
        ),
        "governs": value_key("1", "boolean", of="whether its margin is the least of its key and subject in all cases"),
    },
)  # fmt: skip
"""Keys of a check and of whether it governs."""


def check_pairs(every: Iterable[Check], governing: Sequence[Check]) -> list[tuple[Check, bool]]:
    """Checks, each with whether it governs."""
    return [(check, any(check is one for one in governing)) for check in every]
