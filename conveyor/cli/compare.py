"""`conveyor compare`: compounds over temperature and speed."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Hashable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from conveyor.cli import notes
from conveyor.cli.app import (
    AsJson,
    Quiet,
    Shelves,
    Spec,
    app,
    examples,
    one_of,
    print_json,
    progress,
    values,
    writable,
    write_text,
)
from conveyor.cli.completion import compound_names
from conveyor.errors import InputError, NoSolutionError

if TYPE_CHECKING:
    from conveyor.comparison import Comparison


@app.command(
    short_help="Compare rubber compounds on a conveyor.",
    epilog=examples(
        "conveyor compare overland.yaml -c standard-cover -c low-rolling-resistance-cover",
        "conveyor compare overland.yaml -c s100 -c mine.yaml --temperature -30:40:5",
        "conveyor compare overland.yaml -c s100 -c s120 --speed 4,5,6 -o compounds.xlsx",
    ),
)
def compare(
    spec: Spec,
    compounds: Annotated[
        list[str],
        typer.Option(
            "--compound",
            "-c",
            help="Shelf name or compound file; may be repeated.",
            autocompletion=compound_names,
        ),
    ],
    temperatures: Annotated[
        str | None,
        typer.Option("--temperature", help="Of the belt: from:to:step or a,b,c in degC; else the spec's."),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option("--speed", help="Of the belt: from:to:step or a,b,c in m/s; else the spec's."),
    ] = None,
    cover: Annotated[str, typer.Option(help="Cover made of the compounds: bottom, top or both.")] = "bottom",
    base: Annotated[
        str | None, typer.Option(help="Name of the compound to compare with; else the first.")
    ] = None,
    extra_costs: Annotated[
        list[str] | None,
        typer.Option(
            "--extra-cost", help="NAME=AMOUNT that its belt costs above the base's; may be repeated."
        ),
    ] = None,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write every scene to this file (.csv).")] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw power over temperature to this file (.png, .svg, .pdf).")
    ] = None,
    tan_delta: Annotated[
        Path | None, typer.Option(help="Draw the loss tangents and the band the rolls excite to this file.")
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Compare rubber compounds on a conveyor: power, energy, cost and payback over temperature and speed."""
    import conveyor
    from conveyor.comparison import compare_compounds
    from conveyor.report import comparing

    for path in (output, csv, plot, tan_delta):
        if path is not None:
            writable(path)
    line = conveyor.load(spec, shelves=shelf or ())
    with progress("compounds", silent=quiet or as_json) as step:
        found = compare_compounds(
            line,
            compounds,
            temperatures=None if temperatures is None else values(temperatures, "--temperature", "degC"),
            speeds=None if speeds is None else values(speeds, "--speed", "m/s"),
            cover=one_of("--cover", cover, ("bottom", "top", "both")),
            base=base,
            extra_costs=dict(_amount(item) for item in extra_costs or ()),
            shelves=shelf or (),
            progress=step,
        )
    if not found.scenes:
        reasons = "; ".join(dict.fromkeys(refusal.reason for refusal in found.refused))
        raise NoSolutionError(f"no scene has an answer: {reasons}")
    written = [] if output is None else [f"workbook: {found.to_excel(output)}"]
    if csv is not None:
        write_text(csv, found.table.to_csv(index=False, lineterminator="\n"))
        written.append(f"table: {csv}")
    if plot is not None:
        from conveyor.report import plots

        written.append(f"figure: {plots.save(plots.power_against_temperature(found), plot)}")
    if tan_delta is not None:
        from conveyor.report import plots

        written.append(f"figure: {plots.save(plots.compared_loss_tangents(found), tan_delta)}")
    if as_json:
        print_json(comparing.to_dict(found))
    elif not quiet:
        _print_comparison(found)
        print("\n".join(written))


def _print_comparison(found: Comparison) -> None:
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from conveyor.report import comparing

    frame = found.ranking
    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    table = Table(
        title=escape(f"{found.conveyor.name}: {found.cover} cover, against {found.base}"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        padding=(0, 1),
    )
    columns = _columns(rows, several_speeds=frame["belt speed [m/s]"].nunique() > 1)
    for heading in columns:
        table.add_column(escape(heading), justify="left" if heading == "compound" else "right", no_wrap=True)
    for row in rows:
        table.add_row(*(escape(shown(row)) for shown in columns.values()))
    console = Console(
        highlight=False, width=None if sys.stdout.isatty() or "COLUMNS" in os.environ else _PIPED
    )
    console.print(table)
    notes.show(console, comparing.remarks(found))


Row = Mapping[Hashable, Any]
_PIPED = 120  # columns where nobody's terminal limits them


def _columns(rows: Sequence[Row], *, several_speeds: bool) -> dict[str, Callable[[Row], str]]:
    """Headings and what stands under them, of what the ranking knows."""
    saving = next((str(name) for name in rows[0] if str(name).startswith("saving")), None)
    columns: dict[str, Callable[[Row], str]] = {"compound": lambda row: str(row["compound"])}
    if several_speeds:
        columns["m/s"] = lambda row: f"{row['belt speed [m/s]']:g}"
    columns["mean\n[kW]"] = lambda row: _number(row["mean motor power [kW]"])
    if any(row.get("mean motor power, low [kW]") is not None for row in rows):
        columns["90 % band\n[kW]"] = _band
    columns["change"] = lambda row: f"{row['motor power against base [-]']:+.1%}"
    columns["peak\n[kW]"] = lambda row: _number(row["peak motor power [kW]"])
    columns["at\n[°C]"] = lambda row: f"{row['at temperature [degC]']:g}"
    if saving is not None:
        columns[saving.replace("saving per year", "saved/a\n")] = lambda row: _number(row[saving])
    if any(row.get("payback [a]") is not None for row in rows):
        columns["payback\n[a]"] = lambda row: _number(row["payback [a]"])
    return columns


def _band(row: Row) -> str:
    low, high = row["mean motor power, low [kW]"], row["mean motor power, high [kW]"]
    return "" if low is None or high is None else f"{_number(low)}-{_number(high)}"


def _number(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.1f}"


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
