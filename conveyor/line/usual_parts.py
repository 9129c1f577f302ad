"""Usual parts where the spec gives none: a loading point, cleaners, pulleys.

Figures are those of the worked example of ISO 5048 (skirts as long as the belt runs in a second and 0.625 of its width
apart, blades of the belt's width and 8 mm, half-turn wraps), bulk that lands without speed, seals of the skirts as CEMA
has them (they rub on the empty belt too), and general knowledge (two cleaners, shafts of a fifth of the pulley, a
take-up pulley between two bends).
"""

from __future__ import annotations

from typing import Final, Literal

from conveyor.errors import RangeError
from conveyor.laws.belt_strength import pulley_group_diameter
from conveyor.laws.idler_sets import lump_load_factor
from conveyor.laws.resistance.cema import FOOT, POUND_FORCE, SEALS_PER_FOOT
from conveyor.laws.tension import PULLEY_FACTOR
from conveyor.line.optional_quantities import si_or_default
from conveyor.models import Cleaner, Conveyor, Feeding, Pulley
from conveyor.units import from_si, quantity, si

SKIRT_TRAVEL_TIME: Final = 4.8 / 4.8  # [s], worked example of ISO 5048: 4.8 m at 4.8 m/s
SKIRT_WIDTH_RATIO: Final = 0.75 / 1.2  # [-], worked example of ISO 5048: over the belt's width
CLEANER_COUNT: Final = 2  # general knowledge: one at the head pulley, one behind it
CLEANER_THICKNESS: Final = "8 mm"  # worked example of ISO 5048
SKIRT_SEALS: Final = SEALS_PER_FOOT.value * POUND_FORCE / FOOT  # [N/m] of skirt, both sides; CEMA
SHAFT_DIAMETER_RATIO: Final = 0.2  # [-], general knowledge: over the pulley's diameter
_Place = Literal["head", "take-up", "tail"]
_ENDS: Final[tuple[Literal["head", "tail"], ...]] = ("head", "tail")
LOOP_KINDS: Final = frozenset({"gravity", "winch", "locked winch"})
"""Kinds of take-up with pulleys of their own in the belt's loop, but at the tail; general knowledge."""
TAKE_UP_WRAPS: Final = {"bend 1": "90 deg", "take-up": None, "bend 2": "90 deg"}  # else half a turn; general knowledge


def route_feeding_points(conveyor: Conveyor) -> tuple[tuple[Feeding, ...], bool]:
    """Loading points of the route, or a usual one; True if assumed."""
    given = conveyor.route.feeding_points
    if given or not _uses_usual_values(conveyor):
        return given, False
    belt, bears = conveyor.belt, conveyor.route.sections[0].loaded
    skirts = from_si(SKIRT_TRAVEL_TIME * si(belt.speed), "length")
    usual = Feeding(
        speed=quantity("0 m/s") if bears else belt.speed,
        skirt_length=skirts if bears else quantity("0 m"),
        skirt_width=from_si(SKIRT_WIDTH_RATIO * si(belt.width), "length"),
        skirtboards=skirts,
        seal_drag=from_si(SKIRT_SEALS, "line force"),
    )
    return (usual,), True


def route_cleaners(conveyor: Conveyor) -> tuple[tuple[Cleaner, ...], bool]:
    """Cleaners of the route, or usual ones; True if assumed."""
    given = conveyor.route.cleaners
    if given or not _uses_usual_values(conveyor):
        return given, False
    usual = Cleaner(count=CLEANER_COUNT, width=conveyor.belt.width, thickness=quantity(CLEANER_THICKNESS, "thickness"))
    return (usual,), True


def route_pulleys(conveyor: Conveyor) -> tuple[tuple[Pulley, ...], bool]:
    """Pulleys of the route, or massless usual ones; True if assumed.

    End pulleys, at a drive of its diameter; the pulley of a take-up that hangs or is pulled in the belt's loop, and its
    two bends. A take-up at the tail, a screw or a fixed carriage moves the tail pulley itself.
    """
    given = conveyor.route.pulleys
    if given or not _uses_usual_values(conveyor):
        return given, False
    head, tail = (_usual_pulley(end, end, _end_diameter(conveyor, end)) for end in _ENDS)
    return (head, *_take_up_pulleys(conveyor), tail), True


def _take_up_pulleys(conveyor: Conveyor) -> tuple[Pulley, ...]:
    """Pulley of the take-up and its bends, of the least diameter of their group; none where it moves the tail."""
    take_up = conveyor.route.take_up
    if take_up is None or take_up.kind not in LOOP_KINDS or take_up.position == "tail":
        return ()
    diameter = pulley_group_diameter(_least_diameter(conveyor), group="B")
    return tuple(_usual_pulley(name, "take-up", diameter, wrap) for name, wrap in TAKE_UP_WRAPS.items())


def _end_diameter(conveyor: Conveyor, end: str) -> float:
    """Diameter of the pulley at head or tail [m]: that of a drive there where given, else the least."""
    drives = (drive for drive in conveyor.drive.pulleys if drive.position == end)
    given = next((drive.pulley_diameter for drive in drives if drive.pulley_diameter is not None), None)
    return si_or_default(given, _least_diameter(conveyor))


def _least_diameter(conveyor: Conveyor) -> float:
    """Least diameter of a drive pulley that the carcass bears [m]; other carcasses as EP."""
    carcass = conveyor.belt.carcass
    factor = next((c for kind, c in PULLEY_FACTOR.items() if kind == carcass.kind), PULLEY_FACTOR["EP"])
    return factor * si(carcass.thickness)


def _usual_pulley(name: str, position: _Place, diameter: float, wrap: str | None = None) -> Pulley:
    return Pulley.model_construct(  # unvalidated: a 50 mm carcass needs more than the largest pulley
        name=name,
        position=position,
        diameter=from_si(diameter, "length"),
        shaft_diameter=from_si(SHAFT_DIAMETER_RATIO * diameter, "length"),
        mass=from_si(0.0, "mass"),
        section=None,
        wrap_angle=None if wrap is None else quantity(wrap),
    )


def _uses_usual_values(conveyor: Conveyor) -> bool:
    return conveyor.calculation.not_given == "usual values"


def usual_lump_factor(lump: float | None, density: float) -> float | None:
    """Load factor of lumps of a size [m], 1 for unknown size; None outside the printed table."""
    try:
        return 1.0 if lump is None else lump_load_factor(lump, density=density)
    except RangeError:
        return None
