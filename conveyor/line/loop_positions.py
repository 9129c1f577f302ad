"""Positions in the loop of the belt; at one boundary the belt meets items in the order of `BoundaryOrder`.

Boundaries between stretches are counted in running direction from the head: the n stretches of the return strand first,
the tail is boundary n, then the n of the carry strand; boundary 2n is the head again.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from conveyor.models import Conveyor, DrivePulley, TakeUp

_END_POSITIONS = frozenset({"head", "tail"})


class BoundaryOrder(IntEnum):
    """Order of items at one boundary: end of the strand, head or tail, start of the next strand."""

    END = 0
    """Pulleys and ploughs behind a section."""
    END_DRIVE = 1
    END_BEHIND = 2
    """A take-up behind it."""
    TURN = 3
    """Pulleys of head or tail, ploughs before the head."""
    TURN_DRIVE = 4
    TURN_BEHIND = 5
    """Snubs and cleaners behind the head; the take-up behind head or tail."""
    LANDING = 6
    """Bulk that lands on the next section, and its skirts."""


@dataclass(frozen=True, order=True)
class LoopPosition:
    """A position in the loop: boundary and order there; sorts in the direction of running."""

    boundary: int
    stand: BoundaryOrder


class LoopPositions:
    """Positions in the loop by the names of the spec."""

    def __init__(self, conveyor: Conveyor) -> None:
        self.count = len(conveyor.route.sections)
        self._names = [section.name for section in conveyor.route.sections]
        self._index = {name: i for i, name in enumerate(self._names)}
        self._drive = conveyor.drive

    def boundary(self, position: str, section: str | None) -> int:
        """Boundary of a position; the head is the end of the carry strand."""
        if position == "head":
            return 2 * self.count
        if position == "tail" or section is None:
            return self.count
        index = self._index[section]
        return self.count + index + 1 if position == "carry" else self.count - index

    def landing(self, section: str | None) -> LoopPosition:
        """Position where bulk lands on a section, behind all other items at its tail end."""
        return LoopPosition(self.count + (0 if section is None else self._index[section]), BoundaryOrder.LANDING)

    def name(self, landing: LoopPosition) -> str:
        """Name of a landing position for reports."""
        section = landing.boundary - self.count
        return "tail" if section == 0 else f"tail end of {self._names[section]}"

    def before(self, position: str, section: str | None) -> LoopPosition:
        """Position before the drives at a place."""
        stand = BoundaryOrder.TURN if position in _END_POSITIONS else BoundaryOrder.END
        return LoopPosition(self.boundary(position, section), stand)

    def drive(self, pulley: DrivePulley) -> LoopPosition:
        """Position of a drive."""
        stand = BoundaryOrder.TURN_DRIVE if pulley.position in _END_POSITIONS else BoundaryOrder.END_DRIVE
        return LoopPosition(self.boundary(pulley.position, pulley.section), stand)

    def behind(self, position: str, section: str | None) -> LoopPosition:
        """Position behind the drives at a place; behind the head the loop begins."""
        if position == "head":
            return LoopPosition(0, BoundaryOrder.TURN_BEHIND)
        stand = BoundaryOrder.TURN_BEHIND if position == "tail" else BoundaryOrder.END_BEHIND
        return LoopPosition(self.boundary(position, section), stand)

    def take_up(self, take_up: TakeUp | None) -> LoopPosition:
        """Position of the take-up's pulleys, by default behind the first drive."""
        if take_up is None or take_up.position == "drive":
            return self.behind(self._drive.position, self._drive.section)
        return self.behind(take_up.position, take_up.section)
