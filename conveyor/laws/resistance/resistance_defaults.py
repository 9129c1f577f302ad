"""Default figures: value, range, source, and whether the source was read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

Site: TypeAlias = Literal["overland", "plant", "poor"]
"""Alignment and upkeep of a conveyor."""


@dataclass(frozen=True, slots=True)
class Default:
    """A default of the craft.

    Parameters
    ----------
    value : float
        The default, in the unit its name's comment states.
    low, high : float
        Range met in practice, same unit.
    source : str
        Where the value comes from.
    general_knowledge : bool
        True: common knowledge of the craft, not read in a source; an analysis that uses it must say so.
    """

    value: float
    low: float
    high: float
    source: str
    general_knowledge: bool = False


# Artificial friction factor f [-]
FRICTION_FACTOR: Final = Default(0.020, 0.0085, 0.030, "DIN 22101, ISO 5048: standard value")
FRICTION_FACTOR_OVERLAND: Final = Default(0.011, 0.0085, 0.013, "measured on optimised overland conveyors, midpoint")
FRICTION_FACTOR_GOOD: Final = Default(0.016, 0.016, 0.016, "well aligned, easy running idlers", True)
FRICTION_FACTOR_POOR: Final = Default(0.025, 0.025, 0.030, "dusty, overloaded or badly aligned", True)
FRICTION_FACTOR_DOWNHILL: Final = Default(0.012, 0.012, 0.012, "regenerative downhill conveyors", True)

# Friction coefficients [-]
BULK_ON_BELT_FRICTION: Final = Default(0.5, 0.5, 0.5, "ISO 5048 worked example, μ1")
BULK_ON_SKIRT_FRICTION: Final = Default(0.7, 0.7, 0.7, "ISO 5048 worked example, μ2")
CLEANER_FRICTION: Final = Default(0.6, 0.5, 0.7, "ISO 5048 worked example, μ3; range: general knowledge")
ROLL_ON_BELT_FRICTION: Final = Default(0.35, 0.3, 0.4, "carry rolls against the belt, μ0, midpoint", True)

CLEANER_PRESSURE: Final = Default(
    6e4, 3e4, 1e5, "ISO 5048, 3e4 to 1e5 Pa, middle; its worked example has 3e4, DTII(A) 1e5"
)  # [N/m²]
TILT_COEFFICIENT_30: Final = Default(0.4, 0.4, 0.4, "C_e at a trough angle of 30 deg", True)  # [-]
TILT_COEFFICIENT_45: Final = Default(0.5, 0.5, 0.5, "C_e at a trough angle of 45 deg", True)  # [-]

# Drag of one roll at its rim [N]: acceptance limits, so an upper bound for rolls in order
ROLL_DRAG_TO_153: Final = Default(1.28, 0.0, 1.28, "acceptance limit of rim drag, rolls to 153 mm")
ROLL_DRAG_TO_178: Final = Default(2.45, 0.0, 2.45, "acceptance limit of rim drag, rolls to 178 mm")
ROLL_DRAG_LARGER: Final = Default(3.0, 0.0, 3.0, "acceptance limit of running drag at 650 rpm under 250 N")
ROLL_DRAG_STANDSTILL_FACTOR: Final = 1.5  # [-], acceptance: drag after standstill over running drag, at most

FLEXURE_SHARE: Final = Default(0.11, 0.0, 0.11, "share of the total measured at one overland site")  # [-]

# Bending stiffness D of a carcass per width, lengthwise and flat [N m]; cords and plies slide in the rubber, so far
# below that of a solid as thick
CARCASS_BENDING: Final = Default(15.0, 5.0, 50.0, "carcass that bends between its covers", True)
