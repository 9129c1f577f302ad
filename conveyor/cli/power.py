"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli import outputs
from conveyor.cli.app import (
    AsJson,
    AsParquet,
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
    print_json,
    progress,
)

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Progress, Studies
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
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Power, forces and tensions of a conveyor, with the load cases, the year and the ranges its spec has."""
    outputs.file("--output", output, ".xlsx")
    outputs.file("--html", html, ".html", ".htm")
    outputs.tables(tables, parquet=parquet)
    outputs.folder("--plots", plots)
    import conveyor
    from conveyor import spec as spec_file
    from conveyor.studies import studies

    line = conveyor.load(spec, shelves=shelf or ())
    system: System = line.report.units if units is None else units.value
    result = conveyor.analyse(line)
    shown = result.in_units(system)
    with progress(silent=quiet or as_json) as told:
        with spec_file.placing(spec):
            asked = studies(line, progress=told)
        written = _written(shown, asked, Outputs(output, html, tables, parquet, plots, plot_kind), told)
    if as_json:
        print_json(result.to_dict() | asked.to_dict())
    elif not quiet:
        from conveyor.cli.power_tables import show
        from conveyor.report.tables import of_analysis

        show(of_analysis(shown, asked))
        if written:
            print("\n" + "\n".join(written))


@dataclass(frozen=True)
class Outputs:
    """Files and folders that are asked for."""

    workbook: Path | None
    page: Path | None
    tables: Path | None
    parquet: bool
    plots: Path | None
    kind: ImageKind


def _written(result: Analysis, asked: Studies, to: Outputs, told: Progress | None) -> list[str]:
    """Write what is asked for, in the units of the analysis' report; a line on each."""
    tasks: list[tuple[str, Path, Callable[[Path], str]]] = []
    if to.workbook is not None:
        tasks.append(("workbook", to.workbook, lambda path: str(result.to_excel(path, asked))))
    if to.page is not None:
        tasks.append(("page", to.page, lambda path: str(result.to_html(path, asked))))
    if to.tables is not None:
        tasks.append(("tables", to.tables, lambda path: _tabled(result, asked, path, to)))
    if to.plots is not None:
        tasks.append(("figures", to.plots, lambda path: _drawn(result, asked, path, to)))
    lines = []
    for done, (what, path, write) in enumerate(tasks):
        if told is not None:
            told("writing", done, len(tasks))
        lines.append(f"{what}: {write(path)}")
    return lines


def _tabled(result: Analysis, asked: Studies, folder: Path, to: Outputs) -> str:
    made = result.to_tables(outputs.make(folder), asked, kind="parquet" if to.parquet else "csv")
    return f"{len(made)} in {folder}"


def _drawn(result: Analysis, asked: Studies, folder: Path, to: Outputs) -> str:
    from conveyor.report.plots import save

    made = result.plots.every(asked)
    outputs.make(folder)
    for name, figure in made.items():
        save(figure, folder / f"{name}.{to.kind.value}")
    return f"{len(made)} in {folder}"
