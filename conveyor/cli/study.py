"""`conveyor study`: calculate all variants of a spec, stored as they come, and rank the designs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Set
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.app import Printed, WebPage, argument, option, say
from conveyor.cli.outputs import Outputs
from conveyor.cli.session import Session, command
from conveyor.cli.workers import Scheduler, Workers, begin, executor_of
from conveyor.files import marks
from conveyor.printable import printable

if TYPE_CHECKING:
    from conveyor.report.columns import Contents
    from conveyor.studies.campaign import Campaign, Keyed, Point
    from conveyor.studies.designs import Design
    from conveyor.studies.evaluation import Explored
    from conveyor.units import System

_SHOWN = 3
"""Number of printed reasons of points without an answer."""


@command(
    short_help="Calculate many variants of a spec.",
    examples_of=(
        "conveyor study spacing.yaml -o spacing.csv",
        "conveyor study year.yaml -o points.csv --designs designs.csv --html year.html --specs best",
        "conveyor study spacing.yaml -o spacing.parquet --workers 8",
        "conveyor study year.yaml -o points --workers 8  # a folder of parts, while it runs",
        "conveyor study spacing.yaml -o spacing.csv --scheduler tcp://10.0.0.1:8786 --workers 64",
    ),
)
def study(
    session: Session,
    plan_file: Annotated[Path, argument("Study: .yaml or .json.", "STUDY", show_default=False)],
    output: Annotated[
        Path,
        option(
            "Write the points (.csv, .parquet); into a folder part by part while they are calculated.",
            "FILE",
            "-o",
            "--output",
            show_default=False,
        ),
    ],
    designs: Annotated[Path | None, option("Write the designs (.csv, .parquet).", "FILE")] = None,
    html: WebPage = None,
    pdf: Printed = None,
    plots: Annotated[Path | None, option("Draw every figure into it (.png).", "FOLDER", "--plots")] = None,
    specs: Annotated[Path | None, option("Write the best ten designs into it as specs.", "FOLDER")] = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
) -> None:
    """Calculate every point of a study; stopped or extended, it goes on from FILE.answers beside the table."""
    begin(scheduler, workers)
    from conveyor import shelf as shelves
    from conveyor.report import design_tables, point_tables
    from conveyor.studies import campaign as running
    from conveyor.studies.evaluation import explored
    from conveyor.study_file import base_of, named, read_plan

    plan = read_plan(plan_file)
    spec, answers = base_of(plan, plan_file), output.with_name(f"{output.name}.answers")
    line = session.read(spec)
    system = session.system(line)
    with named(plan_file):
        campaign = running.Campaign.of(
            plan, line, shelves.resolver(extra=session.shelf or (), base=spec.parent)
        )
    table, designed = point_tables.of_points(campaign, system), point_tables.of_designs(campaign, system)
    to = session.outputs(plan_file, spec)
    parted = not output.suffix
    to.folder("--output", output if parted else None)
    _asked(to, "--output", None if parted else output)
    _asked(to, "--designs", designs)
    to.reports(html=html, pdf=pdf)
    to.folder("--plots", plots)
    to.folder("--specs", specs)
    begun = perf_counter()
    with ExitStack() as stack:
        known = stack.enter_context(running.Answers(answers))
        before = len(known)
        told = stack.enter_context(session.progress())
        executor = stack.enter_context(executor_of(scheduler, workers))
        reasons: Counter[str] = Counter()

        def row(number: int, keyed: Keyed) -> Point:
            point = running.point_of(campaign, known, number, keyed)
            reasons.update([point[-1]] if isinstance(point[-1], str) else [])
            return point

        parts = point_tables.PartedTable(table, output, campaign.listed.count, row) if parted else None
        running.run(
            campaign,
            known,
            executor=executor,
            workers=workers,
            progress=telling(told),
            answered=None if parts is None else parts.take,
        )
        new, spent, count = len(known) - before, perf_counter() - begun, campaign.listed.count
        if parts is None:
            table.write(output, (row(number, keyed) for number, keyed in running.keyed_points(campaign)))
        evaluated = explored(campaign, running.designs(campaign, known))
        if designs is not None:
            designed.write(designs, point_tables.design_rows(evaluated, running.designs(campaign, known)))
    contents = design_tables.of_study(evaluated, system)
    _made(to, campaign, evaluated, contents, plots=plots, specs=specs)
    plain = {"points": count, "calculated": new, "without_an_answer": reasons.total(), "table": str(output)}

    def show() -> None:
        show_best(contents, {*evaluated.sought, *plan.limits})
        rate = f" in {spent:.3g} s, {new / spent:.3g} a second" if new else ""
        say(f"{count} points, {new} of them calculated now{rate}; {reasons.total()} without an answer")
        for reason, times in reasons.most_common(_SHOWN):
            say(f"{times} without an answer: {reason}")
        say(f"table: {output}", *([] if designs is None else [f"designs: {designs}"]))

    session.answer(lambda: plain | design_tables.plain(evaluated), to, show)


def _asked(to: Outputs, option: str, path: Path | None) -> None:
    """Register the output file of a table."""
    csv = path is not None and path.suffix == ".csv"
    to.file(option, path, ".csv", ".parquet", kind=marks.STUDY if csv else marks.TABLE)


def _made(
    to: Outputs,
    campaign: Campaign,
    study: Explored,
    contents: Contents,
    *,
    plots: Path | None,
    specs: Path | None,
) -> None:
    """Make the page, figures and design specs."""
    to.write(contents)
    if plots is not None:
        to.figures({drawing.name: drawing.draw() for drawing in contents.drawings}, plots)
    if specs is not None:
        ranked = enumerate(study.best, start=1)
        made = {specs / f"{rank:02}_design_{one.number}.yaml": one for rank, one in ranked}
        system = contents.system
        told = {path: spec_of(campaign, one, said(one, campaign, system)) for path, one in made.items()}
        to.add("specs", specs, told)


def show_best(contents: Contents, deciding: Set[str]) -> None:
    """Print the best designs with the deciding figures only."""
    from conveyor.cli.terminal import console, grid

    if "best" in contents:
        facts = dict(contents.document.facts)
        best, title = contents["best"], f"{contents.document.title}: {facts['study']}; {facts['sought']}"
        shown = tuple(one for one in best.columns if one.kind in {"text", "count"} or one.key in deciding)
        console().print(grid(replace(best, columns=shown), contents.system, title))


def spec_of(campaign: Campaign, design: Design, figures: str) -> bytes:
    """Design as a spec for `conveyor power`, with its figures in the heading."""
    from conveyor.models.fields import with_fields
    from conveyor.spec import dump

    line = with_fields(campaign.base, design.changes, resolve=campaign.compounds.__getitem__)
    changes = [f"#   {path}: {value}\n" for path, value in design.changes.items()]
    heading = [f'# Design {design.number} of the study "{campaign.plan.name}": {figures}\n']
    return printable("".join([*heading, *changes, dump(line)])).encode()


def said(design: Design, campaign: Campaign, system: System) -> str:
    """Figures of a design in one line."""
    from conveyor.report.point_tables import priced
    from conveyor.units.presentation import unit

    known = [(one, design.figures[name]) for name, one in campaign.figures.items()]
    written = (
        f"{one.label} {unit(priced(one.kind, campaign.currency), system).brief(value)}"
        for one, value in known
        if value is not None
    )
    return ", ".join(written)


def telling(told: Callable[..., None] | None) -> Callable[[int, int, int], None] | None:
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
