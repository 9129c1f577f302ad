"""What `conveyor size` shows: a line a design, why each stands where it does, what the ranks rest on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from conveyor.cli.terminal import console, grid, words, wrapped
from conveyor.report.notes import merged

if TYPE_CHECKING:
    from conveyor.report.columns import Contents

_SHOWN: Final = (
    "rank", "belt_width", "speed", "trough", "belt", "rolls", "carry_sets", "return_sets", "drives", "motors",
    "motor_power", "cost_a_year",
)  # fmt: skip


def show(contents: Contents) -> None:
    """Print the designs, what tells them apart, and remarks."""
    every = contents["designs"]
    title = f"{contents.document.title}: designs"
    screen = console()
    screen.print(grid(every.only(*_SHOWN), contents.system, title, large=True))
    why = next(column for column in every.columns if column.key == "why")
    for rank, row in enumerate(every.rows, start=1):
        screen.print(words(f"{rank}: {why.value(row)}"))
    screen.print(words("\nbasis and limitations", style="bold"))
    for line in merged(contents.lines("assumption")):
        screen.print(words(wrapped(line, screen.width, first="  - ", further="    ")))
