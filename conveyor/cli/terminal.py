"""Results on a terminal: plain tables with the main figures of every command."""

from __future__ import annotations

import math
import os
import sys
import textwrap
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

from conveyor.text.printable import escape_controls
from conveyor.units.presentation import Unit, column_name, display_unit
from conveyor.units.sentences import percent
from conveyor.units.unit_systems import trade_of

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as Grid
    from rich.text import Text

    from conveyor.report.table_model import Contents, Figure, Table
    from conveyor.units import System

_PIPED_WIDTH: Final = 120  # columns without a terminal
_NARROWEST: Final = 40
_FORCE_SUMS: Final = ("main", "secondary", "special", "lift", "total")
_DOCUMENT_FIELDS: Final = ("project", "number", "client", "engineer", "revision")
_INPUTS_NAMED: Final = 3
"""Number of most sensitive inputs printed."""
_FIRST_ORDER_ROWS: Final = 2  # rows of the band
_SCENARIO_COLUMNS: Final = (
    "scenario", "highest_tension", "at", "in", "lowest_tension", "lowest_at", "lowest_in", "comes_to_rest", "way",
)  # fmt: skip
_DESIGN_COLUMNS: Final = (
    "rank", "belt_width", "trough", "speed", "belt", "rolls", "carry_sets", "return_sets", "drives", "motors",
    "motor_power", "cost_a_year",
)  # fmt: skip


def terminal_console() -> Console:
    """Console of the width of the terminal or of `COLUMNS`; 120 where output is piped."""
    from rich.console import Console

    own = sys.stdout.isatty() or os.environ.get("COLUMNS", "").strip("0").isdecimal()
    return Console(highlight=False, width=max(Console().width, _NARROWEST) if own else _PIPED_WIDTH)


def plain_text(text: str, style: str = "") -> Text:
    """Text for the terminal, without markup and control characters."""
    from rich.text import Text

    return Text(escape_controls(text), style=style)


def plain_table(title: str | None = None, heads: Iterable[str] = (), *, left: Collection[str] = ()) -> Grid:
    """Table without a frame, with a line below its head.

    Columns are aligned right, those of `left` left.
    """
    from rich import box
    from rich.table import Table

    made = Table(
        title=None if title is None else plain_text(title, "bold"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1),
    )
    for head in heads:
        of_words = head in left
        made.add_column(plain_text(head), justify="left" if of_words else "right", no_wrap=not of_words)
    return made


def report_grid(part: Table, system: System, title: str | None = None, *, large: bool = False) -> Grid:
    """Table of the report, units below names; `large`: kN for N, and no decimals that are all zero."""
    made = plain_table(part.heading if title is None else title)
    every = []
    for column in part.columns:
        of_words = column.kind == "text"
        sign = display_unit(column.kind, system, large=large).sign
        heading = f"{column.label}\n[{sign}]" if sign else column.label
        cells = (
            display_unit(column.kind, system, large=True) if large else part.unit(column, row, system)
            for row in part.rows
        )
        written = [cell.written(column.get(row)) for cell, row in zip(cells, part.rows, strict=True)]
        if large and not of_words:
            written = without_zeros(written)
        every.append([plain_text(text) for text in written])
        made.add_column(plain_text(heading), justify="left" if of_words else "right")
        if not of_words:  # text wraps, numbers do not
            made.columns[-1].min_width = max((text.cell_len for text in every[-1]), default=None)
    for row in zip(*every, strict=True):
        made.add_row(*row)
    return made


def without_zeros(numbers: Sequence[str]) -> list[str]:
    """Numbers of a column without decimals that are zero in all of them.

    Examples
    --------
    >>> without_zeros(["800.0", "1,000.0"]), without_zeros(["2.50", "3.00"]), without_zeros(["2.55", "3.00"])
    (['800', '1,000'], ['2.5', '3.0'], ['2.55', '3.00'])
    """
    filled = [number for number in numbers if number]
    if not all("." in number for number in filled):
        return list(numbers)
    zeros = min((len(each) - len(each.rstrip("0").rstrip(".")) for each in filled), default=0)
    return [number[: len(number) - zeros] for number in numbers]


def wrap_line(line: str, width: int, *, first: str = "", further: str = "") -> str:
    """Wrap a line to a width, further lines indented."""
    return textwrap.fill(line, width - 1, initial_indent=first, subsequent_indent=further)


def show_notes(screen: Console, notes: Sequence[str]) -> None:
    """Print notes as two lists, wrapped to the terminal."""
    from conveyor.report.merged_notes import NOTE_HEADINGS, sort_notes

    for heading, colour, listed in zip(NOTE_HEADINGS, ("bold yellow", "bold"), sort_notes(notes), strict=True):
        if listed:
            screen.print(plain_text(f"\n{heading}", style=colour))
        for note in listed:
            screen.print(plain_text(wrap_line(note, screen.width, first="  - ", further="    ")))


_LARGE_FORCE: Final = 10_000.0
"""Effective tension from which the forces of the first table are written in kN [N]; below, their parts would be 0.0."""


def show_power(contents: Contents) -> None:
    """Print the main results, the most important first and warnings last."""
    screen = terminal_console()
    _print_head(screen, contents)
    screen.print()
    screen.print(_force_table(contents))
    if "defaults" in contents:
        screen.print(plain_text(wrap_line(contents["defaults"].note, screen.width)))
    screen.print()
    screen.print(_tension_rows(contents))
    if "cema" in contents:
        screen.print()
        screen.print(_cema_table(contents))
    _print_checks(screen, contents)
    if "load_states" in contents:
        screen.print()
        screen.print(_state_table(contents["load_states"], contents.system))
    if "flooded" in contents:
        screen.print(plain_text(wrap_line(_flooded_text(contents["flooded"], contents.system), screen.width)))
    if "governing_cases" in contents:
        screen.print()
        screen.print(_case_table(contents["governing_cases"], contents.system))
    if "duty_year" in contents:
        screen.print()
        screen.print(_year_table(contents["duty_year"].rows, contents.system))
    if "power_band" in contents:
        _print_uncertainty(screen, contents)
    show_notes(screen, contents.lines("warning"))
    error, balance = (_result_figure(contents, f"contact_{name}").value for name in ("error_estimate", "energy_error"))
    screen.print(
        f"\nnumerical error of the contact solutions: at most {error:.0e}; their energy balance closes to {balance:.0e}"
    )


def _result_figure(contents: Contents, key: str) -> Figure:
    figure: Figure = next(row for row in contents["results"].rows if row.key == key)
    return figure


def _print_head(screen: Console, contents: Contents) -> None:
    about, system = contents.document, contents.system
    screen.print(plain_text(about.title, style="bold"))
    named = {"client": "for {}", "engineer": "by {}", "revision": "revision {}"}
    said = (named.get(name, "{}").format(about.said[name]) for name in _DOCUMENT_FIELDS if name in about.said)
    if about.said:
        screen.print(plain_text(", ".join(said)))
    facts = {row.label: row.unit(system).said(row.value, 4) for row in contents["identity"].rows}
    material = facts["material"].rpartition(", ")[0]  # without its density
    screen.print(
        plain_text(
            f"{material}, {facts['mass flow']} over {facts['length']}, lift {facts['lift']}\n"
            f"belt {facts['belt width']} at {facts['belt speed']}, {facts['temperature of the covers']}"
        )
    )


def _force_table(contents: Contents) -> Grid:
    system = contents.system
    sums = {row.key: row.value for row in contents["classical"].rows}
    total = sums["total"][0]
    force = display_unit("force", system, large=abs(total) >= _LARGE_FORCE)
    power = display_unit("power", system, large=True)
    whole = "effective tension Te" if trade_of(system) == "US" else "effective tension"
    names = {"main": "main resistance", "total": whole}
    rows: list[tuple[str, float, float | None]] = [
        (row.label, row.value, None)
        for row in (_result_figure(contents, f"{name.lower()}_force") for name in _main_parts(contents))
    ]
    rows += [(names.get(key, key), *sums[key][:2]) for key in _FORCE_SUMS]
    _, here, other_method, *_ = (column.label for column in contents["classical"].columns)
    given_f = sums["friction_factor"][1]
    other_method = f"classical, f = {given_f:g}" if other_method.startswith("classical") else other_method
    made = plain_table(None, ("force", here, "share", "f", other_method), left=("force",))
    f, given = sums["friction_factor"][:2]
    last_part = rows[-len(_FORCE_SUMS) - 1][0] if len(rows) > len(_FORCE_SUMS) else ""
    over = f / sums["main"][0]  # part of f over main resistance
    for name, value, other in rows:
        share = percent(value / total, 1) if total else ""
        friction = "" if name in {*_FORCE_SUMS[1:], whole} else f"{value * over:.4f}"
        beside = "" if other is None else force.said(other)
        made.add_row(name, force.said(value), share, friction, beside, end_section=name in {last_part, "lift"})
    made.add_section()
    belt, motor, mains = (_result_figure(contents, f"{name}_power").value for name in ("belt", "motor", "mains"))
    made.add_row("belt power", power.said(belt))
    made.add_row("motor power", power.said(motor), "", "", power.said(sums["motor"][1]), style="bold")
    if mains != motor:
        made.add_row("mains power", power.said(mains))
    made.add_row("friction factor f", f"{f:.4f}", "", "", f"{given:.4f}")
    return made


def _main_parts(contents: Contents) -> list[str]:
    """Main resistances by name, where there are several."""
    parts = [name for name in contents["breakdown"].rows if name not in _FORCE_SUMS]
    return parts if len(parts) > 1 else []


def _tension_rows(contents: Contents) -> Grid:
    """Tensions and energy as label/value pairs."""
    from rich.table import Table

    force = display_unit("force", contents.system, large=True)
    known = {row.key: row for row in contents["results"].rows}
    tight, slack = (force.said(known[f"{side}_side_tension"].value) for side in ("tight", "slack"))
    made = Table.grid(padding=(0, 2))
    sides = "T1 / T2" if trade_of(contents.system) == "US" else "tight / slack"
    made.add_row(f"tensions, {sides}", f"{tight} / {slack}")
    made.add_row("take-up", _take_up_text(contents))
    if "specific_energy" in known:
        energy = known["specific_energy"]
        made.add_row("energy", energy.unit(contents.system).said(energy.value))
    year = [known[key] for key in ("energy_per_year", "cost_per_year") if key in known]
    if year:
        said = (f"{row.unit(contents.system).shown(row.value):,.0f} {row.unit(contents.system).sign}" for row in year)
        made.add_row("in a year", ", ".join(said))
    return made


def _cema_table(contents: Contents) -> Grid:
    """Resistances by the classic form of CEMA, with motor power."""
    force, power = (display_unit(kind, contents.system) for kind in ("force", "power"))
    made, items = plain_table("CEMA classic", ("resistance", "force"), left=("resistance",)), contents["cema"]
    for symbol, name, newtons in items.rows:
        made.add_row(f"{symbol}, {name}", force.said(newtons))
    made.add_section()
    made.add_row("Te", force.said(items.totals()[-1]))
    motor = next(row.value for row in contents["classical"].rows if row.key == "motor")
    names = [column.label for column in contents["classical"].columns[1:]]
    by_cema = next(value for name, value in zip(names, motor, strict=True) if "CEMA" in name)
    made.add_row("motor power", power.said(by_cema), style="bold")
    return made


def _take_up_text(contents: Contents) -> str:
    """Take-up setting, mass and travel as text."""
    known = {row.key: row for row in contents["take_up"].rows if row.value is not None}
    force, mass, length = (display_unit(kind, contents.system, large=True) for kind in ("force", "mass", "length"))
    said = [force.said(known["take_up_setting"].value)]
    if "take_up_mass" in known:
        said.append(mass.said(known["take_up_mass"].value))
    if "take_up_travel" in known:
        said.append(f"travel {length.said(known['take_up_travel'].value)}")
    return ", ".join(said)


def _print_checks(screen: Console, contents: Contents) -> None:
    rows = contents["checks"].rows
    counts = {word: sum(check.verdict == word for check in rows) for word in ("pass", "FAIL", "not checked")}
    said = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    screen.print(plain_text(f"checks: {said}", style="bold"))
    cases = ["case"] if "case" in [column.key for column in contents["checks"].columns] else []
    text = ("check", "calculated, required", *cases, "")
    made = plain_table(None, (*text[:2], "margin", *text[2:]), left=text)
    for check in rows:
        if check.leads or check.verdict == "FAIL":
            cells = [
                check.subject,
                f"{check.found}, {check.asked}",
                display_unit("margin").written(check.margin),
            ]
            cells += [*([check.case] if cases else []), check.verdict]
            made.add_row(*map(plain_text, cells), style="red" if check.verdict == "FAIL" else "")
    screen.print(made)


def _state_table(states: Table, system: System) -> Grid:
    figures = {
        "motor_power": "motor",
        "largest_tension": "max. tension",
        "take_up_tension_asked_for": "take-up",
    }
    text = ("state", "sections loaded", "at")
    made = plain_table("load states", (*text, *figures.values()), left=text)
    columns = {column.key: column for column in states.columns}
    for row in states.rows:
        said = [display_unit(columns[key].kind, system, large=True).said(columns[key].get(row)) for key in figures]
        at = display_unit("temperature", system).said(columns["temperature"].get(row), 4)
        made.add_row(plain_text(columns["state"].get(row)), plain_text(columns["sections_loaded"].get(row)), at, *said)
    return made


def _case_table(cases: Table, system: System) -> Grid:
    made = plain_table("governing load cases", ("figure", "value", "case", "at"), left=("figure", "case", "at"))
    get = {column.key: column.get for column in cases.columns}
    for row in cases.rows:
        at = ", ".join(display_unit(key, system).said(get[key](row), 4) for key in ("temperature", "speed"))
        value = display_unit(row.kind, system, large=True).said(get["value"](row))
        made.add_row(row.label, value, plain_text(get["case"](row)), at)
    return made


def _year_table(figures: Iterable[Figure], system: System) -> Grid:
    made = plain_table("the year", ("figure", "value"), left=("figure",))
    for figure in figures:
        value = figure.unit(system).shown(figure.value)
        written = f"{value:,.4f}" if 0.0 < abs(value) < 1.0 else f"{value:,.0f}"
        made.add_row(plain_text(column_name(figure.label, figure.kind, system)), written)
    return made


def _print_uncertainty(screen: Console, contents: Contents) -> None:
    power, band = display_unit("power", contents.system, large=True), contents["power_band"]
    ends = [column.get for column in band.only("motor_power_low", "motor_power_high").columns]
    said = " to ".join(power.said(end(band.rows[0])) for end in ends)
    exact = [
        f"; {row[0]}: {' to '.join(power.said(end(row)) for end in ends)}" for row in band.rows[_FIRST_ORDER_ROWS:]
    ]
    inputs = contents["sensitivity"]
    first = ", ".join(inputs.columns[0].get(row) for row in inputs.rows[:_INPUTS_NAMED])
    screen.print(plain_text("\nuncertainty", style="bold"))
    of = "90 % interval of the inputs' ranges alone, first order"
    said = f"motor power {said} ({of}){''.join(exact)}; most sensitive to: {first}"
    screen.print(plain_text(wrap_line(said, screen.width, first="  ", further="  ")))


def show_comparison(contents: Contents) -> None:
    """Print the ranking and its remarks."""
    facts = dict(contents.document.facts)
    title = f"{contents.document.title}: {facts['cover']} cover, against {facts['savings against']}"
    ranked = contents["ranking"]
    screen = terminal_console()
    savings = _saving_columns(ranked, contents.by_key.get("costs"), contents.system)
    for heading, columns in ((title, _ranking_columns(ranked, contents.system)), ("Saving a year", savings)):
        if columns:
            made = plain_table(heading, columns, left=("compound",))
            for row in ranked.rows:
                made.add_row(*(plain_text(shown(row)) for shown in columns.values()))
            screen.print(made)
    if len(ranked.rows) == 1:
        screen.print("one compound has nothing to be compared with: name a second one with -c, today's first")
    show_notes(screen, contents.lines("warning"))


def _saving_columns(ranked: Table, costs: Table | None, system: System) -> dict[str, Callable[[Any], str]]:
    """Headings and cell functions of savings and paybacks; empty without prices."""
    saved = [] if costs is None else [column for column in costs.columns if column.key == "saving_per_year"]
    if not saved:
        return {}
    money, years = display_unit(saved[0].kind, system), display_unit("years", system)
    columns: dict[str, Callable[[Any], str]] = {
        "compound": lambda row: str(row.compound),
        _unit_heading("saved/yr", money): lambda row: _number_text(money, row.saving),
        _unit_heading("90 % interval", money): lambda row: _ends_text(money, row.savings),
    }
    if any(row.paybacks[0] is not None for row in ranked.rows):
        columns[_unit_heading("payback", years)] = lambda row: _number_text(years, row.payback)
        columns[_unit_heading("90 % interval ", years)] = lambda row: _ends_text(years, row.paybacks)
    return columns


def _ends_text(written: Unit, ends: tuple[float | None, float | None], between: str = " to ") -> str:
    return "" if None in ends else between.join(_number_text(written, end) for end in ends)


def _two_digits(percent: float) -> str:
    return f"{percent:+.0f}" if abs(percent) >= 10.0 else f"{percent:+.1f}"


def _ranking_columns(ranked: Table, system: System) -> dict[str, Callable[[Any], str]]:
    """Headings and cell functions of the ranking."""
    power, speed, warmth = (display_unit(kind, system, large=True) for kind in ("power", "speed", "temperature"))

    def change(row: Any) -> str:
        low, high = row.band
        if row.change is None:
            return ""
        ends = "" if low is None else f" ({_two_digits(100.0 * low)} to {_two_digits(100.0 * high)})"
        return f"{100.0 * row.change:+.1f}{ends}"

    columns: dict[str, Callable[[Any], str]] = {
        "compound": lambda row: str(row.compound),
        "rank": lambda row: "" if row.rank is None else f"{row.rank}",
    }
    if len({row.speed for row in ranked.rows}) > 1:
        columns[speed.sign] = lambda row: f"{speed.shown(row.speed):.4g}"
    columns[_unit_heading("mean", power)] = lambda row: _number_text(power, row.motor)
    if any(row.low is not None for row in ranked.rows):
        columns[_unit_heading("90 % band", power)] = lambda row: _ends_text(power, (row.low, row.high), "-")
    columns["change, 90 %\n[%]"] = change
    columns[_unit_heading("peak", power)] = lambda row: _number_text(power, row.peak)
    columns[_unit_heading("at", warmth)] = lambda row: (
        "" if row.temperature is None else f"{warmth.shown(row.temperature):g}"
    )
    return columns


def _unit_heading(words: str, written: Unit) -> str:
    return f"{words}\n[{written.sign}]"


def _number_text(written: Unit, given: float | None) -> str:
    if given is None:
        return ""
    value = written.shown(given)
    if math.isinf(value):
        return written.written(given)
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.1f}"


_OF_FLOODED_BELT: Final = {
    "cross-section of the bulk", "mass flow", "load of a carry set", "motor power", "maximum tension, all states"
}  # fmt: skip


def _flooded_text(table: Table, system: System) -> str:
    """Sentence on the flooded belt, or why it has no answer; the reports have every figure."""
    shown = [row for row in table.rows if row.label in _OF_FLOODED_BELT]
    large = ((row, display_unit(row.kind, system, large=True)) for row in shown)
    said = ", ".join(f"{row.called(system)} {unit.said(row.value)}" for row, unit in large)
    return f"flooded belt: {said}. {table.note if len(shown) == 1 else 'Nothing is checked by it.'}"


def show_dynamics(contents: Contents) -> None:
    """Print the scenarios, then checks that fail and assumptions."""
    shown = contents["scenarios"].only(*_SCENARIO_COLUMNS)
    screen = terminal_console()
    screen.print(report_grid(shown, contents.system, contents.document.title, large=True))
    if "scenario_sizes" in contents:
        _print_sizes(screen, contents)
    counted = [row.verdict for row in contents["checks"].rows]
    screen.print(f"\nchecks: {counted.count('pass')} pass, {counted.count('FAIL')} FAIL")
    show_notes(screen, [*contents.lines("warning"), *contents.lines("assumption")])


def _print_sizes(screen: Console, contents: Contents) -> None:
    """Print the sized values, their errors and governing checks."""
    shown = contents["scenario_sizes"]
    by_key = {column.key: column for column in shown.columns}
    for row in shown.rows:
        written = row.unit(contents.system)
        error, most = by_key["to"].get(row), by_key["serves_up_to"].get(row)
        said = f"{by_key['scenario'].get(row)}: {row.label} {written.said(by_key['found'].get(row))}"
        said += "" if error is None else f", to {percent(error, 1)}"
        said += "" if most is None else f"; up to {written.said(most)} serves"
        governs, why = by_key["governing_check"].get(row), by_key["what_fails_with_less"].get(row)
        said += f"; governed by {governs} ({why})" if governs else "; the least looked for serves"
        screen.print(plain_text(said))


def show_sizing(contents: Contents) -> None:
    """Print the designs, the reasons for their rank, and remarks."""
    from conveyor.report.merged_notes import merge_notes

    every = contents["designs"]
    title = f"{contents.document.title}: designs"
    screen = terminal_console()
    screen.print(report_grid(every.only(*_DESIGN_COLUMNS), contents.system, title, large=True))
    shown = every.only("top_cover", "bottom_cover", "belt_safety", "why", "closest_carry_sets").columns
    for rank, row in enumerate(every.rows, start=1):
        figures = {column.key: (column.kind, column.get(row)) for column in shown}
        said = {
            key: display_unit(kind, contents.system).said(value)
            for key, (kind, value) in figures.items()
            if value is not None
        }
        words = "{why}; top cover {top_cover}, bottom cover {bottom_cover}, belt safety {belt_safety}"
        words += "; carry sets from {closest_carry_sets} on, by the tension" if "closest_carry_sets" in said else ""
        screen.print(plain_text(f"{rank}: {words.format(**said)}"))
    screen.print(plain_text("\nbasis and limitations", style="bold"))
    for line in merge_notes(contents.lines("assumption")):
        screen.print(plain_text(wrap_line(line, screen.width, first="  - ", further="    ")))
