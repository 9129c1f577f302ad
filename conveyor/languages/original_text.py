"""English texts from translated ones: the headers of a form that comes back filled in."""

from __future__ import annotations

from collections.abc import Collection
from unicodedata import normalize

from conveyor.languages import TRANSLATED
from conveyor.languages.catalogue import load_catalogue
from conveyor.languages.gapped_sentence import gap_pattern


def every_translation(english: str) -> tuple[str, ...]:
    """Return a text in every language, English first."""
    return english, *(load_catalogue(language).texts[english] for language in TRANSLATED)


def original_header(header: str, known: Collection[str]) -> str:
    """Return the header of a column in English, with its unit; one that is none of the known stays as it is.

    Parameters
    ----------
    header : str
        Of a column, with its unit in brackets.
    known : collection of str
        Headers in English without units; with {} for a figure.

    Examples
    --------
    >>> original_header("bei 1,5 N/mm, eigener Ansatz [N/m]", ("at {}, ours", "cover"))
    'at 1.5 N/mm, ours [N/m]'
    >>> original_header("覆盖层 [mm]", ("cover",)), original_header("note", ("cover",))
    ('cover [mm]', 'note')
    """
    label, bracket, unit = normalize("NFKC", header).partition(" [")
    for catalogue in map(load_catalogue, TRANSLATED):
        for english in known:
            found = gap_pattern(normalize("NFKC", catalogue.texts[english])).fullmatch(label)
            if found is not None:
                figures = map(catalogue.numbers.read, found.groups())
                return english.format(*figures) + bracket + unit
    return header
