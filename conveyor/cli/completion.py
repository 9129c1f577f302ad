"""Names of compounds for the shell to complete: read off the file names, without a heavy import."""

from __future__ import annotations

import typer

from conveyor.errors import InputError
from conveyor.files.shelves import files


def compound_names(context: typer.Context, incomplete: str) -> list[str]:
    """Names on the shelf that begin with what was typed; the folders of --shelf are searched, too."""
    given = context.params.get("shelf") or context.params.get("shelves") or ()
    try:
        known = files(given)
    except InputError:
        return []
    return sorted(name for name in known if name.startswith(incomplete.casefold()))
