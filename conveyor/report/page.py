"""One static page: its style, its parts, its shell. No script, nothing fetched, every text escaped."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from conveyor.markup import Html, element, escaped, joined
from conveyor.models.report import Paper
from conveyor.report.columns import NAMED, OF_ROW, Column, Figure, Table
from conveyor.report.page_style import style
from conveyor.units import System
from conveyor.units.presentation import unit

_WIDE = 8  # columns beyond which a table is set smaller on paper
_SHORT = 12  # rows up to which a table is kept on one page
_BESIDE = 6  # figures up to which they stand under one another
_NAME = 30  # characters up to which a name of a row stays on one line
_LONG = 36  # characters beyond which a column of text may be broken anywhere
_NOTHING = "–"
_MARKS = {"pass": ("pass", "✓"), "FAIL": ("fail", "✗"), "not checked": ("open", "?")}


@dataclass(frozen=True)
class Part:
    """A part of the page: its identifier, its heading, what is in it, whether paper has it."""

    name: str
    heading: str
    content: Html
    printed: bool = True


def table(shown: Table, caption: str, system: System = "SI", *, kind: str = "") -> Html:
    """Return a table of results: headers with scope, units beside names, numbers as in the workbook."""
    columns = [[_cell(shown, column, row, system) for row in shown.rows] for column in shown.columns]
    values = [[column.value(row) for row in shown.rows] for column in shown.columns]
    empty = [
        column.asked and all(map(_missing, given))
        for column, given in zip(shown.columns, values, strict=True)
    ]
    classes = [
        "asked" if empty[j] else None if kind else _class(given, named=j < shown.named)
        for j, given in enumerate(values)
    ]
    heads = [
        element(
            "th",
            _with_unit(column.label, _unit(column, system)),
            scope="col",
            class_=None if how == "asked" else how,
        )
        for column, how in zip(shown.columns, classes, strict=True)
    ]

    def line(cells: Iterable[Html]) -> Html:
        return element(
            "tr",
            *(
                element(
                    "th", cell, scope="row", class_=how, data_label=_spelled(column, system) if j else None
                )
                if j < shown.named
                else element("td", cell, class_=how, data_label=_spelled(column, system))
                for j, (column, cell, how) in enumerate(zip(shown.columns, cells, classes, strict=True))
            ),
        )

    parts = [element("caption", caption), element("thead", element("tr", *heads))]
    parts.append(element("tbody", *(line(cells) for cells in zip(*columns, strict=True))))
    if shown.foot and any(column.total for column in shown.columns):
        sums = zip(shown.columns, shown.totals(), strict=True)
        cells = (escaped("" if v is None else unit(c.kind, system).written(v)) for c, v in sums)
        parts.append(element("tfoot", line(cells)))
    short = len(shown.rows) <= _SHORT
    return scrolling(
        element("table", *parts),
        caption,
        wide=len(shown.columns) > _WIDE,
        keep=short,
        kind=f"rows {kind}".rstrip(),
    )


def _class(values: Sequence[object], *, named: bool) -> str | None:
    """How a column is set: numbers, long text, names of rows."""
    given = [value for value in values if not _missing(value)]
    if given and all(isinstance(value, int | float) and not isinstance(value, bool) for value in given):
        return "n"
    width = max((len(value) for value in given if isinstance(value, str)), default=0)
    return "long" if width > _LONG else "name" if named and width <= _NAME else None


def _missing(value: object) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _unit(column: Column, system: System) -> str:
    return "" if column.kind in {OF_ROW, NAMED} else unit(column.kind, system).sign


def _spelled(column: Column, system: System) -> str:
    sign = _unit(column, system)
    return f"{column.label} [{sign}]" if sign else column.label


def _with_unit(words: str, sign: str) -> Html:
    marked = [words, " ", element("span", f"[{sign}]", class_="unit")] if sign else [words]
    return joined(marked)


def _cell(shown: Table, column: Column, row: Any, system: System) -> Html:
    value = column.value(row)
    if column.kind == NAMED:
        return _with_unit(value, row.unit(system).sign)
    if _missing(value):
        return escaped(
            "" if column.asked and all(_missing(column.value(one)) for one in shown.rows) else _NOTHING
        )
    if column.kind == "verdict" and value in _MARKS:
        return verdict(value)
    return escaped(shown.unit(column, row, system).written(value))


def scrolling(content: Html, label: str, *, wide: bool, keep: bool, kind: str = "") -> Html:
    """Return a table that scrolls by itself where the screen is narrow."""
    kinds = "scroll" + (" wide" if wide else "") + (" keep" if keep else "") + (f" {kind}" if kind else "")
    return element("div", content, class_=kinds, tabindex="0", role="group", aria_label=label)


def folded(caption: str, content: Html) -> Html:
    """Return what is shown when it is asked for, and not printed."""
    return element("details", element("summary", caption), content)


def listed(shown: Table, caption: str, system: System = "SI") -> Html:
    """Return named figures: name, value, unit; many of them in two tables side by side where there is room."""
    half = -(-len(shown.rows) // 2) if len(shown.rows) > _BESIDE else len(shown.rows)
    parts = [
        _listed(rows, caption if k == 0 else f"{caption}, continued", system, named=k == 0)
        for k, rows in enumerate((shown.rows[:half], shown.rows[half:]))
        if rows
    ]
    return parts[0] if len(parts) == 1 else element("div", *parts, class_="beside")


def _listed(rows: Sequence[Figure], caption: str, system: System, *, named: bool) -> Html:
    lines = [
        element(
            "tr",
            element("th", row.called(system), scope="row"),
            element(
                "td", row.unit(system).written(row.value), class_="v" if isinstance(row.value, str) else "n"
            ),
            element("td", row.unit(system).sign, class_="unit"),
        )
        for row in rows
    ]
    head = element(
        "tr",
        element("th", "quantity", scope="col"),
        element("th", "value", scope="col", class_="n"),
        element("th", "unit", scope="col"),
    )
    above = element("caption", caption, class_=None if named else "further")
    whole = element("table", above, element("thead", head), element("tbody", *lines))
    return scrolling(whole, caption, wide=False, keep=len(lines) <= _SHORT)


def verdict(word: str) -> Html:
    """Return a verdict with its mark."""
    kind, mark = _MARKS[word]
    return element("span", element("span", mark, aria_hidden="true"), " ", word, class_=f"verdict {kind}")


def facts(pairs: Iterable[tuple[str, object]], kind: str = "facts") -> Html:
    """Return names and values side by side."""
    return element(
        "dl",
        *(element("div", element("dt", name), element("dd", value)) for name, value in pairs),
        class_=kind,
    )


def tiles(figures: Iterable[Figure], system: System = "SI") -> Html:
    """Return key figures, large."""
    pairs = []
    for figure in figures:
        written = unit(figure.kind, system, large=True)
        value, _, sign = written.short(figure.value).partition(" ")
        pairs.append(
            (
                f"{figure.called(system)}, as given",
                joined([value, " ", element("small", sign)]) if sign else value,
            )
        )
    return facts(pairs, "tiles")


def bullets(lines: Sequence[str], kind: str | None = None) -> Html:
    """Return lines as a list; "none" where there are none."""
    if not lines:
        return element("p", "none")
    return element("ul", *(element("li", line) for line in lines), class_=kind)


def page(title: str, kind: str, top: Html, parts: Sequence[Part], foot: str, *, paper: Paper = "A4") -> Html:
    """Return the whole document.

    Parameters
    ----------
    title, kind : str
        Of what, and what the page is.
    top : Html
        Below the title, above the contents.
    parts : sequence of Part
        Each under its heading, in their order.
    foot : str
        What made it.
    paper : {"A4", "Letter"}
        To print on.
    """
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="generator", content=foot),
        element("title", f"{title} – {kind}"),
        element("style", Html(style(paper))),
    )
    contents = element(
        "ol", *(element("li", element("a", part.heading, href=f"#{part.name}")) for part in parts)
    )
    sections = [
        element(
            "section",
            element("h2", part.heading, id=part.name),
            part.content,
            aria_labelledby=part.name,
            class_=None if part.printed else "unprinted",
        )
        for part in parts
    ]
    body = element(
        "body",
        element("header", element("p", kind, class_="kind"), element("h1", title), top),
        element("nav", element("details", element("summary", "Contents"), contents), aria_label="Contents"),
        element("main", *sections),
        element("footer", foot),
    )
    return Html("<!DOCTYPE html>\n" + element("html", head, body, lang="en") + "\n")
