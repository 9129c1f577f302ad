"""One static page: its style, its parts, its shell. No script, nothing fetched, every text escaped."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from conveyor.markup import Html, element, joined
from conveyor.models.report import Paper
from conveyor.report.formats import number_format
from conveyor.report.page_style import style
from conveyor.report.unit_systems import converted, converted_rows
from conveyor.report.verdicts import Check
from conveyor.units import System

_UNIT = re.compile(r"^(.*?)\s*\[([^\]]*)\]$")
_SPELLED = {"degC": "°C", "degF": "°F", "deg": "°", "-": ""}
_WIDE = 8  # columns beyond which a table is set smaller on paper
_SHORT = 12  # rows up to which a table is kept on one page
_NAME = 30  # characters up to which a name of a row stays on one line
_LONG = 36  # characters beyond which a column of text may be broken anywhere
_NOTHING = "–"
_MARKS = {"pass": ("pass", "✓"), "FAIL": ("fail", "✗"), "not checked": ("open", "?")}


@dataclass(frozen=True)
class Part:
    """A part of the page: its identifier, its heading, what is in it."""

    name: str
    heading: str
    content: Html


def number(name: str, value: float) -> str:
    """Write a number as the workbook shows it, by the unit in its name.

    Examples
    --------
    >>> number("tension [N]", 84147.576), number("share [-]", 0.4681), number("error estimate [-]", 8e-7)
    ('84,147.6', '46.8%', '8.0E-07')
    """
    if math.isinf(value):
        return "∞" if value > 0.0 else "-∞"
    pattern = number_format(name)
    if pattern == "General" or isinstance(value, int):
        return f"{value:,}" if isinstance(value, int) else f"{value:,.6g}"
    digits = len(pattern.partition(".")[2].rstrip("%E+0")) or pattern.partition(".")[2].split("E")[0].count(
        "0"
    )
    kind = "%" if pattern.endswith("%") else "E" if "E" in pattern else "f"
    written = f"{value:{',' if pattern.startswith('#') else ''}.{digits}{kind}}"
    return written.removeprefix("-") if not written.strip("-0.,%") else written


def unit_of(name: str) -> tuple[str, str]:
    """Part a figure's name from its unit, as the page writes it.

    Examples
    --------
    >>> unit_of("temperature [degC]"), unit_of("strand"), unit_of("equivalent DIN f [-]")
    (('temperature', '°C'), ('strand', ''), ('equivalent DIN f', ''))
    """
    found = _UNIT.match(name)
    if found is None:
        return name, ""
    return found[1], _SPELLED.get(found[2], found[2])


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _missing(value: object) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _written(name: str, value: Any) -> str:
    plain = value.item() if hasattr(value, "item") else value
    if _missing(plain):
        return _NOTHING
    if isinstance(plain, bool):
        return "yes" if plain else "NO"
    return number(name, plain) if _is_number(plain) else str(plain)


def table(
    frame: pd.DataFrame,
    caption: str,
    *,
    system: System = "SI",
    named: int = 1,
    by_row: str = "",
    foot: Sequence[object] = (),
) -> Html:
    """Return a table of results: headers with scope, units beside names, numbers as in the workbook.

    Parameters
    ----------
    frame, caption
        What, and what it is called.
    system : {"SI", "US"}
        Units to show it in.
    named : int
        Leading columns that name the row.
    by_row : str
        Name of a column of figures' names: each row's numbers are formatted by its own unit.
    foot : sequence
        A last line of totals, one value a column.
    """
    shown = converted_rows(frame, by_row, system) if by_row else converted(frame, system)
    names = [str(name) for name in shown.columns]
    columns = [shown[name].tolist() for name in names]
    numeric = [
        all(_missing(v) or _is_number(v) for v in column) and any(_is_number(v) for v in column)
        for column in columns
    ]
    widths = [max((len(v) for v in column if isinstance(v, str)), default=0) for column in columns]
    classes = [
        "n" if isnumber else "long" if width > _LONG else "name" if j < named and width <= _NAME else None
        for j, (isnumber, width) in enumerate(zip(numeric, widths, strict=True))
    ]
    head = element("tr", *(_head(name, kind) for name, kind in zip(names, classes, strict=True)))
    figures = shown[by_row].tolist() if by_row else [""] * len(shown)

    def cell(j: int, value: Any, figure: str) -> Html:
        tag, scope = ("th", "row") if j < named else ("td", None)
        content = (
            _figure_name(value) if by_row and names[j] == by_row else _written(figure or names[j], value)
        )
        return element(tag, content, scope=scope, class_=classes[j])

    body = [
        element("tr", *(cell(j, column[i], figures[i]) for j, column in enumerate(columns)))
        for i in range(len(shown))
    ]
    parts = [element("caption", caption), element("thead", head), element("tbody", *body)]
    if foot:
        sums = converted(pd.DataFrame([dict(zip(frame.columns, foot, strict=True))]), system).iloc[0].tolist()
        parts.append(
            element(
                "tfoot", element("tr", *(cell(j, "" if v is None else v, "") for j, v in enumerate(sums)))
            )
        )
    return scrolling(element("table", *parts), caption, wide=len(names) > _WIDE, keep=len(shown) <= _SHORT)


def _head(name: str, kind: str | None) -> Html:
    words, unit = unit_of(name)
    marked = joined([words, " ", element("span", f"[{unit}]", class_="unit")]) if unit else words
    return element("th", marked, scope="col", class_=kind)


def _figure_name(name: str) -> Html:
    words, unit = unit_of(name)
    return joined([words, " ", element("span", f"[{unit}]", class_="unit")] if unit else [words])


def scrolling(content: Html, label: str, *, wide: bool, keep: bool, kind: str = "") -> Html:
    """Return a table that scrolls by itself where the screen is narrow."""
    kinds = "scroll" + (" wide" if wide else "") + (" keep" if keep else "") + (f" {kind}" if kind else "")
    return element("div", content, class_=kinds, tabindex="0", role="group", aria_label=label)


def listed(figures: pd.Series, caption: str, *, system: System = "SI") -> Html:
    """Return named figures as a table: name, value, unit."""
    frame = figures.rename_axis("quantity").rename("value").reset_index()
    shown = converted_rows(frame, "quantity", system)
    rows = []
    for name, value in zip(shown["quantity"].tolist(), shown["value"].tolist(), strict=True):
        words, unit = unit_of(str(name))
        rows.append(
            element(
                "tr",
                element("th", words, scope="row"),
                element("td", _written(str(name), value), class_="v" if isinstance(value, str) else "n"),
                element("td", unit, class_="unit"),
            )
        )
    head = element(
        "tr",
        element("th", "quantity", scope="col"),
        element("th", "value", scope="col", class_="n"),
        element("th", "unit", scope="col"),
    )
    whole = element("table", element("caption", caption), element("thead", head), element("tbody", *rows))
    return scrolling(whole, caption, wide=False, keep=len(rows) <= _SHORT)


def verdicts(found: Iterable[Check], caption: str) -> Html:
    """Return checks as a table; the verdict is a word and a mark, its colour says nothing more."""
    heads = [element("th", name, scope="col") for name in ("check", "verdict", "found", "asked for")]
    rows = [
        element(
            "tr",
            element("th", check.subject, scope="row"),
            element("td", verdict(check.verdict)),
            element("td", check.found),
            element("td", check.asked),
        )
        for check in found
    ]
    whole = element(
        "table", element("caption", caption), element("thead", element("tr", *heads)), element("tbody", *rows)
    )
    return scrolling(whole, caption, wide=False, keep=len(rows) <= _SHORT, kind="checks")


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


def tiles(figures: pd.Series, names: Sequence[str], system: System = "SI") -> Html:
    """Return the key figures of a summary, large; those it does not hold are left out."""
    given = converted(pd.DataFrame([figures[[name for name in names if name in figures.index]]]), system)
    pairs = []
    for name in given.columns:
        words, unit = unit_of(str(name))
        value = number(str(name), float(given[name].iloc[0]))
        pairs.append((words, joined([value, " ", element("small", unit)]) if unit else value))
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
        )
        for part in parts
    ]
    body = element(
        "body",
        element("header", element("p", kind, class_="kind"), element("h1", title), top),
        element("nav", contents, aria_label="Contents"),
        element("main", *sections),
        element("footer", foot),
    )
    return Html("<!DOCTYPE html>\n" + element("html", head, body, lang="en") + "\n")
