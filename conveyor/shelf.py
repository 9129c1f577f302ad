"""The shelf of rubber compounds: the built-in folder, and the user's own folders and files."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError
from conveyor.files.compound_folders import ENVIRONMENT, SUFFIXES, built_in, compound_files, folders
from conveyor.files.document import read_document, yaml_text
from conveyor.models.compound import RubberCompound
from conveyor.models.file_kinds import read_file_of

__all__ = ["ENVIRONMENT", "built_in", "compound", "dump", "folders", "names", "read_compound", "resolver"]


@check_arguments
def names(extra: Iterable[str | Path] = ()) -> list[str]:
    """Return the names on the shelf, sorted.

    Examples
    --------
    >>> "standard-cover" in names()
    True
    """
    return sorted(compound_files(extra))


@check_arguments
def compound(name_or_path: str | Path, *, extra: Iterable[str | Path] = (), base: Path | None = None) -> RubberCompound:
    """Return a compound by its shelf name (in any case) or the path of its file.

    Parameters
    ----------
    name_or_path : str or Path
        ``"s100"``, or a path: anything with a folder or the ending .yaml, .yml or .json.
    extra : iterable of path
        Further folders to search.
    base : Path, optional
        Folder that a relative path starts from; default: the working directory.

    Raises
    ------
    InputError
        Unknown name (with the names there are), two files of one name, or a file with errors (every one
        on its line).

    Examples
    --------
    >>> compound("S100").kind
    'measured'
    """
    text = str(name_or_path)
    if isinstance(name_or_path, Path) or Path(text).suffix.lower() in SUFFIXES or "/" in text or os.sep in text:
        return read_compound((base or Path()) / _expand_home(text))
    known = compound_files(extra)
    paths = known.get(text.casefold(), [])
    if len(paths) > 1:
        listed = " and ".join(str(path) for path in paths)
        raise InputError(f'compound "{text}" is on the shelf twice: {listed}; rename one or give its path')
    if not paths:
        near = difflib.get_close_matches(text.casefold(), known, n=1)
        guess = f'; did you mean "{near[0]}"?' if near else ""
        raise InputError(f'unknown compound "{text}"{guess}; on the shelf: {", ".join(sorted(known))}')
    return read_compound(paths[0])


def _expand_home(text: str) -> Path:
    try:
        return Path(text).expanduser()
    except RuntimeError:
        raise InputError(f'compound "{text}": no home folder "{Path(text).parts[0]}"; give the path in full') from None


def read_compound(path: Path) -> RubberCompound:
    """Read a compound file.

    Raises
    ------
    InputError
        The file cannot be read or its content is refused: one line for each error.
    """
    try:
        state = path.stat()
    except (OSError, ValueError):  # ValueError: a null byte in the name
        read_document(path)
        raise
    return _read_cached(path, state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=256)
def _read_cached(path: Path, _changed: int, _size: int) -> RubberCompound:
    """Read a file, cached by its time and size: models are frozen and may be shared."""
    return read_file_of(RubberCompound, path)


def resolver(*, extra: Iterable[str | Path] = (), base: Path | None = None) -> Callable[[str], RubberCompound]:
    """Return the function by which models look up compounds while a spec is read.

    Raises
    ------
    InputError
        A folder does not exist.
    """
    listed = tuple(extra)
    folders(listed)

    def resolve(name: str) -> RubberCompound:
        return compound(name, extra=listed, base=base)

    return resolve


@check_arguments
def dump(compound: RubberCompound, heading: str = "") -> str:
    """YAML text of a compound file, as the shelf reads it; lists of numbers and terms on one line each.

    Parameters
    ----------
    compound : RubberCompound
        Compound to write.
    heading : str
        A comment for the first line, without ``#``.
    """
    from ruamel.yaml.comments import CommentedMap, CommentedSeq

    def laid(value: Any) -> Any:
        if isinstance(value, Mapping):
            made = CommentedMap({key: laid(item) for key, item in value.items()})
            if set(made) == {"modulus", "time"}:
                made.fa.set_flow_style()
            return made
        if isinstance(value, list):
            row = CommentedSeq([laid(item) for item in value])
            if not any(isinstance(item, Mapping | list) for item in value) and _fits_one_line(value):
                row.fa.set_flow_style()
            return row
        return value

    written = yaml_text(laid(compound.as_data()), width=100_000)  # no line breaks in rows
    return (f"# {heading}\n" if heading else "") + written


def _fits_one_line(items: list[Any]) -> bool:
    """True for a list of numbers and short texts."""
    return all(not isinstance(item, str) or len(item) < 24 for item in items)
