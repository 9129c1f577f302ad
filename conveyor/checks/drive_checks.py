"""Criteria of drives, brakes and backstops, of starting and stopping."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, Relation, check_against_limit, leave_open_unless_failed, pass_or_fail
from conveyor.laws.drives import DRIVE_SPEED_TOLERANCE
from conveyor.laws.motion import Stop
from conveyor.line.line import Line
from conveyor.loop.drive_duty import coasting_flywheel
from conveyor.loop.equilibrium import DESIGN, LEAST
from conveyor.loop.run_up import rated_force
from conveyor.units.sentences import Message, escape_braces, message, percent

_AT_MOST: Final[Relation] = "at most"


_AT_LEAST: Final[Relation] = "at least"


def motor_power(result: CalculatedConveyor) -> Iterator[Check]:
    """Every drive's motors give its share with the friction to design for, or hold it with the least."""
    line, motor = result.line, result.balance.layout.motor
    low, high = result.drive_forces
    designed = high > result.balance.equilibrium.force
    for drive in line.drives:
        least, most = (motor(drive.share * force, drive.share) for force in (low, high))
        certain = abs(least) > abs(most)
        power = least if certain else most
        who = "the motor" if len(line.drives) == 1 else f'"{escape_braces(drive.name)}"'
        yield check_against_limit(
            "motor_power", f"motor power, {escape_braces(drive.name)}", abs(power), "at most", drive.power, "power",
            wording=message("{}" + (" (generating)" if power < 0.0 else ""), (abs(power), "power")),
            missing="installed power not given", where=LEAST if certain else (DESIGN if designed else ""),
            why=f"{who} requires {{calculated}}, {{required}} are installed: install more power",
        )  # fmt: skip


def starting_force(result: CalculatedConveyor) -> Iterator[Check]:
    """Motor force suffices for a controlled start or the whole run-up, and for breaking away after standstill.

    With the friction to design for.
    """
    start = result.motions.design_start
    if start.force <= 0.0:
        return
    where = DESIGN if result.line.design_friction > 1.0 else ""
    if start.available is not None and start.least is not None:
        if start.asked is not None:
            why = (
                "the motors give {required} at the start (drive.torque_factor, torque_curve), {calculated} are "
                f"required (drive.start_factor, rotating masses): it is limited to {start.factor:.3g} times the steady "
                "force; more power, torque or a softer start"
            )
            given, limit, relation = start.asked, start.least, _AT_MOST
        else:
            why = (
                "the motors give at least {calculated} during run-up (drive.torque_factor, torque_curve), the belt "
                "requires {required}: more power or torque"
            )
            given, limit, relation = start.least, result.balance.equilibrium.design_force, _AT_LEAST
        yield check_against_limit(
            "starting_force", "starting force, motors", given, relation, limit, "force", why=why, where=where
        )
    given = start.standstill if result.start_of_motors is None else result.start_of_motors
    rated = rated_force(result.line)
    torque = "" if rated is None else f"; {start.breakaway / rated:.2f} times the rated torque breaks it away"
    made = check_against_limit(
        "breakaway", "starting force after standstill", given, "at least", start.breakaway, "force", where=where,
        why="the starting force of {calculated} does not overcome the resistance after standstill, up to {required}: "
        f"raise drive.start_factor or the motors' torque{torque}",
    )  # fmt: skip
    least = message(
        "at least {}, and the higher friction of the belt at rest on the plate, which is not calculated",
        (start.breakaway, "force"),
    )
    on_plates = any(section.bed is not None for section in result.line.sections)
    yield leave_open_unless_failed(made, least) if on_plates else made


def comes_to_rest(result: CalculatedConveyor) -> Iterator[Check]:
    """The conveyor stops without power, by friction alone or by its brakes; both are reported."""
    moving, brakes = result.motions, math.fsum(result.line.brakes)
    alone, stopped = moving.coasting_least, moving.braked
    why = message("the conveyor does not stop by itself and has no brake: give drive.brake_force")
    if moving.runaway is not None:
        why = message(
            "the conveyor does not stop by itself and has no brake, it runs away at {}: give drive.brake_force",
            (moving.runaway, "acceleration"),
        )
    words = _rest_text(alone, moving.runaway)
    safe = alone is not None or stopped is not None
    asked = message("a stop with the least friction" if brakes == 0.0 else "a stop with the least friction, or brakes")
    yield Check(
        "comes_to_rest", message("coast-down stop"), None if alone is None else alone.time, None,
        "duration", words, asked, pass_or_fail(holds=safe), why, _AT_MOST,
    )  # fmt: skip
    if brakes > 0.0:
        why = message("brakes of {} do not stop the conveyor", (brakes, "force"))
        yield Check(
            "comes_to_rest", message("coast-down stop, brakes on"), None if stopped is None else stopped.time,
            None, "duration", _rest_text(stopped, None), message("a stop with the least friction"),
            pass_or_fail(holds=stopped is not None), why, _AT_MOST,
        )  # fmt: skip


def _rest_text(stopping: Stop | None, runaway: float | None) -> Message:
    """Stop or runaway in words."""
    if stopping is not None:
        return message(f"in {stopping.time:,.1f} s, {{}}", (stopping.distance, "length"))
    return message("does not") if runaway is None else message("runs away at {}", (runaway, "acceleration"))


def holding_brake(result: CalculatedConveyor) -> Iterator[Check]:
    """A brake or backstop holds the loaded belt, and brakes give the required deceleration."""
    moving, line = result.motions, result.line
    given = any(drive.brake is not None for drive in line.drives)
    brakes = math.fsum(line.brakes)
    where = LEAST if line.least_friction < 1.0 else ""
    if moving.brake_to_hold > 0.0:
        bear = _backstop_forces(line) if moving.rolls_back else ()
        blind = moving.rolls_back and not bear and any(drive.backstop is True for drive in line.drives)
        what = "backstop" if moving.rolls_back and (bear or blind or not given) else "brake"
        known = (given and not blind) or bool(bear)
        none = "no brake and no backstop torque given" if moving.rolls_back else "no brake given"
        none = "torque of the backstop not given" if blind else none
        made = check_against_limit(
            "holding_brake", f"holding {what}, loaded belt", math.fsum((brakes, *bear)), "at least",
            moving.brake_to_hold, "force", source=f"lift less {percent(line.least_friction)} of the friction",
            wording=None if known else message(none), where=where,
            why=f"the loaded belt needs a {what} of {{required}} at the belt to stay at rest",
        )  # fmt: skip
        yield made if known else replace(made, verdict="not checked")
    if moving.brake_to_stop is not None:
        yield check_against_limit(
            "stopping_brake", "brakes for the specified deceleration", brakes, "at least", moving.brake_to_stop,
            "force", wording=None if given else message("no brake given"), where=where,
            why="drive.stop_deceleration requires brakes of {required} at the belt, given: {calculated}",
        )  # fmt: skip


def _backstop_forces(line: Line) -> tuple[float, ...]:
    """Forces at the belt of the backstops of given torque [N]."""
    parts = ((drive.parts, drive.radius) for drive in line.drives)
    return tuple(
        part.backstop / radius
        for part, radius in parts
        if part is not None and part.backstop is not None and radius is not None
    )


def drive_speed(result: CalculatedConveyor) -> Iterator[Check]:
    """Motor, gear and pulley of every drive move the belt at its speed; where the spec gives all three."""
    speed = result.line.speed
    for drive in result.line.drives:
        parts = drive.parts
        if parts is None or parts.rotation is None or parts.ratio is None or drive.radius is None:
            continue
        rim, name = 2.0 * math.pi * drive.radius * parts.rotation / parts.ratio, escape_braces(drive.name)
        yield check_against_limit(
            "drive_speed", f"belt speed by motor, gear and pulley, {name}", abs(rim / speed - 1.0), "at most",
            DRIVE_SPEED_TOLERANCE, "share", wording=message("{}", (rim, "speed")),
            asked=message(f"within {percent(DRIVE_SPEED_TOLERANCE)} of {{}} (general knowledge)", (speed, "speed")),
            why=message(f'"{name}": motor_speed, gear_ratio {parts.ratio:g} and a pulley of {{}} move the belt at '
                        "{}, belt.speed is {}: correct one of them (of a motor led by an inverter, motor_speed is that "
                        "at belt.speed)", (2.0 * drive.radius, "length"), (rim, "speed"), (speed, "speed")),
        )  # fmt: skip


def drive_parts(result: CalculatedConveyor) -> Iterator[Check]:
    """Parts of the drives, starts an hour and uncontrolled load sharing are within their limits; where given."""
    motor = result.balance.layout.motor
    for duty in result.drive_duty:
        name, parts, installed = escape_braces(duty.drive.name), duty.parts, duty.drive.power
        if parts.backstop is not None and duty.backstop is not None:
            yield check_against_limit(
                "backstop_torque", f"torque of the backstop, {name}", duty.backstop, "at most", parts.backstop,
                "torque", where="holding" if duty.backstop == duty.holding else "motors stalled",
                why=f'the backstop of "{name}" bears {{required}}, {{calculated}} are asked of it',
            )  # fmt: skip
        for part, asked, rated in (
            ("gear", duty.gear_torque, parts.gearbox), ("coupling", duty.coupling_torque, parts.coupling)
        ):  # fmt: skip
            if asked is not None and rated is not None:
                yield check_against_limit(
                    f"{part}_torque", f"torque of the {part}, {name}", asked, "at most", rated, "torque",
                    why=f'the {part} of "{name}" is rated for {{required}}, the motor asks for {{calculated}} with '
                    f"the service factor {parts.service:g}: a larger one (drive.service_factor)",
                )  # fmt: skip
        if parts.heat is not None and duty.heat is not None:
            yield check_against_limit(
                "brake_heat", f"heat of a stop in the brake, {name}", duty.heat, "at most", parts.heat, "heat",
                why=f'a stop leaves {{calculated}} in the brake of "{name}", it bears {{required}}',
            )  # fmt: skip
        if parts.starts is not None and duty.allowed_starts is not None:
            yield _motor_starts_check(name, parts.starts, duty.allowed_starts)
        if duty.shared is not None and installed is not None:
            yield check_against_limit(
                "load_sharing", f"motor power by uncontrolled sharing, {name}",
                abs(motor(duty.shared, duty.drive.share)), "at most",
                installed, "power",
                why=f'"{name}" takes {{calculated}} where nothing but the belt couples the drives, installed: '
                "{required}; control the sharing, or choose motors of more slip and pulleys alike",
            )  # fmt: skip


def _motor_starts_check(name: str, asked: float, allowed: float | str) -> Check:
    subject = message(f"starts an hour, {name}")
    if isinstance(allowed, str):
        wanted = message("{}", (asked, "number"))
        return Check("motor_starts", subject, asked, None, "number", wanted, message(allowed), "not checked")
    return check_against_limit(
        "motor_starts", subject, asked, "at most", allowed, "number",
        asked=message(f"at most {allowed:.2f} (NEMA MG 10)"),
        why=f'the motors of "{name}" bear {allowed:.2g} starts an hour of this load (NEMA MG 10), {asked:g} are asked '
        "for: a coupling or an inverter",
    )  # fmt: skip


def coasting_time(result: CalculatedConveyor) -> Iterator[Check]:
    """Coasting without power and brakes lasts the required time at design friction, or a flywheel is named."""
    wanted, stopped = result.line.coast_time, result.motions.coasting_design
    if wanted is None or stopped is None:
        return
    inertia = coasting_flywheel(result.line, result.motions)
    figures = () if inertia is None else ((inertia, "inertia"),)
    cure = ": a flywheel of {} at the motors' shafts" if figures else ""
    why = message(f"the conveyor coasts for {stopped.time:,.1f} s, {wanted:,.1f} s are wanted{cure}", *figures)
    yield check_against_limit(
        "coasting_time", "coasting without power", stopped.time, "at least", wanted, "time", why=why,
        wording=message(f"{stopped.time:,.1f} s"), asked=message(f"at least {wanted:,.1f} s"),
    )  # fmt: skip
