"""What a conveyor is checked for: what was found, what is asked for, and pass or fail in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from conveyor.figures import RAISED, belt_strength, figure
from conveyor.line.roll_lives import ASKED_LIFE, shortest_life
from conveyor.line.walk import excited_band
from conveyor.loop.starting import every_state
from conveyor.models import Conveyor
from conveyor.models.checks import cross_sections
from conveyor.remarks import DEEP
from conveyor.report.case_checks import case_checks
from conveyor.report.verdicts import Check, verdict
from conveyor.units import System, is_quantity, si

if TYPE_CHECKING:
    from conveyor.calculation import Calculation
    from conveyor.line.stretches import Strand
    from conveyor.loop.belt_duty import BeltDuty, CurveCheck
    from conveyor.loop.starting import Motions
    from conveyor.studies import CalculatedStudies

_LEAST, _MOST = 1e-2, 1e6  # frequencies between which no power of ten is written [Hz]


def checks(
    analysis: Calculation, system: System = "SI", studies: CalculatedStudies | None = None
) -> tuple[Check, ...]:
    """Check an analysis: drives, take-up, belt, pulleys, curves, start and stop, rolls, rubber; its load cases.

    Parameters
    ----------
    analysis : Calculation
        What to check.
    studies : CalculatedStudies, optional
        Whose load cases are checked, too.
    system : {"SI", "US"}
        Units of what was found and asked for.

    Notes
    -----
    The limits are those of the warnings (`conveyor.remarks.loop`, `conveyor.remarks.rolls`): what fails here is said
    there with its source.
    """
    conveyor, duty, moving = analysis.conveyor, analysis.belt_duty, analysis.motions
    return (
        *_filling(conveyor, system),
        *_drives(analysis, system),
        *_take_up(analysis, system),
        *_belt(conveyor, duty, system),
        *_pulleys(duty, system),
        *(check for curve in duty.curves for check in _curve(curve, system)),
        *_start(moving, system),
        *_stop(conveyor, moving, system),
        *_bulk(moving, system),
        *_rolls(analysis),
        *_rubber(analysis, system),
        *(() if studies is None or studies.cases is None else case_checks(studies.cases, system)),
    )


def band_words(band: tuple[float, float]) -> str:
    """Write a band of frequency [Hz] for people.

    Examples
    --------
    >>> band_words((154.31, 2605.4)), band_words((7.7e-4, 1e11))
    ('154 to 2,605 Hz', '8×10⁻⁴ to 1×10¹¹ Hz')
    """
    return f"{' to '.join(map(_frequency, band))} Hz"


def _frequency(value: float) -> str:
    if _LEAST <= value < _MOST:
        return f"{value:,.0f}" if value >= 100.0 else f"{value:.3g}"
    digit, exponent = f"{value:.0e}".split("e")
    return f"{digit}×10{str(int(exponent)).translate(RAISED)}"


def _filling(conveyor: Conveyor, system: System) -> Iterator[Check]:
    """A spec that overfills its belt is refused; how full it is remains to be said."""
    sections = cross_sections(conveyor)
    if sections is not None:
        bulk, most = sections
        found = f"{bulk / most:.0%} of the cross-section"
        yield Check(
            "filling of the belt", found, f"at most {figure(most, 'area', system)} (ISO 5048)", "pass"
        )


def _drives(analysis: Calculation, system: System) -> Iterator[Check]:
    data = analysis.balance.settled.loop.data
    for drive, side in zip(data.drives, analysis.balance.settled.steady.drives, strict=True):
        power = data.motor(side.force)
        found = figure(abs(power), "power", system) + (" (generating)" if power < 0.0 else "")
        subject = f"motor power, {drive.name}"
        if drive.power is None:
            yield Check(subject, found, "installed power not given", "not checked")
        else:
            holds = abs(power) <= drive.power
            yield Check(
                subject, found, f"at most {figure(drive.power, 'power', system)}", verdict(holds=holds)
            )


def _take_up(analysis: Calculation, system: System) -> Iterator[Check]:
    settled = analysis.balance.settled
    found = figure(settled.setting, "force", system)
    governing, short = settled.condition_name(settled.governed_by), settled.short
    for name, asked in (short or {governing: settled.needed}).items():
        yield Check(
            f"tension of the take-up ({name})",
            found,
            f"at least {figure(asked, 'force', system)}",
            verdict(holds=not short),
        )
    slackest = min(every_state(analysis.balance, analysis.motions), key=lambda state: state.smallest)
    yield Check(
        f"smallest tension of all states ({slackest.name})",
        figure(slackest.smallest, "force", system),
        "not slack: at least 0",
        verdict(holds=not slackest.slack),
    )


def _belt(conveyor: Conveyor, duty: BeltDuty, system: System) -> Iterator[Check]:
    asked = f"at least {duty.safety_needed:g} (DIN 22101:1982)"
    strength = conveyor.belt.carcass.strength
    if duty.safety_steady is None or strength is None:
        yield Check("safety of the belt, steady", "strength not given", asked, "not checked")
        return
    holds = duty.safety_steady >= duty.safety_needed
    yield Check("safety of the belt, steady", f"{duty.safety_steady:.2f}", asked, verdict(holds=holds))
    if duty.strength_needed is not None:
        yield Check(
            "strength of the belt for its splice",
            belt_strength(si(strength), system),
            f"at least {belt_strength(duty.strength_needed, system)} (DIN 22101:2002)",
            verdict(holds=si(strength) >= duty.strength_needed),
        )


def _pulleys(duty: BeltDuty, system: System) -> Iterator[Check]:
    for pulley in duty.pulleys:
        yield Check(
            f"diameter, {pulley.name} pulley",
            figure(pulley.diameter, "thickness", system),
            f"at least {figure(pulley.least, 'thickness', system)} (DIN 22101, group {pulley.group})",
            verdict(holds=pulley.large_enough),
        )


def _curve(curve: CurveCheck, system: System) -> Iterator[Check]:
    where = f"{curve.kind} curve, {curve.section}, {curve.strand}"
    for least, why in (
        (curve.lift_off, "empty belt stays down"),
        (curve.overstress, "no strip overstressed"),
        (curve.buckling, "no strip slack"),
    ):
        if least is not None:
            asked = "no radius helps" if math.isinf(least) else f"at least {figure(least, 'length', system)}"
            yield Check(
                f"{where}: {why}",
                figure(curve.radius, "length", system),
                asked,
                verdict(holds=curve.radius >= least),
            )


def _start(moving: Motions, system: System) -> Iterator[Check]:
    start = moving.start
    if start.force <= 0.0:
        return
    found = figure(start.force, "force", system)
    if start.available is not None:
        yield Check(
            "starting force, motors",
            found,
            f"at most {figure(start.available, 'force', system)}",
            verdict(holds=start.force <= start.available),
        )
    yield Check(
        "starting force after standstill",
        found,
        f"at least {figure(start.breakaway, 'force', system)}",
        verdict(holds=start.force >= start.breakaway),
    )


def _stop(conveyor: Conveyor, moving: Motions, system: System) -> Iterator[Check]:
    given = [si(drive.brake_force) for drive in conveyor.drive.pulleys if is_quantity(drive.brake_force)]
    brakes = math.fsum(given)
    found = figure(brakes, "force", system) if given else "no brake or backstop given"
    stopping = moving.coasting_least if moving.braked is None else moving.braked
    yield Check(
        "comes to rest without power",
        "does not"
        if stopping is None
        else f"in {stopping.time:,.1f} s, {figure(stopping.distance, 'length', system)}",
        "a stop, least friction",
        verdict(holds=stopping is not None),
    )
    if moving.brake_to_hold > 0.0:
        what = "backstop" if moving.rolls_back else "brake"
        yield Check(
            f"{what} that holds the loaded belt",
            found,
            f"at least {figure(moving.brake_to_hold, 'force', system)}",
            verdict(holds=brakes >= moving.brake_to_hold) if given else "not checked",
        )
    if moving.brake_to_stop is not None:
        yield Check(
            "brakes for the deceleration wanted",
            found,
            f"at least {figure(moving.brake_to_stop, 'force', system)}",
            verdict(holds=brakes >= moving.brake_to_stop),
        )


def _bulk(moving: Motions, system: System) -> Iterator[Check]:
    slip = moving.slip
    if slip is None:
        return
    if slip.sliding:
        yield Check("bulk lies on the belt", f"slides in {', '.join(slip.sliding)}", "no sliding", "FAIL")
        return
    hardest, fastest = moving.hardest
    yield Check(
        f"bulk lies still while stopping, {slip.braking_at}",
        figure(-hardest, "acceleration", system),
        f"at most {figure(-slip.braking, 'acceleration', system)}",
        verdict(holds=hardest >= slip.braking),
    )
    yield Check(
        f"bulk lies still at the start, {slip.starting_at}",
        figure(fastest, "acceleration", system),
        f"at most {figure(slip.starting, 'acceleration', system)}",
        verdict(holds=fastest <= slip.starting),
    )


def _rolls(analysis: Calculation) -> Iterator[Check]:
    strands: tuple[Strand, ...] = ("carry", "return")
    for strand in strands:
        results = [r for r in analysis.stretches if r.stretch.strand == strand]
        deepest = max(float(roll.peak.penetration) / r.surface.thickness for r in results for roll in r.rolls)
        yield Check(
            f"penetration of the cover, {strand} rolls",
            f"{deepest:.1%} of its thickness",
            f"at most {DEEP:.0%} (small strain)",
            verdict(holds=deepest <= DEEP),
        )
        life = shortest_life([r.stretch for r in results], strand, si(analysis.conveyor.belt.speed))
        if life is not None:
            subject, found = f"L10 life, {strand} idler sets", f"{life.hours:,.0f} h"
            if life.whole or life.too_short:
                asked = f"at least {ASKED_LIFE:,.0f} h"
                yield Check(subject, found, asked, verdict(holds=not life.too_short))
            else:
                yield Check(subject, found, "bearings of some rolls not given", "not checked")


def _rubber(analysis: Calculation, system: System) -> Iterator[Check]:
    conveyor = analysis.conveyor
    at = si(conveyor.ambient.belt)
    strands: tuple[Strand, ...] = ("carry", "return")
    for strand in strands:
        compound = conveyor.carry_compound if strand == "carry" else conveyor.return_compound
        band, data = excited_band(analysis.stretches, strand), compound.frequencies(at)
        subject = f"rubber data cover the excited band, {strand}"
        if band is None:
            continue
        if compound.kind == "illustrative":
            yield Check(f"rubber, {strand}", "constructed spectrum", "a measured compound", "not checked")
            continue
        found = f"{band_words(band)} at {figure(at, 'temperature', system)}"
        if data is None:
            yield Check(subject, found, "range of the data not stated", "not checked")
            continue
        asked = f"within {band_words(data)}"
        yield Check(subject, found, asked, verdict(holds=data[0] <= band[0] and band[1] <= data[1]))
