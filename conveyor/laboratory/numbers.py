"""Number cells: recognise numbers, and the decimal mark of a table where it is certain."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_NUMBER: Final = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?")
_THOUSANDS_LIKE: Final = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_THOUSANDS: Final = (
    r"[+-]?\d[\d,' ]*[,' ][\d,' ]*\.?\d*(?:[eE][+-]?\d+)?|[+-]?\d[\d.' ]*[.' ][\d.' ]*,\d*(?:[eE][+-]?\d+)?"
)
_GROUPED_DIGITS: Final = re.compile(r"[+-]?\d{1,3}(?:(?:[.']\d{3})+,\d*|(?:[,']\d{3})+\.\d*)")
_DATE: Final = r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}.*|\d{1,2}[-. ]{1,2}(?:[A-Za-zäÄ]{3,9})\.?.*|.*\d{1,2}:\d{2}.*"
_REASONS: Final = (
    (_THOUSANDS, "has a thousands separator; export the numbers without it"),
    (_DATE, "looks like a date or time; restore the number (Excel turns 1.2 into 1 Feb)"),
    (
        r"[+-]?[\d.,]+(?:[eE][+-]?\d+)?\s*[A-Za-z%°µ].*",
        "holds a unit; write the number alone and the unit in the header",
    ),
)
_NO_NUMBER: Final = "is not a number; delete the row, or put # in front if it is a remark"
_LONGEST_CELL: Final = 60
"""Longer cells are no numbers; patterns with two stars would be slow on them."""
_NO_READINGS: Final = frozenset({
    "nan", "n/a", "na", "n.a.", "k.a.", "#n/a", "inf", "-inf", "+inf", "none", "null", "ovl", "ovf", "o.l.", "ol",
    "overload", "over load", "overrange", "over range", "overflow", "over", "err", "error", "invalid", "-", "*",
})  # fmt: skip
_SIGNS: Final = re.compile(r"[-–—*#.?]{2,}")
DATE_MARK: Final = "date "
"""Prefix of a workbook cell that holds a date."""
PERCENT_MARK: Final = "percent-format "
"""Prefix of a workbook cell shown as a percentage."""


_HALF_WIDTH: Final = {code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)} | str.maketrans("−　【】", "- []")
"""Full-width signs of Chinese and Japanese, the minus sign, the wide blank."""


def half_width(text: str) -> str:
    """Text with full-width signs, as of Chinese and Japanese programs, as ASCII.

    Examples
    --------
    >>> half_width("（ＭＰａ）　１．５")
    '(MPa) 1.5'
    """
    return text if text.isascii() else text.translate(_HALF_WIDTH)


def is_number(cell: str) -> bool:
    """True for one plain number, with either decimal mark.

    Examples
    --------
    >>> is_number("1,5E+06"), is_number("nan"), is_number("1 000")
    (True, False, False)
    """
    return _NUMBER.fullmatch(cell) is not None


def last_digit(cell: str) -> float:
    """Value of one in the last digit of a number; trailing zeros of a whole number do not count.

    Examples
    --------
    >>> last_digit("6,80"), last_digit("1.2E+06"), last_digit("6800000")
    (0.01, 100000.0, 100000.0)
    """
    mantissa, _, power = cell.replace(",", ".").lower().partition("e")
    whole, mark, decimals = mantissa.partition(".")
    place = -len(decimals) if mark else len(whole) - len(whole.rstrip("0"))
    return float(10.0 ** (place + int(power or 0)))


def looks_like_number(cell: str) -> bool:
    """True for a number, with or without thousands separators.

    Examples
    --------
    >>> looks_like_number("3.781,12"), looks_like_number("0,5;3.781"), looks_like_number("E' [kPa]")
    (True, False, False)
    """
    return is_number(cell) or _GROUPED_DIGITS.fullmatch(cell) is not None


def decimal_mark(cells: Iterable[str]) -> tuple[str, str | None]:
    """Decimal mark of number cells and None; or "" and the first ambiguous cell.

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
    """Message on a cell that is not a number, with the remedy.

    Examples
    --------
    >>> why_not_a_number("10 Hz")
    "'10 Hz' holds a unit; write the number alone and the unit in the header"
    """
    if cell.startswith(PERCENT_MARK):
        return (
            f"{cell.removeprefix(PERCENT_MARK)} is shown as a percentage, so the header and the stored number may"
            " differ by 100; set the cell format to Number and write the unit in the header"
        )
    if cell.startswith(DATE_MARK):
        return f"Excel made a date of it ({cell}); restore the number and format the column as Number"
    if cell.lower() in _NO_READINGS or _SIGNS.fullmatch(cell):
        return f"'{cell}' is not a finite number; delete the row, or repair the value"
    if len(cell) > _LONGEST_CELL:
        return f"'{cell[:_LONGEST_CELL]}...' {_NO_NUMBER}"
    said = (reason for pattern, reason in _REASONS if re.fullmatch(pattern, cell))
    return f"'{cell}' {next(said, _NO_NUMBER)}"
