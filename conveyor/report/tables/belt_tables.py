"""Strength of the belt and loads of the pulleys."""

from __future__ import annotations

from collections.abc import Sequence

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.loop.ties import first_maximum
from conveyor.report.row_getters import extreme_getter
from conveyor.report.table_model import Column, Figure, Table, figure_table
from conveyor.studies.load_cases import Load


def belt_strength_table(a: CalculatedConveyor) -> Table:
    """Strength of the belt; figures that are not known are left out."""
    duty, strength = a.belt_duty, a.line.belt.strength
    needed = duty.strength_needed.values()
    used = max(needed) / strength if needed and strength is not None else None
    rows = (
        Figure("maximum tension, steady", "force", duty.largest_steady, us="Tmax", key="largest_tension_steady"),
        Figure("maximum tension, all states", "force", duty.largest, us="Tmax", key="largest_tension_all_states"),
        Figure("safety, steady", "ratio", duty.safety_steady),
        Figure("safety, all states", "ratio", duty.safety),
        Figure("required safety", "ratio", duty.safety_needed, key="classic_safety_asked_for"),
        Figure("tension per width, steady", "strength", duty.per_width_steady),
        Figure("tension per width, all states", "strength", duty.per_width),
        Figure("rated tension per width", "strength", duty.rating),
        Figure("belt strength required by the splice", "strength", max(needed, default=None),
               key="strength_the_splice_asks_for"),
        Figure("utilisation of the splice", "share", used),
        *(
            Figure(f"required {cover.cover} cover", "thickness", cover.least + cover.wear)
            for cover in a.line.belt.covers
        ),
        Figure("minimum diameter of drive pulleys", "size", duty.drive_diameter,
               key="least_diameter_of_drive_pulleys"),
    )  # fmt: skip
    return figure_table("belt_strength", "Loop", "Strength of the belt", rows, page="belt", prefix="belt_")


def pulley_table(a: CalculatedConveyor) -> Table:
    """Diameter of every pulley, and the minimum."""
    columns = (
        Column("pulley", "text", "name"),
        Column("position", "text", "position"),
        Column("group", "text", "group"),
        Column("utilisation", "share", "utilisation", sparse=True),
        Column("diameter", "size", "diameter"),
        Column("minimum", "size", "least", key="least"),
        Column("standard size", "size", "next_size", key="of_the_series"),
        Column("large enough", "verdict", "large_enough"),
    )
    return Table("pulleys", "Pulleys", "Pulleys", columns, tuple(a.belt_duty.pulleys), "belt")


def pulley_loads(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Largest loads of every pulley over all cases and states; shaft, bearings, lagging."""
    system = a.conveyor.report.units
    every = [(load.label, duty) for load in loads for duty in load.found.pulley_duty]
    rows = []
    for own in a.pulley_duty:
        of = [(label, duty) for label, duty in every if duty.pulley.name == own.pulley.name]
        rows.append((own, *first_maximum(of, lambda pair: pair[1].largest.resultant), [duty for _, duty in of]))

    columns = (
        Column("pulley", "text", "0.pulley.name"),
        Column("driven", "verdict", lambda row: "yes" if row[0].pulley.driven else "no", page=None),
        Column("diameter", "size", "0.pulley.diameter"),
        Column("wrap angle", "angle", "0.pulley.wrap_angle", page=None, key="wrap"),
        Column("rotation", "rotation", extreme_getter(max, "3", "rotation"), page=None),
        Column("resultant, steady", "force", "0.steady.resultant", page=None),
        Column("largest resultant", "force", "2.largest.resultant"),
        Column("in the state", "text", "2.largest.state"),
        Column("of the case", "text", lambda row: row[1].text(system), page=None),
        Column("largest torque", "torque", extreme_getter(max, "3", "torque")),
        Column("bending moment at the hub", "torque", extreme_getter(max, "3", "moment"), sparse=True, page=None),
        Column("shaft in the hub", "size", "0.pulley.hub_diameter"),
        Column("minimum shaft in the hub", "size", extreme_getter(max, "3", "least_shaft"), sparse=True),
        Column("slope at the hub", "friction", extreme_getter(max, "3", "slope"), sparse=True),
        Column("safety of the shaft", "ratio",
               extreme_getter(min, "3", "safety.0"), sparse=True),
        Column("L10 of a bearing, steady", "duration", extreme_getter(min, "3", "bearing_seconds"), sparse=True),
        Column("pressure on the lagging", "pressure", extreme_getter(max, "3", "pressure")),
    )  # fmt: skip
    note = (
        "Resultant of belt and weight; without pull_angle the weight adds to the pull in full. Shaft after CEMA B105.1 "
        "(slope at most 0.0023, safety at least 1.5). Driven pulleys at one place are passed in the order listed."
    )
    heading = "Loads of the pulleys, all cases and states"
    return Table("pulley_loads", "Pulleys", heading, columns, tuple(rows), "belt", note)


def pulley_states(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Tensions, resultant and torque of every pulley in every case and state."""
    system = a.conveyor.report.units
    rows = tuple(
        (duty.pulley.name, load.label.text(system), pull)
        for load in loads
        for duty in load.found.pulley_duty
        for pull in duty.loads
    )
    columns = (
        Column("pulley", "text", "0"),
        Column("case", "text", "1"),
        Column("state", "text", "2.state"),
        Column("arriving", "force", "2.arriving"),
        Column("leaving", "force", "2.leaving"),
        Column("resultant", "force", "2.resultant"),
        Column("torque", "torque", "2.torque"),
    )
    heading = "Loads of the pulleys in every case and state"
    return Table("pulley_states", "States", heading, columns, rows, printed=False)
