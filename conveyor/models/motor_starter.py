"""Motor starters: device between mains and belt, and the torque it allows over time."""

from __future__ import annotations

import itertools
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.units import Bounds, Fraction, Time, quantity, si

RampShape = Literal["linear", "cosine", "S"]


class FillPoint(Model):
    """What a coupling lets through, and when."""

    at: Annotated[Time, Bounds(ge="0 s", le="1 h")]
    """From when its drive is switched on."""
    share: Annotated[Fraction, Bounds(ge="0 %", le="100 %")]
    """Of the largest torque; linear between the points, held beyond the last."""


class Starter(Model):
    """What lets a motor pull, and how over time."""

    kind: Literal["inverter", "direct", "star-delta", "soft starter", "fluid coupling"] = "inverter"
    """An inverter leads the speed; the others let the motor pull as its torque curve allows, or a share of it."""
    ramp: RampShape = "S"
    """Speed over time of an inverter: linear, 1 - cos (Harrison), or two parabolas (S, Nordell)."""
    time: Annotated[Time, Bounds(gt="0 s", le="1 h")] | None = None
    """Of an inverter's ramp, in star, of the voltage's ramp, of filling a coupling; without it as long as the motors
    would take with the belt stiff, at the start factor."""
    stop_time: Annotated[Time, Bounds(gt="0 s", le="1 h")] | None = None
    """Of an inverter's ramp down; time without it."""
    delay: Annotated[Time, Bounds(ge="0 s", le="10 min")] = quantity("0 s")
    """From the command to start until this drive is switched on; an inverter then joins the ramp that all follow."""
    initial_torque: Annotated[Fraction, Bounds(gt="0 %", le="100 %")] | None = None
    """Of a soft starter or a coupling at the start, over its largest; 30 % without it."""
    fill: Annotated[tuple[FillPoint, ...], Field(max_length=100)] = ()
    """How a fluid coupling fills, from 0 s on, instead of time and initial_torque."""
    torque_limit: Annotated[Number, Field(ge=1, le=5)] | None = None
    """Largest torque over the rated one; that of drive.torque_factor or drive.torque_curve, else 1.6, without it."""
    slip: Annotated[Fraction, Bounds(gt="0 %", le="20 %")] | None = None
    """Of the motor, with its coupling, at rated torque; 2 % without it."""

    @model_validator(mode="after")
    def _of_its_kind(self) -> Self:
        problems = []
        if self.kind != "inverter" and self.stop_time is not None:
            problems.append(
                Problem(("stop_time",), f"given with kind {self.kind}: only an inverter leads a stop; remove it")
            )
        if self.kind == "direct" and self.time is not None:
            problems.append(Problem(("time",), "given with kind direct: nothing is led; remove it"))
        if self.kind not in {"soft starter", "fluid coupling"} and self.initial_torque is not None:
            problems.append(Problem(("initial_torque",), f"given with kind {self.kind}; remove it"))
        if self.fill:
            if self.kind != "fluid coupling":
                problems.append(Problem(("fill",), f"given with kind {self.kind}: only a fluid coupling fills"))
            beside = [name for name in ("time", "initial_torque") if getattr(self, name) is not None]
            problems += [Problem((name,), "given beside fill, which says it; remove one") for name in beside]
            times = [si(point.at) for point in self.fill]
            if times[0] != 0.0 or any(late <= early for early, late in itertools.pairwise(times)):
                problems.append(Problem(("fill",), "its points must begin at 0 s and follow one another"))
        raise_problems("Starter", problems)
        return self
