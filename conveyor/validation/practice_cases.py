"""Conveyors of published or measured resistance, compared with the computed one.

The specs have the printed data and state what is assumed; nothing is fitted to a case. A printed design includes the
allowances of its method and is compared with the upper end of the band, a measurement with the middle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from statistics import median
from typing import Any, Final, Literal

from ruamel.yaml import YAML

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.default_bands import power_range
from conveyor.models import LoadCase
from conveyor.models.variants import with_case
from conveyor.pipeline import calculate
from conveyor.spec import load

Evidence = Literal["printed", "measured"]
Resistance = Literal["friction", "main", "f", "carry set"]

QUANTITIES: Final[dict[Resistance, tuple[str, str]]] = {
    "friction": ("effective tension less lift", "N"),
    "main": ("main resistance", "N"),
    "f": ("friction factor f", "-"),
    "carry set": ("main resistance of a carry set", "N"),
}
"""Compared quantities and their units."""


@dataclass(frozen=True)
class PracticeFigure:
    """A published or measured resistance, and the computed one.

    Attributes
    ----------
    spec, source, assumed : str
        Name of the spec, source of the figure, assumptions of the spec.
    evidence : {"printed", "measured"}
        A design, or a running conveyor.
    resistance : str
        Key of `QUANTITIES`.
    loading : {"full", "empty"}
        Loading of the belt.
    stated : float
        Printed or measured [N], f [-].
    expected, low, design : float
        Computed, and both ends of the band that holds nine tenths, of the same unit.
    classical : float or None
        By ISO 5048 / DIN 22101 with the spec's f; None of a single set.
    """

    spec: str
    source: str
    assumed: str
    evidence: Evidence
    resistance: Resistance
    loading: Literal["full", "empty"]
    stated: float
    expected: float
    low: float
    design: float
    classical: float | None

    @property
    def within(self) -> bool:
        """True if the stated figure lies in the band."""
        return self.low <= self.stated <= self.design


def practice_figures() -> Iterator[PracticeFigure]:
    """Compute every conveyor of the collection.

    Yields
    ------
    PracticeFigure
        In the order of the collection.
    """
    folder = Path(str(resources.files("conveyor") / "_reference" / "practice"))
    cases: list[dict[str, Any]] = YAML(typ="safe", pure=True).load((folder / "cases.yaml").read_text(encoding="utf-8"))
    for case in cases:
        conveyor = load(folder / f"{case['spec']}.yaml")
        for figure in case["figures"]:
            empty = figure["loading"] == "empty"
            loaded = with_case(conveyor, LoadCase(name="empty", loading="empty")) if empty else conveyor
            result = calculate(loaded)
            low, high = power_range(result).friction
            expected = _computed_resistance(result, figure["what"])
            yield PracticeFigure(
                spec=case["spec"],
                source=case["source"],
                assumed=case["assumed"],
                evidence=case["kind"],
                resistance=figure["what"],
                loading=figure["loading"],
                stated=float(figure["value"]),
                expected=expected,
                low=low * expected,
                design=high * expected,
                classical=_classical_figure(result, figure["what"]),
            )


def _computed_resistance(result: CalculatedConveyor, what: Resistance) -> float:
    forces = result.balance.forces
    if what == "friction":
        return forces.total - forces.lift
    if what == "main":
        return forces.main
    if what == "f":
        return result.balance.friction_factor
    first = result.stretches[0]
    return first.main / first.stretch.sets


def _classical_figure(result: CalculatedConveyor, what: Resistance) -> float | None:
    made = result.balance.classical
    if what == "friction":
        return made.total - made.lift
    return {"main": made.main, "f": made.friction_factor}.get(what)


@dataclass(frozen=True)
class PracticeSummary:
    """Comparison of the figures of one kind of evidence.

    Attributes
    ----------
    count, within : int
        Figures, and those in their band.
    conveyors, conveyors_within : int
        Conveyors, and those of which every figure is in its band.
    design_over_stated, expected_over_stated : float
        Medians [-].
    """

    count: int
    within: int
    conveyors: int
    conveyors_within: int
    design_over_stated: float
    expected_over_stated: float


def practice_summary(figures: list[PracticeFigure]) -> PracticeSummary:
    """Medians of computed over stated, and the number of figures within their band.

    Parameters
    ----------
    figures : list of PracticeFigure
        At least one.

    Returns
    -------
    PracticeSummary
        Summary of all figures.
    """
    return PracticeSummary(
        count=len(figures),
        within=sum(figure.within for figure in figures),
        conveyors=len({figure.spec for figure in figures}),
        conveyors_within=len({one.spec for one in figures} - {one.spec for one in figures if not one.within}),
        design_over_stated=median(figure.design / figure.stated for figure in figures),
        expected_over_stated=median(figure.expected / figure.stated for figure in figures),
    )
