"""The whole conveyor: its parts, checked against each other, and what is asked of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Self

from pydantic import Field, model_validator

from conveyor.models.base import Problem, refuse
from conveyor.models.cases import LoadCase, named_once
from conveyor.models.checks import conflicts, cross_sections
from conveyor.models.parts import ConveyorParts
from conveyor.models.report import Report
from conveyor.models.scenarios import Scenario, scenario_problems
from conveyor.models.uncertainty import Uncertainty


class Conveyor(ConveyorParts):
    """A belt conveyor as its designers list it."""

    cases: Annotated[tuple[LoadCase, ...], Field(max_length=100)] = ()
    """Load cases to calculate beside the conveyor as given."""
    scenarios: Annotated[tuple[Scenario, ...], Field(max_length=50)] = ()
    """Starts and stops that `conveyor dynamics` follows through time; standard ones without."""
    uncertainty: Uncertainty | None = None
    """Ranges of what is not known exactly."""
    report: Report = Report()
    """What reports carry on their cover, and their units."""
    notes: str | None = None
    """Anything worth keeping; printed in reports, no effect on figures."""

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        refuse("Conveyor", [*conflicts(self), *named_once(self.cases), *self._case_problems()])
        return self

    def _case_problems(self) -> Iterator[Problem]:
        """Every section that a case or a scenario loads exists, and every drive that a scenario names."""
        named = [("cases", i, case.sections) for i, case in enumerate(self.cases)]
        named += [("scenarios", i, scenario.sections) for i, scenario in enumerate(self.scenarios)]
        for field, i, sections in named:
            for j, name in enumerate(sections):
                yield from self.route.section_problem((field, i, "sections", j), name)
        yield from scenario_problems(self.scenarios, self.drive.names)

    @property
    def cross_sections(self) -> tuple[float, float] | None:
        """Cross-section of the bulk and the largest the belt holds (ISO 5048) [m²]; None where there is no rule."""
        return cross_sections(self)
