"""Figures of the whole conveyor, and the defaults that affect its power."""

from __future__ import annotations

from dataclasses import replace

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.default_bands import PowerRange
from conveyor.force_sums import force_label
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.report.table_model import Column, Figure, PagePlacement, Table, figure_table
from conveyor.report.tables.drive_tables import unsteady_words
from conveyor.units import System
from conveyor.units.presentation import MONEY, format_figure


def result_table(a: CalculatedConveyor, left_open: PowerRange) -> Table:
    """Figures of the whole conveyor, with the range of power due to defaults."""
    conveyor, balance = a.conveyor, a.balance
    forces, power, tensions_at, classic = balance.forces, balance.power, balance.tensions, balance.classical
    band = (
        Figure("motor power, low by defaults", "power", left_open.low, "", "defaults.motor_kW.low",
               key="motor_power_low"),
        Figure("motor power, high by defaults", "power", left_open.high, "", "defaults.motor_kW.high",
               key="motor_power_high"),
    )  # fmt: skip
    # six figures in large: by a classical method two others stand for the share
    share = forces.indentation / forces.main if a.line.method == "viscoelastic" else None
    error, energy_error = a.contacts.error, a.contacts.energy_error
    safety, of_year, at = a.belt_duty.safety, a.year, unsteady_words(a)
    energy, cost = (None, None) if of_year is None else (of_year.energy * JOULE_PER_KWH, of_year.cost)
    money = f"{MONEY}{(of_year and of_year.currency) or '-'}"
    rows = (
        Figure("length", "length", conveyor.route.length, json="length_m"),
        Figure("lift", "length", conveyor.route.rise, json="lift_m"),
        Figure("belt speed", "speed", a.line.speed),
        Figure("mass flow", "mass flow", a.line.flow, json="flow_t_per_h"),
        Figure("motor power", "power", power.motor, "tile large notebook", "power_kW.motor"),
        *(band if left_open.effects else ()),
        Figure("friction to design for, over the computed", "ratio", left_open.design_friction, "",
               "design_friction", key="design_friction"),
        Figure("motor power with the friction to design for", "power", left_open.design, "", "power_kW.design",
               key="motor_power_design"),
        Figure("belt power", "power", power.belt, f"{'tile ' if share is None else ''}large notebook", "power_kW.belt"),
        Figure("mains power", "power", power.mains, "", "power_kW.mains"),
        Figure("effective tension", "force", forces.total, "tile large notebook", "forces_N.total", us="Te"),
        *(
            Figure(
                force_label(name), "force", newtons, "notebook",
                f"forces_N.{name}", key=f"{name.lower()}_force",
            )
            for name, newtons in forces.parts.items()
        ),
        *(
            (Figure("indentation share of main resistance", "share", share, "tile large", key="indentation_share"),)
            if share is not None
            else ()
        ),
        Figure("equivalent DIN f", "friction", balance.friction_factor, "tile large notebook", "friction_factor",
               key="equivalent_f"),
        Figure("tight side tension", "force", tensions_at.tight,
               f"tile {'large ' if share is None else ''}notebook", us="T1"),
        Figure("slack side tension", "force", tensions_at.slack, "notebook", us="T2"),
        Figure(f"tight side tension {at}", "force", tensions_at.tight_start, key="tight_side_tension_at_start"),
        Figure("minimum tension, steady", "force", tensions_at.smallest, key="smallest_tension"),
        Figure(f"belt safety {at}", "ratio", safety, key="belt_safety_at_start"),
        Figure("energy", "specific energy", power.energy_per_tonne_km, "tile large notebook",
               key="specific_energy"),
        Figure("energy per year", "energy", energy),
        Figure("cost per year", money, cost),
        Figure("classical f", "friction", classic.friction_factor),
        Figure("classical effective tension", "force", classic.total, us="Te"),
        Figure("classical motor power", "power", balance.layout.shaft_power(classic.motor_force)),
        Figure("maximum error estimate of the contacts", "error", error, "", "error_estimate",
               key="contact_error_estimate"),
        Figure("maximum energy error of the contacts", "error", energy_error, key="contact_energy_error"),
    )  # fmt: skip
    heading = "Figures of the whole conveyor as given"
    page = (PagePlacement("summary", heading, printed=False),)
    table = figure_table("results", "Results", heading, rows, page=page, prefix="")
    name = Column("name", "text", "key", page=None)
    return replace(table, columns=(*table.columns, name))


def default_table(left_open: PowerRange, system: System) -> Table:
    """Defaults in use and their effect on the power, the most influential first."""
    columns = (
        Column("default", "text", "name", json="what"),
        Column("forces, low", "ratio", "low_factor", json="low_factor"),
        Column("forces, high", "ratio", "high_factor", json="high_factor"),
        Column("motor power at low", "power", "motor_low", json="motor_low_kW"),
        Column("motor power at high", "power", "motor_high", json="motor_high_kW"),
        Column("give instead", "text", "give", json="give"),
        Column("name", "text", "key", page=None, json="key"),
    )
    heading = "Defaults that affect the power, most influential first"
    return Table("defaults", "Results", heading, columns, left_open.effects, "inputs",
                 _power_range_text(left_open, system) if left_open.effects else "")  # fmt: skip


def _design_friction_text(power: PowerRange) -> str:
    """Friction to design for over the computed one, and where it comes from."""
    return f"{power.design_friction:.3g} times the expected friction, {power.design_source}"


def _power_range_text(power: PowerRange, system: System) -> str:
    """Power with its range and what is designed by it, and the default to replace first."""
    motor, low, high, design = (
        format_figure(end, "power", system) for end in (power.motor, power.low, power.high, power.design)
    )
    first = power.effects[0]
    said = (
        f"Motor power: expected {motor}, from {low} to {high} in the 90 % band of site, defaults and rubber. Motors, "
        f"belt, grip and take-up are checked at {design} ({_design_friction_text(power)}). "
        f"Replace first: {first.name} (give {first.give})."
    )
    untested = (f"Beyond the tests: {one.text(system)}." for one in power.untested)
    return " ".join((said, *untested))
