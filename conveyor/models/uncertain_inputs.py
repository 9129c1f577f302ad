"""Ranges of uncertain inputs, and correlations between them."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

from pydantic import Field, model_validator

from conveyor.models.base import AnyInteger, Model, Problem, Switch, raise_problems
from conveyor.units import Bounds, Fraction, Quantity, TemperatureDifference, si, text

HalfWidth = Annotated[Fraction, Bounds(gt="0 %", lt="100 %")]
Share = Annotated[Fraction, Bounds(ge="0 %", lt="100 %")]
FEWEST_DRAWS: Final = 64
"""Fewest draws whose extremes bound the 5 % and 95 % percentiles with 90 % confidence."""


DrawnInput = Literal[
    "roll_drag", "flexure_share", "flow", "density", "belt_mass", "cover_thickness", "cleaner_pressure",
    "skirt_friction", "temperature",
]  # fmt: skip
CorrelationCoefficient = Annotated[float, Field(gt=-1.0, lt=1.0)]


class Correlation(Model):
    """Two inputs that are not independent in the draws."""

    between: Annotated[tuple[DrawnInput, ...], Field(min_length=2, max_length=2)]
    """Two of the ranges, by name."""
    coefficient: CorrelationCoefficient
    """Of correlation, between -1 and 1."""


class Uncertainty(Model):
    """Ranges of inputs, each a 90 % interval; a share is of the value in the spec, up and down."""

    roll_drag: HalfWidth | None = None
    """Of the drag of all rolls, up and down ("30 %")."""
    flexure_share: Annotated[tuple[Share, ...], Field(min_length=2, max_length=2)] | None = None
    """Lowest and highest share of the flexure in the main resistance."""
    flow: HalfWidth | None = None
    """Of the mass flow, up and down."""
    density: HalfWidth | None = None
    """Of the bulk density at the same mass flow, up and down: it works on the skirts."""
    belt_mass: HalfWidth | None = None
    """Of the belt's mass per length, up and down."""
    cover_thickness: HalfWidth | None = None
    """Of the bottom cover's thickness, up and down (a worn cover is thinner)."""
    cleaner_pressure: HalfWidth | None = None
    """Of the pressure of all cleaners, up and down."""
    skirt_friction: HalfWidth | None = None
    """Of the friction of bulk on skirts, up and down."""
    forming_load: HalfWidth | None = None
    """Of a pipe's forming load, or of the stiffness across its belt, up and down."""
    temperature: Annotated[TemperatureDifference, Bounds(gt="0 K", le="100 K")] | None = None
    """Of the belt's covers, up and down."""
    rubber: Switch = False
    """Whether the compounds' replicas (bootstrap of their fits) and the band of their tests are calculated."""

    draws: Annotated[int, Field(ge=0, le=100_000), AnyInteger] = 0
    """Draws of all inputs together, each calculated in full (Monte Carlo); none without."""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1), AnyInteger] = 0
    """Of the draws: the same seed draws the same."""
    correlations: tuple[Correlation, ...] = ()
    """Inputs that the draws take as correlated."""

    def half_width(self, name: str) -> float | None:
        """Half width of a range, relative or in kelvin [-, K]; None where it is not given."""
        given: Quantity | None = getattr(self, name)
        return None if given is None else si(given)

    @model_validator(mode="after")
    def _lower_first(self) -> Self:
        pair = self.flexure_share
        if pair is not None and not si(pair[0]) < si(pair[1]):
            message = f"got {text(pair[0])} to {text(pair[1])}, expected the lower value first"
            raise_problems("Uncertainty", [Problem(("flexure_share",), message)])
        return self

    @model_validator(mode="after")
    def _drawn(self) -> Self:
        problems, seen = [], set()
        if 0 < self.draws < FEWEST_DRAWS:
            problems.append(Problem(("draws",), f"got {self.draws}, expected at least {FEWEST_DRAWS}, or 0 for none"))
        if self.correlations and not self.draws:
            problems.append(Problem(("correlations",), "only draws take them: give draws: 256, or leave them out"))
        for i, pair in enumerate(self.correlations):
            named = frozenset(pair.between)
            missing = [name for name in pair.between if getattr(self, name) is None]
            why = (
                "expected two different inputs" if len(named) < 2
                else f"{missing[0]} has no range here" if missing
                else "is given twice" if named in seen
                else ""
            )  # fmt: skip
            if why:
                problems.append(Problem(("correlations", i, "between"), why))
            seen.add(named)
        raise_problems("Uncertainty", problems)
        return self
