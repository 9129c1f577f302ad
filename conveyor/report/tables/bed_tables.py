"""Table of the plates that carry the belt; empty where the route has none."""

from __future__ import annotations

from conveyor.calculated_conveyor import CalculatedConveyor, StretchResult
from conveyor.report.table_model import Column, Table


def slider_bed_table(a: CalculatedConveyor) -> Table:
    """Plates in running direction: friction, load, pressure, force and the heat that it makes."""
    width, speed = a.line.belt.width, a.line.speed

    def heat(r: StretchResult) -> float:
        return r.forces["slider_bed"] * speed

    def pressure(r: StretchResult) -> float:
        return r.stretch.line_mass * a.line.gravity / width

    columns = (
        Column("plate", "text", "stretch.section"),
        Column("belt on plate", "text", "stretch.bed.name"),
        Column("friction", "friction", "stretch.bed.friction"),
        Column("length", "length", "stretch.length"),
        Column("mass on it", "line mass", "stretch.line_mass"),
        Column("mean pressure", "pressure", pressure),
        Column("force", "force", lambda r: r.forces["slider_bed"]),
        Column("heat of friction", "power", heat),
        Column("source", "text", "stretch.bed.source"),
    )
    rows = tuple(r for r in a.stretches if r.stretch.bed is not None)
    note = (
        "Dry and clean; a wet or dirty plate is in no maker's figure. "
        "The cover wears by sliding: DIN 22101's wear is that of loading alone."
    )
    return Table("slider_beds", "Resistances", "Plates under the belt", columns, rows, "resistances", note)
