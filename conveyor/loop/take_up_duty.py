"""One take-up for all loads of a conveyor: setting, mass, travel."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from conveyor.errors import NoSolutionError
from conveyor.laws.take_up import (
    PERMANENT_STRETCH_STEEL_CORD,
    PERMANENT_STRETCH_TEXTILE,
    STEEL_EXPANSION,
    TakeUpTravel,
    follow_speed,
    take_up_mass,
    take_up_travel,
)
from conveyor.line.belt_body import BeltBody
from conveyor.line.line import Line
from conveyor.line.take_up_unit import TakeUpUnit
from conveyor.loop.balance import Balance, close_at_one_setting, with_take_up_at
from conveyor.loop.tensions import MotionState
from conveyor.loop.ties import first_maximum

_MAX_SETTING_STEPS = 50  # wraps add about 1e-3 of the tension: a few are enough
_SETTING_TOLERANCE = 1e-12  # of the setting: checks to 1e-9 pass also for tensions that are a small part of it


@dataclass(frozen=True, eq=False)
class TakeUpDuty:
    """Requirements of a conveyor's loads on its take-up.

    Attributes
    ----------
    unit : TakeUpUnit
        Kind, place, strands.
    setting, needed : float
        Tension there, or mean of the loop where it fixes the belt's length; the least needed [N].
    governing : int
        Index of the load that needs it.
    governed_by : str
        Governing condition of that load.
    mass : float or None
        Mass of a gravity take-up's weight [kg]; None where the belt's length is fixed.
    warmth : float
        Temperature difference of the coldest and the warmest belt [K].
    travel : TakeUpTravel or None
        Travel of its carriage; None if the belt's stiffness is unknown.
    mean_change : float or None
        Change of the mean tension by `warmth` where the belt's length is fixed [N].
    speed : float or None
        Speed of the carriage that keeps the tension in the hardest start [m/s]; None where the belt's length is fixed
        or its stiffness unknown.
    """

    unit: TakeUpUnit
    setting: float
    needed: float
    governing: int
    governed_by: str
    mass: float | None
    warmth: float
    travel: TakeUpTravel | None
    mean_change: float | None
    speed: float | None


def on_common_side(loops: Sequence[Balance]) -> list[Balance]:
    """Put a slack-side take-up of all loops on the side of the drives it has in the first."""
    kept = loops[0].equilibrium.take_up
    stand = all(one.layout.standing_on(behind=kept.behind) is one.layout for one in loops)
    return list(loops) if stand else with_take_up_at(loops, kept)


def at_common_setting(loops: Sequence[Balance], asking: Sequence[bool] = ()) -> list[Balance]:
    """Close loops of one conveyor under several loads at the least setting of its take-up that serves them.

    A take-up on the slack side of the drives has the side of the first load in all of them.

    Parameters
    ----------
    loops : sequence of Balance
        Loops closed at any setting; a setting of the spec they all have already.
    asking : sequence of bool
        True for loads that the setting must serve; the others are closed at it. All loads if none is.

    Raises
    ------
    NoSolutionError
        At every setting some load needs more.
    """
    if not loops:
        return []
    if loops[0].line.take_up.tension is not None:
        return on_common_side(loops)
    kept = loops[0].equilibrium.take_up
    served = [i for i, asks in enumerate(asking) if asks] or range(len(loops))
    kept = kept._replace(tension=max(loops[i].equilibrium.needed for i in served))
    closed = list(loops)
    if not all(one.is_closed_at(kept) for one in loops):
        closed = close_at_one_setting(loops, kept.behind, served)
    for _ in range(_MAX_SETTING_STEPS):  # more than once only for loops of several plans
        kept = kept._replace(tension=max(closed[i].equilibrium.needed for i in served))
        closed = with_take_up_at(closed, kept)
        if math.isclose(kept.tension, max(closed[i].equilibrium.needed for i in served), rel_tol=_SETTING_TOLERANCE):
            return closed
    raise NoSolutionError(
        "no take-up tension suits every load: each increase raises what another load needs; check pulley diameters"
    )


def take_up_duty(
    loops: Sequence[Balance], states: Sequence[Iterable[MotionState]], temperatures: Iterable[float]
) -> TakeUpDuty:
    """Setting, mass and travel of the take-up for several loads.

    Parameters
    ----------
    loops : sequence of Balance
        Loop of every load, at one setting.
    states : sequence of iterable of MotionState
        Every state of motion under each load.
    temperatures : iterable of float
        Temperatures of the belt [K].
    """
    line = loops[0].line
    governing = first_maximum(range(len(loops)), lambda i: loops[i].equilibrium.needed)
    equilibrium = loops[governing].equilibrium
    means = [loop.equilibrium.steady.mean(loop.line.loop.length) for loop in loops]
    every = [state.mean(loop.line.loop.length) for loop, of in zip(loops, states, strict=True) for state in of]
    known = list(temperatures)
    warmth = max(known) - min(known)
    unit, setting = line.take_up, equilibrium.setting
    stiffness, strain = belt_stiffness(line.belt), _thermal_expansion(line.belt) * warmth
    travel, change = None, None
    if stiffness is not None:
        travel = take_up_travel(
            (min(means), max(means)),
            (min(every), max(every)),
            stiffness=stiffness,
            loop_length=float(line.loop.way[-1]),
            permanent_stretch=_permanent_stretch(line.belt),
            thermal_strain=strain,
            reserve=unit.reserve,
            strands=unit.strands,
        )
        change = stiffness * strain if unit.keeps_length and strain > 0.0 else None
    return TakeUpDuty(
        unit=unit,
        setting=setting,
        needed=equilibrium.needed,
        governing=governing,
        governed_by=equilibrium.governing,
        mass=None if unit.keeps_length else take_up_weight_mass(line, setting),
        warmth=warmth,
        travel=travel,
        mean_change=change,
        speed=None if stiffness is None or unit.keeps_length else _carriage_speed(loops, stiffness),
    )


def _carriage_speed(loops: Sequence[Balance], stiffness: float) -> float:
    """Highest speed of the carriage in a start [m/s]; 0 without acceleration."""
    line, speeds = loops[0].line, [0.0]
    for loop in loops:
        start, lengths = loop.equilibrium.unsteady, loop.line.loop.length
        if start.acceleration != 0.0:
            speeds.append(
                follow_speed(
                    start.mean(lengths) - loop.equilibrium.steady.mean(lengths),
                    time=loop.line.speed / abs(start.acceleration),
                    stiffness=stiffness,
                    loop_length=float(line.loop.way[-1]),
                    strands=line.take_up.strands,
                )
            )
    return max(speeds)


def take_up_weight_mass(line: Line, setting: float) -> float:
    """Mass of a gravity take-up's weight [kg] at a setting [N]; 0 at a negative setting."""
    unit = line.take_up
    return take_up_mass(max(setting, 0.0), reeving=unit.reeving, gravity=line.gravity, strands=unit.strands)


def belt_stiffness(belt: BeltBody) -> float | None:
    """Tensile stiffness EA of the whole belt [N], given or usual."""
    per_width = belt.tensile_stiffness
    return None if per_width is None else per_width * belt.width


def _permanent_stretch(belt: BeltBody) -> float:
    """Permanent elongation [-], given or usual."""
    if belt.permanent_stretch is not None:
        return belt.permanent_stretch
    return (PERMANENT_STRETCH_STEEL_CORD if belt.steel_cord else PERMANENT_STRETCH_TEXTILE).value


def _thermal_expansion(belt: BeltBody) -> float:
    """Thermal expansion [1/K]; 0 for textiles, which shrink as often as they grow."""
    return STEEL_EXPANSION.value if belt.steel_cord else 0.0
