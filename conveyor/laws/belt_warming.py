"""Warming of a belt by what its covers lose under the rolls."""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require_not_negative, require_positive

STILL_AIR_COEFFICIENT: Final = 5.7
"""Heat transfer of a smooth plate in still air: McAdams, Heat Transmission, 3rd ed. (1954), after Jürges [W/(m² K)]."""
COEFFICIENT_PER_SPEED: Final = 3.8
"""Its increase with the speed of the air, up to 5 m/s [J/(m³ K)]."""
FAST_COEFFICIENT: Final = 6.47
FAST_EXPONENT: Final = 0.78
"""Beyond 5 m/s it is 6.47 v^0.78, the same source [-]."""
JUERGES_SPEED: Final = 5.0
"""Speed at which the laws change [m/s]."""


def heat_transfer(speed: float) -> float:
    """Heat transfer from a face of a belt to still air.

    W. H. McAdams, Heat Transmission, 3rd ed. (1954), after W. Jürges: air along a smooth vertical plate.

    Parameters
    ----------
    speed : float
        Belt speed v, not negative [m/s].

    Returns
    -------
    float
        h = 5.7 + 3.8 v up to 5 m/s, 6.47 v^0.78 beyond [W/(m² K)].

    Raises
    ------
    InputError
        The speed is negative or not finite.

    Notes
    -----
    Sun, rain and the bulk are left out.

    Examples
    --------
    >>> round(heat_transfer(2.0), 1), round(heat_transfer(6.0), 1)
    (13.3, 26.2)
    """
    require_not_negative(speed=speed)
    if speed > JUERGES_SPEED:
        return float(FAST_COEFFICIENT * speed**FAST_EXPONENT)
    return STILL_AIR_COEFFICIENT + COEFFICIENT_PER_SPEED * speed


def belt_warming(loss: float, *, width: float, length: float, speed: float) -> float:
    """Temperature of the belt above the air in steady running, from the heat balance of the loop (derived).

    Parameters
    ----------
    loss : float
        Power lost in the covers of both strands, not negative [W].
    width : float
        Belt width B, positive [m].
    length : float
        Length L of the conveyor, positive [m].
    speed : float
        Belt speed, not negative [m/s].

    Returns
    -------
    float
        P/(3 h B L): one face open on the carry side, under the bulk, two on the return side [K].

    Raises
    ------
    InputError
        A value is outside its range.

    Notes
    -----
    A mean through the thickness: of one pass under a roll the cover warms by some mK. Bulk warmer or colder than the
    air, sun, and the flexure of the belt are left out.

    Examples
    --------
    >>> round(belt_warming(200e3, width=1.2, length=5000.0, speed=5.0), 2)
    0.45
    """
    require_not_negative(loss=loss)
    require_positive(width=width, length=length)
    return loss / (3.0 * heat_transfer(speed) * width * length)
