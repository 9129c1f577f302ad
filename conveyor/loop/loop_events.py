"""Everything the belt meets round the loop, under empty belt and what the bulk adds, by section."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from conveyor.loop.balance import Balance
from conveyor.loop.reach_shares import reach_shares

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LoopEvents:
    """Runs, point forces, pulleys and drives round the loop from the head, in order; shape (e,).

    Forces, their certain parts [N] and masses [kg] with the section empty, and the addition of its bulk; `section` is
    -1 for none. `stretches` and `drives` are indices of every stretch, shape (2n,), and drive; `held` the place behind
    the take-up, `spots` the place before every spot. `ends` is the place behind every stretch and what acts on a part
    of it, whose middle is `ahead` of the stretch's lengths before its end, shape (2n,). `hoppers` is what the bulk adds
    more when they are filled and when they are empty [N], shape (2, e).
    """

    force: Array
    certain: Array
    mass: Array
    more_force: Array
    more_certain: Array
    more_mass: Array
    hoppers: Array
    section: NDArray[np.int_]
    stretches: NDArray[np.int_]
    ends: NDArray[np.int_]
    ahead: Array
    drives: NDArray[np.int_]
    held: int
    spots: tuple[int, ...]

    def by_section(self, values: Array, count: int) -> Array:
        """Sum values by section, shape (n,)."""
        held = self.section >= 0
        return np.bincount(self.section[held], weights=values[held], minlength=count).astype(float)


_EventRow = tuple[float, float, float, float, float, float, int]
"""Force, its certain part and mass of the empty belt, the bulk's addition to each, and its section."""


def loop_events(full: Balance, empty: Balance) -> LoopEvents:
    """Events round the loop from the head, in running direction."""
    line, layout, count = full.line, full.layout, full.line.count
    rows: list[_EventRow] = []
    stretches, ends = list[int](), list[int]()
    outlets = _outlet_events(full)
    drives = np.zeros(len(line.drives), dtype=int)
    held, spots = 0, list[int]()
    standing = iter(list(enumerate(layout.spots)))
    following = next(standing, None)
    for boundary, (bare, laden) in enumerate(
        zip([*_stretch_events(empty), None], [*_stretch_events(full), None], strict=True)
    ):
        while following is not None and following[1].boundary == boundary:
            j = following[0]
            spots.append(len(rows))
            rows += _point_events(full, empty, j)
            for d in layout.drives[j]:
                drives[d] = len(rows)
                rows.append((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1))
            if j == layout.anchor:
                held = len(rows)
            following = next(standing, None)
        if bare is not None and laden is not None:
            stretches.append(len(rows))
            if boundary < count:
                rows.append((*laden, 0.0, 0.0, 0.0, -1))
            else:
                more = (laden[0] - bare[0], laden[1] - bare[1], laden[2] - bare[2])
                rows.append((*bare, *more, boundary - count))
            if boundary in outlets:
                rows.append(outlets[boundary].row)
            ends.append(len(rows))
    if layout.anchor is None:
        held = (
            int(drives[layout.station[-1]]) + 1 if full.equilibrium.take_up.behind else int(drives[layout.station[0]])
        )
    columns = list(zip(*rows, strict=True))
    values = [np.array(column, dtype=float) for column in columns[:-1]]
    force, certain, mass, more_force, more_certain, more_mass = values
    hoppers, ahead = _outlet_columns(outlets, ends, len(rows))
    return LoopEvents(
        force, certain, mass, more_force, more_certain, more_mass, hoppers,
        section=np.array(columns[-1]), stretches=np.array(stretches), ends=np.array(ends),
        ahead=ahead, drives=drives, held=held, spots=tuple(spots),
    )  # fmt: skip


class _OutletEvent(NamedTuple):
    """Pull of a hopper on a stretch in flow, what it changes filled and empty [N], where its middle is."""

    row: _EventRow
    changes: Array
    ahead: float


def _outlet_events(full: Balance) -> dict[int, _OutletEvent]:
    """Pull of the hoppers on every stretch under one, by its number in loop order."""
    line, pulls, found = full.line, full.layout.standing.pulls, dict[int, _OutletEvent]()
    for point in line.loading:
        if (hopper := point.loaded_hopper) is not None:
            spread = reach_shares(line.loop, point.spot, hopper.length)
            for k in np.flatnonzero(spread.shares).tolist():
                row = (0.0, 0.0, 0.0, float(pulls[0, k]), 0.0, 0.0, point.comes_with)
                found[k] = _OutletEvent(row, pulls[1:, k], float(spread.ahead[k]))
    return found


def _outlet_columns(outlets: Mapping[int, _OutletEvent], ends: Sequence[int], size: int) -> tuple[Array, Array]:
    """Change of force at every event by hoppers filled and empty [N], shape (2, e), and `ahead`, shape (2n,)."""
    hoppers, ahead = np.zeros((2, size)), np.full(len(ends), 0.5)
    for k, outlet in outlets.items():
        hoppers[:, ends[k] - 1], ahead[k] = outlet.changes, outlet.ahead
    return hoppers, ahead


def _stretch_events(balance: Balance) -> list[tuple[float, float, float] | None]:
    """Force, its certain part and mass of every stretch, in loop order."""
    count = balance.line.count
    force, certain = np.zeros(2 * count), np.zeros(2 * count)
    for each in balance.along:
        force += each.newtons
        if each.certain:
            certain += each.newtons
    both = (np.roll(force, count), np.roll(certain, count), balance.line.loop.mass)
    return list(zip(*(column.tolist() for column in both), strict=True))


def _point_events(full: Balance, empty: Balance, j: int) -> Iterator[_EventRow]:
    """Forces at a spot: of bulk with its section, of the length coefficient by section, and the rest."""
    layout = full.layout
    spot = layout.spots[j]
    always = math.fsum(
        force for bend, force in zip(layout.bends, full.equilibrium.bends, strict=True) if bend.pulley.spot == spot
    )
    for force in full.equilibrium.points:
        if force.spot != spot or force.reach > 0.0:
            continue
        if force.key == "secondary_by_length":
            yield from _length_coefficient_events(full, empty, force.total)
        elif force.bulk is not None:
            certain = force.total if force.certain else 0.0
            yield (0.0, 0.0, 0.0, force.total, certain, 0.0, force.bulk)
        else:
            always += force.total
    yield (always, 0.0, 0.0, 0.0, 0.0, 0.0, -1)


def _length_coefficient_events(full: Balance, empty: Balance, total: float) -> Iterator[_EventRow]:
    """Secondary resistance by section, in proportion to the main one."""
    laden, bare = (
        np.array([force.newtons for force in balance.along if force.kind == "main"]).sum(axis=0)
        for balance in (full, empty)
    )
    share = total / float(laden.sum())
    yield (share * float(bare.sum()), 0.0, 0.0, 0.0, 0.0, 0.0, -1)
    for i, more in enumerate((laden - bare)[: full.line.count].tolist()):
        yield (0.0, 0.0, 0.0, share * more, 0.0, 0.0, i)
