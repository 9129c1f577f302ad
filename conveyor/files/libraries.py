"""Libraries of belts, rolls, materials and spacings: commented data files in the package, each entry with its source.

A spec names an entry with `listed`; what it gives itself goes before the entry's.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, Literal, cast, get_args

from conveyor.errors import InputError, shorten_text
from conveyor.files.document import read_document
from conveyor.units import read_si

if TYPE_CHECKING:
    import pandas as pd

Library = Literal["belts", "rolls", "materials", "spacing", "sizes", "sizes_us", "prices"]

ROLL_DIAMETERS: Final = (63, 76, 89, 102, 108, 127, 133, 152, 159, 168, 178, 194, 219, 245)
"""Outer diameters that rolls are made in [mm]: makers' lists."""

_FOLDER = Path(__file__).parents[1] / "_library"


@dataclass(frozen=True)
class LibraryEntry:
    """Entry of a library.

    Attributes
    ----------
    name : str
        Name in specs.
    fields : mapping
        Values as in a spec, nested likewise.
    source : str
        Source of the values.
    general_knowledge : bool
        Common knowledge of the trade without a source; an analysis that uses it remarks on it.
    range : mapping of str to str
        Usual ranges, as text.
    note : str
        Further remarks.
    """

    name: str
    fields: Mapping[str, Any]
    source: str
    general_knowledge: bool = False
    range: Mapping[str, str] = field(default_factory=dict)
    note: str = ""


@cache
def library_entries(library: Library) -> Mapping[str, LibraryEntry]:
    """Return the entries of a library by name.

    Raises
    ------
    InputError
        The library's file is damaged.

    Examples
    --------
    >>> library_entries("rolls")["159x465"].fields["diameter"]
    '159 mm'
    """
    data = read_document(_FOLDER / f"{library}.yaml").data
    return MappingProxyType({str(name): LibraryEntry(str(name), **held) for name, held in data["entries"].items()})


def built_in_entries(library: str) -> Mapping[str, LibraryEntry]:
    """Entries of a library by name; none of a kind that only makers' lists have.

    Examples
    --------
    >>> len(built_in_entries("pulleys"))
    0
    """
    return library_entries(cast("Library", library)) if library in get_args(Library) else {}


def has_entry(entries: Mapping[str, LibraryEntry], name: str) -> bool:
    """True if a library has an entry of a name, in any case."""
    return name.casefold().strip() in {other.casefold() for other in entries}


def library_entry(library: Library, name: str) -> LibraryEntry:
    """Return one entry, its name in any case.

    Raises
    ------
    InputError
        No such name; the message lists the known names.

    Examples
    --------
    >>> library_entry("belts", "st1600").fields["mass"]
    '27 kg/m^2'
    >>> library_entry("materials", "hard cole")
    Traceback (most recent call last):
    conveyor.errors.InputError: "hard cole" is not in the library of materials; did you mean "hard coal"? ...
    """
    known = library_entries(library)
    folded = {other.casefold(): other for other in known}
    name_there = folded.get(name.casefold().strip())
    if name_there is None:
        near = difflib.get_close_matches(name.casefold(), folded, n=1)
        guess = f'; did you mean "{folded[near[0]]}"?' if near else ";"
        raise InputError(
            f'"{shorten_text(name)}" is not in the library of {library}{guess} there are: {" | ".join(known)}'
        )
    return known[name_there]


def belts() -> pd.DataFrame:
    """Return the belt classes, one a row, with sources."""
    return _library_table("belts")


def rolls() -> pd.DataFrame:
    """Return the rolls, one a row, with sources."""
    return _library_table("rolls")


def materials() -> pd.DataFrame:
    """Return the bulk materials, one a row: values, ranges, sources."""
    return _library_table("materials")


def spacings() -> pd.DataFrame:
    """Return guidance on the distance of idler sets, with sources.

    Examples
    --------
    >>> spacings().loc["carry", "to"]
    '1.5 m'
    """
    return _library_table("spacing")


def widest_spacings() -> dict[str, float]:
    """Return the widest distances of idler sets in use, by strand [m].

    Examples
    --------
    >>> widest_spacings()
    {'carry': 3.0, 'return': 6.0}
    """
    guidance = library_entries("spacing")
    return {strand: read_si(guidance[f"{strand}, overland"].fields["to"], "length") for strand in ("carry", "return")}


def _library_table(library: Library) -> pd.DataFrame:
    import pandas as pd

    rows = {
        name: {
            **flatten_fields(held.fields),
            **{f"{key}, range": span for key, span in held.range.items()},
            "note": held.note,
            "general knowledge": held.general_knowledge,
            "source": held.source,
        }
        for name, held in library_entries(library).items()
    }
    frame = pd.DataFrame(list(rows.values()), index=pd.Index(rows, name=library))
    last = ["note", "general knowledge", "source"]
    return frame[[*(column for column in frame.columns if column not in last), *last]]


def flatten_fields(fields: Mapping[str, Any], above: str = "") -> dict[str, Any]:
    """Nested fields under dotted names.

    Examples
    --------
    >>> flatten_fields({"mass": "27 kg/m^2", "carcass": {"kind": "EP"}})
    {'mass': '27 kg/m^2', 'carcass.kind': 'EP'}
    """
    flattened: dict[str, Any] = {}
    for name, value in fields.items():
        if isinstance(value, Mapping):
            flattened |= flatten_fields(value, f"{above}{name}.")
        else:
            flattened[f"{above}{name}"] = value
    return flattened
