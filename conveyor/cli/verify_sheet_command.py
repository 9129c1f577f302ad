"""`conveyor verify-sheet`: calculated rolling resistance for a belt maker to verify by tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from conveyor.cli.application import Reports, argument, option, parse_values, print_lines
from conveyor.cli.shared_options import Session, session_command
from conveyor.errors import InputError

if TYPE_CHECKING:
    from conveyor.results.comparisons import VerificationSheet

_AXIS_OPTIONS = {
    "--load": ("line_loads", "N/mm", "N/m", "lbf/in"),
    "--temperature": ("temperatures", "degC", "degF"),
    "--roll": ("roll_diameters", "mm", "in"),
    "--speed": ("speeds", "m/s", "fpm"),
    "--cover": ("covers", "mm", "in"),
}
"""Options, their Python names and units; the first unit is taken where none is given."""


@session_command(
    "verify-sheet",
    short_help="Write a sheet for a belt maker to fill in.",
    examples_of=(
        "conveyor verify-sheet standard-cover low-rolling-resistance-cover -o sheet.xlsx",
        'conveyor verify-sheet mine.yaml --load "1:8:1 N/mm" --roll "194 mm" -o sheet.html',
        "conveyor verify-sheet s100 --spec overland.yaml --temperature -10:30:10 -o sheet.xlsx",
    ),
)
def verify_sheet(
    session: Session,
    compounds: Annotated[list[str], argument("Shelf names or compound files.", "COMPOUND...", show_default=False)],
    spec: Annotated[
        Path | None, option("Conveyor whose most loaded carry set is shown as well.", "SPEC", "--spec")
    ] = None,
    load: Annotated[str | None, option("Line loads: from:to:step or a,b,c; else 1 to 8 N/mm.", "VALUES")] = None,
    temperature: Annotated[
        str | None, option("Of the cover; else -20 to 40 degC as far as compounds are known.", "VALUES")
    ] = None,
    roll: Annotated[str | None, option("Diameters of rolls; else 159, 194, 219 mm.", "VALUES")] = None,
    speed: Annotated[str | None, option("Of the belt; else 2.5, 5, 7.5 m/s.", "VALUES")] = None,
    cover: Annotated[str | None, option("Thickness of the cover; else 6, 7, 8 mm.", "VALUES")] = None,
    softened: Annotated[
        bool,
        option("Moduli at the strain of every roll, where known: half a second a figure.", None, "--softened"),
    ] = False,
    output: Reports = None,
) -> None:
    """Write the calculated rolling resistance of compounds beside empty columns for a maker's tests."""
    to = session.outputs(spec, *compounds)
    to.reports(output)
    if not output and not session.as_json:
        raise InputError("verify-sheet: give -o SHEET.xlsx, -o SHEET.html, -o SHEET.pdf or --json")
    import conveyor

    if spec is None and session.changed:
        raise InputError("--set: changes a spec; give --spec, too")
    line = None if spec is None else session.read(spec)
    given = dict(zip(_AXIS_OPTIONS, (load, temperature, roll, speed, cover), strict=True))
    axes: dict[str, Any] = {
        _AXIS_OPTIONS[option][0]: parse_values(text, option, *_AXIS_OPTIONS[option][1:])
        for option, text in given.items()
        if text is not None
    }
    with session.progress("compounds") as told:
        sheet = conveyor.verify_sheet(
            compounds, conveyor=line, softened=softened, shelves=session.shelf or (), progress=told, **axes
        )
    to.write(sheet.contents(session.system(line)))
    session.answer(sheet.to_dict, to, lambda: _show_counts(sheet))


def _show_counts(sheet: VerificationSheet) -> None:
    without = sum(row.reason != "" for row in sheet.rows) + sum(row.reason != "" for row in sheet.sets)
    print_lines(f"{len(sheet.rows)} rows, {len(sheet.sets)} of an idler set; {without} without a figure")
