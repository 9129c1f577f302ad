"""HTML elements and tables; content that is not markup already is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from conveyor.text.printable import escape_controls

_MOST_ROWS, _MOST_ITEMS, _MOST_LETTERS = 40, 12, 300
_VOID = frozenset({"br", "col", "meta"})
_STYLE = "text-align:left;vertical-align:top"


class Html(str):
    """Text that is HTML already."""

    __slots__ = ()


def escape_html(value: object) -> Html:
    r"""Escape text for HTML; markup stays as it is.

    Examples
    --------
    >>> print(escape_html('<b title="x">'), escape_html(Html("<b>")), escape_html("bell\x07"))
    &lt;b title=&quot;x&quot;&gt; <b> bell\x07
    """
    if isinstance(value, Html):
        return value
    return Html(escape(escape_controls(str(value)), quote=True))


def element(tag: str, *content: object, **attributes: object) -> Html:
    """Return an element around its content; ``class_`` is the attribute class, ``aria_label`` aria-label.

    Examples
    --------
    >>> print(element("p", "a < b", element("br"), class_="note"))
    <p class="note">a &lt; b<br></p>
    """
    given = "".join(
        f' {name.removesuffix("_").replace("_", "-")}="{escape_html(value)}"'
        for name, value in attributes.items()
        if value is not None
    )
    inner = "".join(map(escape_html, content))
    return Html(f"<{tag}{given}>" if tag in _VOID else f"<{tag}{given}>{inner}</{tag}>")


def join_html(parts: Iterable[object]) -> Html:
    """Join parts, each escaped, to one piece of markup."""
    return Html("".join(map(escape_html, parts)))


def name_value_table(caption: str, rows: Iterable[tuple[str, object]]) -> Html:
    """Return a small table of names and values, for notebooks.

    Examples
    --------
    >>> print(name_value_table("roll", [("width", "1 m")]).replace(' style="text-align:left;vertical-align:top"', ""))
    <table><caption>roll</caption><tbody><tr><th scope="row">width</th><td>1 m</td></tr></tbody></table>
    """
    body = [
        element(
            "tr",
            element("th", name, scope="row", style=_STYLE),
            element("td", _value_html(value), style=_STYLE),
        )
        for name, value in rows
    ]
    return element("table", element("caption", caption, style=_STYLE), element("tbody", *body))


def record_table(caption: str, rows: Sequence[Mapping[str, Any]]) -> Html:
    """Return a table of records, a column for each key, for notebooks; long ones are cut."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    head = element("tr", *(element("th", name, scope="col", style=_STYLE) for name in names))
    body = [
        element("tr", *(element("td", _value_html(row.get(name, "")), style=_STYLE) for name in names))
        for row in rows[:_MOST_ROWS]
    ]
    if len(rows) > _MOST_ROWS:
        body.append(element("tr", element("td", f"... {len(rows)} in all", colspan=str(len(names)))))
    above = element("caption", caption, style=_STYLE)
    return element("table", above, element("thead", head), element("tbody", *body))


def _value_html(value: object) -> Html:
    """Plain data as markup: mappings folded, lists of records as tables, long lists cut."""
    if isinstance(value, Mapping):
        return _details_element(_count_text(len(value), "field", "fields"), name_value_table("", value.items()))
    if isinstance(value, list | tuple):
        if value and all(isinstance(item, Mapping) for item in value):
            return _details_element(_count_text(len(value), "entry", "entries"), record_table("", value))
        more = f", ... {len(value)} in all" if len(value) > _MOST_ITEMS else ""
        return join_html([Html(", ").join(map(_value_html, value[:_MOST_ITEMS])), more])
    if isinstance(value, str) and not isinstance(value, Html) and len(value) > _MOST_LETTERS:
        return escape_html(f"{value[:_MOST_LETTERS]}... ({len(value)} characters)")
    return escape_html(value)


def _count_text(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def _details_element(summary: str, content: Html) -> Html:
    return element("details", element("summary", summary), content)
