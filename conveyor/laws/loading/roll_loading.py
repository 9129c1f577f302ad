"""Load of every roll of a set from the line masses, and its distribution along the roll.

Source: VDI 2341 (shares of the rolls).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_angle, require_not_negative, require_positive

Array = NDArray[np.float64]
Shape = Literal["uniform", "triangular"]

MIDDLE_SHARE_FLAT: Final = 0.5  # VDI 2341: material share of the middle of 3 rolls at 0 deg
MIDDLE_SHARE_PER_DEGREE: Final = 0.005  # [1/deg], VDI 2341
MIDDLE_BELT_OVERHANG: Final = 0.02  # [m], VDI 2341: the middle roll carries a belt strip of l_M + 20 mm
SHARE_SUM_TOLERANCE: Final = 1e-9  # shares typed as decimals; anything coarser is a slip of the pen

_gauss = lru_cache(maxsize=64)(np.polynomial.legendre.leggauss)

_ROLE_NAMES: Final = {
    1: ("flat",),
    2: ("left", "right"),
    3: ("left wing", "middle", "right wing"),
    4: ("left wing", "left inner", "right inner", "right wing"),
    5: ("left outer wing", "left inner wing", "middle", "right inner wing", "right outer wing"),
}


def middle_share_bulk(trough_angle: float) -> float:
    """Share of the bulk's weight on the middle of three rolls, 0.5 + 0.005 λ[deg] (VDI 2341).

    Parameters
    ----------
    trough_angle : float
        λ [rad], from 0 to pi/3 (the line reaches 0.8 there).

    Returns
    -------
    float
        Share [-]. The two wings carry the rest in equal parts.

    Raises
    ------
    InputError
        The angle is outside its range.

    Notes
    -----
    Tabulated for 30, 35 and 45 deg: 0.65, 0.675, 0.725. A worked overland case takes 0.75 at 45 deg.

    Examples
    --------
    >>> round(middle_share_bulk(math.radians(35)), 6)
    0.675
    """
    require(0.0 <= trough_angle <= math.pi / 3.0, "trough_angle", trough_angle, ">= 0 and <= pi/3 rad")
    return MIDDLE_SHARE_FLAT + MIDDLE_SHARE_PER_DEGREE * math.degrees(trough_angle)


def middle_share_belt(middle_roll_length: float, *, belt_width: float) -> float:
    """Share of the belt's own weight on the middle of three rolls, (l_M + 20 mm)/B (VDI 2341).

    Parameters
    ----------
    middle_roll_length : float
        l_M [m], positive.
    belt_width : float
        B [m], at least l_M + 20 mm.

    Returns
    -------
    float
        Share [-].

    Raises
    ------
    InputError
        The belt is narrower than the strip on the middle roll.

    Examples
    --------
    >>> round(middle_share_belt(0.465, belt_width=1.2), 6)
    0.404167
    """
    require_positive(middle_roll_length=middle_roll_length)
    strip = middle_roll_length + MIDDLE_BELT_OVERHANG
    require(strip <= belt_width < math.inf, "belt_width", belt_width, f">= {strip:.4g} m")
    return strip / belt_width


@dataclass(frozen=True, slots=True)
class RollLoad:
    """Load of one roll and its distribution along the roll.

    The belt's part is uniform. The bulk's part is uniform, or triangular with its peak at the inner
    junction and zero at the outer edge of the loaded length.

    Parameters
    ----------
    name : str
        Place in the set: "flat"; "left", "right"; "left wing", "middle", "right wing"; …
    bulk_force : float
        Normal force from the bulk [N].
    belt_force : float
        Normal force from the belt's own weight [N].
    length : float
        Loaded length of the roll [m].
    shape : {"uniform", "triangular"}
        Distribution of the bulk's part.
    """

    name: str
    bulk_force: float
    belt_force: float
    length: float
    shape: Shape

    @property
    def force(self) -> float:
        """Normal force on the roll [N]."""
        return self.bulk_force + self.belt_force

    @property
    def peak_line_load(self) -> float:
        """Largest line load [N/m], at the inner junction of a wing."""
        peak = 2.0 if self.shape == "triangular" else 1.0
        return (peak * self.bulk_force + self.belt_force) / self.length

    def line_loads(self, n: int) -> tuple[Array, Array]:
        """Line load at the Gauss-Legendre points of the loaded length.

        Parameters
        ----------
        n : int
            Number of points [-], at least 1. The load itself is integrated exactly by one point; n is chosen
            for what is computed from it (indentation grows like w^(4/3)).

        Returns
        -------
        line_load : ndarray, shape (n,)
            w_i [N/m], from the inner junction outward.
        weights : ndarray, shape (n,)
            Weights [m]; their sum is the loaded length, and sum(w_i weights_i) the force.

        Raises
        ------
        InputError
            n is below 1.

        Examples
        --------
        >>> wing = RollLoad(name="left wing", bulk_force=90.0, belt_force=30.0, length=0.3, shape="triangular")
        >>> w, weights = wing.line_loads(2)
        >>> w.round(3).tolist(), round(float(w @ weights), 12)
        ([573.205, 226.795], 120.0)
        """
        line_load, weights = line_loads([self], n)
        return line_load[0], weights[0]


def line_loads(loads: Sequence[RollLoad], n: int) -> tuple[Array, Array]:
    """Line loads of many rolls, each at the Gauss-Legendre points of its loaded length.

    Parameters
    ----------
    loads : sequence of RollLoad
        Of the rolls [N].
    n : int
        Number of points [-], at least 1, as of `RollLoad.line_loads`.

    Returns
    -------
    line_load : ndarray, shape (rolls, n)
        w [N/m].
    weights : ndarray, shape (rolls, n)
        Weights [m].

    Raises
    ------
    InputError
        n is below 1.

    Examples
    --------
    >>> wing = RollLoad(name="left wing", bulk_force=90.0, belt_force=30.0, length=0.3, shape="triangular")
    >>> line_loads([wing], 2)[0].round(3).tolist()
    [[573.205, 226.795]]
    """
    require(n >= 1, "n", n, ">= 1")
    nodes, weights = _gauss(n)
    bulk, belt, length, slope = np.array([
        (load.bulk_force, load.belt_force, load.length, load.shape == "triangular") for load in loads
    ]).T[:, :, None]  # fmt: skip
    return (bulk * (1.0 - slope * nodes) + belt) / length, weights * (length / 2.0)


def _contact_lengths(n_rolls: int, roll_length: float, belt_width: float) -> tuple[float, ...]:
    """Length of each roll under the belt [m]: inner rolls whole, outer ones to the belt edge or roll end."""
    if n_rolls == 1:
        return (min(roll_length, belt_width),)
    inner = n_rolls - 2
    outer = min(roll_length, (belt_width - inner * roll_length) / 2.0)
    require(
        outer > 0.0,
        "roll_length",
        roll_length,
        f"< belt_width/{max(inner, 1)}, to reach the wings",
    )
    return (outer, *([roll_length] * inner), outer)


def _symmetric_shares(middle: float) -> tuple[float, float, float]:
    return ((1.0 - middle) / 2.0, middle, (1.0 - middle) / 2.0)


def _check_shares(name: str, shares: tuple[float, ...], n_rolls: int) -> tuple[float, ...]:
    require(len(shares) == n_rolls, name, shares, f"one share for each of the {n_rolls} rolls")
    require(all(0.0 <= share <= 1.0 for share in shares), name, shares, "shares >= 0 and <= 1")
    total = math.fsum(shares)
    require(abs(total - 1.0) <= SHARE_SUM_TOLERANCE, name, shares, f"shares whose sum is 1; it is {total:.12g}")
    return shares


def _bulk_shares(n_rolls: int, trough_angle: float, given: tuple[float, ...] | None) -> tuple[float, ...]:
    if given is not None:
        return _check_shares("bulk_shares", given, n_rolls)
    advice = f"{n_rolls} shares; a set of {n_rolls} rolls has no rule in VDI 2341"
    require(n_rolls not in {4, 5}, "bulk_shares", given, advice)
    if n_rolls == 3:
        return _symmetric_shares(middle_share_bulk(trough_angle))
    return (1.0 / n_rolls,) * n_rolls


def _belt_shares(
    n_rolls: int, lengths: tuple[float, ...], belt_width: float, given: tuple[float, ...] | None
) -> tuple[float, ...]:
    if given is not None:
        return _check_shares("belt_shares", given, n_rolls)
    if n_rolls == 3:
        return _symmetric_shares(middle_share_belt(lengths[1], belt_width=belt_width))
    return tuple(length / math.fsum(lengths) for length in lengths)


def roll_loads(
    *,
    bulk_line_mass: float,
    belt_line_mass: float,
    spacing: float,
    n_rolls: int,
    trough_angle: float,
    roll_length: float,
    belt_width: float,
    inclination: float,
    gravity: float,
    bulk_shares: tuple[float, ...] | None = None,
    belt_shares: tuple[float, ...] | None = None,
    outer_shape: Shape = "triangular",
) -> tuple[RollLoad, ...]:
    """Load of every roll of a set (VDI 2341), and its distribution along the roll.

    Parameters
    ----------
    bulk_line_mass : float
        m'_bulk [kg/m], at least 0.
    belt_line_mass : float
        m'_belt [kg/m], at least 0.
    spacing : float
        Distance of the sets, a [m], positive.
    n_rolls : int
        Rolls of a set [-]: 1 to 5, of equal length.
    trough_angle : float
        λ of the outer rolls [rad], from 0 to below pi/2; not used for 1 roll or given shares.
    roll_length : float
        l_M, shell length of each roll [m], positive.
    belt_width : float
        B [m], positive.
    inclination : float
        δ of the belt line [rad], between -pi/2 and pi/2.
    gravity : float
        g [m/s²], positive.
    bulk_shares : tuple of float, optional
        Share of each roll in the bulk's weight [-], from left to right, sum 1. Needed for 4 and 5 rolls; else
        VDI 2341: flat 1; two rolls 0.5 each; three rolls 0.5 + 0.005 λ[deg] on the middle one.
    belt_shares : tuple of float, optional
        The same for the belt's own weight [-]. Default: three rolls (l_M + 20 mm)/B on the middle one
        (VDI 2341), else in proportion to the lengths under the belt.
    outer_shape : {"triangular", "uniform"}
        Distribution of the bulk along the outer rolls of a set of two or more [-].

    Returns
    -------
    tuple of RollLoad
        From left to right. The forces add up to (m'_bulk + m'_belt) g cos δ a.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    The shares are shares of the normal load of the rolls, as VDI 2341 uses them: the load of an inclined
    wing roll is already the force normal to it and is not multiplied by cos λ again. The loaded length of an
    outer roll ends at the belt edge or at the roll end, whichever comes first; the gaps between the rolls are
    not counted. The bulk's part on an outer roll falls linearly from the junction to zero at the end of the
    loaded length unless `outer_shape` is uniform, on the other rolls it is uniform; so is the belt's part everywhere.

    Examples
    --------
    >>> loads = roll_loads(
    ...     bulk_line_mass=133.1,
    ...     belt_line_mass=16.44,
    ...     spacing=1.2,
    ...     n_rolls=3,
    ...     trough_angle=math.radians(35),
    ...     roll_length=0.465,
    ...     belt_width=1.2,
    ...     inclination=0.0,
    ...     gravity=9.81,
    ... )
    >>> [(r.name, round(r.force, 2)) for r in loads]
    [('left wing', 312.27), ('middle', 1135.84), ('right wing', 312.27)]
    """
    require(n_rolls in _ROLE_NAMES, "n_rolls", n_rolls, "1, 2, 3, 4, 5")
    known = outer_shape in {"triangular", "uniform"}
    require(known, "outer_shape", outer_shape, "triangular, uniform")
    require_not_negative(bulk_line_mass=bulk_line_mass, belt_line_mass=belt_line_mass)
    require_positive(spacing=spacing, roll_length=roll_length, belt_width=belt_width, gravity=gravity)
    require_angle(0.0, trough_angle=trough_angle)
    require_angle(-math.pi / 2.0, inclination=inclination)
    lengths = _contact_lengths(n_rolls, roll_length, belt_width)
    bulk = _bulk_shares(n_rolls, trough_angle, bulk_shares)
    belt = _belt_shares(n_rolls, lengths, belt_width, belt_shares)
    pull = gravity * math.cos(inclination) * spacing
    last = n_rolls - 1
    return tuple(
        RollLoad(
            name=name,
            bulk_force=bulk[i] * bulk_line_mass * pull,
            belt_force=belt[i] * belt_line_mass * pull,
            length=lengths[i],
            shape=outer_shape if n_rolls > 1 and i in {0, last} else "uniform",
        )
        for i, name in enumerate(_ROLE_NAMES[n_rolls])
    )
