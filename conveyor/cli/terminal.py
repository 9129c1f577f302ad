"""How results look on a terminal: plain tables, no wider than it; figures in a system of units."""

from __future__ import annotations

import os
import sys
import textwrap
from typing import TYPE_CHECKING, Final

from conveyor.printable import printable
from conveyor.units import System, convert, display

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

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


def wrapped(line: str, width: int, *, first: str = "", further: str = "") -> str:
    """Break a line where the terminal ends, what follows indented."""
    return textwrap.fill(line, width - 1, initial_indent=first, subsequent_indent=further)


def force(value: float, system: System) -> str:
    """Write a force [N].

    Examples
    --------
    >>> force(168734.4, "SI"), force(168734.4, "US")
    ('168.73 kN', '37,933 lbf')
    """
    if system == "US":
        return _unsigned(f"{convert(value, 'force', 'US'):,.0f}") + " lbf"
    return _unsigned(f"{value / 1e3:,.2f}") + " kN"


def power(value: float, system: System) -> str:
    """Write a power [W].

    Examples
    --------
    >>> power(897500.0, "SI"), power(897500.0, "US")
    ('897.5 kW', '1,203.6 hp')
    """
    if system == "US":
        return _unsigned(f"{convert(value, 'power', 'US'):,.1f}") + " hp"
    return _unsigned(f"{value / 1e3:,.1f}") + " kW"


def shown(value: float, kind: str, system: System) -> str:
    """Write a figure of any other kind, its degrees with their sign.

    Examples
    --------
    >>> shown(293.15, "temperature", "SI"), shown(5.0, "speed", "US")
    ('20 °C', '984.3 fpm')
    """
    return display(value, kind, system).replace("degC", "°C").replace("degF", "°F")


def _unsigned(number: str) -> str:
    """Zero has no sign."""
    return number.removeprefix("-") if not number.strip("-0.,") else number
