"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli.app import (
    AsJson,
    AsParquet,
    Changed,
    Force,
    ImageKind,
    Quiet,
    Shelves,
    Spec,
    TablesFolder,
    UnitsOption,
    WebPage,
    Workbook,
    app,
    examples,
    json_text,
    print_text,
    progress,
    read_spec,
    say,
)
from conveyor.cli.outputs import Outputs
from conveyor.files import marks

if TYPE_CHECKING:
    from conveyor.analysis import Analysis, Studies
    from conveyor.report.columns import Contents
    from conveyor.units import System


@app.command(
    short_help="Power, forces and tensions of a conveyor.",
    epilog=examples(
        "conveyor power overland.yaml",
        "conveyor power overland.yaml -o report.xlsx --html report.html",
        "conveyor power overland.yaml --units us",
        "conveyor power overland.yaml --tables tables --plots figures",
        "conveyor power overland.yaml --json | jq .power_kW",
        "conveyor power input.xlsx --shelf my-compounds",
    ),
)
def power(
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
    units: UnitsOption = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
    changed: Changed = None,
) -> None:
    """Power, forces and tensions of a conveyor, with the load cases, the year and the ranges its spec has."""
    to = Outputs(spec, force=force)
    to.file("--output", output, ".xlsx", kind=marks.REPORT)
    to.file("--html", html, ".html", ".htm", kind=marks.PAGE)
    to.tables(tables, parquet=parquet)
    to.folder("--plots", plots)
    import conveyor
    from conveyor import spec as spec_file
    from conveyor.analysis import studies
    from conveyor.report.tables import of_analysis

    line = read_spec(spec, shelf, changed)
    system: System = line.report.units if units is None else units.value
    result = conveyor.analyse(line)
    with progress(silent=quiet or as_json) as told:
        with spec_file.placing(spec):
            asked = studies(line, result, progress=told)
        result = result.beside(asked)
        shown = result.in_units(system)
        figures = json_text(result.to_dict(asked))
        contents = of_analysis(shown, asked)
        wanted = _wanted(contents, output, html, tables, parquet)
        if plots is not None:
            wanted.append(("figures", plots, lambda folder: _drawn(shown, asked, folder, plot_kind)))
        for done, (what, where, made) in enumerate(wanted):
            if told is not None:
                told("writing", done, len(wanted))
            to.add(what, where, made(where))
        written = to.save()
    if as_json:
        print_text(figures)
    elif not quiet:
        from conveyor.cli.power_tables import show

        show(contents)
        if written:
            say("", *written)


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
