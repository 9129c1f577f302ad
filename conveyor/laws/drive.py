"""Several drives on one belt: who pulls how much, and the tension that lets every one of them grip.

Sources: Eytelwein (grip of each pulley); DIN 22101, ISO 5048 (all conditions have to be met at once).
The tension round the loop is known but for one constant: T(s) = T_ref + ΔT(s), with ΔT from resistances and drives.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from conveyor.laws.tension import grip_ratio, grip_tension
from conveyor.require import require, require_finite, require_not_negative, require_positive


@dataclass(frozen=True, slots=True)
class LoopTension:
    """Tension at the reference point of the loop.

    Parameters
    ----------
    tension : float
        T_ref [N].
    governed_by : str
        Condition that asks for it.
    """

    tension: float
    governed_by: str


def slack_side_offset(drive_force: float, *, run_on_offset: float) -> float:
    """Offset of the slack side of a drive pulley: behind it when it pulls, before it when it brakes.

    Parameters
    ----------
    drive_force : float
        F of this pulley on the belt [N], negative when it brakes.
    run_on_offset : float
        ΔT where the belt runs onto the pulley, over the reference point [N], of either sign.

    Returns
    -------
    float
        ΔT of the slack side [N].

    Raises
    ------
    InputError
        An argument is not finite.

    Examples
    --------
    >>> slack_side_offset(30e3, run_on_offset=50e3), slack_side_offset(-30e3, run_on_offset=50e3)
    (20000.0, 50000.0)
    """
    require_finite(drive_force=drive_force, run_on_offset=run_on_offset)
    return run_on_offset - max(drive_force, 0.0)


def loop_tension(minima: Mapping[str, tuple[float, float]]) -> LoopTension:
    """Least tension at the reference point that meets every condition, T_ref = max(T_min,i - ΔT_i).

    Parameters
    ----------
    minima : mapping of str to (float, float)
        For each condition the least tension T_min it asks for [N], at least 0, and the offset ΔT of its place
        over the reference point [N]: `grip_tension` at `slack_side_offset` for a drive, in steady operation and
        at the start; `sag_tension` at the slackest place of a section.

    Returns
    -------
    LoopTension
        T_ref [N] and the condition that governs, of equals the first. T_ref may be negative if every condition
        lies at a place of higher tension: add one at the slackest place of the loop.

    Raises
    ------
    InputError
        There is no condition, a tension is negative, or a number is not finite.

    Examples
    --------
    >>> loop_tension({"grip head": (8e3, 0.0), "grip tail": (5e3, 2e3), "sag return": (6e3, -4e3)})
    LoopTension(tension=10000.0, governed_by='sag return')
    """
    require(len(minima) > 0, "minima", dict(minima), "at least one condition is needed")
    for name, (least, offset) in minima.items():
        require_not_negative(**{name: least})
        require_finite(**{name: offset})
    governed_by = max(minima, key=lambda name: minima[name][0] - minima[name][1])
    least, offset = minima[governed_by]
    return LoopTension(tension=least - offset, governed_by=governed_by)


def tandem_slack(
    forces: Sequence[float], *, frictions: Sequence[float], wrap_angles: Sequence[float]
) -> tuple[int, float]:
    """Least tension behind pulleys in a row, T ≥ F_i/(e^(μ_i α_i) - 1) - Σ_{j>i} F_j for each (Eytelwein).

    Parameters
    ----------
    forces : sequence of float
        |F| of each pulley in the order from the tight to the slack side [N], at least 0.
    frictions : sequence of float
        μ of each [-], above 0, at most 2.
    wrap_angles : sequence of float
        α of each [rad], above 0, at most 8 pi.

    Returns
    -------
    index : int
        Pulley that governs, counted from 0.
    tension : float
        T on the slack side of the last pulley [N], at least 0.

    Raises
    ------
    InputError
        An argument is outside its range, or the lengths differ.

    Notes
    -----
    Shared forces are those of the motors: equal slip curves share in proportion to rated power.

    Examples
    --------
    >>> index, slack = tandem_slack([60e3, 30e3], frictions=[0.3, 0.3], wrap_angles=[math.pi, math.pi])
    >>> index, round(slack)
    (1, 19153)
    """
    require(len(forces) > 0, "forces", list(forces), "at least one pulley is needed")
    for name, values in (("frictions", frictions), ("wrap_angles", wrap_angles)):
        require(
            len(values) == len(forces), name, list(values), f"one for each of {len(forces)} pulleys is needed"
        )
    behind = 0.0
    best = (len(forces) - 1, 0.0)
    for i in reversed(range(len(forces))):
        require_not_negative(forces=forces[i])
        needed = grip_tension(forces[i], friction=frictions[i], wrap_angle=wrap_angles[i]) - behind
        if needed > best[1]:
            best = (i, needed)
        behind += forces[i]
    return best


def full_grip_shares(*, frictions: Sequence[float], wrap_angles: Sequence[float]) -> tuple[float, ...]:
    """Shares at which pulleys in a row reach their grip together, F_i ∝ (e^(μ_i α_i) - 1) Π_{j>i} e^(μ_j α_j).

    Parameters
    ----------
    frictions : sequence of float
        μ of each pulley in the order from the tight to the slack side [-], above 0, at most 2.
    wrap_angles : sequence of float
        α of each [rad], above 0, at most 8 pi.

    Returns
    -------
    tuple of float
        Share of each pulley in the whole force [-], sum 1; the row then grips like one pulley of the summed μ α.

    Raises
    ------
    InputError
        An argument is outside its range, or the lengths differ.

    Notes
    -----
    From Eytelwein's T1/T2 pulley by pulley. Motors come in equal sizes, so the practical shares 1:1 or 2:1 lie
    beside the best and need more tension, see `tandem_slack`.

    Examples
    --------
    >>> shares = full_grip_shares(frictions=[0.3, 0.3], wrap_angles=[math.pi, math.pi])
    >>> [round(share, 3) for share in shares]
    [0.72, 0.28]
    """
    require(len(frictions) > 0, "frictions", list(frictions), "at least one pulley is needed")
    ok = len(wrap_angles) == len(frictions)
    require(ok, "wrap_angles", list(wrap_angles), f"one for each of {len(frictions)} pulleys is needed")
    behind = 1.0
    shares: list[float] = []
    for friction, wrap_angle in zip(reversed(frictions), reversed(wrap_angles), strict=True):
        ratio = grip_ratio(friction, wrap_angle=wrap_angle)
        shares.append((ratio - 1.0) * behind)
        behind *= ratio
    return tuple(share / (behind - 1.0) for share in reversed(shares))


def used_wrap(drive_force: float, *, slack_tension: float, friction: float) -> float:
    """Angle of wrap a pulley really needs, α = ln(1 + |F|/T2)/μ (Eytelwein).

    Parameters
    ----------
    drive_force : float
        F of the pulley [N], of either sign.
    slack_tension : float
        T2 on its slack side [N], positive.
    friction : float
        μ [-], positive.

    Returns
    -------
    float
        α used [rad]; slip if it is more than the angle there is.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(math.degrees(used_wrap(13232.32, slack_tension=8447.96, friction=0.3)), 3)
    180.0
    """
    require_finite(drive_force=drive_force)
    require_positive(slack_tension=slack_tension, friction=friction)
    return math.log1p(abs(drive_force) / slack_tension) / friction
