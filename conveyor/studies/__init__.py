"""What a spec asks for beyond one analysis: its load cases, its year, its ranges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

from conveyor.models import Conveyor
from conveyor.studies.cases import CaseStudy, analyse_cases
from conveyor.studies.duty import DutyStudy, analyse_duty
from conveyor.studies.uncertainty import UncertaintyStudy, study

Progress: TypeAlias = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False, repr=False)
class Studies:
    """Studies of one conveyor; None where the spec has nothing to study.

    Attributes
    ----------
    cases : CaseStudy or None
        Of `cases`.
    duty : DutyStudy or None
        Of `operation.duty`.
    uncertainty : UncertaintyStudy or None
        Of `uncertainty`.
    """

    cases: CaseStudy | None = None
    duty: DutyStudy | None = None
    uncertainty: UncertaintyStudy | None = None

    def __repr__(self) -> str:
        held = [name for name in ("cases", "duty", "uncertainty") if getattr(self, name) is not None]
        return f"Studies({', '.join(held) or 'nothing asked for'})"

    def _repr_html_(self) -> str:
        """For notebooks: what there is, one after the other."""
        held = (self.cases, self.duty, self.uncertainty)
        return (
            "".join(study._repr_html_() for study in held if study is not None) or "<p>nothing to study</p>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON, only of what there is; units in the keys."""
        from conveyor.report.study_tables import plain

        return plain(self)


def studies(conveyor: Conveyor, *, progress: Progress | None = None) -> Studies:
    """Calculate what the spec asks for.

    Parameters
    ----------
    conveyor : Conveyor
        With `cases`, `operation.duty` or `uncertainty`, or none of them.
    progress : callable, optional
        Called with the study's name, what is done of it and its whole.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        A variant of the duty or of the ranges has no answer; cases without one are listed in the study.
    """

    def told(name: str) -> Callable[[int, int], None] | None:
        return None if progress is None else partial(progress, name)

    return Studies(
        cases=analyse_cases(conveyor, progress=told("load cases")) if conveyor.cases else None,
        duty=analyse_duty(conveyor, progress=told("duty of a year")) if conveyor.duty else None,
        uncertainty=None
        if conveyor.uncertainty is None
        else study(conveyor, progress=told("ranges of the inputs")),
    )
