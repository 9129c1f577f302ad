"""Load cases: which sections bear bulk, at which speeds and temperatures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.models.base import Model, Name, Problem, Switch, raise_problems
from conveyor.models.operation import BeltSpeed, EarthTemperature
from conveyor.units import Bounds, Fraction, Quantity, text

Loading = Literal["as given", "full", "empty", "inclines only", "declines only", "part load", "heavy bulk", "sections"]

STANDARD_LOADINGS: Final[tuple[Loading, ...]] = ("full", "empty", "inclines only", "declines only")
"""Loadings that every conveyor with inclines and declines is checked for."""


class LoadCase(Model):
    """A loading of the conveyor, at every one of its speeds and temperatures."""

    name: Name
    """Each its own."""
    loading: Loading = "as given"
    """Sections that bear bulk: as given (part load, heavy bulk too), all, none, those up or down only, those named."""
    sections: Annotated[tuple[Name, ...], Field(max_length=20000)] = ()
    """The sections that bear bulk, for loading "sections"."""
    share: Annotated[Fraction, Bounds(gt="0 %", le="200 %")] | None = None
    """Mass flow over material.flow, for part load (a surge is above 100 %)."""
    reversed: Switch = False
    """Whether the belt runs the other way, from head to tail; up is then what was down."""
    temperatures: Annotated[tuple[EarthTemperature, ...], Field(max_length=100)] = ()
    """Of the belt's covers; that of ambient without. The air keeps ambient's distance to them."""
    speeds: Annotated[tuple[BeltSpeed, ...], Field(max_length=100)] = ()
    """Of the belt; belt.speed without."""

    @model_validator(mode="after")
    def _check_share_of_part_load(self) -> Self:
        problems = []
        if self.loading == "part load" and self.share is None:
            problems.append(Problem(("share",), 'missing: loading "part load" needs its share of material.flow'))
        elif self.loading != "part load" and self.share is not None:
            message = f'got {text(self.share)} with loading "{self.loading}"; remove it, or set loading to "part load"'
            problems.append(Problem(("share",), message))
        if (self.loading == "sections") != bool(self.sections):
            message = 'missing: loading "sections" needs their names'
            if self.sections:
                message = f'got {len(self.sections)} names with loading "{self.loading}"; set loading to "sections"'
            problems.append(Problem(("sections",), message))
        raise_problems("LoadCase", problems)
        return self


def standard_cases(
    temperatures: Sequence[str | Quantity] = (), speeds: Sequence[str | Quantity] = ()
) -> tuple[LoadCase, ...]:
    """Full, empty, inclines only, declines only, each at every temperature and speed.

    Parameters
    ----------
    temperatures, speeds : sequence of str or Quantity
        Temperatures and speeds of the belt ("-20 degC", "5 m/s"); those of the spec without.

    Raises
    ------
    InputError
        A value is refused.

    Examples
    --------
    >>> [case.name for case in standard_cases(["-20 degC", "30 degC"])]
    ['full', 'empty', 'inclines only', 'declines only']
    """
    return tuple(
        LoadCase.from_data({"name": loading, "loading": loading, "temperatures": temperatures, "speeds": speeds})
        for loading in STANDARD_LOADINGS
    )


def duplicate_case_names(cases: Iterable[LoadCase]) -> Iterator[Problem]:
    """Refuse load cases that share a name."""
    first: dict[str, int] = {}
    for i, case in enumerate(cases):
        if case.name in first:
            message = f'got "{case.name}", already the name of cases[{first[case.name]}]; give each case its own name'
            yield Problem(("cases", i, "name"), message)
        first.setdefault(case.name, i)
