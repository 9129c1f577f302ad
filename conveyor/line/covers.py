"""Covers under the rolls of each strand: thickness, and rubber at its temperature and working strain."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.errors import NoSolutionError, RangeError
from conveyor.indentation import Backing, RollContact, Support, resolved_relaxation_times
from conveyor.indentation.softening import (
    SoftCover,
    SofteningCover,
    WorkingStrain,
    loss_weighted_load,
    soften_at_strains,
    soften_covers,
)
from conveyor.line.line import Line
from conveyor.line.roll_kinds import RollKind
from conveyor.line.stretches import STRANDS, Strand
from conveyor.models import Conveyor, RubberCompound
from conveyor.rubber import PronySeries
from conveyor.rubber.equivalent_series import WorkingPoint
from conveyor.rubber.rolling_test_factor import RollingTestFactor
from conveyor.units import si

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CoverTestFactor:
    """Test factor of a cover's rubber at its temperature [K]."""

    rolling_tests: RollingTestFactor
    temperature: float
    compound: RubberCompound = field(compare=False, repr=False)

    def factor(self, line_load: ArrayLike) -> Array:
        """Measured over calculated indentation at line loads w [N/m]; dimensionless."""
        return self.rolling_tests.factor(line_load, self.temperature)


@dataclass(frozen=True, eq=False)
class CoverState:
    """A cover under rolls: thickness [m], Prony series at its temperature, Poisson's ratio.

    `strain` is the working strain; None for that of the master curve. `test_factor` is that on indentation; None
    without one. `opposite_cover` is the belt's other cover: thickness [m], series at small strain. `merging_error` and
    `interpolation_error` are the relative errors of indentation by merged relaxation terms and by a strain interpolated
    between speeds [-].
    """

    thickness: float
    series: PronySeries
    poisson: float
    opposite_cover: tuple[float, PronySeries]
    strain: WorkingStrain | None = None
    test_factor: CoverTestFactor | None = None
    merging_error: float = 0.0
    interpolation_error: float = 0.0

    @property
    def indentation_error(self) -> float:
        """Relative error of indentation by the approximated rubber [-]."""
        return self.merging_error + self.interpolation_error


CoverName: TypeAlias = Strand | Literal["top"]
"""Cover under the rolls of a strand, or the top cover."""
Covers = Mapping[Strand, CoverState]
"""Cover under each strand."""


def compounds_by_strand(conveyor: Conveyor) -> dict[Strand, RubberCompound]:
    """Compound under the rolls of each strand."""
    return {"carry": conveyor.carry_compound, "return": conveyor.return_compound}


def cover_series(conveyor: Conveyor, series: Callable[[RubberCompound], PronySeries]) -> dict[CoverName, PronySeries]:
    """Prony series of each strand's rubber and of the top cover's; one for each compound.

    Raises
    ------
    RangeError
        A compound is not known at the temperature of `series`.
    """
    behind = series(conveyor.return_compound)
    own = conveyor.belt.top_cover.compound
    turned = conveyor.bottom_cover_on_both and own is not None and conveyor.calculation.support == "belt"
    return {
        "carry": series(conveyor.carry_compound),
        "return": behind,
        "top": series(own) if turned and own is not None else behind,
    }


def covers_by_strand(conveyor: Conveyor, rubber: Mapping[CoverName, PronySeries]) -> dict[Strand, CoverState]:
    """Cover under each strand, of given rubber."""
    bottom = (si(conveyor.belt.bottom_cover.thickness), rubber["carry"])
    top = (si(conveyor.belt.top_cover.thickness), rubber["top"])
    pairs = {"carry": (bottom, top), "return": (bottom, top) if conveyor.bottom_cover_on_both else (top, bottom)}
    compounds = compounds_by_strand(conveyor)
    return {
        strand: CoverState(thickness, rubber[strand], compounds[strand].poisson_ratio, other)
        for strand in STRANDS
        for (thickness, _), other in [pairs[strand]]
    }


@dataclass(frozen=True, eq=False)
class CoverLoading:
    """Rolls of a strand on their cover, its rubber at the strain of the master curve."""

    line: Line
    strand: Strand
    cover: CoverState
    compound: RubberCompound
    temperature: float

    @property
    def kinds(self) -> tuple[RollKind, ...]:
        """Kinds of roll of the strand."""
        return self.line.strands.each[STRANDS.index(self.strand)].kinds

    @property
    def key(self) -> tuple[object, ...]:
        """Key equal for strands that load their covers identically, besides the compound."""
        line, cover = self.line, self.cover
        return (
            self.strand,
            self.temperature,
            line.speed,
            line.softened,
            line.support,
            cover.thickness,
            cover.opposite_cover if line.support == "belt" else None,
            cover.merging_error,
            *(kind.bearing for kind in self.kinds),
        )

    def softening(self) -> SofteningCover | None:
        """Contact that determines the working strain; None without strain dependence."""
        factors = self.compound.amplitude_factors() if self.line.softened and self.kinds else None
        if factors is None:
            return None
        contact = roll_contact(self.line, max(self.kinds, key=lambda kind: kind.highest), self.cover)
        swept = self.compound.swept_series(self.temperature)
        return SofteningCover(contact, self.line_load, factors, self.temperature, swept)

    @property
    def line_load(self) -> float:
        """Mean line load weighted by energy loss [N/m]."""
        if not self.kinds:
            return 0.0
        loads = np.concatenate([kind.line_loads for kind in self.kinds])
        return loss_weighted_load(loads, np.concatenate([kind.weights * kind.sets for kind in self.kinds]))

    def keeps_strain_of(self, cover: CoverState) -> bool:
        """True if a cover's working strain still fits the line load; strain goes as a root of the load."""
        was = cover.strain
        return was is not None and abs(self.line_load - was.line_load) <= self.line.rtol * was.line_load


TERM_MERGE_SHARE: Final = 0.02
"""Share of the contacts' tolerance for merging the fast, and for merging the slow, relaxation terms [-]."""


def resolved_time_range(work: CoverLoading, rtol: float) -> tuple[float, float] | None:
    """Range of relaxation times that a strand's rolls resolve [s]; None unless on a rigid carcass."""
    if work.line.support != "confined" or work.cover.poisson != 0.5 or not work.kinds:
        return None
    lightest = min(work.kinds, key=lambda kind: kind.lowest * kind.radius)
    return resolved_relaxation_times(
        roll_contact(work.line, lightest, work.cover), lightest.lowest, TERM_MERGE_SHARE * rtol
    )


STRAIN_INTERPOLATION_SPEEDS: Final = 5
"""Number of speeds from which the working strain is calculated at three and interpolated between."""
STRAIN_INTERPOLATION_SPAN: Final = 1.65
"""Largest ratio of speeds for interpolation: ln strain is a parabola of ln speed to 5e-4 (three covers of the shelf,
-30 to 40 °C); more nodes gain nothing, the calculated strain scatters as much."""
STRAIN_INTERPOLATION_TOLERANCE: Final = 5e-4
"""Relative interpolation error allowed of the strain, about its scatter [-]."""
STRAIN_INTERPOLATION_ERROR: Final = 7e-5
"""Resulting relative error of indentation [-]: with the error of the curves at most 6e-5, in the median 8e-6, in 204
cases against contacts of 1e-7 without interpolation (benchmarks/compare_error.py)."""
STRAIN_INTERPOLATION_RTOL: Final = 1e-4
"""Finest tolerance of contacts that allows interpolation [-]."""


def softened_covers(
    loadings: Sequence[CoverLoading], runs: Sequence[Sequence[CoverLoading]]
) -> list[CoverState | NoSolutionError | RangeError]:
    """Covers at their working strain, where the compounds have strain sweeps, solved in one batch.

    Parameters
    ----------
    loadings : sequence of CoverLoading
        Loaded strands.
    runs : sequence of sequence of CoverLoading
        Strands of `loadings` that differ in speed alone.

    Returns
    -------
    list
        Covers of the strands in their order, or the error: no solution at the working strain, or sweeps that do not
        reach it.
    """
    asked = {work: softening for work in loadings if (softening := work.softening()) is not None}
    threes = {three: part for run in runs for part in _speed_groups(run) for three in [_interpolation_nodes(part)]}
    between = {work for three, part in threes.items() for work in part if work not in three}
    alone = [work for work in asked if work not in between]
    soft = dict(zip(alone, soften_covers([asked[work] for work in alone]), strict=True))
    read: dict[CoverLoading, WorkingPoint] = {}
    for three, part in threes.items():
        strains = [one[1] for work in three if isinstance(one := soft.get(work), tuple)]
        if len(strains) == len(three):
            read |= _interpolate_strains(three, strains, [work for work in part if work in between])
    soft |= zip(read, soften_at_strains([asked[work] for work in read], list(read.values())), strict=True)
    left = [work for work in asked if work not in soft]
    soft |= zip(left, soften_covers([asked[work] for work in left]), strict=True)
    return [
        _softened_cover(work.cover, soft.get(work), STRAIN_INTERPOLATION_ERROR if work in read else 0.0)
        for work in loadings
    ]


def _speed_groups(run: Sequence[CoverLoading]) -> Iterator[list[CoverLoading]]:
    """Groups of strands within the speed ratio of interpolation, the slowest first."""
    left = sorted(dict.fromkeys(run), key=lambda work: work.line.speed)
    while len(left) >= STRAIN_INTERPOLATION_SPEEDS:
        part = [work for work in left if work.line.speed <= STRAIN_INTERPOLATION_SPAN * left[0].line.speed]
        left = left[len(part) :]
        if len(part) >= STRAIN_INTERPOLATION_SPEEDS:
            yield part


def _interpolation_nodes(part: Sequence[CoverLoading]) -> tuple[CoverLoading, CoverLoading, CoverLoading]:
    """Slowest, middle and fastest strand."""
    slowest, fastest = part[0], part[-1]
    middle = math.sqrt(slowest.line.speed * fastest.line.speed)
    return slowest, min(part[1:-1], key=lambda work: abs(math.log(work.line.speed / middle))), fastest


def _interpolate_strains(
    three: Sequence[CoverLoading], strains: Sequence[WorkingStrain], between: Sequence[CoverLoading]
) -> dict[CoverLoading, WorkingPoint]:
    """Strains and angular frequencies by a parabola in ln speed; none where its error exceeds the tolerance.

    The error of a straight line squares with the degree, as for Chebyshev points (contact.sampling).
    """
    known = np.log([(one.strain, 2.0 * math.pi * one.frequency) for one in strains])
    slow, middle, fast = np.log([work.line.speed for work in three])
    at = np.log([work.line.speed for work in between])[:, None]
    straight = known[0] + (known[2] - known[0]) * (at - slow) / (fast - slow)
    bend = known[1] - known[0] - (known[2] - known[0]) * (middle - slow) / (fast - slow)
    bend = bend * (at - slow) * (at - fast) / ((middle - slow) * (middle - fast))
    miss, span = np.abs(bend).max(axis=0), np.maximum(np.ptp(known, axis=0), np.finfo(float).tiny)
    if np.any(np.minimum(miss, 4.0 * miss * miss / span) > STRAIN_INTERPOLATION_TOLERANCE):
        return {}
    return {
        work: (strain, omega) for work, (strain, omega) in zip(between, np.exp(straight + bend).tolist(), strict=True)
    }


def _softened_cover(
    cover: CoverState, soft: SoftCover | NoSolutionError | RangeError | None, interpolation_error: float
) -> CoverState | NoSolutionError | RangeError:
    if soft is None:
        return cover
    return (
        replace(cover, series=soft[0], strain=soft[1], interpolation_error=interpolation_error)
        if isinstance(soft, tuple)
        else soft
    )


def belt_backing(line: Line, cover: CoverState, tension: float) -> Backing:
    """Backing of a cover by the belt at a tension T - m' V² per width [N/m]."""
    thickness, series = cover.opposite_cover
    body = line.belt
    return Backing(tension, body.bending, body.bending_loss, body.tensile_stiffness or 0.0, thickness, series)


def roll_contact(line: Line, kind: RollKind, cover: CoverState, behind: Backing | None = None) -> RollContact:
    """Contact of a kind of roll with a cover; on a rigid carcass without `behind`."""
    support: Support = "confined" if line.support == "belt" else line.support
    return RollContact(
        radius=kind.radius,
        spacing=kind.spacing,
        cover_thickness=cover.thickness,
        speed=line.speed,
        series=cover.series,
        poisson=cover.poisson,
        support=support if behind is None else "belt",
        backing=behind,
    )
