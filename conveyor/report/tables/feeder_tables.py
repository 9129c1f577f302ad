"""Table of hoppers over the belt; empty where the route has none."""

from __future__ import annotations

from typing import TypeAlias

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.classical_forces import hopper_pull
from conveyor.laws.belt_strength import belt_safety
from conveyor.laws.feeder import FEEDER_SPEED
from conveyor.line.hopper_outlets import HopperOutlet
from conveyor.line.transfer_parts import LoadingPoint
from conveyor.loop.hopper_states import HopperState
from conveyor.loop.pulley_duty import PulleyDuty, pulley_tensions
from conveyor.report.table_model import Column, Table
from conveyor.report.tables.transfer_tables import SHEET

_StateRow: TypeAlias = tuple[str, str, HopperOutlet, float, float, float, float, float, float]
"""Hopper, state, outlet, load factor, load, its three forces, power."""


def hopper_table(a: CalculatedConveyor) -> Table:
    """Loads, pull-out forces and power of every hopper after filling and in flow, a row a state."""
    line = a.line
    rows: list[_StateRow] = []
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
        Column("skirts under it", "force", lambda row: None if row[2].skirts is None else row[7]),
        Column("power at belt speed", "power", "8"),
        Column("flow of the full gate", "mass flow", "2.rated_flow"),
    )
    note = (
        "After filling: the bulk as high as the hopper over its outlet, Arnold, McLean and Roberts, and the pressure "
        "of a bin above it, Janssen; the belt breaks it away once. In flow: the field of stress in mass flow; both for "
        "slots. "
        "For a uniform draw-down the capacity must grow along the outlet in running direction (Roberts): a slot that "
        "widens, a gate that rises; a parallel one empties from its rear end. "
        f"Feeders run at {FEEDER_SPEED.value:g} m/s or less (general knowledge)."
    )
    return Table("hoppers", SHEET, "Hoppers over the belt", columns, tuple(rows), "transfer", note)


def hopper_state_table(a: CalculatedConveyor) -> Table:
    """Drive force, torque, tensions, safety and start of a belt feeder in each state of its hoppers."""
    belt = a.line.belt

    def torque(state: HopperState) -> float | None:
        duties = (
            PulleyDuty(pulley, a.line, ((state.name, *pulley_tensions(a.balance, i, state.motion)),))
            for i, pulley in enumerate(a.line.pulleys)
            if pulley.driven
        )
        return max((duty.torque for duty in duties), default=None)

    def safety(state: HopperState) -> float | None:
        largest = state.motion.largest
        if belt.strength is None or largest <= 0.0:
            return None
        return belt_safety(largest, nominal_strength=belt.strength, belt_width=belt.width)

    columns = (
        Column("state", "text", "name"),
        Column("drive force", "force", "motion.force"),
        Column("torque at the drive shaft", "torque", torque),
        Column("motor power", "power", lambda state: a.balance.layout.motor(state.motion.force)),
        Column("largest tension", "force", "motion.largest"),
        Column("slack side", "force", lambda state: min(side.slack for side in state.motion.drives)),
        Column("safety of the belt", "safety", safety),
        Column("time to full speed, at most", "time", "start_time"),
    )
    note = (
        "All hoppers at once, the take-up at its setting, with the friction to design for. After standing the belt "
        "breaks the initial load away; in the run-out the hoppers are empty and the belt is full. Time to full speed "
        "by the drive force at rest, as if the load stayed; none where the start stalls."
    )
    heading = "Belt feeder by state of the hoppers"
    return Table("hopper_states", SHEET, heading, columns, a.hopper_states, "transfer", note)


def _state_rows(a: CalculatedConveyor, point: LoadingPoint, hopper: HopperOutlet) -> list[_StateRow]:
    name = point.name.removeprefix(", ") or point.place
    states = (
        ("initial, after filling", hopper.initial_factor, hopper.initial_load),
        ("in flow", hopper.flow_factor, hopper.flow_load),
    )
    return [
        (name, state, hopper, factor, load, *forces, sum(forces) * a.line.speed)
        for state, factor, load in states
        for forces in [hopper_pull(a.line, point.section, hopper, load)]
    ]
