"""Take-ups: a gravity take-up keeps the tension, a fixed one the length of the belt.

Sources: statics of the carriage; Hooke (a belt of given length). A winch held at a set tension acts like a gravity
take-up, a locked one like a fixed one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from conveyor.arguments.limits import require, require_finite, require_not_negative, require_positive
from conveyor.laws.resistance.resistance_defaults import Default

LOOP_STRANDS: Final = 2  # [-], strands of belt that pull at the take-up pulley
TRAVEL_RESERVE: Final = Default(0.2, 0.1, 0.3, "travel of the take-up kept beyond the computed one", True)
PERMANENT_STRETCH_STEEL_CORD: Final = Default(
    1e-3, 0.5e-3, 2e-3, "half of the 0.2 % that handbooks give for elastic and lasting elongation", True
)  # [-]
PERMANENT_STRETCH_TEXTILE: Final = Default(
    7.5e-3, 5e-3, 15e-3, "half of the 1.5 % that handbooks give for elastic and lasting elongation", True
)  # [-]
STEEL_EXPANSION: Final = Default(
    12e-6, 11e-6, 13e-6, "steel cords; the structure and the ground taken to stay", True
)  # [1/K]

SCREW_LENGTH: Final = 90.0
"""Longest conveyor with a screw take-up [m], about 300 ft; general knowledge."""


def follow_speed(
    change: float, *, time: float, stiffness: float, loop_length: float, strands: float = LOOP_STRANDS
) -> float:
    """Carriage speed that keeps the tension through a start, ΔT L/(EA s) in half the time of the start.

    Parameters
    ----------
    change : float
        ΔT, mean tension of the loop at the start less that in steady running [N].
    time : float
        t of the start [s], positive: its force is full after half of it, as on an S ramp.
    stiffness : float
        EA of the whole belt [N], positive.
    loop_length : float
        L of the whole belt [m], positive.
    strands : float
        s, of the belt that pull at the carriage [-], positive.

    Returns
    -------
    float
        [m/s].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived (Hooke); waves along the belt need more, see `conveyor dynamics`.

    Examples
    --------
    >>> follow_speed(20e3, time=20.0, stiffness=40e6, loop_length=2000.0)
    0.05
    """
    require_finite(change=change)
    require_positive(time=time, stiffness=stiffness, loop_length=loop_length, strands=strands)
    return abs(change) * loop_length / (stiffness * strands) / (0.5 * time)


def take_up_mass(tension: float, *, reeving: float, gravity: float, strands: float = LOOP_STRANDS) -> float:
    """Mass of a gravity take-up, m = s T/(i g).

    Parameters
    ----------
    tension : float
        T of the belt at the take-up pulley [N], at least 0.
    reeving : float
        i, pull on the carriage over pull of the weight [-], positive; 1 if the weight hangs in the belt's loop.
    gravity : float
        g [m/s²], positive.
    strands : float
        s, strands of the belt that pull at the carriage [-], positive; 2 for one loop of it.

    Returns
    -------
    float
        m [kg], with pulley and frame if they hang in the loop.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Strands parallel, friction of carriage and ropes left out.

    Examples
    --------
    >>> take_up_mass(9810.0, reeving=1.0, gravity=9.81)
    2000.0
    >>> round(take_up_mass(49.0e3, reeving=1.0, gravity=9.81, strands=4) / 1e3)  # 20 t on 4 strands
    20
    """
    require_not_negative(tension=tension)
    require_positive(reeving=reeving, gravity=gravity, strands=strands)
    return strands * tension / (reeving * gravity)


def mean_tension(tensions: Sequence[float], *, lengths: Sequence[float]) -> float:
    """Mean tension of the loop, Σ T_i l_i/Σ l_i: constant with a fixed take-up (Hooke).

    Parameters
    ----------
    tensions : sequence of float
        T, or offset ΔT, mean of each section [N].
    lengths : sequence of float
        l of each section [m], at least 0, not all 0.

    Returns
    -------
    float
        Mean [N].

    Raises
    ------
    InputError
        An argument is outside its range, or the lengths of the lists differ.

    Examples
    --------
    >>> mean_tension([10e3, 30e3], lengths=[300.0, 100.0])
    15000.0
    """
    ok = len(lengths) == len(tensions)
    require(ok, "lengths", list(lengths), f"one for each of {len(tensions)} sections")
    for tension, length in zip(tensions, lengths, strict=True):
        require_finite(tensions=tension)
        require_not_negative(lengths=length)
    whole = math.fsum(lengths)
    require(whole > 0.0, "lengths", list(lengths), "a loop longer than 0")
    return math.fsum(t * length for t, length in zip(tensions, lengths, strict=True)) / whole


@dataclass(frozen=True, slots=True)
class TakeUpTravel:
    """Travel of a take-up's carriage by cause [m].

    Parameters
    ----------
    tensioning : float
        Elongation from the slack belt to the lowest mean tension that occurs.
    load : float
        Between the lowest and the highest mean tension in steady running.
    motion : float
        Beyond these while starting and stopping.
    permanent : float
        Lasting elongation.
    temperature : float
        Between the coldest and the warmest belt.
    reserve : float
        Beyond all these.
    """

    tensioning: float
    load: float
    motion: float
    permanent: float
    temperature: float
    reserve: float

    @property
    def whole(self) -> float:
        """Total travel [m]."""
        return math.fsum((self.tensioning, self.load, self.motion, self.permanent, self.temperature, self.reserve))


def take_up_travel(
    steady: tuple[float, float],
    extreme: tuple[float, float],
    *,
    stiffness: float,
    loop_length: float,
    permanent_stretch: float,
    thermal_strain: float,
    reserve: float,
    strands: float = LOOP_STRANDS,
) -> TakeUpTravel:
    """Travel of the carriage, s = ΔL/strands with ΔL = ΔT L/EA (Hooke), ε L lasting and α Δθ L of temperature.

    Parameters
    ----------
    steady : tuple of float
        Lowest and highest mean tension of the loop in steady running of any load [N].
    extreme : tuple of float
        Lowest and highest mean tension in any state of motion [N], no narrower than `steady`.
    stiffness : float
        EA of the whole belt [N], positive.
    loop_length : float
        L of the whole belt [m], positive.
    permanent_stretch : float
        Lasting elongation ε [-], at least 0.
    thermal_strain : float
        α Δθ between the coldest and the warmest belt [-], at least 0.
    reserve : float
        Of the sum, kept beyond it [-], at least 0.
    strands : float
        Of the belt that pull at the carriage [-], positive.

    Returns
    -------
    TakeUpTravel
        Travel by cause [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    One stiffness all round; sag between the idlers left out. A take-up that keeps the belt's length moves only to
    tension it: its mean tension is the same in every state.

    Examples
    --------
    >>> found = take_up_travel(
    ...     (40e3, 80e3),
    ...     (40e3, 80e3),
    ...     stiffness=40e6,
    ...     loop_length=2000.0,
    ...     permanent_stretch=1e-3,
    ...     thermal_strain=0.0,
    ...     reserve=0.0,
    ... )
    >>> found.tensioning, found.load, found.permanent, found.whole
    (1.0, 1.0, 1.0, 3.0)
    """
    require_positive(stiffness=stiffness, loop_length=loop_length, strands=strands)
    require_not_negative(permanent_stretch=permanent_stretch, thermal_strain=thermal_strain, reserve=reserve)
    ordered = extreme[0] <= steady[0] <= steady[1] <= extreme[1] < math.inf
    require(ordered, "extreme", list(extreme), f"a band that holds {list(steady)}")
    moved = loop_length / strands
    parts = (
        moved * extreme[0] / stiffness,
        moved * (steady[1] - steady[0]) / stiffness,
        moved * (steady[0] - extreme[0] + extreme[1] - steady[1]) / stiffness,
        moved * permanent_stretch,
        moved * thermal_strain,
    )
    return TakeUpTravel(*parts, reserve=reserve * math.fsum(parts))
