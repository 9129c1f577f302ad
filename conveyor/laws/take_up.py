"""What the take-up does to the tensions: gravity keeps them, a fixed one keeps the length of the belt.

Sources: statics of the carriage; Hooke (a belt of given length). A winch held at a set tension acts like a gravity
take-up, a locked one like a fixed one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from conveyor.require import require, require_finite, require_not_negative, require_positive

LOOP_STRANDS = 2  # [-], strands of belt that pull at the take-up pulley


def take_up_mass(tension: float, *, reeving: float, gravity: float) -> float:
    """Mass of a gravity take-up, m = 2 T/(i g).

    Parameters
    ----------
    tension : float
        T of the belt at the take-up pulley [N], at least 0.
    reeving : float
        i, pull on the carriage over pull of the weight [-], positive; 1 if the weight hangs in the belt's loop.
    gravity : float
        g [m/s²], positive.

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
    """
    require_not_negative(tension=tension)
    require_positive(reeving=reeving, gravity=gravity)
    return LOOP_STRANDS * tension / (reeving * gravity)


def mean_tension(tensions: Sequence[float], *, lengths: Sequence[float]) -> float:
    """Mean tension of the loop, Σ T_i l_i/Σ l_i: what a fixed take-up holds in every load case (Hooke).

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
    require(ok, "lengths", list(lengths), f"one for each of {len(tensions)} sections is needed")
    for tension, length in zip(tensions, lengths, strict=True):
        require_finite(tensions=tension)
        require_not_negative(lengths=length)
    whole = math.fsum(lengths)
    require(whole > 0.0, "lengths", list(lengths), "a loop longer than 0 is needed")
    return math.fsum(t * length for t, length in zip(tensions, lengths, strict=True)) / whole


def fixed_take_up_reference(
    mean_tension_held: float, *, offsets: Sequence[float], lengths: Sequence[float]
) -> float:
    """Tension at the reference point with a fixed take-up, T_ref = T_mean - Σ ΔT_i l_i/Σ l_i (Hooke).

    Parameters
    ----------
    mean_tension_held : float
        T_mean, set once and the same in every load case [N], at least 0, see `mean_tension`.
    offsets : sequence of float
        ΔT of each section over the reference point in this load case, mean over the section [N].
    lengths : sequence of float
        l of each section [m], at least 0, not all 0.

    Returns
    -------
    float
        T_ref [N] in this load case.

    Raises
    ------
    InputError
        An argument is outside its range, or the lengths of the lists differ.

    Notes
    -----
    One stiffness all round, sag and creep of the belt left out. To find the setting, take the load case that
    needs the most: T_mean = max over the cases of T_ref + mean of its offsets.

    Examples
    --------
    >>> fixed_take_up_reference(15e3, offsets=[0.0, 20e3], lengths=[300.0, 100.0])
    10000.0
    """
    require_not_negative(mean_tension_held=mean_tension_held)
    return mean_tension_held - mean_tension(offsets, lengths=lengths)


def take_up_travel(mean_tension_change: float, *, loop_length: float, stiffness: float) -> float:
    """Travel of the take-up for a change of tension, s = ΔT L/(2 EA) (Hooke).

    Parameters
    ----------
    mean_tension_change : float
        ΔT, change of the loop's mean tension [N], of either sign.
    loop_length : float
        L of the whole belt [m], positive.
    stiffness : float
        EA of the whole belt [N], positive.

    Returns
    -------
    float
        s [m], elastic part; lasting elongation comes on top, from the belt's maker.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> take_up_travel(40e3, loop_length=2000.0, stiffness=40e6)
    1.0
    """
    require_finite(mean_tension_change=mean_tension_change)
    require_positive(loop_length=loop_length, stiffness=stiffness)
    return mean_tension_change * loop_length / (LOOP_STRANDS * stiffness)
