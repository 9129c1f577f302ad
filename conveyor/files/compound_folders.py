"""Folders of compound files and the names in them; no file is read."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from conveyor.errors import InputError

ENVIRONMENT: Final = "CONVEYOR_SHELF"
"""Environment variable of further folders, separated as in PATH."""
SUFFIXES: Final = (".yaml", ".yml", ".json")


def built_in() -> Path:
    """Return the folder of the built-in compounds: in the installed package, else in the checkout.

    Raises
    ------
    InputError
        Neither exists: the installation is incomplete.
    """
    package = Path(__file__).parents[1]
    for folder in (package / "_materials", package.parent / "materials"):
        if folder.is_dir():
            return folder
    raise InputError(f"no built-in shelf in {package / '_materials'}; install the package again")


def folders(extra: Iterable[str | Path] = ()) -> list[Path]:
    """Return the folders to search: `extra`, those of CONVEYOR_SHELF, the built-in one.

    Raises
    ------
    InputError
        A folder does not exist.
    """
    listed = [Path(folder) for folder in extra]
    listed += [Path(folder) for folder in os.environ.get(ENVIRONMENT, "").split(os.pathsep) if folder]
    for folder in listed:
        if not folder.is_dir():
            why = "is a file, no folder" if folder.is_file() else "no such folder"
            raise InputError(f"shelf {folder}: {why} (given by --shelf, shelves= or the variable {ENVIRONMENT})")
    return [*listed, built_in()]


def compound_files(extra: Iterable[str | Path]) -> dict[str, list[Path]]:
    """Compound files by shelf name, the file name without its ending."""
    by_name: dict[str, list[Path]] = {}
    unique = {folder.resolve(): folder for folder in folders(extra)}
    for folder in unique.values():
        try:
            listed = sorted(folder.iterdir())
        except OSError as error:
            raise InputError(f"shelf {folder}: cannot be read ({error.strerror or error})") from None
        for path in listed:
            if path.suffix.lower() in SUFFIXES:
                by_name.setdefault(path.stem.casefold(), []).append(path)
    return by_name
