"""Atomic writing of files: under temporary names first, then renamed, all or none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from conveyor.errors import InputError


def check_writable(path: Path) -> None:
    """Refuse a path that cannot be written.

    Raises
    ------
    InputError
        A folder, a device, a read-only file, or in a missing or read-only folder; links are followed.
    """
    try:
        target = _link_target(path)
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


def _link_target(path: Path) -> Path:
    """Target of a path, links followed; it need not exist."""
    try:
        target = path.resolve()
    except (RuntimeError, ValueError) as error:  # links in a circle, before Python 3.13; a null byte
        raise OSError(0, str(error)) from None
    if target.is_symlink():
        raise OSError(0, f"links in a circle from {path}")
    return target


def save_files(contents: Mapping[Path, bytes | memoryview], *, folders: Iterable[Path] = ()) -> None:
    """Write files under temporary names and rename them: all of them, or nothing is changed.

    Parameters
    ----------
    contents : mapping of Path to bytes
        Content by path; links are followed.
    folders : iterable of Path
        Created first where missing.

    Raises
    ------
    InputError
        One cannot be written; no file is changed and nothing temporary is left.
    """
    at = next(iter(contents), Path())
    with ExitStack() as undo:
        try:
            for at in folders:
                if not at.is_dir():
                    at.mkdir()
                    undo.callback(_try_undo, at.rmdir)
            parts = {}
            for at, content in contents.items():
                check_writable(at)
                target = _link_target(at)
                parts[at] = target, _temporary_path(target)
                undo.callback(_try_undo, parts[at][1].unlink)
                parts[at][1].write_bytes(content)
                if target.exists():
                    shutil.copymode(target, parts[at][1])
            older = [_move_into_place(*parts[at], undo) for at in contents]
        except OSError as error:
            raise InputError(f"{at}: cannot be written ({error.strerror or error})") from None
        undo.pop_all()
    for kept in older:
        _try_undo(kept.unlink)


@contextmanager
def name_write_errors(path: Path) -> Iterator[None]:
    """Name the output file in errors of writing it or the temporary files its content is made with.

    Raises
    ------
    InputError
        Disk full, file too large, no permission.
    """
    try:
        yield
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror or error})") from None


@contextmanager
def partial_file(path: Path) -> Iterator[Path]:
    """Temporary file for content written piece by piece; renamed to the path when complete.

    Raises
    ------
    InputError
        The file cannot be written; an older file is untouched, nothing temporary is left.
    """
    check_writable(path)
    part = _temporary_path(_link_target(path))
    try:
        with name_write_errors(path):
            yield part
            part.replace(_link_target(path))
    finally:
        part.unlink(missing_ok=True)


def _move_into_place(target: Path, part: Path, undo: ExitStack) -> Path:
    """Rename a temporary file to its target; returns the backup of the older file, restored on failure."""
    older = _temporary_path(target)
    if target.exists():
        with suppress(OSError):
            os.link(target, older)
        if not older.exists():  # no hard links on this file system
            target.rename(older)
        undo.callback(_try_undo, older.unlink)  # a rename onto a hard link of the same file leaves both
        undo.callback(_try_undo, lambda: older.replace(target))
    else:
        undo.callback(_try_undo, target.unlink)
    part.replace(target)
    return older


def _temporary_path(path: Path) -> Path:
    return path.with_name(f".{uuid4().hex}.part")


def _try_undo(undone: Callable[[], object]) -> None:
    """Undo a step; errors are ignored."""
    with suppress(OSError):
        undone()
