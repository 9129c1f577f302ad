"""`conveyor calibrate`: factors on forces from measured power."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from conveyor.cli.app import Spec, option, say, si_of
from conveyor.cli.outputs import SPEC
from conveyor.cli.session import Session, command

if TYPE_CHECKING:
    from conveyor.comparisons import CalibrationStudy
    from conveyor.units import System

_OF_RUNS = ("run", "flow", "speed", "temperature", "measured", "before", "after", "difference", "note")
"""Columns shown on a terminal."""


@command(
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
        option(
            'Standard deviation of a measured power, such as "2 %"; else from the differences.', "PERCENT"
        ),
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
        Path | None,
        option("Write the part of the spec (.yaml) or every table (.xlsx).", "FILE", "-o", "--output"),
    ] = None,
) -> None:
    """Fit factors on indentation, idler rotation and flexure to measured power, as far as the runs tell them apart."""
    to = session.outputs(spec, measured)
    to.file("--output", output, *SPEC, ".xlsx")
    import conveyor

    line = session.read(spec)
    system = session.system(line)
    share = si_of("--error", error, "fraction")
    with session.progress("runs") as told:
        calibration = conveyor.calibrate(line, measured, error=share, factors=factors, progress=told)
    if output is not None and output.suffix.lower() == ".xlsx":
        to.report(calibration.contents(system), output)
    elif output is not None:
        to.add("part of a spec", output, {output: calibration.fragment.encode()})
    session.answer(calibration.to_dict, to, lambda: _show(calibration, system))


def _show(calibration: CalibrationStudy, system: System) -> None:
    """Print factors, correlation, runs, and the part of the spec."""
    from conveyor.cli.terminal import console, grid, wrapped
    from conveyor.report import calibration_tables

    screen = console()
    runs = calibration_tables.runs(calibration).only(*_OF_RUNS)
    for part in (calibration_tables.factors(calibration), calibration_tables.correlation(calibration), runs):
        if part.rows:
            screen.print(grid(part, system), "")
            if part.note:
                say(part.note, "")
    say("basis and limitations:")
    say(
        *(
            wrapped(line, screen.width, first="  - ", further="    ")
            for line in calibration_tables.lines(calibration)
        )
    )
    say("", "to paste into the spec:", calibration.fragment.rstrip())
