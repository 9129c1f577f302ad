"""Marks in output files, by which this program recognises them before it replaces one."""

from __future__ import annotations

import hashlib
import re
import sys
import zipfile
from contextlib import suppress
from functools import cache
from io import BytesIO
from typing import Final
from xml.etree import ElementTree as ET

REPORT: Final = "report workbook"
PAGE: Final = "report page"
FIGURE: Final = "figure"
COMPOUND: Final = "compound file"
TABLE: Final = "table"
STUDY: Final = "table: of a study"
DESIGN: Final = "unedited design"
FACTORS: Final = "unedited part of a spec"
NO_ANSWER_COLUMN: Final = "no answer because"
"""Heading of the last column of a table of a study."""
TO_FILL_IN: Final = "file to fill in"
"""A template or starter: made to be edited, so without a mark and never replaced without --force."""

FIT_HEADING: Final = "Written by conveyor fit"
"""First line of compound files."""
CATEGORY: Final = "conveyor report"
"""Document property of result workbooks."""
PARQUET: Final = "written by conveyor"
"""Metadata key of Parquet files."""

_BOM: Final = b"\xef\xbb\xbf"
_UNIT: Final = re.compile(r" ?\[[^\]]*\]")
_PDF_MARK: Final = re.compile(rb"/Keywords ?\(conveyor ")
_UNEDITED: Final = "# Written by conveyor {} ({}); a later run replaces it unless it was edited.\n"
_UNEDITED_KINDS: Final = {"size": DESIGN, "study": DESIGN, "optimise": DESIGN, "calibrate": FACTORS}
_LARGEST_PROPERTIES: Final = 20_000
_HEAD: Final = 4_000


@cache
def package_version(package: str) -> str:
    """Version of an installed package."""
    from importlib import metadata  # its import takes a tenth of `conveyor --help`

    said = getattr(sys.modules.get(package), "__version__", None)
    return str(said) if said is not None else metadata.version(package)


def program_version() -> str:
    """Program name and version that outputs are marked with."""
    return f"conveyor {package_version('conveyor')}"


def mark_unedited(text: str, command: str) -> bytes:
    r"""Encode a spec or a part of one below a line that tells whether it was edited since a command wrote it.

    Examples
    --------
    >>> written = mark_unedited("name: mine\n", "size")
    >>> output_kind(written)
    'unedited design'
    >>> output_kind(written.replace(b"mine", b"ours")) is None
    True
    """
    digest = hashlib.sha256(text.encode()).hexdigest()[:12]
    return f"{_UNEDITED.format(command, digest)}{text}".encode()


def output_kind(content: bytes) -> str | None:
    r"""Kind of output of this program, by the content of a file.

    Parameters
    ----------
    content : bytes
        The file.

    Returns
    -------
    str or None
        Kind, for tables with the headings without units (except of studies); None for other files.

    Examples
    --------
    >>> output_kind(b"# Written by conveyor fit\nname: mine\n")
    'compound file'
    >>> output_kind("\ufeffroll,force [N]\r\n1,5\r\n".encode())
    'table: roll,force'
    >>> output_kind("\ufeffpoint,belt.speed [m/s],no answer because\r\n".encode())
    'table: of a study'
    >>> output_kind(b"name: mine\n") is None
    True
    """
    head = content[:_HEAD]
    signs = {
        REPORT: content.startswith(b"PK") and _is_report(content),
        PAGE: b'<meta name="generator" content="conveyor ' in head
        or (head.startswith(b"%PDF") and _PDF_MARK.search(content) is not None),
        COMPOUND: head.startswith(b"# " + FIT_HEADING.encode() + b"\n"),
        FIGURE: (head.startswith(b"\x89PNG") and b"Software\0conveyor " in head)
        or (b"<svg" in head and b"<dc:title>conveyor " in head)
        or (head.startswith(b"%PDF") and b"/Creator (conveyor " in content),
        TABLE: content.startswith(b"PAR1") and PARQUET.encode() in content,
    }
    kind_there = next((kind for kind, known in signs.items() if known), None) or _unedited_kind(content)
    if kind_there is None and content.startswith(_BOM):
        headings = content.partition(b"\r\n")[0].decode("utf-8-sig", "replace")
        if headings.startswith(("point,", "design,")) and headings.endswith(f",{NO_ANSWER_COLUMN}"):
            return STUDY
        return f"{TABLE}: {_UNIT.sub('', headings)}"
    return kind_there


def _unedited_kind(content: bytes) -> str | None:
    """Kind of a spec, or of a part of one, that is as a command wrote it."""
    if not content.startswith(b"# Written by conveyor "):
        return None
    text = content.partition(b"\n")[2].decode("utf-8", "replace")
    return next((kind for name, kind in _UNEDITED_KINDS.items() if mark_unedited(text, name) == content), None)


def _is_report(content: bytes) -> bool:
    with suppress(zipfile.BadZipFile, KeyError, ET.ParseError, NotImplementedError, RuntimeError, EOFError, OSError):
        with zipfile.ZipFile(BytesIO(content)) as archive, archive.open("docProps/core.xml") as stream:
            properties = stream.read(_LARGEST_PROPERTIES)
        if b"<!DOCTYPE" not in properties:
            return any(node.text == CATEGORY for node in ET.fromstring(properties))  # noqa: S314
    return False
