"""Table of hoppers over the belt; empty where the route has none."""

from __future__ import annotations

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.classical_forces import hopper_pull
from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.line.hopper_outlets import HopperOutlet
from conveyor.line.transfer_parts import LoadingPoint
from conveyor.report.table_model import Column, Table
from conveyor.report.tables.transfer_tables import SHEET


def hopper_table(a: CalculatedConveyor) -> Table:
    """Loads, pull-out forces and power of every hopper after filling and in flow, a row a state."""
    line = a.line
    rows: list[tuple[str, str, HopperOutlet, float, float, float, float, float]] = []
    for point in line.loading:
        if point.hopper is not None:
            rows += _state_rows(a, point, point.hopper)
    columns = (
        Column("hopper", "text", "0"),
        Column("state", "text", "1"),
        Column("load factor", "ratio", "3"),
        Column("vertical load", "force", "4"),
        Column("pull-out force", "force", "5"),
        Column("sets or plate under it", "force", "6"),
        Column("power at belt speed", "power", "7"),
        Column("flow of the full gate", "mass flow", "2.rated_flow"),
    )
    note = (
        "After filling: the bulk as high as the hopper over its outlet, Arnold, McLean and Roberts; the belt breaks it "
        "away once. In flow: the field of stress in mass flow; both for slots. A bin above the hopper is left out. "
        f"Feeders run at {FEEDER_SPEED.value:g} m/s or less (general knowledge)."
    )
    return Table("hoppers", SHEET, "Hoppers over the belt", columns, tuple(rows), "transfer", note)


def _state_rows(
    a: CalculatedConveyor, point: LoadingPoint, hopper: HopperOutlet
) -> list[tuple[str, str, HopperOutlet, float, float, float, float, float]]:
    name = point.name.removeprefix(", ") or point.place
    states = (
        ("initial, after filling", hopper.initial_factor, hopper.initial_load),
        ("flow", hopper.flow_factor, hopper.flow_load),
    )
    return [
        (name, state, hopper, factor, load, *forces, sum(forces) * a.line.speed)
        for state, factor, load in states
        for forces in [hopper_pull(a.line, point.section, hopper, load)]
    ]
