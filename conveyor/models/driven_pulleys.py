"""Pulleys of a route that drives turn."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from conveyor.models.drive import Drive
from conveyor.models.loop_parts import Pulley
from conveyor.units import si

_LEAST_DRIVEN_WRAP: Final = math.radians(90.0)
"""Least wrap of a driven pulley [rad]; general knowledge."""
_MOST_DRIVEN_WRAP: Final = math.radians(270.0)
"""Largest wrap of one driven pulley [rad], a larger one counts as several pulleys; general knowledge."""


class DrivenPulley(NamedTuple):
    """Number of a pulley of the route, that of the drive that turns it, and its share of the drive's wrap [rad]."""

    pulley: int
    drive: int
    wrap: float


def driven_pulleys(drive: Drive, pulleys: Sequence[Pulley]) -> Iterator[DrivenPulley]:
    """Driven pulleys: at each drive's place the most wrapped, as many as its wrap needs, in the order listed."""
    for place in dict.fromkeys((one.position, one.section) for one in drive.pulleys):
        here = [k for k, one in enumerate(drive.pulleys) if (one.position, one.section) == place]
        shares = {k: _shared_wrap(si(drive.pulleys[k].wrap_angle)) for k in here}
        turning = [k for k, (count, _) in shares.items() for _ in range(count)]
        beside = [
            (-pulley.wrap_or_half_turn, -si(pulley.diameter), i)
            for i, pulley in enumerate(pulleys)
            if (pulley.position, pulley.section) == place and pulley.wrap_or_half_turn >= _LEAST_DRIVEN_WRAP
        ]
        driven = sorted(i for _, _, i in sorted(beside)[: len(turning)])
        for i, k in zip(driven, here if len(driven) == len(here) else turning, strict=False):
            yield DrivenPulley(i, k, shares[k][1])


def missing_driven_pulleys(drive: Drive, pulleys: Sequence[Pulley]) -> Iterator[tuple[str, int, int]]:
    """Places at which pulleys are listed, but fewer than the drives there turn: place, listed, needed."""
    listed = [one.pulley for one in driven_pulleys(drive, pulleys)]
    for position, section in dict.fromkeys((one.position, one.section) for one in drive.pulleys):
        turned = [one for one in drive.pulleys if (one.position, one.section) == (position, section)]
        needed = sum(_shared_wrap(si(one.wrap_angle))[0] for one in turned)
        found = sum((pulleys[i].position, pulleys[i].section) == (position, section) for i in listed)
        if 0 < found < needed:
            yield position if section is None else f"{position}, {section}", found, needed


def _shared_wrap(wrap: float) -> tuple[int, float]:
    """Number of pulleys that a drive's wrap [rad] needs, and the wrap of each [rad]."""
    count = math.ceil(wrap / _MOST_DRIVEN_WRAP)
    return count, wrap / count
