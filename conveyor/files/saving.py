"""Files written whole or not at all: temporary names beside their own first, then renamed; all of them or none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from conveyor.errors import InputError


def writable(path: Path) -> None:
    """Refuse a path that cannot be written before any time is spent on what would be in it.

    Raises
    ------
    InputError
        A folder, a device, a read-only file, or in a folder that does not exist or is read-only; of a link what it
        leads to.
    """
    try:
        target = _target(path)
        folder, there, ordinary = target.is_dir(), target.exists(), target.is_file()
        held = target.parent.is_dir()
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None
    if folder:
        raise InputError(f"{path}: is a folder; give the name of a file in it")
    if not held:
        raise InputError(f"{path}: its folder does not exist; create it or choose another")
    if there and not ordinary:
        raise InputError(f"{path}: is no ordinary file (a pipe or a device); give the name of a file")
    if there and not os.access(target, os.W_OK):
        raise InputError(f"{path}: is read-only; change that or choose another name")
    if not os.access(target.parent, os.W_OK):
        raise InputError(f"{path}: its folder is read-only; choose another")


def _target(path: Path) -> Path:
    """What a path leads to through links, there or not."""
    try:
        target = path.resolve()
    except (RuntimeError, ValueError) as error:  # links in a circle, before Python 3.13; a null byte
        raise OSError(0, str(error)) from None
    if target.is_symlink():
        raise OSError(0, f"links in a circle from {path}")
    return target


def save(contents: Mapping[Path, bytes | memoryview], *, folders: Iterable[Path] = ()) -> None:
    """Write files: all under temporary names, then each under its own; all of them, or nothing is changed.

    Parameters
    ----------
    contents : mapping of Path to bytes
        What goes into each; of a link into what it leads to.
    folders : iterable of Path
        Made first where they are not there.

    Raises
    ------
    InputError
        One cannot be written; none of them is half-written or new, older ones are untouched, nothing temporary is left.
    """
    at = next(iter(contents), Path())
    with ExitStack() as undo:
        try:
            for at in folders:
                if not at.is_dir():
                    at.mkdir()
                    undo.callback(_without, at.rmdir)
            parts = {}
            for at, content in contents.items():
                writable(at)
                target = _target(at)
                parts[at] = target, _beside(target)
                undo.callback(_without, parts[at][1].unlink)
                parts[at][1].write_bytes(content)
                if target.exists():
                    shutil.copymode(target, parts[at][1])
            older = [_replaced(*parts[at], undo) for at in contents]
        except OSError as error:
            raise InputError(f"{at}: cannot be written ({error.strerror or error})") from None
        undo.pop_all()
    for kept in older:
        _without(kept.unlink)


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Name a file that cannot be written, also where that shows as its content is made: in files of the system's own.

    Raises
    ------
    InputError
        The system refuses to write: no room, a file too large, no permission.
    """
    try:
        yield
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None


@contextmanager
def growing(path: Path) -> Iterator[Path]:
    """A temporary file beside a path, for what is written piece by piece; it takes the path's name when it is whole.

    Raises
    ------
    InputError
        It cannot be written; an older file is untouched, nothing temporary is left.
    """
    writable(path)
    part = _beside(_target(path))
    try:
        with naming(path):
            yield part
            part.replace(_target(path))
    finally:
        part.unlink(missing_ok=True)


def _replaced(target: Path, part: Path, undo: ExitStack) -> Path:
    """Rename a part to its target; the older file waits beside it, to come back if a later one fails."""
    older = _beside(target)
    if target.exists():
        with suppress(OSError):
            os.link(target, older)
        if not older.exists():  # a file system without a second name for a file
            target.rename(older)
        undo.callback(_without, older.unlink)  # a rename onto a second name of the same file leaves both
        undo.callback(_without, lambda: older.replace(target))
    else:
        undo.callback(_without, target.unlink)
    part.replace(target)
    return older


def _beside(path: Path) -> Path:
    return path.with_name(f".{uuid4().hex}.part")


def _without(undone: Callable[[], object]) -> None:
    """Undo a step that may not have been taken."""
    with suppress(OSError):
        undone()
