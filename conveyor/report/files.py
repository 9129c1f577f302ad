"""Every table of the workbook as a file of its own: CSV or Parquet."""

from __future__ import annotations

from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import pandas as pd

from conveyor.display import chosen
from conveyor.errors import InputError
from conveyor.files.saving import save
from conveyor.report.columns import Contents
from conveyor.report.comparing import of_comparison
from conveyor.report.tables import of_analysis

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.studies import Studies
    from conveyor.studies.comparison import Comparison
    from conveyor.units import System

FileKind = Literal["csv", "parquet"]
_KINDS: Final = ("csv", "parquet")
_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r", "\n")
"""Beginnings that a spreadsheet reads as a formula when it opens a CSV file."""


def write(
    analysis: Analysis,
    folder: Path,
    studies: Studies | None = None,
    *,
    system: System | None = None,
    kind: FileKind = "csv",
) -> tuple[Path, ...]:
    """Write the tables of an analysis and of its studies, one file each, named as docs/workbook.md lists them.

    Parameters
    ----------
    analysis : Analysis
        What to report.
    folder : Path
        A folder that exists; files of the same names in it are replaced.
    studies : Studies, optional
        Load cases, duty and uncertainty.
    system : {"SI", "US"}, optional
        Units; without it those of the spec's report.
    kind : {"csv", "parquet"}
        Parquet needs the package pyarrow.

    Returns
    -------
    tuple of Path
        The files, in the order of the workbook.

    Raises
    ------
    InputError
        No such folder, it cannot be written to, an unknown system or kind, or Parquet without pyarrow.
    """
    shown = analysis.in_units(chosen(analysis.conveyor.report.units, system))
    _ready(folder, kind)
    return _written(of_analysis(shown, studies), folder, kind)


def write_comparison(
    comparison: Comparison, folder: Path, *, system: System | None = None, kind: FileKind = "csv"
) -> tuple[Path, ...]:
    """Write the tables of a comparison, one file each; as `write`.

    Raises
    ------
    InputError
        As `write`.
    """
    units = chosen(comparison.conveyor.report.units, system)
    _ready(folder, kind)
    return _written(of_comparison(comparison, units), folder, kind)


def _ready(folder: Path, kind: str) -> None:
    if kind not in _KINDS:
        raise InputError(f'kind = "{kind}": csv or parquet')
    if kind == "parquet" and find_spec("pyarrow") is None:
        raise InputError("Parquet needs the package pyarrow: pip install pyarrow; or write CSV")
    try:
        there = folder.is_dir()
    except OSError as error:
        raise InputError(f"{folder}: cannot be written to ({error.strerror or error})") from None
    if not there:
        raise InputError(f"{folder}: is no folder; create it or choose another")


def _written(found: Contents, folder: Path, kind: str) -> tuple[Path, ...]:
    encode = parquet if kind == "parquet" else csv
    files = {folder / f"{part.key}.{kind}": encode(part.frame(found.system)) for part in found.tables}
    save(files)
    return tuple(files)


def csv(frame: pd.DataFrame) -> bytes:
    r"""Write a table as CSV (RFC 4180; UTF-8 with its mark, so that Excel reads it so), no text of it a formula.

    Text that begins as a formula does (``= + - @``, a tab or a line break) has an apostrophe before it.

    Examples
    --------
    >>> csv(pd.DataFrame({"name": ["=1+1", "mine"], "power [kW]": [1.5, -2.0]})).decode("utf-8-sig")
    "name,power [kW]\r\n'=1+1,1.5\r\nmine,-2.0\r\n"
    """
    safe = pd.DataFrame(
        {_plain(str(name)): [_plain(value) for value in frame[name].tolist()] for name in frame.columns},
        dtype=object,
    )
    return safe.to_csv(index=False, lineterminator="\r\n").encode("utf-8-sig")


def _plain(value: object) -> object:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def parquet(frame: pd.DataFrame) -> bytes:
    """Write a table as Parquet; a column of numbers with gaps keeps its gaps."""
    content = BytesIO()
    frame.infer_objects().to_parquet(content, index=False, engine="pyarrow")
    return content.getvalue()
