"""Delimited text to a grid; the separator follows from the rows of numbers."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Final

from conveyor.laboratory.cell_grid import TextGrid, TextLine, cell_error
from conveyor.laboratory.numbers import half_width, is_number, looks_like_number

_SEPARATORS: Final = {"\t": "tab", ";": "semicolon", ",": "comma", " ": "blanks"}
_COMMENT: Final = re.compile(r"\s*(?:#+|%+(?!\s*[;,\t])|//+|!+)\s?")
"""A lone % before a separator is a unit, not the sign of a remark."""
_SAMPLE_LINES: Final = 400
"""Lines sampled to find the separator; every line is checked when it is read."""
_LONGEST_LINE: Final = 200_000
"""Characters; the 16,384 columns of a worksheet with twelve characters each."""


def text_grid(text: str, name: str, note: str) -> TextGrid:
    r"""Split a text into cells without surrounding blanks; trailing empty cells and blank lines are left out.

    Notes
    -----
    The separator is the one that turns most lines into rows of two or more numbers. A line of text (a header)
    that this separator does not split into as many cells as the rows have is tried with the others.

    Raises
    ------
    LaboratoryError
        If a line is longer than a row of a worksheet can be.

    Examples
    --------
    >>> grid = text_grid("# f (Hz)\tE' (Pa)\n1,0;2,5\n", "pad.txt", "encoding: ASCII")
    >>> [line.cells for line in grid.lines], grid.notes[1]
    ([('f (Hz)', "E' (Pa)"), ('1,0', '2,5')], 'separator: semicolon')
    """
    raw = [
        (number, line)
        for number, line in enumerate(re.split(r"\r\n|\n|\r", half_width(text)), start=1)
        if line.strip() and not re.fullmatch(r"\s*sep=.\s*", line)
    ]
    for number, line in raw:
        if len(line) > _LONGEST_LINE:
            what = f"a line of {len(line):,} characters; a table of a laboratory has at most {_LONGEST_LINE:,}"
            raise cell_error(name, number, 0, what)
    separator, width = _find_separator([line for _, line in raw if not _COMMENT.match(line)])
    lines = []
    for number, line in raw:
        comment = _COMMENT.match(line)
        body = line[comment.end() :] if comment else line
        cells = _split_line(body, separator)
        if (comment or len(cells) != width) and not any(map(is_number, cells)):
            cells = _split_words(body, separator, width)
        lines.append(TextLine(number, cells, body.strip(), comment is not None))
    return TextGrid(name, tuple(lines), (note, f"separator: {_SEPARATORS[separator]}"))


def table_lines(text: str, is_header: Callable[[Sequence[str]], bool] | None = None) -> list[TextLine]:
    """Lines of a table, separated as its header or first line; # begins a remark."""
    written = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    said = [line for _, line in written if not line.lstrip().startswith("#")]
    usual = max("\t;,", key=(said[0] if said else "").count)
    headers = (s for line in said for s in "\t;," if is_header is not None and is_header(_quoted_cells(line, s)))
    separator = next(headers, usual)
    return [
        TextLine(number, _quoted_cells(line, separator), line.strip(), line.lstrip().startswith("#"))
        for number, line in written
    ]


def _quoted_cells(line: str, separator: str) -> tuple[str, ...]:
    """Cells of a line, quoted or not, without surrounding blanks."""
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return tuple(cell.strip() for cell in cells)


def _find_separator(lines: list[str]) -> tuple[str, int]:
    """Separator, and the usual number of cells of rows of numbers."""
    sample = lines[:: max(1, len(lines) // _SAMPLE_LINES)]
    best, best_score, best_width = ",", (0, 0), 0
    for separator in _SEPARATORS:
        rows = [_split_line(line, separator) for line in sample]
        counts = [(len(row), sum(map(looks_like_number, row)), sum(map(bool, row))) for row in rows]
        widths = [width for width, numbers, filled in counts if numbers >= 2 and 2 * numbers >= filled]
        score = (sum(numbers == filled and numbers >= 2 for _, numbers, filled in counts), len(widths))
        if score > best_score:
            best, best_score, best_width = separator, score, Counter(widths).most_common(1)[0][0]
    return best, best_width


def _split_line(line: str, separator: str) -> tuple[str, ...]:
    if separator == " ":
        return tuple(line.split())
    if '"' in line and re.search(rf'(?:^|{separator})\s*"', line):
        with suppress(csv.Error):  # a field longer than the reader allows: no number, whatever its quotes
            return _trim_cells(next(csv.reader([line], delimiter=separator, skipinitialspace=True)))
    return _trim_cells(line.split(separator))


def _split_words(line: str, separator: str, width: int) -> tuple[str, ...]:
    """Split a line of words by whichever separator gives the width of the rows: blanks may be part of a name."""
    ways = [_split_line(line, s) for s in (separator, "\t", ";", ",") if s != " "]
    ways.append(_trim_cells(re.split(r"\s{2,}|\t", line.strip())))
    ways.append(_trim_cells(re.split(r"\s+(?![\[(])", line.strip())))
    usual = ways[-2] if separator == " " else ways[0]
    return next((cells for cells in ways if len(cells) == width), usual)


def _trim_cells(parts: list[str]) -> tuple[str, ...]:
    cells = [part.strip() for part in parts]
    while cells and not cells[-1]:
        cells.pop()
    return tuple(cells)
