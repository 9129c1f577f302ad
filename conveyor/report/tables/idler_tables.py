"""Rolls and idler sets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.line.roll_lives import roll_life
from conveyor.line.stretches import Strand
from conveyor.loop.set_duty import SetDuty
from conveyor.loop.ties import first_maximum
from conveyor.report.row_getters import extreme_getter
from conveyor.report.table_model import Column, Table
from conveyor.studies.load_cases import Load
from conveyor.units.presentation import display_unit

_HOUR: Final = 3600.0
_MOST_NAMES: Final = 2
"""Maximum number of sections named in a cell."""


def roll_table(a: CalculatedConveyor) -> Table:
    """Every roll of every section: load, contact at its highest line load, indentation, drag, life."""
    columns = (
        Column("section", "text", "0.stretch.section"),
        Column("strand", "text", "0.stretch.strand"),
        Column("roll", "text", "1.load.name"),
        Column("diameter", "size", lambda row: 2.0 * row[1].curve.contact.radius, page=None),
        Column("force", "force", "1.load.force"),
        Column("highest line load", "line force", "1.peak.line_load"),
        Column("half width", "thickness", "1.peak.half_width"),
        Column("eccentricity", "thickness", "1.peak.eccentricity", page=None),
        Column("penetration", "thickness", "1.peak.penetration"),
        Column("penetration of cover", "share",
               lambda row: row[1].cover_penetration / row[1].curve.contact.cover_thickness, page=None),
        Column("peak pressure", "pressure", "1.peak.peak_pressure"),
        Column("error of the peak", "share", "1.peak.peak_error"),
        Column("transit frequency", "passing",
               lambda row: row[1].curve.contact.speed / (2.0 * float(row[1].peak.half_width)), page=None),
        Column("indentation", "roll force", "1.resistance"),
        Column("error estimate", "error", "1.peak.error", page=None),
        Column("energy error", "error", "1.peak.energy_error", page=None),
        Column("rim drag", "roll force", "2"),
        Column("rotation", "rotation",
               lambda row: row[1].curve.contact.speed / (2.0 * math.pi * row[1].curve.contact.radius), page=None),
        Column("heavier bearing", "force", "3.heavier", page=None, sparse=True),
        Column("roll L10 life", "duration", lambda row: row[3] and row[3].both * _HOUR, sparse=True),
    )  # fmt: skip
    rows = tuple(
        (r, roll, drags[roll.place], roll_life(r.stretch, roll.place, roll.curve.contact.speed))
        for r, drags in zip(a.stretches, a.line.roll_drags, strict=True)
        for roll in r.rolls
    )
    heading = "Every roll of a set, contact at the highest line load"
    return Table("rolls", "Rolls", heading, columns, rows, printed=False)


def distinct_rolls(a: CalculatedConveyor, every: Table) -> Table:
    """Rolls with identical figures once, with their sections."""
    by_look, looks = dict[tuple[str, ...], list[Any]](), dict[tuple[Any, ...], tuple[str, ...]]()
    shown = tuple(column for column in every.columns if column.page is not None)
    for row in every.rows:
        values = tuple(column.get(row) for column in shown[1:])
        if values not in looks:
            looks[values] = tuple(
                display_unit(column.kind).said(value, 3) for column, value in zip(shown[1:], values, strict=True)
            )
        by_look.setdefault(looks[values], []).append(row)
    columns = (
        Column("sections", "text", lambda rows: _section_names([row[0].stretch.section for row in rows])),
        *(column.of("0") for column in shown[1:]),
    )
    heading = "Rolls of a set at their highest line load, identical ones once"
    note = f"Relative error of the contacts: at most {a.error_estimate:.0e}."
    return Table("distinct_rolls", "Sections", heading, columns, tuple(by_look.values()), "rolls", note, named=3)


def idler_sets(a: CalculatedConveyor, loads: Sequence[Load]) -> Table:
    """Idler sets with rating, bearings or flap check, one row per strand and spacing; worst of all cases."""
    system, alike = a.conveyor.report.units, dict[tuple[Strand, float], list[tuple[str, SetDuty]]]()
    for load in loads:
        for duty in load.found.set_duty:
            key = (duty.stretch.strand, duty.stretch.spacing)
            alike.setdefault(key, []).append((load.label.text(system), duty))
    rows = []
    for of in alike.values():
        duties, sets = [duty for _, duty in of], [duty.stretch.sets for case, duty in of if case == of[0][0]]
        heaviest = first_maximum(of, lambda pair: pair[1].limits.load)
        closest = min(duties, key=lambda duty: duty.distance)  # to resonance
        rows.append((duties[0], math.fsum(sets), *heaviest, closest, duties))
    columns = (
        Column("strand", "text", "0.stretch.strand"),
        Column("spacing", "spacing", "0.stretch.spacing"),
        Column("sets", "count", "1"),
        Column("turning mass of a set", "mass", "0.stretch.set_mass"),
        Column("rotation", "rotation", extreme_getter(max, "5", "rotations.1"), page=None),
        Column("load of a set", "force", "3.limits.load"),
        Column("lump factor", "ratio", "3.limits.lump_factor", page=None),
        Column("of the case", "text", "2", page=None),
        Column("rating", "force", "0.limits.rating", sparse=True),
        Column("CEMA class", "text", "0.limits.cema_class", sparse=True),
        Column("least CEMA class", "text", "3.limits.least_class", sparse=True),
        Column("slope of the axle", "angle", extreme_getter(max, "5", "limits.axle.slope"), sparse=True),
        Column("L10 life of a set", "duration",
        extreme_getter(min, "5", lambda duty: duty.life and duty.life.hours * _HOUR),
               sparse=True),
        Column("rolls turn at", "swing", "4.rotations.1"),
        Column("belt swings from", "swing", "4.frequencies.0"),
        Column("belt swings to", "swing", "4.frequencies.1"),
        Column("distance from resonance", "share", "4.distance"),
        Column("in section", "text", "4.stretch.section"),
        Column("spacing at most, against flap", "spacing",
        extreme_getter(min, "5", lambda duty: duty.still_spacing or None),
               sparse=True),
    )  # fmt: skip
    heading = "Idler sets, the worst of all cases"
    note = (
        "Load with the lump factor (given, else by belt.wear.lump) and the tension on a raised set. Belt: first "
        "natural frequency between two sets in the section closest to resonance; rolls out of round excite it and "
        "twice it; distance 0 where a span is hit."
    )
    return Table("idler_sets", "Sections", heading, columns, rows, "rolls", note, named=2)


def _section_names(names: list[str]) -> str:
    """Names of sections; of many the first and the number of others."""
    return ", ".join(names) if len(names) <= _MOST_NAMES else f"{names[0]} and {len(names) - 1} more"
