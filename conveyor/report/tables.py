"""Results as tables: pandas, units in the names, no spreadsheet in sight. Column names are stable."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from conveyor.figures import celsius
from conveyor.line.roll_lives import roll_life, set_life
from conveyor.line.stretches import Strand
from conveyor.line.walk import StretchResult, excited_band, worst_energy_error, worst_error
from conveyor.loop.balance import Balance
from conveyor.models import Conveyor, RubberCompound
from conveyor.units import si

CURVE_POINTS = 25
DECADES = (-3, 7)  # of frequency shown in the rubber table [Hz]
PER_DECADE = 4


def summary(conveyor: Conveyor, results: tuple[StretchResult, ...], found: Balance) -> pd.Series:
    """Figures of the whole conveyor, one a row."""
    forces, power, tensions, classical = found.forces, found.power, found.tensions, found.classical
    strength = conveyor.belt.carcass.strength
    even = not conveyor.duty  # a duty has its own year (case_tables.year)
    rows: dict[str, float | None] = {
        "length [m]": conveyor.route.length,
        "lift [m]": conveyor.route.rise,
        "belt speed [m/s]": si(conveyor.belt.speed),
        "mass flow [t/h]": si(conveyor.material.flow) * 3.6,
        "motor power [kW]": power.motor / 1e3,
        "belt power [kW]": power.belt / 1e3,
        "mains power [kW]": power.mains / 1e3,
        "effective tension [N]": forces.total,
        "indentation [N]": forces.indentation,
        "idler rotation [N]": forces.idler_rotation,
        "flexure [N]": forces.flexure,
        "secondary [N]": forces.secondary,
        "special [N]": forces.special,
        "lift force [N]": forces.lift,
        "indentation share of main resistance [-]": forces.indentation / forces.main,
        "equivalent DIN f [-]": found.friction_factor,
        "tight side tension [N]": tensions.tight,
        "slack side tension [N]": tensions.slack,
        "tight side tension at start [N]": tensions.tight_start,
        "smallest tension [N]": tensions.smallest,
        "belt safety at start [-]": (
            None if strength is None else si(strength) * si(conveyor.belt.width) / tensions.largest
        ),
        "energy [kWh/(t km)]": power.energy_per_tonne_km,
        "energy per year [MWh]": power.energy_per_year / 1e3
        if even and power.energy_per_year is not None
        else None,
        f"cost per year [{power.currency or '-'}]": power.cost_per_year if even else None,
        "classical f [-]": classical.friction_factor,
        "classical effective tension [N]": classical.total,
        "classical motor power [kW]": classical.motor / 1e3,
        "largest error estimate of the contacts [-]": worst_error(results),
        "largest energy error of the contacts [-]": worst_energy_error(results),
    }
    given = {name: value for name, value in rows.items() if value is not None}
    return pd.Series(given, name=conveyor.name, dtype=float)


def rubber(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> pd.DataFrame:
    """One row a strand: its rubber, the strain and the band of frequency that the rolls work it at."""
    compounds: dict[Strand, RubberCompound] = {
        "carry": conveyor.carry_compound,
        "return": conveyor.return_compound,
    }
    at = si(conveyor.ambient.belt)
    rows = []
    for strand, compound in compounds.items():
        band = excited_band(results, strand) or (None, None)
        data = compound.frequencies(at) or (None, None)
        strain = next(r.surface.strain for r in results if r.stretch.strand == strand)
        rows.append(
            {
                "strand": strand,
                "compound": compound.name,
                "kind": compound.kind,
                "temperature [degC]": celsius(at),
                "excited from [Hz]": band[0],
                "excited to [Hz]": band[1],
                "data from [Hz]": data[0],
                "data to [Hz]": data[1],
                "working strain [-]": None if strain is None else strain.strain,
                "E' factor of strain [-]": 1.0 if strain is None else strain.storage_factor,
                "E'' factor of strain [-]": 1.0 if strain is None else strain.loss_factor,
            }
        )
    return pd.DataFrame(rows)


def sections(results: tuple[StretchResult, ...]) -> pd.DataFrame:
    """One row a stretch: geometry, masses, forces; both strands, in running direction.

    The life of a set stands there where the bearings of all its rolls are given.
    """
    table = pd.DataFrame(
        [
            {
                "section": r.stretch.section,
                "strand": r.stretch.strand,
                "length [m]": r.stretch.length,
                "lift [m]": r.stretch.rise,
                "inclination [deg]": math.degrees(r.stretch.inclination),
                "idler spacing [m]": r.stretch.spacing,
                "belt mass [kg/m]": r.stretch.belt_mass,
                "bulk mass [kg/m]": r.stretch.bulk_mass,
                "indentation [N]": r.indentation,
                "idler rotation [N]": r.rotation,
                "flexure [N]": r.flexure,
                "idler tilt [N]": r.tilt,
                "lift force [N]": r.lift,
                "total [N]": r.total,
                "equivalent f [-]": r.main / r.unit_main,
            }
            for r in results
        ]
    )
    sets = [set_life(r.stretch, r.rolls[0].curve.contact.speed) for r in results]
    lives = [life.hours if life is not None and life.whole else None for life in sets]
    return _with_lives(table, "idler set L10 life [h]", lives)


def _with_lives(table: pd.DataFrame, name: str, lives: Sequence[float | None]) -> pd.DataFrame:
    """Append a column of lives, if there is one."""
    if any(life is not None for life in lives):
        table[name] = np.array(lives, dtype=float)
    return table


def rolls(results: tuple[StretchResult, ...]) -> pd.DataFrame:
    """One row a roll of every stretch's set: load, contact at its highest line load, indentation, drag, life."""
    table = pd.DataFrame(
        [
            {
                "section": r.stretch.section,
                "strand": r.stretch.strand,
                "roll": roll.load.name,
                "diameter [mm]": 2e3 * roll.curve.contact.radius,
                "force [N]": roll.load.force,
                "highest line load [N/m]": float(roll.peak.line_load),
                "half width [mm]": 1e3 * float(roll.peak.half_width),
                "eccentricity [mm]": 1e3 * float(roll.peak.eccentricity),
                "penetration [mm]": 1e3 * float(roll.peak.penetration),
                "penetration of cover [-]": float(roll.peak.penetration) / roll.curve.contact.cover_thickness,
                "peak pressure [MPa]": 1e-6 * float(roll.peak.peak_pressure),
                "transit frequency [Hz]": roll.curve.contact.speed / (2.0 * float(roll.peak.half_width)),
                "indentation [N]": roll.resistance,
                "error estimate [-]": roll.peak.error,
                "energy error [-]": roll.peak.energy_error,
                "rim drag [N]": drag,
                "rotation [rpm]": 60.0
                * roll.curve.contact.speed
                / (2.0 * math.pi * roll.curve.contact.radius),
            }
            for r in results
            for roll, drag in zip(r.rolls, r.stretch.drags, strict=True)
        ]
    )
    lives = [
        roll_life(r.stretch, place, roll.curve.contact.speed)
        for r in results
        for place, roll in enumerate(r.rolls)
    ]
    heavier = [None if life is None else life.heavier for life in lives]
    table = _with_lives(table, "heavier bearing [N]", heavier)
    return _with_lives(table, "roll L10 life [h]", [None if life is None else life.both for life in lives])


def resistances(results: tuple[StretchResult, ...], found: Balance) -> pd.DataFrame:
    """Every newton and the law it comes from; the rows add up to the effective tension."""
    by_law = results[0].stretch.span_flexure is not None
    flexure = "calculation.flexure, laws" if by_law else "share of the main resistance, flagged default"
    by_strand = [
        (
            f"{label}, {strand}",
            kind,
            math.fsum(getattr(r, name) for r in results if r.stretch.strand == strand),
            source,
        )
        for label, name, kind, source in (
            ("indentation", "indentation", "main", "viscoelastic contact of every roll (docs/method.md)"),
            ("idler rotation", "rotation", "main", "roll drag x number of rolls"),
            ("flexure of belt and bulk", "flexure", "main", flexure),
            ("idler tilt", "tilt", "special", "ISO 5048, F_e"),
            ("lift", "lift", "lift", "ISO 5048, F_St"),
        )
        for strand in ("carry", "return")
    ]
    singles = [(single.name, single.kind, single.force, single.source) for single in found.singles]
    table = pd.DataFrame([*by_strand, *singles], columns=["resistance", "kind", "force [N]", "source"])
    total = found.forces.total
    table.insert(3, "share [-]", table["force [N]"] / total)
    return table


def comparison(found: Balance) -> pd.DataFrame:
    """Compare with the classical calculation with a given f, and with CEMA's where its factors are given."""
    forces = found.forces
    estimates = {"classical, given f": found.classical, "CEMA classic, given Ky": found.cema}
    return pd.DataFrame(
        {
            "this calculation": [
                found.friction_factor, forces.main, forces.secondary, forces.special, forces.lift, forces.total,
                found.power.motor / 1e3,
            ],
        }
        | {
            name: [
                made.friction_factor, made.main, made.secondary, made.special, made.lift, made.total,
                made.motor / 1e3,
            ]
            for name, made in estimates.items()
            if made is not None
        },
        index=[
            "f [-]", "main [N]", "secondary [N]", "special [N]", "lift [N]", "effective tension [N]",
            "motor power [kW]",
        ],
    )  # fmt: skip


def tensions(found: Balance) -> pd.DataFrame:
    """Tension round the loop in steady running, from the drive back to it."""
    return pd.DataFrame(
        [
            {
                "place": point.place,
                "distance from drive [m]": point.distance,
                "tension [N]": point.tension,
                "least for sag [N]": point.least_for_sag,
            }
            for point in found.points
        ]
    )


def indentation_curves(results: tuple[StretchResult, ...]) -> pd.DataFrame:
    """Indentation against line load, one block a distinct contact, over the loads that occur on it."""
    seen: dict[int, Any] = {}
    for r in results:
        for roll in r.rolls:
            seen.setdefault(id(roll.curve), (f"{r.stretch.strand}, {2e3 * roll.curve.contact.radius:.0f} mm, "
                                             f"{r.stretch.spacing:g} m", roll.curve))  # fmt: skip
    blocks = []
    for label, curve in seen.values():
        w = np.geomspace(curve.lowest, curve.highest, CURVE_POINTS)
        found = curve.at(w)
        block = {
            "contact": label,
            "line load [N/m]": w,
            "indentation [N/m]": found.resistance,
            "friction [-]": found.resistance / w,
            "half width [mm]": 1e3 * found.half_width,
            "peak pressure [MPa]": 1e-6 * found.peak_pressure,
        }
        blocks.append(pd.DataFrame(block))
    return pd.concat(blocks, ignore_index=True)


def prony(compound: RubberCompound, temperature: float) -> pd.DataFrame:
    """Terms of a compound's relaxation spectrum, at the reference and at `temperature` [K]."""
    terms = compound.prony.terms
    series = compound.series(temperature)
    order = np.argsort([si(term.time) for term in terms])
    return pd.DataFrame(
        {
            "modulus [MPa]": [1e-6 * si(terms[i].modulus) for i in order],
            "time at reference [s]": [si(terms[i].time) for i in order],
            "time at belt temperature [s]": series.times,
        }
    )


def moduli(compound: RubberCompound, temperature: float) -> pd.DataFrame:
    """E', E'', tan δ of a compound at `temperature` [K] over frequency."""
    frequency = np.logspace(*DECADES, (DECADES[1] - DECADES[0]) * PER_DECADE + 1)
    series = compound.series(temperature)
    omega = 2.0 * np.pi * frequency
    return pd.DataFrame(
        {
            "frequency [Hz]": frequency,
            "E' [MPa]": 1e-6 * series.storage(omega),
            "E'' [MPa]": 1e-6 * series.loss(omega),
            "tan delta [-]": series.tan_delta(omega),
        }
    )


def solver(results: tuple[StretchResult, ...]) -> pd.DataFrame:
    """One row a distinct contact: its range of loads, what the curve cost, its errors."""
    seen = {id(roll.curve): (r.stretch.strand, roll.curve) for r in results for roll in r.rolls}
    return pd.DataFrame(
        [
            {
                "strand": strand,
                "roll [mm]": 2e3 * curve.contact.radius,
                "spacing [m]": curve.contact.spacing,
                "cover [mm]": 1e3 * curve.contact.cover_thickness,
                "lowest load [N/m]": curve.lowest,
                "highest load [N/m]": curve.highest,
                "order": curve.stats.order,
                "matrices": curve.stats.matrices,
                "nodes": curve.stats.nodes,
                "retardation terms": curve.stats.terms,
                "error estimate [-]": curve.curve.error,
                "energy error [-]": curve.curve.energy_error,
            }
            for strand, curve in seen.values()
        ]
    )
