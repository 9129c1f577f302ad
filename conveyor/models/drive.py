"""The drive: pulleys, motors, brakes, and the train between mains and belt."""

from __future__ import annotations

import math
from typing import Annotated, Any, Final, Self

from pydantic import ConfigDict, Field, model_validator

from conveyor.laws.resistance import FRICTION_FACTOR, FRICTION_FACTOR_DOWNHILL
from conveyor.models.base import Model, Name, Number, Problem, refuse
from conveyor.models.route import SHARE_SUM_TOLERANCE, Position, position_problem
from conveyor.models.train import PRODUCT_TOLERANCE, DrivePart, product, with_efficiency
from conveyor.units import Acceleration, Angle, Bounds, Force, Fraction, Mass, Power, quantity, si, text

LEAST_FRICTION: Final = FRICTION_FACTOR_DOWNHILL.value / FRICTION_FACTOR.value
"""Friction taken for certain when it brakes, over the computed one: f downhill over f, general knowledge."""


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
    reduced_mass: Annotated[Mass, Bounds(ge="0 kg", le="10000 t")] = quantity("0 kg")
    """Rotating masses of motor, gear and pulley reduced to the belt, m = J i²/r²."""

    @model_validator(mode="after")
    def _placed(self) -> Self:
        refuse(type(self).__name__, position_problem(self.position, self.section))
        return self


class FurtherDrive(DrivePulley):
    """A drive pulley beside the first."""

    name: Name
    """What it is called in reports."""


def _train_instead(schema: dict[str, Any]) -> None:
    """Let editors know that the train's parts may stand for the efficiency."""
    schema["required"] = [name for name in schema["required"] if name != "efficiency"]
    schema["anyOf"] = [{"required": ["efficiency"]}, {"required": ["train"]}]


class Drive(DrivePulley):
    """The drive pulley and its motor; further drives beside it."""

    model_config = ConfigDict(json_schema_extra=_train_instead)

    efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")]
    """From the motor's shaft to the belt; may be left out where train is given: then the product of its parts there."""
    train: Annotated[tuple[DrivePart, ...], Field(max_length=20)] = ()
    """Parts of the drive train with their efficiencies, also those between mains and motor shaft."""
    regeneration_efficiency: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """From the belt to the motor's shaft when the belt drives; as efficiency without it."""
    start_factor: Annotated[Number, Field(ge=1, le=5)] = 1.3
    """Drive force at start over that in steady running; a regenerative conveyor's braking force likewise."""
    torque_factor: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Largest torque at start over the rated one, as motor, coupling or converter allow."""
    stop_deceleration: Annotated[Acceleration, Bounds(gt="0 m/s^2", le="5 m/s^2")] | None = None
    """Deceleration wanted when the conveyor is stopped."""
    least_friction: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity(LEAST_FRICTION, "fraction")
    """Friction that is certain where it helps to brake, over the computed one."""
    further_drives: Annotated[tuple[FurtherDrive, ...], Field(max_length=20)] = ()
    """Drives beside the first; at one place the belt meets them in the order of the list."""

    @model_validator(mode="before")
    @classmethod
    def _efficiency_of_train(cls, data: Any) -> Any:
        return with_efficiency(data) if isinstance(data, dict) else data

    @model_validator(mode="after")
    def _shared(self) -> Self:
        refuse("Drive", [*self._share_problems(), *self._train_problems()])
        return self

    @property
    def knows_mains(self) -> bool:
        """Whether the train has a part between mains and motor shaft."""
        return any(part.side == "mains" for part in self.train)

    @property
    def mains_efficiency(self) -> float:
        """From the mains to the motor's shaft [-]; 1 where the train has no part there."""
        return product(self.train, "mains")

    def _train_problems(self) -> list[Problem]:
        whole = product(self.train, "belt")
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
                message = (
                    "missing: another drive has a share of the force; give it for all drives or for none"
                )
                return [Problem((*places[i], "share"), message) for i, ok in enumerate(given) if not ok]
            total = math.fsum(si(pulley.share) for pulley in self.pulleys if pulley.share is not None)
            if abs(total - 1.0) > SHARE_SUM_TOLERANCE:
                message = f"got a sum of {total:.6g}, the shares of all drives must add up to 1 (100 %)"
                return [Problem(("share",), message)]
        elif self.further_drives:
            message = (
                "missing: several drives share the force by installed power; give it, or share, for each"
            )
            return [
                Problem((*place, "installed_power"), message)
                for place, pulley in zip(places, self.pulleys, strict=True)
                if pulley.installed_power is None
            ]
        return []
