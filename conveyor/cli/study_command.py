"""`conveyor study`: calculate all variants of a spec, stored as they come, and rank the designs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence, Set
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.application import ImageKind, PlotKind, PlotsFolder, StudyStop, argument, option, print_lines
from conveyor.cli.output_files import REPORT, Outputs
from conveyor.cli.shared_options import Session, session_command
from conveyor.cli.worker_processes import Scheduler, Workers, open_executor, preload_workers
from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.text.printable import escape_controls

if TYPE_CHECKING:
    from conveyor.report.table_model import Contents
    from conveyor.studies.design_figures import Design
    from conveyor.studies.evaluation import StudySummary
    from conveyor.studies.parametric_study import KeyedPoint, ParametricStudy, Point, ResultStore
    from conveyor.units import System

_REASONS_SHOWN = 3
"""Number of printed reasons of points without an answer."""


@session_command(
    short_help="Calculate many variants of a spec.",
    examples_of=(
        "conveyor study spacing.yaml -o spacing.csv",
        "conveyor study year.yaml -o points.csv -o year.html --designs designs.csv --specs best",
        "conveyor study spacing.yaml -o spacing.parquet --workers 8",
        "conveyor study year.yaml -o points --workers 8  # a folder of parts, while it runs",
        "conveyor study spacing.yaml -o spacing.csv --scheduler tcp://10.0.0.1:8786 --workers 64",
    ),
)
def study(
    session: Session,
    plan_file: Annotated[Path, argument("Study: .yaml or .json.", "STUDY", show_default=False)],
    outputs: Annotated[
        list[Path],
        option(
            "Write the points (.csv, .parquet; into a folder part by part while they are calculated), and the report "
            "(.xlsx, .html, .pdf); may be repeated.",
            "FILE",
            "-o",
            "--output",
            show_default=False,
        ),
    ],
    designs: Annotated[Path | None, option("Write the designs (.csv, .parquet).", "FILE")] = None,
    plots: PlotsFolder = None,
    plot_kind: PlotKind = ImageKind.PNG,
    specs: Annotated[Path | None, option("Write the best ten designs into it as specs.", "FOLDER")] = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
) -> None:
    """Calculate every point of a study; stopped or extended, it goes on from FILE.answers beside the points."""
    preload_workers(scheduler, workers)
    from conveyor import shelf as shelves
    from conveyor.report import point_tables
    from conveyor.report.tables import design_tables
    from conveyor.studies import parametric_study as running
    from conveyor.studies.evaluation import summarise_study
    from conveyor.studies.study_file import base_spec_path, name_plan_file, read_plan

    plan = read_plan(plan_file)
    spec, output = base_spec_path(plan, plan_file), _points_file(outputs)
    line = session.read(spec)
    system = session.system(line)
    with name_plan_file(plan_file):
        campaign = running.ParametricStudy.of(plan, line, shelves.resolver(extra=session.shelf or (), base=spec.parent))
    table, designed = point_tables.point_table(campaign, system), point_tables.design_table(campaign, system)
    to = session.outputs(plan_file, spec)
    parted = not output.suffix
    to.folder("--output", output if parted else None)
    _check_table_file(to, "--output", None if parted else output)
    _check_table_file(to, "--designs", designs)
    to.reports((path for path in outputs if path is not output), plots=plots, plot_kind=plot_kind)
    to.folder("--specs", specs)
    begun = perf_counter()
    with ExitStack() as stack:
        known = stack.enter_context(open_answers(output))
        before = len(known)
        told = stack.enter_context(session.progress())
        executor = stack.enter_context(open_executor(scheduler, workers))
        reasons: Counter[str] = Counter()

        def row(number: int, keyed: KeyedPoint) -> Point:
            point = running.point_result(campaign, known, number, keyed)
            reasons.update([point[-1]] if isinstance(point[-1], str) else [])
            return point

        parts = point_tables.PartedTable(table, output, campaign.require_list_plan().count, row) if parted else None
        running.run_study(
            campaign,
            known,
            executor=executor,
            workers=workers,
            progress=progress_reporter(told),
            answered=None if parts is None else parts.take,
        )
        new, spent, count = len(known) - before, perf_counter() - begun, campaign.require_list_plan().count
        if parts is None:
            table.write(output, (row(number, keyed) for number, keyed in running.keyed_points(campaign)))
        evaluated = summarise_study(campaign, running.design_results(campaign, known))
        if designs is not None:
            designed.write(designs, point_tables.design_rows(evaluated, running.design_results(campaign, known)))
    contents = _write_study_files(to, campaign, evaluated, system, specs=specs)
    plain = {"points": count, "calculated": new, "without_an_answer": reasons.total(), "table": str(output)}

    def show() -> None:
        show_best(contents, {*evaluated.objectives, *plan.limits})
        rate = f" in {spent:.3g} s, {new / spent:.3g} a second" if new else ""
        print_lines(f"{count} points, {new} of them calculated now{rate}; {reasons.total()} without an answer")
        for reason, times in reasons.most_common(_REASONS_SHOWN):
            print_lines(f"{times} without an answer: {reason}")
        print_lines(f"table: {output}", *([] if designs is None else [f"designs: {designs}"]))

    session.answer(lambda: plain | design_tables.study_json(evaluated), to, show)


@contextmanager
def open_answers(output: Path) -> Iterator[ResultStore]:
    """Open the file of answers beside an output; at Ctrl-C say how many points it keeps."""
    from conveyor.studies.parametric_study import ResultStore

    answers = output.with_name(f"{output.name}.answers")
    with ResultStore(answers) as known:
        try:
            yield known
        except KeyboardInterrupt:
            kept = f"{len(known):,} points are kept in {answers}: run it again to go on"
            raise StudyStop(kept if len(known) else "nothing was finished yet") from None


def _points_file(outputs: Sequence[Path]) -> Path:
    """File or folder of the points among the outputs; the others are reports."""
    points = [path for path in outputs if path.suffix.lower() not in REPORT]
    if len(points) != 1:
        raise InputError(f"--output: got {len(points)} for the points, give one: .csv, .parquet or a folder")
    return points[0]


def _check_table_file(to: Outputs, option: str, path: Path | None) -> None:
    """Register the output file of a table."""
    csv = path is not None and path.suffix == ".csv"
    to.file(option, path, ".csv", ".parquet", kind=output_marks.STUDY if csv else output_marks.TABLE)


def _write_study_files(
    to: Outputs,
    campaign: ParametricStudy,
    study: StudySummary,
    system: System,
    *,
    specs: Path | None,
) -> Contents:
    """Make the page, figures and design specs; return the contents of the report."""
    from conveyor.report.tables.design_tables import study_contents

    contents = study_contents(study, system)
    to.write(contents)
    if specs is not None:
        ranked = enumerate(study.best, start=1)
        made = {specs / f"{rank:02}_design_{one.number}.yaml": one for rank, one in ranked}
        told = {
            path: design_spec(campaign, one, describe_design(one, campaign, system), "study")
            for path, one in made.items()
        }
        to.add("specs", specs, told)
    return contents


def show_best(contents: Contents, deciding: Set[str]) -> None:
    """Print the best designs with the deciding figures only, and the remarks."""
    from conveyor.cli.terminal import report_grid, show_notes, terminal_console

    if "best" in contents:
        facts = dict(contents.document.facts)
        best, title = contents["best"], f"{contents.document.title}: {facts['study']}; {facts['sought']}"
        shown = tuple(one for one in best.columns if one.kind in {"text", "count"} or one.key in deciding)
        terminal_console().print(report_grid(replace(best, columns=shown), contents.system, title))
    if "remarks" in contents:
        show_notes(terminal_console(), [row.text for row in contents["remarks"].rows])


def design_spec(campaign: ParametricStudy, design: Design, figures: str, command: str) -> bytes:
    """Design as a spec for `conveyor power`, with its figures in the heading, marked as written by a command."""
    from conveyor.models.fields import with_fields
    from conveyor.spec import dump

    line = with_fields(campaign.base, design.changes, resolve=campaign.compounds.__getitem__)
    changes = [f"#   {path}: {value}\n" for path, value in design.changes.items()]
    heading = [f'# Design {design.number} of the study "{campaign.plan.name}": {figures}\n']
    return output_marks.mark_unedited(escape_controls("".join([*heading, *changes, dump(line)])), command)


def describe_design(design: Design, campaign: ParametricStudy, system: System) -> str:
    """Figures of a design in one line."""
    from conveyor.report.point_tables import money_kind
    from conveyor.units.presentation import display_unit

    known = [(one, design.figures[name]) for name, one in campaign.figures.items()]
    written = (
        f"{one.label} {display_unit(money_kind(one.kind, campaign.currency), system).said(value, 4)}"
        for one, value in known
        if value is not None
    )
    return ", ".join(written)


def progress_reporter(told: Callable[..., None] | None) -> Callable[[int, int, int], None] | None:
    """Progress callback with the rate of points and the number without an answer."""
    if told is None:
        return None
    begun: list[tuple[float, int]] = []

    def tell(done: int, whole: int, without: int) -> None:
        begun.append((perf_counter(), done)) if not begun else None
        time, first = begun[0]
        rate = (done - first) / max(perf_counter() - time, 1e-9)
        told("points", done, whole, f"{rate:.3g} a second, {without} without an answer")

    return tell
