"""Pulleys, transitions and the take-up of a conveyor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from conveyor.laws.pulley import Keyway, Steel
from conveyor.laws.take_up import LOOP_STRANDS, TRAVEL_RESERVE
from conveyor.models.base import AnyInteger, Model, Name, Number, Problem, raise_problems
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import Listed
from conveyor.units import (
    Angle,
    Bounds,
    Distance,
    Duration,
    Force,
    Fraction,
    Length,
    Mass,
    Pressure,
    Speed,
    Time,
    quantity,
    si,
    text,
)

Position = Literal["head", "tail", "carry", "return"]


def position_problem(position: str, section: str | None) -> list[Problem]:
    """Refuse a position along a strand without a section, and a section at head or tail."""
    along = position in {"carry", "return"}
    if along and section is None:
        message = f'missing: position "{position}" stands behind a section of that strand; give its name'
        return [Problem(("section",), message)]
    if not along and section is not None:
        message = f'got "{section}" with position "{position}"; remove section, or set position to "carry" or "return"'
        return [Problem(("section",), message)]
    return []


EUROPEAN_STEELS: Final[Mapping[str, Steel]] = {
    "c45": "C1045", "c45e": "C1045", "c45r": "C1045", "1.0503": "C1045", "1.1191": "C1045",
    "42crmo4": "C4140", "42crmos4": "C4140", "1.7225": "C4140", "1.7227": "C4140",
}  # fmt: skip
"""Shaft steels by names and numbers of EN ISO 683-1 and -2, and the steel of CEMA B105.1 nearest to them; general
knowledge: lists of alike steels."""


def _refuse_european_steel(value: Any) -> Any:
    """Refuse a European name of a steel with the American one; anything else as it is."""
    known = EUROPEAN_STEELS.get(value.replace(" ", "").casefold()) if isinstance(value, str) else None
    if known is None:
        return value
    message = f"of the steels of CEMA B105.1, whose strengths are used, {known} is nearest: write {known}"
    raise PydanticCustomError("steel", "{message}", {"message": message})


class Pulley(LibraryItem):
    """A pulley that bends the belt and turns in bearings."""

    library: ClassVar = "pulleys"

    name: Name
    """Each its own."""
    position: Literal["head", "tail", "take-up", "carry", "return"]
    """Which belt tension acts: head, tail, take-up, or behind a section of a strand in its running direction."""
    section: Name | None = None
    """The section, for position "carry" or "return"."""
    diameter: Annotated[Length, Bounds(gt="0 m", le="5 m")]
    """Of the shell with its lagging."""
    shaft_diameter: Annotated[Length, Bounds(gt="0 m", le="2 m")]
    """Diameter of the shaft in its bearings."""
    mass: Annotated[Mass, Bounds(ge="0 kg", le="100 t")]
    """Of pulley and shaft; its weight loads the bearings."""
    face_width: Annotated[Length, Bounds(gt="0 m", le="10 m")] | None = None
    """Of its shell, which must be wider than the belt."""
    wrap_angle: Annotated[Angle, Bounds(gt="0 deg", le="360 deg")] | None = None
    """Angle over which the belt lies on it; without it that of the drive that turns it, else 180 deg."""
    pull_angle: Annotated[Angle, Bounds(ge="0 deg", le="180 deg")] = quantity("0 deg")
    """Between the belt's pull on it and straight down: 90 deg where it pulls level; at 0 all the weight adds to it."""
    bearing_centres: Annotated[Length, Bounds(gt="0 m", le="10 m")] | None = None
    """Distance of its bearings, for the shaft."""
    hub_centres: Annotated[Length, Bounds(gt="0 m", le="10 m")] | None = None
    """Distance of its hubs, for the shaft."""
    hub_shaft_diameter: Annotated[Length, Bounds(gt="0 m", le="2 m")] | None = None
    """Diameter of the shaft in and between the hubs; that in the bearings without it."""
    shaft_steel: Annotated[Steel | None, BeforeValidator(_refuse_european_steel)] = None
    """Steel of the shaft, as CEMA B105.1 names it; C1045 is C45, C4140 is 42CrMo4, annealed."""
    keyway: Keyway = "profiled"
    """What weakens the shaft in the hub."""
    bearing_rating: Annotated[Force, Bounds(gt="0 N", le="100 MN")] | None = None
    """Dynamic load rating C of one bearing, a roller bearing."""
    bearing_life: Annotated[Duration, Bounds(gt="0 h", le="1000000 h")] | None = None
    """L10 asked of each bearing in steady running."""
    lagging_pressure: Annotated[Pressure, Bounds(gt="0 Pa", le="100 MPa")] | None = None
    """Pressure of the belt that its lagging bears, by the lagging's maker."""
    listed: Listed | None = None
    """Item of a maker's list that gives what is not given here."""

    @property
    def wrap_or_half_turn(self) -> float:
        """Wrap as given, else half a turn [rad]."""
        return math.pi if self.wrap_angle is None else si(self.wrap_angle)

    @model_validator(mode="after")
    def _shaft_inside(self) -> Self:
        problems = []
        for name, shaft in (
            ("shaft_diameter", self.shaft_diameter),
            ("hub_shaft_diameter", self.hub_shaft_diameter),
        ):
            if shaft is not None and si(shaft) >= si(self.diameter):
                message = (
                    f"got {text(shaft)}, but the pulley's diameter is {text(self.diameter)}; "
                    f"the shaft must be thinner: correct {name} or diameter"
                )
                problems.append(Problem((name,), message))
        bearings, hubs = self.bearing_centres, self.hub_centres
        if bearings is not None and hubs is not None and si(hubs) >= si(bearings):
            message = f"got {text(hubs)}, but the bearings stand outside the hubs, {text(bearings)} apart; correct one"
            problems.append(Problem(("hub_centres",), message))
        raise_problems("Pulley", [*problems, *position_problem(self.position, self.section)])
        return self


class Transition(Model):
    """Where the belt changes between trough or pipe and a flat pulley; of a pipe on both strands alike."""

    length: Annotated[Distance, Bounds(gt="0 m", le="200 m")] | None = None
    """From the pulley's axis to the first set of full trough, or of the pipe; what is needed is shown without it."""
    pulley_height: Annotated[Fraction, Bounds(ge="0 %", le="100 %")] | None = None
    """Top of the pulley over the middle roll, over depth of trough or pipe: 50 % half trough; full trough without."""


class TakeUp(Model):
    """What keeps the belt taut: a weight, a carriage that is held, or a winch that keeps its pull."""

    kind: Literal["gravity", "fixed", "screw", "winch", "locked winch"]
    """Gravity and winch keep the tension at their place; fixed, screw and locked winch keep the length of the belt."""
    position: Literal["drive", "head", "tail", "carry", "return"] = "drive"
    """Slack side of the drives at the first one's place under the own load, right behind head or tail, or a section."""
    section: Name | None = None
    """The section, for position "carry" or "return"."""
    tension: Annotated[Force, Bounds(gt="0 N", le="10 MN")] | None = None
    """Belt tension it is set to: at its place, of a fixed one the mean of the loop; the least needed without it."""
    mass: Annotated[Mass, Bounds(gt="0 kg", le="1000 t")] | None = None
    """Mass of the weight of a gravity take-up, instead of the tension."""
    reeving: Annotated[Number, Field(gt=0, le=20)] = 1.0
    """Pull on the carriage over pull of the weight or rope: 1 for a weight in the belt's loop."""
    strands: Annotated[int, Field(ge=1, le=20, strict=True), AnyInteger] = LOOP_STRANDS
    """Strands that pull at the carriage, 4 where the belt goes round it twice: tension = mass g reeving/strands."""
    reserve: Annotated[Fraction, Bounds(ge="0 %", le="200 %")] = quantity(TRAVEL_RESERVE.value, "fraction")
    """Travel kept beyond what is computed, over it."""
    travel: Annotated[Distance, Bounds(gt="0 m", le="1 km")] | None = None
    """Way that the carriage has; not checked without it."""
    carriage_mass: Annotated[Mass, Bounds(ge="0 kg", le="1000 t")] = quantity("0 kg")
    """What moves with the carriage beside the weight, for scenarios."""
    winch_speed: Annotated[Speed, Bounds(gt="0 m/s", le="10 m/s")] | None = None
    """Of the carriage on its winch, checked against what a start asks for; without it a winch always keeps its pull."""
    winch_band: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] = quantity(0.1, "fraction")
    """Of the tension, up and down, within which the winch rests."""
    winch_run_up: Annotated[Time, Bounds(gt="0 s", le="10 min")] | None = None
    """In which the winch comes from rest to its speed, and back to rest; scenarios need it where it has a speed."""

    @model_validator(mode="after")
    def _one_setting(self) -> Self:
        problems = position_problem(self.position, self.section)
        if self.mass is not None and self.kind != "gravity":
            message = f'got {text(self.mass)} with kind "{self.kind}"; give the tension, or set kind to "gravity"'
            problems.append(Problem(("mass",), message))
        elif self.mass is not None and self.tension is not None:
            message = f"got {text(self.mass)} and tension {text(self.tension)}; give one of the two"
            problems.append(Problem(("mass",), message))
        if self.winch_speed is not None and self.kind != "winch":
            problems.append(
                Problem(("winch_speed",), f'given with kind "{self.kind}"; remove it, or set kind to "winch"')
            )
        if self.winch_run_up is not None and self.winch_speed is None:
            problems.append(Problem(("winch_run_up",), "given without winch_speed; give the speed too, or remove it"))
        raise_problems("TakeUp", problems)
        return self
