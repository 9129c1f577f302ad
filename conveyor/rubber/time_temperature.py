"""Isotherms to a master curve: all shifts at once, against one smooth curve, with their uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from conveyor.arguments.arrays import FloatArray, positive_number
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.rubber.joint_shift import LONGEST_STEP, JointMinimum, JointShift
from conveyor.rubber.master_curve import (
    LEAST_ROWS,
    SAME_FREQUENCY,
    Isotherm,
    PhaseSlope,
    Resonance,
    ShiftVariant,
    Superposition,
    off_resonance,
)
from conveyor.rubber.misfit import hampel_weights
from conveyor.rubber.overlap import LogIsotherm, first_guess, measure_overlap, modulus_differences
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
"""Quantile of the normal distribution [-]."""
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

    E' and E'' of one rubber ask for the same shifts. They are placed by E' alone, by E'' alone and by both, by both
    also with vertical shifts. The difference of each to the chosen one is tested against its own uncertainty
    (Hausman's test: the less efficient estimate differs by no more than its variance). Beyond the 99.9 % quantile the
    larger one of the moduli, and that of the vertical shifts, enter the uncertainty, each as one standard deviation.
    Not covered: errors
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
    others = _place_otherwise(sheets, t_ref, by, vertical=vertical)
    if not vertical:
        shifted = others.get(("both", True)) if by == "both" else None
        chosen = replace(chosen, with_vertical=_needed_vertical(chosen, sheets, (moduli, placed), shifted))
    storage = chosen if (by, vertical) == ("storage", False) else others.get(("storage", False))
    slope = None if storage is None else _phase_slope(sheets, storage.log10_a_T)
    return replace(_add_spread(chosen, (by, vertical), others), phase_slope=slope)


Placement: TypeAlias = tuple[Literal["both", "storage", "loss"], bool]
"""Moduli that count, and True with vertical shifts."""


def _place_otherwise(
    sheets: list[LogIsotherm], t_ref: float, by: str, *, vertical: bool
) -> dict[Placement, Superposition]:
    """Superpositions by the other moduli, and by both with vertical shifts, as far as they are determined.

    Of one modulus alone only the bend of its curve separates a vertical shift from a horizontal one: it says nothing.
    """
    made: dict[Placement, Superposition] = {}
    others: list[Placement] = [("both", vertical), ("storage", vertical), ("loss", vertical)]
    for other, shifted in others if vertical else [*others, ("both", True)]:
        if (other, shifted) != (by, vertical):
            try:
                placed = _place_isotherms(sheets, MODULI[other], vertical=shifted)
            except NoSolutionError:  # flat curves; straight lines in log-log with vertical shifts
                continue
            made[other, shifted] = _assemble_master_curve(sheets, t_ref, MODULI[other], placed)
    return made


def _add_spread(
    chosen: Superposition, placement: Placement, others: Mapping[Placement, Superposition]
) -> Superposition:
    """Add the differences that are beyond chance to the uncertainty: the largest by moduli, that by vertical shifts."""
    n = chosen.temperatures.size
    variants, apart = [], {False: np.zeros(2 * n), True: np.zeros(2 * n)}
    for (by, vertical), other in others.items():
        differs = _differs_beyond_chance(chosen, placement, other, (by, vertical))
        variants.append(
            ShiftVariant(
                by, vertical, other.log10_a_T, other.log10_b_T, other.log10_a_T_error, other.correlation, differs
            )
        )
        difference, shifted = (other.shifts - chosen.shifts).ravel(), vertical != placement[1]
        if differs and np.linalg.norm(difference[:n]) > np.linalg.norm(apart[shifted][:n]):
            apart[shifted] = difference
    covariance = chosen.joint_covariance + sum(np.outer(one, one) for one in apart.values())
    return replace(
        chosen,
        joint_covariance=covariance,
        log10_a_T_error=_standard_errors(covariance[:n, :n]),
        log10_b_T_error=_standard_errors(covariance[n:, n:]),
        variants=tuple(variants),
    )


def _differs_beyond_chance(
    chosen: Superposition, placement: Placement, other: Superposition, other_placement: Placement
) -> bool:
    """True if two placements differ in log10 a_T by more than the less efficient of them may."""
    (by, vertical), (other_by, other_vertical) = placement, other_placement
    nested = set(MODULI[other_by]) <= set(MODULI[by]) and other_vertical >= vertical
    contains = set(MODULI[by]) <= set(MODULI[other_by]) and vertical >= other_vertical
    covariance = other.covariance if nested else chosen.covariance if contains else other.covariance + chosen.covariance
    apart = other.log10_a_T - chosen.log10_a_T
    values, vectors = np.linalg.eigh(covariance)
    known = values > RANK_TOLERANCE * values[-1]
    statistic = float(np.sum((vectors.T @ apart)[known] ** 2 / values[known]))
    return statistic > _chi2_limit(int(np.count_nonzero(known)))


def _phase_slope(sheets: list[LogIsotherm], log10_a_T: FloatArray) -> PhaseSlope | None:
    """Slope of ln E'' over measured frequency at one reduced frequency; None with fewer than three isotherms.

    In the overlap of two neighbours the colder one was measured log10 a_T apart, at the lower frequency.
    """
    if len(sheets) < LEAST_ISOTHERMS:
        return None
    apart = -np.diff(log10_a_T)
    differences = [
        float(np.nanmean(modulus_differences(cold, hot, np.array([step]))[1, 0]))
        for (cold, hot), step in zip(pairwise(sheets), apart.tolist(), strict=True)
    ]
    offsets, squares = np.array(differences), float(apart @ apart)
    slope = -float(apart @ offsets) / squares
    left = offsets + slope * apart
    return PhaseSlope(slope, float(np.sqrt(left @ left / (apart.size - 1) / squares)))


def _needed_vertical(
    chosen: Superposition,
    sheets: list[LogIsotherm],
    placed: tuple[tuple[int, ...], JointMinimum],
    other: Superposition | None,
) -> Superposition | None:
    """Superposition with vertical shifts if the isotherms need it: score test, size, and one curve by it."""
    if other is None:
        return None
    moduli, minimum = placed
    steps = -np.diff(minimum.shift)
    score = JointShift(sheets, moduli=moduli, vertical=True).score(
        np.concatenate([steps, np.zeros_like(steps)]), minimum.residual
    )
    chance = 2.0 / np.sqrt(chosen.frequency.size)
    needed = (
        score >= _chi2_limit(steps.size)
        and np.ptp(other.log10_b_T) >= LEAST_VERTICAL
        # else the slopes hardly separate one shift from the other
        and np.max(np.abs(np.diff(other.log10_a_T - chosen.log10_a_T))) <= LONGEST_STEP
        and other.correlation <= max(chance, 0.5 * chosen.correlation)
    )
    return other if needed else None


def _chi2_limit(freedom: int) -> float:
    """99.9 % quantile of chi squared: Wilson and Hilferty, PNAS 17 (1931) 684-688."""
    step = 2.0 / (9.0 * freedom)
    return float(freedom * (1.0 - step + NORMAL_QUANTILE_999 * np.sqrt(step)) ** 3)


def _place_isotherms(sheets: list[LogIsotherm], moduli: tuple[int, ...], *, vertical: bool) -> JointMinimum:
    joint = JointShift(sheets, moduli=moduli, vertical=vertical)
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
    shift, offset = placed.shift, placed.offset
    size = t.size
    a, from_a = _zero_at_reference(t, shift, t_ref)
    b, from_b = _zero_at_reference(t, offset, t_ref)
    from_both = np.block([[from_a, np.zeros((size, size))], [np.zeros((size, size)), from_b / LN10]])
    covariance = from_both @ placed.covariance @ from_both.T
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
        log10_b_T=b / LN10,
        log10_b_T_error=_standard_errors(covariance[size:, size:]),
        joint_covariance=covariance,
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


def _zero_at_reference(t: FloatArray, value: FloatArray, t_ref: float) -> tuple[FloatArray, FloatArray]:
    """Values less the interpolated one at the reference, and their derivative by the values."""
    from scipy.interpolate import PchipInterpolator

    at = np.flatnonzero(t == t_ref)
    if at.size:
        weights = np.eye(t.size)[at[0]]
    else:
        moved = value + DIFFERENCE_STEP * np.vstack([np.eye(t.size), -np.eye(t.size)])
        at_reference = PchipInterpolator(t, moved, axis=1)(t_ref)
        weights = (at_reference[: t.size] - at_reference[t.size :]) / (2.0 * DIFFERENCE_STEP)
    level = float(PchipInterpolator(t, value)(t_ref))
    return value - level, np.eye(t.size) - weights


def _standard_errors(covariance: FloatArray) -> FloatArray:
    """Standard deviations of a covariance; that of the reference is 0 up to rounding of either sign."""
    return np.sqrt(np.maximum(np.diagonal(covariance), 0.0))
