"""Tables of the workbook as files: CSV or Parquet."""

from __future__ import annotations

from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.files.atomic_write import save_files
from conveyor.report.table_model import Contents
from conveyor.text.printable import escape_controls

if TYPE_CHECKING:
    import pandas as pd

FileKind = Literal["csv", "parquet"]
_KINDS: Final = ("csv", "parquet")
_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r", "\n")
"""First characters that a spreadsheet reads as a formula in a CSV file."""


def write_tables(contents: Contents, folder: Path, kind: FileKind = "csv") -> tuple[Path, ...]:
    """Write the tables of a report, one file each, named as docs/workbook.md lists them.

    Parameters
    ----------
    contents : Contents
        Its tables, in their unit system.
    folder : Path
        A folder that exists; files of the same names in it are replaced.
    kind : {"csv", "parquet"}
        Parquet needs the package pyarrow.

    Returns
    -------
    tuple of Path
        The files, in the order of the workbook.

    Raises
    ------
    InputError
        No such folder, it cannot be written to, an unknown kind, or Parquet without pyarrow.
    """
    if kind not in _KINDS:
        raise InputError(f'kind = "{kind}": csv or parquet')
    if kind == "parquet" and find_spec("pyarrow") is None:
        raise InputError('Parquet needs the package pyarrow: pip install "conveyor[parquet]"; or write CSV')
    try:
        there = folder.is_dir()
    except OSError as error:
        raise InputError(f"{folder}: cannot be written to ({error.strerror or error})") from None
    if not there:
        raise InputError(f"{folder}: is no folder; create it or choose another")
    made = encode_tables(contents, folder, kind)
    save_files(made)
    return tuple(made)


def encode_tables(contents: Contents, folder: Path, kind: FileKind = "csv") -> dict[Path, bytes]:
    """Encode the tables of a report, by path; as `write_tables`."""
    encode = parquet_bytes if kind == "parquet" else csv_bytes
    return {folder / f"{part.key}.{kind}": encode(part.frame(contents.system)) for part in contents.tables}


def csv_bytes(frame: pd.DataFrame) -> bytes:
    r"""Encode a table as CSV (RFC 4180; UTF-8 with BOM for Excel).

    Text that begins as a formula does (``= + - @``, a tab or a line break) gets an apostrophe before it.

    Examples
    --------
    >>> import pandas as pd
    >>> csv_bytes(pd.DataFrame({"name": ["=1+1", "mine"], "power [kW]": [1.5, -2.0]})).decode("utf-8-sig")
    "name,power [kW]\r\n'=1+1,1.5\r\nmine,-2.0\r\n"
    """
    import pandas as pd

    safe = pd.DataFrame(
        {csv_cell(str(name)): [csv_cell(value) for value in frame[name].tolist()] for name in frame.columns},
        dtype=object,
    )
    return safe.to_csv(index=False, lineterminator="\r\n").encode("utf-8-sig")


def csv_cell(value: object) -> object:
    """Cell of a CSV file, escaped so that no text is read as a formula."""
    if not isinstance(value, str):
        return value
    return f"'{escape_controls(value)}" if value.startswith(_FORMULA) else escape_controls(value)


def parquet_bytes(frame: pd.DataFrame) -> bytes:
    """Encode a table as Parquet; missing numbers stay missing."""
    content = BytesIO()
    marked = frame.infer_objects()
    marked.attrs = {output_marks.PARQUET: output_marks.program_version()}
    marked.to_parquet(content, index=False, engine="pyarrow")
    return content.getvalue()
