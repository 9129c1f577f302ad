"""Weigh sections of a belt scale: where they stand, and what their alignment costs.

Source: general installation requirements for legal-for-trade scales in the instruction manual of the Siemens
Milltronics MMI (page 14), which are those of a maker for NIST Handbook 44; the error of alignment is derived.
"""

from __future__ import annotations

from typing import Final

from conveyor.arguments.limits import require, require_not_negative, require_positive
from conveyor.laws.idler_sets import raised_set_load

LEAST_SCALE_DISTANCE: Final = 6.096
"""From the nearest weigh idler to the end of the skirtboards or to the head, 20 ft [m]; at least 5 spacings."""
LEAST_CURVE_DISTANCE: Final = 12.192
"""From the scale to the tangent point of a curve, 40 ft [m]."""
SCALE_CONVEYOR_LENGTHS: Final = (12.0, 300.0)
"""Shortest and longest conveyor of a scale for trade [m]."""
_SPACINGS: Final = 5.0


def weigh_idler_distance(spacing: float) -> float:
    """Least distance of a weigh idler from the skirtboards or the head: 20 ft or 5 spacings (Siemens, 1c).

    Parameters
    ----------
    spacing : float
        Of the sets at the scale [m], positive.

    Returns
    -------
    float
        Distance [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Of a maker's scale for trade; other makers' rules differ.

    Examples
    --------
    >>> [weigh_idler_distance(spacing) for spacing in (1.0, 1.5)]
    [6.096, 7.5]
    """
    require_positive(spacing=spacing)
    return max(LEAST_SCALE_DISTANCE, _SPACINGS * spacing)


def alignment_error(tension: float, *, height: float, spacing: float, n_sets: int, bulk_force: float) -> float:
    """Weight that the belt's tension adds on weigh idlers out of line, over that of the bulk: 2 T d/a/(n a q).

    Parameters
    ----------
    tension : float
        T of the belt [N], at least 0.
    height : float
        d of the weigh idlers over their neighbours [m], at least 0.
    spacing : float
        a of the sets [m], positive.
    n_sets : int
        n weigh sets side by side [-], at least 1.
    bulk_force : float
        q, weight of the bulk per length as it presses on the sets [N/m], positive.

    Returns
    -------
    float
        Error [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Derived: n sets raised together bend the belt at the two spans beside them alone. A tension that does not change
    is taken out by setting the zero; what it changes by stays. The stiffness of the belt is left out.

    Examples
    --------
    >>> alignment_error(10e3, height=1e-3, spacing=1.0, n_sets=2, bulk_force=1000.0)
    0.01
    """
    require(n_sets >= 1, "n_sets", n_sets, ">= 1")
    require_not_negative(tension=tension, height=height)
    require_positive(spacing=spacing, bulk_force=bulk_force)
    return raised_set_load(tension, height=height, spacing=spacing) / (n_sets * spacing * bulk_force)
