"""`conveyor study`: a spec with fields that vary, every point calculated, kept as it comes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli.app import (
    AsJson,
    Changed,
    Force,
    Quiet,
    Shelves,
    UnitsOption,
    app,
    examples,
    json_text,
    print_text,
    progress,
    read_spec,
    say,
)
from conveyor.cli.outputs import Outputs
from conveyor.errors import InputError
from conveyor.files import marks

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from conveyor.studies.campaign import Point
    from conveyor.units import System

_SHOWN = 3
"""Reasons without an answer that are printed."""


@app.command(
    short_help="Calculate many variants of a spec.",
    epilog=examples(
        "conveyor study spacing.yaml -o spacing.csv",
        "conveyor study spacing.yaml -o spacing.parquet --workers 8",
        "conveyor study spacing.yaml -o spacing.csv --scheduler tcp://10.0.0.1:8786 --workers 64",
    ),
)
def study(
    plan_file: Annotated[
        Path, typer.Argument(metavar="STUDY", help="Study: .yaml or .json.", show_default=False)
    ],
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", metavar="FILE", help="Write the table (.csv, .parquet).", show_default=False
        ),
    ],
    workers: Annotated[
        int, typer.Option(metavar="N", help="Processes, or workers of the cluster.", min=1, max=1024)
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Of a Dask cluster (package distributed); else this machine."),
    ] = None,
    units: UnitsOption = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
    changed: Changed = None,
) -> None:
    """Calculate every point of a study; stopped or extended, it goes on from FILE.answers beside the table."""
    from conveyor import shelf as shelves
    from conveyor.report.campaigning import CampaignTable
    from conveyor.studies.campaign import Answers, Campaign, rows, run
    from conveyor.studies.points import OUTPUTS
    from conveyor.study_file import read_plan

    plan = read_plan(plan_file)
    spec, answers = plan_file.parent / plan.base, output.with_name(f"{output.name}.answers")
    line = read_spec(spec, shelf, changed)
    system: System = line.report.units if units is None else units.value
    campaign = Campaign.of(plan, line, shelves.resolver(extra=shelf or (), base=spec.parent))
    price = None if line.operation is None else line.operation.price
    currency = "-" if price is None else price.currency
    table = CampaignTable(plan, [OUTPUTS[key] for key in campaign.outputs], system, currency)
    to = Outputs(plan_file, spec, force=force)
    to.file(
        "--output", output, ".csv", ".parquet", kind=table.mark if output.suffix == ".csv" else marks.TABLE
    )
    to.tables(output.parent, parquet=output.suffix == ".parquet")
    with ExitStack() as stack:
        known = stack.enter_context(Answers(answers))
        before = len(known)
        told = stack.enter_context(progress(silent=quiet or as_json))
        executor = stack.enter_context(_executor(scheduler, workers)) if scheduler or workers > 1 else None
        run(
            campaign,
            known,
            executor=executor,
            workers=workers,
            progress=None if told is None else lambda done, whole, _: told("points", done, whole),
        )
        reasons: Counter[str] = Counter()
        count = table.write(output, _counted(rows(campaign, known), reasons))
        new, without = len(known) - before, reasons.total()
    if as_json:
        told_of = {"points": count, "calculated": new, "without_an_answer": without, "table": str(output)}
        print_text(json_text(told_of))
    elif not quiet:
        say(f"{count} points, {new} of them calculated now; {without} without an answer", f"table: {output}")
        for reason, times in reasons.most_common(_SHOWN):
            say(f"{times} without an answer: {reason}")


def _counted(points: Iterable[Point], reasons: Counter[str]) -> Iterator[Point]:
    """The points as they pass; reasons of those without an answer are counted."""
    for point in points:
        if isinstance(point[-1], str):
            reasons[point[-1]] += 1
        yield point


def _executor(scheduler: str | None, workers: int) -> Executor:
    """Processes of this machine, or a cluster."""
    if scheduler is None:
        from concurrent.futures import ProcessPoolExecutor
        from multiprocessing import get_context

        return ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            '--scheduler: needs the package distributed (pip install "conveyor[cluster]")'
        ) from None
    try:
        executor: Executor = Client(scheduler, timeout="10s").get_executor()
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler: {scheduler}: no cluster answers ({error})") from None
    return executor
