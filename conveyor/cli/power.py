"""`conveyor power`: forces, tensions, power."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from conveyor.cli.app import AsJson, Quiet, Shelves, Spec, app

if TYPE_CHECKING:
    from conveyor.analysis import Analysis


@app.command()
def power(
    spec: Spec,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write the workbook (.xlsx).")] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Power, forces and tensions of a conveyor.

    Example: conveyor power examples/specs/overland.yaml -o overland.xlsx
    """
    import conveyor

    result = conveyor.analyse(conveyor.load(spec, shelves=shelf or ()))
    written = None if output is None else result.to_excel(output)
    if as_json:
        print(json.dumps(result.to_dict(), indent=2, allow_nan=False, ensure_ascii=False))
    elif not quiet:
        _print_power(result)
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
    for warning in result.warnings:
        console.print(f"[yellow]note:[/] {escape(warning)}")
