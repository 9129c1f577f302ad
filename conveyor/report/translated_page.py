"""The page and its figures in the language of the report: every text of the page is translated."""

from __future__ import annotations

from dataclasses import replace
from textwrap import wrap
from typing import TYPE_CHECKING, Final

from conveyor.languages.number_format import NumberFormat
from conveyor.languages.translator import Translator
from conveyor.text.markup import Html, Markup

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.container import Container
    from matplotlib.figure import Figure
    from matplotlib.ticker import Formatter

_ATTRIBUTES: Final = frozenset({"aria-label", "data-label", "alt", "title"})
_HEADINGS: Final = frozenset({"caption", "dt", "h2", "h3", "summary"})
_LEAST_LINE: Final = 12  # letters of a line of a label


def translate_page(page: Html, translator: Translator) -> Html:
    """Return a page with its texts in the language of a translator; those marked `translate="no"` stay."""
    given = {name: translator.heading(said) if name in _ATTRIBUTES else said for name, said in page.attributes.items()}
    if page.tag == "html":
        given["lang"] = translator.catalogue.language
    if given.get("translate") == "no":
        return replace(page, attributes=given)
    heading = page.tag in _HEADINGS or given.get("scope") == "col"
    content: list[Html | str] = []
    for part in page.content:
        if isinstance(part, Html):
            content.append(translate_page(part, translator))
        elif isinstance(part, Markup):  # drawings, whose words were translated before they were drawn
            content.append(part)
        else:
            content.append(translator.heading(part) if heading and not content else translator.text(part))
    return Html(tuple(content), page.tag, given)


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


def localise_ticks(figure: Figure, translator: Translator) -> None:
    """Write the numbers along the axes of a figure as the language has them; labels are translated already."""
    from matplotlib.ticker import FixedFormatter

    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            written = axis.get_major_formatter()
            if not isinstance(written, FixedFormatter):
                axis.set_major_formatter(_local_formatter(written, translator.catalogue.numbers))


def _local_formatter(written: Formatter, numbers: NumberFormat) -> Formatter:
    """Text that another formatter writes, in the signs of a language."""
    from matplotlib.ticker import Formatter

    class LocalFormatter(Formatter):
        def __call__(self, x: float, pos: int | None = None) -> str:
            return numbers.localise(written(x, pos))

        def set_locs(self, locs: list[float]) -> None:
            written.set_locs(locs)

    return LocalFormatter()


def _translate_lines(words: str, translator: Translator) -> str:
    """Translate words that may be broken into lines, and break them anew."""
    lines = words.split("\n")
    if len(lines) == 1:
        return translator.text(words)
    whole = translator.text(" ".join(words.replace("-\n", "-").split()))
    return "\n".join(wrap(whole, max(_LEAST_LINE, *map(len, lines))))
