"""Files written whole or not at all: temporary names beside their own first, then renamed."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

from conveyor.errors import InputError


def writable(path: Path) -> None:
    """Refuse a path that cannot be written before any time is spent on what would be in it.

    Raises
    ------
    InputError
        A folder, a device, a read-only file, or in a folder that does not exist or is read-only.
    """
    try:
        folder, there, ordinary = path.is_dir(), path.exists(), path.is_file()
        held = path.absolute().parent.is_dir()
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    if folder:
        raise InputError(f"{path}: is a folder; give the name of a file in it")
    if not held:
        raise InputError(f"{path}: its folder does not exist; create it or choose another")
    if there and not ordinary:
        raise InputError(f"{path}: is no ordinary file (a pipe or a device); give the name of a file")
    if there and not os.access(path, os.W_OK):
        raise InputError(f"{path}: is read-only; change that or choose another name")
    if not os.access(path.absolute().parent, os.W_OK):
        raise InputError(f"{path}: its folder is read-only; choose another")


def save(contents: Mapping[Path, bytes | memoryview]) -> None:
    """Write files: all under temporary names, then each under its own, in their order.

    Parameters
    ----------
    contents : mapping of Path to bytes
        What goes into each; the last one named is the one that speaks of the others.

    Raises
    ------
    InputError
        One cannot be written; none of them is half-written, older ones are untouched, nothing temporary is left.
    """
    for path in contents:
        writable(path)
    parts = {path: path.with_name(f".{uuid4().hex}.part") for path in contents}
    at = next(iter(contents), Path())
    try:
        for at, part in parts.items():
            part.write_bytes(contents[at])
        for at, part in parts.items():
            part.replace(at)
    except OSError as error:
        raise InputError(f"{at}: cannot be written ({error.strerror or error})") from None
    finally:
        for part in parts.values():
            with suppress(OSError):  # gone after the rename; a folder that went away has nothing to clean
                part.unlink(missing_ok=True)
