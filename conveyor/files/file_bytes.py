"""Bytes of an input file; refused unless it is an ordinary file of an allowed size."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from conveyor.errors import InputError


def file_content(path: Path, *, largest: int, expected: str) -> bytes:
    """Read a file whole.

    Parameters
    ----------
    path : Path
        The file.
    largest : int
        Largest size [bytes].
    expected : str
        Expected kind of file, for the message on a larger one ("spec or compound file").

    Raises
    ------
    InputError
        No such file, a folder, a pipe or device, larger than allowed, or unreadable.
    """
    try:
        state = path.stat()
        refusal = _file_problem(state, largest, expected)
        content = path.read_bytes() if refusal is None else b""
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except ValueError:  # a null byte in the name
        raise InputError(f"{str(path)!r}: no name of a file") from None
    if refusal is not None:
        raise InputError(f"{path}: {refusal}")
    return content


def _file_problem(state: os.stat_result, largest: int, expected: str) -> str | None:
    if stat.S_ISDIR(state.st_mode):
        return "is a folder; give a file in it"
    if not stat.S_ISREG(state.st_mode):
        return "is no ordinary file (a pipe or a device); write it to a file first"
    return f"larger than {largest:,} bytes; this is no {expected}" if state.st_size > largest else None
