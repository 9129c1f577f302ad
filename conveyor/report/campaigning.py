"""The tables of a study, one row a point or a design: written row by row, so that its size does not matter."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from conveyor.files import marks
from conveyor.files.saving import growing
from conveyor.report.files import plain
from conveyor.studies.explored import varied
from conveyor.studies.points import OUTPUTS
from conveyor.units import System
from conveyor.units.presentation import MONEY, labelled, unit

if TYPE_CHECKING:
    from conveyor.models import Conveyor
    from conveyor.models.study import Value
    from conveyor.studies.campaign import Campaign
    from conveyor.studies.designs import Design
    from conveyor.studies.explored import Explored, VariedField

_ROWS: Final = 10_000  # of a group of a Parquet file

Cells = tuple[Any, ...]
Row: TypeAlias = "tuple[int, tuple[Value, ...], Sequence[Any] | str]"
"""Number, values of what varies, SI figures or why there are none."""


class CampaignTable:
    """Headings and cells of a table of a study, one row a point or a design, in a system of units.

    Parameters
    ----------
    row : str
        What a row is: "point".
    fields : sequence of VariedField
        What varies: its columns have the unit of their first value.
    figures : sequence of (str, str)
        Words and kind of each figure, in the system's units.
    system : {"SI", "US"}
        Of the figures.
    line : Conveyor
        Whose currency costs have.
    """

    def __init__(
        self,
        row: str,
        fields: Sequence[VariedField],
        figures: Sequence[tuple[str, str]],
        system: System,
        line: Conveyor,
    ) -> None:
        self._fields = fields
        self._shown = [unit(priced(kind, line), system) for _, kind in figures]
        headed = [labelled(label, sign.label) for (label, _), sign in zip(figures, self._shown, strict=True)]
        inputs = (labelled(field.path, field.unit) for field in fields)
        self.headings = (row, *inputs, *headed, "no answer because")

    def cells(self, row: Row) -> Cells:
        """A row."""
        number, values, answer = row
        given = [
            value if field.words else field.number(value)
            for field, value in zip(self._fields, values, strict=True)
        ]
        if isinstance(answer, str):
            return (number, *given, *(None for _ in self._shown), answer)
        return (number, *given, *(sign.shown(x) for x, sign in zip(answer, self._shown, strict=True)), None)

    @property
    def mark(self) -> str:
        """What an older file of this table is."""
        return marks.mark(_line(self.headings).encode("utf-8-sig")) or marks.TABLE

    def write(self, path: Path, points: Iterable[Row]) -> int:
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


def of_points(campaign: Campaign, system: System) -> CampaignTable:
    """The table of a study's points."""
    figures = [(OUTPUTS[key].label, OUTPUTS[key].kind) for key in campaign.outputs]
    return CampaignTable(
        "point", varied(campaign.listed, campaign.plan.paths), figures, system, campaign.base
    )


def of_designs(campaign: Campaign, system: System) -> CampaignTable:
    """The table of a study's designs; its rows come from `design_rows`."""
    figures = [(figure.label, figure.kind) for figure in campaign.figures.values()]
    shown = (*figures, ("breaks", "text"), ("on the front", "verdict"))
    return CampaignTable("design", varied(campaign.listed), shown, system, campaign.base)


def design_rows(found: Explored, designs: Iterable[Design]) -> Iterator[Row]:
    """Designs as rows of their table."""
    front = set(found.numbers[found.front].tolist())
    for one in designs:
        values = tuple(one.changes.values())
        figures = [
            *one.figures.values(),
            ", ".join(one.broken) or None,
            "yes" if one.number in front else "no",
        ]
        yield one.number, values, one.why or figures


def priced(kind: str, line: Conveyor) -> str:
    """A kind, money in the currency of the spec's costs."""
    if kind != "money":
        return kind
    price = None if line.operation is None else line.operation.price
    return f"{MONEY}{'-' if price is None else price.currency}"
