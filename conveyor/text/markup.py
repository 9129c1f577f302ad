"""Pages as trees of elements and texts, written as HTML at the end; tables for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any, TypeGuard

from conveyor.text.printable import escape_controls

_MOST_ROWS, _MOST_ITEMS, _MOST_LETTERS = 40, 12, 300
_VOID = frozenset({"br", "col", "meta"})
_STYLE = "text-align:left;vertical-align:top"


class Markup(str):
    """Text that is written as it is: a drawing as SVG, a style sheet."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Html:
    """A piece of a page: an element around its content, or content alone.

    `str` writes it; only then are texts and attributes escaped.

    Attributes
    ----------
    content : tuple of Html or str
        Elements, texts and `Markup` in order; no two texts follow one another.
    tag : str
        Name of the element; "" for content alone.
    attributes : mapping of str to str
        Its attributes.

    Examples
    --------
    >>> print(element("p", "<b> & ", element("br"), Markup("<svg/>"), title='"x"'))
    <p title="&quot;x&quot;">&lt;b&gt; &amp; <br><svg/></p>
    """

    content: tuple[Html | str, ...] = ()
    tag: str = ""
    attributes: Mapping[str, str] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.tag or self.content)

    def __str__(self) -> str:
        inner = "".join(escape(part) if _is_text(part) else str(part) for part in self.content)
        if not self.tag:
            return inner
        given = "".join(f' {name}="{escape(value)}"' for name, value in self.attributes.items())
        written = f"<{self.tag}{given}>" if self.tag in _VOID else f"<{self.tag}{given}>{inner}</{self.tag}>"
        return f"<!DOCTYPE html>\n{written}\n" if self.tag == "html" else written

    @property
    def classes(self) -> frozenset[str]:
        """Classes of the element."""
        return frozenset(self.attributes.get("class", "").split())

    @property
    def elements(self) -> list[Html]:
        """Elements of its content."""
        return [part for part in self.content if isinstance(part, Html)]

    @property
    def text(self) -> str:
        """Its texts in order."""
        shown = (part for part in self.content if not isinstance(part, Markup))
        return "".join(part.text if isinstance(part, Html) else part for part in shown)

    def every(self) -> Iterator[Html]:
        """All elements in it, in the order of the page."""
        for one in self.elements:
            yield one
            yield from one.every()

    def first(self, tag: str) -> Html:
        """First element with a tag, at any depth."""
        return next(one for one in self.every() if one.tag == tag)


def element(tag: str, *content: Html | str, **attributes: object) -> Html:
    """Return an element around its content; ``class_`` is the attribute class, ``aria_label`` aria-label.

    Examples
    --------
    >>> print(element("p", "a < b", element("br"), class_="note"))
    <p class="note">a &lt; b<br></p>
    """
    given = {
        name.removesuffix("_").replace("_", "-"): escape_controls(str(value))
        for name, value in attributes.items()
        if value is not None
    }
    return Html(join_html(content).content, tag, given)


def join_html(parts: Iterable[Html | str]) -> Html:
    r"""Join parts to one piece of a page; control characters in texts become their codes.

    Raises
    ------
    TypeError
        A part is neither.

    Examples
    --------
    >>> join_html(["a", join_html(["b\x07", element("br")])]).content[0]
    'ab\\x07'
    """
    content: list[Html | str] = []
    for part in parts:
        if isinstance(part, Html):
            added = (part,) if part.tag else part.content
        elif isinstance(part, str):
            added = (part if isinstance(part, Markup) else escape_controls(part),)
        else:
            raise TypeError(f"a piece of a page is an element or text, got {type(part).__name__}")
        for one in added:
            last = content[-1] if content else None
            if _is_text(one) and _is_text(last):
                content[-1] = f"{last}{one}"
            elif one:
                content.append(one)
    return Html(tuple(content))


def _is_text(part: object) -> TypeGuard[str]:
    return isinstance(part, str) and not isinstance(part, Markup)


def name_value_table(caption: str, rows: Iterable[tuple[str, object]]) -> Html:
    """Return a small table of names and values, for notebooks.

    Examples
    --------
    >>> [(one.tag, one.text) for one in name_value_table("roll", [("width", "1 m")]).every() if not one.elements]
    [('caption', 'roll'), ('th', 'width'), ('td', '1 m')]
    """
    body = [
        element(
            "tr",
            element("th", str(name), scope="row", style=_STYLE),
            element("td", _value_html(value), style=_STYLE),
        )
        for name, value in rows
    ]
    return element("table", element("caption", caption, style=_STYLE), element("tbody", *body))


def record_table(caption: str, rows: Sequence[Mapping[str, Any]]) -> Html:
    """Return a table of records, a column for each key, for notebooks; long ones are cut."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    head = element("tr", *(element("th", str(name), scope="col", style=_STYLE) for name in names))
    body = [
        element("tr", *(element("td", _value_html(row.get(name, "")), style=_STYLE) for name in names))
        for row in rows[:_MOST_ROWS]
    ]
    if len(rows) > _MOST_ROWS:
        body.append(element("tr", element("td", f"... {len(rows)} in all", colspan=str(len(names)))))
    above = element("caption", caption, style=_STYLE)
    return element("table", above, element("thead", head), element("tbody", *body))


def _value_html(value: object) -> Html | str:
    """Plain data as content: mappings folded, lists of records as tables, long lists cut."""
    if isinstance(value, Mapping):
        return _details_element(_count_text(len(value), "field", "fields"), name_value_table("", value.items()))
    if isinstance(value, list | tuple):
        if value and all(isinstance(item, Mapping) for item in value):
            return _details_element(_count_text(len(value), "entry", "entries"), record_table("", value))
        more = f", ... {len(value)} in all" if len(value) > _MOST_ITEMS else ""
        items = [part for item in value[:_MOST_ITEMS] for part in (", ", _value_html(item))]
        return join_html([*items[1:], more])
    if isinstance(value, str) and len(value) > _MOST_LETTERS:
        return f"{value[:_MOST_LETTERS]}... ({len(value)} characters)"
    return str(value)


def _count_text(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def _details_element(summary: str, content: Html) -> Html:
    return element("details", element("summary", summary), content)
