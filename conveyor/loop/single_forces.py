"""Forces at single places of the belt: loading points, skirts, cleaners, pulleys; SI, once for a conveyor.

Places of the loop are boundaries between stretches, counted in running direction from the head: the n stretches of the
return strand first, the tail is boundary n, then the n of the carry strand; boundary 2n is the head again. What stands
at one boundary the belt meets in the order of `Stand`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Literal

from conveyor.errors import NoSolutionError
from conveyor.laws.resistance import (
    acceleration_length,
    acceleration_resistance,
    acceleration_skirt_resistance,
    cleaner_resistance,
    fabric_wrap_resistance,
    plough_resistance,
    pulley_bearing_resistance,
    pulley_load,
    skirt_resistance,
    steel_cord_wrap_resistance,
)
from conveyor.models import Conveyor, DrivePulley, Feeding, Pulley, TakeUp
from conveyor.units import si

Kind = Literal["secondary", "special"]

_TURNS = frozenset({"head", "tail"})
_LEAST_DRIVEN_WRAP = math.radians(90.0)
"""Nobody drives a pulley that the belt lies on for less; general knowledge."""
_MOST_DRIVEN_WRAP = math.radians(270.0)
"""On one pulley; a drive of more stands for several, general knowledge."""
_SLOPE_OVER = 1e6  # [N], tension over which a wrap's line is drawn; the law is linear, so any would do


@dataclass(frozen=True)
class SingleForce:
    """A resistance at one place of the belt [N], with the law it comes from."""

    name: str
    kind: Kind
    place: str
    force: float
    source: str


class Stand(IntEnum):
    """In which order the belt meets what stands at one boundary: the strand's end, head or tail, the next strand."""

    END = 0
    """Pulleys and ploughs behind a section."""
    END_DRIVE = 1
    END_BEHIND = 2
    """A take-up behind it."""
    TURN = 3
    """Pulleys of head or tail, ploughs before the head."""
    TURN_DRIVE = 4
    TURN_BEHIND = 5
    """Snubs and cleaners behind the head; the take-up behind head or tail."""
    LANDING = 6
    """Bulk that lands on the next section, and its skirts."""


@dataclass(frozen=True, order=True)
class Spot:
    """A place of the loop: a boundary, and where among what stands there; sorted as the belt meets them."""

    boundary: int
    stand: Stand


@dataclass(frozen=True)
class Placed:
    """A single force at its place; `certain` where no friction makes it."""

    spot: Spot
    single: SingleForce
    certain: bool = False


@dataclass(frozen=True)
class Bend:
    """A pulley's resistances as lines over the tensions at it."""

    name: str
    spot: Spot
    place: str
    wrap: tuple[float, float]
    """Bending of the belt: at no tension [N], and per newton of mean tension [-]."""
    bearings: float | None
    """Bearing resistance per newton of load [-]; None of a driven pulley, whose bearings the efficiency holds."""
    mass: float
    wrap_angle: float = math.pi

    def forces(self, tight: float, slack: float, gravity: float) -> tuple[float, float]:
        """Wrap and bearings at the tensions of both sides [N].

        Raises
        ------
        NoSolutionError
            The belt is slack at the pulley.
        """
        if min(tight, slack) < 0.0:
            raise NoSolutionError(
                f'the belt is slack at pulley "{self.name}" ({min(tight, slack):.6g} N): raise the take-up\'s tension '
                "(route.take_up.tension), or look for a resistance far too large among the forces before it"
            )
        base, slope = self.wrap
        bend = base + slope * 0.5 * (tight + slack)
        if self.bearings is None:
            return bend, 0.0
        load = pulley_load(
            tight_tension=tight,
            slack_tension=slack,
            pulley_mass=self.mass,
            gravity=gravity,
            wrap_angle=self.wrap_angle,
        )
        return bend, self.bearings * load

    def singles(self, tight: float, slack: float, gravity: float) -> tuple[SingleForce, ...]:
        """Both as forces with their names."""
        bend, turn = self.forces(tight, slack, gravity)
        source = "ISO 5048 / DIN 22101, belt wrap"
        wrap = SingleForce(f"wrap, {self.name}", "secondary", self.place, bend, source)
        if self.bearings is None:
            return (wrap,)
        return wrap, SingleForce(f"bearings, {self.name}", "secondary", self.place, turn, "ISO 5048, F_t")


class Places:
    """Boundaries of the loop by the names a spec gives them."""

    def __init__(self, conveyor: Conveyor) -> None:
        self.count = len(conveyor.route.sections)
        self._names = [section.name for section in conveyor.route.sections]
        self._index = {name: i for i, name in enumerate(self._names)}
        self._drive = conveyor.drive

    def boundary(self, position: str, section: str | None) -> int:
        """Boundary of a position; the head is the end of the carry strand."""
        if position == "head":
            return 2 * self.count
        if position == "tail" or section is None:
            return self.count
        index = self._index[section]
        return self.count + index + 1 if position == "carry" else self.count - index

    def landing(self, section: str | None) -> Spot:
        """Where bulk lands on a section, behind all else that stands at its tail end."""
        return Spot(self.count + (0 if section is None else self._index[section]), Stand.LANDING)

    def name(self, landing: Spot) -> str:
        """Where bulk lands, in words."""
        section = landing.boundary - self.count
        return "tail" if section == 0 else f"tail end of {self._names[section]}"

    def before(self, position: str, section: str | None) -> Spot:
        """Place before the drives of a position."""
        stand = Stand.TURN if position in _TURNS else Stand.END
        return Spot(self.boundary(position, section), stand)

    def drive(self, pulley: DrivePulley) -> Spot:
        """Place of a drive."""
        stand = Stand.TURN_DRIVE if pulley.position in _TURNS else Stand.END_DRIVE
        return Spot(self.boundary(pulley.position, pulley.section), stand)

    def behind(self, position: str, section: str | None) -> Spot:
        """Place behind the drives of a position; behind the head the loop begins."""
        if position == "head":
            return Spot(0, Stand.TURN_BEHIND)
        stand = Stand.TURN_BEHIND if position == "tail" else Stand.END_BEHIND
        return Spot(self.boundary(position, section), stand)

    def take_up(self, take_up: TakeUp | None) -> Spot:
        """Place of the take-up's pulleys: behind the first drive without one."""
        if take_up is None or take_up.position == "drive":
            return self.behind(self._drive.position, self._drive.section)
        return self.behind(take_up.position, take_up.section)


def fixed_singles(conveyor: Conveyor, places: Places) -> tuple[Placed, ...]:
    """Single forces that no tension changes: feeding points, cleaners and ploughs."""
    points = conveyor.route.feeding_points
    fed = [placed for point in points for placed in _feeding(conveyor, point, places)]
    return (*fed, *_cleaners(conveyor), *_ploughs(conveyor, places))


def _ploughs(conveyor: Conveyor, places: Places) -> tuple[Placed, ...]:
    """Ploughs, where there is bulk to sweep."""
    if si(conveyor.material.flow) == 0.0:
        return ()
    found = []
    for i, plough in enumerate(conveyor.route.ploughs, start=1):
        force = plough_resistance(
            si(plough.width), scraping_factor=si(plough.scraping_factor), n_ploughs=plough.count
        )
        place = "head" if plough.section is None else f"behind {plough.section}, carry"
        single = SingleForce(f"plough {i} (x{plough.count})", "special", place, force, "ISO 5048, F_a")
        found.append(Placed(places.before(plough.position, plough.section), single))
    return tuple(found)


def _feeding(conveyor: Conveyor, feeding: Feeding, places: Places) -> tuple[Placed, ...]:
    flow, speed = si(conveyor.material.flow), si(conveyor.belt.speed)
    flow *= 1.0 if feeding.share is None else si(feeding.share)
    if flow == 0.0:
        return ()
    density, gravity = si(conveyor.material.density), si(conveyor.calculation.gravity)
    landing = si(feeding.speed)
    spot = places.landing(feeding.section)
    place = places.name(spot)
    which = f", {feeding.section or 'first'}" if conveyor.route.further_feeding else ""
    length = acceleration_length(
        belt_speed=speed, initial_speed=landing, belt_friction=feeding.belt_friction, gravity=gravity
    )
    # the bulk that lies there already rubs on the skirts of a later feeding point too
    name = places_name(conveyor, feeding)
    beyond_flow = si(conveyor.material.flow) * conveyor.route.flow_shares[name]
    skirts = skirt_resistance(
        volume_flow=beyond_flow / density,
        bulk_density=density,
        length=si(feeding.skirt_length),
        bulk_speed=speed,
        skirt_distance=si(feeding.skirt_width),
        skirt_friction=feeding.skirt_friction,
        gravity=gravity,
    )
    beyond = Placed(
        spot,
        SingleForce(f"skirts beyond the loading zone{which}", "special", place, skirts, "ISO 5048, F_gL"),
    )
    if conveyor.calculation.secondary == "C":
        return (beyond,)
    inertia = acceleration_resistance(flow, belt_speed=speed, initial_speed=landing)
    zone = acceleration_skirt_resistance(
        volume_flow=flow / density,
        bulk_density=density,
        length=length,
        belt_speed=speed,
        initial_speed=landing,
        skirt_distance=si(feeding.skirt_width),
        skirt_friction=feeding.skirt_friction,
        gravity=gravity,
    )
    return (
        Placed(
            spot,
            SingleForce(f"acceleration of the bulk{which}", "secondary", place, inertia, "ISO 5048, F_bA"),
            certain=True,
        ),
        Placed(
            spot,
            SingleForce(f"skirts in the loading zone{which}", "secondary", place, zone, "ISO 5048, F_f"),
        ),
        beyond,
    )


def places_name(conveyor: Conveyor, feeding: Feeding) -> str:
    """Name of the section at whose tail end a feeding point stands."""
    return conveyor.route.sections[0].name if feeding.section is None else feeding.section


def _cleaners(conveyor: Conveyor) -> tuple[Placed, ...]:
    """Cleaners behind the head."""
    return tuple(
        Placed(
            Spot(0, Stand.TURN_BEHIND),
            SingleForce(
                f"cleaner {i} (x{cleaner.count})",
                "special",
                "head",
                cleaner.count
                * cleaner_resistance(
                    si(cleaner.width) * si(cleaner.thickness),
                    pressure=si(cleaner.pressure),
                    friction=cleaner.friction,
                ),
                "ISO 5048, F_r",
            ),
        )
        for i, cleaner in enumerate(conveyor.route.cleaners, start=1)
    )


def bends(conveyor: Conveyor, places: Places) -> tuple[Bend, ...]:
    """Wraps, and bearings of every pulley but the driven ones; none beside the length coefficient C."""
    if conveyor.calculation.secondary == "C":
        return ()
    driven = driven_pulleys(conveyor)
    return tuple(
        _bend(conveyor, pulley, places, driven=i in driven) for i, pulley in enumerate(conveyor.route.pulleys)
    )


def driven_pulleys(conveyor: Conveyor) -> frozenset[int]:
    """Which pulleys of the route the drives turn: at each drive's place as many as stand there, those most wrapped.

    What else stands there bends the belt or is a snub, and is not driven.
    """
    found: set[int] = set()
    for place in {(drive.position, drive.section) for drive in conveyor.drive.pulleys}:
        wraps = [si(d.wrap_angle) for d in conveyor.drive.pulleys if (d.position, d.section) == place]
        count = sum(math.ceil(wrap / _MOST_DRIVEN_WRAP) for wrap in wraps)
        beside = [
            (-si(pulley.wrap_angle), -si(pulley.diameter), i)
            for i, pulley in enumerate(conveyor.route.pulleys)
            if (pulley.position, pulley.section) == place and si(pulley.wrap_angle) >= _LEAST_DRIVEN_WRAP
        ]
        found.update(i for _, _, i in sorted(beside)[:count])
    return frozenset(found)


def _pulley_spot(conveyor: Conveyor, pulley: Pulley, places: Places, *, driven: bool) -> Spot:
    """Where the belt meets a pulley; one beside a driven one on the return strand, on a strand before the drive."""
    if pulley.position == "take-up":
        return places.take_up(conveyor.route.take_up)
    before = places.before(pulley.position, pulley.section)
    at = {(drive.position, drive.section): places.drive(drive) for drive in conveyor.drive.pulleys}
    drive = at.get((pulley.position, pulley.section))
    if drive is not None and driven:
        return drive
    return places.behind("head", None) if drive is not None and pulley.position == "head" else before


def _bend(conveyor: Conveyor, pulley: Pulley, places: Places, *, driven: bool) -> Bend:
    spot = _pulley_spot(conveyor, pulley, places, driven=driven)
    place = pulley.position if pulley.section is None else f"behind {pulley.section}, {pulley.position}"
    slack, taut = (_wrap(conveyor, pulley, tension) for tension in (0.0, _SLOPE_OVER))
    turn = pulley_bearing_resistance(
        1.0, shaft_diameter=si(pulley.shaft_diameter), pulley_diameter=si(pulley.diameter)
    )
    return Bend(
        name=pulley.name,
        spot=spot,
        place=place,
        wrap=(slack, (taut - slack) / _SLOPE_OVER),
        bearings=None if driven else turn,
        mass=si(pulley.mass),
        wrap_angle=si(pulley.wrap_angle),
    )


def _wrap(conveyor: Conveyor, pulley: Pulley, tension: float) -> float:
    belt = conveyor.belt
    law = steel_cord_wrap_resistance if belt.carcass.kind == "steel cord" else fabric_wrap_resistance
    parts = (belt.top_cover.thickness, belt.bottom_cover.thickness, belt.carcass.thickness)
    return law(
        belt_width=si(belt.width),
        tension=tension,
        belt_thickness=math.fsum(si(part) for part in parts),
        pulley_diameter=si(pulley.diameter),
    )
