"""Errors of a fit; scatter and correlation of data about a smooth curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from conveyor.arguments.arrays import FloatArray

MAD_TO_SIGMA = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation [-]."""
HAMPEL_BEND, HAMPEL_FALL, HAMPEL_OUT = 2.5, 4.0, 8.0
"""Robust standard deviations from which a residual pulls no harder, pulls less, and pulls no more [-]."""
LEAST_SCATTER = 0.005
"""Relative scatter taken at least: closer than this no instrument repeats a modulus, and what a curve or a series
leaves of exact data is no outlier (general knowledge) [-]."""
MOST_SPENT = 0.75
"""Parameters of a fit over its values from which what it leaves does not tell their scatter: it has halved that [-]."""


@dataclass(frozen=True)
class Misfit:
    """Relative errors, model over data minus one, of one quantity over all rows.

    Parameters
    ----------
    rms : float
        Root mean square relative error [-].
    worst : float
        Relative error largest in magnitude, with its sign [-].
    worst_frequency : float
        Cyclic frequency of that row [Hz].
    """

    rms: float
    worst: float
    worst_frequency: float


def relative_misfit(error: FloatArray, frequency: FloatArray) -> Misfit:
    """Root mean square and worst of relative errors.

    Examples
    --------
    >>> import numpy as np
    >>> relative_misfit(np.array([0.03, -0.04]), np.array([1.0, 10.0])).worst_frequency
    10.0
    """
    k = int(np.argmax(np.abs(error)))
    return Misfit(float(np.sqrt(np.mean(error**2))), float(error[k]), float(frequency[k]))


def hampel_weights(error: FloatArray) -> FloatArray:
    """Weights of residuals, 1 to 0, by Hampel's three-part loss.

    References
    ----------
    F. R. Hampel, E. M. Ronchetti, P. J. Rousseeuw, W. A. Stahel, Robust Statistics (1986), section 2.6.

    Examples
    --------
    >>> import numpy as np
    >>> hampel_weights(np.array([0.01, -0.01, 0.01, -0.01, 0.05, 1.0])).round(2)
    array([1.  , 1.  , 1.  , 1.  , 0.74, 0.  ])
    """
    size = np.abs(error) / max(MAD_TO_SIGMA * float(np.median(np.abs(error))), LEAST_SCATTER)
    pull = HAMPEL_BEND * np.clip((HAMPEL_OUT - size) / (HAMPEL_OUT - HAMPEL_FALL), 0.0, 1.0)
    return np.divide(pull, size, out=np.ones_like(size), where=size > HAMPEL_BEND)


def row_scatter(
    frequency: FloatArray, modulus: FloatArray, curve: FloatArray | None = None, spent: float = 0.0
) -> float | None:
    r"""Relative standard deviation of a row from the line through its neighbours [-]; None below three rows.

    Gasser, Sroka, Jennen-Steinmetz, Biometrika 73 (1986) 625-633: with
    ``eps_i = a y_{i-1} + b y_{i+1} - y_i`` (linear interpolation of y = ln modulus in x = ln frequency),
    ``sigma^2 = mean of eps_i^2/(a^2 + b^2 + 1)``.

    Parameters
    ----------
    frequency : numpy.ndarray
        Ascending, shape `(n,)` [Hz].
    modulus : numpy.ndarray
        At them, shape `(n,)` [Pa].
    curve : numpy.ndarray, optional
        A fit to these rows, at them, shape `(n,)` [Pa].
    spent : float
        Effective parameters of that fit over the values it was fitted to [-].

    Notes
    -----
    Curvature over three rows counts as noise: at six rows a decade some 0.2 % for a rubber, at one a decade 7 %. A
    fitted curve takes it out: y is ln modulus less ln curve, and sigma is divided by the square root of 1 - `spent`,
    which the fit has taken of it. Both ways hold the scatter and something beside it, curvature or misfit of the curve:
    the smaller one counts. What is smooth but wrong (two moduli that contradict each other) does not count: that is in
    the misfit only.

    Examples
    --------
    >>> import numpy as np
    >>> f = np.logspace(0, 4, 9)
    >>> row_scatter(f, 1e6 * f**0.1) < 1e-12
    True
    >>> bent = 1e6 * np.exp(0.01 * np.log(f) ** 2)
    >>> row_scatter(f, bent) > 0.01, row_scatter(f, bent, bent) < 1e-12
    (True, True)
    """
    return scatter_within(frequency, modulus, np.zeros(frequency.size), curve, spent)


def scatter_within(
    frequency: FloatArray, modulus: FloatArray, group: FloatArray, curve: FloatArray | None = None, spent: float = 0.0
) -> float | None:
    """Relative standard deviation of a row from the line through its neighbours in its own group [-].

    As `row_scatter` of each group of three rows and more, squares averaged over all; None without such a group.
    Differences between groups, isotherms on a master curve, do not count.

    Examples
    --------
    >>> import numpy as np
    >>> f, group = np.logspace(0, 4, 9), np.arange(9.0) % 2
    >>> moduli = 1e6 * f**0.1 * (1.0 + 0.1 * group)
    >>> row_scatter(f, moduli) > 0.05, scatter_within(f, moduli, group) < 1e-12
    (True, True)
    """
    bare = _root_mean_square(frequency, modulus, group)
    if curve is None or bare is None or spent > MOST_SPENT:
        return bare
    about = _root_mean_square(frequency, modulus / curve, group)
    return bare if about is None else min(bare, about / float(np.sqrt(1.0 - spent)))


def _root_mean_square(frequency: FloatArray, modulus: FloatArray, group: FloatArray) -> float | None:
    """Root mean square of the residuals of `row_scatter` in all groups of three rows and more."""
    squares = [
        _scatter_squares(frequency[rows], modulus[rows]) for rows in (group == each for each in np.unique(group))
    ]
    joined = np.concatenate(squares)
    return float(np.sqrt(np.mean(joined))) if joined.size else None


def _scatter_squares(frequency: FloatArray, modulus: FloatArray) -> FloatArray:
    """Squares of the residuals of `row_scatter`, shape `(n - 2,)`."""
    if frequency.size < 3:
        return np.zeros(0)
    x, y = np.log(frequency), np.log(modulus)
    width = x[2:] - x[:-2]
    a = np.divide(x[2:] - x[1:-1], width, out=np.full(width.size, 0.5), where=width > 0.0)
    b = 1.0 - a
    eps = a * y[:-2] + b * y[2:] - y[1:-1]
    return np.asarray(eps**2 / (a * a + b * b + 1.0))


def neighbour_correlation(error: FloatArray) -> float:
    """Correlation of each residual with the next in frequency [-]: 0 for noise, 1 for a misfit with a shape.

    Examples
    --------
    >>> import numpy as np
    >>> neighbour_correlation(np.array([1.0, -1.0, 1.0, -1.0]))
    -0.75
    """
    total = float(error @ error)
    return float(error[:-1] @ error[1:]) / total if total > 0.0 else 0.0
