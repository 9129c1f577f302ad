"""Full examples from the examples folder, each runnable as it is."""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

import conveyor
from conveyor.errors import InputError


class Example(NamedTuple):
    """Example: file, command that runs it, spec that it varies."""

    file: str
    command: str = "power"
    base: str | None = None


EXAMPLES: Final = {
    "shuttle": Example("specs/shuttle.yaml"),
    "reversible": Example("specs/reversible.yaml"),
    "curved": Example("specs/curved.yaml"),
    "brakes": Example("specs/downhill_brakes.yaml"),
    "transfer": Example("specs/transfer.yaml"),
    "slider": Example("specs/slider.yaml"),
    "feeder": Example("specs/feeder.yaml"),
    "pipe": Example("specs/pipe.yaml"),
    "cema": Example("specs/by_cema_us.yaml"),
    "weighed": Example("specs/weighed.yaml"),
    "dynamics": Example("dynamics/overland_15km.yaml", "dynamics"),
    "study": Example("studies/spacing.yaml", "study", "specs/overland.yaml"),
    "search": Example("studies/search.yaml", "optimise", "specs/overland_10km.yaml"),
}
"""Examples by kind of `conveyor new`."""


def example_files(kind: str, path: Path) -> dict[Path, bytes]:
    """Files of an example by the paths to write: itself, and next to it the spec that a study varies.

    Raises
    ------
    InputError
        The package is incomplete.

    Examples
    --------
    >>> [file.name for file in example_files("study", Path("spacing.yaml"))]
    ['spacing.yaml', 'spacing_base.yaml']
    """
    shown = EXAMPLES[kind]
    told = _example_text(shown.file)
    if shown.base is None:
        return {path: told.encode()}
    base = path.with_name(f"{path.stem}_base.yaml")
    return {
        path: told.replace(f"../{shown.base}", base.name).encode(),
        base: _example_text(shown.base).encode(),
    }


def _example_text(name: str) -> str:
    """Text of an example file, of the package or the checkout."""
    package = Path(conveyor.__file__).parent
    for folder in (package / "_examples", package.parent / "examples"):
        if (folder / name).is_file():
            return (folder / name).read_text(encoding="utf-8")
    raise InputError(f"no example {name} in {package / '_examples'}; install the package again")
