"""The page and its figures in the language of the report: every text of the finished page is translated."""

from __future__ import annotations

import re
from html import unescape
from textwrap import wrap
from typing import TYPE_CHECKING, Final

from conveyor.languages.translator import Translator
from conveyor.text.markup import Html, escape_html

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.container import Container
    from matplotlib.figure import Figure

_TOKEN: Final = re.compile(r"<[^>]*>|[^<]+")
_TAG: Final = re.compile(r"<(/?)([A-Za-z][\w:-]*)")
_ATTRIBUTE: Final = re.compile(r'(\s(?:aria-label|data-label|alt|title)=")([^"]*)(")')
_HEADINGS: Final = frozenset({"caption", "dt", "h2", "h3", "summary"})
_SKIPPED: Final = frozenset({"style", "script"})
_LEAST_LINE: Final = 12  # letters of a line of a label
_COLUMN_HEAD: Final = 'scope="col"'
_KEPT: Final = 'translate="no"'
TRANSLATED_FIGURE: Final = "data-translated"
"""Mark of a figure whose words were translated before it was drawn."""


def translate_page(page: str, translator: Translator) -> Html:
    """Return a page with its texts in the language of a translator; those marked `translate="no"` stay."""
    made, kept, drawn, heading = [], _Depth(), _Depth(), False
    for token in _TOKEN.findall(page):
        if token.startswith("<"):
            tag = _TAG.match(token)
            name, closes = (tag[2], bool(tag[1])) if tag else ("", False)
            inside = kept.inside
            kept.pass_tag(token, name, closes=closes, opens=name in _SKIPPED or _KEPT in token)
            drawn.pass_tag(token, name, closes=closes, opens=name == "svg" and TRANSLATED_FIGURE in token)
            heading = not closes and (name in _HEADINGS or _COLUMN_HEAD in token)
            made.append(token if inside else _translate_attributes(token, translator))
        elif kept.inside or not token.strip():
            made.append(token)
        elif drawn.inside:
            made.append(escape_html(translator.numbers_only(unescape(token))))
        else:
            translate = translator.heading if heading else translator.text
            made.append(escape_html(translate(unescape(token))))
    return Html("".join(made))


class _Depth:
    """Whether the tokens lie inside an element, counted by its tag."""

    def __init__(self) -> None:
        self._name, self._open = "", 0

    @property
    def inside(self) -> bool:
        return self._open > 0

    def pass_tag(self, token: str, name: str, *, closes: bool, opens: bool) -> None:
        """Go past a tag; `opens` if it begins such an element."""
        if self._open:
            if name == self._name and not token.endswith("/>"):
                self._open += -1 if closes else 1
        elif opens and not closes and not token.endswith("/>"):
            self._name, self._open = name, 1


def _translate_attributes(token: str, translator: Translator) -> str:
    if token.startswith("<html "):
        return token.replace('lang="en"', f'lang="{translator.catalogue.language}"')
    return _ATTRIBUTE.sub(
        lambda found: f"{found[1]}{escape_html(translator.heading(unescape(found[2])))}{found[3]}", token
    )


def translate_figure(figure: Figure, translator: Translator) -> None:
    """Translate the words of a figure before it is drawn, so that it is laid out for them."""
    from matplotlib.ticker import FixedLocator

    for axes in figure.axes:
        labelled: list[Artist | Container] = [*axes.get_children(), *axes.containers]
        for artist in labelled:
            label = artist.get_label()
            if isinstance(label, str) and label and not label.startswith("_"):
                artist.set_label(_translate_lines(label, translator))
        for words in (*axes.texts, axes.xaxis.label, axes.yaxis.label):
            words.set_text(_translate_lines(words.get_text(), translator))
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_locator(), FixedLocator):
                labels = [_translate_lines(words.get_text(), translator) for words in axis.get_ticklabels()]
                axis.set_ticklabels(labels)


def _translate_lines(words: str, translator: Translator) -> str:
    """Translate words that may be broken into lines, and break them anew."""
    lines = words.split("\n")
    if len(lines) == 1:
        return translator.text(words)
    whole = translator.text(" ".join(words.replace("-\n", "-").split()))
    return "\n".join(wrap(whole, max(_LEAST_LINE, *map(len, lines))))
