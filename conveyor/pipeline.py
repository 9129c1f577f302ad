"""The whole calculation.

spec -> line in SI, loads of the rolls -> contacts of all rolls -> forces along the belt -> loop of tensions -> result

Many variants are calculated in one batch: their contacts are solved together; shared parts (a line, a rubber at a
temperature, a cover at its working strain) are built once. On curves, and with a yielding belt, the tensions change the
roll loads: both are iterated to convergence.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import islice, repeat
from typing import Any, Final, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.forces import RubberFreeForces, forces_along_belt, strand_rubber_free_forces
from conveyor.indentation.softening import soften_covers
from conveyor.line.belt_contacts import STRETCH_QUADRATURE, TensionedCurveCache, solve_belt_contacts
from conveyor.line.contacts import Contacts, LoadCurveCache, RollResult, solve_contacts
from conveyor.line.covers import (
    STRAIN_INTERPOLATION_RTOL,
    TERM_MERGE_SHARE,
    CoverLoading,
    Covers,
    CoverState,
    CoverTestFactor,
    compounds_by_strand,
    cover_series,
    covers_by_strand,
    resolved_time_range,
    softened_covers,
)
from conveyor.line.line import Line
from conveyor.line.roll_drags import StrandDrags, roll_drags_many
from conveyor.line.rolling_test_theory import RollingTestTheory
from conveyor.line.strands import OneStrand, Strands
from conveyor.line.stretches import STRANDS, CurveLoads, RouteSection, Strand, Stretch, route_sections
from conveyor.loop.annual_energy import AnnualEnergy, annual_energy
from conveyor.loop.balance import Balance, OpenLoop, close_loops
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.drive_duty import DriveDuty, drive_duty
from conveyor.loop.horizontal_curve_duty import HorizontalCurveCheck, horizontal_curve_checks
from conveyor.loop.loop_layout import LoopLayout, TakeUpSetting
from conveyor.loop.pulley_duty import PulleyDuty, pulley_duty
from conveyor.loop.set_duty import SetDuty, set_duty
from conveyor.loop.start_and_stop import StartAndStop, motion_states, start_and_stop
from conveyor.loop.take_up_duty import TakeUpDuty, at_common_setting, take_up_duty
from conveyor.loop.tension_coupling import Convergence, loads_on_curves, next_convergence, pull_per_width
from conveyor.loop.tensions import MotionState
from conveyor.loop.transfer_points import (
    CleanerDuty,
    LoadingPointDuty,
    Trajectory,
    cleaner_duty,
    discharge_trajectory,
    loading_point_duty,
)
from conveyor.models import Calculation, Conveyor, RubberCompound
from conveyor.models.belt import Belt
from conveyor.models.fields import PartCache
from conveyor.rubber.rolling_test_factor import RollingTestFactor
from conveyor.units.sentences import error_in_units

Array = NDArray[np.float64]
T = TypeVar("T")
NoAnswer: TypeAlias = NoSolutionError | RangeError | InputError
ProgressCallback: TypeAlias = Callable[[int, int], None]
"""Called with the amount done, which never falls, and the total."""
KnownTestFactors: TypeAlias = list[tuple[RubberCompound, bool, RollingTestFactor | NoAnswer | None]]
"""Compounds by identity, whether softened by strain, and their test factors or errors; begins empty."""


@dataclass(frozen=True, eq=False)
class Variant:
    """A conveyor with overrides.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    temperature : float, optional
        Temperature of the covers instead of the spec's [K]; the air stays.
    level : mapping of strand to float
        Factor on a strand's indentation [-]; 1 if absent.
    roll_drag : float
        Factor on the drag of all rolls [-].
    take_up : TakeUpSetting, optional
        Setting of the take-up by other loads, instead of the spec's or the least [N], and its side.
    """

    conveyor: Conveyor
    temperature: float | None = None
    level: Mapping[Strand, float] = field(default_factory=dict)
    roll_drag: float = 1.0
    take_up: TakeUpSetting | None = None

    @property
    def covers_at(self) -> float:
        """Temperature of the covers [K]."""
        return self.conveyor.temperature if self.temperature is None else self.temperature


@dataclass(frozen=True, eq=False)
class StretchResult:
    """Results of a section of one strand: rolls on their cover, and every force along it [N].

    Attributes
    ----------
    stretch : Stretch
        Geometry, masses and loads.
    cover : CoverState
        Cover under its rolls.
    rolls : tuple of RollResult
        Rolls of one set, left to right.
    forces : mapping
        Forces by key, as in `Balance.along`.
    main, unit_main : float
        Main resistance, and that which DIN 22101 gives for f = 1.
    """

    stretch: Stretch
    cover: CoverState
    rolls: tuple[RollResult, ...]
    forces: Mapping[str, float]
    main: float
    unit_main: float

    @property
    def total(self) -> float:
        """All forces along the stretch [N]."""
        return math.fsum(self.forces.values())


@dataclass(frozen=True, eq=False)
class CalculatedConveyor:
    """Everything calculated for one conveyor, SI.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    temperature : float
        Temperature of its covers [K].
    contacts : Contacts
        Contacts of all rolls.
    balance : Balance
        Forces, tensions, power.
    fixed : RubberFreeForces
        Forces independent of the rubber.
    convergence : Convergence or None
        Convergence of tensions and roll loads; None without coupling.
    friction_band : tuple of float or None
        Low and high factor on the computed friction [-]; drive.least_friction and 1 where None.
    start_of_motors : float or None
        Force at rest of motors of unknown power, sized for the load that needs most [N]; None where only this load is
        known, or every power.
    """

    conveyor: Conveyor
    temperature: float
    contacts: Contacts
    balance: Balance
    fixed: RubberFreeForces
    convergence: Convergence | None = None
    friction_band: tuple[float, float] | None = None
    start_of_motors: float | None = None

    @cached_property
    def drive_forces(self) -> tuple[float, float]:
        """Drive force at both ends of the friction band [N]."""
        settled = self.balance.settled
        low, high = map(settled.resistance, self.friction_band or (self.line.least_friction, 1.0))
        return low, high

    @property
    def governing_motor_power(self) -> float:
        """Motor power at the less favourable end of the friction band [W]; negative: generating."""
        least, most = map(self.balance.frame.motor, self.drive_forces)
        return least if abs(least) > abs(most) else most

    @property
    def line(self) -> Line:
        """The conveyor in SI."""
        return self.balance.line

    @cached_property
    def stretches(self) -> tuple[StretchResult, ...]:
        """Results of every section: carry strand from the tail, return strand from the head."""
        along = {force.key: force for force in self.balance.along}
        columns = [force.newtons.tolist() for force in along.values() if not isinstance(force.newtons, float)]
        main = [key for key, force in along.items() if force.kind == "main"]
        results = []
        for stretch, rolls, unit_main, *newtons in zip(
            self.line.stretches, self.contacts.rolls, self.fixed.unit_main.tolist(), *columns, strict=True
        ):
            forces = dict(zip(along, newtons, strict=True))
            total = math.fsum(forces[key] for key in main)
            cover = self.contacts.covers[stretch.strand]
            results.append(StretchResult(stretch, cover, rolls, forces, total, unit_main))
        return tuple(results)

    @cached_property
    def motions(self) -> StartAndStop:
        """Start, coasting, braking, holding; slip limits of the bulk."""
        return start_and_stop(self.balance)

    @property
    def motion_states(self) -> tuple[MotionState, ...]:
        """Tensions in every state of motion."""
        return motion_states(self.balance, self.motions)

    @cached_property
    def take_up(self) -> TakeUpDuty:
        """Setting, mass and travel of the take-up for this load."""
        return common_take_up_duty([self])

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves, lengths of transitions."""
        return belt_duty(self.balance, self.motion_states)

    @cached_property
    def horizontal(self) -> tuple[HorizontalCurveCheck, ...]:
        """Horizontal curves on both strands: drift in every state, radii, tensions of the edges."""
        return horizontal_curve_checks(self.balance, self.motion_states)

    @cached_property
    def pulley_duty(self) -> tuple[PulleyDuty, ...]:
        """Loads of every pulley in every state, its shaft, bearings and lagging."""
        return pulley_duty(self.balance, self.motion_states)

    @cached_property
    def drive_duty(self) -> tuple[DriveDuty, ...]:
        """Gear, backstop, brake, starts and sharing of the drives whose parts the spec gives."""
        return drive_duty(self.balance, self.motions)

    @cached_property
    def set_duty(self) -> tuple[SetDuty, ...]:
        """Load, axles, life and flap of the idler sets whose limits the spec gives."""
        return set_duty(self.balance)

    @cached_property
    def loading_point_duty(self) -> tuple[LoadingPointDuty, ...]:
        """Impact and skirts of every loading point."""
        return loading_point_duty(self.line)

    @cached_property
    def cleaner_duty(self) -> tuple[CleanerDuty, ...]:
        """Carryback behind every cleaner."""
        return cleaner_duty(self.line)

    @cached_property
    def trajectory(self) -> Trajectory | None:
        """Trajectory of the bulk over the head pulley, where the spec gives `discharge`."""
        return discharge_trajectory(self.line)

    @cached_property
    def year(self) -> AnnualEnergy | None:
        """Annual energy at constant load and its cost; None without hours or with a duty."""
        operation = self.conveyor.operation
        if operation is None or operation.duty:
            return None
        return annual_energy(operation, self.balance.power.mains, self.line.flow)

    @property
    def error_estimate(self) -> float:
        """Largest relative error estimate of any roll's indentation [-]."""
        return self.contacts.error


def common_take_up_duty(loads: Sequence[CalculatedConveyor], temperatures: Iterable[float] = ()) -> TakeUpDuty:
    """Setting, mass and travel of the take-up for several loads calculated at one setting.

    The travel covers further `temperatures` of the belt [K], too.
    """
    return take_up_duty(
        [load.balance for load in loads],
        [load.motion_states for load in loads],
        [*(load.temperature for load in loads), *temperatures],
    )


def calculate(conveyor: Conveyor) -> CalculatedConveyor:
    """Calculate one conveyor under its own load.

    The take-up is at its given setting, else at the least that serves this load; reports have the least that serves
    every load, from `conveyor.studies`.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.

    Returns
    -------
    CalculatedConveyor
        Contacts, forces, tensions, power, duties of the parts.

    Raises
    ------
    NoSolutionError
        A contact has no solution, the tensions do not converge, or the belt lifts off with its bulk.
    RangeError
        A compound is not known at the belt's temperature.
    InputError
        The argument is not a Conveyor.
    """
    if not isinstance(conveyor, Conveyor):
        raise InputError(
            f"analyse: takes a Conveyor, got {type(conveyor).__name__}; conveyor.load(path) reads one from a file"
        )
    (result,) = calculate_many([Variant(conveyor)])
    if not isinstance(result, CalculatedConveyor):
        raise result
    return result


def calculate_many(
    variants: Sequence[Variant],
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
    *,
    one_take_up: Callable[[CalculatedConveyor], bool] | None = None,
    known: CalculatedConveyor | None = None,
    anchors: KnownTestFactors | None = None,
    kept: ReuseCache | None = None,
    runs: Iterable[Iterable[int]] = (),
) -> list[CalculatedConveyor | NoAnswer]:
    """Calculate many variants, all contacts in one batch.

    Parameters
    ----------
    variants : sequence of Variant
        Conveyors.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of each spec.
    progress : callable, optional
        Called as variants are loaded, and when they are solved; a variant counts half for each.
    one_take_up : callable, optional
        Give all variants one setting of the take-up, the least that serves the variants for which this is true. By
        default the least of each. A setting of the spec is kept.
    known : CalculatedConveyor, optional
        A variant calculated before: the test factors of its compounds are reused.
    anchors : list, optional
        Test factors of earlier calls with the same compounds, by default those of `kept`; new ones are added.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.
    runs : iterable of iterable of int
        Indices of variants that differ in speed alone: their working strain is interpolated among three, where `rtol`
        allows it (`STRAIN_INTERPOLATION_RTOL`).

    Returns
    -------
    list
        Calculations in the order of the variants, or the error of each.

    Raises
    ------
    NoSolutionError
        No setting of the take-up serves all.
    """
    shared = _BatchContext(known, anchors, rtol, ReuseCache() if kept is None else kept)
    shared.set_speed_runs(runs)
    tell = _ProgressReporter(len(variants), progress)
    shared.anchor(variants)
    made: dict[int, CalculatedConveyor] = {}
    refused: dict[int, NoAnswer] = {}
    going = {i: _IterationState() for i in range(len(variants))}
    while going:
        loaded: dict[int, _PreparedLine] = {}
        for i, one in shared.loaded({i: (variants[i], step.acting) for i, step in going.items()}):
            if isinstance(one, _PreparedLine):
                loaded[i] = one
            else:
                refused[i] = one
            tell(len(variants) - len(going), len(loaded))
        for i, result in _close_all_loops(variants, loaded, _solve_all_contacts(shared, loaded, going, rtol)).items():
            if isinstance(result, CalculatedConveyor):
                made[i] = result
            else:
                refused[i] = result
        for i in refused:
            made.pop(i, None)
        if one_take_up is not None:
            asking = list(map(one_take_up, made.values()))
            level = at_common_setting([result.balance for result in made.values()], asking)
            made = {i: replace(made[i], balance=one) for i, one in zip(made, level, strict=True)}
        acted = [i for i in going if i in made and made[i].line.has_tension_coupling]
        again: dict[int, _IterationState] = {}
        for i in acted:
            try:
                made[i] = result = replace(made[i], convergence=_tension_convergence(made[i], going[i]))
                again[i] = _IterationState.after(result)
            except NoSolutionError as error:
                refused[i] = error
                del made[i]
        moving = {i for i in again if not _is_settled(made[i])}
        # one that still moves the common setting moves the tensions of all
        going = again if one_take_up is not None and moving else {i: again[i] for i in moving}
        tell(len(variants) - len(going), 0)
    systems = enumerate(one.conveyor.report.units for one in variants)
    return [error_in_units(refused[i], system) if i in refused else made[i] for i, system in systems]


@dataclass(frozen=True, eq=False)
class _IterationState:
    """Iteration state of a variant: loads on curves, pull of the belt, results of the step before."""

    acting: CurveLoads = field(default_factory=CurveLoads)
    pulls: Array | None = None
    covers: Covers = field(default_factory=dict)
    before: Balance | None = None
    convergence: Convergence | None = None

    @classmethod
    def after(cls, result: CalculatedConveyor) -> _IterationState:
        """State for the step after a result."""
        line, steady = result.line, result.balance.settled.steady
        held = pull_per_width(line, steady, STRETCH_QUADRATURE[0]) if line.support == "belt" else None
        covers = result.contacts.covers
        return cls(loads_on_curves(line, steady), held, covers, result.balance, result.convergence)


@dataclass(frozen=True, eq=False)
class _PreparedLine:
    """A line prepared for its contacts: loop, forces independent of rubber, loaded covers.

    `acted`: with loads of tension on curves, so that no other variant shares it; `anchored`: test factors apply.
    """

    line: Line
    frame: LoopLayout
    fixed: RubberFreeForces
    has_curve_loads: bool
    works: Mapping[Strand, CoverLoading] = field(default_factory=dict)
    uses_rolling_tests: bool = False


def conveyor_test_factors(conveyor: Conveyor, compounds: Iterable[RubberCompound]) -> KnownTestFactors:
    """Test factors of compounds as a conveyor's calculation uses them."""
    levels: KnownTestFactors = []
    if _uses_rolling_tests(conveyor.calculation):
        softened = conveyor.calculation.strain != "off"
        for theory in _missing_theories(levels, [(compound, softened) for compound in compounds]):
            found = theory.levels(soften_covers(theory.works))
            levels += zip(theory.compounds, repeat(softened), found, strict=False)
    return levels


def _missing_theories(
    levels: KnownTestFactors, asked: Iterable[tuple[RubberCompound, bool]]
) -> list[RollingTestTheory]:
    """Theory at the tests of compounds, softened or not, whose test factors are unknown."""
    new: list[tuple[RubberCompound, bool]] = []
    for one, soft in asked:
        if not any(one is other and soft == how for other, how, *_ in (*levels, *new)):
            new.append((one, soft))
    return [
        RollingTestTheory([one for one, soft in new if soft == softened], softened=softened)
        for softened in dict.fromkeys(soft for _, soft in new)
    ]


def _uses_rolling_tests(calculation: Calculation) -> bool:
    """True if rolling-resistance tests scale the indentation."""
    return calculation.anchor == "tests" and calculation.support in {"confined", "belt"}


def _strand_and_forces(
    conveyor: Conveyor, sections: tuple[RouteSection, ...], strand: Strand, on_curves: CurveLoads
) -> tuple[OneStrand, RubberFreeForces]:
    """A strand of a conveyor and its forces independent of rubber."""
    made = OneStrand.of(conveyor, sections, strand, on_curves)
    return made, strand_rubber_free_forces(made)


def _prepare_line(line: Line, fixed: Sequence[RubberFreeForces], acted: bool) -> _PreparedLine:
    """Prepare a line without roll drags and loaded covers."""
    carry, back = fixed
    return _PreparedLine(line, LoopLayout(line), carry.joined(back), acted)


def _solve_all_contacts(
    shared: _BatchContext,
    loaded: Mapping[int, _PreparedLine],
    steps: Mapping[int, _IterationState],
    rtol: float | None,
) -> dict[int, Contacts | NoAnswer]:
    """Solve the contacts of prepared lines, their covers at their working strain, in one batch.

    A yielding belt is first calculated on a rigid carcass, as its tensions are unknown.
    """
    running = shared.softened(loaded, {i: steps[i].covers for i in loaded})
    covers = {i: one for i, one in running.items() if isinstance(one, Mapping)}
    solved = solve_contacts([loaded[i].line for i in covers], list(covers.values()), rtol, shared.curves)
    refused = {i: one for i, one in running.items() if not isinstance(one, Mapping)}
    contacts: dict[int, Contacts | NoAnswer] = {**refused, **dict(zip(covers, solved, strict=True))}
    tight = {i: one for i in loaded if (one := steps[i].pulls) is not None}
    held = {i: fast for i in tight if isinstance(fast := contacts[i], Contacts)}
    if held:
        rtols = [loaded[i].line.rtol if rtol is None else rtol for i in held]
        belts = solve_belt_contacts(list(held.values()), [tight[i] for i in held], rtols, shared.tensioned)
        contacts |= dict(zip(held, belts, strict=True))
    return contacts


def _close_all_loops(
    variants: Sequence[Variant],
    loaded: Mapping[int, _PreparedLine],
    contacts: Mapping[int, Contacts | NoAnswer],
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Close the loops around the forces of the rolls in one batch."""
    found: dict[int, CalculatedConveyor | NoAnswer] = {}
    open_loops: dict[int, tuple[Contacts, OpenLoop]] = {}
    for i, one in contacts.items():
        try:
            if isinstance(one, Contacts):
                open_loops[i] = one, _open_loop(variants[i], loaded[i], one)
            else:
                found[i] = one
        except InputError as error:
            found[i] = error
    closed = close_loops([loop for _, loop in open_loops.values()])
    for (i, (rolls, _)), made in zip(open_loops.items(), closed, strict=True):
        at = variants[i]
        found[i] = (
            made
            if isinstance(made, NoSolutionError)
            else CalculatedConveyor(at.conveyor, at.covers_at, rolls, made, loaded[i].fixed)
        )
    return found


def _open_loop(variant: Variant, loaded: _PreparedLine, contacts: Contacts) -> OpenLoop:
    """Loop with the forces along the belt, to be closed."""
    level = np.repeat([variant.level.get(strand, 1.0) for strand in STRANDS], loaded.line.count)
    along = forces_along_belt(
        loaded.line,
        loaded.fixed,
        level * contacts.indentation,
        roll_drag=variant.roll_drag,
        calibration=variant.conveyor.calculation.calibration,
    )
    return OpenLoop.of(loaded.frame, along, float(loaded.fixed.unit_main.sum()), variant.take_up)


def _tension_convergence(result: CalculatedConveyor, step: _IterationState) -> Convergence | None:
    """Convergence of coupled tensions against the step before; None in the first step."""
    if step.before is None:
        return None
    before, now = step.before.settled.steady, result.balance.settled.steady
    return next_convergence(step.convergence, before, now, result.line, result.balance.tensions.largest)


def _is_settled(result: CalculatedConveyor) -> bool:
    """True if tensions and roll loads have converged."""
    return result.convergence is not None and result.convergence.settled(result.line.rtol)


_MISSING: Final[Any] = object()
_RUBBER_FIELDS: Final[Any] = {cover: {"compound"} for cover in ("top_cover", "bottom_cover")}


class _IdentityKey:
    """Dictionary key of a spec's part by identity; it keeps the part alive."""

    __slots__ = ("part",)

    def __init__(self, part: object) -> None:
        self.part = part

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _IdentityKey) and self.part is other.part

    def __hash__(self) -> int:
        return object.__hash__(self.part)


class ReuseCache:
    """Cache of parts shared by the variants of a spec: strands, lines, covers, load curves.

    Parts of specs are compared by identity: variants come from `replace`, which keeps unchanged parts. Belts that
    differ in rubber alone share strands and lines.
    """

    MOST: Final = 2048
    """Entries of each kind kept between calls, the last used; more than a study over speeds and spacings needs."""

    def __init__(self) -> None:
        self._made: dict[object, Any] = {}
        self.anchors: KnownTestFactors = []
        self.covers: dict[CoverLoading, CoverState | NoAnswer] = {}
        self.curves: LoadCurveCache = {}
        self.drags: dict[tuple[OneStrand, float | None], StrandDrags | InputError] = {}
        self.fields = PartCache()
        """For `with_fields`: specs of equal changes share their parts."""

    def begin(self) -> None:
        """Drop the least recently used entries beyond `MOST`."""
        every: tuple[dict[Any, Any], ...] = (self._made, self.covers, self.curves, self.drags)
        for known in every:
            for key in list(known)[: max(0, len(known) - self.MOST)]:
                known.pop(key, None)
        if self.fields.full:
            self.fields = PartCache()

    def forget_solved(self) -> None:
        """Drop batch solutions, whose last digits depend on the batch."""
        self.covers.clear()
        self.curves.clear()

    def once(self, make: Callable[[], T], what: str, parts: Iterable[object], values: tuple[object, ...] = ()) -> T:
        """Cached value for the same parts and equal values, made if absent."""
        key = (what, *map(_IdentityKey, parts), *values)
        made: T = self._made.pop(key, _MISSING)
        if made is _MISSING:
            made = make()
        self._made[key] = made  # at the end are those used last
        return made

    def belt(self, belt: Belt) -> Belt:
        """First belt that differs from `belt` in its rubber alone."""
        said = self.once(lambda: belt.model_dump_json(exclude=_RUBBER_FIELDS), "said", (belt,))
        return self.once(partial(_same_object, belt), "belt", (), (said, belt.line_mass))


class _BatchContext:
    """Parts shared by the variants of one call: lines, rubbers at a temperature, covers at their strain."""

    def __init__(
        self,
        known: CalculatedConveyor | None,
        anchors: KnownTestFactors | None,
        rtol: float | None,
        kept: ReuseCache,
    ) -> None:
        kept.begin()
        self._kept, self._own = kept, ReuseCache()
        self._theories: list[RollingTestTheory] = []
        self._anchors, self._rtol = kept.anchors if anchors is None else anchors, rtol
        self._running: dict[CoverLoading, CoverState | NoAnswer] = {}
        self._drags = kept.drags
        self.tensioned: TensionedCurveCache = {}
        self._runs: list[list[int]] = []
        self.curves = kept.curves
        if known is not None:
            for strand, compound in compounds_by_strand(known.conveyor).items():
                cover = known.contacts.covers[strand]
                if cover.level is not None:
                    self._anchors.append((compound, known.line.softened, cover.level.anchor))
                work = CoverLoading(known.line, strand, cover, compound, known.temperature)
                first = kept.once(partial(_same_object, work), "alike", (compound,), work.scene)
                self._running[first] = cover

    def set_speed_runs(self, runs: Iterable[Iterable[int]]) -> None:
        """Interpolate strains of variants that differ in speed alone, where the tolerance allows."""
        if self._rtol is not None and self._rtol >= STRAIN_INTERPOLATION_RTOL:
            self._runs = [list(run) for run in runs]

    def anchor(self, variants: Iterable[Variant]) -> None:
        """Request the test factors of all compounds; they are solved with the covers of the strands."""
        anchored = [one.conveyor for one in variants if _uses_rolling_tests(one.conveyor.calculation)]
        compounds = ((one, compounds_by_strand(one).values()) for one in anchored)
        asked = [(compound, one.calculation.strain != "off") for one, each in compounds for compound in each]
        self._theories = _missing_theories(self._anchors, asked)

    def loaded(self, asked: Mapping[int, tuple[Variant, CurveLoads]]) -> Iterator[tuple[int, _PreparedLine | NoAnswer]]:
        """Lines of variants under the loads on their curves, with their covers at small strain.

        An error where the belt lifts off on a concave curve or runs off its rolls on a horizontal one, a compound is
        unknown at the belt's temperature, or a law of roll drag is out of range at a load.
        """
        still: dict[int, _PreparedLine | NoAnswer] = {}
        for i, (variant, on_curves) in asked.items():
            try:
                still[i] = self._line_without_drag(variant.conveyor, on_curves)
            except (NoSolutionError, RangeError, InputError) as error:
                still[i] = error
        self._drag([(asked[i][0].conveyor, one) for i, one in still.items() if isinstance(one, _PreparedLine)])
        for i, one in still.items():
            try:
                yield i, self._in_air(asked[i][0], one) if isinstance(one, _PreparedLine) else one
            except (NoSolutionError, RangeError, InputError) as error:
                yield i, error

    def _drag(self, lines: Iterable[tuple[Conveyor, _PreparedLine]]) -> None:
        """Calculate the unknown drags of all rolls in one batch."""
        asked = {
            (one, _drag_air_temperature(given)): (given, one) for given, line in lines for one in line.line.strands.each
        }
        new = {key: pair for key, pair in asked.items() if key not in self._drags}
        self._drags.update(zip(new, roll_drags_many(list(new.values())), strict=True))

    def _in_air(self, variant: Variant, still: _PreparedLine) -> _PreparedLine:
        """Line with the drags of its rolls and its covers at small strain."""
        given, at = variant.conveyor, variant.covers_at
        compounds = compounds_by_strand(given)
        rubber = cover_series(given, lambda one: self._kept.once(partial(one.series, at), "series", (one,), (at,)))
        gives = given.calculation.support == "belt"
        acted = self._own if still.has_curve_loads else self._kept
        running = acted.once(
            partial(self._dragged, still, _drag_air_temperature(given)),
            "in air",
            (still,),
            (_drag_air_temperature(given),),
        )
        rtol = running.line.rtol if self._rtol is None else self._rtol
        works = {
            strand: acted.once(
                partial(self._worked, CoverLoading(running.line, strand, cover, compounds[strand], at), rtol),
                "work",
                (running.line, cover.rubber, compounds[strand], *((cover.other[1],) if gives else ())),
                (strand, at, rtol),
            )
            for strand, cover in covers_by_strand(given, rubber).items()
        }
        return replace(running, works=works, uses_rolling_tests=_uses_rolling_tests(given.calculation))

    def _dragged(self, still: _PreparedLine, air: float | None) -> _PreparedLine:
        """Line with the drags of its rolls in air of a temperature [K]."""
        drags: list[tuple[float, ...]] = []
        for strand in still.line.strands.each:
            one = self._drags[strand, air]
            if isinstance(one, InputError):
                raise one
            drags += one
        line = replace(still.line, roll_drags=tuple(drags))
        return replace(still, line=line, frame=still.frame.of(line))

    def _worked(self, work: CoverLoading, rtol: float) -> CoverLoading:
        """First strand that loads its cover identically, with unresolved relaxation terms merged."""
        felt = self._merge_unresolved_terms(work, rtol)
        return self._kept.once(partial(_same_object, felt), "alike", (work.compound,), felt.scene)

    def _merge_unresolved_terms(self, work: CoverLoading, rtol: float) -> CoverLoading:
        """Merge relaxation terms that the rolls of a strand cannot resolve."""
        times = resolved_time_range(work, rtol)
        if times is None:
            return work
        rubber, (fastest, slowest) = work.cover.rubber, times
        cut = tuple(rubber.times.searchsorted(times).tolist())
        less = self._kept.once(lambda: rubber.merged(fastest=fastest, slowest=slowest), "merged", (rubber,), cut)
        return replace(work, cover=replace(work.cover, rubber=less, merged=2.0 * TERM_MERGE_SHARE * rtol))

    def _line_without_drag(self, given: Conveyor, on_curves: CurveLoads) -> _PreparedLine:
        """Line of a spec without roll drags."""
        acted = on_curves != CurveLoads()
        kept, belt = self._own if acted else self._kept, self._kept.belt(given.belt)
        others = (belt, given.material, given.route, given.drive, given.calculation, given.report)
        scene = (*map(_item_tuple, vars(on_curves).values()), given.ambient.wind_speed, given.site)

        def made() -> _PreparedLine:
            """Build the line; specs of equal belt, load and idlers share strands."""
            sections = self._kept.once(lambda: route_sections(given), "sections", (given.route,))
            each = []
            for strand, own in zip(STRANDS, sets, strict=True):
                parts = (belt, own, given.material, given.route, given.calculation)
                laid = partial(_strand_and_forces, given, sections, strand, on_curves)
                each.append(kept.once(laid, "strand", parts, (strand, *scene)))
            (carry, up), (back, down) = each
            strands, wind = Strands(sections, (carry, back)), (given.ambient.wind_speed,)
            like = self._kept.once(lambda: Line.of(given, strands, [(), ()]), "like", others, wind)
            return _prepare_line(replace(like, strands=strands), (up, down), acted)

        sets = given.idlers.carry, given.idlers.return_
        return kept.once(made, "line", (*sets, *others), scene)

    def softened(
        self, loaded: Mapping[int, _PreparedLine], before: Mapping[int, Covers]
    ) -> dict[int, Covers | NoAnswer]:
        """Covers of many lines at their working strain; identical ones are one object and share load curves.

        A cover of the step before is kept while its line load is unchanged.
        """
        for i, kept in before.items():
            for strand, cover in kept.items():
                if loaded[i].works[strand].keeps_strain_of(cover):
                    self._running.setdefault(loaded[i].works[strand], cover)
        still = {work for one in loaded.values() if not one.has_curve_loads for work in one.works.values()}
        works = dict.fromkeys(work for one in loaded.values() for work in one.works.values())
        asked = [work for work in works if work not in self._running]
        known = self._kept.covers
        self._running |= {work: one for work in asked if (one := known.pop(work, None)) is not None}
        new = [work for work in asked if work not in self._running]
        tests = [work for theory in self._theories for work in theory.works]
        runs = [[loaded[i].works[strand] for i in run if i in loaded] for run in self._runs for strand in STRANDS]
        unknown = set(new)
        covers, soft = softened_covers(new, tests, [run for run in runs if unknown.issuperset(run)])
        self._running.update(zip(new, covers, strict=True))
        known |= {work: self._running[work] for work in asked if work in still}
        tested = iter(soft)
        for theory in self._theories:
            levels = theory.levels(list(islice(tested, len(theory.works))))
            self._anchors += zip(theory.compounds, repeat(theory.softened), levels, strict=False)
        self._theories = []
        return {
            i: _all_or_error({strand: self._at_level(one, strand) for strand in one.works}) for i, one in loaded.items()
        }

    def _at_level(self, loaded: _PreparedLine, strand: Strand) -> CoverState | NoAnswer:
        """Cover of a strand with the test factor of its compound, if any."""
        work = loaded.works[strand]
        cover = self._running[work]
        known = self._anchors if loaded.uses_rolling_tests else ()
        softened = loaded.line.softened
        anchors = (level for one, how, level in known if one is work.compound and how == softened)
        anchor = next(anchors, None)
        if not isinstance(cover, CoverState) or isinstance(anchor, NoAnswer):
            return anchor if isinstance(anchor, NoAnswer) else cover
        level = None if anchor is None else CoverTestFactor(anchor, work.temperature, work.compound)
        if cover.level == level:
            return cover
        return self._kept.once(lambda: replace(cover, level=level), "level", (cover, anchor))


def _same_object(one: T) -> T:
    return one


def _drag_air_temperature(conveyor: Conveyor) -> float | None:
    """Air temperature at the rolls [K], where their drag depends on it."""
    return conveyor.air_temperature if conveyor.idlers.drag_follows_air else None


def _item_tuple(figures: Mapping[tuple[str, Strand], float]) -> tuple[object, ...]:
    return tuple(figures.items())


def _all_or_error(covers: Mapping[Strand, CoverState | NoAnswer]) -> Covers | NoAnswer:
    """Covers of all strands, or the first error."""
    for cover in covers.values():
        if not isinstance(cover, CoverState):
            return cover
    return {strand: cover for strand, cover in covers.items() if isinstance(cover, CoverState)}


class _ProgressReporter:
    """Reports the progress of a batch; repeated steps never lower it."""

    def __init__(self, variants: int, progress: ProgressCallback | None) -> None:
        self._whole, self._most, self._progress = 2 * variants, 0, progress

    def __call__(self, solved: int, loaded: int) -> None:
        self._most = max(self._most, 2 * solved + loaded)
        if self._progress is not None:
            self._progress(self._most, self._whole)
