"""The table of a study, one row a point: written row by row, so that its size does not matter."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from conveyor.errors import InputError
from conveyor.files import marks
from conveyor.files.saving import growing
from conveyor.report.files import plain
from conveyor.units import System, quantity
from conveyor.units.presentation import MONEY, labelled, unit

if TYPE_CHECKING:
    from conveyor.models.study import StudyPlan, Value
    from conveyor.studies.campaign import Point
    from conveyor.studies.points import Output

_ROWS: Final = 10_000  # of a group of a Parquet file

Cells = tuple[Any, ...]


class CampaignTable:
    """Headings and cells of a study's table in a system of units.

    Parameters
    ----------
    plan : StudyPlan
        What varies: its columns have the unit of their first value.
    outputs : sequence of Output
        Figures, in the system's units.
    system : {"SI", "US"}
        Of the figures.
    currency : str
        Of costs.
    """

    def __init__(self, plan: StudyPlan, outputs: Sequence[Output], system: System, currency: str) -> None:
        first = next(plan.points())
        inputs = [_input(path, first[path]) for path in plan.paths]
        self._read = [read for _, read in inputs]
        self._shown = [
            unit(f"{MONEY}{currency}" if output.kind == "money" else output.kind, system)
            for output in outputs
        ]
        figures = [labelled(one.label, sign.label) for one, sign in zip(outputs, self._shown, strict=True)]
        self.headings = ("point", *(heading for heading, _ in inputs), *figures, "no answer because")

    def cells(self, point: Point) -> Cells:
        """A row."""
        number, values, answer = point
        given = [read(value) for read, value in zip(self._read, values, strict=True)]
        if isinstance(answer, str):
            return (number, *given, *(None for _ in self._shown), answer)
        figures = (None if x is None else sign(x) for x, sign in zip(answer, self._shown, strict=True))
        return (number, *given, *figures, None)

    @property
    def mark(self) -> str:
        """What an older file of this table is."""
        return marks.mark(_line(self.headings).encode("utf-8-sig")) or marks.TABLE

    def write(self, path: Path, points: Iterable[Point]) -> int:
        """Write the table as its name ends, `.csv` or `.parquet`; the file is there when it is whole.

        Returns
        -------
        int
            Rows.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        rows = map(self.cells, points)
        with growing(path) as temporary:
            return self._parquet(temporary, rows) if path.suffix == ".parquet" else self._csv(temporary, rows)

    def _csv(self, path: Path, rows: Iterator[Cells]) -> int:
        count = 0
        with path.open("w", encoding="utf-8-sig", newline="") as file:
            file.write(_line(self.headings))
            for count, row in enumerate(rows, start=1):  # noqa: B007 the number of rows
                file.write(_line(row))
        return count

    def _parquet(self, path: Path, rows: Iterator[Cells]) -> int:
        import pyarrow as pa
        from pyarrow import parquet

        count, writer = 0, None
        while part := list(islice(rows, _ROWS)):
            columns = dict(zip(self.headings, zip(*part, strict=True), strict=True))
            if writer is None:
                known = pa.schema([(name, _type(values, pa)) for name, values in columns.items()])
                writer = parquet.ParquetWriter(path, known.with_metadata({marks.PARQUET: marks.maker()}))
            writer.write_table(pa.table(columns, schema=writer.schema))
            count += len(part)
        if writer is not None:
            writer.close()
        return count


def _type(values: Sequence[Any], pa: Any) -> Any:
    known = [value for value in values if value is not None]
    if known and all(isinstance(value, int) for value in known):
        return pa.int64()
    return pa.string() if not known or any(isinstance(value, str) for value in known) else pa.float64()


def _line(cells: Iterable[Any]) -> str:
    line = io.StringIO()
    csv.writer(line).writerow(["" if cell is None else plain(cell) for cell in cells])
    return line.getvalue()


def _input(path: str, first: Value) -> tuple[str, Callable[[Value], Any]]:
    """Heading of a field that varies, and how its values are written: quantities in the unit of the first."""
    if not isinstance(first, str):
        return path, lambda value: value
    try:
        like = quantity(first)
    except InputError:
        return path, lambda value: value
    sign = first.strip().partition(" ")[2].strip()

    def read(value: Value) -> Any:
        return float(f"{quantity(str(value)).to(like.units).magnitude:.12g}")

    return labelled(path, sign), read
