"""Shapes in which sets hold the belt: a trough, flat too, or a closed pipe; what each holds and how it lies.

Whoever needs to know asks `IdlerSet.shape`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar, Final, Protocol

from conveyor.laws.loading import CrossSection, Wing, cross_section, pipe_area, roll_angles, usable_width
from conveyor.laws.pipe_geometry import forming_length, pipe_strip_distance, pipe_transition_stretch
from conveyor.laws.transition import TransitionStretch, transition_stretch
from conveyor.models.base import Model
from conveyor.units import Bounds, Force, Fraction, Length, Quantity, quantity, si

OVERFILL_LIMIT: Final = 1.5
"""Largest calculated bulk over the cross-section that a trough holds [-]; more where edge to edge holds more."""


class BeltShape(Protocol):
    """What differs between a trough and a pipe.

    Attributes
    ----------
    closed : bool
        True where rolls hold the belt from all sides: it neither drifts nor lifts off.
    filling_source : str
        Where the largest cross-section is from.
    brim : str
        How bulk lies that fills it to the brim.
    larger : str
        What holds more.
    steepest : float
        Largest slope of bulk of which nothing else is known [rad].
    slope_source : str
        Where it is from.
    """

    closed: ClassVar[bool]
    filling_source: ClassVar[str]
    brim: ClassVar[str]
    larger: ClassVar[str]
    steepest: ClassVar[float]
    slope_source: ClassVar[str]

    def largest_section(self, width: float, surcharge: float) -> CrossSection:
        """Largest bulk cross-section of a level belt of a width [m] at a surcharge angle [rad]."""
        ...

    def flooded_section(self, width: float, surcharge: float) -> CrossSection:
        """Bulk cross-section of a level belt filled to the brim."""
        ...

    def most_calculated(self, width: float, surcharge: float) -> float:
        """Bulk cross-section beyond which a flow is refused [m²]."""
        ...

    def roll_turns(self) -> tuple[float, ...]:
        """Angle of each roll to square over that of its set's axis [-], left to right."""
        ...

    def transition_stretch(self, width: float, pulley_height: float) -> TransitionStretch:
        """Stretch of the strips on the way to a pulley of a height over the depth of the shape [-]."""
        ...

    @property
    def forming_length(self) -> float | None:
        """Least way to the pulley by rule of thumb [m]; None without one."""
        ...


@dataclass(frozen=True)
class Trough:
    """The belt on sets below it: in a trough, or flat.

    Attributes
    ----------
    rolls : int
        Rolls of a set.
    roll_length, angle : float
        Of each roll [m]; of the outer rolls [rad].
    inner_wing : Wing
        Length and angle of the inner wing rolls of four and five [m, rad].
    """

    rolls: int
    roll_length: float
    angle: float
    inner_wing: Wing

    closed: ClassVar[bool] = False
    filling_source: ClassVar[str] = "ISO 5048"
    brim: ClassVar[str] = "heaped from edge to edge"
    larger: ClassVar[str] = "a wider belt"
    steepest: ClassVar[float] = math.radians(18.0)
    slope_source: ClassVar[str] = "most bulk on a smooth belt, general knowledge"

    def middle_belt(self, width: float) -> float:
        """Width of belt on the middle roll [m]: all of it on one roll, 0 without a middle roll."""
        if self.rolls == 1:
            return width
        return min(self.roll_length, width) if self.rolls in {3, 5} else 0.0

    def largest_section(self, width: float, surcharge: float) -> CrossSection:
        """ISO 5048's, on the usable width of the belt."""
        return self._section(usable_width(width), surcharge)

    def flooded_section(self, width: float, surcharge: float) -> CrossSection:
        """On the whole width of the belt."""
        return self._section(width, surcharge)

    def most_calculated(self, width: float, surcharge: float) -> float:
        """An overfull trough only fails its check, up to `OVERFILL_LIMIT` or the brim [m²]."""
        held, flooded = self.largest_section(width, surcharge).area, self.flooded_section(width, surcharge).area
        return max(OVERFILL_LIMIT * held, flooded)

    def _section(self, across: float, surcharge: float) -> CrossSection:
        """Bulk cross-section on a width of the belt [m]."""
        return cross_section(
            across,
            middle_roll_length=self.middle_belt(across),
            trough_angle=self.angle,
            surcharge_angle=surcharge,
            inner_wing=self.inner_wing,
        )

    def roll_turns(self) -> tuple[float, ...]:
        """A wing roll turns by cos λ of its set's angle."""
        slopes = roll_angles(self.rolls, trough_angle=self.angle, inner_angle=self.inner_wing.angle)
        return tuple(math.cos(slope) for slope in slopes)

    def transition_stretch(self, width: float, pulley_height: float) -> TransitionStretch:
        """Stretch of straight strips to the wings."""
        return transition_stretch(
            width,
            middle_roll_length=self.middle_belt(width),
            trough_angle=self.angle,
            pulley_height=pulley_height,
            inner_wing=self.inner_wing,
        )

    @property
    def forming_length(self) -> float | None:
        """None: CEMA's table has the belt's use and carcass too, see `cema_transition_length`."""
        return None


class Pipe(Model):
    """The belt as a closed pipe in panels of six rolls, one of them below."""

    diameter: Annotated[Length, Bounds(gt="50 mm", le="2 m")]
    """Of the pipe inside the belt; what the belt is wider than its circumference overlaps."""
    forming_load: Annotated[Force, Bounds(ge="1 N", le="20 kN")] | None = None
    """What the belt, which would open, presses on a roll of a panel, the mean of the six without its weight: measured,
    or of its maker; needed without belt.transverse_stiffness."""
    filling: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity("75 %")
    """Most bulk in the pipe, over its cross-section."""
    lump: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity("33 %")
    """Largest lump (belt.wear.lump) over the diameter."""

    closed: ClassVar[bool] = True
    filling_source: ClassVar[str] = "idlers.carry.pipe.filling"
    brim: ClassVar[str] = "filling the whole pipe"
    larger: ClassVar[str] = "a larger pipe"
    steepest: ClassVar[float] = math.radians(27.0)
    slope_source: ClassVar[str] = "sluggish bulk in a pipe, helixtech.com.au"

    def carcass_radius(self, cover: Quantity, carcass: Quantity) -> float:
        """Radius of the middle of the carcass, by its thickness and that of the cover inside [m]."""
        return pipe_strip_distance(si(self.diameter), cover_thickness=si(cover), carcass_thickness=si(carcass))

    @property
    def radius(self) -> float:
        """Inner radius [m]."""
        return 0.5 * si(self.diameter)

    @property
    def largest_lump(self) -> float:
        """Largest lump that passes [m]."""
        return si(self.lump) * si(self.diameter)

    def largest_section(self, width: float, surcharge: float) -> CrossSection:  # noqa: ARG002 of every shape
        """Its filling, whatever the slope."""
        return CrossSection(0.0, pipe_area(si(self.diameter), filling=si(self.filling)))

    def flooded_section(self, width: float, surcharge: float) -> CrossSection:  # noqa: ARG002 of every shape
        """All of the pipe."""
        return CrossSection(0.0, pipe_area(si(self.diameter)))

    def most_calculated(self, width: float, surcharge: float) -> float:
        """All of the pipe [m²]."""
        return self.flooded_section(width, surcharge).area

    def roll_turns(self) -> tuple[float, ...]:
        """A panel out of square turns its side rolls by part of that: all of it, the safe side."""
        return (1.0,) * 6

    def transition_stretch(self, width: float, pulley_height: float) -> TransitionStretch:
        """Stretch of straight strips to the circle."""
        return pipe_transition_stretch(width, diameter=si(self.diameter), pulley_height=pulley_height)

    @property
    def forming_length(self) -> float | None:
        """From the flat belt to the pipe [m]."""
        return forming_length(si(self.diameter))
