"""Effect of one input on the power, and the band from several."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Effect:
    """Effect of one input on the power.

    Attributes
    ----------
    name : str
        The input.
    low, given, high : str
        Its values as text.
    motor_low, motor_high : float
        Motor shaft power at both ends [W]; for rubber the 5 % and 95 % quantiles of its replicas.
    """

    name: str
    low: str
    given: str
    high: str
    motor_low: float
    motor_high: float

    @property
    def swing(self) -> float:
        """Change of the power between the ends [W]."""
        return abs(self.motor_high - self.motor_low)


def root_of_squares(motor: float, effects: Sequence[Effect]) -> tuple[float, float]:
    """Band of independent inputs: root of the sum of squares of the changes down, and of those up [W].

    Parameters
    ----------
    motor : float
        Power as given [W].
    effects : sequence of Effect
        One per input.

    Examples
    --------
    >>> root_of_squares(100.0, [Effect("a", "", "", "", 97.0, 103.0), Effect("b", "", "", "", 104.0, 96.0)])
    (95.0, 105.0)
    """
    return ends_of_band(motor, [(effect.motor_low, effect.motor_high) for effect in effects])


def ends_of_band(value: float, ends: Iterable[Sequence[float]]) -> tuple[float, float]:
    """Band of a figure from its values at both ends of each of several independent inputs.

    Examples
    --------
    >>> ends_of_band(100.0, [(97.0, 103.0), (104.0, 96.0)])
    (95.0, 105.0)
    """
    changes = [(low - value, high - value) for low, high in ends]
    down = math.hypot(*(min(*pair, 0.0) for pair in changes))
    up = math.hypot(*(max(*pair, 0.0) for pair in changes))
    return value - down, value + up
