"""Pulleys and transitions of the belt, in SI."""

from __future__ import annotations

from dataclasses import dataclass, replace

from conveyor.laws.pulley import Keyway, Steel
from conveyor.line import usual_parts
from conveyor.line.loop_positions import LoopPosition, LoopPositions
from conveyor.line.optional_quantities import si_or_default, si_or_none
from conveyor.line.stretches import Strand
from conveyor.models import Conveyor, Pulley
from conveyor.models.driven_pulleys import driven_pulleys
from conveyor.units import si


@dataclass(frozen=True)
class BendPulley:
    """A pulley that bends the belt: diameters, distances of bearings and hubs [m], mass [kg], wrap [rad], rating [N].

    `pull_angle` is between the belt's pull and straight down [rad], `bearing_life` the required one [s],
    `allowed_pressure` that of its lagging [Pa]; None not given. `driven`: it has a drive.
    """

    name: str
    position: str
    spot: LoopPosition
    place: str
    diameter: float
    shaft_diameter: float
    mass: float
    wrap_angle: float
    driven: bool
    pull_angle: float
    bearing_centres: float | None
    hub_centres: float | None
    hub_diameter: float
    shaft_steel: Steel | None
    keyway: Keyway
    bearing_rating: float | None
    bearing_life: float | None
    allowed_pressure: float | None
    assumed: bool = False


@dataclass(frozen=True)
class TransitionZone:
    """Transition between trough or pipe and pulley: length [m], None not given; pulley height over its depth [-]."""

    end: str
    length: float | None
    pulley_height: float
    strand: Strand = "carry"

    @property
    def name(self) -> str:
        """End, and the strand if it is the return one."""
        return self.end if self.strand == "carry" else f"{self.end}, return"


def name_pulley(name: str) -> str:
    """Name of a pulley for sentences: with the word, once.

    >>> name_pulley("head"), name_pulley("take-up pulley")
    ('head pulley', 'take-up pulley')
    """
    return name if name.lower().endswith("pulley") else f"{name} pulley"


def bend_pulleys(conveyor: Conveyor, places: LoopPositions) -> tuple[BendPulley, ...]:
    """Pulleys of a conveyor, by default the usual ones."""
    pulleys, assumed = usual_parts.route_pulleys(conveyor)
    driven = {one.pulley: one.wrap for one in driven_pulleys(conveyor.drive, pulleys)}
    return tuple(
        replace(_bend_pulley(conveyor, pulley, places, driven.get(i)), assumed=assumed)
        for i, pulley in enumerate(pulleys)
    )


def _bend_pulley(conveyor: Conveyor, pulley: Pulley, places: LoopPositions, drive_wrap: float | None) -> BendPulley:
    """Pulley in SI; with the wrap of its drive [rad] where it has one and no wrap of its own."""
    driven = drive_wrap is not None
    return BendPulley(
        name=pulley.name,
        position=pulley.position,
        spot=_pulley_position(conveyor, pulley, places, driven=driven),
        place=pulley.position if pulley.section is None else f"behind {pulley.section}, {pulley.position}",
        diameter=si(pulley.diameter),
        shaft_diameter=si(pulley.shaft_diameter),
        mass=si(pulley.mass),
        wrap_angle=si_or_default(pulley.wrap_angle, drive_wrap or pulley.wrap_or_half_turn),
        driven=driven,
        pull_angle=si(pulley.pull_angle),
        bearing_centres=si_or_none(pulley.bearing_centres),
        hub_centres=si_or_none(pulley.hub_centres),
        hub_diameter=si_or_default(pulley.hub_shaft_diameter, si(pulley.shaft_diameter)),
        shaft_steel=pulley.shaft_steel,
        keyway=pulley.keyway,
        bearing_rating=si_or_none(pulley.bearing_rating),
        bearing_life=si_or_none(pulley.bearing_life),
        allowed_pressure=si_or_none(pulley.lagging_pressure),
    )


def transition_zones(conveyor: Conveyor) -> tuple[TransitionZone, ...]:
    """Transitions at tail and head that the spec gives; a pipe on the return strand opens and closes there too."""
    given = {"tail": conveyor.route.tail_transition, "head": conveyor.route.head_transition}
    strands: tuple[Strand, ...] = ("carry", "return") if conveyor.idlers.return_.shape.closed else ("carry",)
    return tuple(
        TransitionZone(end, si_or_none(zone.length), si_or_default(zone.pulley_height, 0.0), strand)
        for strand in strands
        for end, zone in given.items()
        if zone is not None
    )


def _pulley_position(conveyor: Conveyor, pulley: Pulley, places: LoopPositions, *, driven: bool) -> LoopPosition:
    """Position of a pulley; one next to a driven one is behind the drive at the head, before it elsewhere."""
    if pulley.position == "take-up":
        return places.take_up(conveyor.route.take_up)
    at = {(drive.position, drive.section): places.drive(drive) for drive in conveyor.drive.pulleys}
    drive = at.get((pulley.position, pulley.section))
    if drive is not None and driven:
        return drive
    if drive is not None and pulley.position == "head":
        return places.behind("head", None)
    return places.before(pulley.position, pulley.section)
