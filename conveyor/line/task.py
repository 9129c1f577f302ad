"""What a conveyor is sized from, in SI, and the spec of a choice of its parts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Final

from conveyor.files import libraries
from conveyor.laws.belt import PULLEY_DIAMETERS, least_cover, next_pulley_diameter, pulley_group_diameter
from conveyor.laws.loading import cross_section, filled_width, usable_width
from conveyor.laws.sizing import (
    PULLEY_MASS,
    carcass_mass,
    least_width_for_lumps,
    recommended_speed,
    roll_shell_mass,
    standard_edge_distance,
    wear_addition,
)
from conveyor.laws.tension import least_pulley_diameter
from conveyor.line.defaults import SHAFT
from conveyor.models import Conveyor
from conveyor.models.sizing import DriveLayout, SiteRules, SizingDuty, sizes
from conveyor.units import from_si, in_si, si

_BEARING_INSET: Final = 0.02  # [m], middle of a bearing inside the tube's end; general knowledge
_OVERLAND: Final = 1000.0  # [m], from which sets stand as far apart as overland; general knowledge
_STEP: Final = 0.5e-3  # [m], of cover thicknesses
_V_ANGLE: Final = math.radians(10.0)
_V_FROM: Final = 1.2  # [m], belt width from which return sets are Vs of two rolls; general knowledge


@dataclass(frozen=True)
class CarcassClass:
    """A class of belts: kind, strength [N/m], thickness [m], mass [kg/m²], least covers [m]."""

    kind: str
    strength: float
    thickness: float

    @property
    def steel_cord(self) -> bool:
        """Whether it is of steel cords."""
        return self.kind == "steel cord"

    @property
    def mass(self) -> float:
        """Per area [kg/m²]."""
        return carcass_mass(self.strength, thickness=self.thickness, steel_cord=self.steel_cord)

    @property
    def least_cover(self) -> float:
        """Least thickness of a cover [m]."""
        return least_cover(self.thickness, steel_cord=self.steel_cord)

    def covers(self, addition: float) -> tuple[float, float]:
        """Top and bottom cover with an addition against wear, on steps of half a millimetre; at most 3 to 1 [m]."""
        top = _stepped(self.least_cover + addition)
        return top, _stepped(max(self.least_cover, top / 3.0))

    @property
    def drive_diameter(self) -> float:
        """Least diameter of a drive pulley of the series [m]; beyond the series what the carcass asks for."""
        least = least_pulley_diameter(self.thickness, carcass="steel cord" if self.steel_cord else "EP")
        return _pulley(least)

    @property
    def bend_diameter(self) -> float:
        """The same of tail and take-up."""
        least = least_pulley_diameter(self.thickness, carcass="steel cord" if self.steel_cord else "EP")
        return _pulley(pulley_group_diameter(least, group="B"))


def _stepped(thickness: float) -> float:
    return _STEP * math.ceil(thickness / _STEP - 1e-9)  # decimals: 6.5 mm is a step


def _pulley(least: float) -> float:
    return next_pulley_diameter(least) if least <= PULLEY_DIAMETERS[-1] else least


@dataclass(frozen=True)
class RollSize:
    """Rolls of a diameter [m]: wall [m], ends [kg], rating C of a bearing [N]."""

    diameter: float
    wall: float
    ends: float
    rating: float

    def mass(self, length: float) -> float:
        """What turns [kg]."""
        return roll_shell_mass(self.diameter, wall=self.wall, length=length) + self.ends


@dataclass(frozen=True)
class WidthSize:
    """A belt width and lengths of its rolls [m]."""

    belt: float
    one: float
    two: float
    three: float

    @property
    def return_rolls(self) -> tuple[int, float, float]:
        """Number, length [m] and angle [rad] of the rolls of a return set."""
        return (2, self.two, _V_ANGLE) if self.belt >= _V_FROM else (1, self.one, 0.0)


@dataclass(frozen=True)
class Trough:
    """A belt width with a trough angle [rad]: largest cross-section of the bulk [m²]."""

    width: WidthSize
    angle: float
    area: float


@dataclass(frozen=True)
class Choice:
    """What a candidate is made of; SI.

    Attributes
    ----------
    trough : Trough
        Width of the belt, and angle of the outer rolls.
    speed, filling : float
        Of the belt [m/s], and of its cross-section [-].
    roll : RollSize
        Of both strands.
    carry, back : float
        Distances of the sets of carry and return strand [m].
    cover : int
        Number of the compound of the bottom cover.
    kind : str
        Of the carcass.
    drives : str
        Where they stand.
    graduated : tuple of float
        Distance of carry sets of each section [m]; empty where it is `carry`.
    thicker : float
        Bottom cover beyond the least one [m].
    """

    trough: Trough
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
class Chosen:
    """What follows from a candidate's tensions: class, covers [m], motor of each drive [W], brakes at the belt [N].

    `settling`: whether it does from exact ones already.
    """

    carcass: CarcassClass
    top: float
    bottom: float
    motors: tuple[float, ...]
    brake: float
    settling: bool = False


@dataclass(frozen=True, eq=False)
class SizingTask:
    """A duty in SI."""

    duty: SizingDuty

    @property
    def rules(self) -> SiteRules:
        """Of the site."""
        return self.duty.rules

    @property
    def flow(self) -> float:
        """[kg/s]."""
        return si(self.duty.material.flow)

    @property
    def density(self) -> float:
        """[kg/m³]."""
        return si(self.duty.material.density)

    @property
    def gravity(self) -> float:
        """[m/s²]."""
        return si(self.duty.calculation.gravity)

    @cached_property
    def sections(self) -> tuple[tuple[float, float], ...]:
        """Length and rise of each [m]."""
        return tuple((si(section.length), section.rise) for section in self.duty.sized_route.sections)

    @property
    def length(self) -> float:
        """[m]."""
        return math.fsum(length for length, _ in self.sections)

    @property
    def seconds(self) -> float:
        """Of running in a year [s]."""
        return self.duty.operation.seconds_per_year

    @property
    def energy_price(self) -> float:
        """[currency/kWh]."""
        price = self.duty.operation.price
        return 0.0 if price is None else price.amount

    @property
    def feed_in_price(self) -> float:
        """Of energy fed back [currency/kWh]; 0 without one."""
        credit = self.duty.operation.feed_in_price
        return 0.0 if credit is None else credit.amount

    @property
    def roll_life(self) -> float:
        """L10 asked of a set [s]."""
        return si(self.rules.roll_life)

    @property
    def sags(self) -> tuple[float, float]:
        """Of carry and return strand, over the distance of the sets [-]."""
        return si(self.rules.carry_sag), si(self.rules.return_sag)

    @property
    def grip(self) -> tuple[float, float]:
        """Friction [-] and wrap [rad] of a drive pulley."""
        return self.rules.friction, si(self.rules.wrap_angle)

    @property
    def efficiency(self) -> float:
        """[-]."""
        return si(self.rules.efficiency)

    @property
    def largest_motor(self) -> float:
        """[W]."""
        return si(self.rules.largest_motor)

    @property
    def take_up_travel(self) -> float:
        """Longest of a take-up [m]."""
        return si(self.rules.take_up_travel)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Of carcasses to choose from."""
        return self.rules.carcasses

    @property
    def cold(self) -> bool:
        """Whether motors and strength are for colder covers than the energy."""
        coldest = self.duty.coldest
        return coldest is not None and si(coldest) < si(self.duty.ambient.belt)

    @cached_property
    def speeds(self) -> tuple[float, ...]:
        """To choose from [m/s]."""
        return tuple(map(si, self.rules.speeds or sizes().speeds))

    @cached_property
    def spacings(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """To choose from, of carry and return sets [m]."""
        rules, wide = self.rules, ", overland" if self.length >= _OVERLAND else ""
        pairs = []
        for strand, asked, series in (
            ("carry", rules.carry_spacings, sizes().carry_spacings),
            ("return", rules.return_spacings, sizes().return_spacings),
        ):
            widest = in_si(libraries.entries("spacing")[f"{strand}{wide}"].fields["to"], "length")
            pairs.append(tuple(map(si, asked)) or tuple(a for a in map(si, series) if a <= widest))
        return pairs[0], pairs[1]

    @property
    def _fitted(self) -> Iterator[float]:
        """Widths of skirts, cleaners and ploughs that the duty gives [m]."""
        route = self.duty.sized_route
        yield from (si(cleaner.width) for cleaner in route.cleaners)
        yield from (si(plough.width) for plough in route.ploughs)
        for point in route.feeding_points:
            yield si(point.skirt_width)

    @cached_property
    def troughs(self) -> tuple[Trough, ...]:
        """Widths that take the lumps, with every trough angle."""
        rules, surcharge = self.rules, self.duty.material.surcharge
        asked = [si(width) for width in rules.widths]
        lumps = least_width_for_lumps(si(self.duty.lump), surcharge_angle=surcharge, share=self.duty.lumps)
        least = max([lumps, *self._fitted])
        shapes = []
        for row in sizes().widths:
            width = WidthSize(si(row.belt), si(row.one), si(row.two), si(row.three))
            if width.belt < least or (asked and not any(map(partial(math.isclose, width.belt), asked))):
                continue
            for angle in map(si, rules.trough_angles):
                section = cross_section(
                    usable_width(width.belt),
                    middle_roll_length=width.three,
                    trough_angle=angle,
                    surcharge_angle=surcharge,
                )
                shapes.append(Trough(width, angle, section.area))
        return tuple(shapes)

    def filling(self, trough: Trough, speed: float) -> float | None:
        """Share of the cross-section under bulk [-]; None where rules of speed, filling or edges are not kept."""
        width, given = trough.width.belt, self.rules.fastest
        fastest = si(given) if given else recommended_speed(width, abrasiveness=self.duty.abrasiveness)
        if speed > fastest:
            return None
        area = self.flow / (self.density * speed)
        filling = area / trough.area
        narrowest = width == self.troughs[0].width.belt
        if filling > si(self.rules.filling) or (filling < si(self.rules.least_filling) and not narrowest):
            return None
        under = filled_width(
            area,
            middle_roll_length=trough.width.three,
            trough_angle=trough.angle,
            surcharge_angle=self.duty.material.surcharge,
        )
        return filling if 0.5 * (width - under) >= standard_edge_distance(width) else None

    @cached_property
    def rolls(self) -> tuple[RollSize, ...]:
        """Of the library."""
        return tuple(
            RollSize(si(row.diameter), si(row.wall), si(row.ends), si(row.dynamic_rating))
            for row in sizes().rolls
        )

    def turns_slowly(self, roll: RollSize, speed: float) -> bool:
        """Whether a roll keeps the rule of rotation."""
        return speed / (math.pi * roll.diameter) <= si(self.rules.roll_rotation)

    @cached_property
    def carcasses(self) -> Mapping[str, tuple[CarcassClass, ...]]:
        """Classes of each kind, the weakest first."""
        rows = {"EP": sizes().textile, "steel cord": sizes().steel_cord}
        return {
            kind: tuple(CarcassClass(kind, si(row.strength), si(row.thickness)) for row in rows[kind])
            for kind in self.rules.carcasses
        }

    def wear(self, speed: float) -> float:
        """Cover to be added against wear at a belt speed [m]."""
        duty = self.duty
        return wear_addition(
            lump=si(duty.lump),
            density=self.density,
            round_time=2.0 * self.length / speed,
            abrasiveness=duty.abrasiveness,
            loading=duty.loading,
        )

    def covers(self, choice: Choice, carcass: CarcassClass) -> tuple[float, float]:
        """Top and bottom cover of a candidate with a class of belt [m]."""
        top, bottom = carcass.covers(self.wear(choice.speed))
        return top, bottom + choice.thicker

    def spec(self, choice: Choice, chosen: Chosen, name: str) -> Conveyor:
        """The complete spec of a candidate.

        Raises
        ------
        InputError
            The spec is refused: what the duty gives does not fit the choice.
        """
        duty, carcass = self.duty, chosen.carcass
        route = duty.sized_route.as_data()
        for section, spacing in zip(route["sections"], choice.graduated, strict=bool(choice.graduated)):
            section["carry_spacing"] = _written(spacing, "m")
        route["pulleys"] = [
            self._pulley(name, place, size, choice.trough.width.belt)
            for name, place, size in (
                ("head", "head", carcass.drive_diameter),
                ("take-up", "take-up", carcass.bend_diameter),
                (
                    "tail",
                    "tail",
                    carcass.drive_diameter if "tail" in choice.drives else carcass.bend_diameter,
                ),
            )
        ]
        route["take_up"] = {"kind": "gravity"}
        covers = duty.covers
        return Conveyor.from_data({
            "name": name,
            "belt": {
                "width": _written(choice.trough.width.belt, "mm"),
                "speed": _written(choice.speed, "m/s"),
                "top_cover": {"thickness": _written(chosen.top, "mm"), "compound": covers[0]},
                "bottom_cover": {"thickness": _written(chosen.bottom, "mm"), "compound": covers[choice.cover]},
                "carcass": {
                    "kind": carcass.kind,
                    "strength": _written(carcass.strength, "N/mm"),
                    "thickness": _written(carcass.thickness, "mm"),
                    "mass": f"{carcass.mass:.3g} kg/m^2",
                },
            },
            "idlers": self._idlers(choice),
            "material": duty.material.as_data(),
            "route": route,
            "drive": self._drive(choice, chosen),
            "ambient": duty.ambient.as_data(),
            "operation": duty.operation.as_data(),
            "calculation": duty.calculation.as_data(),
            "report": duty.report.as_data(),
        })  # fmt: skip

    def colder(self, conveyor: Conveyor) -> Conveyor:
        """The same conveyor with its covers as cold as they get."""
        return conveyor.replace(ambient=conveyor.ambient.replace(belt_temperature=self.duty.coldest))

    def pulley_mass(self, carcass: CarcassClass, width: float) -> float:
        """Of head, take-up and tail pulley together [kg]."""
        sizes = (carcass.drive_diameter, carcass.bend_diameter, carcass.bend_diameter)
        return math.fsum(PULLEY_MASS * size**2 * width for size in sizes)

    @staticmethod
    def _pulley(name: str, place: str, diameter: float, width: float) -> dict[str, Any]:
        return {
            "name": name,
            "position": place,
            "diameter": _written(diameter, "mm"),
            "shaft_diameter": _written(SHAFT * diameter, "mm"),
            "mass": f"{PULLEY_MASS * diameter**2 * width:.3g} kg",
        }

    def _idlers(self, choice: Choice) -> dict[str, Any]:
        carry_sag, return_sag = self.sags
        count, length, angle = choice.trough.width.return_rolls
        return {
            "carry": {
                "rolls": 3,
                "spacing": _written(choice.carry, "m"),
                "trough_angle": _written(choice.trough.angle, "deg"),
                "roll": _roll(choice.roll, choice.trough.width.three),
                "sag": f"{100.0 * carry_sag:.6g} %",
            },
            "return": {
                "rolls": count,
                "spacing": _written(choice.back, "m"),
                "trough_angle": _written(angle, "deg"),
                "roll": _roll(choice.roll, length),
                "sag": f"{100.0 * return_sag:.6g} %",
            },
        }

    def _drive(self, choice: Choice, chosen: Chosen) -> dict[str, Any]:
        rules, motors = self.rules, chosen.motors
        one = {"wrap_angle": _written(si(rules.wrap_angle), "deg"), "friction": rules.friction}
        brake = {"brake_force": f"{chosen.brake / 1e3:.4g} kN"} if chosen.brake > 0.0 else {}
        first = {
            **one,
            **brake,
            "position": "tail" if choice.drives == "tail" else "head",
            "installed_power": _written(motors[0], "kW"),
            "efficiency": f"{100.0 * self.efficiency:.6g} %",
            "start_factor": rules.start_factor,
        }
        further = []
        for number, motor in enumerate(motors[1:], start=2):
            tail = "tail" in choice.drives and number == len(motors)
            place = {"name": f"drive {number}", "position": "tail" if tail else "head"}
            further.append({**one, **place, "installed_power": _written(motor, "kW")})
        return {**first, "further_drives": further} if further else first


def _roll(roll: RollSize, length: float) -> dict[str, Any]:
    return {
        "diameter": _written(roll.diameter, "mm"),
        "length": _written(length, "mm"),
        "rotating_mass": f"{roll.mass(length):.3g} kg",
        "bearing": {
            "dynamic_rating": _written(roll.rating, "kN"),
            "distance": _written(length - 2.0 * _BEARING_INSET, "mm"),
        },
    }


_KINDS: Final = {"m": "length", "mm": "thickness", "m/s": "speed", "deg": "angle", "kW": "power", "N/mm": "line force",
                 "kN": "force"}  # fmt: skip


def _written(value: float, unit: str) -> str:
    """Number and unit as specs have them."""
    number = float(from_si(value, _KINDS[unit], unit).magnitude)
    return f"{number:.6g} {unit}"


def spread(power: float, layout: DriveLayout) -> Sequence[float]:
    """Power of each drive: one pulley, or several alike."""
    count = {"head": 1, "tail": 1, "head, two pulleys, and tail": 3}.get(layout, 2)
    return (power / count,) * count
