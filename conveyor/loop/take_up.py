"""One take-up for every load of a conveyor: its setting, its mass, its travel."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from conveyor.errors import NoSolutionError
from conveyor.laws.take_up import (
    PERMANENT_STRETCH_STEEL_CORD,
    PERMANENT_STRETCH_TEXTILE,
    STEEL_EXPANSION,
    Travel,
    follow_speed,
    take_up_mass,
    take_up_travel,
)
from conveyor.line.line import BeltBody, Line, TakeUpUnit
from conveyor.loop.balance import Balance, held
from conveyor.loop.tensions import MotionState
from conveyor.ties import largest

_STEPS = 50  # wraps add about 1e-3 of what they are bent by: a few are enough
_SETTLED = (
    1e-12  # of the setting: no check of a tension that is a small part of it, to 1e-9, fails by what is left
)


@dataclass(frozen=True, eq=False)
class TakeUpDuty:
    """What the loads of a conveyor ask of its one take-up.

    Attributes
    ----------
    unit : TakeUpUnit
        Kind, place, strands.
    setting, needed : float
        Tension at its place, of one that keeps the belt's length the mean of the loop; the least it should be [N].
    governing : int
        Which load asks for it.
    governed_by : str
        The condition there.
    steady_means : tuple of float
        Lowest and highest mean tension of the loop in steady running [N].
    mass : float or None
        Of a gravity take-up's weight [kg]; None where the belt's length is kept.
    warmth : float
        Between the coldest and the warmest belt [K].
    travel : Travel or None
        Of its carriage; None where the belt's stiffness is not known.
    mean_change : float or None
        Change of the mean tension that `warmth` makes where the belt's length is kept [N].
    speed : float or None
        Of the carriage, to keep its tension through the hardest start [m/s]; None where the belt's length is kept or
        its stiffness is not known.
    """

    unit: TakeUpUnit
    setting: float
    needed: float
    governing: int
    governed_by: str
    steady_means: tuple[float, float]
    mass: float | None
    warmth: float
    travel: Travel | None
    mean_change: float | None
    speed: float | None


def on_one_side(loops: Sequence[Balance]) -> list[Balance]:
    """Loops at one setting, with a take-up on the slack side of the drives where that is under the first of them."""
    kept = loops[0].settled.take_up
    stand = all(one.frame.standing_on(behind=kept.behind) is one.frame for one in loops)
    return list(loops) if stand else held(loops, kept)


def at_one_setting(loops: Sequence[Balance], asking: Sequence[bool] = ()) -> list[Balance]:
    """Close loops of one conveyor under several loads at the least setting of its take-up that serves them.

    On the slack side of the drives it stands for all of them where that is under the first.

    Parameters
    ----------
    loops : sequence of Balance
        Closed at whatever setting. Where the spec gives one they all have it already.
    asking : sequence of bool
        Which of them the setting must serve; the others are closed at it. All, where none is.

    Raises
    ------
    NoSolutionError
        Every setting makes a load ask for more.
    """
    if not loops:
        return []
    if loops[0].line.take_up.tension is not None:
        return on_one_side(loops)
    kept = loops[0].settled.take_up
    served = [i for i, asks in enumerate(asking) if asks] or range(len(loops))
    kept = kept._replace(tension=max(loops[i].settled.needed for i in served))
    for _ in range(_STEPS):
        closed = held(loops, kept)
        asked = max(closed[i].settled.needed for i in served)
        if math.isclose(kept.tension, asked, rel_tol=_SETTLED):
            return closed
        kept = kept._replace(tension=asked)
    raise NoSolutionError(
        "no setting of the take-up serves every load: each makes one ask for more; check pulley diameters"
    )


def take_up_duty(
    loops: Sequence[Balance], states: Sequence[Iterable[MotionState]], temperatures: Iterable[float]
) -> TakeUpDuty:
    """What several loads ask of the take-up.

    Parameters
    ----------
    loops : sequence of Balance
        Of every load, at one setting.
    states : sequence of iterable of MotionState
        Every state of motion under each load.
    temperatures : iterable of float
        Of the belt [K].
    """
    line = loops[0].line
    governing = largest(range(len(loops)), lambda i: loops[i].settled.needed)
    settled = loops[governing].settled
    means = [loop.settled.steady.mean(loop.line.loop.length) for loop in loops]
    every = [
        state.mean(loop.line.loop.length) for loop, of in zip(loops, states, strict=True) for state in of
    ]
    known = list(temperatures)
    warmth = max(known) - min(known)
    unit, setting, steady = line.take_up, settled.setting, (min(means), max(means))
    stiffness, strain = belt_stiffness(line.belt), _expansion(line.belt) * warmth
    travel, change = None, None
    if stiffness is not None:
        travel = take_up_travel(
            steady,
            (min(every), max(every)),
            stiffness=stiffness,
            loop_length=float(line.loop.way[-1]),
            permanent_stretch=_permanent(line.belt),
            thermal_strain=strain,
            reserve=unit.reserve,
            strands=unit.strands,
        )
        change = stiffness * strain if unit.keeps_length and strain > 0.0 else None
    return TakeUpDuty(
        unit=unit,
        setting=setting,
        needed=settled.needed,
        governing=governing,
        governed_by=settled.governing,
        steady_means=steady,
        mass=None if unit.keeps_length else weight_mass(line, setting),
        warmth=warmth,
        travel=travel,
        mean_change=change,
        speed=None if stiffness is None or unit.keeps_length else _speed(loops, stiffness),
    )


def _speed(loops: Sequence[Balance], stiffness: float) -> float:
    """Of the carriage in the start that asks for most [m/s]; 0 where nothing is accelerated."""
    line, speeds = loops[0].line, [0.0]
    for loop in loops:
        start, lengths = loop.settled.unsteady, loop.line.loop.length
        if start.acceleration != 0.0:
            speeds.append(
                follow_speed(
                    start.mean(lengths) - loop.settled.steady.mean(lengths),
                    time=loop.line.speed / abs(start.acceleration),
                    stiffness=stiffness,
                    loop_length=float(line.loop.way[-1]),
                    strands=line.take_up.strands,
                )
            )
    return max(speeds)


def weight_mass(line: Line, setting: float) -> float:
    """Mass of a gravity take-up's weight at a setting [N] [kg]; none pulls where nothing is asked for."""
    unit = line.take_up
    return take_up_mass(max(setting, 0.0), reeving=unit.reeving, gravity=line.gravity, strands=unit.strands)


def belt_stiffness(belt: BeltBody) -> float | None:
    """EA of the whole belt [N], as given or as is usual."""
    per_width = belt.tensile_stiffness
    return None if per_width is None else per_width * belt.width


def _permanent(belt: BeltBody) -> float:
    """Lasting elongation [-], as given or as is usual."""
    if belt.permanent_stretch is not None:
        return belt.permanent_stretch
    return (PERMANENT_STRETCH_STEEL_CORD if belt.steel_cord else PERMANENT_STRETCH_TEXTILE).value


def _expansion(belt: BeltBody) -> float:
    """Of temperature [1/K]; textiles shrink as often as they grow, nothing usual is known."""
    return STEEL_EXPANSION.value if belt.steel_cord else 0.0
