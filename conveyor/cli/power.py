"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli import outputs
from conveyor.cli.app import (
    AsJson,
    ImageKind,
    Quiet,
    Shelves,
    Spec,
    UnitsOption,
    app,
    examples,
    print_json,
    progress,
)

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies
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
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    html: Annotated[
        Path | None, typer.Option("--html", help="Write the report as one page (.html); it prints well.")
    ] = None,
    tables: Annotated[
        Path | None, typer.Option("--tables", help="Write every table to a file of its own in this folder.")
    ] = None,
    parquet: Annotated[
        bool, typer.Option("--parquet", help="Tables as Parquet files; without it as CSV.")
    ] = False,
    plots: Annotated[Path | None, typer.Option("--plots", help="Draw the figures into this folder.")] = None,
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
    outputs.folder("--tables", tables)
    outputs.folder("--plots", plots)
    if parquet:
        outputs.parquet(tables)
    import conveyor
    from conveyor.studies import studies

    line = conveyor.load(spec, shelves=shelf or ())
    system: System = line.report.units if units is None else units.value
    result = conveyor.analyse(line)
    shown = result.in_units(system)
    with progress(silent=quiet or as_json) as told:
        asked = studies(line, progress=told)
    written = []
    if output is not None:
        written.append(f"workbook: {result.to_excel(output, asked, system=system)}")
    if html is not None:
        written.append(f"page: {result.to_html(html, asked, system=system)}")
    if tables is not None:
        made = result.to_tables(
            outputs.make(tables), asked, system=system, kind="parquet" if parquet else "csv"
        )
        written.append(f"tables: {len(made)} in {tables}")
    if plots is not None:
        written.append(f"figures: {_draw(result, asked, plots, plot_kind, system)} in {plots}")
    if as_json:
        print_json(result.to_dict() | asked.to_dict())
    elif not quiet:
        from conveyor.cli.power_tables import show

        show(shown, asked, system)
        if written:
            print("\n" + "\n".join(written))


def _draw(result: Analysis, asked: Studies, folder: Path, kind: ImageKind, system: System) -> int:
    """Draw every figure there is into a folder; how many."""
    from conveyor.report.plots import save

    drawn = result.plots.every(asked, system=system)
    outputs.make(folder)
    for name, figure in drawn.items():
        save(figure, folder / f"{name}.{kind.value}")
    return len(drawn)
