"""Number cells: the decimal mark of a table, decided only where it is certain."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?")
_THOUSANDS_LIKE = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_DATE = re.compile(
    r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}.*|\d{1,2}[-. ]{1,2}(?:[A-Za-zäÄ]{3,9})\.?.*|.*\d{1,2}:\d{2}.*"
)
_WITH_UNIT = re.compile(r"[+-]?[\d.,]+(?:[eE][+-]?\d+)?\s*[A-Za-z%°µ].*")
_REASONS = (
    (
        re.compile(
            r"[+-]?\d[\d,' ]*[,' ][\d,' ]*\.?\d*(?:[eE][+-]?\d+)?|[+-]?\d[\d.' ]*[.' ][\d.' ]*,\d*(?:[eE][+-]?\d+)?"
        ),
        "has a thousands separator; export the numbers without it",
    ),
    (_DATE, "looks like a date or time; restore the number (Excel turns 1.2 into 1 Feb)"),
    (_WITH_UNIT, "holds a unit; write the number alone and the unit in the header"),
    (re.compile(r".*", re.DOTALL), "is not a number; delete the row, or put # in front if it is a remark"),
)
_LONGEST_CELL = 60
"""Longer cells are no numbers; patterns with two stars would take their time over them."""
_NOTHING = {
    "nan",
    "n/a",
    "na",
    "#n/a",
    "inf",
    "-inf",
    "+inf",
    "none",
    "null",
    "ovl",
    "ovf",
    "-",
    "--",
    "---",
    "*",
}
DATE_MARK = "date "
"""What a workbook cell holding a date begins with in the grid."""
PERCENT_MARK = "percent-format "
"""What a workbook cell shown as a percentage begins with in the grid."""


def is_number(cell: str) -> bool:
    """Whether a cell is one plain number, with either decimal mark.

    Parameters
    ----------
    cell : str
        Text of the cell [-].

    Returns
    -------
    bool
        True for `1.5`, `1,5`, `-2e+03`; False for `nan`, `1_000`, `1 000` [-].

    Examples
    --------
    >>> is_number("1,5E+06"), is_number("nan"), is_number("1 000")
    (True, False, False)
    """
    return NUMBER.fullmatch(cell) is not None


def decimal_mark(cells: Iterable[str]) -> tuple[str, str | None]:
    """The decimal mark of number cells, or the cell that leaves it open.

    Parameters
    ----------
    cells : iterable of str
        Cells that are numbers [-].

    Returns
    -------
    tuple
        `"."` or `","`, and None; or `""` and the first cell that is doubtful [-].

    Notes
    -----
    A comma is a decimal comma if no cell has a point and at least one cell cannot be a number with a
    thousands comma (`0,5`, `12,25`, `1,234E+06`). `6,800` alone could be 6.8 or 6800 and stays open.

    Examples
    --------
    >>> decimal_mark(["0,1", "6,800"]), decimal_mark(["6,800"]), decimal_mark(["0.1", "6,8"])
    ((',', None), ('', '6,800'), ('', '6,8'))
    """
    first_comma = None
    point = proof = False
    for cell in cells:
        if "," in cell:
            first_comma = first_comma or cell
            proof = proof or not _THOUSANDS_LIKE.fullmatch(cell)
        elif "." in cell:
            point = True
    if first_comma is None:
        return ".", None
    return (",", None) if proof and not point else ("", first_comma)


def why_not_a_number(cell: str) -> str:
    """What a cell holds instead of a number, and the remedy.

    Parameters
    ----------
    cell : str
        Text of the cell [-].

    Returns
    -------
    str
        Part of a message [-].

    Examples
    --------
    >>> why_not_a_number("10 Hz")
    "'10 Hz' holds a unit; write the number alone and the unit in the header"
    """
    if cell.startswith(PERCENT_MARK):
        value = cell.removeprefix(PERCENT_MARK)
        return (
            f"{value} is shown as a percentage, so the header and the stored number may differ by 100;"
            " set the cell format to Number and write the unit in the header"
        )
    if cell.startswith(DATE_MARK):
        return f"Excel made a date of it ({cell}); restore the number and format the column as Number"
    if cell.lower() in _NOTHING:
        return f"'{cell}' is not a finite number; delete the row, or repair the value"
    if len(cell) > _LONGEST_CELL:
        return f"'{cell[:_LONGEST_CELL]}...' is not a number; delete the row, or put # in front if it is a remark"
    reason = next(reason for pattern, reason in _REASONS if pattern.fullmatch(cell))
    return f"'{cell}' {reason}"


def to_floats(cells: Sequence[str], mark: str) -> list[float]:
    """Numbers of cells that all match `NUMBER`.

    Parameters
    ----------
    cells : sequence of str
        Shape `(n,)` [-].
    mark : str
        `"."` or `","` [-].

    Returns
    -------
    list of float
        Shape `(n,)`, in the unit of the file [unit].

    Examples
    --------
    >>> to_floats(["1,5", "-2e3"], ",")
    [1.5, -2000.0]
    """
    if mark == ",":
        return [float(cell.replace(",", ".")) for cell in cells]
    return [float(cell) for cell in cells]
