"""Monte Carlo draws of uncertain inputs, together and correlated, each calculated in full.

Every input is normal with the ends of its range at the 5 % and 95 % quantiles, as in the first-order band; replicas of
a rubber's fit are equally likely. Draws are independent, so binomial ranks bound their percentiles.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import ConveyorError, InputError, NoSolutionError
from conveyor.line.stretches import Strand
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.models import Conveyor, RubberCompound, Uncertainty
from conveyor.models.uncertain_inputs import FEWEST_DRAWS
from conveyor.models.variants import with_alternative
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.rubber.rolling_test_factor import BAND_COVERAGE, quantile_band

Array: TypeAlias = NDArray[np.float64]
_BATCH = 64
PERCENTILE_CONFIDENCE = 0.9
"""Confidence of the bounds of a percentile."""


@dataclass(frozen=True)
class DrawnInput:
    """An input that is drawn: its name and how a draw changes the conveyor or its variant.

    `change` takes a conveyor and the distance from the middle in half widths, 1 at the high end [-]; `drag` and
    `indentation_factors` give factors of the variant; `rubber` is a compound and its equally likely replicas.
    """

    name: str
    change: Callable[[Conveyor, float], Conveyor] | None = None
    drag: float = 0.0
    indentation_factors: Mapping[Strand, float] | None = None
    rubber: tuple[RubberCompound, tuple[RubberCompound, ...]] | None = None


@dataclass(frozen=True)
class Percentiles:
    """Ends of the 90 % interval after some draws, each with its 90 % confidence bounds [W]."""

    draws: int
    low: float
    low_between: tuple[float, float]
    high: float
    high_between: tuple[float, float]


@dataclass(frozen=True, eq=False)
class MonteCarlo:
    """Power of draws.

    Attributes
    ----------
    power : ndarray
        At the motors' shafts, in the order of the draws, shape `(n,)` [W].
    refused : mapping of str to int
        Reasons why draws have no answer, with their number.
    """

    power: Array
    refused: Mapping[str, int]

    @property
    def band(self) -> tuple[float, float]:
        """90 % interval [W]."""
        return quantile_band(self.power)

    @cached_property
    def convergence(self) -> tuple[Percentiles, ...]:
        """The interval after 64, 128, 256 draws and so on."""
        count = len(self.power)
        steps = [FEWEST_DRAWS * 2**k for k in range(32) if FEWEST_DRAWS * 2**k < count]
        return tuple(power_percentiles(self.power[:n]) for n in (*steps, count))


def power_percentiles(power: Array) -> Percentiles:
    """90 % interval of draws with distribution-free bounds of its ends, by ranks.

    Parameters
    ----------
    power : ndarray
        Of at least 64 independent draws, shape `(n,)` [W]; of fewer the outermost bounds nothing.
    """
    from scipy.stats import binom  # takes 0.3 s, not needed without draws

    ranked, count = np.sort(power), len(power)
    low, high = quantile_band(power)

    def between(share: float) -> tuple[float, float]:
        first, last = (int(binom.ppf(0.5 + sign * 0.5 * PERCENTILE_CONFIDENCE, count, share)) for sign in (-1.0, 1.0))
        return float(ranked[first - 1]), float(ranked[last])

    return Percentiles(count, low, between(0.5 - 0.5 * BAND_COVERAGE), high, between(0.5 + 0.5 * BAND_COVERAGE))


def calculate_draws(
    given: CalculatedConveyor,
    inputs: Sequence[DrawnInput],
    ranges: Uncertainty,
    *,
    end: float,
    take_up: TakeUpSetting | None,
    rtol: float | None,
    progress: ProgressCallback | None,
) -> MonteCarlo:
    """Draw all inputs together and calculate every draw.

    Parameters
    ----------
    given : CalculatedConveyor
        The spec calculated.
    inputs : sequence of DrawnInput
        Inputs to draw.
    ranges : Uncertainty
        Draws, seed and correlations.
    end : float
        Standard deviations from the middle to an end of a range [-].
    take_up : TakeUpSetting or None
        Setting and side in every draw [N]; by default the least of each.
    rtol : float or None
        Relative tolerance of the contacts [-]; by default that of the spec.
    progress : callable or None
        Called with the items done and their total.

    Raises
    ------
    InputError
        The correlations contradict each other, or name an input that is not drawn.
    NoSolutionError
        Fewer than 64 draws have an answer.
    """
    rng = np.random.default_rng(ranges.seed)
    normal = (
        rng.standard_normal((ranges.draws, len(inputs))) @ _correlation_root([one.name for one in inputs], ranges).T
    )
    power: list[float] = []
    refused: Counter[str] = Counter()
    for at in range(0, ranges.draws, _BATCH):
        variants: list[Variant] = []
        for row in normal[at : at + _BATCH]:
            try:
                made = _draw_variant(given.conveyor, inputs, row.tolist(), end)
                variants.append(replace(made, take_up=take_up))
            except ConveyorError as error:
                refused[str(error)] += 1
        for result in calculate_many(variants, rtol, known=given):
            if isinstance(result, CalculatedConveyor):
                power.append(result.balance.power.motor)
            else:
                refused[str(result)] += 1
        if progress is not None:
            progress(min(at + _BATCH, ranges.draws), ranges.draws)
    if len(power) < FEWEST_DRAWS:
        why = "; ".join(refused)
        raise NoSolutionError(f"uncertainty.draws: {len(power)} of {ranges.draws} draws have an answer: {why}")
    return MonteCarlo(np.array(power), dict(refused.most_common()))


def _correlation_root(names: Sequence[str], ranges: Uncertainty) -> Array:
    """Cholesky root of the correlation matrix, which correlates independent normals."""
    matrix = np.eye(len(names))
    for pair in ranges.correlations:
        for name in pair.between:
            if name not in names:
                raise InputError(f"uncertainty.correlations: {name} is not drawn; give it a range that matters")
        i, j = (names.index(name) for name in pair.between)
        matrix[i, j] = matrix[j, i] = pair.coefficient
    try:
        return np.asarray(np.linalg.cholesky(matrix), dtype=float)
    except np.linalg.LinAlgError:
        raise InputError("uncertainty.correlations: contradict each other: no inputs have them all") from None


def _draw_variant(conveyor: Conveyor, inputs: Sequence[DrawnInput], row: Sequence[float], end: float) -> Variant:
    """Variant of one draw."""
    made, drag = conveyor, 1.0
    factors: dict[Strand, float] = {}
    for one, normal in zip(inputs, row, strict=True):
        away = normal / end
        if one.change is not None:
            made = one.change(made, away)
        if one.rubber is not None:
            compound, replicas = one.rubber
            made = with_alternative(made, compound, replicas[int(float(ndtr(normal)) * len(replicas))])
        if one.indentation_factors is not None:
            factors |= {strand: math.exp(away * half) for strand, half in one.indentation_factors.items()}
        drag += one.drag * away
    if drag <= 0.0:
        raise InputError("roll drag: a draw of it is not above 0; its range is too wide to be normal")
    return Variant(made, indentation_factors=factors, roll_drag=drag)
