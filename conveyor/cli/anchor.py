"""`conveyor anchor`: test factor of a compound's indentation from rolling-resistance tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.app import argument, compound_names, option, say
from conveyor.cli.outputs import SPEC
from conveyor.cli.session import Session, command
from conveyor.files import marks

if TYPE_CHECKING:
    from conveyor.anchoring import Anchored
    from conveyor.units import System


@command(
    short_help="Set a compound's level by rolling-resistance tests.",
    without=("changed",),
    examples_of=(
        "conveyor anchor mine.yaml --tests campaign.csv -o mine-tested.yaml",
        "conveyor anchor standard-cover --tests campaign.csv --name acme-x -o acme-x.yaml",
    ),
)
def anchor(
    session: Session,
    compound: Annotated[
        str, argument("Compound by shelf name or file.", autocompletion=compound_names, show_default=False)
    ],
    tests: Annotated[
        Path,
        option(
            "Tests (.csv or .xlsx): columns line load, resistance, roll diameter, cover thickness, speed, "
            "temperature; uncertainty, specimen, source, note. Units in the headers: line load [N/mm]. Or the sheet of "
            "verify-sheet, filled in.",
            "FILE",
            show_default=False,
        ),
    ],
    name: Annotated[
        str | None,
        option("Name of the tested compound where only its tests are known: COMPOUND carries them."),
    ] = None,
    source: Annotated[
        str | None, option("Laboratory and report of rows that do not say it; else the file's name.")
    ] = None,
    output: Annotated[
        Path | None, option("Write the compound file (.yaml).", "FILE", "-o", "--output")
    ] = None,
) -> None:
    """Set the level of a compound's indentation by rolling-resistance tests: measured over calculated."""
    to = session.outputs(compound, tests)
    to.file("--output", output, *SPEC, kind=marks.COMPOUND)
    from conveyor import anchoring
    from conveyor import shelf as store
    from conveyor.measured.rolling_tests import read_rolling_tests

    anchored = anchoring.anchored(
        store.compound(compound, extra=session.shelf or ()), read_rolling_tests(tests, source), name=name
    )
    if output is not None:
        to.add("compound file", output, {output: store.dump(anchored.compound, marks.FITTED).encode()})
    session.answer(lambda: anchoring.plain(anchored), to, lambda: _show(anchored, session.system()))


def _show(anchored: Anchored, system: System) -> None:
    """Print measured over calculated of the tests, row by row and in all."""
    from conveyor import anchoring
    from conveyor.cli.terminal import console, grid, wrapped

    screen = console()
    for part in (anchoring.rows(anchored), anchoring.levels(anchored)):
        screen.print(grid(part, system), "")
    say(*(wrapped(line, screen.width, further="  ") for line in anchoring.lines(anchored)))
