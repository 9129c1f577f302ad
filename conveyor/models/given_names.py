"""Names and free text that a user gave in a spec, the same in every language; notes that come with a compound."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Final, get_args, get_origin

from conveyor.models.base import Model
from conveyor.models.compound import RubberCompound
from conveyor.models.rubber_data import FitStatistics, Source, StrainDependence
from conveyor.units.sentences import degree_signs

_NOTES: Final[frozenset[tuple[type[Model], str]]] = frozenset({
    (RubberCompound, "description"), (RubberCompound, "missing"), (StrainDependence, "reference_note"),
    (FitStatistics, "method"), (RubberCompound, "strain"), (Source, "origin"),
})  # fmt: skip
"""Fields of a compound's file that say something of it in words."""


def given_names(value: object) -> frozenset[str]:
    """Return the free texts of models and of all that they hold; words of a choice are none.

    Examples
    --------
    >>> from conveyor.models.report import Report
    >>> sorted(given_names(Report(client="Example AG", units="US")))
    ['Example AG']
    """
    return frozenset(_free_texts(value, notes=False))


def given_notes(value: object) -> frozenset[str]:
    """Return what the compounds of models say of themselves: in another language where a catalogue has it.

    Examples
    --------
    >>> from conveyor import shelf
    >>> "taken, the spectrum is constructed" in given_notes(shelf.compound("standard-cover"))
    True
    """
    return frozenset(_free_texts(value, notes=True))


def _free_texts(value: object, *, notes: bool) -> Iterator[str]:
    if isinstance(value, Model):
        fields = type(value).model_fields
        for name in value.model_fields_set & fields.keys():
            held = getattr(value, name)
            if ((type(value), name) in _NOTES) is notes and _is_free(fields[name].annotation):
                texts = (held,) if isinstance(held, str) else held if isinstance(held, tuple) else ()
                for text in texts:
                    if isinstance(text, str):
                        yield text
                        yield degree_signs(text)
            yield from _free_texts(held, notes=notes)
    elif isinstance(value, tuple | list):
        for item in value:
            yield from _free_texts(item, notes=notes)


def _is_free(annotation: Any) -> bool:
    """True for a type that has any text, not only the words of a choice."""
    if annotation is str:
        return True
    parts = get_args(annotation)[:1] if get_origin(annotation) is Annotated else get_args(annotation)
    return any(_is_free(part) for part in parts if isinstance(part, type) or get_args(part))
