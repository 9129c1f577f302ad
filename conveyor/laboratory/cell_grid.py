"""A laboratory file as a grid of text cells, and errors located in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

from conveyor.errors import InputError

_LONGEST_LABEL: Final = 60
"""Characters of a column's name shown in a message."""


class AnswerableError(InputError):
    """A fault of a file that an option settles with certainty, so that reading can go on.

    Attributes
    ----------
    option : str
        Keyword of `conveyor.laboratory.read_dma`: exclude or ignore.
    value : str
        Rows or columns it has to name [-].
    """

    def __init__(self, message: object = "", *parts: object, option: str = "", value: str = "") -> None:
        super().__init__(message, *parts)
        self.option, self.value = option, value


class TextLine(NamedTuple):
    """One line of a text file or one row of a sheet."""

    number: int
    cells: tuple[str, ...]
    text: str
    comment: bool


@dataclass(frozen=True)
class TextGrid:
    """All lines of one text file or one sheet that are not blank.

    Attributes
    ----------
    name : str
        Start of messages: the file, for a workbook with its sheet.
    lines : tuple of TextLine
        In the order of the file.
    notes : tuple of str
        Decisions taken while reading: encoding, separator.
    sheet : str
        Empty for a text file; columns of a sheet are shown as letters.
    """

    name: str
    lines: tuple[TextLine, ...]
    notes: tuple[str, ...]
    sheet: str = ""

    def refusal(self, row: int, column: int, message: str, *, header: str = "") -> InputError:
        """Error that begins with file, row (from 1) and column (from 0)."""
        return cell_error(self.name, row, column, message, header=header, lettered=bool(self.sheet))

    def column(self, index: int) -> str:
        """Label of a column, counted from 0: its number from 1, or its letter."""
        return _column_label(index, lettered=bool(self.sheet))


def _column_label(index: int, *, lettered: bool) -> str:
    if not lettered:
        return str(index + 1)
    from openpyxl.utils import get_column_letter

    return get_column_letter(index + 1)


def cell_error(
    name: str, row: int, column: int, message: str, *, header: str = "", lettered: bool = False
) -> InputError:
    """Error of one line that begins with file, row (from 1) and column (from 0).

    Examples
    --------
    >>> print(cell_error("pad.csv", 3, 1, "not a number", header="E' [MPa]"))
    pad.csv:3: column 2 "E' [MPa]": not a number
    """
    shown = _column_label(column, lettered=lettered)
    label = f' "{header[:_LONGEST_LABEL]}"' if header else ""
    return InputError(" ".join(f"{name}:{row}: column {shown}{label}: {message}".split()))
