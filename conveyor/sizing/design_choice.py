"""What is chosen for a design: belt, rolls and troughs by the estimate, parts by exact calculations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, NamedTuple

from conveyor.errors import RangeError
from conveyor.laws.belt_strength import CLASSIC_SAFETY, least_cover
from conveyor.laws.idler_sets import CemaClass, rated_set_load
from conveyor.laws.preliminary_sizing import carcass_mass, roll_shell_mass, suitable_roll_lengths
from conveyor.laws.tension import least_pulley_diameter, usual_stiffness
from conveyor.models.maker_lists import ListedItem
from conveyor.models.sizing import DriveLayout, within_limit
from conveyor.units import from_si

TakeUpPlace = Literal["drive", "head end", "tail end"]
_V_ANGLE: Final = math.radians(10.0)


@dataclass(frozen=True)
class CarcassClass:
    """A carcass class: kind, strength [N/m], thickness [m]; if listed mass [kg/m²] and rated tension [N/m].

    Of a maker's list its name there, its stiffness [N/m], and its covers [m] where it is sold with them.
    """

    kind: str
    strength: float
    thickness: float
    listed_mass: float | None = None
    rating: float | None = None
    listed: str = ""
    own_stiffness: float | None = None
    own_covers: tuple[float, float] | None = None

    @property
    def steel_cord(self) -> bool:
        """True for steel cords."""
        return self.kind == "steel cord"

    @property
    def mass(self) -> float:
        """Mass per area [kg/m²]."""
        if self.listed_mass is not None:
            return self.listed_mass
        return carcass_mass(self.strength, thickness=self.thickness, steel_cord=self.steel_cord)

    @property
    def safety(self) -> float:
        """Strength over the allowed tension in steady running [-]."""
        if self.rating is not None:
            return self.strength / self.rating
        return CLASSIC_SAFETY["steel cord" if self.steel_cord else "textile"]

    @property
    def stiffness(self) -> float:
        """Usual tensile stiffness per width [N/m]."""
        if self.own_stiffness is not None:
            return self.own_stiffness
        strength = self.strength if self.rating is None else None
        usual = usual_stiffness(strength, rating=self.rating, carcass=self.kind)
        if usual is None:
            raise AssertionError("every kind of the series has a usual stiffness")
        return usual

    @property
    def name(self) -> str:
        """Trade name, such as ST1000, or that of a maker's list."""
        if self.listed:
            return self.listed
        if self.rating is not None:
            return f"{from_si(self.rating, 'line force', 'PIW').magnitude:.0f} PIW"
        return f"{'ST' if self.steel_cord else 'EP'}{self.strength / 1e3:.0f}"

    @property
    def least_cover(self) -> float:
        """Least thickness of a cover [m]."""
        return least_cover(self.thickness, steel_cord=self.steel_cord)

    @property
    def least_pulley(self) -> float:
        """Least diameter of a drive pulley [m]."""
        return least_pulley_diameter(self.thickness, carcass="steel cord" if self.steel_cord else "EP")


class RollPiece(NamedTuple):
    """A roll of a maker's list: its name, length [m], rotating mass [kg] and bearing rating C [N]."""

    name: str
    length: float
    mass: float
    rating: float


@dataclass(frozen=True)
class RollSize:
    """Rolls of one diameter [m]: wall [m], mass of the ends [kg], bearing rating C [N], CEMA class of their sets.

    `pieces`: those of a maker's list; without them rolls of any length.
    """

    diameter: float
    wall: float
    ends: float
    rating: float
    cema_class: CemaClass | None = None
    pieces: tuple[RollPiece, ...] = ()

    def piece(self, length: float, shortest: float, longest: float) -> RollPiece | None:
        """Listed roll between two lengths, None if there is none.

        That of the rating, else the next better, else the best; of those the nearest to a length, then the lightest.
        """
        near = [one for one in self.pieces if within_limit(shortest, one.length) and within_limit(one.length, longest)]
        return min(
            near,
            key=lambda one: (
                one.rating < self.rating,
                abs(one.rating - self.rating),
                abs(one.length - length),
                one.mass,
            ),
            default=None,
        )

    def listed(self, length: float) -> RollPiece | None:
        """Listed roll of a length that a set has; None without a list."""
        return self.piece(length, length, length)

    def nearest(self, width: WidthSize) -> tuple[float, float]:
        """Lengths of the listed rolls nearest to those of the carry and return sets of a width [m]."""
        carry, back = (
            min((one.length for one in self.pieces), key=lambda long: abs(long - wanted))
            for wanted, _, _ in width.suitable_lengths
        )
        return carry, back

    def mass(self, length: float) -> float:
        """Rotating mass of a roll of a length [kg]."""
        listed = self.listed(length)
        if listed is not None:
            return listed.mass
        return roll_shell_mass(self.diameter, wall=self.wall, length=length) + self.ends

    def set_rating(self, width: float, angle: float, rolls: int) -> float:
        """Rating of a set of its class [N]; infinite without a class, 0 where the class has no such set."""
        if self.cema_class is None:
            return math.inf
        try:
            return rated_set_load(self.cema_class, belt_width=width, trough_angle=angle, rolls=rolls)
        except RangeError:
            return 0.0


@dataclass(frozen=True)
class WidthSize:
    """A belt width and its roll lengths for sets of one, two and three [m]; `vee`: return sets are Vs of two.

    `diameters`: usual ones of its rolls [m], any without.
    """

    belt: float
    one: float
    two: float
    three: float
    vee: bool
    diameters: tuple[float, ...] = ()

    @property
    def return_rolls(self) -> tuple[int, float, float]:
        """Number, length [m] and trough angle [rad] of the rolls of a return set."""
        return (2, self.two, _V_ANGLE) if self.vee else (1, self.one, 0.0)

    @property
    def suitable_lengths(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Length of the rolls of carry and of return sets, the shortest and the longest that do instead [m]."""
        count, back, _ = self.return_rolls
        return (
            (self.three, *suitable_roll_lengths(self.three, belt_width=self.belt, rolls=3)),
            (back, *suitable_roll_lengths(back, belt_width=self.belt, rolls=count)),
        )

    def with_rolls(self, roll: RollSize) -> WidthSize | None:
        """The width with the lengths of listed rolls; None if none do for the sets of both strands."""
        if not roll.pieces:
            return self
        carry, back = (roll.piece(*lengths) for lengths in self.suitable_lengths)
        if carry is None or back is None:
            return None
        with_carry = replace(self, three=carry.length)
        return replace(with_carry, two=back.length) if self.vee else replace(with_carry, one=back.length)


@dataclass(frozen=True)
class TroughSize:
    """A belt width with a trough angle [rad] and its largest bulk cross-section on the steepest section [m²]."""

    width: WidthSize
    angle: float
    area: float


@dataclass(frozen=True)
class DesignChoice:
    """Parts of a candidate design, SI.

    Attributes
    ----------
    trough : Trough
        Width of the belt, and angle of the outer rolls.
    speed, filling : float
        Belt speed [m/s] and filling of the cross-section [-].
    roll : RollSize
        Rolls of both strands.
    carry, back : float
        Spacing of carry and return sets [m].
    cover : int
        Index of the compound of the bottom cover.
    kind : str
        Kind of carcass.
    drives : str
        Drive layout.
    graduated : tuple of float
        Spacing of the carry sets of each section [m]; empty where it is `carry`.
    thicker : float
        Addition to the least bottom cover [m].
    """

    trough: TroughSize
    speed: float
    filling: float
    roll: RollSize
    carry: float
    back: float
    cover: int
    kind: str
    drives: DriveLayout
    graduated: tuple[float, ...] = ()
    thicker: float = 0.0


@dataclass(frozen=True)
class ListedPart:
    """Item of a maker's list chosen for a place, by a figure of a kind, SI.

    `needed`: what the design asks for, with its reserve; `rated`: what the item has.
    """

    place: str
    item: ListedItem
    kind: str
    needed: float = field(compare=False)
    rated: float

    @property
    def use(self) -> float:
        """Needed over rated figure [-]."""
        return self.needed / self.rated


@dataclass(frozen=True)
class ListedParts:
    """Items chosen for pulleys and drives; empty or None where a kind is not listed.

    `pulleys`: head, take-up (its bends alike), tail; `gearbox`, `coupling`: of every motor; `backstop`, `brake`: of
    the first drive; `drive_diameter` [m]; `speed`: of the belt [m/s].
    """

    drive_diameter: float
    speed: float
    pulleys: tuple[ListedPart, ...] = ()
    gearbox: ListedPart | None = None
    coupling: ListedPart | None = None
    backstop: ListedPart | None = None
    brake: ListedPart | None = None

    @property
    def parts(self) -> tuple[ListedPart, ...]:
        """All items chosen."""
        every = (self.gearbox, self.coupling, self.backstop, self.brake)
        return (*self.pulleys, *(part for part in every if part is not None))


@dataclass(frozen=True)
class SelectedParts:
    """Parts selected from a candidate's tensions: carcass, covers [m], motors of each drive [W], brake force [N].

    `backstop`: torque of that on the first pulley [N m]; `take_up`: its tension [N], 0 where grip and sag decide;
    `take_up_place`: on the slack side of the first drive, or at an end of the return strand;
    `listed`: items of makers' lists, None without lists of pulleys and parts of drives;
    `shafts`: diameter of each pulley's shaft [m], none before all loads are known, and of listed pulleys;
    `settling`: selected from exact tensions already.
    """

    carcass: CarcassClass
    top: float
    bottom: float
    motors: tuple[float, ...]
    brake: float
    backstop: float = 0.0
    take_up: float = 0.0
    take_up_place: TakeUpPlace = "drive"
    listed: ListedParts | None = None
    settling: bool = False
    shafts: tuple[float, ...] = ()


def drive_powers(power: float, layout: DriveLayout) -> Sequence[float]:
    """Power of each drive of a layout, equal shares [W]."""
    count = {"head": 1, "tail": 1, "head, two pulleys, and tail": 3}.get(layout, 2)
    return (power / count,) * count
