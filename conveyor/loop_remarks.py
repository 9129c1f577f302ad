"""What a reader must know of tensions, drives, take-up, start and stop, curves, belt and pulleys."""

from __future__ import annotations

import math
from collections.abc import Iterator

from conveyor.balance import Balance
from conveyor.belt_duty import BeltDuty, belt_duty
from conveyor.line import StretchResult
from conveyor.models import Conveyor
from conveyor.starting import Motions, motions
from conveyor.units import display, si

HELD = 1.0 - 1e-9
"""Of what is needed; a setting typed to the computed figure is not short of it."""


def loop_warnings(conveyor: Conveyor, results: tuple[StretchResult, ...], found: Balance) -> Iterator[str]:
    """Where the loop is strained, a default stands in, or a figure needs a second look."""
    moving = motions(conveyor, results, found)
    yield from _drives(conveyor, found)
    yield from _take_up(found)
    yield from _start(conveyor, found, moving)
    yield from _stop(conveyor, moving)
    yield from _bulk(moving)
    yield from _belt(conveyor, belt_duty(conveyor, found))


def _force(value: float) -> str:
    return display(value, "force")


def _drives(conveyor: Conveyor, found: Balance) -> Iterator[str]:
    data = found.settled.loop.data
    for drive, side in zip(data.drives, found.settled.steady.drives, strict=True):
        motor = data.motor(side.force)
        if len(data.drives) > 1 and drive.power is not None and abs(motor) > drive.power:
            yield f'"{drive.name}" needs {display(motor, "power")}, installed are {display(drive.power, "power")}'
    if found.settled.least_force < 0.0:
        given = "least_friction" in conveyor.drive.model_fields_set
        source = "" if given else ", general knowledge: f 0.012 downhill over 0.020"
        yield (
            f"drive force {_force(found.settled.least_force)} where only {data.least_friction:.0%} of the friction is "
            f"certain (drive.least_friction{source}), {_force(found.forces.total)} as computed; "
            "grip and brakes are for the former"
        )


def _take_up(found: Balance) -> Iterator[str]:
    settled = found.settled
    if settled.loop.data.take_up.tension is None:
        return
    for name, needed in settled.conditions.items():
        if settled.setting < needed * HELD:
            yield f"the take-up holds {_force(settled.setting)}, {name} asks for {_force(needed)}"


def _start(conveyor: Conveyor, found: Balance, moving: Motions) -> Iterator[str]:
    start = moving.start
    if start.force <= 0.0:
        return
    if start.available is not None and start.available < start.force:
        yield (
            f"the motors give {_force(start.available)} at the start (drive.torque_factor), "
            f"{_force(start.force)} are asked for (drive.start_factor): more power, torque or a softer start"
        )
    if start.force < start.breakaway:
        yield (
            f"the starting force of {_force(start.force)} does not overcome the resistance after standstill, up to "
            f"{_force(start.breakaway)}: raise drive.start_factor"
        )
    if "start_factor" not in conveyor.drive.model_fields_set:
        yield f"drive.start_factor not given: {conveyor.drive.start_factor:g} assumed, 1.2 to 1.5 are usual"
    for state in (*found.settled.states.values(), *moving.states.values()):
        if state.smallest < 0.0:
            yield (
                f'the belt goes slack in the state "{state.name}": down to {_force(state.smallest)}; '
                "raise the take-up's tension, or slow the stop by a flywheel or the drives"
            )


def _stop(conveyor: Conveyor, moving: Motions) -> Iterator[str]:
    brakes = math.fsum(
        si(drive.brake_force) for drive in conveyor.drive.pulleys if drive.brake_force is not None
    )
    if moving.coasting_least is None and brakes == 0.0:
        yield "the conveyor does not stop by itself and has no brake: give drive.brake_force"
    if brakes > 0.0 and moving.braked is None:
        yield f"brakes of {_force(brakes)} do not stop the conveyor"
    if moving.brake_to_hold > brakes:
        what = "a backstop" if moving.rolls_back else "a brake"
        yield f"the loaded belt needs {what} of {_force(moving.brake_to_hold)} at the belt to stay at rest"
    if moving.brake_to_stop is not None and moving.brake_to_stop > brakes:
        yield (
            f"drive.stop_deceleration asks for brakes of {_force(moving.brake_to_stop)} at the belt, "
            f"given are {_force(brakes)}"
        )


def _bulk(moving: Motions) -> Iterator[str]:
    slip = moving.slip
    if slip is None:
        return
    for section in slip.sliding:
        yield f'the bulk slides on the belt in section "{section}" at any speed: too steep for its friction'
    hardest, fastest = moving.hardest
    if not slip.sliding and hardest < slip.braking:
        yield (
            f'the bulk slides while stopping: {hardest:.3g} m/s^2, "{slip.braking_at}" allows {slip.braking:.3g}'
        )
    if not slip.sliding and fastest > slip.starting:
        yield (
            f'the bulk slides at the start: {fastest:.3g} m/s^2, "{slip.starting_at}" allows {slip.starting:.3g}'
        )


def _belt(conveyor: Conveyor, duty: BeltDuty) -> Iterator[str]:
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
                f"the splice asks for a belt of {duty.strength_needed / 1e3:.0f} N/mm (DIN 22101:2002, factors general "
                f"knowledge), given are {given / 1e3:.0f} N/mm"
            )
    for pulley in duty.pulleys:
        if not pulley.large_enough:
            size = (
                "" if pulley.next_size is None else f", of the series {display(pulley.next_size, 'length')}"
            )
            yield (
                f'pulley "{pulley.name}" is {display(pulley.diameter, "length")} in diameter, the carcass asks for '
                f"{display(pulley.least, 'length')}{size} (DIN 22101, group {pulley.group})"
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
                    else f"at least {display(radius, 'length')} are needed"
                )
                yield (
                    f'section "{curve.section}", {curve.strand}: {why} on the {curve.kind} curve of '
                    f"{display(curve.radius, 'length')}; {least}"
                )
