"""`conveyor new`: a commented spec to start from."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

from conveyor.cli.application import Force, Quiet, Units, app, argument, examples_text, option, print_lines
from conveyor.cli.output_files import Outputs
from conveyor.errors import InputError
from conveyor.files.output_marks import TO_FILL_IN

if TYPE_CHECKING:
    from conveyor.starter import Kind

_SI = cast("Units", "SI")


class StarterKind(StrEnum):
    """Kinds of starter: three conveyors, a duty to size one from, and full examples."""

    OVERLAND = "overland"
    IN_PLANT = "in-plant"
    DOWNHILL = "downhill"
    DUTY = "duty"
    SHUTTLE = "shuttle"
    REVERSIBLE = "reversible"
    CURVED = "curved"
    BRAKES = "brakes"
    TRANSFER = "transfer"
    SLIDER = "slider"
    CEMA = "cema"
    WEIGHED = "weighed"
    FEEDER = "feeder"
    PIPE = "pipe"
    DYNAMICS = "dynamics"
    STUDY = "study"
    SEARCH = "search"


@app.command(
    short_help="Write a commented spec to start from.",
    epilog=examples_text(
        "conveyor new mine.yaml",
        "conveyor new mine.yaml --kind in-plant --units US",
        "conveyor new duty.yaml --kind duty",
        "conveyor new spacing.yaml --kind study",
    ),
)
def new(
    spec: Annotated[Path, argument("Spec to write (.yaml).", show_default=False)],
    kind: Annotated[
        StarterKind,
        option(
            "Conveyor to begin with; duty: what one is to be sized from. overland, in-plant, downhill and duty have a "
            "comment for every field; the others are whole examples, in SI."
        ),
    ] = StarterKind.OVERLAND,
    units: Annotated[Units, option("System of units.")] = _SI,
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Write a spec to start from: every field that matters, with a comment; it runs as it stands."""
    if spec.suffix.lower() not in {".yaml", ".yml"}:
        workbook = f"; a workbook to fill in: conveyor template {spec}" if spec.suffix.lower() == ".xlsx" else ""
        raise InputError(f'{spec}: a spec\'s name ends in .yaml, such as "{spec.with_suffix(".yaml")}"{workbook}')
    to = Outputs(force=force)
    to.file("SPEC", spec, ".yaml", ".yml", kind=TO_FILL_IN)
    from conveyor.starter import EXAMPLES, example_files, quote_path, starter_text

    system = units.value
    if kind.value in EXAMPLES:
        files, command = example_files(kind.value, spec), EXAMPLES[kind.value].command
        if system != "SI":
            raise InputError(
                f"--units {system}: the example of --kind {kind.value} is in SI only; leave out --units here, and "
                f"for a report in {system} units: conveyor {command} {quote_path(str(spec))} --units {system.lower()}"
            )
        for beside in [path for path in files if path != spec]:
            to.file("SPEC", beside, ".yaml", kind=TO_FILL_IN)
    else:
        files = {spec: starter_text(cast("Kind", kind.value), system, file=spec.name).encode()}
        command = "size" if kind is StarterKind.DUTY else "power"
    for path, content in files.items():
        to.add("spec", path, {path: content})
    lines = to.save()
    if not quiet:
        more = {"study": " -o points.csv", "optimise": " -o best.yaml"}.get(command, "")
        print_lines(*lines, f"next: conveyor {command} {quote_path(str(spec))}{more}")
