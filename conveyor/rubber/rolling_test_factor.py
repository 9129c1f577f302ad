"""Test factor: indentation measured in rolling-resistance tests over the theory at the same points.

The theory gives the effect of geometry, speed and temperature, the tests the factor on it, fitted by least squares as

    ln(measured/calculated) = ln f(T) + slope ln(w/w0)

with one f at every tested temperature, linear between them, and a slope in the line load where the tests cover one.
Beyond the tested temperatures and loads the factor is held and its band widens.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, positive_vector
from conveyor.arguments.limits import require, require_not_negative
from conveyor.errors import InputError

UNTESTED_FACTOR: Final = 2.5
"""Published tests of low-resistance covers (CEMA-7, DIN 22123) lie 2 to 2.5 times above the theory with small-strain
data of tyre-type rubber [-]: the highest test factor to expect of an untested compound."""
PLAUSIBLE_FACTOR: Final = (0.5, 2.0 * UNTESTED_FACTOR)
"""Test factors outside are slips of unit, roll or cover: half the theory to twice the highest published factor, 2.5
(derived; that twice is enough is general knowledge) [-]."""
USUAL_FACTOR: Final = (0.7, 3.0)
"""Factors beyond it are remarked: published tests lie at 1 to 2.5 (derived: a fifth to a third beyond) [-]."""
USUAL_EXPONENT: Final = (1.1, 1.45)
"""Exponent of the line load in the resistance of a roll: 4/3 by half-space theory (general knowledge) [-]."""
EXPONENT_MARGIN: Final = 0.1
"""Usual excess of measured exponents over the theory's own on a thin cover (general knowledge) [-]."""
USUAL_ROLL_DIAMETER: Final = (0.05, 0.25)
"""Roll diameters of belt conveyors and test rigs [m] (general knowledge)."""
USUAL_COVER_THICKNESS: Final = (0.001, 0.015)
"""Thickness of covers [m] (general knowledge); more is the thickness of a belt."""
DEVIATIONS_OF_90_PERCENT: Final = 1.6448536269514722
"""Half-width of the central 90 % of a normal distribution, in standard deviations [-]."""
TEMPERATURE_TOLERANCE: Final = 2.0
"""Tests this close count as one temperature: control of a climatic chamber (general knowledge) [K]."""
LEAST_LOAD_RATIO: Final = 1.5
"""Least ratio of largest to smallest line load for a slope [-]; below it scatter would be fitted."""
BAND_COVERAGE: Final = 0.9
"""Probability that a range or a band covers [-]."""
BAND_PER_KELVIN: Final = 0.005
"""Half-width of the band per kelvin beyond the tested temperatures (general knowledge) [1/K]."""
BAND_PER_LOAD: Final = 0.1
"""Half-width of the exponent of the line load beyond the tested loads (general knowledge) [-]."""


@dataclass(frozen=True, eq=False)
class RollingTestFactor:
    """Test factor on calculated indentation.

    Attributes
    ----------
    temperatures, levels : ndarray, shape (m,)
        Tested temperatures, ascending [K], and ln of the test factor there at `load` [-].
    slope : float
        d ln factor/d ln line load [-]; 0 where the tests have one load.
    load : float
        w0, geometric mean of the tested line loads [N/m].
    loads : tuple of float
        Lowest and highest tested line load [N/m].
    half_width : float
        Half-width of the 90 % band of ln factor at the tests: residuals and uncertainty of a test [-].
    points : int
        Number of test points.
    shared : float
        Part of the half-width common to all belts tested alike [-].
    """

    temperatures: FloatArray
    levels: FloatArray
    slope: float
    load: float
    loads: tuple[float, float]
    half_width: float
    points: int
    shared: float = 0.0

    def factor(self, line_load: ArrayLike, temperature: float) -> FloatArray:
        """Test factor [-] at line loads [N/m] and a temperature [K], held beyond the tests."""
        held = np.clip(np.asarray(line_load, dtype=np.float64), *self.loads)
        level = float(np.interp(temperature, self.temperatures, self.levels))
        return np.asarray(np.exp(level + self.slope * np.log(held / self.load)))

    def band(self, line_load: float, temperature: float) -> float:
        """Half-width of the 90 % band of ln factor [-] at a line load [N/m] and temperature [K]."""
        beyond = abs(temperature - self.nearest(temperature))
        outside = abs(math.log(line_load / min(max(line_load, self.loads[0]), self.loads[1])))
        return math.hypot(self.half_width, BAND_PER_KELVIN * beyond, BAND_PER_LOAD * outside)

    def nearest(self, temperature: float) -> float:
        """Temperature limited to the tested range [K]."""
        return min(max(temperature, float(self.temperatures[0])), float(self.temperatures[-1]))

    @property
    def own_half_width(self) -> float:
        """Half-width of ln factor without the part common to belts tested alike [-].

        Unknown speed, roll and loads of the tests, and the extrapolation beyond tested temperatures and loads, are
        errors of the method: they cancel between two such belts.
        """
        return math.sqrt((self.half_width - self.shared) * (self.half_width + self.shared))

    def tested_at(self, temperature: float) -> bool:
        """True if a temperature [K] is within the tested ones, or within `TEMPERATURE_TOLERANCE` of them."""
        low, high = float(self.temperatures[0]), float(self.temperatures[-1])
        return low - TEMPERATURE_TOLERANCE <= temperature <= high + TEMPERATURE_TOLERANCE


def quantile_band(values: ArrayLike) -> tuple[float, float]:
    """Quantiles at 5 % and 95 % of draws; of 19 draws the outermost.

    Between draws k and n + 1 - k of n the next one lies with a chance of (n + 1 - 2 k)/(n + 1): Weibull's positions.

    Examples
    --------
    >>> [round(end, 9) for end in quantile_band(range(1, 100))]
    [5.0, 95.0]
    """
    low, high = np.quantile(
        np.asarray(values, dtype=float),
        (0.5 - 0.5 * BAND_COVERAGE, 0.5 + 0.5 * BAND_COVERAGE),
        method="weibull",
    )
    return float(low), float(high)


def fit_test_factor(
    line_load: ArrayLike, temperature: ArrayLike, ratio: ArrayLike, *, uncertainty: float, shared: float = 0.0
) -> RollingTestFactor:
    """Fit the test factor to ratios measured/calculated indentation [-] at line loads [N/m] and temperatures [K].

    `uncertainty` is that of a test [-], `shared` its part common to all belts tested alike [-].

    Notes
    -----
    The band is the root of the squares of 1.645 standard deviations of the residuals, where there are more tests than
    parameters, and of the uncertainty of a test. Residuals of tests on several rolls, covers and speeds include the
    error of transferring one to another.

    Examples
    --------
    >>> anchor = fit_test_factor([1e3, 2e3, 4e3], [293.15] * 3, [2.0, 2.0, 2.0], uncertainty=0.1)
    >>> round(float(anchor.factor(3e3, 293.15)), 6), round(anchor.band(3e3, 293.15), 3)
    (2.0, 0.1)
    >>> round(anchor.band(3e3, 273.15), 3)
    0.141
    """
    w = positive_vector("line_load", line_load, "N/m")
    at = positive_vector("temperature", temperature, "K")
    y = np.log(positive_vector("ratio", ratio, "-"))
    if not w.size == at.size == y.size > 0:
        raise InputError(f"line_load, temperature, ratio: one length of at least 1, got {w.size}, {at.size}, {y.size}")
    require_not_negative(uncertainty=uncertainty)
    require(0.0 <= shared <= uncertainty, "shared", shared, f">= 0 and <= uncertainty = {uncertainty!r}")
    levels = _temperature_numbers(at)
    middle = float(np.exp(np.mean(np.log(w))))
    low, high = float(w.min()), float(w.max())
    columns = [(levels == k).astype(np.float64) for k in range(int(levels.max()) + 1)]
    sloped = high >= LEAST_LOAD_RATIO * low and y.size > len(columns)
    if sloped:
        columns.append(np.log(w / middle))
    matrix = np.stack(columns, axis=1)
    solution, _, rank, _ = np.linalg.lstsq(matrix, y, rcond=None)
    if rank < matrix.shape[1]:  # one load per temperature: the slope is not determined
        matrix, sloped = matrix[:, :-1], False
        solution = np.linalg.lstsq(matrix, y, rcond=None)[0]
    freedom = y.size - matrix.shape[1]
    residual = math.sqrt(float(np.sum((y - matrix @ solution) ** 2)) / freedom) if freedom > 0 else 0.0
    count = int(levels.max()) + 1
    return RollingTestFactor(
        temperatures=np.array([float(np.mean(at[levels == k])) for k in range(count)]),
        levels=solution[:count],
        slope=float(solution[count]) if sloped else 0.0,
        load=middle,
        loads=(low, high),
        half_width=math.hypot(DEVIATIONS_OF_90_PERCENT * residual, uncertainty),
        points=int(y.size),
        shared=shared,
    )


def load_exponent(line_load: ArrayLike, resistance: ArrayLike) -> float | None:
    """Exponent of the line load [N/m] in resistances [N/m] of one roll, cover, speed, temperature; None if too close.

    Examples
    --------
    >>> (
    ...     round(load_exponent([1e3, 2e3, 4e3], [10.0, 25.2, 63.5]), 2),
    ...     load_exponent([1e3, 1.2e3], [10.0, 12.7]),
    ... )
    (1.33, None)
    """
    w, f = positive_vector("line_load", line_load, "N/m"), positive_vector("resistance", resistance, "N/m")
    if w.max() < LEAST_LOAD_RATIO * w.min():
        return None
    return float(np.polyfit(np.log(w), np.log(f), 1)[0])


def _temperature_numbers(temperature: FloatArray) -> FloatArray:
    """Index of the tested temperature of each test, ascending."""
    order = np.argsort(temperature, kind="stable")
    ascending = temperature[order]
    numbers, start = np.zeros(temperature.size, dtype=np.int64), float(ascending[0])
    number = 0
    for i, value in zip(order, ascending.tolist(), strict=True):
        if value - start > TEMPERATURE_TOLERANCE:
            number, start = number + 1, value
        numbers[i] = number
    return np.asarray(numbers)
