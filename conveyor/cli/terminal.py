"""How results look on a terminal: plain tables, no wider than it."""

from __future__ import annotations

import os
import sys
import textwrap
from typing import TYPE_CHECKING, Final

from conveyor.printable import printable

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from conveyor.report.columns import Table as Part
    from conveyor.units import System

_PIPED: Final = 120  # columns where nobody's terminal limits them
_NARROWEST: Final = 40


def console() -> Console:
    """A console as wide as the terminal, or as `COLUMNS` says, or 120 where output is piped."""
    from rich.console import Console

    own = sys.stdout.isatty() or os.environ.get("COLUMNS", "").strip("0").isdecimal()
    return Console(highlight=False, width=max(Console().width, _NARROWEST) if own else _PIPED)


def words(text: str, style: str = "") -> Text:
    """Text for the terminal: not markup, and without control characters."""
    from rich.text import Text

    return Text(printable(text), style=style)


def table(title: str | None = None) -> Table:
    """A table without a frame: a line below its head, nothing that a file of text does not hold."""
    from rich import box
    from rich.table import Table

    return Table(
        title=None if title is None else words(title, "bold"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1),
    )


def grid(part: Part, system: System, title: str | None = None, *, large: bool = False) -> Table:
    """A table of the report, units below names; `large`: in kN where the report has N."""
    from conveyor.units.presentation import unit

    made = table(part.heading if title is None else title)
    for column in part.columns:
        sign = unit(column.kind, system, large=large).sign
        heading = f"{column.label}\n[{sign}]" if sign else column.label
        made.add_column(words(heading), justify="left" if column.kind == "text" else "right")
    for row in part.rows:
        cells = (
            unit(column.kind, system, large=True) if large else part.unit(column, row, system)
            for column in part.columns
        )
        written = [
            words(cell.written(column.get(row))) for cell, column in zip(cells, part.columns, strict=True)
        ]
        made.add_row(*written)
        for column, drawn, text in zip(part.columns, made.columns, written, strict=True):
            if column.kind != "text":  # words break where there is no room, numbers do not
                drawn.min_width = max(drawn.min_width or 0, text.cell_len)
    return made


def wrapped(line: str, width: int, *, first: str = "", further: str = "") -> str:
    """Break a line where the terminal ends, what follows indented."""
    return textwrap.fill(line, width - 1, initial_indent=first, subsequent_indent=further)
