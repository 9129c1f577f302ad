"""Every table of a calibration, declared once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

from conveyor.report.columns import Column, Contents, Table
from conveyor.report.tables import document, provenance
from conveyor.spec import fingerprint
from conveyor.units import System
from conveyor.units.presentation import unit

if TYPE_CHECKING:
    from conveyor.studies.calibration import CalculatedCalibration

SHEET: Final = "Calibration"


def of_calibration(found: CalculatedCalibration, system: System) -> Contents:
    """Every table of a calibration in a unit system."""
    facts = (("runs", str(len(found.runs))), ("error", error_words(found)))
    parts = (
        factors(found), runs(found), correlation(found), notes(found),
        provenance(fingerprint(found.conveyor), SHEET),
    )  # fmt: skip
    about = document(found.conveyor, "Calibration to measured power", system, facts)
    return Contents(about, tuple(part for part in parts if not part.empty), system)


def factors(found: CalculatedCalibration) -> Table:
    """One row a factor: its band, or why there is none."""
    columns = (
        Column("factor on", "text", attrgetter("name")),
        Column("value", "factor", attrgetter("value")),
        Column("5 %", "factor", attrgetter("low"), key="low"),
        Column("95 %", "factor", attrgetter("high"), key="high"),
    )
    held = ", ".join(name.replace("_", " ") for name in found.held)
    note = f"held at 1: {held}" if held else ""
    return Table("factors", SHEET, "Factors with their 90 % interval", columns, found.factors, note=note)


def runs(found: CalculatedCalibration) -> Table:
    """One row a run: what was measured, what is calculated without factors and with them."""
    columns = (
        Column("run", "count", lambda row: row[0]),
        Column("at", "text", attrgetter("run.at")),
        Column("flow", "mass flow", attrgetter("run.mass_flow")),
        Column("belt speed", "speed", attrgetter("run.belt_speed"), sparse=True, key="speed"),
        Column("temperature", "temperature", attrgetter("run.belt_temperature"), sparse=True),
        Column("measured", "power", attrgetter("measured")),
        Column("calculated", "power", attrgetter("before"), key="before"),
        Column("calibrated", "power", attrgetter("after"), key="after"),
        Column("difference before", "share", attrgetter("difference_before")),
        Column("difference", "share", attrgetter("difference")),
        Column("error", "power", attrgetter("error")),
        Column("note", "text", lambda row: row.run.note or None, sparse=True),
    )
    rows = tuple(enumerate(found.runs, start=1))
    numbered = (columns[0], *(_of_run(column) for column in columns[1:]))
    return Table("runs", SHEET, "Runs: measured, calculated without factors and with them", numbered, rows)


def _of_run(column: Column) -> Column:
    get = column.get
    return replace(column, get=lambda row: get(row[1]))


def correlation(found: CalculatedCalibration) -> Table:
    """One row a factor; nothing of one factor alone."""
    names = [factor.name for factor in found.factors]
    rows = list(zip(names, found.correlation.tolist(), strict=True)) if len(names) > 1 else []
    columns = (
        Column("factor on", "text", lambda row: row[0]),
        *(Column(name, "ratio", _entry(k)) for k, name in enumerate(names)),
    )
    return Table("correlation", SHEET, "Correlation of the factors", columns, rows)


def _entry(k: int) -> Callable[[Any], float]:
    return lambda row: float(row[1][k])


def notes(found: CalculatedCalibration) -> Table:
    """What is not told apart, and what the figures rest on."""
    columns = (Column("note", "text", lambda row: row),)
    return Table("notes", SHEET, "Basis and limitations", columns, lines(found))


def lines(found: CalculatedCalibration) -> tuple[str, ...]:
    """What is not told apart, and what the figures rest on, in sentences."""
    return (
        *found.notes,
        f"chi square {found.chi_square:.3g} at {found.freedom} degrees of freedom; errors: {error_words(found)}",
        "lift, tilt, secondary resistances and the efficiencies of the drive are taken as the spec says: "
        "what they lack is in the factors",
    )


def error_words(found: CalculatedCalibration) -> str:
    """How well a power is known, and where that is from."""
    if found.error is None:
        return "as the runs state"
    source = "from the differences" if found.estimated else "as given"
    return f"{unit('share').written(found.error)} of each power, {source}"


def plain(found: CalculatedCalibration) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys."""
    return {
        "calibration": found.calibration.factors | {"source": found.calibration.source},
        "factors": [
            {"on": list(f.forces), "value": f.value, "low": f.low, "high": f.high} for f in found.factors
        ],
        "held_at_1": list(found.held),
        "correlation": found.correlation.tolist(),
        "chi_square": found.chi_square,
        "degrees_of_freedom": found.freedom,
        "error": found.error,
        "error_estimated": found.estimated,
        "runs": [
            {
                "at": one.run.at,
                "flow_t_per_h": unit("mass flow").shown(one.run.mass_flow),
                "measured_kW": one.measured / 1e3,
                "calculated_kW": one.before / 1e3,
                "calibrated_kW": one.after / 1e3,
                "error_kW": one.error / 1e3,
                "note": one.run.note,
            }
            for one in found.runs
        ],
        "notes": list(found.notes),
        "spec": found.fragment,
    }
