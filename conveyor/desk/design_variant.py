"""A variant: an open file and the changes of a page, as a conveyor, as text of the file, as a line to copy."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeAlias

from conveyor import shelf
from conveyor.desk.design_form import read_change
from conveyor.errors import InputError
from conveyor.files.compound_folders import SUFFIXES, folders
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import CompoundResolver, field_value, with_fields
from conveyor.reuse import ReuseCache

TextChanges: TypeAlias = Mapping[str, str | None]
"""Texts by the path of their field; None takes a value away."""
MOST_CHANGES: Final = 500
"""Changes of a variant, at most."""
_COMPOUND: Final = re.compile(r"belt\.(?:top|bottom)_cover\.compound")
_FIELD: Final = re.compile(r"((?:[a-z_]+(?:\.[a-z_]+|\[[0-9]+\])*)): (.*)", re.DOTALL)
_PLAIN: Final = re.compile(r"[\w .,:/%+=\[\]^*°µ²³-]*")


class FieldError(NamedTuple):
    """A refusal and its field; "" for what belongs to none."""

    path: str
    message: str


def guarded_resolver(base: Path, shelves: Iterable[Path]) -> CompoundResolver:
    """Return the look-up of compounds for a page: from the shelves, and from files in the folder of the spec.

    Parameters
    ----------
    base : Path
        Folder of the spec.
    shelves : iterable of Path
        Further folders of compounds.
    """
    listed = tuple(shelves)
    resolve = shelf.resolver(extra=listed, base=base)

    def resolve_inside(name: str) -> RubberCompound:
        if "/" in name or os.sep in name or Path(name).suffix.lower() in SUFFIXES:
            allowed = [folder.resolve() for folder in (base, *folders(listed))]
            try:
                target = (base / name).resolve()
            except (OSError, RuntimeError, ValueError):
                target = Path()
            if name.startswith("~") or not any(target.is_relative_to(folder) for folder in allowed):
                raise InputError(
                    f'compound "{name}": outside the folder of the spec and the shelves; copy it there, or start with '
                    "--shelf FOLDER"
                )
        try:
            return resolve(name)
        except InputError as error:
            raise InputError(_without_folders(str(error), (base, base.resolve(), *folders(listed)))) from None

    return resolve_inside


def _without_folders(words: str, known: Iterable[Path]) -> str:
    """Words without the folders of files, which are not the page's to know."""
    for folder in known:
        if folder.is_absolute():
            words = words.replace(f"{folder}{os.sep}", "")
    return words


def change_conveyor(
    conveyor: Conveyor, changes: TextChanges, resolve: CompoundResolver, kept: ReuseCache | None = None
) -> Conveyor:
    """Conveyor of a variant.

    Parameters
    ----------
    conveyor : Conveyor
        The spec as its file gives it.
    changes : mapping of str to str or None
        Texts by path.
    resolve : callable
        Looks up compounds.
    kept : ReuseCache, optional
        Cache of earlier calls.

    Raises
    ------
    InputError
        Refused; a line for each field, with its path.
    """
    if len(changes) > MOST_CHANGES:
        raise InputError(f"{len(changes)} changes, at most {MOST_CHANGES}; save the spec, and go on from it")
    refused: list[str] = []
    values: dict[str, Any] = {}
    for path, text in changes.items():
        try:
            values[path] = _change_value(conveyor, path, text, resolve)
        except InputError as error:
            refused.append(str(error))
    made = conveyor
    try:
        made = with_fields(conveyor, values, resolve=resolve, kept=kept)
    except InputError as error:
        refused += str(error).splitlines()
    if refused:
        raise InputError("\n".join(refused))
    return made


def _change_value(conveyor: Conveyor, path: str, text: str | None, resolve: CompoundResolver) -> Any:
    value = read_change(path, text)
    if isinstance(value, str) and _COMPOUND.fullmatch(path):
        try:
            found = resolve(value)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        return value if isinstance(field_value(conveyor, path), RubberCompound) else found
    return value


def field_errors(message: str) -> list[FieldError]:
    """Lines of a refusal with the field that each is about.

    Examples
    --------
    >>> field_errors("belt.speed: got 90 m/s, allowed: <= 20 m/s")
    [FieldError(path='belt.speed', message='got 90 m/s, allowed: <= 20 m/s')]
    """
    found = (_FIELD.fullmatch(line) for line in message.splitlines())
    lines = zip(message.splitlines(), found, strict=True)
    return [FieldError("", line) if at is None else FieldError(at[1], at[2]) for line, at in lines]


def command_line(name: str, changes: TextChanges) -> str:
    """Command that calculates a variant in a terminal.

    Examples
    --------
    >>> command_line("mine.yaml", {"belt.speed": "5.5 m/s"})
    'conveyor power mine.yaml --set "belt.speed=5.5 m/s"'
    """
    settings = "".join(f" --set {_quote_word(f'{path}={_setting_text(path, text)}')}" for path, text in changes.items())
    return f"conveyor power {name if ' ' not in name else _quote_word(name)}{settings}"


def _setting_text(path: str, text: str | None) -> str:
    """Value as `--set` reads it back: JSON where plain text would be read as something else."""
    value = read_change(path, text)
    if isinstance(value, str):
        try:
            json.loads(value)
        except ValueError:
            return value
    return json.dumps(value, ensure_ascii=False)


def _quote_word(word: str) -> str:
    """Word in quotes that shells leave as it is."""
    return f'"{word}"' if _PLAIN.fullmatch(word) else "'" + word.replace("'", "'\\''") + "'"
