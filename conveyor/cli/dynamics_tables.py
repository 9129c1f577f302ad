"""What `conveyor dynamics` shows: a line a scenario, what fails, what the figures rest on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from conveyor.cli import notes
from conveyor.cli.terminal import console, table, words
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from conveyor.report.columns import Contents

_SHOWN: Final = (
    "scenario", "highest_tension", "at", "in", "lowest_tension", "lowest_at", "lowest_in", "comes_to_rest", "way",
)  # fmt: skip


def show(contents: Contents) -> None:
    """Print the scenarios, then checks that fail and assumptions."""
    shown = contents["scenarios"].only(*_SHOWN)
    made = table(contents.document.title)
    units = [unit(column.kind, contents.system, large=True) for column in shown.columns]
    for column, written in zip(shown.columns, units, strict=True):
        left = column.kind == "text"
        head = column.label if left else f"{column.label}\n[{written.sign}]"
        made.add_column(words(head), justify="left" if left else "right")
    for row in shown.rows:
        cells = [column.get(row) for column in shown.columns]
        made.add_row(*(
            words("" if value is None else value if isinstance(value, str) else f"{written.shown(value):,.1f}")
            for value, written in zip(cells, units, strict=True)
        ))  # fmt: skip
    screen = console()
    screen.print(made)
    counted = [row.verdict for row in contents["checks"].rows]
    screen.print(f"\nchecks: {counted.count('pass')} pass, {counted.count('FAIL')} FAIL")
    notes.show(screen, [*contents.lines("warning"), *(f"{line}" for line in contents.lines("assumption"))])
