"""Elements of a static page: style, tables, lists, shell. No script, nothing fetched, every text escaped."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final

from conveyor.models.report import Paper
from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Column, Contents, Figure, Table, figure_table
from conveyor.text.markup import Html, Markup, element, join_html
from conveyor.units import System
from conveyor.units.presentation import display_unit

COLOURS: Final = {
    "paper": "#FFFFFF",
    "ink": "#1B1F24",
    "muted": "#4A5560",
    "accent": "#1F4E79",
    "pale": "#EEF3F8",
    "line": "#C9D3DD",
    "good": "#14602B",
    "good-pale": "#E4F3E8",
    "bad": "#9B1C1C",
    "bad-pale": "#FDEBEB",
    "open": "#5C4400",
    "open-pale": "#FFF4D6",
}
"""Colours of the page by role; contrast of every text is 4.5 or more (WCAG 2.2, 1.4.3)."""

DARK: Final = {
    "paper": "#14181D",
    "ink": "#E6EAF0",
    "muted": "#A9B4C0",
    "accent": "#8FC1F0",
    "pale": "#1E2630",
    "line": "#3A4654",
    "good": "#7FD79A",
    "good-pale": "#15301F",
    "bad": "#FF9B94",
    "bad-pale": "#3D1A1A",
    "open": "#F2CE73",
    "open-pale": "#38300F",
}
"""Colours in dark mode."""

_STYLE: Final = """
* { box-sizing: border-box; }
html { font: 16px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif;
  color-scheme: light dark; -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 3rem; max-width: 62rem; color: var(--ink); background: var(--paper); }
h1 { font-size: 1.9rem; line-height: 1.2; margin: .15rem 0 .4rem; color: var(--accent); overflow-wrap: anywhere; }
h2 { font-size: 1.3rem; margin: 2.4rem 0 .7rem; padding-top: .5rem; border-top: 2px solid var(--accent);
  color: var(--accent); }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
p, li, dd, td, th { overflow-wrap: anywhere; }
html:not(:lang(en)) :is(p, li, dd, dt, td, th, caption) { hyphens: auto; }
p { margin: .5rem 0; }
a { color: var(--accent); }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.kind, .note, figcaption, caption { color: var(--muted); }
.kind { margin: 0; font-size: .9rem; letter-spacing: .04em; text-transform: uppercase; }
.note { font-size: .9rem; }
nav { margin: 1.2rem 0; padding: .7rem 1rem; background: var(--pale); }
nav details { margin: 0; }
.checks td[data-label="margin"] { white-space: nowrap; }
nav ol { margin: .6rem 0 0; padding-left: 1.4rem; columns: 15rem; }
nav li { padding: .1rem 0; }
.facts, .tiles { display: grid; gap: .6rem 1.2rem; margin: 1rem 0; }
.facts { grid-template-columns: repeat(auto-fill, minmax(10.5rem, 1fr)); }
.tiles { grid-template-columns: repeat(3, 1fr); }
.facts dt, .tiles dt { font-size: .85rem; color: var(--muted); }
.facts dd, .tiles dd { margin: 0; }
.facts dd { font-weight: 600; }
.tiles > div { padding: .6rem .8rem; background: var(--pale); border-left: 4px solid var(--accent); }
.tiles dd { font-size: 1.45rem; font-weight: 600; line-height: 1.25; color: var(--accent); overflow-wrap: normal; }
.tiles dd small { font-size: .95rem; font-weight: 400; white-space: nowrap; }
.scroll { overflow-x: auto; margin: .8rem 0; }
table { border-collapse: collapse; width: 100%; font-size: .88rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0 0 .35rem; }
th, td { padding: .28rem .55rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line);
  overflow-wrap: normal; }
thead th { vertical-align: bottom; font-weight: 600; color: var(--paper); background: var(--accent); }
tbody th { font-weight: 400; }
tfoot th, tfoot td { font-weight: 600; border-top: 2px solid var(--accent); }
.n { text-align: right; white-space: nowrap; }
thead .n { white-space: normal; }
.v { text-align: right; }
tbody .name { white-space: nowrap; }
.wide table { font-size: .8rem; }
.wide th, .wide td { padding: .28rem .4rem; }
.asked { background: var(--open-pale); border: 1px solid var(--line); min-width: 3.5rem; }
.beside { display: flex; flex-wrap: wrap; gap: 0 1.5rem; align-items: flex-start; }
.beside > * { flex: 1 1 20rem; min-width: 0; }
.further { visibility: hidden; }
.sheet { break-after: page; }
.signed { display: flex; gap: 3rem; }
.signed > div { flex: 1; border-top: 1px solid; padding-top: .2rem; margin-top: 2.6rem; }
.terms { columns: 18rem; }
.stands { padding: .6rem .8rem; border-radius: .2rem; font-weight: 600; font-size: 1.05rem; }
details { margin: .8rem 0; }
summary { color: var(--accent); cursor: pointer; }
.unit { white-space: nowrap; font-weight: 400; }
.long { overflow-wrap: anywhere; min-width: 11rem; }
.verdict { display: inline-block; padding: 0 .5rem; border-radius: .2rem; font-weight: 600; white-space: nowrap; }
.pass { color: var(--good); background: var(--good-pale); }
.fail { color: var(--bad); background: var(--bad-pale); }
.open { color: var(--open); background: var(--open-pale); }
.warnings li { margin: .35rem 0; }
figure { margin: 1rem 0; }
.drawing svg { max-width: 48rem; }
.moving button { font: inherit; padding: .2rem .9rem; margin: 0 0 .3rem; cursor: pointer; }
@media print { .moving button { display: none; } }
@media (prefers-reduced-motion: reduce) { .moving button { display: none; } }
figcaption { font-size: .9rem; }
svg { display: block; width: 100%; height: auto; font-family: system-ui, Arial, sans-serif; }
svg * { stroke-linejoin: round; stroke-linecap: butt; }
footer { margin-top: 2.5rem; padding-top: .6rem; border-top: 1px solid var(--line); color: var(--muted);
  font-size: .85rem; overflow-wrap: anywhere; }
@media screen and (prefers-color-scheme: dark) { .drawing svg { filter: invert(.92) hue-rotate(180deg); } }
@media screen and (max-width: 40rem) {
  body { padding: 1rem .8rem 2rem; }
  h1 { font-size: 1.5rem; }
  .tiles { grid-template-columns: 1fr 1fr; }
  .tiles dd { font-size: 1.2rem; }
  table { font-size: .82rem; }
  th, td { padding: .25rem .4rem; overflow-wrap: anywhere; }
  .unit, tbody .name { white-space: normal; }
  .rows thead { display: none; }
  .rows tr { display: block; padding: .35rem 0; border-bottom: 2px solid var(--line); }
  .rows th, .rows td { display: flex; justify-content: space-between; gap: 1rem; border: 0; text-align: right;
    padding: .1rem .4rem; white-space: normal; min-width: 0; }
  .rows tbody th:first-child { font-weight: 600; text-align: left; }
  .rows td::before, .rows th[data-label]::before { content: attr(data-label); color: var(--muted); text-align: left;
    font-weight: 400; overflow-wrap: normal; }
}
@page { margin: 10mm 11mm 12mm; @bottom-right { content: counter(page) " / " counter(pages);
  font: 8pt sans-serif; } }
@media print {
  html { font-size: 9pt; line-height: 1.2; }
  h1 { font-size: 16pt; }
  h2 { font-size: 11pt; margin: .9rem 0 .3rem; padding-top: .2rem; }
  h3 { margin: .6rem 0 .2rem; }
  p, .scroll, figure { margin: .3rem 0; }
  .facts, .tiles { gap: .25rem .8rem; margin: .4rem 0; }
  .facts { grid-template-columns: repeat(5, 1fr); }
  .tiles { grid-template-columns: repeat(6, 1fr); }
  .tiles > div { padding: .2rem .4rem; }
  .tiles dd { font-size: 11pt; }
  .beside { flex-wrap: nowrap; }
  details, .unprinted { display: none; }
  li, .warnings li { margin: 0; }
  ul { margin: .3rem 0; }
  body { max-width: none; padding: 0; }
  nav { display: none; }
  a { text-decoration: none; }
  h2, h3, caption { break-after: avoid; }
  tbody tr:nth-child(-n+2) { break-after: avoid; }
  tbody tr:nth-last-child(-n+3), tfoot tr { break-before: avoid; }
  figure, tr, .tiles, .facts, .keep, .beside { break-inside: avoid; }
  thead { display: table-header-group; }
  tfoot { display: table-row-group; }
  .scroll { overflow: visible; }
  table { font-size: 8pt; line-height: 1.12; }
  th, td { padding: .07rem .35rem; }
  figure svg { max-width: 181mm; max-height: 210mm; }
  .wide table { font-size: 8pt; }
  .wide th, .wide td { padding: .07rem .05rem; }
  footer { font-size: .9rem; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
"""


def style_sheet(paper: Paper) -> str:
    """Return the style sheet for a paper size."""
    light, dark = (
        ":root { " + " ".join(f"--{name}: {value};" for name, value in colours.items()) + " }"
        for colours in (COLOURS, DARK)
    )
    return (
        f"{light}\n@media screen and (prefers-color-scheme: dark) {{ {dark} }}"
        + _STYLE
        + f"@page {{ size: {paper}; }}\n"
    )


_WIDE = 8  # columns beyond which a table is set smaller on paper
_NOTEBOOK_ROWS = 40  # of a table that a notebook is shown
_SHORT = 12  # rows up to which a table is kept on one page
_ONE_COLUMN = 6  # figures up to which they stand under one another
_NAME_CHARACTERS, _WORD_CHARACTERS = (
    30,
    9,
)  # characters up to which a name of a row, and another text ("600 PIW"), stays on one line
_LONG = 36  # characters beyond which a column of text may be broken anywhere
_NO_VALUE, _WIDE_SPACE = "–", "\u2002"
_VERDICT_MARKS = {"pass": ("pass", "✓"), "FAIL": ("fail", "✗"), "not checked": ("open", "?")}


@dataclass(frozen=True)
class PagePart:
    """Part of the page: identifier, heading, content, whether it is printed."""

    name: str
    heading: str
    content: Html
    printed: bool = True


def table_html(shown: Table, caption: str, system: System = "SI", *, kind: str = "") -> Html:
    """Return a table of results: headers with scope, units beside names, numbers as in the workbook."""
    columns = [[_cell_html(shown, column, row, system) for row in shown.rows] for column in shown.columns]
    values = [[column.get(row) for row in shown.rows] for column in shown.columns]
    empty = [column.asked and all(map(_is_missing, given)) for column, given in zip(shown.columns, values, strict=True)]
    classes = [
        "asked" if empty[j] else None if kind else _column_class(given, named=j < shown.named)
        for j, given in enumerate(values)
    ]
    names = [_with_unit(column.label, _unit_sign(column, system)) for column in shown.columns]
    heads = [
        element("th", name, scope="col", class_=None if how == "asked" else how)
        for name, how in zip(names, classes, strict=True)
    ]

    def line(cells: Iterable[Html | str]) -> Html:
        made = []
        for j, (column, cell, how) in enumerate(zip(shown.columns, cells, classes, strict=True)):
            tag, scope = ("th", "row") if j < shown.named else ("td", None)
            label = None if scope and j == 0 else _column_label(column, system)
            kept = "no" if column.verbatim else None
            made.append(element(tag, cell, scope=scope, class_=how, data_label=label, translate=kept))
        return element("tr", *made)

    parts = [element("caption", caption), element("thead", element("tr", *heads))]
    parts.append(element("tbody", *(line(cells) for cells in zip(*columns, strict=True))))
    if shown.foot and any(column.total for column in shown.columns):
        sums = zip(shown.columns, shown.totals(), strict=True)
        cells = ("" if v is None else display_unit(c.kind, system).written(v) for c, v in sums)
        parts.append(element("tfoot", line(cells)))
    wide, short = len(shown.columns) > _WIDE, len(shown.rows) <= _SHORT
    return scroll_box(element("table", *parts), caption, wide=wide, keep=short, kind=f"rows {kind}".rstrip())


def _column_class(values: Sequence[object], *, named: bool) -> str | None:
    """CSS class of a column: numbers, long text, short names."""
    given = [value for value in values if not _is_missing(value)]
    if given and all(isinstance(value, int | float) and not isinstance(value, bool) for value in given):
        return "n"
    width = max((len(value) for value in given if isinstance(value, str)), default=0)
    return (
        "long" if width > _LONG else "name" if 0 < width <= (_NAME_CHARACTERS if named else _WORD_CHARACTERS) else None
    )


def _is_missing(value: object) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _unit_sign(column: Column, system: System) -> str:
    return "" if column.kind in {ROW_KIND, FIGURE_NAME} else display_unit(column.kind, system).sign


def _column_label(column: Column, system: System) -> str:
    sign = _unit_sign(column, system)
    return f"{column.label} [{sign}]" if sign else column.label


def _with_unit(words: str, sign: str) -> Html:
    return join_html([words, " ", element("span", f"[{sign}]", class_="unit")] if sign else [words])


def _cell_html(shown: Table, column: Column, row: Any, system: System) -> Html | str:
    value = column.get(row)
    if column.kind == FIGURE_NAME:
        return _with_unit(value, row.unit(system).sign)
    if _is_missing(value):
        return "" if column.asked and all(_is_missing(column.get(one)) for one in shown.rows) else _NO_VALUE
    if column.kind == "verdict" and value in _VERDICT_MARKS:
        return verdict_mark(value)
    return shown.unit(column, row, system).written(value)


def scroll_box(content: Html, label: str, *, wide: bool, keep: bool, kind: str = "") -> Html:
    """Return content that scrolls by itself on a narrow screen."""
    kinds = "scroll" + (" wide" if wide else "") + (" keep" if keep else "") + (f" {kind}" if kind else "")
    return element("div", content, class_=kinds, tabindex="0", role="group", aria_label=label)


def fold_away(caption: str, content: Html) -> Html:
    """Return content that is folded away and not printed."""
    return element("details", element("summary", caption), content)


def notebook_html(
    system: System,
    tables: Iterable[tuple[str, Table]],
    notes: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> Html:
    """Return tables cut to their first rows, and notes folded away."""
    shown = ((caption, replace(part.on_sheet(), rows=part.rows[:_NOTEBOOK_ROWS], foot="")) for caption, part in tables)
    every = [(figure_list if part.figures else table_html)(part, caption, system) for caption, part in shown]
    below = [fold_away(f"{name} ({len(lines)})", bullet_list(lines)) for name, lines in notes.items() if lines]
    return join_html([*every, *below])


def notebook_summary(contents: Contents) -> Html:
    """Return the summary of a report for a notebook: key figures, failed checks, warnings."""
    checks = contents["checks"].rows
    failed = [check.subject for check in checks if check.verdict == "FAIL"]
    lines = [f"{len(failed)} of {len(checks)} checks failed" + (f": {'; '.join(failed)}" if failed else "")]
    lines += [contents["defaults"].note] if "defaults" in contents else []
    key = figure_table("key", "", "", contents.figures_for("notebook"))
    shown = notebook_html(contents.system, [(contents.document.title, key)])
    said = [element("p", line) for line in lines]
    return join_html([shown, *said, notebook_html(contents.system, (), {"warnings": contents.lines("warning")})])


def figure_list(shown: Table, caption: str, system: System = "SI") -> Html:
    """Return a list of figures: name, value, unit; long ones in two columns."""
    value = next(column.get for column in shown.columns if column.kind == ROW_KIND)
    half = -(-len(shown.rows) // 2) if len(shown.rows) > _ONE_COLUMN else len(shown.rows)
    parts = [
        _figure_list_part(rows, value, caption if k == 0 else f"{caption}, continued", system, named=k == 0)
        for k, rows in enumerate((shown.rows[:half], shown.rows[half:]))
        if rows
    ]
    return parts[0] if len(parts) == 1 else element("div", *parts, class_="beside")


def _figure_list_part(
    rows: Sequence[Figure], value: Callable[[Figure], Any], caption: str, system: System, *, named: bool
) -> Html:
    lines = [
        element(
            "tr",
            element("th", row.called(system), scope="row"),
            element("td", row.unit(system).written(given), class_="v" if isinstance(given, str) else "n"),
            element("td", row.unit(system).sign, class_="unit"),
        )
        for row, given in zip(rows, map(value, rows), strict=True)
    ]
    heads = (("quantity", None), ("value", "n"), ("unit", None))
    head = element("tr", *(element("th", words, scope="col", class_=how) for words, how in heads))
    above = element("caption", caption, class_=None if named else "further")
    whole = element("table", above, element("thead", head), element("tbody", *lines))
    return scroll_box(whole, caption, wide=False, keep=len(lines) <= _SHORT)


def verdict_mark(word: str) -> Html:
    """Return a verdict with its symbol."""
    kind, mark = _VERDICT_MARKS[word]
    return element("span", element("span", mark, aria_hidden="true"), " ", word, class_=f"verdict {kind}")


def verdict_counts(verdicts: Iterable[str]) -> Html:
    """Return how many have each verdict, with its symbol."""
    count = Counter(verdicts)
    known = (word for word in _VERDICT_MARKS if count[word])
    return join_html(part for word in known for part in (f"{count[word]} ", verdict_mark(word), _WIDE_SPACE))


def fact_list(pairs: Iterable[tuple[str, Html | str]], kind: str = "facts") -> Html:
    """Return names and values as a definition list."""
    named = (element("div", element("dt", name), element("dd", value)) for name, value in pairs)
    return element("dl", *named, class_=kind)


def key_figure_tiles(shown: Iterable[Figure], system: System, of: str = "") -> Html:
    """Return key figures as large tiles; `of` stands behind their names."""
    pairs: list[tuple[str, Html | str]] = []
    for figure in shown:
        written = display_unit(figure.kind, system, large=True)
        value, _, sign = written.said(figure.value, 3).partition(" ")
        pairs.append(
            (
                f"{figure.called(system)}{of}",
                join_html([value, " ", element("small", sign)]) if sign else value,
            )
        )
    return fact_list(pairs, "tiles")


def bullet_list(lines: Sequence[str], kind: str | None = None) -> Html:
    """Return lines as a list; "none" where there are none."""
    if not lines:
        return element("p", "none")
    return element("ul", *(element("li", line) for line in lines), class_=kind)


def page_html(title: str, kind: str, top: Html, parts: Sequence[PagePart], foot: str, *, paper: Paper = "A4") -> Html:
    """Return the whole document.

    Parameters
    ----------
    title, kind : str
        Title, and kind of page.
    top : Html
        Between the title and the contents.
    parts : sequence of PagePart
        Parts in order.
    foot : str
        Footer: program and version.
    paper : {"A4", "Letter"}
        Paper size.
    """
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="generator", content=foot),
        element("title", f"{title} – {kind}"),
        element("style", Markup(style_sheet(paper))),
    )
    contents = element("ol", *(element("li", element("a", part.heading, href=f"#{part.name}")) for part in parts))
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
    return element("html", head, body, lang="en")
