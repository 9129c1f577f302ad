"""Every table of the workbook as a file of its own: CSV or Parquet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from conveyor.errors import InputError

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.comparison import Comparison
    from conveyor.studies import Studies
    from conveyor.units import System

FileKind = Literal["csv", "parquet"]


def write(
    analysis: Analysis,
    folder: Path,
    studies: Studies | None = None,
    *,
    system: System | None = None,
    kind: FileKind = "csv",
) -> tuple[Path, ...]:
    """Write the tables of an analysis."""
    raise InputError(
        f"{folder}: tables are not written yet ({analysis.conveyor.name}, {studies}, {system}, {kind})"
    )


def write_comparison(
    comparison: Comparison, folder: Path, *, system: System | None = None, kind: FileKind = "csv"
) -> tuple[Path, ...]:
    """Write the tables of a comparison."""
    raise InputError(f"{folder}: tables are not written yet ({comparison.base}, {system}, {kind})")
