"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli import notes
from conveyor.cli.app import AsJson, Quiet, Shelves, Spec, app, examples, print_json, writable

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies


@app.command(
    short_help="Power, forces and tensions of a conveyor.",
    epilog=examples(
        "conveyor power overland.yaml",
        "conveyor power overland.yaml -o overland.xlsx",
        "conveyor power overland.yaml --json | jq .power_kW",
        "conveyor power input.xlsx --shelf my-compounds",
    ),
)
def power(
    spec: Spec,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Power, forces and tensions of a conveyor, with the load cases, the year and the ranges its spec has."""
    import conveyor
    from conveyor.studies import studies

    if output is not None:
        writable(output)
    line = conveyor.load(spec, shelves=shelf or ())
    result, asked = conveyor.analyse(line), studies(line)
    written = None if output is None else result.to_excel(output, asked)
    if as_json:
        print_json(result.to_dict() | asked.to_dict())
    elif not quiet:
        _print_power(result)
        _print_studies(asked)
        if written is not None:
            print(f"\nworkbook: {written}")


def _print_power(result: Analysis) -> None:
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console(highlight=False)
    found = result.balance
    forces, classical, drive = found.forces, found.classical, found.power
    table = Table(title=escape(result.conveyor.name), title_justify="left", title_style="bold")
    table.add_column("")
    table.add_column("this calculation", justify="right")
    table.add_column("share", justify="right")
    table.add_column(f"classical, f = {classical.friction_factor:g}", justify="right")
    rows = (
        ("indentation", forces.indentation, None),
        ("idler rotation", forces.idler_rotation, None),
        ("flexure", forces.flexure, None),
        ("main resistance", forces.main, classical.main),
        ("secondary", forces.secondary, classical.secondary),
        ("special", forces.special, classical.special),
        ("lift", forces.lift, classical.lift),
        ("effective tension", forces.total, classical.total),
    )
    for name, force, other in rows:
        share = f"{force / forces.total:.1%}" if forces.total else ""
        table.add_row(name, f"{force / 1e3:.2f} kN", share, "" if other is None else f"{other / 1e3:.2f} kN")
    table.add_section()
    table.add_row("belt power", f"{drive.belt / 1e3:.1f} kW", "", "")
    table.add_row(
        "[bold]motor power[/]", f"[bold]{drive.motor / 1e3:.1f} kW[/]", "", f"{classical.motor / 1e3:.1f} kW"
    )
    table.add_row("friction factor f", f"{found.friction_factor:.4f}", "", f"{classical.friction_factor:.4f}")
    table.add_row(
        "tensions, tight / slack", f"{found.tensions.tight / 1e3:.1f} / {found.tensions.slack / 1e3:.1f} kN"
    )
    if drive.energy_per_tonne_km is not None:
        table.add_row("energy", f"{drive.energy_per_tonne_km:.4f} kWh/(t km)")
    if drive.energy_per_year is not None:
        cost = "" if drive.cost_per_year is None else f"{drive.cost_per_year:,.0f} {drive.currency}/a"
        table.add_row("energy per year", f"{drive.energy_per_year / 1e3:,.0f} MWh/a", "", cost)
    console.print(table)
    console.print(f"relative error of the contact solutions: at most {result.error_estimate:.0e}")
    notes.show(console, result.warnings)


def _print_studies(asked: Studies) -> None:
    """The figures of load cases, year and ranges that a designer looks for first."""
    if asked.cases is None and asked.duty is None and asked.uncertainty is None:
        return
    from rich.console import Console
    from rich.markup import escape

    from conveyor.report import case_tables

    console = Console(highlight=False)
    if asked.cases is not None:
        console.print("\n[bold]load cases[/]")
        for row in case_tables.governing(asked.cases).to_dict("records"):
            at = f"{row['temperature [degC]']:g} °C, {row['belt speed [m/s]']:g} m/s"
            console.print(
                f"  {row['figure']}: {row['value']:,.0f} {row['unit']} [dim]({escape(str(row['case']))}, {at})[/]"
            )
    if asked.duty is not None:
        console.print("\n[bold]year[/]")
        for name, value in case_tables.year(asked.duty).items():
            shown = f"{value:,.4f}" if abs(value) < 1.0 else f"{value:,.0f}"
            console.print(f"  {escape(str(name))}: {shown}")
    if asked.uncertainty is not None:
        low, high = (figure / 1e3 for figure in asked.uncertainty.band)
        first = ", ".join(escape(effect.name) for effect in asked.uncertainty.effects[:3])
        console.print(
            f"\n[bold]motor power[/] {low:,.0f} to {high:,.0f} kW in nine tenths of the ranges; "
            f"what matters first: {first}"
        )
