"""A conveyor cut into stretches: geometry, masses, loads of the rolls, and the forces that no rubber changes.

Here quantities become SI, once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from conveyor.errors import NoSolutionError
from conveyor.loading import RollLoad, bulk_line_mass, roll_loads
from conveyor.models import Conveyor, IdlerSet, Roll, Section
from conveyor.resistance import (
    ROLL_ON_BELT_FRICTION,
    TILT_COEFFICIENT_30,
    TILT_COEFFICIENT_45,
    idler_rotation_resistance,
    idler_tilt_resistance,
    roll_drag,
    roll_line_mass,
    section_main_resistance,
    slope_resistance,
)
from conveyor.tension import sag_tension
from conveyor.units import Quantity, si

Strand = Literal["carry", "return"]
Pressing = Mapping[tuple[str, Strand], float]
"""Mass per length with which tension presses on the rolls of a section and strand [kg/m], negative where it lifts."""

_TILT_STEEP = math.radians(37.5)  # trough angle midway between the two listed coefficients C_e


@dataclass(frozen=True)
class Stretch:
    """One section of one strand, SI, in running direction of that strand.

    Attributes
    ----------
    section : str
        Name of the section.
    strand : {"carry", "return"}
        Which strand.
    length, rise : float
        Along the belt, and upward in running direction [m].
    spacing : float
        Of the idler sets [m].
    idlers : IdlerSet
        The sets.
    belt_mass, bulk_mass : float
        m'_belt, m'_bulk [kg/m].
    loads : tuple of RollLoad
        Load of each roll of one set.
    least_tension : float
        That keeps the sag between the sets as small as asked for [N].
    """

    section: str
    strand: Strand
    length: float
    rise: float
    spacing: float
    idlers: IdlerSet
    belt_mass: float
    bulk_mass: float
    loads: tuple[RollLoad, ...]
    least_tension: float

    @property
    def inclination(self) -> float:
        """Slope angle δ [rad]."""
        return math.asin(self.rise / self.length)

    @property
    def sets(self) -> float:
        """Number of idler sets, a broken number allowed."""
        return self.length / self.spacing

    @property
    def line_mass(self) -> float:
        """m'_belt + m'_bulk [kg/m]."""
        return self.belt_mass + self.bulk_mass


def stretches(conveyor: Conveyor, pressing: Pressing | None = None) -> tuple[Stretch, ...]:
    """Both strands of every section, SI; `pressing` as of `roll_masses`."""
    sections = conveyor.route.sections
    carry = [_stretch(conveyor, section, "carry", pressing or {}) for section in sections]
    back = [_stretch(conveyor, section, "return", pressing or {}) for section in reversed(sections)]
    return (*carry, *back)


def roll_masses(belt_mass: float, bulk_mass: float, pressing: float) -> tuple[float, float]:
    """Belt and bulk as they press on the rolls of a vertical curve [kg/m].

    A concave curve's negative mass relieves the belt first, then the bulk; the sum is kept.

    Raises
    ------
    NoSolutionError
        The belt lifts off with all that lies on it.
    """
    belt = belt_mass + pressing
    if belt >= 0.0:
        return belt, bulk_mass
    if bulk_mass + belt <= 0.0:
        raise NoSolutionError(
            f"the belt lifts off: on a concave curve its tension pulls up like {-pressing:.4g} kg/m, belt and bulk are "
            f"{belt_mass + bulk_mass:.4g} kg/m; choose a larger curve_radius or less tension"
        )
    return 0.0, bulk_mass + belt


def _stretch(conveyor: Conveyor, section: Section, strand: Strand, pressing: Pressing) -> Stretch:
    carrying = strand == "carry"
    idlers = conveyor.idlers.carry if carrying else conveyor.idlers.return_
    own = section.carry_spacing if carrying else section.return_spacing
    spacing = si(idlers.spacing if own is None else own)
    loaded = carrying and section.loaded
    flow = bulk_line_mass(si(conveyor.material.flow), belt_speed=si(conveyor.belt.speed)) if loaded else 0.0
    flow *= conveyor.route.flow_shares[section.name]
    belt_on_rolls, bulk_on_rolls = roll_masses(
        conveyor.belt.line_mass, flow, pressing.get((section.name, strand), 0.0)
    )
    length = si(section.length)
    rise = section.rise if carrying else -section.rise
    return Stretch(
        section=section.name,
        strand=strand,
        length=length,
        rise=rise,
        spacing=spacing,
        idlers=idlers,
        belt_mass=conveyor.belt.line_mass,
        bulk_mass=flow,
        least_tension=sag_tension(
            conveyor.belt.line_mass + flow,
            spacing=spacing,
            relative_sag=si(idlers.sag),
            gravity=si(conveyor.calculation.gravity),
        ),
        loads=roll_loads(
            bulk_line_mass=bulk_on_rolls,
            belt_line_mass=belt_on_rolls,
            spacing=spacing,
            n_rolls=idlers.rolls,
            trough_angle=si(idlers.trough_angle),
            roll_length=si(idlers.roll.length),
            belt_width=si(conveyor.belt.width),
            inclination=math.asin(rise / length),
            gravity=si(conveyor.calculation.gravity),
            bulk_shares=_shares(idlers.load_shares),
            belt_shares=_shares(idlers.belt_shares),
        ),
    )


def _shares(given: tuple[Quantity, ...] | None) -> tuple[float, ...] | None:
    return None if given is None else tuple(si(share) for share in given)


def roll_at(idlers: IdlerSet, place: int) -> Roll:
    """Roll at a place of the set, left to right."""
    middle = idlers.rolls in {3, 5} and place == idlers.rolls // 2
    return idlers.middle if middle else idlers.roll


@dataclass(frozen=True)
class FixedForces:
    """Forces of a stretch that no rubber changes [N]."""

    rotation: float
    tilt: float
    lift: float
    unit_main: float

    @classmethod
    def of(cls, stretch: Stretch, gravity: float) -> FixedForces:
        """Forces of a stretch under gravity [m/s²]."""
        return cls(
            rotation=_rotation(stretch),
            tilt=_tilt(stretch, gravity),
            lift=slope_resistance(stretch.line_mass, lift=stretch.rise, gravity=gravity),
            unit_main=section_main_resistance(
                friction_factor=1.0,
                length=stretch.length,
                roll_mass=roll_line_mass(_set_mass(stretch.idlers), spacing=stretch.spacing),
                belt_mass=stretch.belt_mass,
                bulk_mass=stretch.bulk_mass,
                inclination=stretch.inclination,
                gravity=gravity,
            ),
        )


def _set_mass(idlers: IdlerSet) -> float:
    """Rotating mass of one set [kg]."""
    return math.fsum(si(roll_at(idlers, place).rotating_mass) for place in range(idlers.rolls))


def _rotation(stretch: Stretch) -> float:
    """Drag of all rolls of the stretch [N]."""
    total = 0.0
    for place in range(stretch.idlers.rolls):
        roll = roll_at(stretch.idlers, place)
        drag = roll_drag(None if roll.drag is None else si(roll.drag), roll_diameter=si(roll.diameter))
        total += idler_rotation_resistance(
            drag.force, n_rolls=1, spacing=stretch.spacing, length=stretch.length
        )
    return total


def _tilt(stretch: Stretch, gravity: float) -> float:
    """Resistance of wings tilted forward [N]; zero where they are not."""
    angle = si(stretch.idlers.tilt_angle)
    if angle == 0.0:
        return 0.0
    steep = si(stretch.idlers.trough_angle) > _TILT_STEEP
    return idler_tilt_resistance(
        tilt_coefficient=(TILT_COEFFICIENT_45 if steep else TILT_COEFFICIENT_30).value,
        roll_friction=ROLL_ON_BELT_FRICTION.value,
        length=stretch.length,
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        inclination=stretch.inclination,
        tilt_angle=angle,
        gravity=gravity,
    )
