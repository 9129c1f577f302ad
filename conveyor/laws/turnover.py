"""Turnovers of the return strand, 180 degrees between two pulleys."""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require_positive

TURNOVER_OVER_WIDTH: Final = 12.0
"""Least length of a turnover of a textile belt over the belt's width, 1 ft per inch [-]: shorter ones leave the middle
of the belt too slack (rule of thumb, skecon.com, How is conveyor belt turnover affecting belt conveyor)."""


def least_turnover_length(belt_width: float) -> float:
    """Least length of a turnover of a textile belt, 12 B.

    Parameters
    ----------
    belt_width : float
        B of the belt [m], positive.

    Returns
    -------
    float
        Length from pulley to pulley [m].

    Raises
    ------
    InputError
        The width is outside its range.

    Notes
    -----
    A rule of thumb for textile belts. Those of steel cord are longer; how much, and by the tension in the turnover, the
    belt's maker says.

    Examples
    --------
    >>> least_turnover_length(0.75)
    9.0
    """
    require_positive(belt_width=belt_width)
    return TURNOVER_OVER_WIDTH * belt_width
