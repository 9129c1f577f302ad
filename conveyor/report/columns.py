"""Columns, figures and tables of reports: what a number is and where it appears; their names with units are made here.

Values are SI; unit, digits and conversion follow from the kind and the system (`conveyor.units.presentation`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from conveyor.models.report import Paper
from conveyor.units import System
from conveyor.units.presentation import Unit, headed, spelled, unit

if TYPE_CHECKING:
    import pandas as pd

FAILS: Final = "FAILS"
"""In the name of a state of motion whose tensions are not to be had."""
OF_ROW: Final = "of row"
"""Kind of a column whose values have the kind of their row's figure."""
CHECKS_AND_NOTES: Final = "Checks and notes"
"""The workbook's last sheet."""
NAMED: Final = "named"
"""Kind of the column that names the figure of each row, with its unit."""
Getter: TypeAlias = Callable[[Any], Any]
"""Of a row an SI value, words, or None where it is not known."""


HEADINGS: Final = ("action required", "basis and limitations")
"""Above the two lists."""
_NAMES: Final = re.compile(r'"[^"]*"|\b[a-z_]+(?:\[\d+\])?(?:\.[a-z_]+(?:\[\d+\])?)+')
"""What alike notes differ in: quoted names and fields."""
_SEVERAL: Final = re.compile(r'^compound ("[^"]*"(?:, "[^"]*")+) is ')
_OF_DATA: Final = re.compile(
    r"^compounds? \"|^calculation\.(calibration|flexure)|^the belt gives|^means over|^90 % bands|^energy and cost|"
    "not given|assumed|illustrative|not read in the standard|as commonly reproduced"
)
"""Notes on what was given, not on what was found."""


def slug(words: str) -> str:
    """Return words as a stable name.

    Examples
    --------
    >>> slug("stopping time, drives off"), slug("E' factor")
    ('stopping_time_drives_off', 'e_factor')
    """
    return "_".join("".join(c if c.isalnum() else " " for c in words.lower()).split())


@cache
def at(path: str) -> Getter:
    """Return what takes a value off a row along a path of attributes, keys and places; None where it ends in None.

    Numbers of arrays are plain ones.

    Examples
    --------
    >>> at("1.real")(("carry", 2.5)), at("0.mass")([{"mass": 3.0}]), at("real.0")(None)
    (2.5, 3.0, None)
    """
    steps = path.split(".")

    def taken(row: Any) -> Any:
        for step in steps:
            if row is not None:
                keyed = step.isdecimal() or isinstance(row, Mapping)
                row = row[int(step) if step.isdecimal() else step] if keyed else getattr(row, step)
        return row.item() if getattr(row, "ndim", None) == 0 else row

    return taken


def extreme(of: Callable[[Iterable[float]], float], path: str, get: str | Getter) -> Getter:
    """Return what takes the largest or the least figure of all that a row holds at a path; None where none has one."""
    held, figure = at(path), at(get) if isinstance(get, str) else get

    def taken(row: Any) -> float | None:
        known = [value for one in held(row) if isinstance(value := figure(one), float)]
        return of(known) if known else None

    return taken


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes
    ----------
    label : str
        Words without unit.
    kind : str
        Of quantity, `OF_ROW` or `NAMED`.
    get : callable
        What takes its value off a row: an SI value, words, or None where it is not known; may be given as a path.
    page : str or None
        Which of its table's places on the page it stands in: all without a name; None: in none.
    sheet : bool
        Whether it stands in workbook, files and data frames.
    json : str
        Key in `to_dict`; left out there without.
    total : bool
        Whether the line of totals has its sum.
    sparse : bool
        Whether it is left out where no row has a value.
    asked : bool
        Whether its cells are for the reader to fill in or to change.
    formula : callable or None
        Of a row what the workbook calculates its cell by, "" for a plain value; `[key]` is the cell of a column in the
        same row, `[key:3]` that in the fourth.
    key : str
        A stable name; without it made of the label.
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

    def __post_init__(self) -> None:
        object.__setattr__(self, "key", self.key or slug(self.label))
        object.__setattr__(self, "get", at(self.get) if isinstance(self.get, str) else self.get)

    def of(self, path: str) -> Column:
        """The same column of rows that hold the former ones at a path."""
        get, inner = self.get, at(path)
        return replace(self, get=lambda row: get(inner(row)))


@dataclass(frozen=True)
class Figure:
    """A figure with a name of its own, a row of a table of figures.

    Attributes
    ----------
    label, kind : str
        Words without unit, kind of quantity.
    value : float, str, tuple or None
        SI; several where the table has several columns of values; None where it is not known.
    on : str
        Where it is shown beside its table, words of: tile (page), large (cover), notebook; input: to be changed.
    json : str
        Path in `to_dict`, with points; left out there without.
    key : str
        Name that others link to it by; without it made of the label.
    us : str
        Symbol that US reports call it by, behind the label.
    formula : str
        What the workbook calculates it by, of names of figures; its value stands beside.
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
        """How it is written."""
        return unit(self.kind, system)

    def called(self, system: System) -> str:
        """Its label, in the US with the symbol used there."""
        return f"{self.label} {self.us}" if self.us and system == "US" else self.label


@dataclass(frozen=True)
class OnPage:
    """A table's place on the page: part, caption, its columns' name where not all stand in it; whether paper has it."""

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
        Its name: of the range in the workbook (``table_<key>``) and of its file.
    sheet : str
        Sheet it stands on; without, it is neither in the workbook nor a file.
    heading : str
        Words above it.
    columns : tuple of Column
        What stands in it; those that the page leaves out come last, and paper leaves them out too.
    rows : sequence
        What columns get their values of.
    page : str or tuple of OnPage
        Part of the page where it stands under its heading, or its places there.
    note : str
        What to know of it.
    foot : str
        Words beside the totals; none without.
    named : int
        Leading columns that name the row.
    links : bool
        Whether its rows are figures that others link to.
    printed : bool
        Whether its sheet prints it; else it stands below what is printed.
    """

    key: str
    sheet: str
    heading: str
    columns: tuple[Column, ...]
    rows: Sequence[Any]
    page: str | tuple[OnPage, ...] = ""
    note: str = ""
    foot: str = ""
    named: int = 1
    links: bool = False
    printed: bool = True

    def __post_init__(self) -> None:
        kept = tuple(
            c for c in self.columns if not c.sparse or any(c.get(row) is not None for row in self.rows)
        )
        shown_first = tuple(sorted(kept, key=lambda column: column.page is None))
        object.__setattr__(self, "columns", shown_first)

    @property
    def places(self) -> tuple[OnPage, ...]:
        """Where it stands on the page."""
        if isinstance(self.page, str):
            return (OnPage(self.page, self.heading),) if self.page else ()
        return self.page

    @cached_property
    def by_row(self) -> bool:
        """Whether its rows are figures of kinds of their own."""
        return any(column.kind == NAMED for column in self.columns)

    @property
    def figures(self) -> bool:
        """Whether it lists figures, each with one value."""
        return self.by_row and [c.kind for c in self.columns if c.page is not None] == [NAMED, OF_ROW]

    def on_sheet(self) -> Table:
        """The table as workbook, files and data frames hold it."""
        return replace(self, columns=tuple(column for column in self.columns if column.sheet))

    def on_page(self, place: OnPage) -> Table:
        """The table as it stands in a place on the page."""
        views = {"", place.view}
        return replace(self, columns=tuple(c for c in self.columns if c.page is not None and c.page in views))

    def only(self, *keys: str) -> Table:
        """The table with these columns."""
        return replace(self, columns=tuple(column for column in self.columns if column.key in keys))

    def index(self, key: str) -> int:
        """Place of a column, from 0."""
        return [column.key for column in self.columns].index(key)

    def name(self, column: Column, system: System) -> str:
        """Name of a column with its unit."""
        return column.label if column.kind in {OF_ROW, NAMED} else headed(column.label, column.kind, system)

    def head(self, column: Column, system: System) -> str:
        """Name of a column as people read it."""
        return column.label if column.kind in {OF_ROW, NAMED} else spelled(column.label, column.kind, system)

    def unit(self, column: Column, row: Any, system: System) -> Unit:
        """How a cell is written."""
        return unit(
            row.kind if column.kind == OF_ROW else "text" if column.kind == NAMED else column.kind, system
        )

    def cells(self, column: Column, system: System) -> list[Any]:
        """Values of a column in a system: numbers, words, None."""
        if column.kind == NAMED:
            return [headed(row.called(system), row.kind, system) for row in self.rows]
        if column.kind == OF_ROW:
            return [unit(row.kind, system).shown(column.get(row)) for row in self.rows]
        written = unit(column.kind, system)
        return [written.shown(column.get(row)) for row in self.rows]

    def names(self, system: System) -> list[str]:
        """Names of its figures as people read them."""
        return [spelled(row.called(system), row.kind, system) for row in self.rows]

    def totals(self) -> tuple[Any, ...]:
        """The line of totals, SI: words in the first column, sums where columns have them."""
        sums = (
            sum(column.get(row) for row in self.rows) if column.total else None for column in self.columns[1:]
        )
        return (self.foot, *sums)

    def frame(self, system: System = "SI") -> pd.DataFrame:
        """The table as a data frame, units in the names of its columns or rows."""
        shown = [column for column in self.columns if column.sheet]
        import pandas as pd

        return pd.DataFrame({self.name(column, system): self.cells(column, system) for column in shown})

    def series(self, name: str, system: System = "SI") -> pd.Series:
        """Figures as a series, units in its index."""
        names = [headed(row.called(system), row.kind, system) for row in self.rows]
        import pandas as pd

        return pd.Series(dict(zip(names, self.cells(self.columns[1], system), strict=True)), name=name)

    def records(self) -> list[dict[str, Any]]:
        """Rows as plain SI data under the names of the columns, or what JSON calls them; figures beside their units."""
        cells: dict[str, list[Any]] = {}
        for column in self.columns:
            if column.sheet:
                named = column.kind == NAMED
                name = self.name(replace(column, label=column.json or column.label), "SI")
                cells[name] = [row.label for row in self.rows] if named else self.cells(column, "SI")
            if column.kind == OF_ROW:
                cells["unit"] = [row.unit("SI").label for row in self.rows]
        return [{name: _known(values[i]) for name, values in cells.items()} for i in range(len(self.rows))]

    def plain(self) -> list[dict[str, Any]]:
        """Rows as plain SI data under the keys of `to_dict`."""
        known = [(column.json, self.cells(column, "SI")) for column in self.columns if column.json]
        return [{name: cells[i] for name, cells in known} for i in range(len(self.rows))]


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Remark(NamedTuple):
    """A remark: its kind and its text."""

    kind: str
    text: str


def noted(
    lines: Mapping[str, Iterable[str]],
    sheet: str = CHECKS_AND_NOTES,
    heading: str = "Remarks",
    page: str = "",
) -> Table:
    """Return the table of remarks: lines by their kind."""
    columns = (Column("kind", "text", "kind"), Column("text", "text", "text"))
    rows = tuple(Remark(kind, line) for kind, of in lines.items() for line in of)
    return Table("remarks", sheet, heading, columns, rows, page)


def figures(
    key: str, sheet: str, heading: str, rows: Iterable[Figure], *, prefix: str | None = None, **more: Any
) -> Table:
    """Return a table of figures with one value each, those left out that are not known.

    Others link to them where there is a prefix of their names.
    """
    columns = (Column("quantity", NAMED, "label"), Column("value", OF_ROW, "value"))
    known = tuple(replace(row, key=f"{prefix or ''}{row.key}") for row in rows if row.value is not None)
    return Table(key, sheet, heading, columns, known, links=prefix is not None, **more)


@dataclass(frozen=True)
class Drawing:
    """A figure of the page: its name, its caption, what draws it, the table it stands above."""

    name: str
    caption: str
    draw: Callable[[], Any]
    above: str


@dataclass(frozen=True)
class ReportHead:
    """What a report is of.

    Attributes
    ----------
    title, kind : str
        Name of the conveyor, and what the report is.
    said : mapping
        What the spec says of the document: project, client, number, revision, engineer.
    fingerprint : str
        The spec's SHA-256.
    paper : str
        To print on.
    facts : tuple of (str, str)
        What stands below the title.
    """

    title: str
    kind: str
    said: dict[str, str]
    fingerprint: str
    paper: Paper
    facts: tuple[tuple[str, str], ...] = ()

    @property
    def documented(self) -> str:
        """What the spec says of the document, in one line."""
        return ", ".join(f"{name}: {value}" for name, value in self.said.items())


@dataclass(frozen=True)
class Contents:
    """What a report holds.

    Attributes
    ----------
    document : ReportHead
        What it is of.
    parts : tuple of Table
        Its tables in their order, no empty ones.
    system : str
        Units they are in.
    drawings : tuple of Drawing
        Its figures.
    page : tuple of (str, str)
        Parts of its page and their headings; those that hold nothing are left out.
    layout : str
        How its workbook is laid out, if not table under table.
    """

    document: ReportHead
    parts: tuple[Table, ...]
    system: System
    drawings: tuple[Drawing, ...] = ()
    page: tuple[tuple[str, str], ...] = ()
    layout: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", tuple(part for part in self.parts if part.rows))

    @cached_property
    def by_key(self) -> dict[str, Table]:
        """Tables by name."""
        return {part.key: part for part in self.parts}

    def __getitem__(self, key: str) -> Table:
        return self.by_key[key]

    def __contains__(self, key: str) -> bool:
        return key in self.by_key

    @property
    def tables(self) -> tuple[Table, ...]:
        """Tables of the workbook, as it and files hold them."""
        return tuple(part.on_sheet() for part in self.parts if part.sheet)

    def of(self, sheet: str) -> tuple[str, ...]:
        """Names of the tables of one sheet."""
        return tuple(part.key for part in self.parts if part.sheet == sheet)

    @property
    def sheets(self) -> tuple[str, ...]:
        """Sheets that hold a table, in order."""
        return tuple(dict.fromkeys(part.sheet for part in self.parts if part.sheet))

    def lines(self, kind: str) -> tuple[str, ...]:
        """Remarks of a kind."""
        return (
            tuple(row.text for row in self["remarks"].rows if row.kind == kind) if "remarks" in self else ()
        )

    def marked(self, where: str) -> list[Figure]:
        """Figures of all tables that are shown in a place, in their order."""
        rows = chain.from_iterable(part.rows for part in self.parts if part.by_row)
        return [row for row in rows if where in row.on.split()]


def merged(notes: Iterable[str]) -> list[str]:
    """Make one of notes that differ in quoted names or fields only, listing those.

    Examples
    --------
    >>> merged(['compound "a" is made up', "no brake", 'compound "b" is made up'])
    ['compounds "a", "b" are made up', 'no brake']
    """
    alike: dict[str, list[list[str]]] = {}
    for note in notes:
        alike.setdefault(_NAMES.sub("\0", note), []).append(_NAMES.findall(note))
    return [_joined(pattern, names) for pattern, names in alike.items()]


def _joined(pattern: str, names: Sequence[Sequence[str]]) -> str:
    columns = iter([", ".join(dict.fromkeys(column)) for column in zip(*names, strict=True)])
    note = "".join(next(columns) if part == "\0" else part for part in re.split("(\0)", pattern))
    return _SEVERAL.sub(r"compounds \1 are ", note)


def ordered(notes: Iterable[str]) -> tuple[list[str], list[str]]:
    """Give merged notes on what was found, then those on what the figures rest on."""
    every = merged(notes)
    of_data = [note for note in every if _OF_DATA.search(note)]
    return [note for note in every if note not in of_data], of_data
