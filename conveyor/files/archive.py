"""A workbook's archive looked through as a stream before anything is built of it: what would swell is refused."""

from __future__ import annotations

import re
import zipfile
import zlib
from dataclasses import dataclass
from io import BytesIO
from typing import IO, Final
from xml.parsers import expat

from conveyor.errors import InputError

LAST_ROW: Final = 1_048_576
LAST_COLUMN: Final = 16_384
"""Of a sheet (Excel specifications and limits)."""
DEEPEST: Final = 100
"""Levels of XML; a chart has twenty."""

_PIECE: Final = 1 << 16
_SPANNED: Final = {"mergeCell", "hyperlink"}
"""Elements whose range a reader writes out cell by cell."""
_LONGEST_TAG: Final = 4 * _PIECE
_REFERENCE: Final = re.compile(r"\$?([A-Za-z]{1,4})\$?([0-9]{1,12})")
_DAMAGED: Final = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    OSError,
    NotImplementedError,
    RuntimeError,
    ValueError,
)


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What the parts of an archive may hold together.

    Attributes
    ----------
    content : int
        Bytes, unpacked, as the archive states them (no more is ever unpacked).
    parts : int
        Files in it.
    elements : int
        Elements of XML (cells, rows, comments, styles) and ranges that one of them names.
    expected : str
        What it should be, for the message on a larger one ("input workbook").
    """

    content: int
    parts: int
    elements: int
    expected: str


def look_through(content: bytes, name: str, limits: Limits) -> None:
    """Refuse an archive whose parts would take long or much to read, without building anything of them.

    Parameters
    ----------
    content : bytes
        The file.
    name : str
        Its name in messages.
    limits : Limits
        What it may hold.

    Raises
    ------
    InputError
        No archive, damaged, protected, more than the limits, a declared document type (entities), nested too deep, a
        cell beyond the last of a sheet, or ranges of merged cells or links over more cells than `limits.elements`.
    """
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            problem = _problem(archive, limits)
    except _DAMAGED:
        raise InputError(f"{name}: damaged or cut short; copy it again") from None
    if problem:
        raise InputError(f"{name}: {problem}")


def _problem(archive: zipfile.ZipFile, limits: Limits) -> str:
    parts = archive.infolist()
    if len(parts) > limits.parts or sum(part.file_size for part in parts) > limits.content:
        return (
            f"unpacks to more than {limits.content:,} bytes or {limits.parts:,} parts; "
            f"this is no {limits.expected}"
        )
    if any(part.flag_bits & 1 for part in parts):
        return "protected by a password; save it without one"
    seen = _Seen(limits)
    for part in parts:
        with archive.open(part) as stream:
            seen.part(stream, part.filename)
        if seen.problem:
            return seen.problem
    return ""


class _Seen:
    """Counts what the parts hold, and stops at the first thing that is not allowed."""

    def __init__(self, limits: Limits) -> None:
        self.problem = ""
        self._limits = limits
        self._elements = self._spanned = self._depth = 0
        self._name = ""

    def part(self, stream: IO[bytes], name: str) -> None:
        """Read a part to its end (its checksum with it), as XML until it is none."""
        self._name, self._depth = name, 0
        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartDoctypeDeclHandler = self._doctype
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        is_xml, read = True, 0
        while piece := stream.read(_PIECE):
            read += len(piece)
            if is_xml:
                try:
                    parser.Parse(piece)
                    if (
                        read - parser.CurrentByteIndex > _LONGEST_TAG
                    ):  # each piece of one is parsed from its beginning
                        self._stop(f"has a tag of more than {_LONGEST_TAG:,} bytes")
                except expat.ExpatError:  # a picture, or damage that the reader of the workbook will meet
                    is_xml = False
            if self.problem:
                return

    def _refuse(self, problem: str) -> None:
        self.problem = self.problem or problem

    def _doctype(self, *_: object) -> None:
        self._refuse(f"{self._name} declares a document type, which no workbook does")
        raise expat.ExpatError

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._elements += 1 + attributes.get("sqref", "").count(" ")
        self._depth += 1
        if self._elements > self._limits.elements:
            self._stop(f"holds more than {self._limits.elements:,} cells and other elements")
        if self._depth > DEEPEST:
            self._stop(f"is nested deeper than {DEEPEST} levels")
        element = tag.rpartition("}")[2]
        if element in _SPANNED:
            self._spanned += _cells(attributes.get("ref", ""))
            if self._spanned > self._limits.elements:
                self._stop(
                    f"merges or links more than {self._limits.elements:,} cells ({attributes['ref'][:40]}); "
                    "unmerge them"
                )
        elif element in {"row", "c"} and not _on_sheet(attributes.get("r", "")):
            self._stop(f"has a cell or row {attributes['r'][:40]}, beyond the last of a sheet")

    def _stop(self, said: str) -> None:
        self._refuse(f"{self._name} {said}; this is no {self._limits.expected}")
        raise expat.ExpatError

    def _end(self, _: str) -> None:
        self._depth -= 1


def _cells(ranged: str) -> int:
    """Cells of a range such as B2:C5; of one without rows or columns as many as a sheet has."""
    count = 0
    for one in ranged.split():
        ends = [_REFERENCE.fullmatch(end) for end in one.split(":")]
        corners = [(int(end[2]), _column(end[1])) for end in ends if end is not None]
        if len(corners) < len(ends):
            return LAST_ROW * LAST_COLUMN
        rows, columns = zip(*corners, strict=True)
        count += (max(rows) - min(rows) + 1) * (max(columns) - min(columns) + 1)
    return count


def _column(letters: str) -> int:
    number = 0
    for letter in letters.upper():
        number = 26 * number + ord(letter) - ord("A") + 1
    return number


def _on_sheet(reference: str) -> bool:
    """Whether a row's number or a cell's name is one that a sheet has; what is neither is for the reader to refuse."""
    if reference.isdecimal():
        return len(reference) < 9 and int(reference) <= LAST_ROW
    found = _REFERENCE.fullmatch(reference)
    return found is None or (_column(found[1]) <= LAST_COLUMN and int(found[2]) <= LAST_ROW)
