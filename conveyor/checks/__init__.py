"""Checks of a conveyor: one function for each criterion; the case of the least margin governs it."""

from conveyor.checks.check import (
    BELT_STRENGTH_CRITERIA,
    Check,
    Verdict,
    check_against_limit,
    governing_by_criterion,
    governing_by_subject,
    highest_use,
    pass_or_fail,
    severity_rank,
)
from conveyor.checks.register import rubber_data_suffice, run_checks, unsearched_criteria

__all__ = [
    "BELT_STRENGTH_CRITERIA",
    "Check",
    "Verdict",
    "check_against_limit",
    "governing_by_criterion",
    "governing_by_subject",
    "highest_use",
    "pass_or_fail",
    "rubber_data_suffice",
    "run_checks",
    "severity_rank",
    "unsearched_criteria",
]
