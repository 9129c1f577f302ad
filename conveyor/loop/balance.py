"""The whole conveyor: its forces, the tensions round the loop, the power at belt, motors and mains."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import NoSolutionError
from conveyor.force_sums import Force, ForceSums
from conveyor.forces import length_coefficient_force
from conveyor.laws.power import belt_power, specific_energy
from conveyor.laws.resistance import equivalent_friction_factor
from conveyor.line.line import Line
from conveyor.loop.equilibrium import Equilibrium, solve_equilibria
from conveyor.loop.estimates import CemaEstimate, ClassicalEstimate, cema_estimate, classical_estimate
from conveyor.loop.loop_layout import LoopLayout, TakeUpSetting
from conveyor.loop.tensions import LoopBatch, MotionState
from conveyor.units.presentation import format_figure

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TensionPoint:
    """Tension at a place of the loop in steady running [N], and the least for the sag there [N]."""

    place: str
    distance: float
    tension: float
    least_for_sag: float


@dataclass(frozen=True)
class Tensions:
    """Tensions at the drive pulleys, steady and at start, and extremes of the loop [N]; `governed_by` grip or sag."""

    tight: float
    slack: float
    tight_start: float
    governed_by: str
    largest: float
    smallest: float


@dataclass(frozen=True)
class Power:
    """Power at belt, motor shafts and mains [W], negative where the belt drives; per mass and distance [kWh/(t km)]."""

    belt: float
    motor: float
    mains: float
    energy_per_tonne_km: float | None


@dataclass(frozen=True, eq=False)
class Balance:
    """The whole conveyor.

    Attributes
    ----------
    along, singles : tuple of Force
        Forces along the belt, and those at single places: together every resistance.
    unit_main : float
        Main resistance that DIN 22101 gives for f = 1 [N].
    equilibrium : Equilibrium
        Solved loop: every drive, the take-up, the states that decide its setting.

    Examples
    --------
    >>> import conveyor
    >>> conveyor.analyse(conveyor.load("examples/specs/overland.yaml")).balance
    Balance(effective tension 215 kN, motor 1,140 kW, f 0.0117, tight side 344 kN, slack side 128 kN)
    """

    along: tuple[Force, ...]
    unit_main: float
    equilibrium: Equilibrium

    def __repr__(self) -> str:
        power, tensions = self.power, self.tensions
        return (
            f"Balance(effective tension {format_figure(self.forces.total, 'force')}, motor "
            f"{format_figure(power.motor, 'power')}, "
            f"f {self.friction_factor:.4f}, tight side {format_figure(tensions.tight, 'force')}, slack side "
            f"{format_figure(tensions.slack, 'force')})"
        )

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.equilibrium.line

    @property
    def layout(self) -> LoopLayout:
        """Layout of the loop."""
        return self.equilibrium.layout

    @property
    def singles(self) -> tuple[Force, ...]:
        """Forces at single places."""
        return self.equilibrium.singles

    @property
    def every(self) -> tuple[Force, ...]:
        """All resistances in one list."""
        return (*self.along, *self.singles)

    @cached_property
    def forces(self) -> ForceSums:
        """Resistances summed by kind."""
        return ForceSums.of(self.every)

    @cached_property
    def friction_factor(self) -> float:
        """The f that DIN 22101's main resistance would need for the same force [-]."""
        return equivalent_friction_factor(self.forces.main, unit_main_force=self.unit_main)

    @cached_property
    def tensions(self) -> Tensions:
        """Tensions at the drives and extremes of the loop."""
        steady, unsteady = self.equilibrium.steady, self.equilibrium.unsteady
        return Tensions(
            tight=max(drive.tight for drive in steady.drives),
            slack=min(drive.slack for drive in steady.drives),
            tight_start=max(drive.tight for drive in unsteady.drives),
            governed_by="take-up" if self.equilibrium.given else self.equilibrium.governed_by,
            largest=self.equilibrium.largest,
            smallest=steady.smallest,
        )

    @cached_property
    def power(self) -> Power:
        """Power in steady running."""
        line, force = self.line, self.equilibrium.force
        mains = self.layout.mains(force)
        return Power(
            belt=belt_power(force, belt_speed=line.speed),
            motor=self.layout.motor(force),
            mains=mains,
            energy_per_tonne_km=specific_energy(mains, mass_flow=line.flow, length=line.length)
            if line.flow > 0.0
            else None,
        )

    @cached_property
    def classical(self) -> ClassicalEstimate:
        """ISO 5048 / DIN 22101 with the spec's f."""
        return classical_estimate(self.line, self.forces, self.unit_main)

    @cached_property
    def cema(self) -> CemaEstimate | None:
        """Classic CEMA estimate, where the spec gives its factors; its f is the one DIN 22101 would need."""
        return cema_estimate(self.line, self.unit_main)

    @cached_property
    def tension_points(self) -> tuple[TensionPoint, ...]:
        """Tensions round the loop in steady running, from the head back to it."""
        return tuple(_tension_points(self.equilibrium, self.equilibrium.steady))

    def is_closed_at(self, kept: TakeUpSetting) -> bool:
        """True if the loop was closed with the take-up at this setting."""
        equilibrium = self.equilibrium
        stands = equilibrium.layout.standing_on(behind=kept.behind) is equilibrium.layout
        return stands and equilibrium.given and equilibrium.setting == kept.tension

    def designed_for(self, friction: float) -> Balance:
        """The loop with a friction to design for, over the computed one [-], the take-up at its setting."""
        layout = self.layout.designed_for(friction)
        if layout is self.layout:
            return self
        (found,) = raise_first_error(
            close_loops([OpenLoop.of(layout, self.along, self.unit_main, self.equilibrium.take_up)])
        )
        return found

    def held(self, setting: float) -> Balance:
        """The loop with the take-up at a setting [N]."""
        (found,) = with_take_up_at([self], self.equilibrium.take_up._replace(tension=setting))
        return found


def close_loop(layout: LoopLayout, along: tuple[Force, ...], unit_main: float, setting: float | None = None) -> Balance:
    """Close the loop of tensions around the forces along the belt.

    Parameters
    ----------
    layout : LoopLayout
        Layout of the loop.
    along : tuple of Force
        Forces along the belt.
    unit_main : float
        Main resistance for f = 1 [N].
    setting : float, optional
        Tension of the take-up [N]; by default that of the spec, else the least that serves every state.

    Raises
    ------
    NoSolutionError
        The tensions do not converge (wraps that grow faster than the tension they need).
    """
    (found,) = raise_first_error(close_loops([OpenLoop(layout, along, unit_main, setting)]))
    return found


def with_take_up_at(loops: Iterable[Balance], kept: TakeUpSetting) -> list[Balance]:
    """Loops with the take-up at a setting: those of another one are closed anew."""
    every = list(loops)
    moved = [i for i, one in enumerate(every) if not one.is_closed_at(kept)]
    asked = [OpenLoop.of(one.layout, one.along, one.unit_main, kept) for one in (every[i] for i in moved)]
    for i, one in zip(moved, raise_first_error(close_loops(asked)), strict=True):
        every[i] = one
    return every


def raise_first_error(found: Sequence[Balance | NoSolutionError]) -> list[Balance]:
    """Raise the first error among results, else return them."""
    for one in found:
        if isinstance(one, NoSolutionError):
            raise one
    return [one for one in found if isinstance(one, Balance)]


class OpenLoop(NamedTuple):
    """A loop to be closed, as `close_loop` takes it."""

    layout: LoopLayout
    along: tuple[Force, ...]
    unit_main: float
    setting: float | None = None

    @classmethod
    def of(cls, layout: LoopLayout, along: tuple[Force, ...], unit_main: float, kept: TakeUpSetting | None) -> OpenLoop:
        """Loop with the take-up at a setting, on its side of the drives."""
        if kept is None:
            return cls(layout, along, unit_main)
        return cls(layout.standing_on(behind=kept.behind), along, unit_main, kept.tension)


def close_at_one_setting(loops: Sequence[Balance], behind: bool, serving: Sequence[int]) -> list[Balance]:
    """Close loops at the least setting of the take-up that suits those at the indices `serving`, each plan's own."""
    asked = [OpenLoop(one.layout.standing_on(behind=behind), one.along, one.unit_main) for one in loops]
    marked = set(serving)
    return raise_first_error(close_loops(asked, [i in marked for i in range(len(asked))]))


def close_loops(asked: Sequence[OpenLoop], serving: Sequence[bool] = ()) -> list[Balance | NoSolutionError]:
    """Close many loops, those of one plan in one batch; no result depends on the others.

    With `serving`, those of one plan get one setting, the least that suits the loops marked; all of them if none is.
    """
    alike: dict[tuple[object, ...], list[int]] = {}
    given = [one.layout.line.take_up.tension if one.setting is None else one.setting for one in asked]
    for i, (one, setting) in enumerate(zip(asked, given, strict=True)):
        alike.setdefault((one.layout.plan.key, setting is None), []).append(i)
    found: dict[int, Balance | NoSolutionError] = {}
    for rows in alike.values():
        these = [asked[i] for i in rows]
        further = [_length_coefficient_forces(one) for one in these]
        loops = LoopBatch([one.layout for one in these], [one.along for one in these], further)
        held = [setting for i in rows if (setting := given[i]) is not None]
        marked = np.array([serving[i] for i in rows]) if serving else None
        if marked is not None and not marked.any():
            marked = ~marked
        closed, refused = solve_equilibria(loops, np.array(held) if held else None, serving=marked)
        for row, (i, one) in enumerate(zip(rows, these, strict=True)):
            if row in refused:
                found[i] = refused[row]
                continue
            made = one._replace(along=_with_flexure(one.along, closed.flexure[row]))
            equilibrium = Equilibrium(closed, row, (*one.layout.points, *_length_coefficient_forces(made)))
            found[i] = Balance(made.along, one.unit_main, equilibrium)
    return [found[i] for i in range(len(asked))]


def _with_flexure(along: tuple[Force, ...], flexure: Array) -> tuple[Force, ...]:
    """Forces along the belt with a flexure by load and sag in loop order [N]."""
    return tuple(
        force if force.at_sag_limit is None else replace(force, newtons=np.roll(flexure, flexure.size // 2))
        for force in along
    )


def _length_coefficient_forces(one: OpenLoop) -> tuple[Force, ...]:
    """Secondary resistance by the length coefficient, where it is not itemised."""
    layout = one.layout
    return (length_coefficient_force(layout.line, layout.landing, one.along),) if layout.line.secondary == "C" else ()


def _tension_points(equilibrium: Equilibrium, state: MotionState) -> Iterator[TensionPoint]:
    """Tensions round the loop in a state, from the head back to it."""
    line, shape = equilibrium.line, equilibrium.line.loop
    way: list[float] = shape.way.tolist()
    last = equilibrium.layout.boundaries[-1]
    met = sorted(zip(line.drives, state.drives, strict=True), key=lambda pair: pair[0].spot)
    at_head = [side for drive, side in met if drive.spot.boundary == last]
    head = "drive" if at_head else "head"
    between: dict[int, list[TensionPoint]] = {}
    for drive, side in met:
        at = drive.spot.boundary
        if at != last:
            between.setdefault(at, []).extend(
                TensionPoint(f"{drive.name}, {when}", way[at], tension, 0.0)
                for when, tension in (("arriving", side.arriving), ("leaving", side.leaving))
            )
    yield TensionPoint(f"{head}, leaving", 0.0, state.leaving, 0.0)
    columns = (shape.stretches, shape.least.tolist(), state.starts.tolist(), state.ends.tolist())
    for i, (stretch, least, start, end) in enumerate(zip(*columns, strict=True)):
        yield from between.get(i, ())
        name = f"{stretch.section}, {stretch.strand}"
        yield TensionPoint(f"{name}, start", way[i], start, least)
        yield TensionPoint(f"{name}, end", way[i + 1], end, least)
    arriving = at_head[0].arriving if at_head else state.arriving
    yield TensionPoint(f"{head}, arriving", way[-1], arriving, 0.0)
