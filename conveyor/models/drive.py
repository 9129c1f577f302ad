"""The drive: pulleys, motors, brakes, and the train between mains and belt."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Annotated, Any, Final, Literal, Self

from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from conveyor.laws.drives import GEAR_SERVICE
from conveyor.laws.resistance import FRICTION_FACTOR, FRICTION_FACTOR_DOWNHILL
from conveyor.models.base import AnyInteger, Model, Name, Number, Problem, Switch, raise_problems
from conveyor.models.drive_train import PRODUCT_TOLERANCE, DrivePart, train_efficiency, with_efficiency
from conveyor.models.listed_parts import with_listed_parts
from conveyor.models.loop_parts import Position, position_problem
from conveyor.models.maker_lists import Listed
from conveyor.models.motor_starter import Starter
from conveyor.models.route import SHARE_SUM_TOLERANCE
from conveyor.units import (
    Acceleration,
    Angle,
    Bounds,
    Force,
    Fraction,
    Heat,
    Inertia,
    Length,
    Mass,
    Power,
    Rotation,
    Time,
    Torque,
    quantity,
    si,
    text,
)

DesignFriction = Annotated[Fraction, Bounds(ge="100 %", le="500 %")]
LEAST_FRICTION: Final = FRICTION_FACTOR_DOWNHILL.value / FRICTION_FACTOR.value
"""Friction relied on for braking over the computed one [-]: f downhill over f, general knowledge."""
CEMA_LEAST_FRICTION: Final = 0.5
"""The same of CEMA's Te, whose friction is meant to be enough for every motor [-]: a holdback bears the lift less half
of the force that moves belt and load horizontally (Overland Conveyor, Belt Analyst knowledge base, Backstops, 2012)."""


Shaft = Literal["pulley", "motor"]


class DrivePulley(Model):
    """A drive pulley with its motors and its brake."""

    position: Position = "head"
    """Where it stands: head, tail, or behind a section of a strand in its running direction."""
    section: Name | None = None
    """The section, for position "carry" or "return"."""
    wrap_angle: Annotated[Angle, Bounds(gt="0 deg", le="1440 deg")]
    """Angle of wrap; of all drive pulleys together where they stand at one place and are given as one."""
    friction: Annotated[Number, Field(ge=0.01, le=1)]
    """Friction of belt on pulley μ: about 0.35 lagged, 0.25 bare."""
    installed_power: Annotated[Power, Bounds(gt="0 kW")] | None = None
    """Power of the motors."""
    share: Annotated[Fraction, Bounds(ge="0 %", le="100 %")] | None = None
    """Share of the whole drive force; of several drives without it in proportion to installed power."""
    brake_force: Annotated[Force, Bounds(gt="0 N", le="10 MN")] | None = None
    """Force of its brake at the belt."""
    brake_torque: Annotated[Torque, Bounds(gt="0 N*m", le="100 MN*m")] | None = None
    """Torque of its brake at brake_shaft, instead of brake_force."""
    brake_shaft: Shaft = "pulley"
    """Shaft that brake_torque is at; at the motor's it acts by the gear ratio, losses of the gear left out."""
    reduced_mass: Annotated[Mass, Bounds(ge="0 kg", le="10000 t")] | None = None
    """Rotating masses of motor, gear and pulley reduced to the belt; else by inertia, else typical of the power."""
    inertia: Annotated[Inertia, Bounds(ge="0 kg*m^2", le="100000 kg*m^2")] | None = None
    """The same as a moment of inertia at the motor's shaft, of all its motors together; J, in m = J i²/r²."""
    gear_ratio: Annotated[Number, Field(gt=0, le=1000)] | None = None
    """Speed of the motor over that of the pulley, i; needed beside inertia, and for torques at the motor's shaft."""
    pulley_diameter: Annotated[Length, Bounds(gt="0 m", le="5 m")] | None = None
    """Diameter of its pulley, for torques, inertia and, without route.pulleys, its wrap; else that in route.pulleys."""
    starter: Starter | None = None
    """How its motors are started, for scenarios; led by an inverter without it, or direct where drive has a torque
    curve or factor and no start factor."""
    backstop: Switch | None = None
    """Whether it cannot turn backward, for scenarios; without it the first drive of a belt that would roll back."""
    backstop_torque: Annotated[Torque, Bounds(gt="0 N*m", le="100 MN*m")] | None = None
    """Torque that its backstop bears, at backstop_shaft."""
    backstop_shaft: Shaft = "pulley"
    """Shaft that backstop_torque is at; at the motor's it bears that times the gear ratio at the pulley."""
    gear_torque: Annotated[Torque, Bounds(gt="0 N*m", le="100 MN*m")] | None = None
    """Rated torque of the gearbox of one motor, at its slow shaft; checked with service_factor."""
    coupling_torque: Annotated[Torque, Bounds(gt="0 N*m", le="100 MN*m")] | None = None
    """Rated torque of the coupling of one motor, at the motor's shaft; checked likewise, needs motor_speed."""
    motors: Annotated[int, Field(ge=1, le=20, strict=True), AnyInteger] = 1
    """How many equal motors it has."""
    motor_speed: Annotated[Rotation, Bounds(gt="0 rpm", le="5000 rpm")] | None = None
    """Speed of its motors at belt.speed, for ratio and torque of the gear; with gear_ratio checked against it."""
    starts_per_hour: Annotated[Number, Field(gt=0, le=1000)] | None = None
    """Starts asked of motors that are switched on directly, checked against NEMA's table; needs motor_speed."""
    diameter_loss: Annotated[Length, Bounds(ge="0 mm", le="100 mm")] | None = None
    """How much smaller its pulley is than the nominal one, worn or made so, for sharing without control."""
    brake_disc: Annotated[Mass, Bounds(gt="0 kg", le="100 t")] | None = None
    """Mass of its brake's disc or drum, for the rise of its temperature in a stop."""
    brake_heat: Annotated[Heat, Bounds(gt="0 J", le="10 MWh")] | None = None
    """Heat of one stop that its brake bears, by the brake's maker."""
    listed: Annotated[tuple[Listed, ...], Field(max_length=10)] = ()
    """Items of makers' lists: motor, gearbox, coupling, backstop, brake; they give what is not given here."""

    @model_validator(mode="before")
    @classmethod
    def _of_listed_parts(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, dict):
            return data
        data = with_listed_parts(data, cls, info)
        return with_efficiency(data) if "train" in cls.model_fields else data

    @model_validator(mode="after")
    def _placed(self) -> Self:
        problems = position_problem(self.position, self.section)
        if self.inertia is not None and self.reduced_mass is not None:
            message = f"got {text(self.inertia)} beside reduced_mass {text(self.reduced_mass)}; give one of the two"
            problems.append(Problem(("inertia",), message))
        elif self.inertia is not None and self.gear_ratio is None:
            problems.append(Problem(("gear_ratio",), "missing: inertia is given and needs it, or remove inertia"))
        elif self.inertia is None and self.gear_ratio is not None and not self.motor_shaft_field:
            problems.append(Problem(("inertia",), "missing: gear_ratio is given and needs it, or remove gear_ratio"))
        problems += self._shaft_problems()
        brake = self.brake_force if self.brake_torque is None else self.brake_torque
        for field, value, asked, other in (
            ("starts_per_hour", self.starts_per_hour, self.motor_speed, "motor_speed"),
            ("starts_per_hour", self.starts_per_hour, self.installed_power, "installed_power"),
            ("brake_disc", self.brake_disc, brake, "brake_force"),
            ("brake_heat", self.brake_heat, brake, "brake_force"),
            ("gear_torque", self.gear_torque, self.installed_power, "installed_power"),
            ("coupling_torque", self.coupling_torque, self.installed_power, "installed_power"),
            ("coupling_torque", self.coupling_torque, self.motor_speed, "motor_speed"),
        ):
            if value is not None and asked is None:
                problems.append(Problem((other,), f"missing: {field} is given and needs it, or remove {field}"))
        if self.backstop is False and self.backstop_torque is not None:
            message = f"got {text(self.backstop_torque)} of a drive without a backstop (backstop: false); remove one"
            problems.append(Problem(("backstop_torque",), message))
        raise_problems(type(self).__name__, problems)
        return self

    def _shaft_problems(self) -> Iterator[Problem]:
        """Refuse a brake given twice, and shafts without a torque or a ratio."""
        if self.brake_force is not None and self.brake_torque is not None:
            message = f"got {text(self.brake_torque)} beside brake_force {text(self.brake_force)}; give one of the two"
            yield Problem(("brake_torque",), message)
        for part, shaft, torque in (
            ("brake", self.brake_shaft, self.brake_torque), ("backstop", self.backstop_shaft, self.backstop_torque)
        ):  # fmt: skip
            if shaft == "motor" and torque is None:
                message = f"missing: {part}_shaft is given and needs it, or remove {part}_shaft"
                yield Problem((f"{part}_torque",), message)
        field = self.motor_shaft_field
        if field and self.gear_ratio is None and self.motor_speed is None:
            message = f"missing: {field} is at the motor's shaft and needs it, or motor_speed"
            yield Problem(("gear_ratio",), message)

    @property
    def motor_shaft_field(self) -> str:
        """Name of a torque that is at the motor's shaft; empty if none is."""
        if self.brake_torque is not None and self.brake_shaft == "motor":
            return "brake_torque"
        return "backstop_torque" if self.backstop_torque is not None and self.backstop_shaft == "motor" else ""

    @property
    def braked(self) -> bool:
        """True if it has a brake."""
        return self.brake_force is not None or self.brake_torque is not None

    @property
    def judged(self) -> bool:
        """True if the spec has data to check the parts of the drive, beyond force and power."""
        given = (
            self.backstop_torque, self.motor_speed, self.starts_per_hour, self.diameter_loss, self.brake_disc,
            self.brake_heat, self.gear_torque, self.coupling_torque,
        )  # fmt: skip
        return any(value is not None for value in given)


class TorquePoint(Model):
    """A point of the motors' torque curve."""

    speed: Annotated[Fraction, Bounds(ge="0 %", le="100 %")]
    """Over the rated speed."""
    torque: Annotated[Number, Field(gt=0, le=10)]
    """Over the rated torque."""


class FurtherDrive(DrivePulley):
    """A drive pulley beside the first."""

    name: Name
    """What it is called in reports."""


def _efficiency_or_train(schema: dict[str, Any]) -> None:
    """JSON schema: either the efficiency or the parts of the drive train, also of makers' lists."""
    schema["required"] = [name for name in schema["required"] if name != "efficiency"]
    schema["anyOf"] = [{"required": [name]} for name in ("efficiency", "train", "listed")]


class Drive(DrivePulley):
    """The drive pulley and its motor; further drives beside it."""

    model_config = ConfigDict(json_schema_extra=_efficiency_or_train)

    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """From the motor's shaft to the belt; may be left out where train is given: then the product of its parts there."""
    train: Annotated[tuple[DrivePart, ...], Field(max_length=20)] = ()
    """Parts of the drive train with their efficiencies, also those between mains and motor shaft."""
    regeneration_efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """From the belt to the motor's shaft when the belt drives; as efficiency without it."""
    service_factor: Annotated[Number, Field(ge=1, le=5)] = GEAR_SERVICE.value
    """Rated torque of gearbox and coupling over that of their motor, by their maker or the contract."""
    start_factor: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Drive force of a controlled start over that in steady running; without it all that torque_factor or torque_curve
    let the motors give, without those 1.3. A regenerative conveyor's braking force likewise."""
    torque_factor: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Largest torque at start over the rated one, as motor, coupling or converter allow."""
    torque_curve: Annotated[tuple[TorquePoint, ...], Field(max_length=100)] = ()
    """Torque of the motors over their speed, from rest, instead of torque_factor; the last one holds to full speed."""
    brake_delay: Annotated[Time, Bounds(ge="0 s", le="60 s")] = quantity("0 s")
    """Time from a power failure until the brakes grip."""
    stop_deceleration: Annotated[Acceleration, Bounds(gt="0 m/s^2", le="5 m/s^2")] | None = None
    """Deceleration wanted when the conveyor is stopped."""
    coast_time: Annotated[Time, Bounds(gt="0 s", le="1 h")] | None = None
    """Time wanted from full speed to rest without power and brakes; the flywheel it needs is shown."""
    least_friction: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """Friction that is certain where it helps to brake, over the computed one; 60 % without it, by CEMA 50 %."""
    design_friction: DesignFriction | None = None
    """Friction that motors, belt, grip and take-up are designed for, over the computed one; without it the upper end of
    the band of the defaults in use."""
    further_drives: Annotated[tuple[FurtherDrive, ...], Field(max_length=20)] = ()
    """Drives beside the first; at one place the belt meets them in the order of the list."""

    @model_validator(mode="after")
    def _shared(self) -> Self:
        raise_problems("Drive", [*self._share_problems(), *self._train_problems(), *self._torque_problems()])
        return self

    @property
    def knows_mains(self) -> bool:
        """True if the drive train has a part between mains and motor shaft."""
        return any(part.side == "mains" for part in self.train)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the drives, the first one first."""
        return ("drive", *(pulley.name for pulley in self.further_drives))

    @property
    def mains_efficiency(self) -> float:
        """Efficiency from mains to motor shaft [-]; 1 where the drive train has no part there."""
        return train_efficiency(self.train, "mains")

    def _torque_problems(self) -> Iterator[Problem]:
        speeds = [si(point.speed) for point in self.torque_curve]
        if self.torque_curve and self.torque_factor is not None:
            yield Problem(("torque_factor",), "given beside torque_curve; give one of the two")
        if speeds and speeds[0] != 0.0:
            yield Problem(
                ("torque_curve", 0, "speed"), f"got {text(self.torque_curve[0].speed)}; a start begins at 0 %"
            )
        for i, (slower, faster) in enumerate(itertools.pairwise(speeds), start=1):
            if faster <= slower:
                message = f"got {text(self.torque_curve[i].speed)}, not faster than the point before; sort them"
                yield Problem(("torque_curve", i, "speed"), message)

    def _train_problems(self) -> list[Problem]:
        whole = train_efficiency(self.train, "belt")
        if not any(part.side == "belt" for part in self.train):
            return []
        if abs(si(self.efficiency) - whole) <= PRODUCT_TOLERANCE:
            return []
        message = (
            f"got {text(self.efficiency)}, the parts of train from motor shaft to belt give {whole:.6g}; "
            "leave efficiency out or correct one of the two"
        )
        return [Problem(("efficiency",), message)]

    @property
    def pulleys(self) -> tuple[DrivePulley, ...]:
        """All drives."""
        return (self, *self.further_drives)

    def _share_problems(self) -> list[Problem]:
        places = [(), *(("further_drives", i) for i in range(len(self.further_drives)))]
        given = [pulley.share is not None for pulley in self.pulleys]
        if any(given):
            if not all(given):
                message = "missing: another drive has a share of the force; give it for all drives or for none"
                return [Problem((*places[i], "share"), message) for i, ok in enumerate(given) if not ok]
            total = math.fsum(si(pulley.share) for pulley in self.pulleys if pulley.share is not None)
            if abs(total - 1.0) > SHARE_SUM_TOLERANCE:
                message = f"got a sum of {total:.6g}, the shares of all drives must add up to 1 (100 %)"
                return [Problem(("share",), message)]
        elif self.further_drives:
            message = "missing: several drives share the force by installed power; give it, or share, for each"
            return [
                Problem((*place, "installed_power"), message)
                for place, pulley in zip(places, self.pulleys, strict=True)
                if pulley.installed_power is None
            ]
        return []
