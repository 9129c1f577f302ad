"""Result of one criterion, how it is made of two figures, and which result governs."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from typing import Final, Literal

from conveyor.units.sentences import Message, escape_braces, message

Verdict = Literal["pass", "FAIL", "not checked"]


Relation = Literal["at least", "at most"]


_FIGURE_PATTERN: Final = re.compile(r"(?<!{){(?:calculated|required)}(?!})")


_MARGIN_DIGITS: Final = 9
"""Digits of margins, so that rounding does not decide between equals, see `conveyor.loop.ties`."""


_ROUNDING: Final = 10.0**-_MARGIN_DIGITS
"""Share of a limit by which rounding of units and sums may pass it: 0.35 of 400 mm is 140 mm."""


@dataclass(frozen=True)
class Check:
    """Result of one criterion.

    Attributes
    ----------
    key : str
        Key of the criterion in files.
    subject : Message
        What is checked.
    calculated, required : float or None
        Values in SI; None without a figure.
    kind : str
        Kind of quantity of both.
    found, asked : Message
        Both in words, with their units.
    verdict : {"pass", "FAIL", "not checked"}
        "not checked" where the spec lacks data for it.
    why : Message or None
        Message where it fails.
    relation : {"at least", "at most"}
        Relation of the calculated to the required figure.
    where : str
        Governing state of motion or section.
    case : Message or None
        The load case; None for the conveyor as its spec gives it.

    Examples
    --------
    >>> required = message("at most {}", (1.6e6, "power"))
    >>> Check(
    ...     "motor_power",
    ...     message("motor power"),
    ...     1.25e6,
    ...     1.6e6,
    ...     "power",
    ...     message("{}", (1.25e6, "power")),
    ...     required,
    ...     "pass",
    ... )
    Check("motor power": 1,250 kW, at most 1,600 kW: pass)
    """

    key: str
    subject: Message
    calculated: float | None
    required: float | None
    kind: str
    found: Message
    asked: Message
    verdict: Verdict
    why: Message | None = None
    relation: Relation = "at least"
    where: str = ""
    case: Message | None = None

    def __repr__(self) -> str:
        case = "" if self.case is None else f' in "{self.case}"'
        return f'Check("{self.name}"{case}: {self.found}, {self.asked}: {self.verdict})'

    @property
    def failed(self) -> bool:
        """True if the criterion is not met."""
        return self.verdict == "FAIL"

    @property
    def name(self) -> Message:
        """Subject of the check with the governing state or section."""
        if not self.where:
            return self.subject
        return replace(self.subject, words=f"{self.subject.words} ({escape_braces(self.where)})")

    @property
    def margin(self) -> float | None:
        """Relative margin of the calculated to the required figure, positive on the safe side [-].

        Calculated over required less 1 for "at least", 1 less calculated over required for "at most";
        None where a figure is missing, the required one is 0, or both are temperatures, which have no ratio.
        """
        if self.calculated is None or not self.required or self.kind == "temperature":
            return None
        over = (self.calculated - self.required) / abs(self.required)
        return over if self.relation == "at least" else -over

    @property
    def use(self) -> float | None:
        """Utilisation of the limit [-]; None where a figure is missing or 0."""
        if not self.calculated or not self.required:
            return None
        ratio = self.calculated / self.required
        return ratio if self.relation == "at most" else 1.0 / ratio


def highest_use(checks: Iterable[Check], keys: Collection[str]) -> tuple[float | None, Check | None]:
    """Highest utilisation among checks of these keys [-] and its check; None without one."""
    used = [(one.use, one) for one in checks if one.key in keys and one.use is not None]
    return max(used, key=lambda pair: pair[0] or 0.0, default=(None, None))


BELT_STRENGTH_CRITERIA: Final = frozenset({"belt_safety", "belt_rating"})
"""Criteria of belt tension, by strength or rating."""


def pass_or_fail(*, holds: bool) -> Verdict:
    """Return pass or FAIL."""
    return "pass" if holds else "FAIL"


def check_against_limit(  # noqa: PLR0917 reads as the sentence it checks
    key: str,
    subject: str | Message,
    calculated: float,
    relation: Relation,
    required: float | None,
    kind: str,
    *,
    source: str = "",
    wording: Message | None = None,
    asked: Message | None = None,
    holds: bool | None = None,
    missing: str = "",
    why: Message | str | None = None,
    where: str = "",
) -> Check:
    """Check a figure against its limit; at the limit itself, but for rounding, it holds.

    Parameters
    ----------
    key, subject : str
        Key and subject of the criterion.
    calculated, required : float
        Values in SI; `required` is None if unknown.
    relation : {"at least", "at most"}
        Relation of the calculated to the required figure.
    kind : str
        Kind of quantity of both.
    source : str
        Source of the limit.
    wording : Message, optional
        The calculated figure in other words.
    asked : Message, optional
        The required figure in other words.
    holds : bool, optional
        Result, where the figures alone do not decide.
    missing : str
        Message where no limit is known.
    why : Message or str, optional
        Message where it fails; in a str {calculated} and {required} are replaced by the figures.
    where : str
        Governing state or section.
    """
    shown = message("{}", (calculated, kind)) if wording is None else wording
    name = message(subject) if isinstance(subject, str) else subject
    if required is None:
        shortfall = message(missing)
        return Check(key, name, calculated, None, kind, shown, shortfall, "not checked", None, relation, where)
    if holds is None:
        beyond = calculated - required if relation == "at most" else required - calculated
        holds = beyond <= _ROUNDING * abs(required)
    if asked is None:
        asked = message(f"{relation} {{}}{f' ({source})' if source else ''}", (required, kind))
    if isinstance(why, str):
        figures = {"{calculated}": (calculated, kind), "{required}": (required, kind)}
        why = Message(_FIGURE_PATTERN.sub("{}", why), tuple(figures[word] for word in _FIGURE_PATTERN.findall(why)))
    judged = pass_or_fail(holds=holds)
    return Check(key, name, calculated, required, kind, shown, asked, judged, why, relation, where)


def leave_open_unless_failed(check: Check, asked: Message) -> Check:
    """A check whose limit is not all that is asked: not checked where it does not fail, with what is asked in words."""
    return check if check.failed else replace(check, verdict="not checked", required=None, asked=asked, why=None)


def governing_by_subject(every: Iterable[Check]) -> tuple[Check, ...]:
    """Governing check of each criterion and subject, those of one criterion together.

    A failed check goes before a passed one, that before one not checked; then the least margin decides, among equals
    the first.
    """
    groups: dict[str, dict[Message, list[Check]]] = {}
    for check in every:
        groups.setdefault(check.key, {}).setdefault(check.subject, []).append(check)
    return tuple(min(group, key=severity_rank) for of in groups.values() for group in of.values())


def governing_by_criterion(checks: Iterable[Check]) -> tuple[Check, ...]:
    """Governing check of each criterion over all subjects."""
    groups: dict[str, list[Check]] = {}
    for check in checks:
        groups.setdefault(check.key, []).append(check)
    return tuple(min(group, key=severity_rank) for group in groups.values())


def severity_rank(check: Check) -> tuple[int, float, float]:
    """Sort key of a check: the least governs; a failure without margin comes first.

    Among checks of a calculated 0, which has the same margin for any limit, the larger requirement governs; without a
    limit the one without a figure, else the lowest or highest.
    """
    margin, further = check.margin, 0.0
    sign = 1.0 if check.relation == "at least" else -1.0
    if check.required is not None and check.calculated is not None:
        over = sign * (check.calculated - check.required)
        if margin is None:  # temperatures are compared by their difference; a limit of 0 is met by any or by none
            margin = over if check.kind == "temperature" or over == 0.0 else math.copysign(math.inf, over)
        further = 0.0 if check.calculated and check.required else over
    else:
        margin = -math.inf if check.failed else math.inf
        further = -math.inf if check.calculated is None else sign * check.calculated
    order = ("FAIL", "pass", "not checked").index(check.verdict)
    return order, round(margin, _MARGIN_DIGITS), float(f"{further:.{_MARGIN_DIGITS}g}")
