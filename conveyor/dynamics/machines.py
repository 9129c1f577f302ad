"""Motors, brakes and take-up of scenarios over time, and the initial state of the belt."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.dynamics.belt_chain import SPEED_POINTS, Chain, InitialState, Machines
from conveyor.dynamics.cut_loop import Cells, CutLoop
from conveyor.errors import NoSolutionError
from conveyor.laws.motion import start_force, typical_reduced_mass
from conveyor.laws.waves import (
    BELT_RETARDATION,
    DRIVE_DRAG,
    MOTOR_SLIP,
    STEEPEST_SLOPE,
    TORQUE_LIMIT,
    ramp_speed,
)
from conveyor.line.belt_body import BeltBody
from conveyor.line.drive_scenarios import ScenarioUnit, StarterUnit
from conveyor.line.drive_units import DriveUnit
from conveyor.units.sentences import Message

Array = NDArray[np.float64]

_TOP = 1.2  # of full speed, up to which motor limits are tabulated; constant beyond
_AFTER = 3.0  # wave round trips simulated after the last event


@dataclass(frozen=True, eq=False)
class ScenarioSetup:
    """A scenario on a loaded belt, ready for simulation.

    Attributes
    ----------
    scene : ScenarioUnit
        The scenario.
    loop : CutLoop
        The belt with its bulk.
    given : CutLoop
        The belt under the spec's own load, for which the starters are set.
    setting : float
        Take-up setting [N].
    units, braking : tuple or None
        Starters and brake forces [N] of every drive, instead of those of scenario and line.
    """

    scene: ScenarioUnit
    loop: CutLoop
    given: CutLoop
    setting: float
    units: tuple[StarterUnit, ...] | None = None
    braking: tuple[float, ...] | None = None

    @property
    def drives(self) -> tuple[DriveUnit, ...]:
        """Drives of the conveyor."""
        return self.loop.line.drives

    @cached_property
    def starters(self) -> tuple[StarterUnit, ...]:
        """Starter of every drive, with a time if needed."""
        return self.units or tuple(self._starter(drive) for drive in self.drives)

    @property
    def brakes(self) -> tuple[float, ...]:
        """Brake force of every drive at the belt [N]."""
        return self.braking or tuple(self.loop.line.brakes)

    def _starter(self, drive: DriveUnit) -> StarterUnit:
        line = self.loop.line
        unit = self.scene.starter or drive.starter
        if unit is None:
            direct = line.start_factor is None and bool(line.torque_curve)
            unit = StarterUnit("direct" if direct else "inverter", "S", None, None, 0.0, 1.0, None,
                               MOTOR_SLIP.value, ("kind", "slip"))  # fmt: skip
        if unit.kind == "direct" or unit.time is not None:
            return unit
        rigid = self.given.steady.motions.start.time
        if rigid is None:
            raise NoSolutionError(f'drive "{drive.name}" does not reach full speed: give its starter a time')
        time = rigid * STEEPEST_SLOPE[unit.ramp] if unit.kind == "inverter" else rigid
        return replace(unit, time=time, stop_time=unit.stop_time or time, assumed=(*unit.assumed, "time"))

    @cached_property
    def rated(self) -> Array:
        """Rated motor force at the belt [N]; if not given, the largest steady one of loaded belt or spec."""
        line, torques = self.loop.line, []
        for drive in self.drives:
            if drive.power is None:
                largest = max(
                    abs(self.loop.steady.balance.equilibrium.force), abs(self.given.steady.balance.equilibrium.force)
                )
                torques.append(max(drive.share, 1.0 / len(self.drives)) * largest)
            else:
                torques.append(start_force(drive.power, torque_factor=1.0, efficiency=line.efficiency,
                                         rated_belt_speed=line.speed))  # fmt: skip
        return np.array(torques)

    @cached_property
    def rims(self) -> Array:
        """Rotating masses of the drives at the belt [kg]; if not given, typical of the rated force."""
        line = self.loop.line
        return np.array([
            drive.reduced_mass
            or typical_reduced_mass(force * line.speed / line.efficiency, belt_speed=line.speed)
            for drive, force in zip(self.drives, self.rated.tolist(), strict=True)
        ])  # fmt: skip

    @cached_property
    def backstops(self) -> NDArray[np.bool_]:
        """True for drives with a backstop: the first if the spec says nothing and the belt would roll back."""
        if all(drive.backstop is None for drive in self.drives):
            rolls = self.loop.steady.motions.rolls_back and self.loop.steady.motions.brake_to_hold > 0.0
            return np.array([rolls and i == 0 for i in range(len(self.drives))])
        return np.array([bool(drive.backstop) for drive in self.drives])

    @property
    def assumed_backstop(self) -> bool:
        """True if a backstop is assumed that the spec does not name."""
        return bool(self.backstops.any()) and all(drive.backstop is None for drive in self.drives)

    @cached_property
    def duration(self) -> float:
        """Duration as given, or to the end of the last ramp or the rest of a rigid belt plus some round trips [s]."""
        if self.scene.duration is not None:
            return self.scene.duration
        equilibrium = self.loop.steady.balance.equilibrium
        friction = self.scene.friction * (equilibrium.force - self.loop.weight.sum()) + self.loop.weight.sum()
        mass = self.loop.mass.sum() + self.rims.sum()
        coasting = mass * self.loop.line.speed / friction if friction > 0.0 else 60.0
        last = 0.0
        for happening in self.scene.drive_events:
            starters = [self.starters[d] for d in happening.drives]
            takes = {
                "start": max(unit.delay + (unit.time or coasting) for unit in starters),
                "ramp down": max(unit.stop_time or 1.2 * coasting for unit in starters),
                "power off": 1.2 * coasting,
                "brake": 1.2 * coasting,
            }[happening.do]
            last = max(last, happening.at + takes)
        heavy = float(self.rims.sum() / self.loop.mass.sum())
        swing = 2.0 * math.pi * math.sqrt(heavy) if heavy > 1.0 else 1.0  # of drives on a belt lighter than they are
        return last + _AFTER * swing * float(self.loop.travel[-1])

    def over_time(self, times: Array) -> tuple[Array, Array, Array]:
        """Reference over no-load speed, share of the torque limit, brake force, each (steps, d).

        Raises
        ------
        NoSolutionError
            A drive without an inverter has the command to ramp down.
        """
        columns = [self._of_drive(d, times) for d in range(len(self.drives))]
        reference, share, brake = (np.stack(parts, axis=1) for parts in zip(*columns, strict=True))
        return reference, share, brake

    def _of_drive(self, d: int, times: Array) -> tuple[Array, Array, Array]:
        """The same for one drive; later commands override earlier ones."""
        unit, force = self.starters[d], self.brakes[d]
        reference = np.full(times.size, float(self.scene.running))
        share, brake = reference, force * (1.0 - reference)
        for told in self.scene.drive_events:
            if d not in told.drives:
                continue
            since = times - told.at - (unit.delay if told.do == "start" else 0.0)
            now = since >= 0.0
            if told.do == "brake":
                grown = np.clip(since / told.over, 0.0, 1.0) if told.over else 1.0
                brake = np.where(now, told.share * force * grown, brake)
            elif told.do == "power off":
                share = np.where(now, 0.0, share)
            elif told.do == "start":
                led: Array = np.ones_like(times)
                if unit.kind == "inverter" and unit.time:  # all drives share one ramp, whenever they are switched on
                    led = ramp_speed((times - told.at) / unit.time, shape=unit.ramp)
                reference = np.where(now, led, reference)
                share, brake = np.where(now, _torque_share(unit, since), share), np.where(now, 0.0, brake)
            else:
                time = self._stop_time(d)
                led = float(np.interp(told.at, times, reference)) * (1.0 - ramp_speed(since / time, shape=unit.ramp))
                reference = np.where(now, led, reference)
                over = since > time  # then power off and brake on
                share, brake = np.where(over, 0.0, share), np.where(over, force, brake)
        return reference, share, brake

    def _stop_time(self, d: int) -> float:
        unit = self.starters[d]
        if unit.kind != "inverter" or unit.stop_time is None:
            raise NoSolutionError(
                f'drive "{self.drives[d].name}" has no inverter ({unit.kind}) and cannot ramp down; say "power off", '
                "or give it a starter"
            )
        return unit.stop_time

    def limits(self) -> Array:
        """Force limit of every motor over speed [N], shape (d, points)."""
        line = self.loop.line
        over = _TOP * np.linspace(0.0, 1.0, SPEED_POINTS)
        curve = line.torque_curve or ((0.0, TORQUE_LIMIT.value), (1.0, TORQUE_LIMIT.value))
        torque = np.interp(over, *np.transpose(curve))
        most = max(value for _, value in curve)
        each = [
            (unit.limit or most) * np.ones_like(over) if unit.kind == "inverter"
            else np.minimum(torque, unit.limit or math.inf)
            for unit in self.starters
        ]  # fmt: skip
        return np.asarray(self.rated[:, None] * np.array(each))


@dataclass(frozen=True, eq=False)
class ScenarioSize:
    """Size determined for a scenario.

    Attributes
    ----------
    scenario : str
        Its name.
    label, kind : str
        Label of the size, and its kind of quantity.
    value : float
        SI.
    error : float or None
        Relative distance to the next smaller value tried [-]; None if the smallest tried passes.
    most : float or None
        The largest value tried that passes; None if every larger one does.
    governs, why : Message
        Check that fails at the next smaller value; for a delay the one with the least margin.
    setup : ScenarioSetup
        The scenario at this size.
    """

    scenario: str
    label: str
    kind: str
    value: float
    error: float | None
    most: float | None
    governs: Message
    why: Message
    setup: ScenarioSetup


def _torque_share(unit: StarterUnit, since: Array) -> Array:
    """Share of the motor's torque passed by its starter."""
    if unit.fill:
        return np.asarray(np.interp(since, *np.transpose(unit.fill)))
    if unit.kind in {"direct", "inverter"} or unit.time is None:
        return np.ones_like(since)
    x = np.clip(since / unit.time, 0.0, 1.0)
    if unit.kind == "star-delta":
        return np.where(x < 1.0, 1.0 / 3.0, 1.0)
    if unit.kind == "fluid coupling":
        return unit.initial + (1.0 - unit.initial) * x
    root = math.sqrt(unit.initial)  # torque is as the square of the voltage
    return np.asarray((root + (1.0 - root) * x) ** 2)


def prepare_belts(setups: list[ScenarioSetup], step: Array | float) -> tuple[list[Cells], Chain, InitialState]:
    """Cells and chain of all scenarios, padded with idle cells, and their initial state.

    Cells are as long as a wave travels in a step [s], of all or of each.
    """
    steps = np.broadcast_to(step, len(setups)).tolist()
    cells = [
        setup.loop.cut_into_cells(one, filled=not setup.scene.running) for setup, one in zip(setups, steps, strict=True)
    ]
    most = max(one.at.size for one in cells)

    def filled(parts: list[Array], rest: float, size: int) -> Array:
        return np.array([
            np.pad(part, [(0, 0)] * (part.ndim - 1) + [(0, size - part.shape[-1])], constant_values=rest)
            for part in parts
        ])  # fmt: skip

    line = setups[0].loop.line
    unit, friction = line.take_up, np.array([setup.scene.friction for setup in setups])
    begun = [_initial_balance(setup, one) for setup, one in zip(setups, cells, strict=True)]
    held = np.array([tension[0] for _, tension, _ in begun])
    weight = (
        0.0
        if unit.kind in {"winch", "fixed", "screw", "locked winch"}
        else unit.reeving / (unit.strands * line.gravity)
    )
    carriage = np.inf if unit.keeps_length else weight * held + unit.carriage / unit.strands**2
    speed, band, run_up = unit.winch or (0.0, 0.0, None)
    chain = Chain(
        mass=filled([one.mass for one in cells], 1.0, most),
        stiffness=filled([one.stiffness for one in cells], 0.0, most - 1),
        retardation=belt_retardation(line.belt),
        weight=filled([one.weight for one in cells], 0.0, most),
        friction=np.moveaxis(filled([one.friction for one in cells], 0.0, most), 1, 0) * friction[:, None],
        sticking=filled([one.sticking(rest) for one, rest in zip(cells, friction, strict=True)], 0.0, most),
        end=np.array([one.at.size - 1 for one in cells]),
        nodes=np.array([one.nodes for one in cells]),
        before=np.stack([
            one.before * np.array([1.0, 1.0, rest, rest, rest, rest])[:, None]
            for one, rest in zip(cells, friction.tolist(), strict=True)
        ], axis=1),
        lumps=_pad_lumps(cells),
        rim=np.array([setup.rims for setup in setups]),
        grip=np.array([[math.expm1(drive.friction * drive.wrap_angle) for drive in setup.drives] for setup in setups]),
        backstop=np.array([setup.backstops for setup in setups]),
        held=held,
        carriage=np.broadcast_to(carriage, held.shape),
        winch=np.outer([speed * unit.strands, band, run_up or 1.0], np.ones(held.size)),
        sag=filled([one.sag for one in cells], 0.0, most - 1),
        relaxing=line.belt.relaxing or (0.0, 1.0),
        known=line.speed,
    )  # fmt: skip
    moving = np.array([[line.speed * setup.scene.running] for setup in setups])
    start = InitialState(
        speed=moving * filled([np.ones(one.at.size) for one in cells], 0.0, most),
        tension=filled([tension[1:] for _, tension, _ in begun], 0.0, most - 1),
        resisting=filled([resisting for resisting, _, _ in begun], 0.0, most),
        driving=np.array([driving for _, _, driving in begun]),
        rims=moving * np.ones_like(chain.rim),
    )
    return cells, chain, start


def _pad_lumps(cells: list[Cells]) -> NDArray[np.int_]:
    """Lumps of every belt, padded with its first drive, whose friction is already included."""
    most = max(one.lumps.size for one in cells)
    return np.array([
        np.pad(one.lumps, (0, most - one.lumps.size), constant_values=one.nodes[0]) for one in cells
    ])  # fmt: skip


def belt_retardation(belt: BeltBody) -> float:
    """Retardation time τ of the belt [s]: as given, 0 with a standard solid, else the default."""
    if belt.retardation is not None:
        return belt.retardation
    return BELT_RETARDATION.value if belt.relaxing is None else 0.0


def _initial_balance(setup: ScenarioSetup, cells: Cells) -> tuple[Array, Array, Array]:
    """Initial friction, tensions (take-up, then every cell) and drive forces in equilibrium [N].

    At rest friction holds the belt as far as it can, by the same share everywhere but more where the belt would be
    slack; the first drive holds the rest by its brake or backstop.
    """
    line, friction = setup.loop.line, setup.scene.friction
    shares = np.array([drive.share for drive in setup.drives])
    if setup.scene.running:
        resisting = cells.resisting(line.speed, friction)
        driving = shares * float(resisting.sum() + cells.weight.sum())
    else:
        most = cells.sticking(friction)
        share = -float(cells.weight.sum()) / float(most.sum())
        resisting = most * min(1.0, max(-1.0, share))
        resisting = _taut_friction(setup.setting, resisting, most, cells)
        driving = np.zeros_like(shares)
        driving[0] = float(resisting.sum() + cells.weight.sum())
    against = resisting + cells.weight
    against[cells.nodes] -= driving
    along = np.concatenate([np.zeros(1), np.cumsum(against)[:-1]])
    tension = setup.setting + along
    if line.take_up.keeps_length:  # it holds the mean of the loop
        length = np.diff(cells.at)
        tension = tension - float(along[1:] @ length) / float(length.sum())
    tension[1:] = np.maximum(tension[1:], cells.slack)  # slack from the start: its check reports it
    return resisting, tension, driving


def _taut_friction(setting: float, resisting: Array, most: Array, cells: Cells) -> Array:
    """Friction at rest that keeps the belt taut as far as possible [N]."""
    weight = cells.weight
    tension = setting + np.cumsum(resisting + weight)[:-1]
    for i in range(1, tension.size):
        tension[i] = max(tension[i], cells.slack[i], tension[i - 1] + weight[i] - most[i])
    for i in range(tension.size - 2, -1, -1):
        tension[i] = max(tension[i], tension[i + 1] - weight[i + 1] - most[i + 1])
    held = np.append(np.diff(tension, prepend=setting) - weight[:-1], resisting[-1])
    return np.asarray(np.clip(held, -most, most))


def machines_over_time(setups: list[ScenarioSetup], start: InitialState, step: Array, lasts: Array) -> Machines:
    """Motors and brakes of scenarios over their steps [s]; running drives start in their steady state."""
    line = setups[0].loop.line
    reference, share, brake = tables = np.zeros((3, int(lasts.max()), *start.rims.shape))
    for i, setup in enumerate(setups):
        tables[:, : lasts[i], i] = setup.over_time(step[i] * np.arange(lasts[i]))
    rated = np.array([setup.rated for setup in setups])
    slip = np.array([[unit.slip for unit in setup.starters] for setup in setups])
    slope = rated / (slip * line.speed)
    steady = np.array([
        [drive.share * setup.loop.steady.balance.equilibrium.force for drive in setup.drives] for setup in setups
    ])  # fmt: skip
    running = np.array([[setup.scene.running] for setup in setups])
    level = line.speed + np.where(running, start.driving, steady) / slope
    limits = np.array([setup.limits() for setup in setups])
    drag = DRIVE_DRAG.value * (1.0 / line.efficiency - 1.0) * rated
    return Machines(slope, reference * level, share, brake, limits, _TOP * line.speed, drag)
