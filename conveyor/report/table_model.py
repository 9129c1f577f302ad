"""Columns, figures, tables and contents of reports, and their names with units.

Values are SI; unit, digits and conversion follow from the kind and the system (`conveyor.units.presentation`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Self

from conveyor.languages.translator import Translator, report_translator
from conveyor.models.report import Paper
from conveyor.report.row_getters import path_getter
from conveyor.units import System
from conveyor.units.presentation import Unit, column_name, display_unit, label_for_people
from conveyor.units.unit_systems import trade_of

if TYPE_CHECKING:
    import pandas as pd

FAILS: Final = "FAILS"
"""In the name of a motion state whose belt is slack or slips."""
ROW_KIND: Final = "of row"
"""Kind of a column whose values have the kind of their row's figure."""
CHECKS_AND_NOTES: Final = "Checks and notes"
"""The workbook's last sheet."""
FIGURE_NAME: Final = "named"
"""Kind of the column that names the figure of each row, with its unit."""


def slug(words: str) -> str:
    """Return words as a stable name.

    Examples
    --------
    >>> slug("stopping time, drives off"), slug("E' factor")
    ('stopping_time_drives_off', 'e_factor')
    """
    return "_".join("".join(c if c.isalnum() else " " for c in words.lower()).split())


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes
    ----------
    label : str
        Words without unit.
    kind : str
        Kind of quantity, `ROW_KIND` or `FIGURE_NAME`.
    get : callable
        Returns its value in a row: SI, text, or None where it is not known; may be given as a path.
    page : str or None
        Name of the table's place on the page that shows it; "": all of them; None: none.
    sheet : bool
        Whether workbook, files and data frames have it.
    json : str
        Key in `to_dict`; left out there if empty.
    total : bool
        Whether the line of totals sums it.
    sparse : bool
        Whether it is left out where no row has a value.
    asked : bool
        Whether the reader fills in or changes its cells.
    formula : callable or None
        Returns the formula of a row's cell, "" for a value; `[key]` is the cell of a column in the same row, `[key:3]`
        that in the fourth.
    key : str
        Stable name; by default made of the label.
    verbatim : bool
        Whether its texts are of a spec or a file and the same in every language.
    """

    label: str
    kind: str
    get: Any
    page: str | None = ""
    sheet: bool = True
    json: str = ""
    total: bool = False
    sparse: bool = False
    asked: bool = False
    formula: Callable[[Any], str] | None = None
    key: str = ""
    verbatim: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "key", self.key or slug(self.label))
        object.__setattr__(self, "get", path_getter(self.get) if isinstance(self.get, str) else self.get)

    def of(self, path: str) -> Column:
        """The same column for rows that hold the original rows at a path."""
        get, inner = self.get, path_getter(path)
        return replace(self, get=lambda row: get(inner(row)))


@dataclass(frozen=True)
class Figure:
    """A named value: a row of a table of figures.

    Attributes
    ----------
    label, kind : str
        Words without unit, kind of quantity.
    value : float, str, tuple or None
        SI; several where the table has several columns of values; None where it is not known.
    on : str
        Where else it is shown, words of: tile (page), large (cover), notebook; input: for the reader to change.
    json : str
        Dotted path in `to_dict`; left out there if empty.
    key : str
        Name for links to it; by default made of the label.
    us : str
        Symbol after the label in US reports.
    formula : str
        Formula in the workbook, in terms of names of figures.
    """

    label: str
    kind: str
    value: Any
    on: str = ""
    json: str = ""
    key: str = ""
    us: str = ""
    formula: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "key", self.key or slug(self.label))

    def unit(self, system: System) -> Unit:
        """Unit and digits of the figure in a system."""
        return display_unit(self.kind, system)

    def called(self, system: System) -> str:
        """Label, with the symbol in US reports."""
        return f"{self.label} {self.us}" if self.us and trade_of(system) == "US" else self.label


@dataclass(frozen=True)
class PagePlacement:
    """A table's place on the page: part, caption, view (which columns), whether it is printed."""

    part: str
    caption: str
    view: str = ""
    printed: bool = True


@dataclass(frozen=True)
class Table:
    """A table of a report.

    Attributes
    ----------
    key : str
        Name of its file and of its range in the workbook (``table_<key>``).
    sheet : str
        Its sheet; "": neither in the workbook nor a file.
    heading : str
        Heading.
    columns : tuple of Column
        Its columns; those that page and paper leave out come last.
    rows : sequence
        Objects that the columns take their values from.
    page : str or tuple of PagePlacement
        Part of the page that shows it under its heading, or its places there.
    note : str
        Note below it.
    foot : str
        Label of the line of totals; "": no such line.
    named : int
        Number of leading columns that name the row.
    links : bool
        Whether its figures have defined names in the workbook.
    printed : bool
        Whether its sheet prints it; else it is placed below the printed ones.
    """

    key: str
    sheet: str
    heading: str
    columns: tuple[Column, ...]
    rows: Sequence[Any]
    page: str | tuple[PagePlacement, ...] = ""
    note: str = ""
    foot: str = ""
    named: int = 1
    links: bool = False
    printed: bool = True

    def __post_init__(self) -> None:
        kept = tuple(c for c in self.columns if not c.sparse or any(c.get(row) is not None for row in self.rows))
        shown_first = tuple(sorted(kept, key=lambda column: column.page is None))
        object.__setattr__(self, "columns", shown_first)

    @property
    def places(self) -> tuple[PagePlacement, ...]:
        """Its places on the page."""
        if isinstance(self.page, str):
            return (PagePlacement(self.page, self.heading),) if self.page else ()
        return self.page

    @cached_property
    def by_row(self) -> bool:
        """True if every row is a figure with its own kind."""
        return any(column.kind == FIGURE_NAME for column in self.columns)

    @property
    def figures(self) -> bool:
        """True for a list of figures with one value each."""
        return self.by_row and [c.kind for c in self.columns if c.page is not None] == [FIGURE_NAME, ROW_KIND]

    def on_sheet(self) -> Table:
        """The table with the columns of workbook, files and data frames."""
        return replace(self, columns=tuple(column for column in self.columns if column.sheet))

    def on_page(self, place: PagePlacement) -> Table:
        """The table with the columns of a place on the page."""
        views = {"", place.view}
        return replace(self, columns=tuple(c for c in self.columns if c.page is not None and c.page in views))

    def only(self, *keys: str) -> Table:
        """The table with these columns alone, in this order, wherever the page shows them."""
        known = {column.key: replace(column, page="") for column in self.columns}
        return replace(self, columns=tuple(known[key] for key in keys if key in known))

    def name(self, column: Column, system: System) -> str:
        """Name of a column with its unit."""
        return (
            column.label if column.kind in {ROW_KIND, FIGURE_NAME} else column_name(column.label, column.kind, system)
        )

    def head(self, column: Column, system: System) -> str:
        """Name of a column with its unit in words."""
        return (
            column.label
            if column.kind in {ROW_KIND, FIGURE_NAME}
            else label_for_people(column.label, column.kind, system)
        )

    def unit(self, column: Column, row: Any, system: System) -> Unit:
        """Unit and digits of a cell."""
        if column.kind == ROW_KIND:
            unit: Unit = row.unit(system)
            return unit
        return display_unit("text" if column.kind == FIGURE_NAME else column.kind, system)

    def cells(self, column: Column, system: System) -> list[Any]:
        """Values of a column in a system: numbers, text, None."""
        if column.kind == FIGURE_NAME:
            return [column_name(row.called(system), row.kind, system) for row in self.rows]
        if column.kind == ROW_KIND:
            return [display_unit(row.kind, system).shown(column.get(row)) for row in self.rows]
        written = display_unit(column.kind, system)
        return [written.shown(column.get(row)) for row in self.rows]

    def names(self, system: System) -> list[str]:
        """Names of its figures with their units in words."""
        return [label_for_people(row.called(system), row.kind, system) for row in self.rows]

    def totals(self) -> tuple[Any, ...]:
        """Line of totals, SI: its label, then sums of the columns that have one."""
        sums = (sum(column.get(row) for row in self.rows) if column.total else None for column in self.columns[1:])
        return (self.foot, *sums)

    def frame(self, system: System = "SI") -> pd.DataFrame:
        """Data frame with units in the names of its columns or rows."""
        shown = [column for column in self.columns if column.sheet]
        import pandas as pd

        return pd.DataFrame({self.name(column, system): self.cells(column, system) for column in shown})

    def series(self, name: str, system: System = "SI") -> pd.Series:
        """Figures as a series with units in its index."""
        names = [column_name(row.called(system), row.kind, system) for row in self.rows]
        import pandas as pd

        return pd.Series(dict(zip(names, self.cells(self.columns[1], system), strict=True)), name=name)

    def records(self) -> list[dict[str, Any]]:
        """Rows as plain SI data under the names of the columns in JSON; figures with their units."""
        cells: dict[str, list[Any]] = {}
        for column in self.columns:
            if column.sheet:
                named = column.kind == FIGURE_NAME
                name = self.name(replace(column, label=column.json or column.label), "SI")
                cells[name] = [row.label for row in self.rows] if named else self.cells(column, "SI")
            if column.kind == ROW_KIND:
                cells["unit"] = [row.unit("SI").label for row in self.rows]
        return [{name: _finite_or_none(values[i]) for name, values in cells.items()} for i in range(len(self.rows))]

    def plain(self) -> list[dict[str, Any]]:
        """Rows as plain SI data under the keys of `to_dict`."""
        known = [(column.json, self.cells(column, "SI")) for column in self.columns if column.json]
        return [{name: cells[i] for name, cells in known} for i in range(len(self.rows))]


def _finite_or_none(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Remark(NamedTuple):
    """A remark: its kind and its text."""

    kind: str
    text: str


def remark_table(
    lines: Mapping[str, Iterable[str]],
    sheet: str = CHECKS_AND_NOTES,
    heading: str = "Remarks",
    page: str = "",
) -> Table:
    """Return the table of remarks from lines by kind."""
    columns = (Column("kind", "text", "kind"), Column("text", "text", "text"))
    rows = tuple(Remark(kind, line) for kind, of in lines.items() for line in of)
    return Table("remarks", sheet, heading, columns, rows, page)


def figure_table(
    key: str, sheet: str, heading: str, rows: Iterable[Figure], *, prefix: str | None = None, **more: Any
) -> Table:
    """Return a table of the known figures, one value each; with a prefix they have defined names in the workbook."""
    columns = (Column("quantity", FIGURE_NAME, "label"), Column("value", ROW_KIND, "value"))
    known = tuple(replace(row, key=f"{prefix or ''}{row.key}") for row in rows if row.value is not None)
    return Table(key, sheet, heading, columns, known, links=prefix is not None, **more)


@dataclass(frozen=True)
class Drawing:
    """A drawing of the page: name, caption, function that draws it, key of the table below it."""

    name: str
    caption: str
    draw: Callable[[], Any]
    above: str


@dataclass(frozen=True)
class ReportHead:
    """Head of a report.

    Attributes
    ----------
    title, kind : str
        Name of the conveyor, and kind of report.
    said : mapping
        Document block of the spec: project, client, number, revision, engineer.
    fingerprint : str
        The spec's SHA-256.
    paper : str
        Paper size.
    facts : tuple of (str, str)
        Facts below the title.
    language : str
        Language of the texts of page and workbook.
    names : callable
        Returns the names and texts that the user gave, the same in every language.
    notes : callable
        Returns the notes of its compounds.
    """

    title: str
    kind: str
    said: dict[str, str]
    fingerprint: str
    paper: Paper
    facts: tuple[tuple[str, str], ...] = ()
    language: str = "en"
    names: Callable[[], frozenset[str]] = frozenset
    notes: Callable[[], frozenset[str]] = frozenset

    @property
    def document_line(self) -> str:
        """Document block in one line."""
        return ", ".join(f"{name}: {value}" for name, value in self.said.items())


@dataclass(frozen=True)
class Contents:
    """Contents of a report.

    Attributes
    ----------
    document : ReportHead
        Head.
    by_key : mapping of str to Table
        Tables in order, without empty ones.
    system : str
        Unit system.
    drawn : callable
        Returns its drawings.
    page : tuple of (str, str)
        Parts of its page and their headings; empty ones are left out.
    layout : str
        Layout of its workbook; "": tables stacked.
    """

    document: ReportHead
    by_key: Mapping[str, Table]
    system: System
    drawn: Callable[[], Iterable[Drawing]] = tuple
    page: tuple[tuple[str, str], ...] = ()
    layout: str = ""

    @classmethod
    def of(
        cls, document: ReportHead, parts: Iterable[Table], system: System, drawings: Iterable[Drawing] = (), **more: Any
    ) -> Self:
        """Return contents of tables in order; empty ones are left out."""
        return cls(document, {part.key: part for part in parts if part.rows}, system, lambda: drawings, **more)

    @cached_property
    def drawings(self) -> tuple[Drawing, ...]:
        """Its drawings."""
        return tuple(self.drawn())

    @cached_property
    def parts(self) -> tuple[Table, ...]:
        """Tables in order."""
        return tuple(self.by_key.values())

    def make_translator(self) -> Translator | None:
        """Return a translator of its texts; None in English."""
        about = self.document
        return None if about.language == "en" else report_translator(about.language, about.names(), about.notes())

    def in_language(self, language: str) -> Contents:
        """The same contents for a report in a language."""
        return replace(self, document=replace(self.document, language=language))

    def __getitem__(self, key: str) -> Table:
        return self.by_key[key]

    def __contains__(self, key: str) -> bool:
        return key in self.by_key

    @property
    def tables(self) -> tuple[Table, ...]:
        """Tables of the workbook and of files."""
        return tuple(part.on_sheet() for part in self.parts if part.sheet)

    def keys_on(self, sheet: str) -> tuple[str, ...]:
        """Keys of the tables of a sheet."""
        return tuple(part.key for part in self.parts if part.sheet == sheet)

    @property
    def sheets(self) -> tuple[str, ...]:
        """Sheets with a table, in order."""
        return tuple(dict.fromkeys(part.sheet for part in self.parts if part.sheet))

    def lines(self, kind: str) -> tuple[str, ...]:
        """Remarks of a kind."""
        return tuple(row.text for row in self["remarks"].rows if row.kind == kind) if "remarks" in self else ()

    def figures_for(self, where: str) -> list[Figure]:
        """Figures of all tables that are shown in a place: tile, large, notebook."""
        rows = chain.from_iterable(part.rows for part in self.parts if part.by_row)
        return [row for row in rows if where in row.on.split()]
