"""Walks the route: both strands, section by section, from masses to the forces of every stretch.

The only place, with balance.py, where models meet laws: quantities become SI here, once.
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from conveyor.indentation import Indentation, IndentationCurve, RollContact, indentation_curve
from conveyor.loading import RollLoad, bulk_line_mass, roll_loads
from conveyor.models import Conveyor, IdlerSet, Roll, Section
from conveyor.resistance import (
    ROLL_ON_BELT_FRICTION,
    TILT_COEFFICIENT_30,
    TILT_COEFFICIENT_45,
    flexure_resistance,
    idler_rotation_resistance,
    idler_tilt_resistance,
    roll_drag,
    roll_line_mass,
    section_main_resistance,
    slope_resistance,
)
from conveyor.rubber import PronySeries
from conveyor.units import Quantity, si

Array = NDArray[np.float64]
Strand = Literal["carry", "return"]

_CURVE_DOWN_TO = 0.25  # of the highest load: a curve to be looked at, also where all rolls bear the same
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


@dataclass(frozen=True, eq=False)
class RollResult:
    """One roll of a set: its load, its contact at the highest line load, its indentation.

    Attributes
    ----------
    load : RollLoad
        Force and distribution.
    curve : IndentationCurve
        The load curve it was read from.
    peak : Indentation
        Contact at the highest line load, for a wing that of its inner end.
    resistance : float
        Indentation resistance of the roll [N].
    """

    load: RollLoad
    curve: IndentationCurve
    peak: Indentation
    resistance: float


@dataclass(frozen=True, eq=False)
class StretchResult:
    """Forces of a stretch [N]; `unit_main` is the main resistance DIN 22101 gives for f = 1."""

    stretch: Stretch
    rolls: tuple[RollResult, ...]
    indentation: float
    rotation: float
    flexure: float
    tilt: float
    lift: float
    unit_main: float

    @property
    def main(self) -> float:
        """Indentation, rotation and flexure [N]."""
        return self.indentation + self.rotation + self.flexure

    @property
    def total(self) -> float:
        """All forces along the stretch [N]."""
        return self.main + self.tilt + self.lift


def excited_band(results: tuple[StretchResult, ...], strand: Strand) -> tuple[float, float] | None:
    """Frequencies between which every roll of a strand loses nine tenths of its energy [Hz]; None without loss."""
    curves = {roll.curve for r in results if r.stretch.strand == strand for roll in r.rolls}
    bands = [curve.band for curve in curves]
    found = [band for band in bands if band is not None]
    return (min(low for low, _ in found), max(high for _, high in found)) if found else None


@dataclass(frozen=True)
class _Surface:
    """What the rolls of a strand run on, SI."""

    thickness: float
    rubber: PronySeries
    poisson: float


def walk(conveyor: Conveyor) -> tuple[StretchResult, ...]:
    """Carry strand from tail to head, then return strand from head to tail.

    Raises
    ------
    NoSolutionError
        A roll's contact has no answer (it splits, or wraps the roll).
    RangeError
        A compound is not known at the belt's temperature.
    """
    route = stretches(conveyor)
    surfaces = _surfaces(conveyor)
    curves = _solve_curves(conveyor, route, surfaces)
    return tuple(_resist(conveyor, stretch, surfaces, curves) for stretch in route)


def stretches(conveyor: Conveyor) -> tuple[Stretch, ...]:
    """Both strands of every section, SI."""
    sections = conveyor.route.sections
    carry = [_stretch(conveyor, section, "carry") for section in sections]
    back = [_stretch(conveyor, section, "return") for section in reversed(sections)]
    return (*carry, *back)


def _stretch(conveyor: Conveyor, section: Section, strand: Strand) -> Stretch:
    carrying = strand == "carry"
    idlers = conveyor.idlers.carry if carrying else conveyor.idlers.return_
    own = section.carry_spacing if carrying else section.return_spacing
    spacing = si(idlers.spacing if own is None else own)
    loaded = carrying and section.loaded
    flow = bulk_line_mass(si(conveyor.material.flow), belt_speed=si(conveyor.belt.speed)) if loaded else 0.0
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
        loads=roll_loads(
            bulk_line_mass=flow,
            belt_line_mass=conveyor.belt.line_mass,
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


def _surfaces(conveyor: Conveyor) -> dict[Strand, _Surface]:
    """The cover under each strand at the belt's temperature; one series per compound."""
    temperature = si(conveyor.ambient.belt)
    carry, back = conveyor.carry_compound, conveyor.return_compound
    series = carry.series(temperature)
    same = back is carry or back == carry
    other = series if same else back.series(temperature)
    return {
        "carry": _Surface(si(conveyor.belt.bottom_cover.thickness), series, carry.poisson_ratio),
        "return": _Surface(si(conveyor.return_cover_thickness), other, back.poisson_ratio),
    }


def roll_at(idlers: IdlerSet, place: int) -> Roll:
    """Roll at a place of the set, left to right."""
    middle = idlers.rolls in {3, 5} and place == idlers.rolls // 2
    return idlers.middle if middle else idlers.roll


def _contact(conveyor: Conveyor, stretch: Stretch, place: int, surface: _Surface) -> RollContact:
    return RollContact(
        radius=0.5 * si(roll_at(stretch.idlers, place).diameter),
        spacing=stretch.spacing,
        cover_thickness=surface.thickness,
        speed=si(conveyor.belt.speed),
        rubber=surface.rubber,
        poisson=surface.poisson,
        support=conveyor.calculation.support,
    )


def _solve_curves(
    conveyor: Conveyor, route: tuple[Stretch, ...], surfaces: dict[Strand, _Surface]
) -> dict[RollContact, IndentationCurve]:
    """One load curve per distinct roll, cover, speed and spacing, over the loads that occur on it."""
    points = conveyor.calculation.gauss_points
    occurring: dict[RollContact, list[Array]] = defaultdict(list)
    for stretch in route:
        for place, load in enumerate(stretch.loads):
            contact = _contact(conveyor, stretch, place, surfaces[stretch.strand])
            occurring[contact] += [load.line_loads(points)[0], np.array([load.peak_line_load])]
    rtol = conveyor.calculation.rtol
    ranges = {contact: np.concatenate(loads) for contact, loads in occurring.items()}
    return {
        contact: indentation_curve(
            contact, min(float(w.min()), _CURVE_DOWN_TO * float(w.max())), float(w.max()), rtol
        )
        for contact, w in ranges.items()
    }


def _resist(
    conveyor: Conveyor,
    stretch: Stretch,
    surfaces: dict[Strand, _Surface],
    curves: dict[RollContact, IndentationCurve],
) -> StretchResult:
    rolls = tuple(
        _roll(curves[_contact(conveyor, stretch, place, surfaces[stretch.strand])], load, conveyor)
        for place, load in enumerate(stretch.loads)
    )
    indentation = stretch.sets * math.fsum(roll.resistance for roll in rolls)
    rotation = _rotation(stretch)
    gravity = si(conveyor.calculation.gravity)
    share = si(conveyor.calculation.flexure_share)
    return StretchResult(
        stretch=stretch,
        rolls=rolls,
        indentation=indentation,
        rotation=rotation,
        flexure=flexure_resistance(indentation + rotation, share=share),
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


def _roll(curve: IndentationCurve, load: RollLoad, conveyor: Conveyor) -> RollResult:
    """Indentation of one roll, ∫ f(w(y)) dy along it."""
    line_load, weights = load.line_loads(conveyor.calculation.gauss_points)
    found = curve.at(line_load)
    return RollResult(load, curve, curve.at(load.peak_line_load), float(found.resistance @ weights))


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
