"""Sizing duty in SI, and the spec of a candidate in the units of its series."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

from conveyor.files import libraries
from conveyor.laws.energy import MOTOR_SERIES, NEMA_MOTORS, next_motor
from conveyor.laws.loading import cross_section, filled_width, usable_width
from conveyor.laws.misalignment import MISALIGNMENT, misalignment_friction
from conveyor.laws.preliminary_sizing import (
    LOADING_SPACING_SHARE,
    least_width_for_lumps,
    normal_spacings,
    recommended_speed,
    standard_edge_distance,
    wear_addition,
)
from conveyor.laws.resistance.cema import POUND_FORCE
from conveyor.laws.take_up import (
    PERMANENT_STRETCH_STEEL_CORD,
    PERMANENT_STRETCH_TEXTILE,
    STEEL_EXPANSION,
    TRAVEL_RESERVE,
)
from conveyor.line.optional_quantities import si_or_none
from conveyor.line.usual_parts import usual_lump_factor
from conveyor.models import Conveyor
from conveyor.models.base import given_data
from conveyor.models.belt_shapes import Trough
from conveyor.models.maker_lists import ListedItem
from conveyor.models.sizing import (
    CarcassRow,
    SiteRules,
    Sizes,
    SizingDuty,
    same_width,
    size_series,
    within_limit,
)
from conveyor.models.variants import with_temperature
from conveyor.sizing.classical_friction import ClassicalFriction
from conveyor.sizing.design_choice import CarcassClass, DesignChoice, RollSize, TroughSize, WidthSize
from conveyor.sizing.listed_sizes import listed_carcasses, listed_rolls, motor_power
from conveyor.sizing.pulley_sizes import PulleySizes
from conveyor.units import Quantity, read_si, si

_KEPT_FIELDS: Final = ("site", "material", "ambient", "operation", "calculation", "report")


@dataclass(frozen=True, eq=False)
class SizingTask:
    """A duty in SI."""

    duty: SizingDuty

    @cached_property
    def kept_fields(self) -> Mapping[str, Any]:
        """Fields that the spec of a design has as the duty gives them."""
        return {name: value for name, value in given_data(self.duty).items() if name in _KEPT_FIELDS}

    @property
    def rules(self) -> SiteRules:
        """Rules of the site."""
        return self.duty.rules

    @property
    def flow(self) -> float:
        """Mass flow [kg/s]."""
        return si(self.duty.material.flow)

    @property
    def density(self) -> float:
        """Bulk density [kg/m³]."""
        return si(self.duty.material.density)

    @property
    def lump(self) -> float:
        """Size of the lumps [m]."""
        return si(self.duty.lump)

    @property
    def gravity(self) -> float:
        """Gravity [m/s²]."""
        return si(self.duty.calculation.gravity)

    @cached_property
    def sections(self) -> tuple[tuple[float, float], ...]:
        """Length and rise of every section [m]."""
        return tuple((si(section.length), section.rise) for section in self.duty.sized_route.sections)

    @property
    def steepest(self) -> float:
        """Inclination of the steepest section, up or down [rad]."""
        return max(abs(math.asin(rise / length)) for length, rise in self.sections)

    @property
    def steepest_for_bulk(self) -> float:
        """Largest slope that the bulk is carried on [rad]."""
        given = self.duty.material.max_slope
        return Trough.steepest if given is None else si(given)

    @property
    def length(self) -> float:
        """Length of the route [m]."""
        return math.fsum(length for length, _ in self.sections)

    @property
    def seconds(self) -> float:
        """Running time in a year [s]."""
        return self.duty.operation.seconds_per_year

    @property
    def energy_price(self) -> float:
        """Price of energy [currency/kWh]; 0 without one."""
        price = self.duty.operation.price
        return 0.0 if price is None else price.amount

    @property
    def feed_in_price(self) -> float:
        """Price of energy fed back [currency/kWh]; 0 without one."""
        credit = self.duty.operation.feed_in_price
        return 0.0 if credit is None else credit.amount

    @property
    def roll_life(self) -> float:
        """Required L10 of a set [s]."""
        return si(self.rules.roll_life)

    @property
    def misalignment_friction(self) -> float:
        """Drag of misaligned sets over their load [-]."""
        return misalignment_friction(MISALIGNMENT[self.duty.site].value)

    @cached_property
    def classical(self) -> ClassicalFriction | None:
        """Friction by the classical method that the duty is sized by; None by the rolling contact."""
        return ClassicalFriction.of(self.duty, self.sections)

    @property
    def bottom_covers(self) -> tuple[int, ...]:
        """Numbers of the bottom covers to choose from; by a method that knows no rubber the cheapest alone."""
        count, prices = len(self.duty.covers), self.duty.prices.amounts
        if self.classical is None:
            return tuple(range(count))
        return (int(count > 1 and prices["special_cover"] < prices["cover"]),)

    @property
    def sags(self) -> tuple[float, float]:
        """Sag of carry and return strand over the spacing of sets [-]."""
        return si(self.rules.carry_sag), si(self.rules.return_sag)

    @property
    def grip(self) -> tuple[float, float]:
        """Friction [-] and wrap [rad] of a drive pulley."""
        return self.rules.friction, si(self.rules.wrap_angle)

    @property
    def efficiency(self) -> float:
        """Efficiency of the drives [-]."""
        return si(self.rules.efficiency)

    @cached_property
    def sizes(self) -> Sizes:
        """Series that parts are chosen from."""
        return size_series(self.duty.series)

    @property
    def _motors(self) -> tuple[float, ...]:
        """Rated motor powers of the series, or of the lists [W]."""
        if self.duty.listed.items("motors"):
            return tuple(sorted({motor_power(item) for item in self.duty.listed.items("motors")}))
        return NEMA_MOTORS if self.duty.series == "US" else MOTOR_SERIES

    @property
    def _largest_motor(self) -> float:
        """Largest motor of the series allowed by the rules [W]; the limit itself if below the series."""
        most = si(self.rules.largest_motor)
        return max((each for each in self._motors if within_limit(each, most)), default=most)

    @property
    def largest_drive(self) -> float:
        """Largest power of all motors of a pulley [W]."""
        return self.rules.motors_per_pulley * self._largest_motor

    def motors(self, power: float) -> float:
        """Total power of the fewest, smallest equal motors of a pulley, with the reserve of the rules [W]."""
        count = self.motor_count(power * self.rules.motor_reserve)
        return count * next_motor(power / count, reserve=self.rules.motor_reserve, series=self._motors)

    def listed_motor(self, rated: float) -> ListedItem | None:
        """Item of a list for the equal motors of a pulley of a rated power [W]; None without lists."""
        one = rated / self.motor_count(rated)
        return next((item for item in self.duty.listed.items("motors") if same_width(motor_power(item), one)), None)

    def motor_count(self, rated: float) -> int:
        """Number of equal motors of a pulley for a rated power [W]."""
        return max(1, math.ceil(round(rated / self._largest_motor, 9)))

    @property
    def take_up_travel(self) -> float:
        """Longest travel of a take-up [m]."""
        return si(self.rules.take_up_travel)

    @property
    def take_up_strain(self) -> float:
        """Strain of the loop that the take-up's travel allows after its reserve [-]."""
        return self.take_up_travel / (self.length * (1.0 + TRAVEL_RESERVE.value))

    def lasting_strain(self, kind: str) -> float:
        """Permanent and thermal strain of a kind of carcass over the temperatures of the duty [-]."""
        if kind != "steel cord":
            return PERMANENT_STRETCH_TEXTILE.value
        cooling = si(self.duty.ambient.belt) - si(self.duty.lowest_temperature)  # [K]
        return PERMANENT_STRETCH_STEEL_CORD.value + STEEL_EXPANSION.value * cooling

    @property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of carcass to choose from, of lists those that they have."""
        return tuple(kind for kind in self.rules.carcasses if self.carcasses[kind])

    @property
    def cold(self) -> bool:
        """True if motors, strength and take-up are for a colder conveyor than the energy."""
        return si(self.duty.lowest_temperature) < si(self.duty.ambient.belt)

    @cached_property
    def speeds(self) -> tuple[float, ...]:
        """Belt speeds to choose from [m/s]; of those that listed gearboxes can give, if any."""
        every = tuple(map(si, self.rules.speeds or self.sizes.speeds))
        geared = self._geared_speeds
        near = tuple(one for one in every if any(abs(v / one - 1.0) <= self.speed_tolerance for v in geared))
        return near or every

    @property
    def speed_tolerance(self) -> float:
        """Largest deviation of the belt speed that gearboxes give from that of the rules, over it [-]."""
        return si(self.rules.speed_tolerance)

    @cached_property
    def _geared_speeds(self) -> tuple[float, ...]:
        """Belt speeds of listed motors, gearboxes and pulleys [m/s]; empty without gearboxes."""
        listed = self.duty.listed
        turns = {
            read_si(motor.fields["motor_speed"], "rotation") / float(gearbox.fields["gear_ratio"])
            for gearbox in listed.items("gearboxes")
            for motor in listed.items("motors")
        }
        return tuple(math.pi * size * turn for turn in turns for size in self.pulley_sizes)

    @property
    def pulley_sizes(self) -> tuple[float, ...]:
        """Diameters of pulleys to choose from, of the lists or the series [m]."""
        pulleys = self.duty.listed.items("pulleys")
        if pulleys:
            return tuple(sorted({read_si(item.fields["diameter"], "length") for item in pulleys}))
        return self.pulleys.series

    @cached_property
    def spacings(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Spacings of carry and return sets to choose from [m]."""
        rules, wide = self.rules, ", US" if self.duty.series == "US" else ""
        if self.duty.site == "overland":
            wide = ", overland"
        pairs = []
        for strand, asked, series in (
            ("carry", rules.carry_spacings, self.sizes.carry_spacings),
            ("return", rules.return_spacings, self.sizes.return_spacings),
        ):
            widest = read_si(libraries.library_entries("spacing")[f"{strand}{wide}"].fields["to"], "length")
            pairs.append(tuple(map(si, asked)) or tuple(a for a in map(si, series) if within_limit(a, widest)))
        return pairs[0], pairs[1]

    def loading_spacing(self, carry: float) -> float:
        """Spacing of the sets where bulk lands [m]: that of the rules, else half that of the carry sets there."""
        asked = self.rules.loading_spacing
        return LOADING_SPACING_SHARE * carry if asked is None else min(si(asked), carry)

    @property
    def _fitted(self) -> Iterator[float]:
        """Widths of skirts, cleaners and ploughs that the duty gives [m]."""
        route = self.duty.sized_route
        yield from (si(cleaner.width) for cleaner in route.cleaners)
        yield from (si(plough.width) for plough in route.ploughs)
        for point in route.feeding_points:
            yield si(point.skirt_width)

    @property
    def trough_angles(self) -> Sequence[Quantity]:
        """Trough angles to choose from."""
        return self.rules.trough_angles or self.sizes.trough_angles

    @property
    def heaps(self) -> bool:
        """True if a heap stands on the steepest section, or troughs hold the bulk."""
        return self.steepest < si(self.duty.material.surcharge_angle) or any(map(si, self.trough_angles))

    @property
    def widest_belt(self) -> float:
        """Width of the widest belt to choose from [m]."""
        return max(map(si, self.rules.widths or [row.belt for row in self.sizes.widths]))

    @property
    def fullest(self) -> float:
        """Most filling of the cross-section [-]."""
        return si(self.rules.filling)

    @cached_property
    def troughs(self) -> tuple[TroughSize, ...]:
        """Belt widths that take the lumps, with every trough angle."""
        rules, surcharge = self.rules, self.duty.material.surcharge
        asked = [si(width) for width in rules.widths]
        lumps = least_width_for_lumps(self.lump, surcharge_angle=surcharge, share=self.duty.lumps)
        least = max([lumps, *self._fitted])
        shapes = []
        for row in self.sizes.widths:
            belt, vee = si(row.belt), si(row.belt) >= si(self.sizes.vee_from)
            usual = tuple(map(si, rules.roll_diameters or (() if self.duty.listed.items("rolls") else row.rolls)))
            width = WidthSize(belt, si(row.one), si(row.two), si(row.three), vee, usual)
            if not within_limit(least, belt):
                continue
            if asked and not any(same_width(belt, one) for one in asked):
                continue
            for angle in map(si, self.trough_angles):
                trough = self._trough(width, angle)
                if trough.area > 0.0:
                    shapes.append(trough)
        return tuple(shapes)

    def _trough(self, width: WidthSize, angle: float) -> TroughSize:
        """Trough of a width and angle [rad] with the bulk that the steepest section holds."""
        material = self.duty.material
        section = cross_section(
            usable_width(width.belt),
            middle_roll_length=width.three,
            trough_angle=angle,
            surcharge_angle=material.surcharge,
        )
        return TroughSize(width, angle, section.on_slope(self.steepest, surcharge_angle=si(material.surcharge_angle)))

    def trough_on(self, roll: RollSize, trough: TroughSize) -> TroughSize | None:
        """A trough of the series with the lengths of listed rolls; None if rolls are not usual or none do for it."""
        usual, width = trough.width.diameters, trough.width.with_rolls(roll)
        if width is None or (usual and not any(same_width(roll.diameter, one) for one in usual)):
            return None
        return trough if width == trough.width else self._trough(width, trough.angle)

    @property
    def widths_without_rolls(self) -> tuple[float, ...]:
        """Widths of belts that take the flow, but for which no rolls of the lists do [m]."""
        taking = [one for one in self.troughs if any(self.filling(one, v) is not None for v in self.speeds)]
        rolling = {one.width.belt for one in taking for roll in self.rolls if self.trough_on(roll, one) is not None}
        return tuple(dict.fromkeys(one.width.belt for one in taking if one.width.belt not in rolling))

    def filled(self, trough: TroughSize, speed: float) -> float:
        """Share of the cross-section under bulk [-]."""
        return self.flow / (self.density * speed) / trough.area

    def full_enough(self, trough: TroughSize, speed: float) -> bool:
        """True if filled to the least filling of the rules; the narrowest belt is exempt."""
        narrowest = trough.width.belt == self.troughs[0].width.belt
        return narrowest or self.filled(trough, speed) >= si(self.rules.least_filling)

    def edge(self, trough: TroughSize, speed: float) -> float:
        """Free edge of the belt on either side [m]."""
        under = filled_width(
            self.flow / (self.density * speed),
            middle_roll_length=trough.width.three,
            trough_angle=trough.angle,
            surcharge_angle=self.duty.material.surcharge,
        )
        return 0.5 * (trough.width.belt - under)

    def allows(self, trough: TroughSize, speed: float) -> bool:
        """True if the rules allow the belt speed [m/s]."""
        given = self.rules.fastest
        fastest = si(given) if given else recommended_speed(trough.width.belt, abrasiveness=self.duty.abrasiveness)
        return within_limit(speed, fastest)

    def filling(self, trough: TroughSize, speed: float) -> float | None:
        """Filling of the cross-section [-]; None where it breaks the rules of speed, filling or edges."""
        if not self.allows(trough, speed):
            return None
        filling = self.filled(trough, speed)
        if filling > self.fullest or not self.full_enough(trough, speed):
            return None
        return filling if self.edge(trough, speed) >= standard_edge_distance(trough.width.belt) else None

    @cached_property
    def rolls(self) -> tuple[RollSize, ...]:
        """Roll sizes of the library, or of the lists."""
        if self.duty.listed.items("rolls"):
            return listed_rolls(self.duty.listed.items("rolls"))
        return tuple(
            RollSize(si(row.diameter), si(row.wall), si(row.ends), si(row.dynamic_rating), row.cema_class)
            for row in self.sizes.rolls
        )

    def set_ratings(self, roll: RollSize, trough: TroughSize) -> tuple[float, float]:
        """Ratings of carry and return sets of a roll's class [N]; infinite without a class, 0 if it has no such set."""
        count, _, vee = trough.width.return_rolls
        belt = trough.width.belt
        return roll.set_rating(belt, trough.angle, 3), roll.set_rating(belt, vee, count)

    @cached_property
    def lump_factor(self) -> float:
        """Lump factor on the bulk's load for set ratings [-]; 1 outside the printed table."""
        return usual_lump_factor(self.lump, si(self.duty.material.heaviest)) or 1.0

    def suits(self, roll: RollSize, trough: TroughSize, speed: float) -> bool:
        """True if rolls have sets for a trough and turn slowly enough."""
        return self.turns_slowly(roll, speed) and min(self.set_ratings(roll, trough)) > 0.0

    def widest_spacings(self, trough: TroughSize) -> tuple[float, float]:
        """Widest carry and return spacings for a width and the bulk [m]; infinite where the duty gives its own."""
        rules = self.rules
        carry = back = math.inf
        if self.duty.series == "US" and self.duty.site != "overland":
            carry, back = normal_spacings(trough.width.belt, density=self.density)
        return math.inf if rules.carry_spacings else carry, math.inf if rules.return_spacings else back

    def turns_slowly(self, roll: RollSize, speed: float) -> bool:
        """True if a roll keeps the limit of rotation."""
        return speed / (math.pi * roll.diameter) <= si(self.rules.roll_rotation)

    @cached_property
    def carcasses(self) -> Mapping[str, tuple[CarcassClass, ...]]:
        """Carcass classes of each kind, the weakest first."""
        if self.duty.listed.items("belts"):
            return {kind: listed_carcasses(self.duty.listed.items("belts"), kind) for kind in self.rules.carcasses}
        rows = {"EP": self.sizes.textile, "steel cord": self.sizes.steel_cord}
        return {kind: tuple(_carcass_class(kind, row) for row in rows[kind]) for kind in self.rules.carcasses}

    def wear(self, speed: float) -> float:
        """Wear addition of the cover at a belt speed [m]."""
        duty = self.duty
        return wear_addition(lump=self.lump, density=si(duty.material.heaviest), round_time=2.0 * self.length / speed,
                             abrasiveness=duty.abrasiveness, loading=duty.loading)  # fmt: skip

    def covers(self, choice: DesignChoice, carcass: CarcassClass) -> tuple[float, float]:
        """Top and bottom cover of a candidate with a class of belt [m]."""
        top, bottom = self.worn_covers(carcass, self.wear(choice.speed))
        return top, bottom if carcass.own_covers else bottom + choice.thicker

    @property
    def cover_step(self) -> float:
        """Step of cover thickness [m]."""
        return si(self.sizes.cover_step)

    def worn_covers(self, carcass: CarcassClass, addition: float) -> tuple[float, float]:
        """Top and bottom cover with a wear addition, on steps of the series; at most 3 to 1; or its own [m]."""
        if carcass.own_covers is not None:
            return carcass.own_covers
        step, least = self.cover_step, carcass.least_cover
        top = _round_up_to_step(least + addition, step)
        return top, _round_up_to_step(max(least, top / 3.0), step)

    @cached_property
    def pulleys(self) -> PulleySizes:
        """Pulleys and shafts of its series."""
        return PulleySizes(
            us=self.duty.series == "US",
            falls=math.fsum(rise for _, rise in self.sections) < 0.0,
            asked_allowance=si_or_none(self.rules.face_allowance),
        )

    def colder(self, conveyor: Conveyor) -> Conveyor:
        """The conveyor at the coldest temperature: its covers, and the air around its rolls as its load case has it."""
        return with_temperature(conveyor, self.duty.lowest_temperature) if self.cold else conveyor

    @property
    def cases(self) -> list[dict[str, Any]]:
        """Load cases of the spec of a design: that at the coldest temperature, if any."""
        return [{"name": "coldest", "temperatures": [self.duty.lowest_temperature]}] if self.cold else []

    @property
    def take_up_step(self) -> float:
        """Step of a written take-up tension [N]."""
        return 100.0 * POUND_FORCE if self.duty.series == "US" else 500.0


def _carcass_class(kind: str, row: CarcassRow) -> CarcassClass:
    mass, rating = (None if given is None else si(given) for given in (row.mass, row.rating))
    return CarcassClass(kind, si(row.strength), si(row.thickness), mass, rating)


def _round_up_to_step(thickness: float, step: float) -> float:
    return step * math.ceil(thickness / step - 1e-9)  # decimals: 6.5 mm is a step
