"""What `conveyor size` shows: a line a design, why each stands where it does, what the ranks rest on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from conveyor.cli.terminal import console, table, words, wrapped
from conveyor.report.notes import merged
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from conveyor.report.columns import Contents

_SHOWN: Final = (
    "rank", "belt_width", "speed", "trough", "belt", "rolls", "carry_sets", "return_sets", "drives", "motors",
    "motor_power", "cost_a_year",
)  # fmt: skip


def show(contents: Contents) -> None:
    """Print the designs, what tells them apart, and remarks."""
    every = contents["designs"]
    shown = every.only(*_SHOWN)
    made = table(f"{contents.document.title}: designs")
    units = [unit(column.kind, contents.system, large=True) for column in shown.columns]
    for column, written in zip(shown.columns, units, strict=True):
        head = column.label if written.label is None else f"{column.label}\n[{written.sign}]"
        made.add_column(words(head), justify="left" if column.kind == "text" else "right")
    for row in shown.rows:
        cells = [column.get(row) for column in shown.columns]
        made.add_row(*(
            words("" if value is None else value if isinstance(value, str) else written.written(value))
            for value, written in zip(cells, units, strict=True)
        ))  # fmt: skip
    screen = console()
    screen.print(made)
    why = next(column for column in every.columns if column.key == "why")
    for rank, row in enumerate(every.rows, start=1):
        screen.print(words(f"{rank}: {why.get(row)}"))
    screen.print(words("\nbasis and limitations", style="bold"))
    for line in merged(contents.lines("assumption")):
        screen.print(words(wrapped(line, screen.width, first="  - ", further="    ")))
