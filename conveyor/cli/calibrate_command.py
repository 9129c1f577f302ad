"""`conveyor calibrate`: factors on forces from measured power."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.application import Spec, option, print_lines, si_of
from conveyor.cli.output_files import SPEC
from conveyor.cli.shared_options import Session, session_command
from conveyor.files import output_marks

if TYPE_CHECKING:
    from conveyor.results.comparisons import CalibrationStudy
    from conveyor.units import System

_RUN_COLUMNS = ("run", "flow", "speed", "temperature", "measured", "before", "after", "difference", "note")
"""Columns shown on a terminal."""


@session_command(
    short_help="Calibrate a conveyor to measured power.",
    examples_of=(
        "conveyor calibrate mine.yaml --measured runs.csv",
        'conveyor calibrate mine.yaml --measured runs.xlsx --error "2 %" -o calibration.yaml',
        "conveyor calibrate mine.yaml --measured runs.csv --factor indentation --factor idler_rotation",
    ),
)
def calibrate(
    session: Session,
    spec: Spec,
    measured: Annotated[
        Path,
        option(
            "Runs (.csv or .xlsx): columns motor power or mains power, flow; speed, temperature, air temperature, "
            "standard deviation, note. Units in the headers: flow [t/h].",
            "FILE",
            show_default=False,
        ),
    ],
    error: Annotated[
        str | None,
        option('Standard deviation of a measured power, such as "2 %"; else from the differences.', "PERCENT"),
    ] = None,
    factors: Annotated[
        list[str] | None,
        option(
            "indentation, idler_rotation, flexure or misalignment, for itself; may be repeated. Else what the runs "
            "tell apart.",
            "NAME",
            "--factor",
        ),
    ] = None,
    output: Annotated[
        list[Path] | None,
        option(
            "Write the part of the spec (.yaml) or the report (.xlsx, .html, .pdf); may be repeated.",
            "FILE",
            "-o",
            "--output",
        ),
    ] = None,
) -> None:
    """Fit factors on indentation, idler rotation and flexure to measured power, as far as the runs tell them apart."""
    to = session.outputs(spec, measured)
    parts = to.reports(output, *SPEC, kind=output_marks.FACTORS)
    import conveyor

    line = session.read(spec)
    system = session.system(line)
    share = si_of("--error", error, "fraction")
    with session.progress("runs") as told:
        calibration = conveyor.calibrate(line, measured, error=share, factors=factors, progress=told)
    to.write(calibration.contents(system))
    for path in parts:
        to.add("part of a spec", path, {path: output_marks.mark_unedited(calibration.fragment, "calibrate")})
    session.answer(calibration.to_dict, to, lambda: _show_calibration(calibration, system))


def _show_calibration(calibration: CalibrationStudy, system: System) -> None:
    """Print factors, correlation, runs, and the part of the spec."""
    from conveyor.cli.terminal import report_grid, terminal_console, wrap_line
    from conveyor.report.tables import calibration_tables

    screen = terminal_console()
    runs = calibration_tables.run_table(calibration).only(*_RUN_COLUMNS)
    for part in (
        calibration_tables.factor_table(calibration),
        calibration_tables.correlation_table(calibration),
        runs,
    ):
        if part.rows:
            screen.print(report_grid(part, system), "")
            if part.note:
                print_lines(part.note, "")
    print_lines("basis and limitations:")
    print_lines(
        *(
            wrap_line(line, screen.width, first="  - ", further="    ")
            for line in calibration_tables.note_lines(calibration)
        )
    )
    print_lines("", "to paste into the spec:", calibration.fragment.rstrip())
