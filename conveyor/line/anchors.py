"""Anchor of a compound: its rolling-resistance tests over the theory on the rolls and covers of the tests."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError, NoSolutionError
from conveyor.indentation import RollContact, indentation_curves
from conveyor.laws.softening import COARSE, WorkedCover, softened_each
from conveyor.models import RubberCompound
from conveyor.models.rolling_tests import RollingPoints
from conveyor.rubber.anchor import PLAUSIBLE, UNANCHORED, Anchor, fit_anchor
from conveyor.units.sentences import celsius

Array = NDArray[np.float64]

RTOL: Final = 1e-4
"""Of the theory at the tests: far below their scatter [-]."""
SPACING: Final = 1.0
"""Between the rolls of a test [m]; a cover on a stiff carcass forgets it (`conveyor.indentation.MEMORY`)."""
SOFT_LOADS: Final = 3
"""Loads at which a test's rubber is taken at its own strain; between them ln f is a parabola in ln w."""


@dataclass(frozen=True, eq=False)
class RollingRow:
    """One row of a test: line load, measured and calculated resistance [N/m], temperature [K], number of its test."""

    test: int
    line_load: float
    temperature: float
    measured: float
    calculated: float


def anchor_rows(compound: RubberCompound, *, softened: bool) -> tuple[RollingRow, ...]:
    """Every row of a compound's tests beside the theory, on the test's own roll, cover, speed and temperature.

    Parameters
    ----------
    compound : RubberCompound
        With tests.
    softened : bool
        Whether its rubber is taken at the strain of the test, where the compound knows it.

    Raises
    ------
    NoSolutionError
        A test's contact has no answer.
    RangeError
        The compound is not known at a test's temperature, or at its strain.
    """
    rows: list[RollingRow] = []
    for number, test in enumerate(compound.tests):
        points = test.points()
        calculated = _theory(compound, points, softened=softened)
        rows += [
            RollingRow(number, load, points.temperature, measured, ours)
            for load, measured, ours in zip(
                points.line_load.tolist(), points.resistance.tolist(), calculated.tolist(), strict=True
            )
        ]
    return tuple(rows)


def anchor(compound: RubberCompound, *, softened: bool) -> Anchor | None:
    """The level of a compound's indentation, from its tests; None without any.

    Raises
    ------
    NoSolutionError, RangeError
        As `anchor_rows`.
    """
    return anchor_of(compound, anchor_rows(compound, softened=softened)) if compound.tests else None


def anchor_of(compound: RubberCompound, rows: Sequence[RollingRow]) -> Anchor:
    """The level of a compound from its tests beside the theory.

    Raises
    ------
    InputError
        The tests are farther from the theory than tests of rubber are.
    """
    level = fit_anchor(
        [row.line_load for row in rows],
        [row.temperature for row in rows],
        [row.measured / row.calculated for row in rows],
        uncertainty=max(test.relative_uncertainty for test in compound.tests),
    )
    low, high = PLAUSIBLE
    for t in level.temperatures.tolist():
        factor = max(level.factor(level.loads, t).tolist(), key=lambda value: abs(math.log(value)))
        if not low <= factor <= high:
            raise InputError(
                f'tests: those of "{compound.name}" are {factor:.3g} times the theory at {celsius(t):.0f} degC, where '
                f"published ones lie at 1 to {UNANCHORED:g} times ({low:g} to {high:g} are taken); are roll diameter, "
                "cover and units those of the tests? To calculate without them: calculation: {anchor: off}"
            )
    return level


def _theory(compound: RubberCompound, points: RollingPoints, *, softened: bool) -> Array:
    """Calculated resistance per width at a test's loads [N/m]."""
    contact = RollContact(
        radius=points.radius,
        spacing=max(SPACING, 4.0 * points.radius),
        cover_thickness=points.cover_thickness,
        speed=points.speed,
        rubber=compound.series(points.temperature),
        poisson=compound.poisson_ratio,
    )
    factors = compound.amplitude_factors() if softened else None
    low, high = float(points.line_load.min()), float(points.line_load.max())
    if factors is None:
        return _resistance([contact], [points.line_load])[0]
    nodes = np.unique(np.geomspace(low, high, SOFT_LOADS if high > low else 1))
    swept = compound.swept_series(points.temperature)
    works = [WorkedCover(contact, w, factors, points.temperature, swept) for w in nodes.tolist()]
    covers = [series for series, _ in softened_each(works, inside=COARSE)]
    resistances = _resistance(
        [replace(contact, rubber=cover) for cover in covers], [np.array([w]) for w in nodes]
    )
    shape = np.polynomial.Polynomial.fit(np.log(nodes), np.log(np.concatenate(resistances)), nodes.size - 1)
    return np.asarray(np.exp(shape(np.log(points.line_load))))


def _resistance(contacts: list[RollContact], loads: list[Array]) -> list[Array]:
    """Resistance per width of contacts at their loads [N/m], solved side by side."""
    lowest = [float(w.min()) * (1.0 - RTOL) for w in loads]  # a curve is solved between two loads
    curves = indentation_curves(contacts, lowest, [float(w.max()) for w in loads], RTOL)
    resistances = []
    for curve, w in zip(curves, loads, strict=True):
        if isinstance(curve, NoSolutionError):
            raise NoSolutionError(f"a rolling-resistance test: {curve}")
        resistances.append(curve.resistance(w))
    return resistances
