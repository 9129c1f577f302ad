"""Sections with their forces, resistances with their sources, classical estimates."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor, StretchResult
from conveyor.force_sums import force_label
from conveyor.line.roll_lives import idler_set_life
from conveyor.loop.estimates import ClassicalEstimate, estimate_of_forces
from conveyor.models.calculation_methods import FACTOR_METHODS, METHOD_NAMES
from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Column, Figure, PagePlacement, Table

_HOUR: Final = 3600.0


def section_table(a: CalculatedConveyor) -> Table:
    """Geometry, masses and forces of every section of both strands, in running direction."""
    columns = (
        Column("section", "text", "stretch.section", json="section"),
        Column("strand", "text", "stretch.strand", json="strand"),
        Column("length", "length", "stretch.length", "layout", json="length_m"),
        Column("lift", "length", "stretch.rise", "layout", json="lift_m"),
        Column("inclination", "angle", "stretch.inclination", page=None),
        Column("idler spacing", "spacing", lambda r: r.stretch.spacing if r.stretch.bed is None else None, "layout"),
        Column("belt mass", "line mass", "stretch.belt_mass", "layout"),
        Column("bulk mass", "line mass", "stretch.bulk_mass", "layout"),
        *(
            Column(force.short or force.name, "force", _force_getter(force.key), "forces", json=f"{force.key}_N",
                   total=True)
            for force in a.balance.along
        ),
        Column("total", "force", "total", "forces", json="total_N", total=True),
        Column("equivalent f", "friction", lambda r: r.main / r.unit_main if r.unit_main else None, "layout"),
        Column("idler set L10 life", "duration", _set_life_seconds, "layout", sparse=True),
    )  # fmt: skip
    page = (
        PagePlacement("route", "Sections of both strands, in running direction", "layout", printed=False),
        PagePlacement("route", "Forces of the sections", "forces"),
    )
    heading = "Forces of every section and strand"
    return Table("sections", "Sections", heading, columns, a.stretches, page, foot="all sections")


def _force_getter(key: str) -> Callable[[StretchResult], float]:
    return lambda row: row.forces[key]


def _set_life_seconds(r: StretchResult) -> float | None:
    """L10 life of the bearings of a set [s]; None where one is not given."""
    life = idler_set_life(r.stretch, r.rolls[0].curve.contact.speed) if r.rolls else None
    return life.hours * _HOUR if life is not None and life.whole else None


def resistance_table(a: CalculatedConveyor) -> Table:
    """Resistances with their sources; the rows add up to the effective tension."""
    along = [
        (f"{force.name}, {strand}" if force.only_on is None else force.name, force.kind, newtons, force.source)
        for force in a.balance.along
        for strand, newtons in force.by_strand().items()
        if force.only_on in {None, strand}
    ]
    total = a.balance.forces.total
    columns = (
        Column("resistance", "text", "0"),
        Column("kind", "text", lambda row: force_label(row[1])),
        Column("force", "force", "2", total=True),
        Column("share", "share", lambda row: _share_or_nan(row[2], total), total=total != 0.0),
        Column("source", "text", "3"),
    )
    rows = (*along, *((each.name, each.kind, each.total, each.source) for each in a.balance.singles))
    heading = "Resistances and their sources"
    return Table("resistances", "Resistances", heading, columns, rows, "resistances", foot="effective tension")


def _share_or_nan(part: float, whole: float) -> float:
    """Share of a whole; NaN if that is zero."""
    return part / whole if whole else math.nan


def _friction_part(a: CalculatedConveyor, name: str) -> float:
    """Contribution of a main resistance to the friction factor f [-]; NaN for others."""
    balance = a.balance
    main = {force.key for force in balance.along if force.kind == "main"}
    return balance.forces.parts[name] / balance.unit_main if name in main else math.nan


def breakdown_table(a: CalculatedConveyor) -> Table:
    """Sums of the forces by kind, with their shares."""
    forces = a.balance.forces
    columns = (
        Column("resistance", "text", force_label),
        Column("force", "force", forces.parts.get),
        Column("share of total", "share", lambda name: _share_or_nan(forces.parts[name], forces.total)),
        Column("part of f", "friction", lambda name: _friction_part(a, name)),
    )
    heading = "Breakdown of the effective tension"
    return Table("breakdown", "Resistances", heading, columns, tuple(forces.parts), printed=False)


def classical_table(a: CalculatedConveyor, by_contact: CalculatedConveyor | None) -> Table:
    """Comparison with the other methods: a given f, CEMA where its factors are given, else the rolling contact."""
    balance, forces = a.balance, a.balance.forces
    of_rolls = None
    if by_contact is not None:
        other = by_contact.balance
        of_rolls = estimate_of_forces(other.forces, other.friction_factor, "itemised")
    estimates: list[tuple[str, ClassicalEstimate | None]] = [
        ("rolling contact", of_rolls),
        ("classical, given f", None if a.line.method in FACTOR_METHODS else balance.classical),
        ("CEMA classic, given Ky", None if a.line.method == "cema classic" else balance.cema),
    ]
    others = [(name, made) for name, made in estimates if made is not None]

    def row(label: str, kind: str, name: str, here: float) -> Figure:
        return Figure(label, kind, (here, *(getattr(made, name) for _, made in others)), key=name)

    powers = (balance.power.motor, *(balance.layout.shaft_power(made.motor_force) for _, made in others))

    rows = (
        row("f", "friction", "friction_factor", balance.friction_factor),
        row("main", "force", "main", forces.main),
        row("secondary", "force", "secondary", forces.secondary),
        row("special", "force", "special", forces.special),
        row("lift force", "force", "lift", forces.lift),
        replace(row("effective tension", "force", "total", forces.total), us="Te"),
        Figure("motor power", "power", powers, key="motor"),
    )
    names = [method_label(a), *(name for name, _ in others)]
    columns = (
        Column("quantity", FIGURE_NAME, "label"),
        *(Column(name, ROW_KIND, f"value.{i}", key=f"estimate_{i}") for i, name in enumerate(names)),
    )
    heading = "This calculation and the other methods"
    classical = f"secondary resistances of the classical estimate: {balance.classical.secondary_by}; "
    note = (
        f"{'' if a.line.method in FACTOR_METHODS else classical}governing at the drive: {balance.tensions.governed_by}"
    )
    return Table("classical", "Resistances", heading, columns, rows, "resistances", note)


def method_label(a: CalculatedConveyor) -> str:
    """Name of the column of the calculation itself."""
    return "this calculation" if a.line.method == "viscoelastic" else f"this calculation, {METHOD_NAMES[a.line.method]}"


def cema_table(a: CalculatedConveyor) -> Table:
    """CEMA classic, itemised; the rows add up to Te."""
    made, given = a.balance.cema, a.line.cema
    columns = (
        Column("symbol", "text", "0"),
        Column("CEMA resistance", "text", "1"),
        Column("force", "force", "2", total=True),
    )
    rows = () if made is None else made.items
    heading = "CEMA classic, itemised"
    note = (
        ""
        if given is None
        else f"Ky {given.flexure:g}, Kt {given.temperature:g}; Tp is "
        + ("the book's, by place and wrap" if given.pulleys is None else "the spec's")
    )
    return Table("cema", "Resistances", heading, columns, rows, "resistances", note, foot="Te", named=2)
