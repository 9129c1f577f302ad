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
from conveyor.forces import WithoutRubber, along_the_belt, strand_without_rubber
from conveyor.laws.softening import softened_many
from conveyor.line.anchors import Theory
from conveyor.line.belts import GAUSS, Tensioned, solve_belts
from conveyor.line.contacts import Contacts, RollResult, SolvedCurves, solve_contacts
from conveyor.line.covers import (
    FELT,
    READ_RTOL,
    Covers,
    Level,
    RunningCover,
    StrandAtWork,
    compounds_by_strand,
    covers_of,
    rubbers,
    softened_covers,
    told_apart,
)
from conveyor.line.line import Line
from conveyor.line.roll_drags import StrandDrags, roll_drags_many
from conveyor.line.strands import OneStrand, Strands
from conveyor.line.stretches import STRANDS, Acting, RouteSection, Strand, Stretch, route_sections
from conveyor.loop.balance import Balance, OpenLoop, balances
from conveyor.loop.belt_duty import BeltDuty, belt_duty
from conveyor.loop.curves import Convergence, acting, converged, pulls
from conveyor.loop.drive_duty import DriveDuty, drive_duty
from conveyor.loop.frame import Frame, TakeUpSetting
from conveyor.loop.horizontal import HorizontalCheck, horizontal_checks
from conveyor.loop.pulley_duty import PulleyDuty, pulley_duty
from conveyor.loop.set_duty import SetDuty, set_duty
from conveyor.loop.starting import Motions, every_state, motions
from conveyor.loop.take_up import TakeUpDuty, at_one_setting, take_up_duty
from conveyor.loop.tensions import MotionState
from conveyor.loop.transfer import Cleaning, Landing, Trajectory, cleanings, landings, trajectory
from conveyor.loop.year import Year, year
from conveyor.models import Calculation, Conveyor, RubberCompound
from conveyor.models.belt import Belt
from conveyor.models.fields import KnownParts
from conveyor.rubber.anchor import Anchor
from conveyor.units.sentences import told

Array = NDArray[np.float64]
T = TypeVar("T")
NoAnswer: TypeAlias = NoSolutionError | RangeError | InputError
Progress: TypeAlias = Callable[[int, int], None]
"""Called with the amount done, which never falls, and the total."""
Anchors: TypeAlias = list[tuple[RubberCompound, bool, Anchor | NoAnswer | None]]
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
    cover : RunningCover
        Cover under its rolls.
    rolls : tuple of RollResult
        Rolls of one set, left to right.
    forces : mapping
        Forces by key, as in `Balance.along`.
    main, unit_main : float
        Main resistance, and that which DIN 22101 gives for f = 1.
    """

    stretch: Stretch
    cover: RunningCover
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
    fixed : WithoutRubber
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
    fixed: WithoutRubber
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
    def motor_asked(self) -> float:
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
    def motions(self) -> Motions:
        """Start, coasting, braking, holding; slip limits of the bulk."""
        return motions(self.balance)

    @property
    def every_state(self) -> tuple[MotionState, ...]:
        """Tensions in every state of motion."""
        return every_state(self.balance, self.motions)

    @cached_property
    def take_up(self) -> TakeUpDuty:
        """Setting, mass and travel of the take-up for this load."""
        return take_up_of([self])

    @cached_property
    def belt_duty(self) -> BeltDuty:
        """Safety of the belt, diameters of the pulleys, radii of vertical curves, lengths of transitions."""
        return belt_duty(self.balance, self.every_state)

    @cached_property
    def horizontal(self) -> tuple[HorizontalCheck, ...]:
        """Horizontal curves on both strands: drift in every state, radii, tensions of the edges."""
        return horizontal_checks(self.balance, self.every_state)

    @cached_property
    def pulley_duty(self) -> tuple[PulleyDuty, ...]:
        """Loads of every pulley in every state, its shaft, bearings and lagging."""
        return pulley_duty(self.balance, self.every_state)

    @cached_property
    def drive_duty(self) -> tuple[DriveDuty, ...]:
        """Gear, backstop, brake, starts and sharing of the drives whose parts the spec gives."""
        return drive_duty(self.balance, self.motions)

    @cached_property
    def set_duty(self) -> tuple[SetDuty, ...]:
        """Load, axles, life and flap of the idler sets whose limits the spec gives."""
        return set_duty(self.balance)

    @cached_property
    def landings(self) -> tuple[Landing, ...]:
        """Impact and skirts of every loading point."""
        return landings(self.line)

    @cached_property
    def cleanings(self) -> tuple[Cleaning, ...]:
        """Carryback behind every cleaner."""
        return cleanings(self.line)

    @cached_property
    def trajectory(self) -> Trajectory | None:
        """Trajectory of the bulk over the head pulley, where the spec gives `discharge`."""
        return trajectory(self.line)

    @cached_property
    def year(self) -> Year | None:
        """Annual energy at constant load and its cost; None without hours or with a duty."""
        operation = self.conveyor.operation
        if operation is None or operation.duty:
            return None
        return year(operation, self.balance.power.mains, self.line.flow)

    @property
    def error_estimate(self) -> float:
        """Largest relative error estimate of any roll's indentation [-]."""
        return self.contacts.error


def take_up_of(loads: Sequence[CalculatedConveyor], temperatures: Iterable[float] = ()) -> TakeUpDuty:
    """Setting, mass and travel of the take-up for several loads calculated at one setting.

    The travel covers further `temperatures` of the belt [K], too.
    """
    return take_up_duty(
        [load.balance for load in loads],
        [load.every_state for load in loads],
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
    progress: Progress | None = None,
    *,
    one_take_up: Callable[[CalculatedConveyor], bool] | None = None,
    known: CalculatedConveyor | None = None,
    anchors: Anchors | None = None,
    kept: Kept | None = None,
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
    kept : Kept, optional
        Cache of earlier calls; new parts are added.
    runs : iterable of iterable of int
        Indices of variants that differ in speed alone: their working strain is interpolated among three, where `rtol`
        allows it (`READ_RTOL`).

    Returns
    -------
    list
        Calculations in the order of the variants, or the error of each.

    Raises
    ------
    NoSolutionError
        No setting of the take-up serves all.
    """
    shared = _Shared(known, anchors, rtol, Kept() if kept is None else kept)
    shared.read_among(runs)
    tell = _Told(len(variants), progress)
    shared.anchor(variants)
    made: dict[int, CalculatedConveyor] = {}
    refused: dict[int, NoAnswer] = {}
    going = {i: _Step() for i in range(len(variants))}
    while going:
        loaded: dict[int, _Loaded] = {}
        for i, one in shared.loaded({i: (variants[i], step.acting) for i, step in going.items()}):
            if isinstance(one, _Loaded):
                loaded[i] = one
            else:
                refused[i] = one
            tell(len(variants) - len(going), len(loaded))
        for i, result in _closed(variants, loaded, _solved(shared, loaded, going, rtol)).items():
            if isinstance(result, CalculatedConveyor):
                made[i] = result
            else:
                refused[i] = result
        for i in refused:
            made.pop(i, None)
        if one_take_up is not None:
            asking = list(map(one_take_up, made.values()))
            level = at_one_setting([result.balance for result in made.values()], asking)
            made = {i: replace(made[i], balance=one) for i, one in zip(made, level, strict=True)}
        acted = [i for i in going if i in made and made[i].line.tension_acts]
        again: dict[int, _Step] = {}
        for i in acted:
            try:
                made[i] = result = replace(made[i], convergence=_convergence(made[i], going[i]))
                again[i] = _Step.after(result)
            except NoSolutionError as error:
                refused[i] = error
                del made[i]
        moving = {i for i in again if not _settled(made[i])}
        # one that still moves the common setting moves the tensions of all
        going = again if one_take_up is not None and moving else {i: again[i] for i in moving}
        tell(len(variants) - len(going), 0)
    systems = enumerate(one.conveyor.report.units for one in variants)
    return [told(refused[i], system) if i in refused else made[i] for i, system in systems]


@dataclass(frozen=True, eq=False)
class _Step:
    """Iteration state of a variant: loads on curves, pull of the belt, results of the step before."""

    acting: Acting = field(default_factory=Acting)
    pulls: Array | None = None
    covers: Covers = field(default_factory=dict)
    before: Balance | None = None
    convergence: Convergence | None = None

    @classmethod
    def after(cls, result: CalculatedConveyor) -> _Step:
        """State for the step after a result."""
        line, steady = result.line, result.balance.settled.steady
        held = pulls(line, steady, GAUSS[0]) if line.support == "belt" else None
        covers = result.contacts.covers
        return cls(acting(line, steady), held, covers, result.balance, result.convergence)


@dataclass(frozen=True, eq=False)
class _Loaded:
    """A line prepared for its contacts: loop, forces independent of rubber, loaded covers.

    `acted`: with loads of tension on curves, so that no other variant shares it; `anchored`: test factors apply.
    """

    line: Line
    frame: Frame
    fixed: WithoutRubber
    acted: bool
    works: Mapping[Strand, StrandAtWork] = field(default_factory=dict)
    anchored: bool = False


def anchors_of(conveyor: Conveyor, compounds: Iterable[RubberCompound]) -> Anchors:
    """Test factors of compounds as a conveyor's calculation uses them."""
    levels: Anchors = []
    if _anchored(conveyor.calculation):
        softened = conveyor.calculation.strain != "off"
        for theory in _theories(levels, [(compound, softened) for compound in compounds]):
            found = theory.levels(softened_many(theory.works))
            levels += zip(theory.compounds, repeat(softened), found, strict=False)
    return levels


def _theories(levels: Anchors, asked: Iterable[tuple[RubberCompound, bool]]) -> list[Theory]:
    """Theory at the tests of compounds, softened or not, whose test factors are unknown."""
    new: list[tuple[RubberCompound, bool]] = []
    for one, soft in asked:
        if not any(one is other and soft == how for other, how, *_ in (*levels, *new)):
            new.append((one, soft))
    return [
        Theory([one for one, soft in new if soft == softened], softened=softened)
        for softened in dict.fromkeys(soft for _, soft in new)
    ]


def _anchored(calculation: Calculation) -> bool:
    """True if rolling-resistance tests scale the indentation."""
    return calculation.anchor == "tests" and calculation.support in {"confined", "belt"}


def _strand(
    conveyor: Conveyor, sections: tuple[RouteSection, ...], strand: Strand, on_curves: Acting
) -> tuple[OneStrand, WithoutRubber]:
    """A strand of a conveyor and its forces independent of rubber."""
    made = OneStrand.of(conveyor, sections, strand, on_curves)
    return made, strand_without_rubber(made)


def _loaded(line: Line, fixed: Sequence[WithoutRubber], acted: bool) -> _Loaded:
    """Prepare a line without roll drags and loaded covers."""
    carry, back = fixed
    return _Loaded(line, Frame(line), carry.joined(back), acted)


def _solved(
    shared: _Shared, loaded: Mapping[int, _Loaded], steps: Mapping[int, _Step], rtol: float | None
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
        belts = solve_belts(list(held.values()), [tight[i] for i in held], rtols, shared.tensioned)
        contacts |= dict(zip(held, belts, strict=True))
    return contacts


def _closed(
    variants: Sequence[Variant], loaded: Mapping[int, _Loaded], contacts: Mapping[int, Contacts | NoAnswer]
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Close the loops around the forces of the rolls in one batch."""
    found: dict[int, CalculatedConveyor | NoAnswer] = {}
    open_loops: dict[int, tuple[Contacts, OpenLoop]] = {}
    for i, one in contacts.items():
        try:
            if isinstance(one, Contacts):
                open_loops[i] = one, _open(variants[i], loaded[i], one)
            else:
                found[i] = one
        except InputError as error:
            found[i] = error
    closed = balances([loop for _, loop in open_loops.values()])
    for (i, (rolls, _)), made in zip(open_loops.items(), closed, strict=True):
        at = variants[i]
        found[i] = (
            made
            if isinstance(made, NoSolutionError)
            else CalculatedConveyor(at.conveyor, at.covers_at, rolls, made, loaded[i].fixed)
        )
    return found


def _open(variant: Variant, loaded: _Loaded, contacts: Contacts) -> OpenLoop:
    """Loop with the forces along the belt, to be closed."""
    level = np.repeat([variant.level.get(strand, 1.0) for strand in STRANDS], loaded.line.count)
    along = along_the_belt(
        loaded.line,
        loaded.fixed,
        level * contacts.indentation,
        roll_drag=variant.roll_drag,
        calibration=variant.conveyor.calculation.calibration,
    )
    return OpenLoop.of(loaded.frame, along, float(loaded.fixed.unit_main.sum()), variant.take_up)


def _convergence(result: CalculatedConveyor, step: _Step) -> Convergence | None:
    """Convergence of coupled tensions against the step before; None in the first step."""
    if step.before is None:
        return None
    before, now = step.before.settled.steady, result.balance.settled.steady
    return converged(step.convergence, before, now, result.line, result.balance.tensions.largest)


def _settled(result: CalculatedConveyor) -> bool:
    """True if tensions and roll loads have converged."""
    return result.convergence is not None and result.convergence.settled(result.line.rtol)


_NOTHING: Final[Any] = object()
_RUBBER: Final[Any] = {cover: {"compound"} for cover in ("top_cover", "bottom_cover")}


class _Same:
    """Dictionary key of a spec's part by identity; it keeps the part alive."""

    __slots__ = ("part",)

    def __init__(self, part: object) -> None:
        self.part = part

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.part is other.part

    def __hash__(self) -> int:
        return object.__hash__(self.part)


class Kept:
    """Cache of parts shared by the variants of a spec: strands, lines, covers, load curves.

    Parts of specs are compared by identity: variants come from `replace`, which keeps unchanged parts. Belts that
    differ in rubber alone share strands and lines.
    """

    MOST: Final = 2048
    """Entries of each kind kept between calls, the last used; more than a study over speeds and spacings needs."""

    def __init__(self) -> None:
        self._made: dict[object, Any] = {}
        self.anchors: Anchors = []
        self.covers: dict[StrandAtWork, RunningCover | NoAnswer] = {}
        self.curves: SolvedCurves = {}
        self.drags: dict[tuple[OneStrand, float | None], StrandDrags | InputError] = {}
        self.fields = KnownParts()
        """For `with_fields`: specs of equal changes share their parts."""

    def begin(self) -> None:
        """Drop the least recently used entries beyond `MOST`."""
        every: tuple[dict[Any, Any], ...] = (self._made, self.covers, self.curves, self.drags)
        for known in every:
            for key in list(known)[: max(0, len(known) - self.MOST)]:
                known.pop(key, None)
        if self.fields.full:
            self.fields = KnownParts()

    def forget_solved(self) -> None:
        """Drop batch solutions, whose last digits depend on the batch."""
        self.covers.clear()
        self.curves.clear()

    def once(
        self, make: Callable[[], T], what: str, parts: Iterable[object], values: tuple[object, ...] = ()
    ) -> T:
        """Cached value for the same parts and equal values, made if absent."""
        key = (what, *map(_Same, parts), *values)
        made: T = self._made.pop(key, _NOTHING)
        if made is _NOTHING:
            made = make()
        self._made[key] = made  # at the end are those used last
        return made

    def belt(self, belt: Belt) -> Belt:
        """First belt that differs from `belt` in its rubber alone."""
        said = self.once(lambda: belt.model_dump_json(exclude=_RUBBER), "said", (belt,))
        return self.once(partial(_itself, belt), "belt", (), (said, belt.line_mass))


class _Shared:
    """Parts shared by the variants of one call: lines, rubbers at a temperature, covers at their strain."""

    def __init__(
        self, known: CalculatedConveyor | None, anchors: Anchors | None, rtol: float | None, kept: Kept
    ) -> None:
        kept.begin()
        self._kept, self._own = kept, Kept()
        self._theories: list[Theory] = []
        self._anchors, self._rtol = kept.anchors if anchors is None else anchors, rtol
        self._running: dict[StrandAtWork, RunningCover | NoAnswer] = {}
        self._drags = kept.drags
        self.tensioned: Tensioned = {}
        self._runs: list[list[int]] = []
        self.curves = kept.curves
        if known is not None:
            for strand, compound in compounds_by_strand(known.conveyor).items():
                cover = known.contacts.covers[strand]
                if cover.level is not None:
                    self._anchors.append((compound, known.line.softened, cover.level.anchor))
                work = StrandAtWork(known.line, strand, cover, compound, known.temperature)
                first = kept.once(partial(_itself, work), "alike", (compound,), work.scene)
                self._running[first] = cover

    def read_among(self, runs: Iterable[Iterable[int]]) -> None:
        """Interpolate strains of variants that differ in speed alone, where the tolerance allows."""
        if self._rtol is not None and self._rtol >= READ_RTOL:
            self._runs = [list(run) for run in runs]

    def anchor(self, variants: Iterable[Variant]) -> None:
        """Request the test factors of all compounds; they are solved with the covers of the strands."""
        anchored = [one.conveyor for one in variants if _anchored(one.conveyor.calculation)]
        compounds = ((one, compounds_by_strand(one).values()) for one in anchored)
        asked = [(compound, one.calculation.strain != "off") for one, each in compounds for compound in each]
        self._theories = _theories(self._anchors, asked)

    def loaded(self, asked: Mapping[int, tuple[Variant, Acting]]) -> Iterator[tuple[int, _Loaded | NoAnswer]]:
        """Lines of variants under the loads on their curves, with their covers at small strain.

        An error where the belt lifts off on a concave curve or runs off its rolls on a horizontal one, a compound is
        unknown at the belt's temperature, or a law of roll drag is out of range at a load.
        """
        still: dict[int, _Loaded | NoAnswer] = {}
        for i, (variant, on_curves) in asked.items():
            try:
                still[i] = self._still(variant.conveyor, on_curves)
            except (NoSolutionError, RangeError, InputError) as error:
                still[i] = error
        self._drag([(asked[i][0].conveyor, one) for i, one in still.items() if isinstance(one, _Loaded)])
        for i, one in still.items():
            try:
                yield i, self._in_air(asked[i][0], one) if isinstance(one, _Loaded) else one
            except (NoSolutionError, RangeError, InputError) as error:
                yield i, error

    def _drag(self, lines: Iterable[tuple[Conveyor, _Loaded]]) -> None:
        """Calculate the unknown drags of all rolls in one batch."""
        asked = {(one, _air(given)): (given, one) for given, line in lines for one in line.line.strands.each}
        new = {key: pair for key, pair in asked.items() if key not in self._drags}
        self._drags.update(zip(new, roll_drags_many(list(new.values())), strict=True))

    def _in_air(self, variant: Variant, still: _Loaded) -> _Loaded:
        """Line with the drags of its rolls and its covers at small strain."""
        given, at = variant.conveyor, variant.covers_at
        compounds = compounds_by_strand(given)
        rubber = rubbers(given, lambda one: self._kept.once(partial(one.series, at), "series", (one,), (at,)))
        gives = given.calculation.support == "belt"
        acted = self._own if still.acted else self._kept
        running = acted.once(partial(self._dragged, still, _air(given)), "in air", (still,), (_air(given),))
        rtol = running.line.rtol if self._rtol is None else self._rtol
        works = {
            strand: acted.once(
                partial(self._worked, StrandAtWork(running.line, strand, cover, compounds[strand], at), rtol),
                "work",
                (running.line, cover.rubber, compounds[strand], *((cover.other[1],) if gives else ())),
                (strand, at, rtol),
            )
            for strand, cover in covers_of(given, rubber).items()
        }
        return replace(running, works=works, anchored=_anchored(given.calculation))

    def _dragged(self, still: _Loaded, air: float | None) -> _Loaded:
        """Line with the drags of its rolls in air of a temperature [K]."""
        drags: list[tuple[float, ...]] = []
        for strand in still.line.strands.each:
            one = self._drags[strand, air]
            if isinstance(one, InputError):
                raise one
            drags += one
        line = replace(still.line, roll_drags=tuple(drags))
        return replace(still, line=line, frame=still.frame.of(line))

    def _worked(self, work: StrandAtWork, rtol: float) -> StrandAtWork:
        """First strand that loads its cover identically, with unresolved relaxation terms merged."""
        felt = self._felt(work, rtol)
        return self._kept.once(partial(_itself, felt), "alike", (work.compound,), felt.scene)

    def _felt(self, work: StrandAtWork, rtol: float) -> StrandAtWork:
        """Merge relaxation terms that the rolls of a strand cannot resolve."""
        times = told_apart(work, rtol)
        if times is None:
            return work
        rubber, (fastest, slowest) = work.cover.rubber, times
        cut = tuple(rubber.times.searchsorted(times).tolist())
        less = self._kept.once(
            lambda: rubber.merged(fastest=fastest, slowest=slowest), "merged", (rubber,), cut
        )
        return replace(work, cover=replace(work.cover, rubber=less, merged=2.0 * FELT * rtol))

    def _still(self, given: Conveyor, on_curves: Acting) -> _Loaded:
        """Line of a spec without roll drags."""
        acted = on_curves != Acting()
        kept, belt = self._own if acted else self._kept, self._kept.belt(given.belt)
        others = (belt, given.material, given.route, given.drive, given.calculation, given.report)
        scene = (*map(_in_order, vars(on_curves).values()), given.ambient.wind_speed, given.site)

        def made() -> _Loaded:
            """Build the line; specs of equal belt, load and idlers share strands."""
            sections = self._kept.once(lambda: route_sections(given), "sections", (given.route,))
            each = []
            for strand, own in zip(STRANDS, sets, strict=True):
                parts = (belt, own, given.material, given.route, given.calculation)
                laid = partial(_strand, given, sections, strand, on_curves)
                each.append(kept.once(laid, "strand", parts, (strand, *scene)))
            (carry, up), (back, down) = each
            strands, wind = Strands(sections, (carry, back)), (given.ambient.wind_speed,)
            like = self._kept.once(lambda: Line.of(given, strands, [(), ()]), "like", others, wind)
            return _loaded(replace(like, strands=strands), (up, down), acted)

        sets = given.idlers.carry, given.idlers.return_
        return kept.once(made, "line", (*sets, *others), scene)

    def softened(
        self, loaded: Mapping[int, _Loaded], before: Mapping[int, Covers]
    ) -> dict[int, Covers | NoAnswer]:
        """Covers of many lines at their working strain; identical ones are one object and share load curves.

        A cover of the step before is kept while its line load is unchanged.
        """
        for i, kept in before.items():
            for strand, cover in kept.items():
                if loaded[i].works[strand].still_at(cover):
                    self._running.setdefault(loaded[i].works[strand], cover)
        still = {work for one in loaded.values() if not one.acted for work in one.works.values()}
        works = dict.fromkeys(work for one in loaded.values() for work in one.works.values())
        asked = [work for work in works if work not in self._running]
        known = self._kept.covers
        self._running |= {work: one for work in asked if (one := known.pop(work, None)) is not None}
        new = [work for work in asked if work not in self._running]
        tests = [work for theory in self._theories for work in theory.works]
        runs = [
            [loaded[i].works[strand] for i in run if i in loaded] for run in self._runs for strand in STRANDS
        ]
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
            i: _together({strand: self._at_level(one, strand) for strand in one.works})
            for i, one in loaded.items()
        }

    def _at_level(self, loaded: _Loaded, strand: Strand) -> RunningCover | NoAnswer:
        """Cover of a strand with the test factor of its compound, if any."""
        work = loaded.works[strand]
        cover = self._running[work]
        known = self._anchors if loaded.anchored else ()
        softened = loaded.line.softened
        anchors = (level for one, how, level in known if one is work.compound and how == softened)
        anchor = next(anchors, None)
        if not isinstance(cover, RunningCover) or isinstance(anchor, NoAnswer):
            return anchor if isinstance(anchor, NoAnswer) else cover
        level = None if anchor is None else Level(anchor, work.temperature, work.compound)
        if cover.level == level:
            return cover
        return self._kept.once(lambda: replace(cover, level=level), "level", (cover, anchor))


def _itself(one: T) -> T:
    return one


def _air(conveyor: Conveyor) -> float | None:
    """Air temperature at the rolls [K], where their drag depends on it."""
    return conveyor.air_temperature if conveyor.idlers.drag_follows_air else None


def _in_order(figures: Mapping[tuple[str, Strand], float]) -> tuple[object, ...]:
    return tuple(figures.items())


def _together(covers: Mapping[Strand, RunningCover | NoAnswer]) -> Covers | NoAnswer:
    """Covers of all strands, or the first error."""
    for cover in covers.values():
        if not isinstance(cover, RunningCover):
            return cover
    return {strand: cover for strand, cover in covers.items() if isinstance(cover, RunningCover)}


class _Told:
    """Reports the progress of a batch; repeated steps never lower it."""

    def __init__(self, variants: int, progress: Progress | None) -> None:
        self._whole, self._most, self._progress = 2 * variants, 0, progress

    def __call__(self, solved: int, loaded: int) -> None:
        self._most = max(self._most, 2 * solved + loaded)
        if self._progress is not None:
            self._progress(self._most, self._whole)
