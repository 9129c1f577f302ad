"""`conveyor anchor`: test factor of a compound's indentation from rolling-resistance tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.application import argument, compound_names, option, print_lines
from conveyor.cli.output_files import SPEC
from conveyor.cli.shared_options import Session, session_command
from conveyor.files import output_marks

if TYPE_CHECKING:
    from conveyor.results.rolling_test_calibration import RollingTestCalibration
    from conveyor.units import System


@session_command(
    short_help="Set a compound's test factor by rolling tests.",
    without=("changed", "language"),
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
    output: Annotated[Path | None, option("Write the compound file (.yaml).", "FILE", "-o", "--output")] = None,
) -> None:
    """Set a compound's test factor by rolling-resistance tests: indentation measured over calculated."""
    to = session.outputs(compound, tests)
    to.file("--output", output, *SPEC, kind=output_marks.COMPOUND)
    from conveyor import shelf as store
    from conveyor.measured.rolling_test_table import read_rolling_tests
    from conveyor.results import rolling_test_calibration

    anchored = rolling_test_calibration.calibrate_compound(
        store.compound(compound, extra=session.shelf or ()), read_rolling_tests(tests, source), name=name
    )
    if output is not None:
        to.add(
            "compound file",
            output,
            {output: store.dump(anchored.compound, output_marks.FIT_HEADING).encode()},
        )
    session.answer(
        lambda: rolling_test_calibration.calibration_to_dict(anchored),
        to,
        lambda: _show_tests(anchored, session.system()),
    )


def _show_tests(anchored: RollingTestCalibration, system: System) -> None:
    """Print measured over calculated of the tests, row by row and in all."""
    from conveyor.cli.terminal import report_grid, terminal_console, wrap_line
    from conveyor.results import rolling_test_calibration

    screen = terminal_console()
    for part in (
        rolling_test_calibration.residual_table(anchored),
        rolling_test_calibration.factor_table(anchored),
    ):
        screen.print(report_grid(part, system), "")
    print_lines(
        *(wrap_line(line, screen.width, further="  ") for line in rolling_test_calibration.calibration_notes(anchored))
    )
