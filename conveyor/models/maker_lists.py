"""Makers' lists: items that a user keeps in a folder of his own and that specs name beside those of the package."""

from __future__ import annotations

import difflib
import os
from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Final, Literal, TypeAlias, get_args

from pydantic import Field, StringConstraints, WithJsonSchema

from conveyor.errors import InputError, shorten_text
from conveyor.files import libraries
from conveyor.models.base import Model, Name
from conveyor.models.model_file import read_model

MakerKind = Literal["rolls", "belts", "pulleys", "motors", "gearboxes", "couplings", "backstops", "brakes"]
MAKER_KINDS: Final[tuple[MakerKind, ...]] = get_args(MakerKind)
DRIVE_KINDS: Final[tuple[MakerKind, ...]] = ("motors", "gearboxes", "couplings", "backstops", "brakes")
"""Kinds of the parts of a drive."""
FOLDER: Final = "conveyor-library"
"""Name of a folder of makers' lists: in a project, and in the home folder."""
ENVIRONMENT: Final = "CONVEYOR_LIBRARY"
"""Environment variable of further folders, separated as in PATH, instead of the one in the home folder."""
SUFFIX: Final = ".yaml"

EntryName = Annotated[str, StringConstraints(min_length=1, max_length=100)]
Source = Annotated[str, StringConstraints(min_length=1, max_length=500)]


class MakerEntry(Model):
    """An item of a maker's list."""

    source: Source
    """Maker, list, edition and page."""
    fields: Annotated[dict[str, Any], Field(min_length=1)]
    """Values as in a spec, nested likewise."""
    note: str = ""
    """What else is to be said of it."""


class ListedItem(MakerEntry):
    """An item of a maker's list as a spec keeps it once it is read: whoever has the spec needs no list."""

    kind: MakerKind
    """List it is of."""
    name: EntryName
    """Its name there."""

    @property
    def one(self) -> str:
        """Kind of the item, in the singular."""
        return "gearbox" if self.kind == "gearboxes" else self.kind.removesuffix("s")

    @property
    def entry(self) -> libraries.LibraryEntry:
        """The item as an entry of a library."""
        return libraries.LibraryEntry(self.name, self.fields, self.source, note=self.note)


_ITEM_SCHEMA: Final = {"type": "object", "description": "The item itself, as specs that the program writes have it."}
Listed: TypeAlias = EntryName | Annotated[ListedItem, WithJsonSchema(_ITEM_SCHEMA)]


Entries: TypeAlias = Annotated[dict[Name, MakerEntry], Field(default_factory=dict)]


class MakerList(Model):
    """A file of makers' lists: items by kind and name."""

    rolls: Entries
    belts: Entries
    pulleys: Entries
    motors: Entries
    gearboxes: Entries
    couplings: Entries
    backstops: Entries
    brakes: Entries

    @property
    def items(self) -> Iterator[ListedItem]:
        """Every item."""
        for kind in MAKER_KINDS:
            for name, entry in getattr(self, kind).items():
                yield ListedItem(kind=kind, name=name, source=entry.source, fields=entry.fields, note=entry.note)


def project_folder(base: Path) -> Path | None:
    """Folder of makers' lists in a folder or the nearest one above it."""
    start = base.resolve()
    return next((each / FOLDER for each in (start, *start.parents) if (each / FOLDER).is_dir()), None)


def personal_folders() -> list[Path]:
    """Folders of CONVEYOR_LIBRARY; without it that in the home folder, whether it is there or not.

    Raises
    ------
    InputError
        A folder of the variable does not exist.
    """
    given = [Path(each) for each in os.environ.get(ENVIRONMENT, "").split(os.pathsep) if each]
    for folder in given:
        if not folder.is_dir():
            raise InputError(f"makers' lists: no folder {folder} (given by the variable {ENVIRONMENT})")
    try:
        return given or [Path.home() / FOLDER]
    except RuntimeError:  # no home folder
        return []


def library_folders(base: Path) -> list[Path]:
    """Folders of makers' lists for specs of a folder: the project's, then the personal ones."""
    found = [project_folder(base), *personal_folders()]
    return list({each.resolve(): each for each in found if each is not None and each.is_dir()}.values())


def maker_items(base: Path, *further: Path) -> list[tuple[ListedItem, Path]]:
    """Every item for specs of a folder and in further folders of lists, with the file it is in.

    Raises
    ------
    InputError
        A file is refused: every error on its line.
    """
    folders = {each.resolve(): each for each in (*library_folders(base), *further)}.values()
    files = [path for folder in folders for path in sorted(folder.glob(f"*{SUFFIX}"))]
    return [(item, path) for path in files for item in read_model(MakerList, path).items]


def list_file(base: Path, name: str, *, personal: bool = False) -> Path:
    """File of a kept list that specs of a folder find.

    Parameters
    ----------
    base : Path
        Folder of the specs.
    name : str
        Name of the list: that of its file, without ending, in any case.
    personal : bool, optional
        Look in the personal folders alone.

    Raises
    ------
    InputError
        There is none, with the lists there are; or there are two.
    """
    folders = [each for each in personal_folders() if each.is_dir()] if personal else library_folders(base)
    files = [path for folder in folders for path in sorted(folder.glob(f"*{SUFFIX}"))]
    wanted = name.strip().removesuffix(SUFFIX).casefold()
    found = [path for path in files if path.stem.casefold() == wanted]
    if len(found) > 1:
        places = " and ".join(map(str, found))
        raise InputError(f'"{shorten_text(name)}" is the name of two lists: {places}; --personal takes that at home')
    if not found:
        there = " | ".join(path.stem for path in files) or "none"
        raise InputError(f'no list "{shorten_text(name)}" is kept; there are: {there} (conveyor library list)')
    return found[0]


def named_items(kept: MakerList, path: Path, name: str | None) -> list[ListedItem]:
    """Items of a list, those of a name in any case; all without a name.

    Raises
    ------
    InputError
        None has the name.
    """
    items = list(kept.items)
    found = [item for item in items if name is None or item.name.casefold() == name.strip().casefold()]
    if name is not None and not found:
        near = difflib.get_close_matches(name, [item.name for item in items], n=1)
        guess = f'did you mean "{near[0]}"?' if near else f"there are: {' | '.join(item.name for item in items)}"
        raise InputError(f'{path}: no item "{shorten_text(name)}"; {guess}')
    return found


class MakerLists:
    """Makers' lists for specs of a folder, read when a name first asks for them."""

    def __init__(self, base: Path | None = None) -> None:
        self._base = base or Path()

    @cached_property
    def _items(self) -> list[tuple[ListedItem, Path]]:
        return maker_items(self._base)

    def every(self, kind: MakerKind) -> list[ListedItem]:
        """All items of a kind."""
        return [item for item, _ in self._items if item.kind == kind]

    def item(self, kinds: Collection[MakerKind], name: str, others: Iterable[str] = ()) -> ListedItem:
        """Item of a name, in any case.

        Parameters
        ----------
        kinds : collection of MakerKind
            Kinds that it may be of.
        name : str
            Its name.
        others : iterable of str
            Names of the package's own library, for the message.

        Raises
        ------
        InputError
            There is none, with the names there are; or there are two.
        """
        folded = name.casefold().strip()
        found = [(item, path) for item, path in self._items if item.kind in kinds and item.name.casefold() == folded]
        if len(found) == 1:
            return found[0][0]
        if found:
            places = " and ".join(f"{path} ({item.kind})" for item, path in found)
            raise InputError(f'"{shorten_text(name)}" is in makers\' lists twice: {places}; rename one')
        known = {each.casefold(): each for each in others}
        known |= {item.name.casefold(): item.name for item, _ in self._items if item.kind in kinds}
        near = difflib.get_close_matches(folded, known, n=1)
        guess = f'; did you mean "{known[near[0]]}"?' if near else ";"
        there = " | ".join(known.values()) or "none, conveyor library add LIST.xlsx reads them from a maker's list"
        raise InputError(
            f'"{shorten_text(name)}" is not in the library of {" or ".join(kinds)}{guess} there are: {there}'
        )
