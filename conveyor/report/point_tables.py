"""Tables of a study, one row per point or design, streamed row by row."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from conveyor.errors import InputError
from conveyor.files import output_marks
from conveyor.files.atomic_write import partial_file
from conveyor.report.table_files import csv_cell
from conveyor.studies.evaluation import varied_fields
from conveyor.studies.points import OUTPUTS, round_for_storage
from conveyor.units import System
from conveyor.units.presentation import MONEY, Unit, display_unit, label_with_unit

if TYPE_CHECKING:
    from conveyor.models.study import Value
    from conveyor.studies.design_figures import Design
    from conveyor.studies.evaluation import StudySummary, VariedField
    from conveyor.studies.parametric_study import KeyedPoint, ParametricStudy

PART_POINTS: Final = 1024
"""Points per part of a table that is written while its study runs."""
_GROUP_ROWS: Final = 10_000  # of a group of a Parquet file
_PART_NAME: Final = re.compile(r"part-\d+\.(csv|parquet)")

Cells = tuple[Any, ...]
PointRow: TypeAlias = "tuple[int, tuple[Value, ...], Sequence[Any] | str]"
"""Number, values of the varied fields, SI figures or the reason why there are none."""


class StudyTable:
    """Headings and cells of a table of a study, one row per point or design, in a system of units.

    Parameters
    ----------
    row : str
        Name of a row: "point" or "design".
    fields : sequence of VariedField
        Varied fields; columns have the unit of the first value.
    figures : sequence of (str, str)
        Label and kind of each figure.
    system : {"SI", "US"}
        Unit system of the figures.
    currency : str
        Currency of costs.
    """

    def __init__(
        self,
        row: str,
        fields: Sequence[VariedField],
        figures: Sequence[tuple[str, str]],
        system: System,
        currency: str,
    ) -> None:
        self._fields = fields
        self._shown = [display_unit(money_kind(kind, currency), system) for _, kind in figures]
        headed = [label_with_unit(label, sign.label) for (label, _), sign in zip(figures, self._shown, strict=True)]
        inputs = (label_with_unit(field.path, field.unit) for field in fields)
        self.headings = (row, *inputs, *headed, output_marks.NO_ANSWER_COLUMN)
        given = ("text" if field.words else "number" for field in fields)
        self._kinds = ("count", *given, *(_STORAGE_TYPES.get(kind, "number") for _, kind in figures), "text")

    def cells(self, row: PointRow) -> Cells:
        """Cells of a row."""
        number, values, answer = row
        given = [
            str(value) if field.words else field.number(value)
            for field, value in zip(self._fields, values, strict=True)
        ]
        if isinstance(answer, str):
            return (number, *given, *(None for _ in self._shown), answer)
        stored = self._kinds[1 + len(given) : -1]
        shown = (_storage_value(x, sign, kind) for x, sign, kind in zip(answer, self._shown, stored, strict=True))
        return (number, *given, *shown, None)

    def write(self, path: Path, points: Iterable[PointRow]) -> int:
        """Write the table as `.csv` or `.parquet`, by the ending of its name; the file appears when it is complete.

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
        with partial_file(path) as temporary:
            return self._parquet(temporary, rows) if path.suffix == ".parquet" else self._csv(temporary, rows)

    def _csv(self, path: Path, rows: Iterator[Cells]) -> int:
        count = 0
        with path.open("w", encoding="utf-8-sig", newline="") as file:
            file.write(_csv_line(self.headings))
            for count, row in enumerate(rows, start=1):  # noqa: B007 the number of rows
                file.write(_csv_line(row))
        return count

    def _parquet(self, path: Path, rows: Iterator[Cells]) -> int:
        import pyarrow as pa
        from pyarrow import parquet

        stored = {"count": pa.int64(), "number": pa.float64(), "text": pa.string()}
        columns = [(name, stored[kind]) for name, kind in zip(self.headings, self._kinds, strict=True)]
        schema, count = pa.schema(columns, {output_marks.PARQUET: output_marks.program_version()}), 0
        with parquet.ParquetWriter(path, schema) as writer:
            while part := list(islice(rows, _GROUP_ROWS)):
                cells = dict(zip(self.headings, zip(*part, strict=True), strict=True))
                writer.write_table(pa.table(cells, schema=schema))
                count += len(part)
        return count


def _storage_value(value: Any, sign: Unit, kind: str) -> Any:
    shown = round_for_storage(sign.shown(value))
    return int(shown) if kind == "count" and shown is not None else shown


_STORAGE_TYPES: Final = {"count": "count", "text": "text", "verdict": "text"}
"""Storage types in a Parquet file by kind; others are numbers."""


class PartedTable:
    """A table in a folder, one file per `PART_POINTS` points, each written once they are all solved.

    Parameters
    ----------
    table : StudyTable
        Table of the points.
    folder : Path
        Created if missing; parts of an older run are removed.
    count : int
        Number of points of the study.
    row : callable
        Returns the row of a point from its number and keyed result.

    Raises
    ------
    InputError
        The folder cannot be written, or holds other files than parts of such a table.
    """

    def __init__(self, table: StudyTable, folder: Path, count: int, row: Callable[[int, KeyedPoint], PointRow]) -> None:
        self._table, self._folder, self._count, self._row = table, folder, count, row
        self._ending = ".csv" if find_spec("pyarrow") is None else ".parquet"
        self._waiting: dict[int, dict[int, KeyedPoint]] = {}
        try:
            folder.mkdir(exist_ok=True)
            older = sorted(folder.iterdir())
            for path in older:
                if _PART_NAME.fullmatch(path.name) is None:
                    raise InputError(f"{path}: is no part of such a table; give an empty folder, or a new one")
                if output_marks.output_kind(path.read_bytes()) not in {
                    output_marks.TABLE,
                    output_marks.STUDY,
                }:
                    raise InputError(
                        f"{path}: is damaged, or no table that conveyor wrote; remove it, or give another folder"
                    )
            for path in older:
                path.unlink()
        except OSError as error:
            raise InputError(f"{folder}: cannot be written ({error.strerror or error})") from None

    def take(self, points: Iterable[tuple[int, KeyedPoint]]) -> None:
        """Add solved points by number; write the parts that are now complete.

        Raises
        ------
        InputError
            A part cannot be written.
        """
        touched = set()
        for number, keyed in points:
            part = (number - 1) // PART_POINTS
            self._waiting.setdefault(part, {})[number] = keyed
            touched.add(part)
        for part in sorted(touched):
            if len(self._waiting[part]) == min(PART_POINTS, self._count - part * PART_POINTS):
                held = self._waiting.pop(part)
                path = self._folder / f"part-{part + 1:05}{self._ending}"
                self._table.write(path, (self._row(number, held[number]) for number in sorted(held)))


def _csv_line(cells: Iterable[Any]) -> str:
    line = io.StringIO()
    csv.writer(line).writerow(["" if cell is None else csv_cell(cell) for cell in cells])
    return line.getvalue()


def point_table(campaign: ParametricStudy, system: System) -> StudyTable:
    """Table of a study's points."""
    figures = [(OUTPUTS[key].label, OUTPUTS[key].kind) for key in campaign.outputs]
    return StudyTable(
        "point", varied_fields(campaign.require_list_plan(), campaign.plan.paths), figures, system, campaign.currency
    )


def design_table(campaign: ParametricStudy, system: System) -> StudyTable:
    """Table of a study's designs; its rows come from `design_rows`."""
    figures = [(figure.label, figure.kind) for figure in campaign.figures.values()]
    shown = (*figures, ("breaks", "text"), ("on the front", "verdict"))
    return StudyTable("design", varied_fields(campaign.require_list_plan()), shown, system, campaign.currency)


def design_rows(study: StudySummary, designs: Iterable[Design]) -> Iterator[PointRow]:
    """Rows of the table of designs."""
    front = set(study.numbers[study.front].tolist())
    for one in designs:
        values = tuple(one.changes.values())
        figures = [
            *one.figures.values(),
            ", ".join(one.broken) or None,
            "yes" if one.number in front else "no",
        ]
        yield one.number, values, one.why or figures


def money_kind(kind: str, currency: str) -> str:
    """Kind of quantity; money gets its currency."""
    return f"{MONEY}{currency}" if kind == "money" else kind
