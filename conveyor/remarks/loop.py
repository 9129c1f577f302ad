"""What a reader must know of tensions, drives, take-up, start and stop, curves, belt and pulleys."""

from __future__ import annotations

import math
from collections.abc import Iterator

from conveyor.figures import belt_strength, figure
from conveyor.line.walk import StretchResult
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.starting import Motions, every_state, motions
from conveyor.models import Conveyor
from conveyor.units import System, si


def loop_warnings(conveyor: Conveyor, results: tuple[StretchResult, ...], found: Balance) -> Iterator[str]:
    """Where the loop is strained, a default stands in, or a figure needs a second look."""
    moving, units = motions(conveyor, results, found), conveyor.report.units
    yield from _drives(conveyor, found)
    yield from _take_up(found, units)
    yield from _start(conveyor, moving)
    yield from _slack(found, moving, units)
    yield from _stop(conveyor, moving)
    yield from _bulk(moving, units)
    yield from _belt(conveyor, belt_duty(conveyor, found))


def _force(value: float, units: System) -> str:
    return figure(value, "force", units)


def _drives(conveyor: Conveyor, found: Balance) -> Iterator[str]:
    units = conveyor.report.units
    data = found.settled.loop.data
    for drive, side in zip(data.drives, found.settled.steady.drives, strict=True):
        motor = data.motor(side.force)
        if len(data.drives) > 1 and drive.power is not None and abs(motor) > drive.power:
            installed = figure(drive.power, "power", units)
            yield f'"{drive.name}" needs {figure(motor, "power", units)}, installed are {installed}'
    if found.settled.least_force < 0.0:
        given = "least_friction" in conveyor.drive.model_fields_set
        source = "" if given else ", general knowledge: f 0.012 downhill over 0.020"
        yield (
            f"drive force {_force(found.settled.least_force, units)} where only {data.least_friction:.0%} of the "
            f"friction is certain (drive.least_friction{source}), {_force(found.forces.total, units)} as computed; "
            "grip and brakes are for the former"
        )


def _take_up(found: Balance, units: System) -> Iterator[str]:
    settled = found.settled
    for name, needed in settled.short.items():
        yield f"the take-up holds {_force(settled.setting, units)}, {name} asks for {_force(needed, units)}"


def _start(conveyor: Conveyor, moving: Motions) -> Iterator[str]:
    units = conveyor.report.units
    start = moving.start
    if "start_factor" not in conveyor.drive.model_fields_set:
        yield f"drive.start_factor not given: {conveyor.drive.start_factor:g} assumed, 1.2 to 1.5 are usual"
    if start.force <= 0.0:
        return
    if start.available is not None and start.available < start.force:
        yield (
            f"the motors give {_force(start.available, units)} at the start (drive.torque_factor), "
            f"{_force(start.force, units)} are asked for (drive.start_factor): more power, torque or a softer start"
        )
    if start.force < start.breakaway:
        yield (
            f"the starting force of {_force(start.force, units)} does not overcome the resistance after "
            f"standstill, up to {_force(start.breakaway, units)}: raise drive.start_factor"
        )


def _slack(found: Balance, moving: Motions, units: System) -> Iterator[str]:
    for state in every_state(found, moving):
        if state.slack:
            yield (
                f'the belt goes slack in the state "{state.name}": down to {_force(state.smallest, units)}; '
                "raise the take-up's tension, or slow the stop by a flywheel or the drives"
            )


def _stop(conveyor: Conveyor, moving: Motions) -> Iterator[str]:
    units = conveyor.report.units
    brakes = math.fsum(
        si(drive.brake_force) for drive in conveyor.drive.pulleys if drive.brake_force is not None
    )
    if moving.coasting_least is None and brakes == 0.0:
        yield "the conveyor does not stop by itself and has no brake: give drive.brake_force"
    if brakes > 0.0 and moving.braked is None:
        yield f"brakes of {_force(brakes, units)} do not stop the conveyor"
    if moving.brake_to_hold > brakes:
        what = "a backstop" if moving.rolls_back else "a brake"
        yield f"the loaded belt needs {what} of {_force(moving.brake_to_hold, units)} at the belt to stay at rest"
    if moving.brake_to_stop is not None and moving.brake_to_stop > brakes:
        yield (
            f"drive.stop_deceleration asks for brakes of {_force(moving.brake_to_stop, units)} at the belt, "
            f"given are {_force(brakes, units)}"
        )


def _bulk(moving: Motions, units: System) -> Iterator[str]:
    slip = moving.slip
    if slip is None:
        return
    for section in slip.sliding:
        yield f'the bulk slides on the belt in section "{section}" at any speed: too steep for its friction'
    hardest, fastest = moving.hardest
    if not slip.sliding and hardest < slip.braking:
        yield (
            f'the bulk slides while stopping: {figure(hardest, "acceleration", units)}, "{slip.braking_at}" allows '
            f"{figure(slip.braking, 'acceleration', units)}"
        )
    if not slip.sliding and fastest > slip.starting:
        yield (
            f'the bulk slides at the start: {figure(fastest, "acceleration", units)}, "{slip.starting_at}" allows '
            f"{figure(slip.starting, 'acceleration', units)}"
        )


def _belt(conveyor: Conveyor, duty: BeltDuty) -> Iterator[str]:
    units = conveyor.report.units
    if duty.safety_steady is not None and duty.safety_steady < duty.safety_needed:
        yield (
            f"safety of the belt {duty.safety_steady:.2f} in steady running, {duty.safety_needed:g} are classic "
            "(DIN 22101:1982, general knowledge)"
        )
    strength = conveyor.belt.carcass.strength
    if strength is not None and duty.strength_needed is not None:
        given = si(strength)
        if given < duty.strength_needed:
            yield (
                f"the splice asks for a belt of {belt_strength(duty.strength_needed, units)} (DIN 22101:2002, factors "
                f"general knowledge), given are {belt_strength(given, units)}"
            )
    for pulley in duty.pulleys:
        if not pulley.large_enough:
            size = (
                ""
                if pulley.next_size is None
                else f", of the series {figure(pulley.next_size, 'thickness', units)}"
            )
            yield (
                f'pulley "{pulley.name}" is {figure(pulley.diameter, "thickness", units)} in diameter, '
                f"the carcass asks for {figure(pulley.least, 'thickness', units)}{size} "
                f"(DIN 22101, group {pulley.group})"
            )
    for curve in duty.curves:
        for radius, why in (
            (curve.lift_off, "the empty belt lifts off"),
            (curve.overstress, "a strip of the belt is overstressed"),
            (curve.buckling, "a strip of the belt goes slack"),
        ):
            if radius is not None and radius > curve.radius:
                least = (
                    "no radius helps"
                    if math.isinf(radius)
                    else f"at least {figure(radius, 'length', units)} are needed"
                )
                yield (
                    f'section "{curve.section}", {curve.strand}: {why} on the {curve.kind} curve of '
                    f"{figure(curve.radius, 'length', units)}; {least}"
                )
