"""Every resistance of a conveyor in one list, over which sums, tables, plots and the loop of tensions iterate.

A new resistance is a law, its field of the spec, and its line in `forces_along_belt` (independent of the rubber:
computed in `rubber_free_forces`) or `point_forces`. By a classical method the main resistance is that of
`conveyor.classical_forces`, and by CEMA's every other one too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from conveyor.classical_forces import (
    bed_forces,
    cema_forces_along,
    cema_point_forces,
    factor_main_force,
    hopper_forces,
    unit_main_force,
)
from conveyor.force_sums import Force, ForceSums
from conveyor.laws.resistance import (
    ROLL_ON_BELT_FRICTION,
    TILT_COEFFICIENT_30,
    TILT_COEFFICIENT_45,
    acceleration_resistance,
    acceleration_skirt_resistance,
    cleaner_resistance,
    fabric_wrap_resistance,
    flexure_resistance,
    idler_tilt_resistance,
    plough_resistance,
    pulley_bearing_resistance,
    secondary_resistance,
    skirt_resistance,
    slope_resistance,
    steel_cord_wrap_resistance,
)
from conveyor.laws.transfer import skirt_seal_resistance
from conveyor.line.bend_pulleys import BendPulley
from conveyor.line.line import Line
from conveyor.line.loop_positions import LoopPosition
from conveyor.line.strands import OneStrand, Strands
from conveyor.line.stretches import Stretch
from conveyor.line.transfer_parts import LoadingPoint
from conveyor.models import Calibration

Array = NDArray[np.float64]

_VEE = 2  # rolls of a set
_TILT_TROUGHS = np.radians((30.0, 45.0))  # [rad], trough angles of the two listed coefficients C_e
_SLOPE_TENSION = 1e6  # [N], tension for the slope of a wrap; the law is linear, any would do
_CONTACT_SOURCE = "viscoelastic contact of every roll (see Method)"
_MISALIGNMENT_SOURCE = "friction across the belt x sine of the angle, derived"


@dataclass(frozen=True, eq=False)
class RubberFreeForces:
    """Forces along a line independent of rubber and air [N], shape (2n,).

    `guidance` is None without skewed sets in horizontal curves, `flexure` where it is a share of the other main
    resistances; `unit_main` is the main resistance of DIN 22101 for f = 1.
    """

    misalignment: Array
    tilt: Array
    guidance: Array | None
    lift: Array
    unit_main: Array
    flexure: Array | None

    def joined(self, back: RubberFreeForces) -> RubberFreeForces:
        """Join these forces of the carry strand with those of the return strand."""
        none = np.zeros_like(self.lift)
        joined: dict[str, Any] = {}
        for name in (field.name for field in fields(self)):
            pair = getattr(self, name), getattr(back, name)
            known = [part for part in pair if part is not None]
            joined[name] = np.concatenate([none if part is None else part for part in pair]) if known else None
        return RubberFreeForces(**joined)


def rubber_free_forces(strands: Strands) -> RubberFreeForces:
    """Forces along the belt independent of rubber and air."""
    carry, back = map(strand_rubber_free_forces, strands.each)
    return carry.joined(back)


def strand_rubber_free_forces(strand: OneStrand) -> RubberFreeForces:
    """Forces along one strand independent of rubber and air, shape (n,)."""

    def each(law: Callable[[Stretch, float], float]) -> Array:
        return np.array([law(stretch, strand.gravity) for stretch in strand.stretches])

    skewed = any(stretch.turn is not None and stretch.turn.guided for stretch in strand.stretches)
    return RubberFreeForces(
        misalignment=each(_misalignment_force),
        tilt=each(_tilt_force),
        guidance=each(_guidance_force) if skewed else None,
        lift=each(_lift_force),
        unit_main=each(unit_main_force),
        flexure=each(_flexure_force) if strand.flexes else None,
    )


def forces_along_belt(
    line: Line,
    rubber_free: RubberFreeForces,
    indentation: Array,
    *,
    roll_drag: float = 1.0,
    calibration: Calibration | None = None,
) -> tuple[Force, ...]:
    """Return the forces along the belt, flexure by load and sag at the largest sag.

    Parameters
    ----------
    line : Line
        The conveyor.
    rubber_free : RubberFreeForces
        Forces of `rubber_free_forces`.
    indentation : ndarray, shape (2n,)
        Indentation resistance of every stretch [N]; not used by a classical method.
    roll_drag : float
        Factor on the drag of all rolls [-].
    calibration : Calibration, optional
        Factors on indentation, rotation, flexure and misalignment; 1 without.
    """
    lift = Force("lift", "lift force", "lift", rubber_free.lift, "ISO 5048, F_St", certain=True)
    if line.method == "cema classic" and line.cema is not None:
        return (*cema_forces_along(line, line.cema), *_guidance_forces(rubber_free), lift)
    tilt = Force("tilt", "idler tilt", "special", rubber_free.tilt, "ISO 5048, F_e")
    beside = (tilt, *bed_forces(line), *_guidance_forces(rubber_free), lift)
    if line.method != "viscoelastic":
        return (factor_main_force(line, rubber_free.unit_main), *beside)
    factors = calibration or Calibration()
    indentation = factors.indentation * indentation
    rotation = factors.idler_rotation * roll_drag * line.roll_drag_forces
    flexure, share = rubber_free.flexure, line.flexure_share or 0.0
    if flexure is None:
        flexure = np.array([
            flexure_resistance(other, share=share) for other in (indentation + rotation).tolist()
        ])  # fmt: skip
    flexure = factors.flexure * flexure
    slackens = flexure if line.flexes_by_sag else None
    misalignment = factors.misalignment * rubber_free.misalignment
    return (
        Force("indentation", "indentation", "main", indentation, _CONTACT_SOURCE),
        Force("idler_rotation", "idler rotation", "main", rotation, "roll drag x number of rolls"),
        Force(
            "flexure",
            "flexure of belt and bulk",
            "main",
            flexure,
            line.flexure_source,
            short="flexure",
            at_sag_limit=slackens,
        ),
        Force(
            "misalignment",
            "misaligned idlers",
            "main",
            misalignment,
            _MISALIGNMENT_SOURCE,
            short="misalignment",
        ),
        *beside,
    )


def _flexure_force(stretch: Stretch, _gravity: float) -> float:
    """Flexure over all spans of the stretch [N]."""
    return stretch.sets * (stretch.span_flexure or 0.0)


def _misalignment_force(stretch: Stretch, _gravity: float) -> float:
    """Drag of all rolls of the stretch that are not square to the belt [N]."""
    pairs = zip(stretch.misalignment, stretch.loads, strict=True)
    return stretch.sets * math.fsum(friction * load.force for friction, load in pairs)


def _tilt_force(stretch: Stretch, gravity: float) -> float:
    """Resistance of wings tilted forward [N]; C_e in between is interpolated, beyond its ends kept."""
    if stretch.tilt_angle == 0.0:
        return 0.0
    listed = (TILT_COEFFICIENT_30.value, TILT_COEFFICIENT_45.value)
    wings = math.cos(stretch.trough_angle)
    if len(stretch.loads) != _VEE:
        wings = float(np.interp(stretch.trough_angle, _TILT_TROUGHS, listed))
    return idler_tilt_resistance(
        tilt_coefficient=wings,
        roll_friction=ROLL_ON_BELT_FRICTION.value,
        length=stretch.length,
        belt_mass=stretch.belt_mass,
        bulk_mass=stretch.bulk_mass,
        inclination=stretch.inclination,
        tilt_angle=stretch.tilt_angle,
        gravity=gravity,
    )


def _guidance_force(stretch: Stretch, _gravity: float) -> float:
    """Resistance of sets skewed to steer the belt on a horizontal curve [N]."""
    return 0.0 if stretch.turn is None else stretch.sets * stretch.turn.guidance()


def _guidance_forces(rubber_free: RubberFreeForces) -> Iterator[Force]:
    if rubber_free.guidance is not None:
        law = "guiding friction x sine of the skew, derived"
        yield Force(
            "guidance", "skewed idlers in horizontal curves", "special", rubber_free.guidance, law, short="guidance"
        )


def _lift_force(stretch: Stretch, gravity: float) -> float:
    return slope_resistance(stretch.line_mass, lift=stretch.rise, gravity=gravity)


def point_forces(line: Line) -> tuple[Force, ...]:
    """Forces at single places independent of tension: feeding points, cleaners, ploughs; by CEMA pulleys, too."""
    if line.method == "cema classic" and line.cema is not None:
        return tuple(cema_point_forces(line, line.cema))
    loaded = [force for point in line.loading for force in _loading_forces(line, point)]
    return (*loaded, *hopper_forces(line), *_cleaner_forces(line), *_plough_forces(line))


def length_coefficient_force(line: Line, spot: LoopPosition, along: Iterable[Force]) -> Force:
    """Secondary resistances as a whole, (C-1) F_H, at the loading point."""
    main = ForceSums.of(along).main
    force = secondary_resistance(main, length=line.length)
    return Force(
        "secondary_by_length", "secondary, (C-1) F_H", "secondary", force, "ISO 5048 / DIN 22101, C(L)",
        spot=spot, place=line.places.name(spot),
    )  # fmt: skip


def _loading_forces(line: Line, point: LoadingPoint) -> Iterator[Force]:
    name, here = point.name, partial(Force, spot=point.spot, place=point.place, assumed=point.assumed)
    length = point.acceleration_length(line.speed, line.gravity)
    if point.lift is not None and point.flow > 0.0:
        bulk = slope_resistance(point.flow / line.speed, lift=point.lift, gravity=line.gravity)
        yield Force(
            "tripper_lift", f"lift over the tripper{name}", "lift", bulk, "ISO 5048, F_St of the bulk",
            certain=True, spot=point.before, place=point.place, bulk=point.comes_with,
        )  # fmt: skip
    if point.flow > 0.0 and (line.secondary != "C" or point.lift is not None):
        inertia = acceleration_resistance(point.flow, belt_speed=line.speed, initial_speed=point.speed)
        law = _source_text("ISO 5048, F_bA", point.assumed)
        yield here("acceleration", f"acceleration of the bulk{name}", "secondary", inertia, law, certain=True,
                   bulk=point.comes_with)  # fmt: skip
        zone = acceleration_skirt_resistance(
            volume_flow=point.flow / line.density,
            bulk_density=line.density,
            length=length,
            belt_speed=line.speed,
            initial_speed=point.speed,
            skirt_distance=point.skirt_width,
            skirt_friction=point.skirt_friction,
            gravity=line.gravity,
            passing=max(0.0, point.flow_beyond - point.flow) / line.density,
        )
        law = _source_text("ISO 5048, F_f", point.assumed)
        yield here("loading_skirts", f"skirts in the loading zone{name}", "secondary", zone, law,
                   bulk=point.comes_with)  # fmt: skip
    if point.seal_drag > 0.0:
        drag = skirt_seal_resistance(point.boards(line.speed, line.gravity), drag_per_length=point.seal_drag)
        law = _source_text("seal_drag x length of the skirts", point.assumed)
        yield here("skirt_seals", f"seals of the skirts{name}", "special", drag, law)
    if point.flow_beyond == 0.0:
        return
    # bulk already on the belt rubs on the skirts of a later feeding point too
    beyond = skirt_resistance(
        volume_flow=point.flow_beyond / line.density,
        bulk_density=line.density,
        length=point.skirt_length,
        bulk_speed=line.speed,
        skirt_distance=point.skirt_width,
        skirt_friction=point.skirt_friction,
        gravity=line.gravity,
    )
    law = _source_text("ISO 5048, F_gL", point.assumed)
    yield here("skirts", f"skirts beyond the loading zone{name}", "special", beyond, law, bulk=point.section)


def _source_text(source: str, assumed: bool) -> str:
    return f"{source}, usual figures" if assumed else source


def _cleaner_forces(line: Line) -> Iterator[Force]:
    """Forces of the cleaners, behind the head and any head drive."""
    for i, scraper in enumerate(line.scrapers, start=1):
        one = cleaner_resistance(scraper.area, pressure=scraper.pressure, friction=scraper.friction)
        yield Force(
            "cleaner", f"cleaner {i} (x{scraper.count})", "special", scraper.count * one,
            _source_text("ISO 5048, F_r", scraper.assumed),
            spot=line.places.behind("head", None), place="head", assumed=scraper.assumed,
        )  # fmt: skip


def _plough_forces(line: Line) -> Iterator[Force]:
    """Forces of the ploughs; none on an empty belt."""
    if line.flow == 0.0:
        return
    for i, plough in enumerate(line.ploughs, start=1):
        force = plough_resistance(plough.width, scraping_factor=plough.scraping_factor, n_ploughs=plough.count)
        yield Force(
            "plough", f"plough {i} (x{plough.count})", "special", force, "ISO 5048, F_a",
            spot=plough.spot, place=plough.place,
        )  # fmt: skip


@dataclass(frozen=True)
class PulleyResistance:
    """Resistances of a pulley as linear functions of its tensions.

    Attributes
    ----------
    pulley : BendPulley
        The pulley.
    wrap : tuple of float
        Wrap resistance at no tension [N], and per newton of mean tension [-].
    bearings : float or None
        Bearing resistance per newton of load [-]; None for a driven pulley, included in the drive's efficiency.
    """

    pulley: BendPulley
    wrap: tuple[float, float]
    bearings: float | None

    def forces(self, wrap: float, bearings: float) -> Iterator[Force]:
        """Wrap and bearing resistance [N] as named forces."""
        name, assumed = self.pulley.name, self.pulley.assumed
        here = partial(Force, spot=self.pulley.spot, place=self.pulley.place, assumed=assumed)
        law = _source_text("ISO 5048 / DIN 22101, belt wrap", assumed)
        yield here("wrap", f"wrap, {name}", "secondary", wrap, law)
        if self.bearings is not None:
            law = _source_text("ISO 5048, F_t", assumed)
            yield here("pulley_bearings", f"bearings, {name}", "secondary", bearings, law)

    def times(self, factor: float) -> PulleyResistance:
        """The pulley with its resistances times a factor."""
        base, slope = self.wrap
        turn = None if self.bearings is None else factor * self.bearings
        return PulleyResistance(self.pulley, (factor * base, factor * slope), turn)


def pulley_resistances(line: Line) -> tuple[PulleyResistance, ...]:
    """Wrap resistance of every pulley, bearings of those not driven; none with the length coefficient C or by CEMA."""
    by_others = line.secondary == "C" or line.method == "cema classic"
    return () if by_others else tuple(_pulley_resistance(line, pulley) for pulley in line.pulleys)


def _pulley_resistance(line: Line, pulley: BendPulley) -> PulleyResistance:
    law = steel_cord_wrap_resistance if line.belt.steel_cord else fabric_wrap_resistance
    slack, taut = (
        law(
            belt_width=line.belt.width,
            tension=tension,
            belt_thickness=line.belt.thickness,
            pulley_diameter=pulley.diameter,
        )
        for tension in (0.0, _SLOPE_TENSION)
    )
    turn = pulley_bearing_resistance(1.0, shaft_diameter=pulley.shaft_diameter, pulley_diameter=pulley.diameter)
    return PulleyResistance(pulley, (slack, (taut - slack) / _SLOPE_TENSION), None if pulley.driven else turn)
