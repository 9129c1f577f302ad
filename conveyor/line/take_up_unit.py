"""The take-up in SI."""

from __future__ import annotations

from dataclasses import dataclass

from conveyor.laws.take_up import LOOP_STRANDS, TRAVEL_RESERVE
from conveyor.line.bend_pulleys import BendPulley
from conveyor.line.loop_positions import LoopPosition, LoopPositions
from conveyor.line.optional_quantities import si_or_none
from conveyor.models import Conveyor
from conveyor.units import si


@dataclass(frozen=True)
class TakeUpUnit:
    """The take-up; `spot` is None on the slack side of the drives at the first one's position.

    `behind` then tells that side, behind or before the drives, under the spec's own load; None if not yet calculated.
    `tension` is its setting [N], None for the least needed; `reserve` of its travel [-]; mass of its `carriage` [kg];
    `winch`: speed [m/s], dead band of tension [-] and run-up [s] or None; available `travel` [m].
    """

    kind: str
    spot: LoopPosition | None
    tension: float | None
    reeving: float
    strands: int
    reserve: float
    carriage: float = 0.0
    winch: tuple[float, float, float | None] | None = None
    travel: float | None = None
    behind: bool | None = None

    @property
    def keeps_length(self) -> bool:
        """True if it fixes the belt's length, and so the mean tension of the loop, not the local tension."""
        return self.kind in {"fixed", "screw", "locked winch"}

    @property
    def on_slack_side(self) -> bool:
        """True if it fixes the tension on the slack side of the drives, whichever side that is."""
        return self.spot is None and not self.keeps_length

    def pulls(self, pulley: BendPulley) -> bool:
        """True for a pulley on its carriage, with the take-up's tension on both sides."""
        return pulley.position == "take-up" and not self.keeps_length


def take_up_unit(conveyor: Conveyor, places: LoopPositions) -> TakeUpUnit:
    """Take-up of a conveyor; on the slack side of the drives without one."""
    given = conveyor.route.take_up
    if given is None:
        return TakeUpUnit("slack side", None, None, 1.0, LOOP_STRANDS, TRAVEL_RESERVE.value)
    tension = si_or_none(given.tension)
    if given.mass is not None:
        # take_up_mass solved for the tension
        tension = si(given.mass) * given.reeving * si(conveyor.calculation.gravity) / given.strands
    spot = None if given.position == "drive" else places.take_up(given)
    winch = None
    if given.winch_speed is not None:
        winch = si(given.winch_speed), si(given.winch_band), si_or_none(given.winch_run_up)
    return TakeUpUnit(
        given.kind,
        spot,
        tension,
        given.reeving,
        given.strands,
        si(given.reserve),
        si(given.carriage_mass),
        winch,
        si_or_none(given.travel),
    )
