"""What the rolls of each strand run on: the cover's thickness and its rubber at the temperature and strain of work."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.errors import NoSolutionError, RangeError
from conveyor.indentation import Backing, RollContact, Support, felt
from conveyor.laws.softening import (
    SoftCover,
    WorkedCover,
    WorkingStrain,
    losing_load,
    softened_at,
    softened_many,
)
from conveyor.line.line import Line
from conveyor.line.roll_kinds import RollKind
from conveyor.line.stretches import STRANDS, Strand
from conveyor.models import Conveyor, RubberCompound
from conveyor.rubber import PronySeries
from conveyor.rubber.anchor import Anchor
from conveyor.rubber.equivalent import Worked
from conveyor.units import si

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Level:
    """The anchor of a cover's rubber at its temperature [K]; its compound."""

    anchor: Anchor
    temperature: float
    compound: RubberCompound = field(compare=False, repr=False)

    def factor(self, line_load: ArrayLike) -> Array:
        """Measured over calculated indentation at line loads w [N/m]."""
        return self.anchor.factor(line_load, self.temperature)


@dataclass(frozen=True, eq=False)
class RunningCover:
    """A cover that rolls run on: thickness [m], rubber at its temperature, Poisson's ratio.

    `strain` is what the rubber was softened for; None where it is that of the master curve. `level` is the factor that
    the compound's rolling-resistance tests put on its indentation; None where the theory stands alone. `other` is the
    belt's other cover: its thickness [m], and its rubber at small strain. `merged` is what merging terms that the rolls
    do not tell apart may change of indentation [-], `read` what reading the strain between speeds may.
    """

    thickness: float
    rubber: PronySeries
    poisson: float
    other: tuple[float, PronySeries]
    strain: WorkingStrain | None = None
    level: Level | None = None
    merged: float = 0.0
    read: float = 0.0

    @property
    def unsure(self) -> float:
        """What of indentation its rubber may miss [-]."""
        return self.merged + self.read


CoverName: TypeAlias = Strand | Literal["top"]
"""The rolls of a strand run on it; or whatever lies on top."""
Covers = Mapping[Strand, RunningCover]
"""The cover under each strand."""


def compounds_by_strand(conveyor: Conveyor) -> dict[Strand, RubberCompound]:
    """Rubber that the rolls of each strand run on."""
    return {"carry": conveyor.carry_compound, "return": conveyor.return_compound}


def rubbers(
    conveyor: Conveyor, series: Callable[[RubberCompound], PronySeries]
) -> dict[CoverName, PronySeries]:
    """Series of each strand's rubber and of the top cover's; one series a compound.

    Raises
    ------
    RangeError
        A compound is not known at the temperature of `series`.
    """
    behind = series(conveyor.return_compound)
    own = conveyor.belt.top_cover.compound
    turned = conveyor.route.turned_over and own is not None and conveyor.calculation.support == "belt"
    return {
        "carry": series(conveyor.carry_compound),
        "return": behind,
        "top": series(own) if turned and own is not None else behind,
    }


def covers_of(conveyor: Conveyor, rubber: Mapping[CoverName, PronySeries]) -> dict[Strand, RunningCover]:
    """The cover under each strand, of given rubber."""
    bottom = (si(conveyor.belt.bottom_cover.thickness), rubber["carry"])
    top = (si(conveyor.belt.top_cover.thickness), rubber["top"])
    pairs = {"carry": (bottom, top), "return": (bottom, top) if conveyor.route.turned_over else (top, bottom)}
    compounds = compounds_by_strand(conveyor)
    return {
        strand: RunningCover(thickness, rubber[strand], compounds[strand].poisson_ratio, other)
        for strand in STRANDS
        for (thickness, _), other in [pairs[strand]]
    }


@dataclass(frozen=True, eq=False)
class StrandAtWork:
    """The rolls of a strand of a line on their cover, whose rubber is at the strain of its master curve."""

    line: Line
    strand: Strand
    cover: RunningCover
    compound: RubberCompound
    temperature: float

    @property
    def kinds(self) -> tuple[RollKind, ...]:
        """Its rolls."""
        return self.line.strands.each[STRANDS.index(self.strand)].kinds

    @property
    def scene(self) -> tuple[object, ...]:
        """What must be equal where two strands work their covers exactly alike, besides the compound."""
        line, cover = self.line, self.cover
        return (
            self.strand,
            self.temperature,
            line.speed,
            line.softened,
            line.support,
            cover.thickness,
            cover.other if line.support == "belt" else None,
            cover.merged,
            *(kind.bearing for kind in self.kinds),
        )

    def worked(self) -> WorkedCover | None:
        """The contact whose strain softens the cover; None where nothing does."""
        factors = self.compound.amplitude_factors() if self.line.softened else None
        if factors is None:
            return None
        contact = roll_contact(self.line, max(self.kinds, key=lambda kind: kind.highest), self.cover)
        swept = self.compound.swept_series(self.temperature)
        return WorkedCover(contact, self.line_load, factors, self.temperature, swept)

    @property
    def line_load(self) -> float:
        """At which its rolls lose their energy [N/m]."""
        loads = np.concatenate([kind.line_loads for kind in self.kinds])
        return losing_load(loads, np.concatenate([kind.weights * kind.sets for kind in self.kinds]))

    def still_at(self, cover: RunningCover) -> bool:
        """Whether its rolls work a cover at the strain that it was softened for: strain goes as a root of the load."""
        was = cover.strain
        return was is not None and abs(self.line_load - was.line_load) <= self.line.rtol * was.line_load


FELT: Final = 0.02
"""Of the tolerance of the contacts, what merging the fast and what merging the slow terms of a rubber may take [-]."""


def told_apart(work: StrandAtWork, rtol: float) -> tuple[float, float] | None:
    """Relaxation times between which the rolls of a strand tell terms apart [s]; None off a stiff carcass."""
    if work.line.support != "confined" or work.cover.poisson != 0.5:
        return None
    lightest = min(work.kinds, key=lambda kind: kind.lowest * kind.radius)
    return felt(roll_contact(work.line, lightest, work.cover), lightest.lowest, FELT * rtol)


READ_FROM: Final = 5
"""Speeds from which on the working strain is found at three of them, and read between."""
READ_SPAN: Final = 1.65
"""Fastest over slowest of the speeds that a strain is read among: ln strain is a parabola of ln speed to 5e-4 (three
covers of the shelf, -30 to 40 °C); more nodes gain nothing, the strain found at each speed scatters as much."""
READ_STRAIN: Final = 5e-4
"""Of the strain, what reading it may miss by what a straight line misses [-]: about its scatter."""
READ_ERROR: Final = 7e-5
"""Of indentation, what that changes [-]: with the error of the curves 6e-5 at most, 8e-6 in the median was seen of 204
scenes against contacts of 1e-7 with a strain of their own (benchmarks/compare_error.py)."""
READ_RTOL: Final = 1e-4
"""Finest tolerance of contacts that leaves room for it [-]."""


def softened_covers(
    works: Sequence[StrandAtWork],
    tests: Sequence[WorkedCover] = (),
    runs: Sequence[Sequence[StrandAtWork]] = (),
) -> tuple[list[RunningCover | NoSolutionError | RangeError], list[SoftCover | NoSolutionError | RangeError]]:
    """The covers at the strain their rolls work them at, where the compounds have sweeps, solved side by side.

    Parameters
    ----------
    works : sequence of StrandAtWork
        Strands.
    tests : sequence of WorkedCover
        Covers of rolling-resistance tests, that go with them.
    runs : sequence of sequence of StrandAtWork
        Of `works`, strands that differ in speed and what follows from it alone.

    Returns
    -------
    tuple of list
        In their order the covers, of strands and of tests; or why there is none: it has no answer at its working
        strain, or the sweeps of its compound do not reach the strain.
    """
    asked = {work: worked for work in works if (worked := work.worked()) is not None}
    threes = {three: part for run in runs for part in _parts(run) for three in [_three(part)]}
    between = {work for three, part in threes.items() for work in part if work not in three}
    found = softened_many([*tests, *(worked for work, worked in asked.items() if work not in between)])
    soft = dict(zip([work for work in asked if work not in between], found[len(tests) :], strict=True))
    read: dict[StrandAtWork, Worked] = {}
    for three, part in threes.items():
        strains = [one[1] for work in three if isinstance(one := soft.get(work), tuple)]
        if len(strains) == len(three):
            read |= _read(three, strains, [work for work in part if work in between])
    soft |= zip(read, softened_at([asked[work] for work in read], list(read.values())), strict=True)
    left = [work for work in asked if work not in soft]
    soft |= zip(left, softened_many([asked[work] for work in left]), strict=True)
    running = [_running(work.cover, soft.get(work), READ_ERROR if work in read else 0.0) for work in works]
    return running, found[: len(tests)]


def _parts(run: Sequence[StrandAtWork]) -> Iterator[list[StrandAtWork]]:
    """Strands of speeds that a strain is read among, the slowest first."""
    left = sorted(dict.fromkeys(run), key=lambda work: work.line.speed)
    while len(left) >= READ_FROM:
        part = [work for work in left if work.line.speed <= READ_SPAN * left[0].line.speed]
        left = left[len(part) :]
        if len(part) >= READ_FROM:
            yield part


def _three(part: Sequence[StrandAtWork]) -> tuple[StrandAtWork, StrandAtWork, StrandAtWork]:
    """The slowest, the middle one and the fastest."""
    slowest, fastest = part[0], part[-1]
    middle = math.sqrt(slowest.line.speed * fastest.line.speed)
    return slowest, min(part[1:-1], key=lambda work: abs(math.log(work.line.speed / middle))), fastest


def _read(
    three: Sequence[StrandAtWork], strains: Sequence[WorkingStrain], between: Sequence[StrandAtWork]
) -> dict[StrandAtWork, Worked]:
    """Strains and angular frequencies by a parabola in ln speed; none where that may miss more than they are found to.

    What a straight line misses squares with the degree, as of Chebyshev points (contact.sampling).
    """
    known = np.log([(one.strain, 2.0 * math.pi * one.frequency) for one in strains])
    slow, middle, fast = np.log([work.line.speed for work in three])
    at = np.log([work.line.speed for work in between])[:, None]
    straight = known[0] + (known[2] - known[0]) * (at - slow) / (fast - slow)
    bend = known[1] - known[0] - (known[2] - known[0]) * (middle - slow) / (fast - slow)
    bend = bend * (at - slow) * (at - fast) / ((middle - slow) * (middle - fast))
    miss, span = np.abs(bend).max(axis=0), np.maximum(np.ptp(known, axis=0), np.finfo(float).tiny)
    if np.any(np.minimum(miss, 4.0 * miss * miss / span) > READ_STRAIN):
        return {}
    return {
        work: (strain, omega)
        for work, (strain, omega) in zip(between, np.exp(straight + bend).tolist(), strict=True)
    }


def _running(
    cover: RunningCover, soft: SoftCover | NoSolutionError | RangeError | None, read: float
) -> RunningCover | NoSolutionError | RangeError:
    if soft is None:
        return cover
    return replace(cover, rubber=soft[0], strain=soft[1], read=read) if isinstance(soft, tuple) else soft


def backing(line: Line, cover: RunningCover, tension: float) -> Backing:
    """The belt behind a cover at a tension T - m' V² per width [N/m]."""
    thickness, rubber = cover.other
    body = line.belt
    return Backing(tension, body.bending, body.bending_loss, body.tensile_stiffness or 0.0, thickness, rubber)


def roll_contact(
    line: Line, kind: RollKind, cover: RunningCover, behind: Backing | None = None
) -> RollContact:
    """The contact of a kind of roll under a cover; without the belt behind it, on a carcass that does not give."""
    support: Support = "confined" if line.support == "belt" else line.support
    return RollContact(
        radius=kind.radius,
        spacing=kind.spacing,
        cover_thickness=cover.thickness,
        speed=line.speed,
        rubber=cover.rubber,
        poisson=cover.poisson,
        support=support if behind is None else "belt",
        backing=behind,
    )
