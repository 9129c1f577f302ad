"""What `conveyor power` shows: forces beside the classical estimate, checks, studies, notes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from conveyor.cli import notes
from conveyor.cli.terminal import console, table, words, wrapped
from conveyor.units.presentation import headed, unit
from conveyor.units.sentences import percent

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as Grid

    from conveyor.report.columns import Contents, Figure, Table
    from conveyor.units import System

_SUMS: Final = ("main", "secondary", "special", "lift", "total")
_DOCUMENT: Final = ("project", "number", "client", "engineer", "revision")
_MATTERS: Final = 3
_FIRST_ORDER = 2  # rows of the band
"""Inputs that are said to matter first."""


def show(contents: Contents) -> None:
    """Print what a designer looks for, the most important first and what to doubt last."""
    screen = console()
    _head(screen, contents)
    screen.print()
    screen.print(_forces(contents))
    if "defaults" in contents:
        screen.print(words(wrapped(contents["defaults"].note, screen.width)))
    screen.print()
    screen.print(_sums(contents))
    if "cema" in contents:
        screen.print()
        screen.print(_cema(contents))
    _checks(screen, contents)
    if "load_states" in contents:
        screen.print()
        screen.print(_states(contents["load_states"], contents.system))
    if "governing_cases" in contents:
        screen.print()
        screen.print(_cases(contents["governing_cases"], contents.system))
    if "duty_year" in contents:
        screen.print()
        screen.print(_year(contents["duty_year"].rows, contents.system))
    if "power_band" in contents:
        _ranges(screen, contents)
    notes.show(screen, contents.lines("warning"))
    error, balance = (
        _figure(contents, f"contact_{name}").value for name in ("error_estimate", "energy_error")
    )
    screen.print(
        f"\nrelative error of the contact solutions: at most {error:.0e}; "
        f"their energy balance closes to {balance:.0e}"
    )


def _figure(contents: Contents, key: str) -> Figure:
    figure: Figure = next(row for row in contents["results"].rows if row.key == key)
    return figure


def _head(screen: Console, contents: Contents) -> None:
    about, system = contents.document, contents.system
    screen.print(words(about.title, style="bold"))
    named = {"client": "for {}", "engineer": "by {}", "revision": "revision {}"}
    said = (named.get(name, "{}").format(about.said[name]) for name in _DOCUMENT if name in about.said)
    if about.said:
        screen.print(words(", ".join(said)))
    facts = {row.label: row.unit(system).brief(row.value) for row in contents["identity"].rows}
    material = facts["material"].rpartition(", ")[0]  # without its density
    screen.print(
        words(
            f"{material}, {facts['mass flow']} over {facts['length']}, lift {facts['lift']}\n"
            f"belt {facts['belt width']} at {facts['belt speed']}, {facts['temperature of the covers']}"
        )
    )


def _forces(contents: Contents) -> Grid:
    system = contents.system
    force, power = unit("force", system, large=True), unit("power", system, large=True)
    sums = {row.key: row.value for row in contents["classical"].rows}
    total = sums["total"][0]
    whole = "effective tension Te" if system == "US" else "effective tension"
    names = {"main": "main resistance", "total": whole}
    rows: list[tuple[str, float, float | None]] = [
        (row.label, row.value, None)
        for row in (
            _figure(contents, f"{name}_force") for name in ("indentation", "idler_rotation", "flexure")
        )
    ]
    rows += [(names.get(key, key), *sums[key][:2]) for key in _SUMS]
    made = table()
    made.add_column("force")
    made.add_column("this calculation", justify="right", no_wrap=True)
    made.add_column("share", justify="right", no_wrap=True)
    made.add_column(f"classical, f = {sums['friction_factor'][1]:g}", justify="right", no_wrap=True)
    for name, value, other in rows:
        share = percent(value / total, 1) if total else ""
        beside = "" if other is None else force.said(other)
        made.add_row(name, force.said(value), share, beside, end_section=name in {"flexure", "lift"})
    made.add_section()
    belt, motor, mains = (_figure(contents, f"{name}_power").value for name in ("belt", "motor", "mains"))
    made.add_row("belt power", power.said(belt))
    made.add_row("motor power", power.said(motor), "", power.said(sums["motor"][1]), style="bold")
    if mains != motor:
        made.add_row("mains power", power.said(mains))
    f, classical = sums["friction_factor"][:2]
    made.add_row("friction factor f", f"{f:.4f}", "", f"{classical:.4f}")
    return made


def _sums(contents: Contents) -> Grid:
    """Tensions and energy: a name and what it is."""
    from rich.table import Table

    force = unit("force", contents.system, large=True)
    known = {row.key: row for row in contents["results"].rows}
    tight, slack = (force.said(known[f"{side}_side_tension"].value) for side in ("tight", "slack"))
    made = Table.grid(padding=(0, 2))
    made.add_row(
        "tensions, T1 / T2" if contents.system == "US" else "tensions, tight / slack", f"{tight} / {slack}"
    )
    made.add_row("take-up", _take_up(contents))
    if "specific_energy" in known:
        energy = known["specific_energy"]
        made.add_row("energy", energy.unit(contents.system).said(energy.value))
    year = [known[key] for key in ("energy_per_year", "cost_per_year") if key in known]
    if year:
        said = (
            f"{row.unit(contents.system).shown(row.value):,.0f} {row.unit(contents.system).sign}"
            for row in year
        )
        made.add_row("in a year", ", ".join(said))
    return made


def _cema(contents: Contents) -> Grid:
    """The classic form of CEMA by cause, with its motor power."""
    force, power = (unit(kind, contents.system) for kind in ("force", "power"))
    made, items = table("CEMA classic"), contents["cema"]
    made.add_column("resistance")
    made.add_column("force", justify="right", no_wrap=True)
    for symbol, name, newtons in items.rows:
        made.add_row(f"{symbol}, {name}", force.said(newtons))
    made.add_section()
    made.add_row("Te", force.said(items.totals()[-1]))
    motor = next(row.value for row in contents["classical"].rows if row.key == "motor")
    made.add_row("motor power", power.said(motor[-1]), style="bold")
    return made


def _take_up(contents: Contents) -> str:
    """Setting of the take-up, its mass and travel."""
    known = {row.key: row for row in contents["take_up"].rows if row.value is not None}
    force, mass, length = (unit(kind, contents.system, large=True) for kind in ("force", "mass", "length"))
    said = [force.said(known["take_up_setting"].value)]
    if "take_up_mass" in known:
        said.append(mass.said(known["take_up_mass"].value))
    if "take_up_travel" in known:
        said.append(f"travel {length.said(known['take_up_travel'].value)}")
    return ", ".join(said)


def _checks(screen: Console, contents: Contents) -> None:
    rows = contents["checks"].rows
    counts = {word: sum(check.verdict == word for check in rows) for word in ("pass", "FAIL", "not checked")}
    said = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    screen.print(words(f"checks: {said}", style="bold"))
    made, cases = table(), "case" in [column.key for column in contents["checks"].columns]
    for heading in ("check", "calculated, required", "margin", *(["case"] if cases else []), ""):
        made.add_column(
            heading, justify="right" if heading == "margin" else "left", no_wrap=heading == "margin"
        )
    for check in rows:
        if check.leads or check.verdict == "FAIL":
            cells = [check.subject, f"{check.found}, {check.asked}", unit("margin").written(check.margin)]
            cells += [*([check.case] if cases else []), check.verdict]
            made.add_row(*map(words, cells), style="red" if check.verdict == "FAIL" else "")
    screen.print(made)


def _states(states: Table, system: System) -> Grid:
    made = table("load states")
    figures = {
        "motor_power": "motor",
        "largest_tension": "max. tension",
        "take_up_tension_asked_for": "take-up",
    }
    for heading in ("state", "sections loaded", "at", *figures.values()):
        made.add_column(heading, justify="right" if heading in figures.values() else "left")
    columns = {column.key: column for column in states.columns}
    for row in states.rows:
        said = [unit(columns[key].kind, system, large=True).said(columns[key].value(row)) for key in figures]
        at = unit("temperature", system).brief(columns["temperature"].value(row))
        made.add_row(words(columns["state"].value(row)), words(columns["sections_loaded"].value(row)), at, *said)
    return made


def _cases(cases: Table, system: System) -> Grid:
    made = table("governing load cases")
    for heading in ("figure", "value", "case", "at"):
        made.add_column(heading, justify="right" if heading == "value" else "left")
    get = {column.key: column.value for column in cases.columns}
    for row in cases.rows:
        at = ", ".join(unit(key, system).brief(get[key](row)) for key in ("temperature", "speed"))
        value = unit(row.kind, system, large=True).said(get["value"](row))
        made.add_row(row.label, value, words(get["case"](row)), at)
    return made


def _year(figures: Iterable[Figure], system: System) -> Grid:
    made = table("the year")
    made.add_column("figure")
    made.add_column("value", justify="right", no_wrap=True)
    for figure in figures:
        value = figure.unit(system).shown(figure.value)
        written = f"{value:,.4f}" if 0.0 < abs(value) < 1.0 else f"{value:,.0f}"
        made.add_row(words(headed(figure.label, figure.kind, system)), written)
    return made


def _ranges(screen: Console, contents: Contents) -> None:
    power, band = unit("power", contents.system, large=True), contents["power_band"]
    ends = [band.columns[band.index(key)].value for key in ("motor_power_low", "motor_power_high")]
    said = " to ".join(power.said(end(band.rows[0])) for end in ends)
    exact = [
        f"; {row[0]}: {' to '.join(power.said(end(row)) for end in ends)}" for row in band.rows[_FIRST_ORDER:]
    ]
    inputs = contents["sensitivity"]
    first = ", ".join(inputs.columns[0].value(row) for row in inputs.rows[:_MATTERS])
    screen.print(words("\nuncertainty", style="bold"))
    said = f"motor power {said} (90 % interval){''.join(exact)}; most sensitive to: {first}"
    screen.print(words(wrapped(said, screen.width, first="  ", further="  ")))
