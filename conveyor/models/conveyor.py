"""The conveyor: its parts checked against each other, load cases, scenarios and report options."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from typing import Annotated, Any, Final, Self

from pydantic import Field, ValidationError, model_validator

from conveyor.models.base import Model, Problem, raise_problems
from conveyor.models.bulk_sections import skirted_areas
from conveyor.models.cases import LoadCase, duplicate_case_names
from conveyor.models.part_conflicts import CONFLICTS
from conveyor.models.parts import ConveyorParts
from conveyor.models.report import Report
from conveyor.models.reversal import reversal_problems
from conveyor.models.scenarios import Scenario, scenario_problems
from conveyor.models.uncertain_inputs import Uncertainty
from conveyor.reuse import part_key
from conveyor.units import si, text


class Conveyor(ConveyorParts):
    """A belt conveyor as its designers list it.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.load("examples/specs/overland.yaml")
    Conveyor("Overland coal, 5.2 km": 2400 t/h over 5200 m, lift 62.09 m, belt 1200 mm, 5 m/s)
    """

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

    def __repr__(self) -> str:
        route, belt = self.route, self.belt
        return (
            f'Conveyor("{self.name}": {text(self.material.flow)} over {route.length:.4g} m, lift {route.rise:z.4g} m, '
            f"belt {text(belt.width)}, {text(belt.speed)})"
        )

    def __str__(self) -> str:
        return repr(self)

    @model_validator(mode="after")
    def _parts_fit(self) -> Self:
        raise_problems("Conveyor", [problem for check in CHECKS for problem in check(self)], self.report.units)
        return self

    def with_parts(self, parts: Mapping[str, Model], passed: dict[Hashable, None]) -> Conveyor:
        """Copy with other parts of the same kinds, each already checked on its own.

        Parameters
        ----------
        parts : mapping of str to Model
            By the name of their field.
        passed : dict
            Checks passed in earlier calls, with the parts read; new ones are added.

        Raises
        ------
        InputError
            The parts do not fit each other; every refusal on its own line.
        """
        made = Conveyor.model_construct(self.model_fields_set | set(parts), **{**dict(self), **parts})
        new = {
            key: check
            for check, reads in CHECKS.items()
            if (key := (check, *(part_key(getattr(made, name)) for name in reads))) not in passed
        }
        try:
            raise_problems(
                "Conveyor", [problem for check in new.values() for problem in check(made)], made.report.units
            )
        except ValidationError as error:
            refused = self.refusal(error)
        else:
            passed.update(dict.fromkeys(new))
            return made
        raise refused

    def _case_names(self) -> Iterator[Problem]:
        """Refuse load cases that share a name."""
        yield from duplicate_case_names(self.cases)

    def _case_problems(self) -> Iterator[Problem]:
        """Refuse cases and scenarios that ask for sections, drives, a density or a direction it does not have."""
        named = [("cases", i, case.sections) for i, case in enumerate(self.cases)]
        for i, case in enumerate(self.cases):
            if case.loading == "heavy bulk" and self.material.weight_density is None:
                message = 'got "heavy bulk" without material.weight_density; give that, or another loading'
                yield Problem(("cases", i, "loading"), message)
            if case.reversed:
                for problem in reversal_problems(self):
                    message = f"cases[{i}] is reversed: {problem.message}"
                    yield Problem(problem.location, message)
        named += [("scenarios", i, scenario.sections) for i, scenario in enumerate(self.scenarios)]
        for field, i, sections in named:
            for j, name in enumerate(sections):
                yield from self.route.section_problem((field, i, "sections", j), name)
        yield from scenario_problems(self.scenarios, self.drive.names)

    def section_on_slope(self, inclination: float) -> float:
        """Largest bulk cross-section [m²] at an inclination [rad] (ISO 5048)."""
        angle = si(self.material.surcharge_angle)
        largest = self.idlers.carry.shape.largest_section(self.belt_width, self.material.surcharge)
        return largest.on_slope(inclination, surcharge_angle=angle)

    @property
    def steepest_for_bulk(self) -> float:
        """Largest slope that the bulk is carried on [rad]: as given, else usual of trough or pipe."""
        given = self.material.max_slope
        return self.idlers.carry.shape.steepest if given is None else si(given)

    @property
    def skirted_areas(self) -> dict[str, float]:
        """Bulk cross-sections of sections wholly between skirts of known height [m²], by name."""
        return skirted_areas(self)

    @property
    def lowest_temperature(self) -> float:
        """Lowest temperature of covers and air, as given, in the cases and in the duty [K]."""
        cases = [si(each) for case in self.cases for each in case.temperatures]
        bars = [si(bar.temperature) for bar in self.duty if bar.temperature is not None]
        return min(self.temperature, self.air_temperature, *cases, *bars)

    @property
    def flooded_section(self) -> float:
        """Bulk cross-section of a level belt heaped from edge to edge, or between skirts, or of a full pipe [m²]."""
        flooded = self.idlers.carry.shape.flooded_section(self.belt_width, self.material.surcharge)
        return max([flooded.area, *self.skirted_areas.values()])


CHECKS: Final[Mapping[Callable[[Any], Iterator[Problem]], tuple[str, ...]]] = {
    **CONFLICTS,
    Conveyor._case_names: ("cases",),  # noqa: SLF001 of this module
    Conveyor._case_problems: ("cases", "drive", "idlers", "material", "route", "scenarios"),  # noqa: SLF001
}
"""Checks across fields, and the fields that each check reads."""
