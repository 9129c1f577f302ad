"""A check and its verdict."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["pass", "FAIL", "not checked"]


@dataclass(frozen=True)
class Check:
    """One check.

    Attributes
    ----------
    subject : str
        What is checked.
    found, asked : str
        What it is, and what it should be, with units.
    verdict : {"pass", "FAIL", "not checked"}
        "not checked" where the spec does not say what is needed for it.
    """

    subject: str
    found: str
    asked: str
    verdict: Verdict


def verdict(*, holds: bool) -> Verdict:
    """Return pass or FAIL."""
    return "pass" if holds else "FAIL"
