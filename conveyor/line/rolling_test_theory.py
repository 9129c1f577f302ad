"""Test factor of a compound: its rolling-resistance tests over the theory at the tests' own conditions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import starmap
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.contact import solve_many
from conveyor.errors import InputError, MessageQuantity, NoSolutionError, RangeError
from conveyor.indentation import RollContact, coarsen_rubber, indentation_resistances, to_problems
from conveyor.indentation.softening import COARSE_SAMPLING, SoftCover, SofteningCover, soften_covers
from conveyor.line.covers import TERM_MERGE_SHARE
from conveyor.models import RubberCompound
from conveyor.models.rolling_tests import RollingPoints
from conveyor.rubber.rolling_test_factor import (
    EXPONENT_MARGIN,
    PLAUSIBLE_FACTOR,
    UNTESTED_FACTOR,
    USUAL_EXPONENT,
    RollingTestFactor,
    fit_test_factor,
    load_exponent,
    quantile_band,
)
from conveyor.units.sentences import to_celsius

Array = NDArray[np.float64]

RTOL: Final = 1e-4
"""Relative tolerance of the theory at the tests, far below their scatter [-]."""
TEST_ROLL_SPACING: Final = 1.0
"""Spacing of a test's rolls [m]; on a stiff carcass it has no influence (`conveyor.indentation.SPACING_INFLUENCE`)."""
_REPLICA_RTOL: Final = 1e-2
"""Relative tolerance of the contacts of a band: a tenth of the narrowest band."""
_REPLICA_MERGE_TOLERANCE: Final = 1e-4
"""Relative error by merged terms of a replica, far below that."""
SOFTENED_LOAD_COUNT: Final = 3
"""Number of loads at which the rubber is softened; between them ln f is a parabola in ln w."""


@dataclass(frozen=True, eq=False)
class RollingTestRow:
    """One row of a test: line load, measured and calculated resistance [N/m], temperature [K], number of its test."""

    test: int
    line_load: float
    temperature: float
    measured: float
    calculated: float


def rolling_test_rows(compound: RubberCompound, *, softened: bool) -> tuple[RollingTestRow, ...]:
    """Measured and calculated resistance of every row of a compound's tests, at the test's own conditions.

    Parameters
    ----------
    compound : RubberCompound
        Compound with rolling-resistance tests.
    softened : bool
        Take the rubber at the strain of the test, where the compound has strain sweeps.

    Raises
    ------
    NoSolutionError
        A test's contact has no answer.
    RangeError
        The compound is not known at a test's temperature, or at its strain.
    """
    theory = RollingTestTheory([compound], softened=softened)
    (rows,) = theory.rows(soften_covers(theory.works))
    if not isinstance(rows, tuple):
        raise rows
    return rows


def compound_test_factor(compound: RubberCompound, *, softened: bool) -> RollingTestFactor | None:
    """Factor on a compound's indentation from its rolling-resistance tests; None without tests.

    Raises
    ------
    NoSolutionError, RangeError
        As `rolling_test_rows`.
    """
    (level,) = compound_test_factors([compound], softened=softened)
    if level is not None and not isinstance(level, RollingTestFactor):
        raise level
    return level


def compound_test_factors(
    compounds: Sequence[RubberCompound], *, softened: bool
) -> list[RollingTestFactor | NoSolutionError | RangeError | InputError | None]:
    """Test factors of many compounds, each as by `compound_test_factor`, all contacts solved in one batch.

    Parameters
    ----------
    compounds : sequence of RubberCompound
        Compounds.
    softened : bool
        As of `compound_test_factor`.

    Returns
    -------
    list
        Test factors in the order of the compounds, None without tests, or the error.
    """
    theory = RollingTestTheory(compounds, softened=softened)
    return theory.levels(soften_covers(theory.works))


def replica_band(
    compound: RubberCompound, contact: RollContact, load: float, temperatures: tuple[float, float]
) -> tuple[float, float]:
    """Band below and above the series by extrapolation from a tested temperature, in ln factor.

    Parameters
    ----------
    compound : RubberCompound
        Compound with rolling-resistance tests.
    contact : RollContact
        Roll on its cover; its rubber is not used.
    load : float
        Line load [N/m].
    temperatures : tuple of float
        Of the rubber, and of the nearest test [K].

    Raises
    ------
    NoSolutionError
        A replica's contact has no answer.
    RangeError
        The compound is not known at the temperature.

    Notes
    -----
    Friction of each replica over that of the series, at this temperature over the same at the tested one, at the strain
    of the master curve: softening changes all alike.
    """
    if compound.prony.band is None:
        return 0.0, 0.0
    contacts = [
        coarsen_rubber(replace(contact, series=rubber), load, _REPLICA_MERGE_TOLERANCE)
        for at in temperatures
        for rubber in (compound.series(at), *compound.replicas(at))
    ]
    solved = solve_many(to_problems(contacts, [load] * len(contacts)), _REPLICA_RTOL, throw=True)
    friction = np.array([one.friction for one in solved]).reshape(2, -1)
    carried = np.log(friction[0] / friction[1])
    low, high = quantile_band(carried[1:] - carried[0])
    return max(-low, 0.0), max(high, 0.0)


def factor_from_rows(compound: RubberCompound, rows: Sequence[RollingTestRow]) -> RollingTestFactor:
    """Fit the test factor of a compound to its rows and check that it is plausible.

    Raises
    ------
    InputError
        The tests are farther from the theory than tests of rubber are, or go with the line load as no roll does.
    """
    level = fit_test_factor(
        [row.line_load for row in rows],
        [row.temperature for row in rows],
        [row.measured / row.calculated for row in rows],
        uncertainty=max(test.relative_uncertainty for test in compound.tests),
        shared=min(test.shared for test in compound.tests),
    )
    low, high = PLAUSIBLE_FACTOR
    for t in level.temperatures.tolist():
        factor = max(level.factor(level.loads, t).tolist(), key=lambda value: abs(math.log(value)))
        if not low <= factor <= high:
            raise InputError(
                f'tests: those of "{{}}" are {factor:.3g} times the theory at {{}}, where published ones lie at 1 to '
                f"{UNTESTED_FACTOR:g} times ({low:g} to {high:g} are taken); are roll diameter, cover and units "
                f"those of "
                "the tests? To calculate without them: calculation: {{anchor: off}}",
                compound.name,
                MessageQuantity(t, "temperature", f"{to_celsius(t):.0f} degC"),
            )
    for number, exponent, (least, most) in load_exponents(rows):
        if not 2.0 * least - most <= exponent <= 2.0 * most - least:
            raise InputError(
                f'tests[{number}]: the resistance of "{{}}" goes as the line load to the power of {exponent:.2f}, '
                f"where rolls have {least:.3g} to {most:.3g} (as far again on either side is taken); are line loads "
                "and resistances per width, without the drag of bearings, in the units of the columns? To calculate "
                "without the tests: calculation: {{anchor: off}}",
                compound.name,
            )
    return level


def load_exponents(rows: Sequence[RollingTestRow]) -> Iterator[tuple[int, float, tuple[float, float]]]:
    """Test number, fitted exponent of the line load and its usual range, where the loads allow a fit [-]."""
    for number in dict.fromkeys(row.test for row in rows):
        mine = [row for row in rows if row.test == number]
        loads = [row.line_load for row in mine]
        measured = load_exponent(loads, [row.measured for row in mine])
        theory = load_exponent(loads, [row.calculated for row in mine])
        if measured is not None and theory is not None:
            yield number, measured, (USUAL_EXPONENT[0], max(USUAL_EXPONENT[1], theory + EXPONENT_MARGIN))


def _rows_of_test(
    number: int, test: tuple[RollingPoints, Array | NoSolutionError | RangeError]
) -> Iterator[RollingTestRow]:
    """Rows of one test."""
    points, calculated = test
    for load, measured, ours in zip(points.line_load, points.resistance, np.asarray(calculated), strict=True):
        yield RollingTestRow(number, float(load), points.temperature, float(measured), float(ours))


class RollingTestTheory:
    """Theory at the rolling-resistance tests of compounds, in two steps: softened covers, then contacts.

    Attributes
    ----------
    compounds : tuple of RubberCompound
        Compounds with their tests.
    softened : bool
        Take the rubber at the strain of the test.
    works : list of SofteningCover
        Contacts whose covers are to be softened.
    """

    def __init__(self, compounds: Sequence[RubberCompound], *, softened: bool) -> None:
        self.compounds, self.softened = tuple(compounds), softened
        self._tests = [(compound, test.points()) for compound in compounds for test in compound.tests]
        self._refused: dict[int, NoSolutionError | RangeError] = {}
        self._asked: dict[tuple[int, float], RollContact] = {}
        works: dict[tuple[int, float], SofteningCover] = {}
        for i, (compound, points) in enumerate(self._tests):
            try:
                contact, swept = _test_contact(compound, points), compound.swept_series(points.temperature)
            except RangeError as error:
                self._refused[i] = error
                continue
            factors = compound.amplitude_factors() if softened else None
            for w in _load_nodes(points.line_load, few=factors is not None):
                self._asked[i, w] = contact
                if factors is not None:
                    works[i, w] = SofteningCover(contact, w, factors, points.temperature, swept, COARSE_SAMPLING)
        self._worked, self.works = list(works), list(works.values())

    def levels(
        self, covers: Sequence[SoftCover | NoSolutionError | RangeError]
    ) -> list[RollingTestFactor | NoSolutionError | RangeError | InputError | None]:
        """Test factors of the compounds from the softened covers in the order of `works`."""
        levels: list[RollingTestFactor | NoSolutionError | RangeError | InputError | None] = []
        for compound, rows in zip(self.compounds, self.rows(covers), strict=True):
            try:
                levels.append(
                    rows if not isinstance(rows, tuple) else factor_from_rows(compound, rows) if rows else None
                )
            except InputError as error:
                levels.append(error)
        return levels

    def rows(
        self, covers: Sequence[SoftCover | NoSolutionError | RangeError]
    ) -> list[tuple[RollingTestRow, ...] | NoSolutionError | RangeError]:
        """Test rows of each compound, or the error of its first test without a solution."""
        theory = iter(self._resistances(covers))
        points = (points for _, points in self._tests)
        rows_of: list[tuple[RollingTestRow, ...] | NoSolutionError | RangeError] = []
        for compound in self.compounds:
            each = [(next(points), next(theory)) for _ in compound.tests]
            refused = next((ours for _, ours in each if isinstance(ours, NoSolutionError | RangeError)), None)
            rows_of.append(refused or tuple(itertools.chain.from_iterable(starmap(_rows_of_test, enumerate(each)))))
        return rows_of

    def _resistances(
        self, covers: Sequence[SoftCover | NoSolutionError | RangeError]
    ) -> list[Array | NoSolutionError | RangeError]:
        """Calculated resistance per width of each test at its loads [N/m], solved in one batch."""
        refused, asked = dict(self._refused), dict(self._asked)
        for (i, w), soft in zip(self._worked, covers, strict=True):
            if isinstance(soft, tuple):
                asked[i, w] = replace(asked[i, w], series=soft[0])
            else:
                refused.setdefault(i, soft)
                del asked[i, w]
        solved = indentation_resistances(list(asked.values()), [w for _, w in asked], RTOL)
        there: list[dict[float, float]] = [{} for _ in self._tests]
        for (i, w), one in zip(asked, solved, strict=True):
            if isinstance(one, NoSolutionError):
                refused.setdefault(i, NoSolutionError("a rolling-resistance test: {}", one))
            else:
                there[i][w] = one
        return [
            refused[i] if i in refused else _interpolate_resistance(there[i], points.line_load)
            for i, (_, points) in enumerate(self._tests)
        ]


def _test_contact(compound: RubberCompound, points: RollingPoints) -> RollContact:
    """Contact of a test's roll on its cover."""
    contact = RollContact(
        radius=points.radius,
        spacing=max(TEST_ROLL_SPACING, 4.0 * points.radius),
        cover_thickness=points.cover_thickness,
        speed=points.speed,
        series=compound.series(points.temperature),
        poisson=compound.poisson_ratio,
    )
    return coarsen_rubber(contact, float(points.line_load.min()), TERM_MERGE_SHARE * RTOL)


def _load_nodes(loads: Array, *, few: bool) -> list[float]:
    """Line loads at which a test is calculated [N/m]: a few over their range, or each one."""
    low, high = float(loads.min()), float(loads.max())
    nodes = np.geomspace(low, high, SOFTENED_LOAD_COUNT) if few and high > low else loads
    return [float(w) for w in np.unique(nodes)]


def _interpolate_resistance(resistances: Mapping[float, float], loads: Array) -> Array:
    """Resistance at line loads, interpolated by a polynomial in the logarithms [N/m]."""
    if set(resistances) >= set(loads.tolist()):
        return np.array([resistances[w] for w in loads.tolist()])
    nodes, values = np.log(list(resistances.items())).T
    shape = np.polynomial.Polynomial.fit(nodes, values, nodes.size - 1)
    return np.asarray(np.exp(shape(np.log(loads))))
