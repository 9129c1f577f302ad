"""Designs for people, of a duty or a study, with tables and reports; nothing below imports this."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable
from contextlib import nullcontext
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from conveyor import shelf, sizing
from conveyor.arguments.argument_types import check_arguments
from conveyor.models import Conveyor
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import StudyPlan
from conveyor.pipeline import ProgressCallback
from conveyor.report.report_exports import ReportExports
from conveyor.spec import load
from conveyor.studies.evaluation import StudySummary, summarise_study
from conveyor.studies.parametric_study import (
    ParametricStudy,
    Point,
    ResultStore,
    design_results,
    point_results,
    run_study,
)
from conveyor.studies.study_file import base_spec_path, name_plan_file, read_duty, read_plan
from conveyor.units.unit_systems import report_system

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import pandas as pd

    from conveyor.report.table_model import Contents
    from conveyor.units import System


class Sizing(sizing.CalculatedSizing, ReportExports):
    """Ranked designs of a duty, with their tables and reports; `.best.conveyor` is the spec of the cheapest."""

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per design; units in the names."""
        return self.contents(vary=False)["designs"].frame()

    @cached_property
    def around(self) -> pd.DataFrame:
        """Sensitivity of the best design, one row per varied value; units in the names."""
        return self.contents()["around"].frame()

    def contents(self, system: System | None = None, *, vary: bool = True) -> Contents:
        """Contents of a report in a system of units; the sensitivity of the best design takes seconds."""
        from conveyor.report.tables.sizing_tables import sizing_contents

        return sizing_contents(self, report_system(self.duty.report.units, system), vary=vary)


@dataclass(frozen=True, eq=False)
class Study(ReportExports):
    """Every point of a study, and its designs: `explored.best` are the ten best.

    Attributes
    ----------
    campaign : ParametricStudy
        The study on its spec.
    points : tuple of (int, values, answer)
        Number, values of the fields, SI figures or the reason why there are none.
    explored : StudySummary
        Summary of the designs: best ones, front, main effects.
    """

    campaign: ParametricStudy
    points: tuple[Point, ...]
    explored: StudySummary

    def __repr__(self) -> str:
        name, without = self.campaign.plan.name, sum(isinstance(answer, str) for *_, answer in self.points)
        kept = f"{self.explored.count} designs, {int(self.explored.keeps.sum())} keep the limits"
        return f'Study("{name}": {len(self.points)} points, {without} without an answer; {kept})'

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per point; units in the names."""
        import pandas as pd

        from conveyor.report.point_tables import point_table

        made = point_table(self.campaign, self.campaign.base.report.units)
        return pd.DataFrame(map(made.cells, self.points), columns=list(made.headings))

    def contents(self, system: System | None = None) -> Contents:
        """Tables and figures of the designs, in a system of units."""
        from conveyor.report.tables.design_tables import study_contents

        return study_contents(self.explored, report_system(self.campaign.base.report.units, system))


@check_arguments
def size(duty: str | Path | SizingDuty, *, best: int = 3, progress: ProgressCallback | None = None) -> Sizing:
    """Ranked designs of a duty.

    Parameters
    ----------
    duty : path or SizingDuty
        The duty and its rules: a file or data.
    best : int
        Designs wanted, 3 by default.
    progress : callable, optional
        Called with the candidates calculated and their total.

    Returns
    -------
    Sizing
        Designs by rank, their tables and reports.

    Raises
    ------
    InputError
        A file is refused.
    NoSolutionError
        No candidate keeps the rules; the message says which rule leaves none.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.size("examples/duties/overland.yaml", best=3).table  # doctest: +SKIP
    """
    given = duty if isinstance(duty, SizingDuty) else read_duty(duty)
    sized = sizing.size_conveyor(given, best=best, progress=progress)
    return Sizing(**{field.name: getattr(sized, field.name) for field in fields(sized)})


@check_arguments
def study(
    plan: str | Path | StudyPlan,
    conveyor: Conveyor | None = None,
    *,
    answers: str | Path | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    shelves: Iterable[str | Path] = (),
) -> Study:
    """Calculate every point of a study, from a file or data, as `conveyor.studies.parametric_study.run_study`.

    Parameters
    ----------
    plan : path or StudyPlan
        The study.
    conveyor : Conveyor, optional
        Its spec; by default the file that it names, from the folder of the study.
    answers : path, optional
        File that stores answers as they come and supplies known ones; by default a temporary one.
    executor : concurrent.futures.Executor, optional
        Executor of the points; by default this process.
    workers : int
        Workers of the executor, among which the points are shared.
    shelves : iterable of path
        Further folders of compounds.

    Returns
    -------
    Study
        Every point, and the designs.

    Raises
    ------
    InputError
        A file is refused.
    ConveyorError
        A worker was lost, or answers cannot be written.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.study("examples/studies/spacing.yaml").table  # doctest: +SKIP
    """
    given = plan if isinstance(plan, StudyPlan) else read_plan(plan)
    spec = Path(given.base) if isinstance(plan, StudyPlan) else Path(plan).parent / given.base
    if not isinstance(plan, StudyPlan) and conveyor is None:
        spec = base_spec_path(given, plan)
    base = load(spec, shelves=shelves) if conveyor is None else conveyor
    resolve = shelf.resolver(extra=shelves, base=spec.parent)
    with nullcontext() if isinstance(plan, StudyPlan) else name_plan_file(plan):
        campaign = ParametricStudy.of(given, base, resolve)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "study.answers" if answers is None else Path(answers)
        with ResultStore(path) as known:
            run_study(campaign, known, executor=executor, workers=workers)
            return Study(
                campaign,
                tuple(point_results(campaign, known)),
                summarise_study(campaign, design_results(campaign, known)),
            )
