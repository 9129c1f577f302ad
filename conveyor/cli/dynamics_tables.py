"""What `conveyor dynamics` shows: a line a scenario, what fails, what the figures rest on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from conveyor.cli import notes
from conveyor.cli.terminal import console, grid, words
from conveyor.units.sentences import percent

if TYPE_CHECKING:
    from rich.console import Console

    from conveyor.report.columns import Contents

_SHOWN: Final = (
    "scenario", "highest_tension", "at", "in", "lowest_tension", "lowest_at", "lowest_in", "comes_to_rest", "way",
)  # fmt: skip


def show(contents: Contents) -> None:
    """Print the scenarios, then checks that fail and assumptions."""
    shown = contents["scenarios"].only(*_SHOWN)
    screen = console()
    screen.print(grid(shown, contents.system, contents.document.title, large=True))
    if "scenario_sizes" in contents:
        _sizes(screen, contents)
    counted = [row.verdict for row in contents["checks"].rows]
    screen.print(f"\nchecks: {counted.count('pass')} pass, {counted.count('FAIL')} FAIL")
    notes.show(screen, [*contents.lines("warning"), *(f"{line}" for line in contents.lines("assumption"))])


def _sizes(screen: Console, contents: Contents) -> None:
    """What was sought, how well it is known, and what decides."""
    shown = contents["scenario_sizes"]
    by_key = {column.key: column for column in shown.columns}
    for row in shown.rows:
        written = row.unit(contents.system)
        error, most = by_key["to"].value(row), by_key["serves_up_to"].value(row)
        said = f"{by_key['scenario'].value(row)}: {row.label} {written.said(by_key['found'].value(row))}"
        said += "" if error is None else f", to {percent(error, 1)}"
        said += "" if most is None else f"; up to {written.said(most)} serves"
        governs, why = by_key["governing_check"].value(row), by_key["what_fails_with_less"].value(row)
        said += f"; governed by {governs} ({why})" if governs else "; the least looked for serves"
        screen.print(words(said))
