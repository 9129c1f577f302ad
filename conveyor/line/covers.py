"""What the rolls of each strand run on: the cover's thickness and its rubber at the temperature and strain of work."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.indentation import RollContact
from conveyor.laws.softening import WorkingStrain, losing_load, softened_cover
from conveyor.line.line import Line
from conveyor.line.roll_kinds import RollKind
from conveyor.line.stretches import STRANDS, Strand
from conveyor.models import Conveyor, RubberCompound
from conveyor.rubber import PronySeries
from conveyor.rubber.anchor import Anchor
from conveyor.units import si

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Level:
    """The anchor of a cover's rubber at its temperature [K]."""

    anchor: Anchor
    temperature: float

    def factor(self, line_load: ArrayLike) -> Array:
        """Measured over calculated indentation at line loads w [N/m]."""
        return self.anchor.factor(line_load, self.temperature)


@dataclass(frozen=True, eq=False)
class RunningCover:
    """A cover that rolls run on: thickness [m], rubber at its temperature, Poisson's ratio.

    `strain` is what the rubber was softened for; None where it is that of the master curve. `level` is the factor that
    the compound's rolling-resistance tests put on its indentation; None where the theory stands alone.
    """

    thickness: float
    rubber: PronySeries
    poisson: float
    strain: WorkingStrain | None = None
    level: Level | None = None

    def like(self, other: RunningCover) -> bool:
        """Whether it is as thick and of the very same rubber."""
        mine, theirs = (
            (self.thickness, self.poisson, self.level),
            (other.thickness, other.poisson, other.level),
        )
        return self.rubber is other.rubber and mine == theirs


Covers = Mapping[Strand, RunningCover]
"""The cover under each strand."""


def compounds_by_strand(conveyor: Conveyor) -> dict[Strand, RubberCompound]:
    """Rubber that the rolls of each strand run on."""
    return {"carry": conveyor.carry_compound, "return": conveyor.return_compound}


def rubbers(conveyor: Conveyor, temperature: float) -> dict[Strand, PronySeries]:
    """Series of each strand's rubber at a temperature [K]; one series a compound.

    Raises
    ------
    RangeError
        A compound is not known there.
    """
    carry, back = conveyor.carry_compound, conveyor.return_compound
    series = carry.series(temperature)
    same = back is carry or back == carry
    return {"carry": series, "return": series if same else back.series(temperature)}


def covers_of(
    conveyor: Conveyor, rubber: Mapping[Strand, PronySeries], levels: Mapping[Strand, Level | None]
) -> dict[Strand, RunningCover]:
    """The cover under each strand, of given rubber at its level."""
    thickness = {
        "carry": si(conveyor.belt.bottom_cover.thickness),
        "return": si(conveyor.return_cover_thickness),
    }
    compounds = compounds_by_strand(conveyor)
    return {
        strand: RunningCover(
            thickness[strand], rubber[strand], compounds[strand].poisson_ratio, level=levels[strand]
        )
        for strand in STRANDS
    }


def softened_covers(
    line: Line, covers: Covers, conveyor: Conveyor, temperature: float
) -> dict[Strand, RunningCover]:
    """The covers at the strain their rolls work them at, where the compounds have sweeps, at a temperature [K].

    Raises
    ------
    NoSolutionError
        A cover has no answer at its working strain.
    RangeError
        A compound's sweeps do not reach the strain.
    """
    if not line.softened:
        return dict(covers)
    compounds = compounds_by_strand(conveyor)
    return {
        strand: _softened(line, strand, cover, compounds[strand], temperature)
        for strand, cover in covers.items()
    }


def _softened(
    line: Line, strand: Strand, cover: RunningCover, compound: RubberCompound, temperature: float
) -> RunningCover:
    factors = compound.amplitude_factors()
    if factors is None:
        return cover
    kinds = [kind for kind in line.kinds if kind.strand == strand]
    loads = np.concatenate([kind.line_loads for kind in kinds])
    weights = np.concatenate([kind.weights * kind.sets for kind in kinds])
    contact = roll_contact(line, max(kinds, key=lambda kind: kind.highest), cover)
    series, strain = softened_cover(
        contact, losing_load(loads, weights), factors, temperature, swept=compound.swept_series(temperature)
    )
    return replace(cover, rubber=series, strain=strain)


def roll_contact(line: Line, kind: RollKind, cover: RunningCover) -> RollContact:
    """The contact of a kind of roll under a cover."""
    return RollContact(
        radius=kind.radius,
        spacing=kind.spacing,
        cover_thickness=cover.thickness,
        speed=line.speed,
        rubber=cover.rubber,
        poisson=cover.poisson,
        support=line.support,
    )
