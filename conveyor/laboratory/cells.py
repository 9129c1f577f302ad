"""A laboratory file as a grid of text cells that know their place, and the refusal that names it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from conveyor.errors import InputError

_LONGEST_LABEL = 60
"""Characters of a column's name shown in a message."""


class TextLine(NamedTuple):
    """One line of a text file or one row of a sheet."""

    number: int
    cells: tuple[str, ...]
    text: str
    comment: bool


@dataclass(frozen=True)
class TextGrid:
    """All lines of one text file or one sheet.

    Parameters
    ----------
    name : str
        What messages begin with: the file, for a workbook with its sheet [-].
    lines : tuple of Line
        Lines that are not blank, in the order of the file [-].
    notes : tuple of str
        Decisions taken while reading: encoding, separator [-].
    lettered : bool
        Columns are shown as letters, as a spreadsheet does [-].
    sheet : str
        Name of the sheet, empty for a text file [-].
    """

    name: str
    lines: tuple[TextLine, ...]
    notes: tuple[str, ...]
    lettered: bool = False
    sheet: str = ""

    def refusal(self, row: int, column: int, message: str, *, header: str = "") -> InputError:
        """Error that begins with file, row and column.

        Parameters
        ----------
        row : int
            Line or row in the file, from 1 [-].
        column : int
            Column, from 0 [-].
        message : str
            What is refused and the remedy [-].
        header : str
            Name of the column in the file [-].

        Returns
        -------
        InputError
            To be raised by the caller [-].
        """
        return refusal(self.name, row, column, message, header=header, lettered=self.lettered)


def refusal(
    name: str, row: int, column: int, message: str, *, header: str = "", lettered: bool = False
) -> InputError:
    """One-line error with its place.

    Parameters
    ----------
    name : str
        File [-].
    row : int
        Line or row, from 1 [-].
    column : int
        Column, from 0 [-].
    message : str
        What is refused and the remedy [-].
    header : str
        Name of the column in the file [-].
    lettered : bool
        Column as a letter [-].

    Returns
    -------
    InputError
        To be raised by the caller [-].

    Examples
    --------
    >>> print(refusal("pad.csv", 3, 1, "not a number", header="E' [MPa]"))
    pad.csv:3: column 2 "E' [MPa]": not a number
    """
    shown = column_letter(column) if lettered else str(column + 1)
    label = f' "{header[:_LONGEST_LABEL]}"' if header else ""
    return InputError(" ".join(f"{name}:{row}: column {shown}{label}: {message}".split()))


def column_letter(column: int) -> str:
    """Spreadsheet letters of a column.

    Parameters
    ----------
    column : int
        From 0 [-].

    Returns
    -------
    str
        A, B, ... Z, AA, ... [-].

    Examples
    --------
    >>> column_letter(0), column_letter(27)
    ('A', 'AB')
    """
    letters = ""
    rest = column + 1
    while rest:
        rest, digit = divmod(rest - 1, 26)
        letters = chr(ord("A") + digit) + letters
    return letters
