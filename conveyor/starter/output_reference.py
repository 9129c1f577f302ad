"""Pages on what is written: docs/workbook.md and docs/nomenclature.md, of their words and the kinds of quantity."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.resources import files
from typing import Final

from conveyor.report.table_model import FIGURE_NAME, ROW_KIND
from conveyor.units.presentation import MONEY, display_unit
from conveyor.units.unit_systems import SYSTEMS, System

KIND: Final = "kind of quantity"
"""Heading of the column of a page's words that names kinds; a column for each system takes its place."""
SI_UNIT: Final = "unit of kind"
"""The same; one column with the units of SI takes its place."""
_CURRENCY: Final = "currency"
_BORDER: Final = re.compile(r"(?<!\\)\|")


def output_page(name: str) -> str:
    """Write a page: its words, with the units of the kinds that they name.

    Parameters
    ----------
    name : {"workbook", "nomenclature"}
        Which.

    Returns
    -------
    str
        Markdown.

    Examples
    --------
    >>> next(line for line in output_page("workbook").splitlines() if line.startswith("| `motor_power`"))
    '| `motor_power` | motor power | kW | hp |'
    """
    return "\n".join(_page_lines(page_words(name))) + "\n"


def page_words(name: str) -> str:
    """Return the words of a page, with kinds in place of units."""
    return files("conveyor._reference").joinpath(f"{name}.md").read_text(encoding="utf-8").rstrip("\n")


def table_cells(line: str) -> list[str]:
    r"""Return the cells of a row of a table.

    Examples
    --------
    >>> table_cells(r"| `outer_edge` | (a+\|e\|)/R |  |")
    ['`outer_edge`', '(a+\\|e\\|)/R', '']
    """
    return [cell.strip() for cell in _BORDER.split(line)[1:-1]]


def _page_lines(words: str) -> Iterator[str]:
    """Lines of a page; the cells of kinds are units in them."""
    place, of = None, tuple[str, ...]()
    for line in words.splitlines():
        cells = table_cells(line) if line.startswith("|") else []
        if not cells:
            place = None
        elif place is None:
            head = next((each for each in (KIND, SI_UNIT) if each in cells), None)
            place = len(cells) if head is None else cells.index(head)
            of = tuple(SYSTEMS) if head == KIND else ("SI",)
            cells[place : place + 1] = of if head == KIND else ["unit"] if head else []
        elif set(line) == {"|", "-"}:
            cells[place : place + 1] = ["---"] * len(of) if place < len(cells) else []
        else:
            cells[place : place + 1] = [
                _listed_units(cell, system) for cell in cells[place : place + 1] for system in of
            ]
        yield _table_row(cells) if cells else line


def _table_row(cells: list[str]) -> str:
    return f"|{'|'.join(cells)}|" if set(cells) == {"---"} else f"| {' | '.join(cells)} |"


def _listed_units(kinds: str, system: System) -> str:
    """Units of kinds, listed with commas."""
    return ", ".join(_header_unit(kind, system) for kind in kinds.split(", "))


def _header_unit(kind: str, system: System) -> str:
    """Header's unit of a kind; the currency is that of the spec's price."""
    if kind in {"", ROW_KIND, FIGURE_NAME}:
        return ""
    word, per, other = kind.partition("/")
    return f"{_CURRENCY}{per}{other}" if word == MONEY.strip() else display_unit(kind, system).label or ""
