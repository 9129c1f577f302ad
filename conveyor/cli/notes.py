"""Notes for a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from conveyor.cli.terminal import words

if TYPE_CHECKING:
    from rich.console import Console


def show(console: Console, notes: Sequence[str]) -> None:
    """Print notes as two short lists, their lines no wider than the terminal."""
    from conveyor.report.notes import HEADINGS, ordered

    for heading, colour, listed in zip(HEADINGS, ("bold yellow", "bold"), ordered(notes), strict=True):
        if listed:
            console.print(words(f"\n{heading}", style=colour))
        for note in listed:
            console.print(
                words(textwrap.fill(note, console.width - 1, initial_indent="  - ", subsequent_indent="    "))
            )
