"""Overall verdict and governing figures of a conveyor."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from conveyor.assessment import Assessment
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import BELT_STRENGTH_CRITERIA, Check, governing_by_criterion, highest_use
from conveyor.line.covers import compounds_by_strand
from conveyor.loop.equilibrium import START
from conveyor.loop.tensions import MotionState
from conveyor.loop.ties import first_maximum, first_minimum
from conveyor.models import RubberCompound
from conveyor.models.calculation_methods import FACTOR_METHODS
from conveyor.report.table_model import Column, Table
from conveyor.studies.load_cases import AS_GIVEN
from conveyor.units import System
from conveyor.units.presentation import Unit, display_unit, format_figure
from conveyor.units.sentences import percent
from conveyor.units.unit_systems import trade_of

_TAKE_UP_CRITERIA: Final = ("take_up_tension", "sag", "drive_grip")
"""Criteria that the minimum take-up setting is determined by."""
_NO_MARGIN: Final = 1e-6  # [-], margin of the take-up below which its setting is the minimum; it is exact to rounding
_DOMINANT_SHARE: Final = 0.3
"""Indentation share of the main resistance above which the quality of the rubber data is reported."""
_SMALL_CHANGE: Final = 5e-3
"""Share of the power below which a difference between two methods is not said."""
_FAILURES_SHOWN: Final = 3  # failures reported in full


class GoverningRow(NamedTuple):
    """A governing figure as text: subject, value, place and case."""

    subject: str
    value: str
    where: str


def _tension_place(result: CalculatedConveyor, state: MotionState, tension: float) -> str:
    """Place in the loop of a tension of a state."""
    for drive in state.drives:
        if tension in {drive.arriving, drive.leaving}:
            return drive.name
    for stretch, start, end in zip(result.line.loop.stretches, state.starts, state.ends, strict=True):
        if tension in {float(start), float(end)}:
            return f"{stretch.section}, {stretch.strand}, {'start' if tension == float(start) else 'end'}"
    return "head"


def governing_figures(assessment: Assessment) -> Table:
    """Governing figures over all loads, with the verdict as note."""
    columns = (
        Column("what governs", "text", "subject", key="subject"),
        Column("value", "text", "value"),
        Column("where and when", "text", "where", key="where"),
    )
    note = verdict_sentence(assessment.governing, assessment.system)
    rows = tuple(_governing_rows(assessment))
    return Table("governing_figures", "", "What governs the design", columns, rows, note=note)


def _governing_rows(assessment: Assessment) -> Iterator[GoverningRow]:
    a, loads, left_open = assessment.own, assessment.loads, assessment.power_range
    system = assessment.system
    power, force, mass, length = (
        display_unit(kind, system, large=True) for kind in ("power", "force", "mass", "length")
    )
    most = first_maximum(loads, lambda load: abs(load.found.governing_motor_power))
    yield GoverningRow(
        "maximum motor power",
        _motor_power_text(power, most.found.governing_motor_power),
        f"{most.label.text(system)}{_friction_text(most.found)}",
    )
    where = format_figure(a.temperature, "temperature", system)
    if left_open.effects:
        low, high = (power.said(end, 3) for end in (left_open.low, left_open.high))
        where += f"; {low} to {high} in the 90 % band of site, defaults and rubber"
    if left_open.untested:
        where += "; beyond the tested temperatures of the rubber"
    yield GoverningRow("motor power as given, expected", power.said(left_open.motor, 3), where)
    if a.line.method not in FACTOR_METHODS:
        yield _classical_power(a, power)
    installed = [drive.power for drive in a.line.drives if drive.power is not None]
    if installed:
        yield GoverningRow("installed power", power.said(sum(installed), 3), f"{len(installed)} driven pulleys"
                           if len(installed) > 1 else a.line.drives[0].name)  # fmt: skip
    for motor in assessment.motors:
        yield GoverningRow(
            f"selected standard motors, {motor.drive}", f"{motor.count} x {power.said(motor.rated, 3)}",
            f"{_motor_power_text(power, motor.needed)}, needed in {motor.case.text(system)}, reserve "
            f"{motor.reserve:.2f}",
        )  # fmt: skip
    duty, asks = assessment.take_up
    sized = [] if duty.mass is None else [f"weight {mass.said(duty.mass, 3)}"]
    sized += [] if duty.travel is None else [f"travel {length.said(duty.travel.whole, 3)}"]
    asked = f"required by {asks.text(system)}"
    yield GoverningRow(f"take-up, {duty.unit.kind}", force.said(duty.setting, 3), "; ".join([*sized, asked]))
    states = [(load, state) for load in loads for state in load.found.motion_states]
    tightest = first_maximum(states, lambda pair: pair[1].largest)
    slackest = first_minimum(states, lambda pair: pair[1].smallest)
    for name, (load, state), newtons in (
        ("maximum belt tension", tightest, tightest[1].largest),
        ("minimum belt tension", slackest, slackest[1].smallest),
    ):
        where = f"{_tension_place(load.found, state, newtons)}; {state.name}; {load.label.text(system)}"
        yield GoverningRow(name, force.said(newtons, 3), where)
    tensions = a.balance.tensions
    sides = "T1 / T2" if trade_of(system) == "US" else "tight / slack side tension"
    yield GoverningRow(
        f"{sides} as given", f"{force.said(tensions.tight, 3)} / {force.said(tensions.slack, 3)}",
        f"steady; {force.said(tensions.tight_start, 3)} at {START}",
    )  # fmt: skip
    yield from _belt_utilisation(assessment.governing, system)
    if a.balance.forces.indentation > _DOMINANT_SHARE * abs(a.balance.forces.main):
        yield from _rubber_quality(a)


def _classical_power(a: CalculatedConveyor, power: Unit) -> GoverningRow:
    """Power by a given f, and its difference from the expected one by cause."""
    balance, classical = a.balance, a.balance.classical
    here, there = balance.power.motor, balance.layout.shaft_power(classical.motor_force)
    more = classical.total - balance.forces.total
    watts = (there - here) / more if more else 0.0
    main = {force.key for force in balance.along if force.kind == "main"}
    parts = [(name, watts * newtons) for name, newtons in balance.forces.parts.items() if name in main]
    of_parts = ", ".join(f"{name.replace('_', ' ')} {power.said(part, 3)}" for name, part in parts)
    both = f"{power.said(watts * classical.main, 3)} for {power.said(watts * balance.forces.main, 3)}"
    factors = f"f {classical.friction_factor:.4f} for {balance.friction_factor:.4f}"
    causes = (
        (f"main resistance, {factors} ({both}: {of_parts})", "main"),
        ("secondary resistances by C" if classical.secondary_by.startswith("(C") else "secondary resistances",
         "secondary"),
        ("special resistances", "special"),
        ("lift force", "lift"),
    )  # fmt: skip
    changes = [(name, watts * (getattr(classical, key) - getattr(balance.forces, key))) for name, key in causes]
    shown = [(name, change) for name, change in changes if abs(change) > _SMALL_CHANGE * abs(here)]
    said = [f"{name}: {'-' if change < 0.0 else '+'}{power.said(abs(change), 3)}" for name, change in shown]
    where = f"against the expected: {'; '.join(said)}" if said else "as expected"
    return GoverningRow(f"classical motor power, f = {classical.friction_factor:.4g}", power.said(there, 3), where)


def _friction_text(result: CalculatedConveyor) -> str:
    """Friction that the highest power has, over the computed one; empty where it is the computed one."""
    line = result.line
    name, factor = ("design", line.design_friction)
    if result.governing_motor_power < 0.0:
        name, factor = "least", line.least_friction
    return "" if factor == 1.0 else f"; {name} friction, {factor:.3g} times the expected"


def _motor_power_text(power: Unit, watts: float) -> str:
    """Motor power as text, marked if braking."""
    return power.said(abs(watts), 3) + (", braking" if watts < 0.0 else "")


def _belt_utilisation(governing: Sequence[Check], system: System) -> Iterator[GoverningRow]:
    """Belt utilisation, the higher of steady running and all states."""
    share, check = highest_use(governing, BELT_STRENGTH_CRITERIA)
    if share is not None and check is not None:
        case = AS_GIVEN if check.case is None else check.case.text(system)
        words = f"{check.subject.text(system)}: {check.found.text(system)}, {check.asked.text(system)}; {case}"
        yield GoverningRow("belt utilisation", percent(share), words)


def _rubber_quality(a: CalculatedConveyor) -> Iterator[GoverningRow]:
    """Quality of the data of each compound."""
    share, told = display_unit("share"), dict[str, list[str]]()
    known: dict[str, RubberCompound] = {}
    for strand, compound in compounds_by_strand(a.conveyor).items():
        told.setdefault(compound.name, []).append(strand)
        known[compound.name] = compound
    for name, strands in told.items():
        compound, quality = known[name], []
        if compound.kind == "measured":
            fit = compound.fit
            if fit is not None:
                quality.append(f"fit rms error E' {share.said(fit.storage_rms, 4)}, E'' {share.said(fit.loss_rms, 4)}")
        else:
            quality.append("constructed spectrum, not for design")
        factors = [cover.test_factor for strand, cover in a.contacts.covers.items() if strand in strands]
        tested = "test factor of rolling-resistance tests" if any(factors) else "no rolling-resistance tests"
        yield GoverningRow(f"rubber {name}", compound.kind, "; ".join([" and ".join(strands), *quality, tested]))


def verdict_sentence(governing: Sequence[Check], system: System) -> str:
    """Verdict in a sentence, with failures and required action."""
    count = Counter(check.verdict for check in governing)
    failed = [check for check in governing_by_criterion(governing) if check.failed]
    if failed:
        fails = "; ".join(_check_text(check, system) for check in failed[:_FAILURES_SHOWN])
        more = f"; and {len(failed) - _FAILURES_SHOWN} more" if len(failed) > _FAILURES_SHOWN else ""
        done = "; ".join(dict.fromkeys(c.why.text(system) for c in failed[:_FAILURES_SHOWN] if c.why is not None))
        first = f"Not adequate as given: {count['FAIL']} of {len(governing)} checks failed; {fails}{more}."
        return f"{first} Action required: {done}." if done else first
    margins = [(c.margin, c) for c in governing if c.verdict == "pass" and c.margin is not None]
    least = any(c.key == "take_up_tension" and margin <= _NO_MARGIN for margin, c in margins)
    words = f"Adequate as given: all {count['pass']} criteria checked are met"
    if least:
        margins = [(margin, c) for margin, c in margins if c.key not in _TAKE_UP_CRITERIA]
        words += "; the take-up holds the least that grip and sag ask for"
    if margins:
        margin, nearest = min(margins, key=lambda each: each[0])
        words += (
            f"; {'otherwise ' if least else ''}least margin {display_unit('margin', system).written(margin)}, "
            f"{_check_text(nearest, system)}"
        )
    missing = [check for check in governing if check.verdict == "not checked"]
    if missing:
        listed = "; ".join(f"{check.name.text(system)} ({check.asked.text(system)})" for check in missing)
        words += f". Action required for what is not checked: {listed}"
    return f"{words}."


def _check_text(check: Check, system: System) -> str:
    case = "" if check.case is None else f" ({check.case.text(system)})"
    return f"{check.name.text(system)}: {check.found.text(system)}, {check.asked.text(system)}{case}"
