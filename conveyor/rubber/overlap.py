"""Overlap of neighbouring isotherms: first guess of their shift, and their differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import InputError
from conveyor.rubber.shift import celsius_in_message

GUESS_STEP = 0.05
"""Grid of the first guess [decades]; the joint fit refines it."""
LEAST_OVERLAP = 0.1
"""Least share of the shorter isotherm in the overlap: ten rows are a ninth of it apart, with less nothing is
compared [-]."""
FIRST_OVERLAP = 0.25
"""The same for a first guess: with less, a chance crossing of two points wins [-]."""
END_ROWS = 3
"""Rows at the end of an isotherm from which its slope is taken."""


@dataclass(frozen=True, eq=False)
class LogIsotherm:
    """One isotherm in logarithms, by ascending frequency.

    Parameters
    ----------
    temperature : float
        Absolute temperature [K].
    x : numpy.ndarray
        log10 of the frequency in Hz, shape `(n,)` [decades].
    y : numpy.ndarray
        ln E' and ln E'' in Pa, shape `(2, n)` [-].
    """

    temperature: float
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class Overlap:
    """Two neighbouring isotherms on the master curve.

    Parameters
    ----------
    cold : float
        Temperature of the colder one [K].
    hot : float
        Temperature of the hotter one [K].
    decades : float
        Reduced frequencies that both cover [decades].
    held : bool
        Whether this is the least overlap allowed, a tenth of the shorter isotherm: the two have not one
        shape and would part, so their shift is a limit and no measurement, nor its uncertainty [-].
    storage : float
        Root mean square difference of ln E' in the overlap [-].
    loss : float
        Root mean square difference of ln E'' in the overlap [-].

    Notes
    -----
    Each row against the other isotherm, interpolated linearly in log-log: the noise of both, the curvature
    between rows, and what does not superpose.
    """

    cold: float
    hot: float
    decades: float
    held: bool
    storage: float
    loss: float


def modulus_differences(cold: LogIsotherm, hot: LogIsotherm, shift: FloatArray) -> FloatArray:
    """Cold less hot of ln E' and ln E'' at `m` shifts [decades], `(2, m, rows)`; NaN outside the overlap."""
    on_hot, on_cold = cold.x + shift[:, None], hot.x - shift[:, None]
    outside = {"left": np.nan, "right": np.nan}
    return np.array(
        [
            np.hstack(
                [
                    cold.y[k] - np.interp(on_hot, hot.x, hot.y[k], **outside),
                    np.interp(on_cold, cold.x, cold.y[k], **outside) - hot.y[k],
                ]
            )
            for k in (0, 1)
        ]
    )


def shift_limits(cold: LogIsotherm, hot: LogIsotherm, share: float = LEAST_OVERLAP) -> tuple[float, float]:
    """Least and largest shift [decades] at which a share of the shorter isotherm lies in the overlap."""
    least = share * min(float(np.ptp(cold.x)), float(np.ptp(hot.x)))
    return float(hot.x[0] - cold.x[-1]) + least, float(hot.x[-1] - cold.x[0]) - least


def first_guess(cold: LogIsotherm, hot: LogIsotherm, *, moduli: tuple[int, ...], vertical: bool) -> tuple[float, float]:
    """Shift [decades] and ln b_T [-] of the least mean square difference in the overlap, on a grid."""
    _check_common_modulus(cold, hot)
    nearest, farthest = shift_limits(cold, hot, FIRST_OVERLAP)
    nearest = min(max(0.0, nearest), farthest)
    grid = np.linspace(nearest, farthest, max(2, round((farthest - nearest) / GUESS_STEP)))
    error = modulus_differences(cold, hot, grid)[list(moduli)]
    known = np.isfinite(error)
    count = np.maximum(known.sum(axis=(0, 2)), 1)
    error = np.where(known, error, 0.0)
    offset = error.sum(axis=(0, 2)) / count if vertical else np.zeros(grid.size)
    square = np.sum(np.where(known, error - offset[:, None], 0.0) ** 2, axis=(0, 2)) / count
    square[~known.any(axis=(0, 2))] = np.inf
    best = int(np.argmin(square))
    return float(grid[best]), float(offset[best])


def measure_overlap(cold: LogIsotherm, hot: LogIsotherm, shift: float, offset: float, *, held: bool) -> Overlap:
    """Length and differences at a shift [decades] and offset of ln b_T; `held`: at a limit of `shift_limits`."""
    decades = min(cold.x[-1] + shift, hot.x[-1]) - max(cold.x[0] + shift, hot.x[0])
    error = modulus_differences(cold, hot, np.array([shift])) - offset
    rms = np.sqrt(np.nanmean(error[:, 0] ** 2, axis=1))
    return Overlap(cold.temperature, hot.temperature, float(decades), held, float(rms[0]), float(rms[1]))


def _check_common_modulus(cold: LogIsotherm, hot: LogIsotherm) -> None:
    """Refuse neighbours without a common E': where one ends the other has not begun."""
    for low, high in ((hot, cold), (cold, hot)):
        gap = float(high.y[0].min() - low.y[0].max())
        if gap > 0.0:
            up, down = np.argsort(low.y[0])[-END_ROWS:], np.argsort(high.y[0])[:END_ROWS]
            slopes = [abs(np.polyfit(s.x[i], s.y[0][i], 1)[0]) for s, i in ((low, up), (high, down))]
            slope = float(np.mean(slopes))
            raise _gap_error(cold, hot, gap / slope if slope > 0.0 else float("inf"))


def _gap_error(cold: LogIsotherm, hot: LogIsotherm, missing: float) -> InputError:
    return InputError(
        f"the isotherms at {celsius_in_message(cold.temperature)} and {celsius_in_message(hot.temperature)} do not "
        f"overlap: no E' is"
        f" common to both, about {missing:.2g} decades of frequency are missing between them; measure a"
        " temperature between, or a wider range of frequency"
    )
