"""Idler sets of the carry and return strand."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.laws.idler_sets import CemaClass
from conveyor.laws.loading import NO_WING, Wing
from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.models.belt_shapes import BeltShape, Pipe, Trough
from conveyor.models.rolls import Roll
from conveyor.units import (
    Angle,
    Bounds,
    Distance,
    Force,
    Fraction,
    Length,
    Quantity,
    SetMass,
    is_kind,
    quantity,
    si,
    text,
)

SHARE_SUM_TOLERANCE: Final = 1e-9
"""Tolerance of a sum of shares typed as decimals (the loading laws use the same figure)."""

Spacing = Annotated[Distance, Bounds(gt="0 m", le="20 m")]
Share = Annotated[Fraction, Bounds(ge="0 %", le="100 %")]


class IdlerSet(Model):
    """The rolls of one station, repeated at a spacing."""

    rolls: Literal[1, 2, 3, 4, 5, 6]
    """Rolls side by side; 6 are a panel around a pipe."""
    pipe: Pipe | None = None
    """The pipe in six rolls; needed there, refused elsewhere."""
    spacing: Spacing
    """Distance of the sets along the belt."""
    trough_angle: Annotated[Angle, Bounds(ge="0 deg", le="60 deg")] = quantity("0 deg")
    """Angle of the outer rolls to the level."""
    inner_trough_angle: Annotated[Angle, Bounds(ge="0 deg", le="60 deg")] | None = None
    """Angle of the inner wing rolls of 4 or 5 to the level: the 25 deg of a garland of 25 and 55; needed in these."""
    roll: Roll
    middle_roll: Roll | None = None
    """The middle roll of 3 or 5, where it differs (its length may not)."""
    load_shares: tuple[Share, ...] | None = None
    """Share of each roll in the bulk's load, left to right, instead of share_rule."""
    belt_shares: tuple[Share, ...] | None = None
    """The same for the belt's own weight."""
    share_rule: Literal["VDI 2341", "cross-section"] = "VDI 2341"
    """Rule of the bulk's shares without load_shares; cross-section: by the area of bulk above each of 3 to 5."""
    wing_load: Literal["triangular", "uniform"] = "triangular"
    """Bulk along the outer rolls: falling to nothing at the edge, or even."""
    rotating_mass: Annotated[SetMass, Bounds()] | None = None
    """Mass of all parts that turn, of one set or per length at the spacing above, instead of that of each roll."""
    reduced_mass: Annotated[SetMass, Bounds()] | None = None
    """The same reduced to the rim, for starting and stopping; without it all is taken to be at the rim."""
    drag: Annotated[Force, Bounds(ge="0 N", le="5 kN")] | None = None
    """Running drag of all rolls of one set at their rims, instead of that of each roll."""
    offset: Annotated[Length, Bounds(ge="0 m", le="2 m")] = quantity("0 m")
    """Distance along the belt of the plane of the middle rolls from that of the outer ones, of every other roll of a
    pipe; the loads stay."""
    tilt_angle: Annotated[Angle, Bounds(ge="0 deg", le="5 deg")] = quantity("0 deg")
    """Forward tilt of the outer rolls; not of a single roll."""
    misalignment: Annotated[Angle, Bounds(ge="0 deg", le="5 deg")] | None = None
    """Standard deviation of the angles of the sets' axes from square to the belt; that of site without it."""
    sag: Annotated[Fraction, Bounds(gt="0 %", le="5 %")] = quantity("1 %")
    """Largest sag of the belt between sets, over the spacing."""
    cema_class: CemaClass | None = None
    """Class of the sets after CEMA 502, for their load; of class F, and of others' sets, give rating."""
    rating: Annotated[Force, Bounds(gt="0 N", le="1 MN")] | None = None
    """Load that a whole set bears by its maker, instead of that of its class."""
    lump_factor: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Of a rated set, load of the bulk over the steady one: K1 of CEMA, f1 of SANS 1313; by belt.wear.lump without."""
    raised: Annotated[Length, Bounds(ge="0 mm", le="100 mm")] = quantity("0 mm")
    """How much higher than its neighbours a rated set may stand; the belt's tension loads it then."""
    flap_margin: Annotated[Fraction, Bounds(gt="0 %", lt="100 %")] | None = None
    """Distance wanted of the rolls' rotation from the belt's natural frequencies, 10 to 20 %; not checked without."""

    @property
    def judged(self) -> bool:
        """True if the spec has data to check the set: bearings, a rating, a margin to belt flap."""
        bearings = (self.roll.bearing, self.middle.bearing)
        return any(given is not None for given in (self.cema_class, self.rating, self.flap_margin, *bearings))

    @property
    def middle(self) -> Roll:
        """Middle roll of the set."""
        return self.roll if self.middle_roll is None else self.middle_roll

    @property
    def set_mass(self) -> float:
        """Rotating mass of one set [kg]; the reduced mass where no other is given."""
        return self._rotating_mass or self.rim_mass

    @property
    def _rotating_mass(self) -> float:
        """Rotating mass of one set [kg]; 0 where only the reduced mass is given."""
        if self.rotating_mass is not None:
            return self._of_set(self.rotating_mass)
        masses = [self.roll_at(place).rotating_mass for place in range(self.rolls)]
        return 0.0 if None in masses else math.fsum(si(mass) for mass in masses if mass is not None)

    @property
    def reduced_only(self) -> bool:
        """True if only the reduced mass is given."""
        return not self._rotating_mass

    @property
    def rim_mass(self) -> float:
        """Mass of one set reduced to the roll surface, for acceleration [kg]."""
        return self._rotating_mass if self.reduced_mass is None else self._of_set(self.reduced_mass)

    def _of_set(self, mass: Quantity) -> float:
        return si(mass) * (si(self.spacing) if is_kind(mass, "line mass") else 1.0)

    @property
    def inner_wing(self) -> Wing:
        """Length [m] and angle [rad] of the inner wing rolls; none on sets of up to three rolls."""
        if self.rolls not in {4, 5}:
            return NO_WING
        angle = self.inner_trough_angle
        return Wing(si(self.roll.length), 0.0 if angle is None else si(angle))

    @cached_property
    def shape(self) -> BeltShape:
        """Shape in which the sets hold the belt: the pipe, else a trough."""
        return self._trough if self.pipe is None else self.pipe

    @cached_property
    def _trough(self) -> Trough:
        return Trough(self.rolls, si(self.roll.length), si(self.trough_angle), self.inner_wing)

    def middle_belt(self, width: float) -> float:
        """Width of belt on the middle roll [m]: all of it on one roll, 0 without a middle roll."""
        return self._trough.middle_belt(width)

    def roll_at(self, place: int) -> Roll:
        """Roll at a position of the set, left to right."""
        return self.middle if self.rolls in {3, 5} and place == self.rolls // 2 else self.roll

    @model_validator(mode="after")
    def _check_consistency(self) -> Self:
        problems = [*self._roll_problems(), *self._whole_problems()]
        problems += overlap_problems(("spacing",), self.spacing, self)
        for name, shares in (("load_shares", self.load_shares), ("belt_shares", self.belt_shares)):
            problems += self._share_problems(name, shares)
        problems += self._rule_problems()
        problems += self._pipe_problems()
        if self.rating is not None and self.cema_class is not None:
            message = f"got {text(self.rating)} beside cema_class {self.cema_class}; give one of the two"
            problems.append(Problem(("rating",), message))
        raise_problems("IdlerSet", problems)
        return self

    def _roll_problems(self) -> list[Problem]:
        problems = []
        if self.rolls == 1 and si(self.trough_angle) != 0.0:
            problems.append(
                Problem(
                    ("trough_angle",),
                    f"got {text(self.trough_angle)} with rolls: 1, but one roll lies flat; "
                    "set trough_angle to 0 deg or rolls to 2, 3 or 5",
                )
            )
        if self.rolls == 1 and si(self.tilt_angle) != 0.0:
            message = f"got {text(self.tilt_angle)} with rolls: 1, but only wings tilt forward; remove it"
            problems.append(Problem(("tilt_angle",), message))
        problems += self._inner_problems()
        if self.middle_roll is not None and self.rolls not in {3, 5}:
            problems.append(
                Problem(
                    ("middle_roll",),
                    f"given with rolls: {self.rolls}, but only 3 or 5 rolls have a middle one; "
                    "remove middle_roll or change rolls",
                )
            )
        elif self.middle_roll is not None and si(self.middle_roll.length) != si(self.roll.length):
            problems.append(
                Problem(
                    ("middle_roll", "length"),
                    f"got {text(self.middle_roll.length)}, but roll.length is {text(self.roll.length)}; "
                    "the load shares hold for rolls of equal length: make them equal",
                )
            )
        return problems

    def _pipe_problems(self) -> Iterator[Problem]:
        """Require the pipe of six rolls, and refuse fields of troughs beside it."""
        if (self.pipe is None) == (self.rolls == 6):
            message = "missing: rolls: 6 are a panel around a pipe; give it, or take fewer rolls"
            if self.pipe is not None:
                message = f"given with rolls: {self.rolls}, but a pipe has rolls: 6; remove pipe or change rolls"
            yield Problem(("pipe",), message)
        if self.pipe is None:
            return
        for name in ("load_shares", "belt_shares"):
            if getattr(self, name) is not None:
                yield Problem((name,), "given beside pipe, whose loads are statics of the ring; remove it")
        for name in ("trough_angle", "tilt_angle"):
            angle: Quantity = getattr(self, name)
            if si(angle) != 0.0:
                yield Problem((name,), f"got {text(angle)} beside pipe, which has no trough; remove it")
        if self.share_rule != "VDI 2341":
            yield Problem(("share_rule",), f'got "{self.share_rule}" beside pipe, a rule of troughs; remove it')

    def _inner_problems(self) -> Iterator[Problem]:
        """Require inner wings no steeper than the outer ones on four and five rolls, and refuse them on others."""
        angle, inner = self.inner_trough_angle, self.rolls in {4, 5}
        if angle is None and inner and si(self.trough_angle) > 0.0:
            message = f"missing: the inner wings of {self.rolls} rolls have an angle of their own, as 25 deg beside 55"
        elif angle is not None and not inner:
            message = f"given with rolls: {self.rolls}, but only 4 and 5 have inner wings; remove it or change rolls"
        elif angle is not None and si(angle) > si(self.trough_angle):
            message = (
                f"got {text(angle)}, steeper than the outer rolls (trough_angle {text(self.trough_angle)}); "
                "exchange the two or correct one"
            )
        else:
            return
        yield Problem(("inner_trough_angle",), message)

    def _whole_problems(self) -> Iterator[Problem]:
        """Require masses and drag for each roll or for the whole set, never both."""
        for name in ("rotating_mass", "reduced_mass"):
            mass: Quantity | None = getattr(self, name)
            if mass is not None and si(mass) <= 0.0:
                yield Problem((name,), f"got {text(mass)}, allowed: > 0")
        rolls = {"roll": self.roll, "middle_roll": self.middle_roll}
        for name, roll in rolls.items():
            if roll is None:
                continue
            listed = roll.entry is not None and "rotating_mass" in roll.entry.fields
            if roll.rotating_mass is None and self.rotating_mass is None and self.reduced_mass is None:
                message = "missing: give it, or the rotating_mass of the whole set beside spacing"
                yield Problem((name, "rotating_mass"), message)
            elif roll.rotating_mass is not None and self.rotating_mass is not None and not listed:
                message = (
                    f"got {text(roll.rotating_mass)} of a roll, but the whole set has {text(self.rotating_mass)} "
                    "(rotating_mass beside spacing); give one of the two"
                )
                yield Problem((name, "rotating_mass"), message)
            if self.drag is not None and (roll.drag is not None or roll.drag_law is not None):
                given = "drag" if roll.drag_law is None else "drag_law"
                message = f"given beside drag {text(self.drag)} of the whole set; give one of the two"
                yield Problem((name, given), message)
        if self.reduced_mass is not None and 0.0 < self._rotating_mass < self.rim_mass:
            message = f"got {text(self.reduced_mass)}, more than all that turns; correct one of the two"
            yield Problem(("reduced_mass",), message)

    def _rule_problems(self) -> list[Problem]:
        problems = []
        if self.share_rule != "VDI 2341" and self.load_shares is not None:
            message = f'got "{self.share_rule}" beside load_shares; give one of the two, remove the other'
            problems.append(Problem(("share_rule",), message))
        if si(self.offset) > 0.0 and self.rolls not in {3, 5, 6}:
            message = f"got {text(self.offset)}, but rolls: {self.rolls} has no middle ones; remove it"
            problems.append(Problem(("offset",), message))
        elif si(self.offset) >= si(self.spacing):
            message = f"got {text(self.offset)}, but the sets are {text(self.spacing)} apart; correct one of the two"
            problems.append(Problem(("offset",), message))
        return problems

    def _share_problems(self, name: str, shares: tuple[Quantity, ...] | None) -> list[Problem]:
        if shares is None:
            needed = self.rolls in {4, 5} and name == "load_shares" and self.share_rule == "VDI 2341"
            message = (
                f"missing: VDI 2341 has no rule for the shares of {self.rolls} rolls, "
                f"give the {self.rolls} load_shares, or take the share_rule cross-section"
            )
            return [Problem((name,), message)] if needed else []
        if len(shares) != self.rolls:
            return [Problem((name,), f"got {len(shares)} shares for rolls: {self.rolls}; give one share for each roll")]
        total = math.fsum(si(share) for share in shares)
        if abs(total - 1.0) > SHARE_SUM_TOLERANCE:
            return [Problem((name,), f"got a sum of {total:.6g}, the shares must add up to 1 (100 %)")]
        return []


def overlap_problems(location: tuple[int | str, ...], spacing: Quantity, idlers: IdlerSet) -> list[Problem]:
    """Refuse sets so close that rolls of neighbouring sets overlap."""
    thickest = max((idlers.roll, idlers.middle), key=lambda roll: si(roll.diameter))
    if si(spacing) > si(thickest.diameter):
        return []
    message = (
        f"got {text(spacing)}, but the rolls are {text(thickest.diameter)} thick: "
        "rolls of neighbouring sets overlap; increase the spacing or reduce the roll diameter"
    )
    return [Problem(location, message)]


class Idlers(Model):
    """The sets of both strands."""

    carry: IdlerSet
    """Under the loaded strand."""
    return_: Annotated[IdlerSet, Field(alias="return")]
    """Under the returning strand."""

    @property
    def drag_follows_air(self) -> bool:
        """True if the drag of a roll comes from a law, which may depend on the air temperature."""
        sets = [each for each in (self.carry, self.return_) if each.drag is None]
        return any(roll.drag is None for each in sets for roll in (each.roll, each.middle))
