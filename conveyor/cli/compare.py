"""`conveyor compare`: compounds over temperature and speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli import outputs
from conveyor.cli.app import (
    AsJson,
    AsParquet,
    Quiet,
    Shelves,
    Spec,
    TablesFolder,
    UnitsOption,
    WebPage,
    Workbook,
    app,
    examples,
    one_of,
    print_json,
    progress,
    values,
)
from conveyor.cli.completion import compound_names
from conveyor.errors import InputError, NoSolutionError
from conveyor.files import saving

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison
    from conveyor.units import System


@app.command(
    short_help="Compare rubber compounds on a conveyor.",
    epilog=examples(
        "conveyor compare overland.yaml -c standard-cover -c low-rolling-resistance-cover",
        "conveyor compare overland.yaml -c s100 -c mine.yaml --temperature -30:40:5",
        "conveyor compare overland.yaml -c s100 -c s120 --speed 5,6 -o compounds.xlsx --html compounds.html",
        'conveyor compare overland.yaml -c s100 -c s120 --temperature "0:100:20 degF" --units us',
    ),
)
def compare(
    spec: Spec,
    compounds: Annotated[
        list[str],
        typer.Option(
            "--compound",
            "-c",
            metavar="NAME",
            help="Shelf name or compound file; may be repeated.",
            autocompletion=compound_names,
        ),
    ],
    temperatures: Annotated[
        str | None,
        typer.Option(
            "--temperature",
            metavar="VALUES",
            help="Of the belt: from:to:step or a,b,c, in degC without a unit.",
        ),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            "--speed",
            metavar="VALUES",
            help="Of the belt: from:to:step or a,b,c, in m/s without a unit; else the spec's.",
        ),
    ] = None,
    cover: Annotated[
        str, typer.Option(metavar="WHICH", help="Cover made of the compounds: bottom, top or both.")
    ] = "bottom",
    base: Annotated[
        str | None, typer.Option(metavar="NAME", help="Name of the compound to compare with; else the first.")
    ] = None,
    extra_costs: Annotated[
        list[str] | None,
        typer.Option(
            "--extra-cost",
            metavar="NAME=AMOUNT",
            help="What its belt costs above the base's; may be repeated.",
        ),
    ] = None,
    output: Workbook = None,
    html: WebPage = None,
    tables: TablesFolder = None,
    parquet: AsParquet = False,
    csv: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write every scene to this file (.csv).")
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw power over temperature to this file (.png, .svg, .pdf)."),
    ] = None,
    speed_plot: Annotated[
        Path | None,
        typer.Option("--speed-plot", metavar="FILE", help="Draw power over belt speed to this file."),
    ] = None,
    tan_delta: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Draw the loss tangents and the band the rolls excite to this file."
        ),
    ] = None,
    units: UnitsOption = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Compare rubber compounds on a conveyor: power, energy, cost and payback over temperature and speed."""
    outputs.file("--output", output, ".xlsx")
    outputs.file("--html", html, ".html", ".htm")
    outputs.tables(tables, parquet=parquet)
    outputs.file("--csv", csv, ".csv")
    for option, path in (("--plot", plot), ("--speed-plot", speed_plot), ("--tan-delta", tan_delta)):
        outputs.file(option, path, ".png", ".svg", ".pdf")
    import conveyor
    from conveyor.studies.comparison import compare_compounds

    line = conveyor.load(spec, shelves=shelf or ())
    system: System = line.report.units if units is None else units.value
    with progress(silent=quiet or as_json) as told:
        found = compare_compounds(
            line,
            compounds,
            temperatures=None
            if temperatures is None
            else values(temperatures, "--temperature", "degC", "degF"),
            speeds=None if speeds is None else values(speeds, "--speed", "m/s", "fpm"),
            cover=one_of("--cover", cover, ("bottom", "top", "both")),
            base=base,
            extra_costs=dict(_amount(item) for item in extra_costs or ()),
            shelves=shelf or (),
            progress=None if told is None else partial(told, "compounds"),
        )
    if not found.scenes:
        reasons = "; ".join(dict.fromkeys(refusal.reason for refusal in found.refused))
        raise NoSolutionError(f"no scene has an answer: {reasons}")
    written = _written(
        found, Outputs(output, html, tables, parquet, csv, plot, speed_plot, tan_delta), system
    )
    if as_json:
        from conveyor.report import comparing

        print_json(comparing.plain(found))
    elif not quiet:
        from conveyor.cli.compare_tables import show
        from conveyor.report.comparing import of_comparison

        show(of_comparison(found, system))
        if written:
            print("\n" + "\n".join(written))


@dataclass(frozen=True)
class Outputs:
    """Files that are asked for."""

    workbook: Path | None
    page: Path | None
    tables: Path | None
    parquet: bool
    table: Path | None
    plot: Path | None
    speed_plot: Path | None
    tan_delta: Path | None


def _written(found: Comparison, to: Outputs, system: System) -> list[str]:
    """Write what is asked for; a line on each."""
    written = []
    if to.workbook is not None:
        written.append(f"workbook: {found.to_excel(to.workbook, system=system)}")
    if to.page is not None:
        written.append(f"page: {found.to_html(to.page, system=system)}")
    if to.tables is not None:
        made = found.to_tables(
            outputs.make(to.tables), system=system, kind="parquet" if to.parquet else "csv"
        )
        written.append(f"tables: {len(made)} in {to.tables}")
    if to.table is not None:
        from conveyor.report.comparing import scenes
        from conveyor.report.files import csv

        saving.save({to.table: csv(scenes(found).frame(system))})
        written.append(f"table: {to.table}")
    figures = (
        (to.plot, found.plots.power_against_temperature),
        (to.speed_plot, found.plots.power_against_speed),
        (to.tan_delta, found.plots.loss_tangents),
    )
    for path, drawn in figures:
        if path is not None:
            from conveyor.report.plots import save

            written.append(f"figure: {save(drawn(system=system), path)}")
    return written


def _amount(given: str) -> tuple[str, float]:
    name, separator, amount = given.rpartition("=")
    try:
        if separator and math.isfinite(float(amount)):
            return name.strip(), float(amount)
    except ValueError:
        pass
    raise InputError(
        f'--extra-cost: got "{given}", expected NAME=AMOUNT such as "low-rolling-resistance-cover=150000"'
    )
