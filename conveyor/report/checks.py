"""What a conveyor is checked for: what was found, what is asked for, and pass or fail in words."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from conveyor.line.roll_lives import set_life
from conveyor.line.walk import excited_band
from conveyor.models import Conveyor
from conveyor.remarks import DEEP
from conveyor.remarks.loop import HELD
from conveyor.remarks.rolls import ASKED_LIFE
from conveyor.units import System, display, is_quantity, si

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.line.stretches import Strand
    from conveyor.loop.belt_duty import BeltDuty, CurveCheck
    from conveyor.loop.starting import Motions

_WHOLE = re.compile(r"^-?\d{4,}")  # grouped by thousands
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LEAST, _MOST = 1e-2, 1e6  # frequencies between which no power of ten is written [Hz]

Verdict = Literal["pass", "FAIL", "not checked"]


@dataclass(frozen=True)
class Check:
    """One check.

    Attributes
    ----------
    subject : str
        What is checked.
    found, asked : str
        What it is, and what it should be, with units.
    verdict : {"pass", "FAIL", "not checked"}
        "not checked" where the spec does not say what is needed for it.
    """

    subject: str
    found: str
    asked: str
    verdict: Verdict


def _verdict(*, holds: bool) -> Verdict:
    return "pass" if holds else "FAIL"


def checks(analysis: Analysis, system: System = "SI") -> tuple[Check, ...]:
    """Check an analysis: drives, take-up, belt, pulleys, curves, start and stop, rolls, rubber.

    Parameters
    ----------
    analysis : Analysis
        What to check.
    system : {"SI", "US"}
        Units of what was found and asked for.

    Notes
    -----
    The limits are those of the warnings (`conveyor.remarks.loop`, `conveyor.remarks.rolls`): what fails here is said
    there with its source.
    """
    conveyor, duty, moving = analysis.conveyor, analysis.belt_duty, analysis.motions
    return (
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
    )


def _shown(value: float, kind: str, system: System) -> str:
    """As reports write it: thousands grouped, powers raised, degrees with their sign."""
    written = _WHOLE.sub(lambda found: f"{int(found[0]):,}", display(value, kind, system))
    return written.replace("^2", "²").replace("^3", "³").replace(" deg", " °")


def _strength(value: float, system: System) -> str:
    return f"{value / 1e3:,.0f} N/mm" if system == "SI" else _shown(value, "line force", system)


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


def _drives(analysis: Analysis, system: System) -> Iterator[Check]:
    data = analysis.balance.settled.loop.data
    for drive, side in zip(data.drives, analysis.balance.settled.steady.drives, strict=True):
        power = data.motor(side.force)
        found = _shown(abs(power), "power", system) + (" (generating)" if power < 0.0 else "")
        subject = f"motor power, {drive.name}"
        if drive.power is None:
            yield Check(subject, found, "installed power not given", "not checked")
        else:
            holds = abs(power) <= drive.power
            yield Check(
                subject, found, f"at most {_shown(drive.power, 'power', system)}", _verdict(holds=holds)
            )


def _take_up(analysis: Analysis, system: System) -> Iterator[Check]:
    settled = analysis.balance.settled
    found = _shown(settled.setting, "force", system)
    governing = settled.condition_name(settled.governed_by)
    short = {
        name: asked
        for name, asked in settled.conditions.items()
        if settled.setting < asked * (HELD if asked > 0.0 else 1.0)
    }
    for name, asked in (short or {governing: settled.needed}).items():
        yield Check(
            f"tension of the take-up ({name})",
            found,
            f"at least {_shown(asked, 'force', system)}",
            _verdict(holds=not short),
        )
    states = (*settled.states.values(), *analysis.motions.states.values())
    slackest = min(states, key=lambda state: state.smallest)
    yield Check(
        f"smallest tension of all states ({slackest.name})",
        _shown(slackest.smallest, "force", system),
        "not slack: at least 0",
        _verdict(holds=slackest.smallest >= 0.0),
    )


def _belt(conveyor: Conveyor, duty: BeltDuty, system: System) -> Iterator[Check]:
    asked = f"at least {duty.safety_needed:g} (DIN 22101:1982)"
    strength = conveyor.belt.carcass.strength
    if duty.safety_steady is None or strength is None:
        yield Check("safety of the belt, steady", "strength not given", asked, "not checked")
        return
    holds = duty.safety_steady >= duty.safety_needed
    yield Check("safety of the belt, steady", f"{duty.safety_steady:.2f}", asked, _verdict(holds=holds))
    if duty.strength_needed is not None:
        yield Check(
            "strength of the belt for its splice",
            _strength(si(strength), system),
            f"at least {_strength(duty.strength_needed, system)} (DIN 22101:2002)",
            _verdict(holds=si(strength) >= duty.strength_needed),
        )


def _pulleys(duty: BeltDuty, system: System) -> Iterator[Check]:
    for pulley in duty.pulleys:
        yield Check(
            f"diameter, {pulley.name} pulley",
            _shown(pulley.diameter, "thickness", system),
            f"at least {_shown(pulley.least, 'thickness', system)} (DIN 22101, group {pulley.group})",
            _verdict(holds=pulley.large_enough),
        )


def _curve(curve: CurveCheck, system: System) -> Iterator[Check]:
    where = f"{curve.kind} curve, {curve.section}, {curve.strand}"
    for least, why in (
        (curve.lift_off, "empty belt stays down"),
        (curve.overstress, "no strip overstressed"),
        (curve.buckling, "no strip slack"),
    ):
        if least is not None:
            asked = "no radius helps" if math.isinf(least) else f"at least {_shown(least, 'length', system)}"
            yield Check(
                f"{where}: {why}",
                _shown(curve.radius, "length", system),
                asked,
                _verdict(holds=curve.radius >= least),
            )


def _start(moving: Motions, system: System) -> Iterator[Check]:
    start = moving.start
    if start.force <= 0.0:
        return
    found = _shown(start.force, "force", system)
    if start.available is not None:
        yield Check(
            "starting force, motors",
            found,
            f"at most {_shown(start.available, 'force', system)}",
            _verdict(holds=start.force <= start.available),
        )
    yield Check(
        "starting force after standstill",
        found,
        f"at least {_shown(start.breakaway, 'force', system)}",
        _verdict(holds=start.force >= start.breakaway),
    )


def _stop(conveyor: Conveyor, moving: Motions, system: System) -> Iterator[Check]:
    given = [si(drive.brake_force) for drive in conveyor.drive.pulleys if is_quantity(drive.brake_force)]
    brakes = math.fsum(given)
    found = _shown(brakes, "force", system) if given else "no brake or backstop given"
    stopping = moving.coasting_least if moving.braked is None else moving.braked
    yield Check(
        "comes to rest without power",
        "does not"
        if stopping is None
        else f"in {stopping.time:,.1f} s, {_shown(stopping.distance, 'length', system)}",
        "a stop, least friction",
        _verdict(holds=stopping is not None),
    )
    if moving.brake_to_hold > 0.0:
        what = "backstop" if moving.rolls_back else "brake"
        yield Check(
            f"{what} that holds the loaded belt",
            found,
            f"at least {_shown(moving.brake_to_hold, 'force', system)}",
            _verdict(holds=brakes >= moving.brake_to_hold) if given else "not checked",
        )
    if moving.brake_to_stop is not None:
        yield Check(
            "brakes for the deceleration wanted",
            found,
            f"at least {_shown(moving.brake_to_stop, 'force', system)}",
            _verdict(holds=brakes >= moving.brake_to_stop),
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
        _shown(-hardest, "acceleration", system),
        f"at most {_shown(-slip.braking, 'acceleration', system)}",
        _verdict(holds=hardest >= slip.braking),
    )
    yield Check(
        f"bulk lies still at the start, {slip.starting_at}",
        _shown(fastest, "acceleration", system),
        f"at most {_shown(slip.starting, 'acceleration', system)}",
        _verdict(holds=fastest <= slip.starting),
    )


def _rolls(analysis: Analysis) -> Iterator[Check]:
    strands: tuple[Strand, ...] = ("carry", "return")
    for strand in strands:
        results = [r for r in analysis.stretches if r.stretch.strand == strand]
        deepest = max(float(roll.peak.penetration) / r.surface.thickness for r in results for roll in r.rolls)
        yield Check(
            f"penetration of the cover, {strand} rolls",
            f"{deepest:.1%} of its thickness",
            f"at most {DEEP:.0%} (small strain)",
            _verdict(holds=deepest <= DEEP),
        )
        lives = [set_life(r.stretch, r.rolls[0].curve.contact.speed) for r in results]
        known = [life for life in lives if life is not None]
        if known:
            yield Check(
                f"L10 life, {strand} idler sets",
                f"{min(known):,.0f} h",
                f"at least {ASKED_LIFE:,.0f} h",
                _verdict(holds=min(known) >= ASKED_LIFE),
            )


def _rubber(analysis: Analysis, system: System) -> Iterator[Check]:
    conveyor = analysis.conveyor
    at = si(conveyor.ambient.belt)
    strands: tuple[Strand, ...] = ("carry", "return")
    for strand in strands:
        compound = conveyor.carry_compound if strand == "carry" else conveyor.return_compound
        band, data = excited_band(analysis.stretches, strand), compound.frequencies(at)
        subject = f"rubber data cover the excited band, {strand}"
        if band is None:
            continue
        found = f"{band_words(band)} at {_shown(at, 'temperature', system)}"
        if data is None:
            yield Check(subject, found, "range of the data not stated", "not checked")
            continue
        asked = f"within {band_words(data)}"
        yield Check(subject, found, asked, _verdict(holds=data[0] <= band[0] and band[1] <= data[1]))
