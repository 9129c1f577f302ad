"""`conveyor optimise`: the best design of a search, written as a spec."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.application import argument, option, print_lines
from conveyor.cli.output_files import SPEC
from conveyor.cli.shared_options import Session, session_command
from conveyor.cli.study_command import describe_design, design_spec, open_answers
from conveyor.cli.worker_processes import Scheduler, Workers, open_executor, preload_workers
from conveyor.files import output_marks

if TYPE_CHECKING:
    from conveyor.studies.design_figures import Design


@session_command(
    short_help="Find the best design and write its spec.",
    without=("language",),
    examples_of=(
        "conveyor optimise search.yaml -o best.yaml",
        "conveyor optimise search.yaml -o best.yaml --workers 8",
        "conveyor power best.yaml",
    ),
)
def optimise(
    session: Session,
    plan_file: Annotated[Path, argument("Search: .yaml or .json.", "SEARCH", show_default=False)],
    output: Annotated[Path, option("Write the best spec (.yaml).", "FILE", "-o", "--output", show_default=False)],
    workers: Workers = 1,
    scheduler: Scheduler = None,
) -> None:
    """Search the best design within limits; stopped, it goes on from FILE.answers beside the spec it writes."""
    preload_workers(scheduler, workers)
    from conveyor import shelf as shelves
    from conveyor.studies.optimise import optimise as search
    from conveyor.studies.parametric_study import ParametricStudy
    from conveyor.studies.study_file import base_spec_path, name_plan_file, read_search

    plan = read_search(plan_file)
    spec = base_spec_path(plan, plan_file)
    line = session.read(spec)
    system = session.system(line)
    with name_plan_file(plan_file):
        campaign = ParametricStudy.of(plan, line, shelves.resolver(extra=session.shelf or (), base=spec.parent))
    to = session.outputs(plan_file, spec)
    to.file("--output", output, *SPEC, kind=output_marks.DESIGN)
    with ExitStack() as stack:
        known = stack.enter_context(open_answers(output))
        before = len(known)
        told = stack.enter_context(session.progress())
        executor = stack.enter_context(open_executor(scheduler, workers))

        def tell(done: int, most: int, best: Design) -> None:
            if told is not None:
                told(
                    "generations",
                    done,
                    most,
                    describe_design(best, campaign, system) if best.keeps else "none keeps the limits",
                )

        searched = search(campaign, known, executor=executor, workers=workers, progress=tell)
        new = len(known) - before
    figures = describe_design(searched.design, campaign, system)
    to.add("spec", output, {output: design_spec(campaign, searched.design, figures, "optimise")})
    plain = {
        "changes": dict(searched.design.changes),
        "figures_SI": dict(searched.design.figures),
        "designs": searched.tried,
        "calculated": new,
        "generations": searched.generations,
        "settled": searched.settled,
        "history_SI": list(searched.history),
        "spec": str(output),
    }

    def show() -> None:
        print_lines(*(f"{path}: {value}" for path, value in searched.design.changes.items()), figures)
        more = "stopped at the limit of designs: a better one may exist"
        end = "settled" if searched.settled else more
        print_lines(
            f"{searched.tried} designs in {searched.generations} generations, {new} points calculated now; {end}"
        )

    session.answer(lambda: plain, to, show)
