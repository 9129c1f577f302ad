"""Drives, start and stop, brakes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.drives import GEAR_SERVICE, next_preferred_number
from conveyor.loop.drive_duty import DriveDuty, coasting_flywheel
from conveyor.report.row_getters import extreme_getter
from conveyor.report.table_model import Column, Figure, PagePlacement, Table, figure_table
from conveyor.studies.load_cases import Load


def drive_table(a: CalculatedConveyor) -> Table:
    """Force, power, tensions and grip of every drive in every state."""
    motor, states = a.balance.layout.motor, a.balance.equilibrium.states
    columns = (
        Column("drive", "text", "0.name"),
        Column("state", "text", "1"),
        Column("force", "force", "2.force"),
        Column("motor power at full speed", "power", lambda row: motor(row[2].force, row[0].share)),
        Column("installed power", "power", "0.power"),
        Column("arriving", "force", "2.arriving"),
        Column("leaving", "force", "2.leaving"),
        Column("tension ratio", "ratio",
               lambda row: math.inf if row[2].slack <= 0.0 else row[2].tight / row[2].slack),
        Column("grip limit", "ratio", lambda row: math.exp(row[0].friction * row[0].wrap_angle)),
    )  # fmt: skip
    rows = tuple(
        (drive, state.name, side)
        for state in states.values()
        for drive, side in zip(a.line.drives, state.drives, strict=True)
    )
    heading = "Drives in every state of motion"
    return Table(
        "drives",
        "Loop",
        heading,
        columns,
        rows,
        (PagePlacement("tensions", "Drives in every state"),),
        named=2,
    )


def unsteady_words(a: CalculatedConveyor) -> str:
    """Words for the state at the start factor: the start, or the motors' braking of a belt that drives them."""
    return "at start" if a.balance.equilibrium.force >= 0.0 else "in braking by the motors"


def start_stop_table(a: CalculatedConveyor) -> Table:
    """Start, stop, brakes and limits of material slip."""
    moving = a.motions
    start, slip = moving.start, moving.slip
    holder = "backstop" if moving.rolls_back else "brake"
    at = unsteady_words(a)
    rows = [
        Figure("moving mass", "mass", moving.moving_mass),
        Figure("rotating mass of the drives", "mass", moving.rotating_mass),
        Figure(f"drive force {at}", "force", start.force, key="drive_force_at_start"),
        Figure(f"drive force {at} over steady", "ratio", start.factor, key="drive_force_at_start_over_steady"),
        Figure(f"acceleration {at}", "acceleration", start.acceleration, key="acceleration_at_start"),
        Figure("time over the whole speed range", "time", start.time),
        Figure("motor torque at start over rated", "ratio", start.torque_factor),
        Figure("required motor force", "force", start.asked, key="force_asked_of_the_motors"),
        Figure("available motor force", "force", start.available, key="force_the_motors_give"),
        Figure("drive force at rest", "force", start.standstill),
        Figure("resistance after standstill, at most", "force", start.breakaway),
    ]  # fmt: skip
    for label, stop in (
        ("drives off", moving.coasting),
        ("drives off, design friction", None if a.line.design_friction == 1.0 else moving.coasting_design),
        ("drives off, least friction", moving.coasting_least),
        ("brakes on, least friction", moving.braked),
    ):
        if stop is not None:
            rows += [
                Figure(f"deceleration, {label}", "acceleration", stop.deceleration),
                Figure(f"stopping time, {label}", "time", stop.time),
                Figure(f"stopping distance, {label}", "length", stop.distance),
            ]  # fmt: skip
    radius = a.line.drives[0].radius
    torque = None if radius is None else moving.brake_to_hold * radius
    gripping = moving.gripping_speed if a.line.brake_delay > 0.0 else None
    braking, starting = (None, None) if slip is None else (-slip.braking, slip.starting)
    rows += [
        Figure("brake force for the specified deceleration", "force", moving.brake_to_stop,
               key="brake_for_the_deceleration_wanted"),
        Figure(f"{holder} to hold", "force", moving.brake_to_hold),
        Figure("torque to hold, at the first drive's pulley", "torque", torque, key="torque_to_hold"),
        Figure("flywheel for the coasting time, at the motors", "inertia", coasting_flywheel(a.line, moving)),
        Figure("runaway, drives and brakes off", "acceleration", moving.runaway),
        Figure("speed at which the brakes grip", "speed", gripping),
        Figure("maximum deceleration without material slip", "acceleration", braking,
               key="hardest_braking_before_the_bulk_slides"),
        Figure("maximum acceleration without material slip", "acceleration", starting,
               key="highest_acceleration_before_the_bulk_slides"),
    ]  # fmt: skip
    page = (PagePlacement("start-stop", "Start, stop and limits of material slip"),)
    return figure_table("start_stop", "Loop", "Start and stop", rows, page=page, prefix="motion_")


def brake_table(a: CalculatedConveyor) -> Table:
    """Torque and heat of every brake in a stop with the least friction."""
    whole, heat = math.fsum(a.line.brakes), a.motions.braking_heat
    columns = (
        Column("drive", "text", "name"),
        Column("brake force", "force", "brake"),
        Column("brake torque at the pulley", "torque", lambda d: None if d.radius is None else d.brake * d.radius),
        Column("heat of a stop", "heat", lambda d: None if heat is None else heat * d.brake / whole),
    )
    rows = tuple(drive for drive in a.line.drives if drive.brake is not None)
    return Table("brakes", "Loop", "Brakes", columns, rows, "start-stop")


def _uncontrolled_power(a: CalculatedConveyor, duty: DriveDuty) -> float | None:
    """Power of a drive where nothing but the belt couples the drives [W]; None where none differs."""
    return None if duty.shared is None else a.balance.layout.motor(duty.shared, duty.drive.share)


def drive_parts(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Parts of the drives: gear, backstop, starts, brake, load sharing; worst of all cases."""
    every = [load.found.drive_duty for load in loads]
    rows = [(own, [duties[i] for duties in every]) for i, own in enumerate(a.drive_duty)]

    worst = partial(extreme_getter, path="1")
    service = next((duty.parts.service for duty in a.drive_duty), GEAR_SERVICE.value)
    columns = (
        Column("drive", "text", "0.drive.name"),
        Column("motors", "count", lambda row: float(row[0].parts.motors), page=None),
        Column("pulley speed", "rotation", "0.rotation"),
        Column("gear ratio", "ratio", "0.ratio", sparse=True),
        Column("preferred ratio", "ratio", "0.standard_ratio", sparse=True),
        Column("gear size", "torque", "0.gear", sparse=True),
        Column("backstop, holding", "torque", worst(max, get="holding"), sparse=True),
        Column("backstop, motors stalled", "torque",
               worst(max, get=lambda duty: None if duty.holding is None else duty.stalled), sparse=True),
        Column("backstop size", "torque",
               lambda row: next_preferred_number(most) if (most := worst(max, get="backstop")(row)) else None,
               sparse=True),
        Column("load at a motor's shaft", "inertia", worst(max, get="load_inertia"), sparse=True),
        Column("starts an hour", "ratio", worst(min, get="allowed_starts"), sparse=True),
        Column("heat of a stop", "heat", worst(max, get="heat"), sparse=True),
        Column("rise of the disc", "rise", worst(max, get="disc_rise"), sparse=True),
        Column("motor power, uncontrolled", "power",
               worst(partial(max, key=abs), get=partial(_uncontrolled_power, a)),
               sparse=True),
    )  # fmt: skip
    note = (
        f"Sizes are preferred numbers (ISO 3): gear {service:g} times the motor's torque, one of several backstops "
        "1.4 times an even share (general knowledge). Starts of motors switched on directly, NEMA MG 10. Uncontrolled: "
        "nothing but the belt couples the drives."
    )
    heading = "Parts of the drives, all cases"
    return Table("drive_parts", "Loop", heading, columns, tuple(rows), "start-stop", note)
