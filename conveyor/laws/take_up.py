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
