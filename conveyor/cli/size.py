"""`conveyor size`: ranked designs from a duty alone, each a complete spec."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli.app import AsParquet, TablesFolder
from conveyor.cli.outputs import Outputs
from conveyor.cli.session import Session, command
from conveyor.files import marks

if TYPE_CHECKING:
    from conveyor.report.columns import Contents
    from conveyor.sizing import CalculatedSizing

_KINDS = {".xlsx": marks.REPORT, ".html": marks.PAGE, ".htm": marks.PAGE, ".png": marks.FIGURE, ".svg": marks.FIGURE,
          ".pdf": marks.FIGURE, ".yaml": marks.TO_FILL_IN, ".yml": marks.TO_FILL_IN}  # fmt: skip
_MOST = 50


@command(
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
    duty: Annotated[Path, typer.Argument(metavar="DUTY", help="Duty: .yaml or .json.", show_default=False)],
    best: Annotated[
        int, typer.Option("--best", "-n", metavar="N", help="Designs to rank.", min=1, max=_MOST)
    ] = 3,
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Write specs of the designs (.yaml, numbered by rank), .xlsx, .html, or what varies around the best "
            "(.png, .svg, .pdf); may be repeated.",
        ),
    ] = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
) -> None:
    """Size a conveyor from what it is to convey, where and by which rules; the cheapest in a year first.

    Belt width, speed, trough, belt class, covers, rolls, distances of the sets, drives and their places, take-up. Every
    design shown is calculated exactly and passes its checks; a closed estimate chooses which are worth it.
    """
    asked = [(path, path.suffix.lower()) for path in output or ()]
    to = session.outputs(duty)
    for path, ending in asked:
        numbered = _ranked(path, best) if ending in {".yaml", ".yml"} else [path]
        for each in numbered:
            to.file("--output", each, *_KINDS, kind=_KINDS.get(ending, ""))
    to.tables(tables, parquet=parquet)
    from conveyor import sizing
    from conveyor.report.sizing_tables import of_sizing, plain
    from conveyor.study_file import read_duty

    read = read_duty(duty, shelves=session.shelf or ())
    with session.progress() as told:
        designs = sizing.size(read, best=best, progress=None if told is None else partial(told, "designs"))
    pictured = (
        session.as_json or tables is not None or any(ending not in {".yaml", ".yml"} for _, ending in asked)
    )
    contents = of_sizing(designs, session.system(read), vary=pictured)
    for path, ending in asked:
        _write(designs, contents, path, ending, to)
    if tables is not None:
        from conveyor.report import files

        to.add("tables", tables, files.files(contents, tables, "parquet" if parquet else "csv"))
    from conveyor.cli.sizing_tables import show

    session.answer(plain(contents, designs), to, lambda: show(contents))


def _ranked(path: Path, best: int) -> list[Path]:
    """Names of the specs of the designs: that of the only one, else numbered."""
    return [path] if best == 1 else [path.with_stem(f"{path.stem}-{rank}") for rank in range(1, best + 1)]


def _write(sizing: CalculatedSizing, contents: Contents, path: Path, ending: str, to: Outputs) -> None:
    """Make a file of the kind its name says."""
    from conveyor.report import excel, sizing_tables
    from conveyor.report import html as page
    from conveyor.report.plots import drawn
    from conveyor.spec import dump

    if ending in {".yaml", ".yml"}:
        names = _ranked(path, len(sizing.designs) if len(sizing.designs) > 1 else 1)
        made = {
            name: f"# Rank {rank} of conveyor size.\n{dump(design.conveyor)}".encode()
            for rank, (name, design) in enumerate(zip(names, sizing.designs, strict=True), start=1)
        }
        to.add("specs", path, made)
    elif ending == ".xlsx":
        to.add("workbook", path, excel.files(contents, path, {}))
    elif ending in {".html", ".htm"}:
        to.add("page", path, {path: page.build(contents, sizing_tables.PARTS).encode()})
    else:
        around = next(drawing for drawing in contents.drawings if drawing.name == "around")
        to.add("figure", path, {path: drawn(around.draw(), path)})
