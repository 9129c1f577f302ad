"""Horizontal curves in every state of motion: drift of the belt, radii that hold it, tension of its edges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from conveyor.laws.horizontal_curve import half_span
from conveyor.line.curve_sets import CurveSets
from conveyor.line.line import Line
from conveyor.line.stretches import Strand, Stretch
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import trough_of_stretch
from conveyor.loop.belt_limits import StripLimits, strip_limits
from conveyor.loop.tension_coupling import downward_push, inward_pull
from conveyor.loop.tensions import MotionState


@dataclass(frozen=True)
class DriftState:
    """A horizontal curve in a state of motion.

    Attributes
    ----------
    state : str
        State of motion.
    lowest, highest : float
        Tensions in the curve [N].
    inside, outside : float
        Drift at the highest tension with the least guiding friction, and at the lowest with the full one (on flat sets
        with the worse of both, at the end of the curve), the wind to the same side [m]. Negative outward, infinite
        where the belt runs off its rolls.
    least, most : float
        Range of radii at which the belt stays on its rolls [m]; `least` infinite where none is large enough, `most`
        where none is too large.
    """

    state: str
    lowest: float
    highest: float
    inside: float
    outside: float
    least: float
    most: float


@dataclass(frozen=True)
class HorizontalCurveCheck:
    """A horizontal curve on one strand.

    Attributes
    ----------
    section, strand : str
        Section and strand.
    turn : CurveSets
        Curve and its sets.
    states : tuple of DriftState
        Drift in every state of motion.
    overstress, buckling : float or None
        Least radii at which the outer edge is not overstressed, the inner one not slack [m]; infinite where none helps,
        None where stiffness or strength are unknown.
    most, least : float or None
        Highest tension of the outer edge, lowest of the inner one, over all states [N/m].
    """

    section: str
    strand: Strand
    turn: CurveSets
    states: tuple[DriftState, ...]
    overstress: float | None = None
    buckling: float | None = None
    most: float | None = None
    least: float | None = None

    @property
    def kind(self) -> str:
        """Kind of curve for reports."""
        return "horizontal"

    @property
    def radius(self) -> float:
        """Radius of the spec [m]."""
        return self.turn.radius

    @property
    def farthest_in(self) -> DriftState:
        """State of the largest inward drift."""
        return max(self.states, key=lambda state: (state.inside, state.least))

    @property
    def farthest_out(self) -> DriftState:
        """State of the largest outward drift."""
        return min(self.states, key=lambda state: (state.outside, state.most))


def horizontal_curve_checks(balance: Balance, states: Sequence[MotionState]) -> tuple[HorizontalCurveCheck, ...]:
    """Check every horizontal curve on both strands in every state, carry strand first.

    Parameters
    ----------
    balance : Balance
        The conveyor.
    states : sequence of MotionState
        Its states of motion.
    """
    line, half, made = balance.line, balance.line.count, []
    for strand in (range(half, 2 * half), range(half)):
        before: HorizontalCurveCheck | None = None
        for i in strand:
            before = _curve_check(line, line.loop.stretches[i], i, states, before)
            made.append(before)
    return tuple(check for check in made if check is not None)


def _curve_check(
    line: Line, stretch: Stretch, i: int, states: Sequence[MotionState], before: HorizontalCurveCheck | None
) -> HorizontalCurveCheck | None:
    if stretch.turn is None:
        return None
    entries = _entry_drifts(stretch.turn, before, len(states))
    made = tuple(
        _drift_state(line, stretch, stretch.turn, state, i, entry=entry)
        for state, entry in zip(states, entries, strict=True)
    )
    lowest, highest = min(state.lowest for state in made), max(state.highest for state in made)
    edges = _edge_limits(line, stretch, stretch.turn, lowest, highest)
    return HorizontalCurveCheck(stretch.section, stretch.strand, stretch.turn, made, *edges)


def _entry_drifts(turn: CurveSets, before: HorizontalCurveCheck | None, states: int) -> Sequence[tuple[float, float]]:
    """Inward and outward drift at the start of a curve: on flat sets that at the end of the curve just before."""
    if before is None or not turn.flat:
        return [(0.0, 0.0)] * states
    if before.turn.side == turn.side:
        return [(state.inside, state.outside) for state in before.states]
    return [(-state.outside, -state.inside) for state in before.states]


def _drift_state(
    line: Line, stretch: Stretch, turn: CurveSets, state: MotionState, i: int, *, entry: tuple[float, float]
) -> DriftState:
    ends = float(state.starts[i]), float(state.ends[i])
    lowest, highest = min(ends), max(ends)
    tight = [turn.law(downward_push(line, stretch, highest), least=least) for least in (True, False)]
    loose = [turn.law(downward_push(line, stretch, lowest), least=least) for least in (True, False)]
    if not turn.flat:  # a trough holds less with less friction to the inside, to the outside more
        tight, loose = tight[:1], loose[1:]
    drawn, slack = inward_pull(line, stretch, highest), inward_pull(line, stretch, lowest)
    came_in, came_out = entry
    off_in, off_out = math.isinf(came_in), math.isinf(came_out)  # it ran off its rolls in the curve before
    return DriftState(
        state=state.name,
        lowest=lowest,
        highest=highest,
        inside=came_in if off_in else came_in + max(law.drift(drawn + turn.wind) for law in tight),
        outside=came_out if off_out else came_out + min(law.drift(slack - turn.wind) for law in loose),
        least=math.inf
        if off_in
        else _radius_at_pull(turn.radius, drawn, min(law.force(turn.room - came_in) for law in tight) - turn.wind),
        most=0.0
        if off_out
        else _radius_at_pull(turn.radius, slack, max(law.force(-turn.room - came_out) for law in loose) + turn.wind),
    )


def _radius_at_pull(radius: float, pull: float, held: float) -> float:
    """Radius at which a pull, proportional to 1/R, equals the holding force; infinite without one."""
    return math.inf if held <= 0.0 else radius * max(0.0, pull) / held


def _edge_limits(line: Line, stretch: Stretch, turn: CurveSets, lowest: float, highest: float) -> StripLimits:
    """Least radii for outer and inner edge, and their tensions, with the strain of a vertical curve."""
    width, stiffness = line.belt.width, line.belt.tensile_stiffness or 0.0
    across = half_span(
        width,
        middle_roll_length=stretch.idlers.middle_belt(width),
        trough_angle=stretch.trough_angle,
        inner_wing=stretch.idlers.inner_wing,
    )
    upright = stiffness * trough_of_stretch(stretch, width).edge_above / turn.vertical
    return strip_limits(
        line, lowest / width + upright, highest / width + upright, radius=turn.radius, stretched=across,
        slackened=across,
    )  # fmt: skip
