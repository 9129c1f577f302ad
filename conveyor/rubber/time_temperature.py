"""Isotherms to a master curve: all shifts at once, against one smooth curve, with their uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from conveyor.arguments.arrays import FloatArray, positive_number
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.rubber.joint_shift import LONGEST_STEP, JointMinimum, JointShift
from conveyor.rubber.master_curve import (
    LEAST_ROWS,
    SAME_FREQUENCY,
    TREND_LIMIT,
    Isotherm,
    Resonance,
    ShiftVariant,
    Superposition,
    Trend,
    TrendSlope,
    off_resonance,
)
from conveyor.rubber.misfit import hampel_weights
from conveyor.rubber.monotone import MonotoneCubic
from conveyor.rubber.overlap import LogIsotherm, first_guess, measure_overlap
from conveyor.rubber.shift import celsius_in_message

DIFFERENCE_STEP = 1.0e-4
"""Step of a central difference: a hundredth of the smallest shift that matters [decades]."""
MODULI = {"both": (0, 1), "storage": (0,), "loss": (1,)}
"""Rows of `LogIsotherm.y` that count."""
LEAST_ISOTHERMS = 3
"""Isotherms that must hold a frequency to separate a resonance from one bad row [-]."""
OUTLIER_TRUST = 0.5
"""Weight below which a row is an outlier: 4.4 robust standard deviations of the residuals, see `hampel_weights` [-]."""
LEAST_VERTICAL = 0.004
"""Least range of log10 b_T: below it a vertical shift changes no modulus by 1 % [decades]."""
NORMAL_QUANTILE_999 = 3.09
NORMAL_QUANTILE_99 = 2.326
"""Quantiles of the normal distribution [-]."""
RANK_TOLERANCE = 1.0e-10
"""Eigenvalues of a covariance below this share of the largest are rounding: the reference has no error [-]."""
LN10 = float(np.log(10.0))


def superpose(
    isotherms: Sequence[Isotherm],
    reference: float,
    *,
    vertical: bool = False,
    by: Literal["both", "storage", "loss"] = "both",
) -> Superposition:
    """Shift isotherms onto one master curve.

    Parameters
    ----------
    isotherms : sequence of Isotherm
        At least two, at distinct temperatures, any order.
    reference : float
        Absolute temperature at which a_T is to be 1, within the measured ones [K].
    vertical : bool
        Whether the moduli are scaled by a b_T of each isotherm too [-].
    by : {"both", "storage", "loss"}
        The moduli whose overlap counts; the other is carried along. "storage" where E'' is disturbed
        (resonance of the instrument, a stiff glass) [-].

    Returns
    -------
    Superposition
        Shifts, uncertainties, master curve, residuals.

    Raises
    ------
    InputError
        If there are fewer than two isotherms, a temperature occurs twice, or two neighbours do not overlap.
    RangeError
        If the reference is outside the measured temperatures.
    NoSolutionError
        If the data do not determine the shifts (flat curves; with `vertical`, power laws).

    Notes
    -----
    ln E' and ln E'' of all isotherms are regressed on two common smooth functions of log10(f a_T), penalised
    cubic splines, and on the shifts, together: Honerkamp and Weese's idea with splines for their polynomial.
    Stiffness of the curves and noise of each modulus follow from the restricted likelihood, so E' and E''
    weigh by how well they superpose. The first guess lays each isotherm on its hotter neighbour.

    An outlier loses its weight (`conveyor.rubber.misfit.hampel_weights`). A frequency with outliers in most
    isotherms is a
    resonance of the instrument: its rows are left out of all of them, also where one isotherm alone reaches.

    Isotherms with little slope are placed by a prior: the decades per kelvin change from one pair of
    neighbours to the next by half of their mean, as a standard deviation (`conveyor.rubber.joint_shift.RATE_SCATTER`).

    The uncertainty is the posterior covariance of the shifts with the curves integrated out: slope and
    scatter in the overlaps, carried along the chain to the reference. Residuals that correlate within an
    isotherm carry less information; the covariance is widened by (1 + c)/(1 - c). Without `vertical`, a score
    test shows whether vertical shifts are missing.

    E' and E'' of one rubber ask for the same shifts. Trends that contradict that are fitted together with the
    shifts: E'' that grows with each decade of measured frequency (a phase error) or in proportion to it (a time lag of
    the instrument), and both moduli that grow with cold (a vertical shift, or clamps). Where all together are beyond
    chance (99 %), they are left out one by one, the least first, until each is; with those left the shifts are a
    variant. The isotherms are placed by E' alone, by
    E'' alone and by both too, by both also with vertical shifts; where no trends make the isotherms one curve, each of
    these that differs from the chosen one beyond chance (99.9 %, twice) is one too: by Hausman's test (the less
    efficient estimate differs by no more than its variance), which takes the curves as straight as far as the shifts
    are uncertain, and by the likelihood ratio, which does not. The largest difference enters the uncertainty as one
    standard deviation. Not covered: errors
    of the thermometer (1 K is 0.1 decade or more near the glass transition), nor what all rows share.

    A reference between two isotherms is placed by monotone (PCHIP) interpolation of log10 a_T over T, as
    `ShiftTable` does; the error of that interpolation is not in the uncertainty.

    Only the bend of the curves separates a vertical shift from a horizontal one; look at the errors.

    References
    ----------
    J. Honerkamp, J. Weese, Rheol. Acta 32 (1993) 57-64 (shifts by joint regression).
    M. Gergesova, B. Zupancic, I. Saprunov, I. Emri, J. Rheol. 55 (2011) 1-16 (shifts pair by pair).
    J. A. Hausman, Econometrica 46 (1978) 1251-1271 (test of two estimates of one quantity).
    G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432 (variable projection).

    Examples
    --------
    >>> from conveyor.rubber.prony import PronySeries
    >>> series = PronySeries(1e6, np.full(13, 1e6), np.logspace(-9, 3, 13))
    >>> f = np.logspace(-1, 2, 10)
    >>> def sweep(t, a):
    ...     omega = 2 * np.pi * f * 10**a
    ...     return Isotherm(t, f, series.storage(omega), series.loss(omega))
    >>> result = superpose([sweep(273.0, 2.5), sweep(283.0, 1.2), sweep(293.0, 0.0)], reference=293.0)
    >>> [round(float(a), 2) for a in result.log10_a_T[:2]]
    [2.5, 1.2]
    """
    sheets, t_ref = _check_isotherms(isotherms, reference)
    if by not in MODULI:
        raise InputError(f'by = {by!r} must be "both", "storage" or "loss"')
    moduli = MODULI[by]
    placed = _place_isotherms(sheets, moduli, vertical=vertical)
    resonances = _find_resonances(sheets, moduli, placed)
    if resonances:
        sheets = [_without_frequencies(sheet, [one.frequency for one in resonances]) for sheet in sheets]
        placed = _place_isotherms(sheets, moduli, vertical=vertical)
    chosen = replace(_assemble_master_curve(sheets, t_ref, moduli, placed), resonances=resonances)
    others = _place_otherwise(sheets, by, vertical=vertical)
    if not vertical and by == "both" and (shifted := others.get(("both", True))) is not None:
        needed = _needs_vertical(chosen, sheets, (moduli, placed), shifted)
        if needed:
            chosen = replace(chosen, with_vertical=_assemble_master_curve(sheets, t_ref, moduli, shifted))
    variants = [_tested_variant(chosen, (by, vertical), other, placement) for placement, other in others.items()]
    joint = placed if by == "both" else others.get(("both", vertical))
    trends = None
    if joint is not None and len(sheets) >= LEAST_ISOTHERMS:
        trends = _find_trends(sheets, joint, vertical=vertical)
    if trends is not None:
        chosen = replace(chosen, phase_slope=trends.phase, cold_slope=trends.cold)
        if trends.found:
            variants.append(_shift_variant(chosen, trends.placed, ("both", vertical), trends))
    return _add_spread(replace(chosen, variants=tuple(variants)))


Placement: TypeAlias = tuple[Literal["both", "storage", "loss"], bool]
"""Moduli that count, and True with vertical shifts."""


def _place_otherwise(sheets: list[LogIsotherm], by: str, *, vertical: bool) -> dict[Placement, JointMinimum]:
    """Isotherms placed by the other moduli, and by both with vertical shifts, as far as they are determined.

    Of one modulus alone only the bend of its curve separates a vertical shift from a horizontal one: it says nothing.
    """
    made: dict[Placement, JointMinimum] = {}
    others: list[Placement] = [("both", vertical), ("storage", vertical), ("loss", vertical)]
    for other, shifted in others if vertical else [*others, ("both", True)]:
        if (other, shifted) != (by, vertical):
            try:
                made[other, shifted] = _place_isotherms(sheets, MODULI[other], vertical=shifted)
            except NoSolutionError:  # flat curves; straight lines in log-log with vertical shifts
                continue
    return made


class _Trends(NamedTuple):
    """Isotherms placed with the trends that are beyond chance, which those are, and what they come to."""

    placed: JointMinimum
    found: tuple[Trend, ...]
    phase: TrendSlope | None
    cold: TrendSlope | None

    def slope(self, trend: Trend) -> float:
        """Slope of a trend; 0 where it is not among those found."""
        return float(self.placed.slope[self.found.index(trend)]) if trend in self.found else 0.0


def _find_trends(sheets: list[LogIsotherm], without: JointMinimum, *, vertical: bool) -> _Trends | None:
    """Fit all trends together, and leave out the least until each is beyond chance; None if not determined."""
    decades = float(np.ptp(np.concatenate([sheet.x for sheet in sheets])))
    weights = {"phase": 1.0, "lag": -np.expm1(-LN10 * decades) / decades}
    found: tuple[Trend, ...] = ("phase", "lag") if vertical else ("phase", "lag", "cold")
    phase, cold = None, None
    while True:
        try:
            placed = _place_isotherms(sheets, MODULI["both"], vertical=vertical, trends=found)
        except NoSolutionError:  # flat curves
            return None
        if {"phase", "lag"} & set(found):
            phase = _summed_slope(placed, [weights.get(one, 0.0) for one in found])
        if "cold" in found:
            cold = _summed_slope(placed, [float(one == "cold") for one in found])
        if not _beyond_chance(placed, without):
            return _Trends(placed, (), phase, cold)
        z = np.abs(placed.slope) / np.sqrt(np.diagonal(placed.slope_covariance))
        if np.min(z) > TREND_LIMIT or len(found) == 1:
            return _Trends(placed, found if np.min(z) > TREND_LIMIT else (), phase, cold)
        found = tuple(one for k, one in enumerate(found) if k != int(np.argmin(z)))


def _beyond_chance(placed: JointMinimum, without: JointMinimum) -> bool:
    """True if trends are beyond chance (99 %), all together and in what they leave of the moduli.

    On a plateau the shifts follow from their prior, and so would trends: the scatter of the rows does not fall.
    """
    limit = _chi2_limit(placed.slope.size, NORMAL_QUANTILE_99)
    together = float(placed.slope @ np.linalg.solve(placed.slope_covariance, placed.slope))
    fall = float(np.sum(np.log(np.array(without.scatter) / np.array(placed.scatter))))
    return together > limit and 2.0 * placed.residual.shape[1] * fall > limit


def _summed_slope(placed: JointMinimum, weights: list[float]) -> TrendSlope:
    """Weighted sum of the slopes of trends, with its error."""
    w = np.array(weights)
    return TrendSlope(float(w @ placed.slope), float(np.sqrt(w @ placed.slope_covariance @ w)))


def _shift_variant(
    chosen: Superposition, placed: JointMinimum, placement: Placement, trends: _Trends | None = None
) -> ShiftVariant:
    """Another placement beside the chosen one."""
    a, b, covariance = _zeroed_shifts(chosen.temperatures, chosen.reference, placed)
    other = ShiftVariant(
        *placement, a, b, _standard_errors(covariance[: a.size, : a.size]), covariance, placed.correlation,
        differs=False,
    )  # fmt: skip
    if trends is None:
        return other
    highest = float((chosen.frequency / 10.0 ** chosen.log10_a_T[chosen.isotherm]).max())
    return replace(
        other, differs=True, trends=trends.found, phase_slope=trends.slope("phase"),
        lag_slope=trends.slope("lag") / highest,
    )  # fmt: skip


def _tested_variant(
    chosen: Superposition, placement: Placement, placed: JointMinimum, other_placement: Placement
) -> ShiftVariant:
    """Another placement, tested against the chosen one."""
    other = _shift_variant(chosen, placed, other_placement)
    differs = _differs_beyond_chance(chosen, placement, other) and _fits_beyond_chance(chosen, placement, placed, other)
    return replace(other, differs=differs)


def _add_spread(chosen: Superposition) -> Superposition:
    """Add the largest difference to a contradicting variant to the uncertainty."""
    n = chosen.temperatures.size
    apart = [(other.shifts - chosen.shifts).ravel() for other in chosen.contradicting]
    if not apart:
        return chosen
    largest = max(apart, key=lambda one: float(np.linalg.norm(one[:n])))
    covariance = chosen.own_covariance + np.outer(largest, largest)
    return replace(
        chosen,
        joint_covariance=covariance,
        log10_a_T_error=_standard_errors(covariance[:n, :n]),
        log10_b_T_error=_standard_errors(covariance[n:, n:]),
    )


def _differs_beyond_chance(chosen: Superposition, placement: Placement, other: ShiftVariant) -> bool:
    """True if two placements differ in log10 a_T by more than the less efficient of them may."""
    (by, vertical), n = placement, chosen.temperatures.size
    nested = set(MODULI[other.by]) <= set(MODULI[by]) and other.vertical >= vertical
    contains = set(MODULI[by]) <= set(MODULI[other.by]) and vertical >= other.vertical
    own, others = chosen.covariance, other.joint_covariance[:n, :n]
    covariance = others if nested else own if contains else own + others
    apart = other.log10_a_T - chosen.log10_a_T
    values, vectors = np.linalg.eigh(covariance)
    known = values > RANK_TOLERANCE * values[-1]
    statistic = float(np.sum((vectors.T @ apart)[known] ** 2 / values[known]))
    return statistic > _chi2_limit(int(np.count_nonzero(known)))


def _fits_beyond_chance(chosen: Superposition, placement: Placement, placed: JointMinimum, other: ShiftVariant) -> bool:
    """True if the freer of two placements leaves less of the moduli that place it, by more than chance.

    The likelihood ratio of both scatters, of the moduli in common; True where they have none.
    """
    scatter = {0: chosen.storage_scatter, 1: chosen.loss_scatter}
    others = dict(zip(MODULI[other.by], placed.scatter, strict=True))
    rows, common = chosen.frequency.size, sorted(set(MODULI[placement[0]]) & set(MODULI[other.by]))
    if not common:
        return True
    logs = [np.log((scatter[k] or 0.0) / others[k]) for k in common]
    return 2.0 * rows * abs(float(np.sum(logs))) > _chi2_limit(chosen.temperatures.size - 1)


def _needs_vertical(
    chosen: Superposition,
    sheets: list[LogIsotherm],
    placed: tuple[tuple[int, ...], JointMinimum],
    other: JointMinimum,
) -> bool:
    """True if the isotherms need vertical shifts: score test, size, and one curve by it."""
    moduli, minimum = placed
    steps = -np.diff(minimum.shift)
    score = JointShift(sheets, moduli=moduli, vertical=True).score(
        np.concatenate([steps, np.zeros_like(steps)]), minimum.residual
    )
    chance = 2.0 / np.sqrt(chosen.frequency.size)
    return bool(
        score >= _chi2_limit(steps.size)
        and np.ptp(other.offset) >= LEAST_VERTICAL * LN10
        # else the slopes hardly separate one shift from the other
        and np.max(np.abs(np.diff(other.shift - minimum.shift))) <= LONGEST_STEP
        and other.correlation <= max(chance, 0.5 * chosen.correlation)
    )


def _chi2_limit(freedom: int, quantile: float = NORMAL_QUANTILE_999) -> float:
    """Quantile of chi squared, 99.9 % by default: Wilson and Hilferty, PNAS 17 (1931) 684-688."""
    step = 2.0 / (9.0 * freedom)
    return float(freedom * (1.0 - step + quantile * np.sqrt(step)) ** 3)


def _place_isotherms(
    sheets: list[LogIsotherm], moduli: tuple[int, ...], *, vertical: bool, trends: tuple[Trend, ...] = ()
) -> JointMinimum:
    joint = JointShift(sheets, moduli=moduli, vertical=vertical, trends=trends)
    start = [first_guess(cold, hot, moduli=moduli, vertical=vertical) for cold, hot in pairwise(sheets)]
    return joint.minimum(np.array(start).T)


def _find_resonances(sheets: list[LogIsotherm], moduli: tuple[int, ...], placed: JointMinimum) -> tuple[Resonance, ...]:
    """Frequencies whose rows are outliers in more than half of the isotherms that hold them."""
    x = np.concatenate([sheet.x for sheet in sheets])
    stray = np.min([hampel_weights(one) for one in placed.residual], axis=0) < OUTLIER_TRUST
    resonances = []
    for at in np.unique(x[stray]):
        same = np.abs(x - at) < SAME_FREQUENCY
        if np.count_nonzero(same) < LEAST_ISOTHERMS or np.mean(stray[same]) <= 0.5:
            continue
        off = dict(zip(moduli, np.expm1(np.median(placed.residual[:, same & stray], axis=1)), strict=True))
        count = int(np.count_nonzero(stray[same]))
        resonances.append(Resonance(float(10.0**at), count, float(off.get(0, 0.0)), float(off.get(1, 0.0))))
    return tuple(resonances)


def _without_frequencies(sheet: LogIsotherm, frequencies: list[float]) -> LogIsotherm:
    kept = off_resonance(sheet.x, frequencies)
    if np.count_nonzero(kept) < LEAST_ROWS:
        raise NoSolutionError(
            f"the rows at {', '.join(f'{f:g} Hz' for f in frequencies)} stand off the common curve in most isotherms"
            f" (a resonance?), and without them the one at {celsius_in_message(sheet.temperature)} has < "
            f"{LEAST_ROWS} rows"
        )
    return LogIsotherm(sheet.temperature, sheet.x[kept], sheet.y[:, kept])


def _check_isotherms(isotherms: Sequence[Isotherm], reference: float) -> tuple[list[LogIsotherm], float]:
    if len(isotherms) < 2:
        raise InputError(f"a superposition needs >= 2 isotherms; got {len(isotherms)}")
    ordered = sorted(isotherms, key=lambda one: one.temperature)
    t = np.array([one.temperature for one in ordered])
    if np.any(np.diff(t) == 0.0):
        twice = float(t[1:][np.diff(t) == 0.0][0])
        raise InputError(f"two isotherms at {celsius_in_message(twice)}: choose one run, or average the runs")
    t_ref = positive_number("reference", reference, "K")
    if not t[0] <= t_ref <= t[-1]:
        raise RangeError(
            f"reference {celsius_in_message(t_ref)} is outside the isotherms, {celsius_in_message(float(t[0]))} to"
            f" {celsius_in_message(float(t[-1]))}; shifts are not extrapolated: choose a reference inside"
        )
    return [
        LogIsotherm(one.temperature, np.log10(one.frequency), np.log([one.storage, one.loss])) for one in ordered
    ], t_ref


def _assemble_master_curve(
    sheets: list[LogIsotherm], t_ref: float, moduli: tuple[int, ...], placed: JointMinimum
) -> Superposition:
    """Move the zero of the shifts to the reference, and shift the rows."""
    t = np.array([s.temperature for s in sheets])
    size = t.size
    a, log10_b, covariance = _zeroed_shifts(t, t_ref, placed)
    b = LN10 * log10_b
    overlaps = tuple(
        measure_overlap(sheets[i], sheets[i + 1], -da, -db, held=bool(placed.held[i]))
        for i, (da, db) in enumerate(zip(np.diff(a).tolist(), np.diff(b).tolist(), strict=True))
    )
    x = np.concatenate([s.x + d for s, d in zip(sheets, a, strict=True)])
    y = np.hstack([s.y - d for s, d in zip(sheets, b, strict=True)])
    of = np.repeat(np.arange(size), [s.x.size for s in sheets])
    order = np.argsort(x, kind="stable")
    modulus = np.exp(y[:, order])
    scatter = dict(zip(moduli, placed.scatter, strict=True))
    return Superposition(
        reference=t_ref,
        temperatures=t,
        log10_a_T=a,
        log10_a_T_error=_standard_errors(covariance[:size, :size]),
        log10_b_T=log10_b,
        log10_b_T_error=_standard_errors(covariance[size:, size:]),
        joint_covariance=covariance,
        own_covariance=covariance,
        frequency=10.0 ** x[order],
        storage=modulus[0],
        loss=modulus[1],
        isotherm=of[order],
        overlaps=overlaps,
        storage_residual=float(np.sqrt(np.mean([o.storage**2 for o in overlaps]))),
        loss_residual=float(np.sqrt(np.mean([o.loss**2 for o in overlaps]))),
        storage_scatter=scatter.get(0),
        loss_scatter=scatter.get(1),
        correlation=placed.correlation,
    )


def _zeroed_shifts(t: FloatArray, t_ref: float, placed: JointMinimum) -> tuple[FloatArray, FloatArray, FloatArray]:
    """log10 a_T, log10 b_T and their covariance, 0 at the reference [K]."""
    size = t.size
    a, from_a = _zero_at_reference(t, placed.shift, t_ref)
    b, from_b = _zero_at_reference(t, placed.offset, t_ref)
    from_both = np.block([[from_a, np.zeros((size, size))], [np.zeros((size, size)), from_b / LN10]])
    return a, b / LN10, from_both @ placed.covariance @ from_both.T


def _zero_at_reference(t: FloatArray, value: FloatArray, t_ref: float) -> tuple[FloatArray, FloatArray]:
    """Values less the interpolated one at the reference, and their derivative by the values."""
    at = np.flatnonzero(t == t_ref)
    if at.size:
        weights = np.eye(t.size)[at[0]]
    else:
        moved = value + DIFFERENCE_STEP * np.vstack([np.eye(t.size), -np.eye(t.size)])
        at_reference = np.array([float(MonotoneCubic(t, row)(t_ref)) for row in moved])
        weights = (at_reference[: t.size] - at_reference[t.size :]) / (2.0 * DIFFERENCE_STEP)
    level = float(MonotoneCubic(t, value)(t_ref))
    return value - level, np.eye(t.size) - weights


def _standard_errors(covariance: FloatArray) -> FloatArray:
    """Standard deviations of a covariance; that of the reference is 0 up to rounding of either sign."""
    return np.sqrt(np.maximum(np.diagonal(covariance), 0.0))
