"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli.app import AsParquet, ImageKind, Spec, TablesFolder, WebPage, Workbook
from conveyor.cli.session import Session, command
from conveyor.files import marks

if TYPE_CHECKING:
    from conveyor.analysis import Analysis, Studies
    from conveyor.report.columns import Contents


@command(
    short_help="Power, forces and tensions of a conveyor.",
    examples_of=(
        "conveyor power overland.yaml",
        "conveyor power overland.yaml -o report.xlsx --html report.html",
        "conveyor power overland.yaml --units us",
        "conveyor power overland.yaml --tables tables --plots figures",
        "conveyor power overland.yaml --json | jq .power_kW",
        "conveyor power input.xlsx --shelf my-compounds",
    ),
)
def power(
    session: Session,
    spec: Spec,
    output: Workbook = None,
    html: WebPage = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
    plots: Annotated[
        Path | None, typer.Option("--plots", metavar="FOLDER", help="Draw every figure into it.")
    ] = None,
    plot_kind: Annotated[
        ImageKind, typer.Option("--plot-kind", help="Format of the figures.", case_sensitive=False)
    ] = ImageKind.PNG,
) -> None:
    """Power, forces and tensions of a conveyor, with the load cases, the year and the ranges its spec has."""
    to = session.outputs(spec)
    to.file("--output", output, ".xlsx", kind=marks.REPORT)
    to.file("--html", html, ".html", ".htm", kind=marks.PAGE)
    to.tables(tables, parquet=parquet)
    to.folder("--plots", plots)
    import conveyor
    from conveyor import spec as spec_file
    from conveyor.analysis import studies

    line = session.read(spec)
    system = session.system(line)
    result = conveyor.analyse(line)
    with session.progress() as told:
        with spec_file.placing(spec):
            asked = studies(line, result, progress=told)
        result = result.beside(asked)
        shown = result.in_units(system)
        contents = shown.contents(asked)
        wanted = _wanted(contents, output, html, tables, parquet)
        if plots is not None:
            wanted.append(("figures", plots, lambda folder: _drawn(shown, asked, folder, plot_kind)))
        for done, (what, where, made) in enumerate(wanted):
            if told is not None:
                told("writing", done, len(wanted))
            to.add(what, where, made(where))
    from conveyor.cli.power_tables import show

    session.answer(result.to_dict(asked), to, lambda: show(contents))


Wanted = tuple[str, Path, Callable[[Path], Mapping[Path, bytes]]]


def _wanted(
    contents: Contents, output: Path | None, html: Path | None, tables: Path | None, parquet: bool
) -> list[Wanted]:
    """Reports that are asked for: where they go, and what makes their files."""
    from conveyor.report import html as page

    every: list[tuple[str, Path | None, Callable[[Path], Mapping[Path, bytes]]]] = [
        ("workbook", output, lambda path: _workbook(contents, path)),
        ("page", html, lambda path: {path: page.build(contents).encode()}),
        ("tables", tables, lambda folder: _tables(contents, folder, parquet=parquet)),
    ]
    return [(what, where, made) for what, where, made in every if where is not None]


def _workbook(contents: Contents, path: Path) -> Mapping[Path, bytes]:
    from conveyor.report import excel

    return excel.files(contents, path)


def _tables(contents: Contents, folder: Path, *, parquet: bool) -> Mapping[Path, bytes]:
    from conveyor.report import files

    return files.files(contents, folder, "parquet" if parquet else "csv")


def _drawn(result: Analysis, asked: Studies, folder: Path, kind: ImageKind) -> dict[Path, bytes]:
    from conveyor.report.plots import drawn

    made = {folder / f"{name}.{kind.value}": figure for name, figure in result.plots.every(asked).items()}
    return {path: drawn(figure, path) for path, figure in made.items()}
