"""Files and folders a command is asked to write: refused before any time is spent on what would be in them."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path

from conveyor.errors import InputError
from conveyor.files.saving import writable


def file(option: str, path: Path | None, *endings: str) -> None:
    """Refuse a file that cannot be written, or whose name says it is something else.

    Raises
    ------
    InputError
        As `writable`, or another ending than those given.
    """
    if path is None:
        return
    if path.suffix.lower() not in endings:
        *others, last = endings
        allowed = f"{', '.join(others)} or {last}" if others else last
        raise InputError(f'{option}: {path}: its name ends in {allowed}, got "{path.suffix}"')
    writable(path)


def folder(option: str, path: Path | None) -> None:
    """Refuse a folder that is none, or that neither exists nor can be made.

    Raises
    ------
    InputError
        A file has its name, or the folder that holds it does not exist or is read-only.
    """
    if path is None:
        return
    if path.exists() and not path.is_dir():
        raise InputError(f"{option}: {path}: is a file; give the name of a folder")
    holder = path if path.is_dir() else path.absolute().parent
    if not holder.is_dir():
        raise InputError(f"{option}: {path}: its folder does not exist; create it or choose another")
    if not os.access(holder, os.W_OK):
        raise InputError(f"{option}: {path}: {holder} is read-only; choose another folder")


def tables(path: Path | None, *, parquet: bool) -> None:
    """Refuse a folder for tables as `folder` does, and Parquet without a folder or the package that writes it.

    Raises
    ------
    InputError
        As `folder`; no folder, or no such package.
    """
    folder("--tables", path)
    if not parquet:
        return
    if path is None:
        raise InputError("--parquet: says how tables are written; give --tables FOLDER, too")
    if find_spec("pyarrow") is None:
        raise InputError("--parquet: needs the package pyarrow (pip install pyarrow); without it: CSV")


def make(path: Path) -> Path:
    """Make a folder where there is none.

    Raises
    ------
    InputError
        It cannot be made.
    """
    try:
        path.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(f"{path}: cannot be made ({error.strerror or error})") from None
    return path
