"""Rolling-resistance tests of a cover from a laboratory: rows, or a law fitted to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from conveyor.models.base import Model, Number, Problem, raise_problems
from conveyor.models.rubber_data import AbsoluteTemperature
from conveyor.units import Bounds, Fraction, Length, LineForce, Speed, si, text

Array = NDArray[np.float64]
RolledLoad = Annotated[LineForce, Bounds(ge="0.01 N/mm", le="100 N/mm")]
RolledForce = Annotated[LineForce, Bounds(gt="0 N/m")]

LAW_POINTS: Final = 5
"""Number of loads at which a law is evaluated, evenly spaced in the logarithm."""
LEAST_FRICTION, LARGEST_FRICTION = 1e-4, 0.3
"""Plausible range of resistance over load [-]; published tests lie near 0.01."""
TEST_UNCERTAINTY: Final = 0.1
"""Half width of the 90 % interval of repeated tests where it is not given (general knowledge) [-]."""


class RollingLaw(Model):
    """A test in the form of a law, resistance = a (line load)^b, both in N/mm (CEMA-7; DIN 22123, appendix)."""

    a: Annotated[Number, Field(gt=0, le=1)]
    """Resistance at 1 N/mm, in N/mm."""
    b: Annotated[Number, Field(gt=0, le=3)]
    """Exponent of the line load."""
    line_load: tuple[RolledLoad, RolledLoad]
    """Lowest and highest line load that the law was fitted to."""

    def resistance(self, line_load: Array) -> Array:
        """Resistance at line loads [N/m], in N/m."""
        return np.asarray(1e3 * self.a * (1e-3 * line_load) ** self.b)


@dataclass(frozen=True, eq=False)
class RollingPoints:
    """A test in SI: line loads and resistances, shape (n,) [N/m], on one roll and cover."""

    line_load: Array
    resistance: Array
    radius: float
    cover_thickness: float
    speed: float
    temperature: float


class RollingTest(Model):
    """Indentation rolling resistance measured on one roll and cover, at one speed and temperature."""

    source: Annotated[str, Field(min_length=1)]
    """Laboratory and report, or publication."""
    specimen: Literal["belt", "rubber"] = "belt"
    """A belt with its carcass (DIN 22123, AS 1334.13), or a sheet of its rubber."""
    roll_diameter: Annotated[Length, Bounds(ge="20 mm", le="2 m")]
    """Of the roll or drum that indents."""
    cover_thickness: Annotated[Length, Bounds(ge="0.5 mm", le="100 mm")]
    """Of the cover that is indented."""
    speed: Annotated[Speed, Bounds(gt="0 m/s", le="20 m/s")]
    """Of the belt."""
    temperature: AbsoluteTemperature
    """Of the cover."""
    line_load: Annotated[tuple[RolledLoad, ...], Field(max_length=1000)] = ()
    """Load per width of each row."""
    resistance: Annotated[tuple[RolledForce, ...], Field(max_length=1000)] = ()
    """Resistance per width of each row."""
    law: RollingLaw | None = None
    """A law instead of rows."""
    uncertainty: Annotated[Fraction, Bounds(ge="0 %", le="100 %")] | None = None
    """Half-width of the 90 % interval of repeated tests; 10 % without it."""
    shared_uncertainty: Annotated[Fraction, Bounds(ge="0 %", le="100 %")] | None = None
    """Part of `uncertainty` that all belts tested on this roll, cover, speed and temperature have in common; none
    without it. It cancels where two of them are compared."""
    note: str = ""
    """What of it is not printed but assumed."""

    @model_validator(mode="after")
    def _rows_or_law(self) -> Self:
        problems = []
        if (self.law is None) == (not self.line_load):
            problems.append(Problem(("law",), "give either rows, line_load and resistance, or a law"))
        elif len(self.line_load) != len(self.resistance):
            count = f"got {len(self.resistance)} values for {len(self.line_load)} of line_load"
            problems.append(Problem(("resistance",), f"{count}, one per line load is needed"))
        elif self.law is not None and not si(self.law.line_load[0]) < si(self.law.line_load[1]):
            low, high = map(text, self.law.line_load)
            problems.append(Problem(("law", "line_load"), f"got {low} to {high}, expected the lower value first"))
        else:
            points = self.points()
            friction = points.resistance / points.line_load
            for i in np.flatnonzero((friction < LEAST_FRICTION) | (friction > LARGEST_FRICTION))[:1].tolist():
                said = (
                    f"is {friction[i]:.3g} of its line load, {LEAST_FRICTION:g} to {LARGEST_FRICTION:g} are possible: "
                    "per width, N/m or N/mm?"
                )
                place = ("law", "a") if self.law is not None else ("resistance", i)
                problems.append(Problem(place, said))
        if self.shared > self.relative_uncertainty:
            whole = f"uncertainty is {100.0 * self.relative_uncertainty:g} %"
            problems.append(Problem(("shared_uncertainty",), f"is a part of uncertainty, at most as much; {whole}"))
        raise_problems("RollingTest", problems)
        return self

    def points(self) -> RollingPoints:
        """Return the rows in SI; a law at five loads."""
        if self.law is None:
            loads = np.array([si(load) for load in self.line_load])
            resistance = np.array([si(force) for force in self.resistance])
        else:
            low, high = (si(load) for load in self.law.line_load)
            loads = np.geomspace(low, high, LAW_POINTS)
            resistance = self.law.resistance(loads)
        return RollingPoints(
            loads,
            resistance,
            0.5 * si(self.roll_diameter),
            si(self.cover_thickness),
            si(self.speed),
            si(self.temperature),
        )

    @property
    def relative_uncertainty(self) -> float:
        """Half width of the 90 % interval of repeated tests [-]."""
        return TEST_UNCERTAINTY if self.uncertainty is None else si(self.uncertainty)

    @property
    def shared(self) -> float:
        """Part of the uncertainty common to all belts tested alike [-]."""
        return 0.0 if self.shared_uncertainty is None else si(self.shared_uncertainty)

    @property
    def conditions(self) -> tuple[float, float, float, float]:
        """Test conditions: roll diameter, cover thickness [m], speed [m/s], temperature [K]."""
        fields = self.roll_diameter, self.cover_thickness, self.speed, self.temperature
        diameter, thickness, speed, temperature = map(si, fields)
        return diameter, thickness, speed, temperature
