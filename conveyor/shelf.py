"""The shelf of rubber compounds: built in, beside it the user's own folders and files."""

from __future__ import annotations

import difflib
import os
from collections.abc import Callable, Iterable
from functools import lru_cache
from pathlib import Path
from typing import Final

from pydantic import ValidationError

from conveyor.document import listing, read_document
from conveyor.errors import InputError
from conveyor.explain import findings
from conveyor.models.compound import RubberCompound

ENVIRONMENT: Final = "CONVEYOR_SHELF"
"""Environment variable with further folders, separated as in PATH."""
_SUFFIXES = (".yaml", ".yml", ".json")


def built_in() -> Path:
    """Return the folder of the built-in compounds: in the installed package, else in the checkout.

    Raises
    ------
    InputError
        Neither exists: the installation is incomplete.
    """
    package = Path(__file__).parent
    for folder in (package / "_materials", package.parent / "materials"):
        if folder.is_dir():
            return folder
    raise InputError(f"no built-in shelf in {package / '_materials'}; install the package again")


def folders(extra: Iterable[str | Path] = ()) -> list[Path]:
    """Return the folders that are searched: `extra`, those of CONVEYOR_SHELF, the built-in one.

    Raises
    ------
    InputError
        A folder does not exist.
    """
    listed = [Path(folder) for folder in extra]
    listed += [Path(folder) for folder in os.environ.get(ENVIRONMENT, "").split(os.pathsep) if folder]
    for folder in listed:
        if not folder.is_dir():
            raise InputError(
                f"shelf {folder}: no such folder (argument or environment variable {ENVIRONMENT})"
            )
    return [*listed, built_in()]


def _files(extra: Iterable[str | Path]) -> dict[str, list[Path]]:
    """Find the compound files by their name on the shelf: the file's name without its ending."""
    found: dict[str, list[Path]] = {}
    unique = {folder.resolve(): folder for folder in folders(extra)}
    for folder in unique.values():
        for path in sorted(folder.iterdir()):
            if path.suffix.lower() in _SUFFIXES:
                found.setdefault(path.stem.casefold(), []).append(path)
    return found


def names(extra: Iterable[str | Path] = ()) -> list[str]:
    """Return the names on the shelf, sorted.

    Examples
    --------
    >>> "standard-cover" in names()
    True
    """
    return sorted(_files(extra))


def compound(
    name_or_path: str | Path, *, extra: Iterable[str | Path] = (), base: Path | None = None
) -> RubberCompound:
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
    if (
        isinstance(name_or_path, Path)
        or Path(text).suffix.lower() in _SUFFIXES
        or "/" in text
        or os.sep in text
    ):
        path = (base or Path()) / Path(text).expanduser()
        return read_compound(path)
    files = _files(extra)
    paths = files.get(text.casefold(), [])
    if len(paths) > 1:
        listed = " and ".join(str(path) for path in paths)
        raise InputError(f'compound "{text}" is on the shelf twice: {listed}; rename one or give its path')
    if not paths:
        near = difflib.get_close_matches(text.casefold(), files, n=1)
        guess = f'; did you mean "{near[0]}"?' if near else ""
        raise InputError(f'unknown compound "{text}"{guess}; on the shelf: {", ".join(sorted(files))}')
    return read_compound(paths[0])


def read_compound(path: Path) -> RubberCompound:
    """Read a compound file.

    Raises
    ------
    InputError
        The file cannot be read or its content is refused: one line for each error.
    """
    try:
        state = path.stat()
    except OSError:
        read_document(path)
        raise
    return _read_once(path, state.st_mtime_ns, state.st_size)


@lru_cache(maxsize=256)
def _read_once(path: Path, _changed: int, _size: int) -> RubberCompound:
    """Read a file, once for each state of it: models are frozen and may be shared."""
    document = read_document(path)
    try:
        read = RubberCompound.model_validate(document.data)
    except ValidationError as error:
        raise InputError(listing(document.path, findings(error, RubberCompound, document))) from None
    if document.findings:
        raise InputError(listing(document.path, document.findings))
    return read


def resolver(
    *, extra: Iterable[str | Path] = (), base: Path | None = None
) -> Callable[[str], RubberCompound]:
    """Return the function that models use to look compounds up while a spec is read."""
    listed = tuple(extra)

    def resolve(name: str) -> RubberCompound:
        return compound(name, extra=listed, base=base)

    return resolve
