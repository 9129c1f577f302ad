"""Files of a report written whole or not at all: temporary names beside their own first, then renamed."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

from conveyor.errors import InputError


def save(contents: Mapping[Path, bytes | memoryview]) -> None:
    """Write files: all under temporary names, then each under its own, in their order.

    Parameters
    ----------
    contents : mapping of Path to bytes
        What goes into each; the last one named is the one that speaks of the others.

    Raises
    ------
    InputError
        One cannot be written; none of them is half-written and nothing temporary is left.
    """
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
            with suppress(
                OSError
            ):  # no such file after the rename; a folder that went away has nothing to clean
                part.unlink(missing_ok=True)
