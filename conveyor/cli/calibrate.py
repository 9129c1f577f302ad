"""`conveyor calibrate`: factors on forces from measured power."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from conveyor.cli.app import (
    AsJson,
    Changed,
    Force,
    Quiet,
    Shelves,
    Spec,
    UnitsOption,
    app,
    examples,
    json_text,
    print_text,
    progress,
    read_spec,
    say,
)
from conveyor.cli.outputs import Outputs
from conveyor.errors import InputError
from conveyor.files import marks

if TYPE_CHECKING:
    from conveyor.report.columns import Table
    from conveyor.units import System

_OF_RUNS = ("run", "flow", "speed", "temperature", "measured", "before", "after", "difference", "note")
"""Columns that a terminal has room for."""


@app.command(
    short_help="Calibrate a conveyor to measured power.",
    epilog=examples(
        "conveyor calibrate mine.yaml --measured runs.csv",
        'conveyor calibrate mine.yaml --measured runs.xlsx --error "2 %" -o calibration.yaml',
        "conveyor calibrate mine.yaml --measured runs.csv --factor indentation --factor idler_rotation",
    ),
)
def calibrate(
    spec: Spec,
    measured: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="Runs (.csv or .xlsx): columns motor power or mains power, flow; speed, temperature, air temperature, "
            "standard deviation, note. Units in the headers: flow [t/h].",
            show_default=False,
        ),
    ],
    error: Annotated[
        str | None,
        typer.Option(
            metavar="PERCENT",
            help='Standard deviation of a measured power, such as "2 %"; else from the differences.',
        ),
    ] = None,
    factors: Annotated[
        list[str] | None,
        typer.Option(
            "--factor",
            metavar="NAME",
            help="indentation, idler_rotation or flexure, for itself; may be repeated. Else what the runs tell apart.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="Write the part of the spec (.yaml) or every table (.xlsx).",
        ),
    ] = None,
    units: UnitsOption = None,
    force: Force = False,
    as_json: AsJson = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
    changed: Changed = None,
) -> None:
    """Fit factors on indentation, idler rotation and flexure to measured power, as far as the runs tell them apart."""
    to = Outputs(spec, measured, force=force)
    is_book = output is not None and output.suffix.lower() == ".xlsx"
    to.file("--output", output, ".yaml", ".yml", ".xlsx", kind=marks.REPORT if is_book else marks.TO_FILL_IN)
    import conveyor
    from conveyor.report import calibrating, excel

    line = read_spec(spec, shelf, changed)
    system: System = line.report.units if units is None else units.value
    with progress(silent=quiet or as_json) as told:
        found = conveyor.calibrate(
            line,
            measured,
            error=None if error is None else _share(error),
            factors=factors,
            progress=None if told is None else partial(told, "runs"),
        )
    figures = json_text(found.to_dict())
    if output is not None and is_book:
        to.add("workbook", output, excel.files(found.contents(system), output, {}))
    elif output is not None:
        to.add("part of a spec", output, {output: found.fragment.encode()})
    written = to.save()
    if as_json:
        print_text(figures)
    elif not quiet:
        from conveyor.cli.terminal import console, wrapped

        screen = console()
        runs = calibrating.runs(found).only(*_OF_RUNS)
        for part in (calibrating.factors(found), calibrating.correlation(found), runs):
            if not part.empty:
                screen.print(shown(part, system), "")
                if part.note:
                    say(part.note, "")
        say("basis and limitations:")
        say(*(wrapped(line, screen.width, first="  - ", further="    ") for line in calibrating.lines(found)))
        say("", "to paste into the spec:", found.fragment.rstrip())
        if written:
            say("", *written)


def _share(given: str) -> float:
    from conveyor.units import in_si

    try:
        return in_si(given, "fraction")
    except InputError as error:
        raise InputError(f"--error: {error}") from None


def shown(part: Table, system: System) -> Any:
    """A table of the report on the terminal, units below names."""
    from conveyor.cli.terminal import table, words
    from conveyor.units.presentation import unit

    made = table(part.heading)
    for column in part.columns:
        sign = unit(column.kind, system).sign
        heading = f"{column.label}\n[{sign}]" if sign else column.label
        made.add_column(words(heading), justify="left" if column.kind == "text" else "right")
    for row in part.rows:
        made.add_row(
            *(words(part.unit(column, row, system).written(column.get(row))) for column in part.columns)
        )
    return made
