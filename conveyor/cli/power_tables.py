"""What `conveyor power` shows: forces beside the classical estimate, checks, studies, notes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from conveyor.cli import notes
from conveyor.cli.terminal import console, force, power, shown, table, words, wrapped
from conveyor.units import System, si, text

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from conveyor.analysis import Analysis
    from conveyor.models import Conveyor
    from conveyor.studies import Studies
    from conveyor.studies.cases import CaseStudy
    from conveyor.studies.uncertainty import UncertaintyStudy


def show(result: Analysis, asked: Studies, system: System) -> None:
    """Print what a designer looks for, the most important first and what to doubt last."""
    screen = console()
    _head(screen, result.conveyor, system)
    screen.print()
    screen.print(_forces(result, system))
    screen.print()
    screen.print(_sums(result, system))
    _checks(screen, result, asked, system)
    if asked.cases is not None:
        screen.print()
        screen.print(_cases(asked.cases, system))
    if asked.duty is not None:
        from conveyor.report import case_tables

        screen.print()
        screen.print(_year(case_tables.year(asked.duty).items()))
    if asked.uncertainty is not None:
        _ranges(screen, asked.uncertainty, system)
    notes.show(screen, result.warnings)
    from conveyor.line.walk import worst_energy_error

    balance = worst_energy_error(result.stretches)
    screen.print(
        f"\nrelative error of the contact solutions: at most {result.error_estimate:.0e}; "
        f"their energy balance closes to {balance:.0e}"
    )


def _head(screen: Console, conveyor: Conveyor, system: System) -> None:
    report, route, material = conveyor.report, conveyor.route, conveyor.material
    screen.print(words(conveyor.name, style="bold"))
    said = (
        report.project,
        report.number,
        report.client and f"for {report.client}",
        report.engineer and f"by {report.engineer}",
        report.revision and f"revision {report.revision}",
    )
    if any(said):
        screen.print(words(", ".join(filter(None, said))))
    screen.print(
        words(
            f"{material.name}, {shown(si(material.flow), 'mass flow', system)} over "
            f"{shown(route.length, 'length', system)}, lift {shown(route.rise, 'length', system)}\n"
            f"belt {text(conveyor.belt.width)} at {shown(si(conveyor.belt.speed), 'speed', system)}, "
            f"{shown(si(conveyor.ambient.belt), 'temperature', system)}"
        )
    )


def _forces(result: Analysis, system: System) -> Table:
    found = result.balance
    forces, classical = found.forces, found.classical
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
    made = table()
    made.add_column("force")
    made.add_column("this calculation", justify="right", no_wrap=True)
    made.add_column("share", justify="right", no_wrap=True)
    made.add_column(f"classical, f = {classical.friction_factor:g}", justify="right", no_wrap=True)
    for name, value, other in rows:
        share = f"{value / forces.total:.1%}" if forces.total else ""
        beside = "" if other is None else force(other, system)
        made.add_row(name, force(value, system), share, beside, end_section=name in {"flexure", "lift"})
    made.add_section()
    drive = found.power
    made.add_row("belt power", power(drive.belt, system))
    made.add_row(
        "motor power",
        power(drive.motor, system),
        "",
        power(classical.motor, system),
        style="bold",
    )
    if drive.mains != drive.motor:
        made.add_row("mains power", power(drive.mains, system))
    made.add_row("friction factor f", f"{found.friction_factor:.4f}", "", f"{classical.friction_factor:.4f}")
    return made


def _sums(result: Analysis, system: System) -> Table:
    """Tensions and energy: a name and what it is."""
    from rich.table import Table

    drive, tensions = result.balance.power, result.balance.tensions
    made = Table.grid(padding=(0, 2))
    made.add_row(
        "tensions, tight / slack", f"{force(tensions.tight, system)} / {force(tensions.slack, system)}"
    )
    if drive.energy_per_tonne_km is not None:
        made.add_row("energy", f"{drive.energy_per_tonne_km:.4f} kWh/(t km)")
    if drive.energy_per_year is not None and not result.conveyor.duty:
        cost = "" if drive.cost_per_year is None else f", {drive.cost_per_year:,.0f} {drive.currency}"
        made.add_row("in a year", f"{drive.energy_per_year / 1e3:,.0f} MWh{cost}")
    return made


def _checks(screen: Console, result: Analysis, asked: Studies, system: System) -> None:
    from conveyor.report.checks import checks

    found = checks(result, system, asked)
    failed = [check for check in found if check.verdict == "FAIL"]
    counts = [
        f"{sum(check.verdict == word for check in found)} {word}" for word in ("pass", "FAIL", "not checked")
    ]
    screen.print(
        words("checks: " + ", ".join(count for count in counts if not count.startswith("0 ")), style="bold")
    )
    for check in failed:
        said = f"FAIL {check.subject}: {check.found}, {check.asked}"
        screen.print(words(wrapped(said, screen.width, first="  ", further="    "), style="red"))


def _cases(study: CaseStudy, system: System) -> Table:
    made = table("load cases that govern")
    for heading, side in (("figure", "left"), ("value", "right"), ("case", "left"), ("at", "left")):
        made.add_column(heading, justify="right" if side == "right" else "left")
    written = {"force": force, "power": power}
    for row in study.governing:
        at = f"{shown(row.result.temperature, 'temperature', system)}, {shown(row.result.speed, 'speed', system)}"
        made.add_row(row.figure, written[row.kind](row.value, system), words(row.result.case), at)
    return made


def _year(figures: Iterable[tuple[object, float]]) -> Table:
    made = table("the year")
    made.add_column("figure")
    made.add_column("value", justify="right", no_wrap=True)
    for name, value in figures:
        made.add_row(words(str(name)), f"{value:,.4f}" if 0.0 < abs(value) < 1.0 else f"{value:,.0f}")
    return made


def _ranges(screen: Console, study: UncertaintyStudy, system: System) -> None:
    low, high = study.band
    first = ", ".join(effect.name for effect in study.effects[:3])
    screen.print(words("\nranges of the inputs", style="bold"))
    said = (
        f"motor power {power(low, system)} to {power(high, system)} in nine tenths of the cases; "
        f"what matters first: {first}"
    )
    screen.print(words(wrapped(said, screen.width, first="  ", further="  ")))
