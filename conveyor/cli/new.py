"""`conveyor new`: a commented spec to start from."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from conveyor.cli.app import Force, Quiet, Units, app, examples, say
from conveyor.cli.outputs import Outputs
from conveyor.errors import InputError
from conveyor.files.marks import TO_FILL_IN


class StarterKind(StrEnum):
    """What there is a starter of: three conveyors, and a duty to size one from."""

    OVERLAND = "overland"
    IN_PLANT = "in-plant"
    DOWNHILL = "downhill"
    DUTY = "duty"


@app.command(
    short_help="Write a commented spec to start from.",
    epilog=examples(
        "conveyor new mine.yaml",
        "conveyor new mine.yaml --kind in-plant --units US",
        "conveyor new duty.yaml --kind duty",
    ),
)
def new(
    spec: Annotated[Path, typer.Argument(help="Spec to write (.yaml).", show_default=False)],
    kind: Annotated[
        StarterKind,
        typer.Option(
            help="Conveyor the example values belong to; duty: of one to be sized.", case_sensitive=False
        ),
    ] = StarterKind.OVERLAND,
    units: Annotated[Units, typer.Option(help="System of units.", case_sensitive=False)] = Units.SI,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Write a spec to start from: every field that matters, with a comment; it runs as it stands."""
    if spec.suffix.lower() not in {".yaml", ".yml"}:
        raise InputError(f'{spec}: a spec\'s name ends in .yaml, got "{spec.suffix}"')
    to = Outputs(force=force)
    to.file("SPEC", spec, ".yaml", ".yml", kind=TO_FILL_IN)
    from conveyor.starter import quoted, written

    to.add("spec", spec, {spec: written(kind.value, units.value, file=spec.name).encode()})
    lines = to.save()
    if not quiet:
        command = "size" if kind is StarterKind.DUTY else "power"
        say(*lines, f"next: conveyor {command} {quoted(str(spec))}")
