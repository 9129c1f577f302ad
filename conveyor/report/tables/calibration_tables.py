"""Every table of a calibration, declared once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from conveyor.report.table_model import Column, Contents, Table
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.spec import fingerprint
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from conveyor.studies.calibration import CalculatedCalibration

SHEET: Final = "Calibration"


def calibration_contents(calibration: CalculatedCalibration, system: System) -> Contents:
    """Contents of the calibration report in a unit system."""
    facts = (("runs", str(len(calibration.runs))), ("error", error_text(calibration)))
    parts = (
        factor_table(calibration), run_table(calibration), correlation_table(calibration), note_table(calibration),
        provenance_table(fingerprint(calibration.conveyor), SHEET),
    )  # fmt: skip
    about = report_head(calibration.conveyor, "Calibration to measured power", system, facts)
    return Contents.of(about, parts, system)


def factor_table(calibration: CalculatedCalibration) -> Table:
    """Calibration factors with their 90 % intervals, one row each."""
    columns = (
        Column("factor on", "text", "name"),
        Column("value", "factor", "value"),
        Column("5 %", "factor", "low", key="low"),
        Column("95 %", "factor", "high", key="high"),
    )
    held = ", ".join(name.replace("_", " ") for name in calibration.held)
    note = f"held at 1: {held}" if held else ""
    return Table("factors", SHEET, "Factors with their 90 % interval", columns, calibration.factors, note=note)


def run_table(calibration: CalculatedCalibration) -> Table:
    """Power of every run: measured, calculated without factors and with them."""
    columns = (
        Column("run", "count", "0"),
        Column("at", "text", "run.at"),
        Column("flow", "mass flow", "run.mass_flow"),
        Column("belt speed", "speed", "run.belt_speed", sparse=True, key="speed"),
        Column("temperature", "temperature", "run.belt_temperature", sparse=True),
        Column("measured", "power", "measured"),
        Column("calculated", "power", "before", key="before"),
        Column("calibrated", "power", "after", key="after"),
        Column("difference before", "share", "difference_before"),
        Column("difference", "share", "difference"),
        Column("error", "power", "error"),
        Column("note", "text", lambda row: row.run.note or None, sparse=True),
    )
    rows = tuple(enumerate(calibration.runs, start=1))
    numbered = (columns[0], *(column.of("1") for column in columns[1:]))
    return Table("runs", SHEET, "Runs: measured, calculated without factors and with them", numbered, rows)


def correlation_table(calibration: CalculatedCalibration) -> Table:
    """Correlation matrix of the factors; no rows for a single factor."""
    names = [factor.name for factor in calibration.factors]
    rows = list(zip(names, calibration.correlation.tolist(), strict=True)) if len(names) > 1 else []
    columns = (
        Column("factor on", "text", "0"),
        *(Column(name, "ratio", f"1.{k}") for k, name in enumerate(names)),
    )
    return Table("correlation", SHEET, "Correlation of the factors", columns, rows)


def note_table(calibration: CalculatedCalibration) -> Table:
    """Basis and limitations of the calibration."""
    columns = (Column("note", "text", lambda row: row),)
    return Table("notes", SHEET, "Basis and limitations", columns, note_lines(calibration))


def note_lines(calibration: CalculatedCalibration) -> tuple[str, ...]:
    """Sentences on the basis and limitations of the calibration."""
    return (
        *calibration.notes,
        f"chi square {calibration.chi_square:.3g} at {calibration.freedom} degrees of freedom; "
        f"errors: {error_text(calibration)}",
        "lift, tilt, secondary resistances and the efficiencies of the drive are taken as the spec says: "
        "what they lack is in the factors",
    )


def error_text(calibration: CalculatedCalibration) -> str:
    """Relative error of a power, and its origin."""
    if calibration.error is None:
        return "as the runs state"
    source = "from the differences" if calibration.estimated else "as given"
    return f"{display_unit('share').written(calibration.error)} of each power, {source}"


def calibration_json(calibration: CalculatedCalibration) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys."""
    return {
        "calibration": calibration.calibration.factors | {"source": calibration.calibration.source},
        "factors": [
            {"on": list(f.forces), "value": f.value, "low": f.low, "high": f.high} for f in calibration.factors
        ],
        "held_at_1": list(calibration.held),
        "correlation": calibration.correlation.tolist(),
        "chi_square": calibration.chi_square,
        "degrees_of_freedom": calibration.freedom,
        "error": calibration.error,
        "error_estimated": calibration.estimated,
        "runs": [
            {
                "at": one.run.at,
                "flow_t_per_h": display_unit("mass flow").shown(one.run.mass_flow),
                "measured_kW": one.measured / 1e3,
                "calculated_kW": one.before / 1e3,
                "calibrated_kW": one.after / 1e3,
                "error_kW": one.error / 1e3,
                "note": one.run.note,
            }
            for one in calibration.runs
        ],
        "notes": list(calibration.notes),
        "spec": calibration.fragment,
    }
