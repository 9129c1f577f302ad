"""Rubber of the covers, its contacts and its indentation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.belt_warming import belt_warming
from conveyor.line.belt_contacts import BeltContacts
from conveyor.line.contacts import Contacts
from conveyor.line.covers import CoverTestFactor, compounds_by_strand
from conveyor.line.stretches import Strand
from conveyor.models import RubberCompound
from conveyor.report.table_model import Column, PagePlacement, Table
from conveyor.rubber.lots import LOT_SCATTER
from conveyor.units.presentation import display_unit
from conveyor.units.sentences import degree_signs, format_band, percent

CURVE_POINTS: Final = 25
_DECADES, _PER_DECADE = (-3, 7), 4  # of frequency shown in the rubber table [Hz]


def _distinct_contacts(a: CalculatedConveyor) -> dict[Any, Any]:
    """Distinct load curves, each with the last stretch that uses it."""
    return {curve: r for r in a.stretches for roll in r.rolls for curve in roll.curve.solved}


def belt_support(a: CalculatedConveyor) -> Table:
    """Effect of belt compliance and shares of the loss, by strand; empty on a stiff carcass."""
    columns = (
        Column("strand", "text", "strand"),
        Column("lowest effective tension", "line force", "tensions.0"),
        Column("mean effective tension", "line force", "tensions.1"),
        Column("highest effective tension", "line force", "tensions.2"),
        Column("indentation on a stiff carcass", "force", "confined"),
        Column("indentation on the belt", "force", "force"),
        Column("change by the give", "share", "change"),
        Column("loss in the cover on the rolls", "share", lambda row: row.shares.get("bottom_cover")),
        Column("loss in the other cover", "share", lambda row: row.shares.get("top_cover")),
        Column("loss in the carcass", "share", lambda row: row.shares.get("carcass")),
    )
    rows = a.contacts.gives if isinstance(a.contacts, BeltContacts) else ()
    heading = "Effect of belt compliance, and shares of the loss"
    return Table("belt_support", "Indentation", heading, columns, rows, "rolls")


def contact_solutions(a: CalculatedConveyor) -> Table:
    """Distinct contacts: range of loads, size of the solution, errors."""
    gives = isinstance(a.contacts, BeltContacts)  # its contacts are solved at T - m' V² per width
    columns = (
        Column("strand", "text", "1.stretch.strand"),
        Column("roll", "size", lambda row: 2.0 * row[0].contact.radius),
        Column("spacing", "spacing", "0.contact.spacing"),
        Column("cover", "size", "0.contact.cover_thickness"),
        *((Column("effective tension", "line force", "0.contact.pull"),) if gives else ()),
        Column("lowest load", "line force", "0.lowest"),
        Column("highest load", "line force", "0.highest"),
        Column("order", "count", "0.stats.order"),
        Column("matrices", "count", "0.stats.matrices"),
        Column("nodes", "count", "0.stats.nodes"),
        Column("retardation terms", "count", "0.stats.terms"),
        Column("error estimate", "error", "0.error"),
        Column("energy error", "error", "0.energy_error"),
    )
    heading, caption = (
        "Contact solutions, one row per roll, cover and spacing",
        "Contact solutions, one row per roll, cover and spacing",
    )
    rows, page = tuple(_distinct_contacts(a).items()), (PagePlacement("provenance", caption, printed=False),)
    return Table("contact_solutions", "Indentation", heading, columns, rows, page, printed=False)


def indentation_table(a: CalculatedConveyor) -> Table:
    """Indentation against line load, one block per distinct contact, over the loads that occur."""
    seen: dict[Any, tuple[str, CoverTestFactor | None]] = {}
    for r in a.stretches:
        for roll in r.rolls:
            size, apart = (
                display_unit(kind, a.conveyor.report.units).said(value, 4)
                for kind, value in (("size", 2.0 * roll.curve.contact.radius), ("spacing", r.stretch.spacing))
            )
            for curve in roll.curve.solved:
                pull = curve.contact.pull
                held = "" if pull is None else f", {display_unit('line force', a.conveyor.report.units).said(pull, 4)}"
                seen.setdefault(curve, (f"{r.stretch.strand}, {size}, {apart}{held}", r.cover.test_factor))
    rows: list[tuple[Any, ...]] = []
    for curve, (label, tested) in seen.items():
        loads = np.geomspace(curve.lowest, curve.highest, CURVE_POINTS)
        solved = curve.at(loads)
        resistance = solved.resistance if tested is None else tested.factor(loads) * solved.resistance
        columns = (loads, resistance, solved.half_width, solved.peak_pressure, solved.peak_error)
        rows += [(label, *point) for point in zip(*(column.tolist() for column in columns), strict=True)]
    declared = (
        Column("contact", "text", "0"),
        Column("line load", "line force", "1"),
        Column("indentation", "line force", "2"),
        Column("friction", "friction", lambda row: row[2] / row[1]),
        Column("half width", "thickness", "3"),
        Column("peak pressure", "pressure", "4"),
        Column("error of the peak", "share", "5"),
    )
    heading = "Indentation against line load, one block a contact"
    return Table("indentation", "Indentation", heading, declared, tuple(rows), printed=False)


def rubber_table(a: CalculatedConveyor) -> Table:
    """Compound, working strain, excitation band and test factor of every strand."""
    at, rows = a.temperature, []
    for strand, compound in compounds_by_strand(a.conveyor).items():
        strain = a.contacts.covers[strand].strain
        band, data = a.contacts.excited_band(strand), compound.frequencies(at)
        rows.append((strand, compound, band or (None, None), data or (None, None), strain))
    contacts, warming = a.contacts, cover_warming(a)
    columns = (
        Column("strand", "text", "0", json="strand"),
        Column("compound", "text", "1.name", json="compound"),
        Column("kind", "text", "1.kind"),
        Column("temperature", "temperature", lambda _: at, json="temperature_degC"),
        *band_columns("2", "3"),
        Column("", "text", lambda row: list(row[2]), page=None, sheet=False, json="excited_Hz", key="excited"),
        Column("", "text", lambda row: list(row[3]), page=None, sheet=False, json="data_Hz", key="data"),
        Column("working strain", "share", "4.strain", json="working_strain"),
        Column("E' factor of strain", "factor",
               lambda row: 1.0 if row[4] is None else row[4].storage_factor, json="storage_factor",
               key="storage_factor"),
        Column("E'' factor of strain", "factor",
               lambda row: 1.0 if row[4] is None else row[4].loss_factor, json="loss_factor", key="loss_factor"),
        Column("tests", "count", lambda row: sum(test.points().line_load.size for test in row[1].tests), page=None),
        Column("test factor", "factor", lambda row: contacts.test_factor(row[0]), json="level_factor"),
        Column("test factor from", "factor", lambda row: _test_factor_end(contacts, row[0], -1.0), json="level_from"),
        Column("test factor to", "factor", lambda row: _test_factor_end(contacts, row[0], 1.0), json="level_to"),
        Column("warming left out", "warming", lambda _: warming, json="warming_K"),
    )  # fmt: skip
    heading = "Rubber excitation band, working strain and test factor"
    return Table("rubber", "Rubber", heading, columns, rows, "rubber", named=2)


def cover_warming(a: CalculatedConveyor) -> float:
    """Temperature of the belt above the air by its own indentation, which is left out of the power [K]."""
    loss = max(a.balance.forces.indentation, 0.0) * a.line.speed
    return belt_warming(loss, width=a.line.belt.width, length=a.conveyor.route.length, speed=a.line.speed)


def _taken_facts(a: CalculatedConveyor, compound: RubberCompound) -> Iterator[tuple[str, str]]:
    """Facts assumed of the rubber beside its data: warming, conditioning, ageing, lots."""
    shown = display_unit("warming", a.conveyor.report.units)
    warm = shown.said(cover_warming(a), 2)
    yield "warming by its own loss", f"{warm} above the air, left out (heat balance of the loop)"
    yield "conditioning", "taken as run in: stiffness lost in the first cycles (Mullins) is not that of the data"
    yield "ageing", "taken as in the data; covers harden in service, by 5 to 10 Shore A in years (general knowledge)"
    lots = compound.stated_lot_scatter
    words = f"{percent(LOT_SCATTER)} of the indentation (assumed)" if lots is None else f"{percent(lots, 1)} (stated)"
    yield "scatter from lot to lot", f"{words}, 90 %; in comparisons of compounds, not in the range of the power"


def _test_factor_end(contacts: Contacts, strand: Strand, sign: float) -> float | None:
    """Lower or upper end of a strand's test factor; None without tests."""
    if contacts.covers[strand].test_factor is None:
        return None
    return contacts.test_factor(strand) * contacts.test_factor_range(strand)[sign > 0.0]


def band_columns(excited: str, data: str) -> Iterator[Column]:
    """Columns of excitation band and data range: numbers in workbook and files, text on the page."""
    for name, kind, path in (("excited", "passing", excited), ("data", "frequency", data)):
        yield Column(f"{name} from", kind, f"{path}.0", page=None)
        yield Column(f"{name} to", kind, f"{path}.1", page=None)
    yield Column("excitation band", "frequency", _in_hertz, sheet=False).of(excited)
    yield Column("band of the data", "frequency", _in_hertz, sheet=False).of(data)


def _in_hertz(band: tuple[float | None, float | None] | None) -> str | None:
    low, high = band or (None, None)
    return None if low is None or high is None else format_band((low, high)).removesuffix(" Hz")


def compound_facts(a: CalculatedConveyor, strand: Strand) -> Table:
    """Facts of the rubber of a strand in words; no rows where it is that of the carry strand."""
    compounds, system = compounds_by_strand(a.conveyor), a.conveyor.report.units
    compound = compounds[strand]
    known, fit = compound.range, compound.fit
    warmth, share = display_unit("temperature", system), display_unit("share")
    band = compound.frequencies(compound.reference)
    said = (
        ("description", compound.description),
        ("origin", compound.source.origin),
        ("licence", compound.source.licence),
        ("data", compound.source.data or "not stated"),
        ("strain of the data", compound.strain or "not stated"),
        ("Poisson's ratio", repr(compound.poisson_ratio)),
        ("reference temperature", warmth.said(compound.reference_temperature, 4)),
        ("equilibrium modulus", display_unit("pressure", system).said(compound.prony.equilibrium, 4)),
        ("Prony terms", str(len(compound.prony.terms))),
        ("temperature shift", "none" if compound.shift is None else compound.shift.law),
        ("range of frequency", "not stated" if band is None else format_band(band)),
        ("range of temperature",
         "not stated" if known is None else " to ".join(warmth.said(end, 4) for end in known.temperature)),
        ("spectrum", "" if compound.carrier is None else f"of {compound.carrier}, which carries the tests"),
        ("rolling-resistance tests", "; ".join(dict.fromkeys(test.source for test in compound.tests)) or "none"),
        ("fit", "" if fit is None else fit.method),
        ("rms errors of E', E''", "" if fit is None or compound.kind != "measured" else
         f"{share.said(fit.storage_rms, 4)}, {share.said(fit.loss_rms, 4)}"),
        *_taken_facts(a, compound),
        ("unknown", "; ".join(compound.missing) or "nothing listed"),
    )  # fmt: skip
    columns = (Column("fact", "text", "0"), Column("value", "text", "1"))
    again = strand == "return" and compound.name == compounds["carry"].name
    rows = () if again else tuple((name, degree_signs(words)) for name, words in said if words)
    page = (PagePlacement("rubber", f"What is known of {compound.name}", printed=False),)
    return Table(f"known_{strand}", "", f"{compound.name} ({compound.kind})", columns, rows, page)


def prony_table(a: CalculatedConveyor, strand: Strand) -> Table:
    """Relaxation spectrum of the rubber of a strand, at its reference and at the belt's temperature."""
    compound = compounds_by_strand(a.conveyor)[strand]
    reference = compound.series_at_reference
    columns = (
        Column("modulus", "pressure", "0"),
        Column("time at reference", "relaxation time", "1"),
        Column("time at belt temperature", "relaxation time", "2"),
    )
    values = (reference.moduli, reference.times, compound.series(a.temperature).times)
    rows = tuple(zip(*(value.tolist() for value in values), strict=True))
    return Table(f"prony_{strand}", "Rubber", "Relaxation spectrum", columns, rows, printed=False)


def moduli_table(a: CalculatedConveyor, strand: Strand) -> Table:
    """E', E'', tan δ of the rubber of a strand at the belt's temperature over frequency."""
    compound = compounds_by_strand(a.conveyor)[strand]
    frequency = np.logspace(*_DECADES, (_DECADES[1] - _DECADES[0]) * _PER_DECADE + 1)
    series, omega = compound.series(a.temperature), 2.0 * np.pi * frequency
    values = (frequency, series.storage(omega), series.loss(omega), series.tan_delta(omega))
    columns = (
        Column("frequency", "frequency", "0"),
        Column("E'", "pressure", "1", key="storage"),
        Column("E''", "pressure", "2", key="loss"),
        Column("tan delta", "friction", "3"),
    )
    rows = tuple(zip(*(value.tolist() for value in values), strict=True))
    return Table(f"moduli_{strand}", "Rubber", "Moduli at the belt's temperature", columns, rows, printed=False)
