"""`conveyor size`: ranked designs from a duty alone, each a complete spec."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.application import AsParquet, TablesFolder, argument, option
from conveyor.cli.output_files import PICTURE, SPEC
from conveyor.cli.shared_options import Session, session_command
from conveyor.files import output_marks

if TYPE_CHECKING:
    from conveyor.cli.output_files import Outputs
    from conveyor.sizing import CalculatedSizing

_MOST_DESIGNS = 50


@session_command(
    short_help="Size a conveyor from its duty: ranked designs.",
    without=("changed",),
    examples_of=(
        "conveyor size duty.yaml",
        "conveyor size duty.yaml -n 3 -o design.yaml",
        "conveyor size duty.yaml -o designs.xlsx -o around.png",
        "conveyor size duty.yaml --json | jq .designs",
    ),
)
def size(
    session: Session,
    duty: Annotated[Path, argument("Duty: .yaml or .json.", "DUTY", show_default=False)],
    best: Annotated[int, option("Designs to rank.", "N", "--best", "-n", min=1, max=_MOST_DESIGNS)] = 3,
    output: Annotated[
        list[Path] | None,
        option(
            "Write specs of the designs (.yaml, numbered by rank), the report (.xlsx, .html, .pdf), or a figure of "
            "what varies around the best (.png, .svg); may be repeated.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
) -> None:
    """Size a conveyor from what it is to convey, where and by which rules; the cheapest in a year first.

    Belt width, speed, trough, belt class, covers, rolls, distances of the sets, drives and their places, take-up. Every
    design shown is calculated exactly and passes its checks; a closed estimate chooses which are worth it.
    """
    shelves = session.shelf or ()
    specs = [path for path in output or () if path.suffix.lower() in SPEC]
    to = session.outputs(duty)
    for path in specs:
        for each in _ranked_paths(path, best):
            to.file("--output", each, *SPEC, kind=output_marks.DESIGN)
    pictures = to.reports(
        [path for path in output or () if path not in specs], *PICTURE, *SPEC, tables=tables, parquet=parquet
    )
    from conveyor import sizing
    from conveyor.report.tables.sizing_tables import sizing_contents, sizing_json
    from conveyor.studies.study_file import read_duty

    read = read_duty(duty, shelves=shelves)
    with session.progress("designs") as told:
        designs = sizing.size_conveyor(read, best=best, progress=told)
    varied = session.as_json or to.reported or bool(pictures)
    contents = sizing_contents(designs, session.system(read), vary=varied)
    for path in specs:
        _write_specs(designs, path, to, shelves)
    for path in pictures:
        to.figure(next(drawing for drawing in contents.drawings if drawing.name == "around").draw(), path)
    to.write(contents)
    from conveyor.cli.terminal import show_sizing

    session.answer(lambda: sizing_json(contents, designs), to, lambda: show_sizing(contents))


def _ranked_paths(path: Path, best: int) -> list[Path]:
    """Paths of the design specs, numbered by rank where there are several."""
    return [path] if best == 1 else [path.with_stem(f"{path.stem}-{rank}") for rank in range(1, best + 1)]


def _write_specs(sizing: CalculatedSizing, path: Path, to: Outputs, shelves: Iterable[str | Path]) -> None:
    """Add the specs of the designs, numbered by rank where there are several."""
    from conveyor.spec import dump_given

    for rank, (name, design) in enumerate(
        zip(_ranked_paths(path, len(sizing.designs)), sizing.designs, strict=True), start=1
    ):
        text = f"# Rank {rank}.\n{dump_given(design.conveyor, shelves=shelves)}"
        to.add("spec", name, {name: output_marks.mark_unedited(text, "size")})
