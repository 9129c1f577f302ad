"""Parts of a candidate: drives, belt, take-up, brakes, sized by exact calculations until all criteria are met."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant, common_take_up_duty
from conveyor.checks import run_checks
from conveyor.checks.drive_checks import motor_power
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.laws.belt_strength import RATED_START
from conveyor.laws.drives import next_preferred_number
from conveyor.loop.equilibrium import tension_suffices
from conveyor.loop.take_up_duty import at_common_setting
from conveyor.models import Conveyor
from conveyor.pipeline import calculate_many
from conveyor.sizing.design_choice import CarcassClass, DesignChoice, SelectedParts, TakeUpPlace
from conveyor.sizing.design_spec import SHAFT_STEEL, built_choice, design_spec, drive_diameter
from conveyor.sizing.listed_drives import HoldingDemand, select_listed_parts
from conveyor.sizing.screen import Limit
from conveyor.sizing.sized_design import Shortfall, SizedDesign, highest_tension
from conveyor.sizing.sizing_task import SizingTask
from conveyor.studies.costs import conveyor_costs, conveyor_parts, roll_life
from conveyor.studies.loads import EveryLoad
from conveyor.studies.one_take_up import at_one_take_up
from conveyor.studies.states import load_states
from conveyor.units.sentences import escape_braces, message

RTOL: Final = 1e-4
"""Of the contacts, as in studies."""


BRAKE_RESERVE: Final = 1.3
"""Brake force, or torque of a backstop, over that to hold the loaded belt; general knowledge."""


_SIZINGS: Final = 8  # rounds of belt class, motors and brake against their own tensions


LIMIT_MESSAGES: Final[Mapping[Limit, str]] = {
    "belt strength": "its tension asks for a belt of {}, the strongest of the series has {}: allow further drives or "
    "carcasses (rules.drives, rules.carcasses), or split the conveyor",
    "motor power": "a drive pulley needs motors of {}, one may have {}: allow further or larger motors, or further "
    "pulleys (rules.motors_per_pulley, rules.largest_motor, rules.drives), or split the conveyor",
    "take-up travel": "its take-up needs {} of travel, {} are allowed: allow a longer one or steel cord "
    "(rules.take_up_travel, rules.carcasses)",
    "bearings": "the bearings of its idler sets reach an L10 of {}, {} are asked: allow closer sets or a shorter life "
    "(rules.carry_spacings, rules.return_spacings, rules.roll_life)",
    "set rating": "its idler sets bear {}, their class is rated for {}: allow closer sets (rules.carry_spacings)",
}
"""Message of each limit, with the remedy."""


_CURES: Final = {
    "bulk_slip_start": "a softer start (rules.start_factor) or less slope",
    "bulk_slip_stopping": "less slope or a longer conveyor",
    "bulk_slip": "less slope",
    "curve_radius": "a larger radius on the route",
}
"""Remedies in the duty for checks that no choice of parts can meet, by key."""


def size_parts(
    task: SizingTask,
    begin: Sequence[tuple[DesignChoice, SelectedParts, float]],
    *,
    every_load: bool = False,
    made: Sequence[SizedDesign] = (),
) -> list[SizedDesign | Shortfall]:
    """Size class, motors, brake and take-up of candidates by their own calculated tensions.

    Both at the lowest temperature and at that of the duty: less friction needs a larger backstop or brake.

    Parameters
    ----------
    task : SizingTask
        The duty.
    begin : sequence of (DesignChoice, SelectedParts, float)
        Candidates, initial class and motors, yearly cost by the estimate.
    every_load : bool
        True to include empty, inclines only, declines only and the worst loadings, not the full belt alone.
    made : sequence of SizedDesign
        The same candidates as designs for the full belt, whose results are reused.
    """
    now = dict[int, SelectedParts]()
    answers: dict[int, SizedDesign | Shortfall] = {}
    for i, (choice, chosen, _) in enumerate(begin):
        first = select_listed_parts(task, choice, chosen, HoldingDemand())
        if isinstance(first, Shortfall):
            answers[i] = first
        else:
            now[i] = first
    both = set(now) if every_load and task.cold else set[int]()  # calculated at both temperatures
    for _ in range(_SIZINGS):
        specs, refused = candidate_specs(task, {i: (begin[i][0], chosen) for i, chosen in now.items()})
        answers |= refused
        alike = {i: made[i] for i in specs if made and now[i] == made[i].chosen}
        coldest = {i: task.colder(spec) for i, spec in specs.items()}
        known = {i: one.found for i, one in alike.items()}
        cold = calculate_specs(coldest, {i: one.coldest for i, one in alike.items()})
        warm = calculate_specs({i: spec for i, spec in specs.items() if i in both}, known)
        asked = _required_parts(task, begin, now, cold, warm, every_load=every_load)
        late = {i for i, one in asked.items() if task.cold and i not in both and one.settles(now[i])}
        warm = calculate_specs({i: specs[i] for i in late}, {})
        asked |= _required_parts(task, begin, now, {i: cold[i] for i in late}, warm, every_load=every_load)
        both |= late
        answers |= {i: one.short for i, one in asked.items() if one.short is not None}
        again = {}
        for i, one in asked.items():
            if one.settles(now[i]):
                answers[i] = _design_or_shortfall(task, begin[i], now[i], one)
            elif one.chosen is not None:
                again[i] = one.chosen
        now = again
        if not now:
            break
    unsettled = Shortfall("parts do not settle", message("belt class and motors do not settle"), math.inf, {})
    return [answers.get(i, unsettled) for i in range(len(begin))]


@dataclass(frozen=True, eq=False)
class _RequiredParts:
    """Parts required by the loads of a candidate, those at the lowest temperature first, or the shortfall."""

    cold: tuple[CalculatedConveyor, ...] = ()
    warm: tuple[CalculatedConveyor, ...] = ()
    chosen: SelectedParts | None = None
    uses: Mapping[Limit, float] = field(default_factory=dict)
    short: Shortfall | None = None

    @property
    def loads(self) -> tuple[CalculatedConveyor, ...]:
        """All loads."""
        return self.cold + self.warm

    def settles(self, now: SelectedParts) -> bool:
        """True if the required parts are those used in the calculation."""
        return self.chosen is not None and replace(self.chosen, settling=now.settling) == now


def _required_parts(
    task: SizingTask,
    begin: Sequence[tuple[DesignChoice, SelectedParts, float]],
    now: Mapping[int, SelectedParts],
    cold: Mapping[int, CalculatedConveyor | NoAnswer],
    warm: Mapping[int, CalculatedConveyor | NoAnswer],
    *,
    every_load: bool,
) -> dict[int, _RequiredParts]:
    """Parts required by candidates calculated at the lowest temperature, and some at that of the duty."""
    asked = {}
    for i, answer in cold.items():
        try:
            loads = _design_loads(answer, every_load=every_load)
            milder = _design_loads(warm[i], every_load=every_load) if i in warm else ()
            loads, milder = _at_one_weight(loads, milder)
        except (NoSolutionError, RangeError, InputError) as error:
            asked[i] = _RequiredParts(short=_without_answer(error))
            continue
        asked[i] = _select_parts(task, begin[i][0], now[i], _RequiredParts(loads, milder), every_load=every_load)
    return asked


def _at_one_weight(
    cold: tuple[CalculatedConveyor, ...], warm: tuple[CalculatedConveyor, ...]
) -> tuple[tuple[CalculatedConveyor, ...], tuple[CalculatedConveyor, ...]]:
    """Loads of both temperatures with the one take-up that suits them all, which is that of the spec if it has one."""
    if not warm:
        return cold, warm
    loads = (*warm, *cold)
    closed = at_common_setting([one.balance for one in loads])
    made = tuple(replace(one, balance=balance) for one, balance in zip(loads, closed, strict=True))
    return made[len(warm) :], made[: len(warm)]


def _without_answer(error: NoAnswer) -> Shortfall:
    return Shortfall(str(error), message(escape_braces(str(error))), math.inf, {})


def candidate_specs(
    task: SizingTask, now: Mapping[int, tuple[DesignChoice, SelectedParts]]
) -> tuple[dict[int, Conveyor], dict[int, Shortfall]]:
    """Specs of candidates with their present parts, and the shortfalls of those without one."""
    specs, refused = dict[int, Conveyor](), dict[int, Shortfall]()
    for i, (choice, chosen) in now.items():
        try:
            specs[i] = design_spec(task, choice, chosen, task.duty.name)
        except InputError as error:
            refused[i] = _without_answer(error)
    return specs, refused


def calculate_specs(
    specs: Mapping[int, Conveyor], known: Mapping[int, CalculatedConveyor]
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Calculate specs, unknown ones in one batch."""
    new = {i: Variant(spec) for i, spec in specs.items() if i not in known}
    return {**known, **dict(zip(new, calculate_many(list(new.values()), RTOL), strict=True))}


def _design_loads(answer: CalculatedConveyor | NoAnswer, *, every_load: bool) -> tuple[CalculatedConveyor, ...]:
    """The full belt, and every other load at one take-up setting if requested.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        It has no answer.
    """
    if not isinstance(answer, CalculatedConveyor):
        raise answer
    if not every_load:
        return (answer,)
    return EveryLoad(*at_one_take_up(load_states(answer.conveyor, answer), None)).designing


def _select_parts(
    task: SizingTask, choice: DesignChoice, before: SelectedParts, asked: _RequiredParts, *, every_load: bool
) -> _RequiredParts:
    """Select the parts required by the calculated tensions, or the limit that the series cannot meet.

    After the first round no weaker class is taken, so that sizing ends. A backstop affects neither cost nor tensions:
    it is selected only with every load.
    """
    loads = asked.loads
    classes, last = task.carcasses[choice.kind], task.carcasses[choice.kind][-1]
    strength, travel = (
        partial(_required_strength, choice=choice, loads=loads),
        _take_up_travel(before.carcass, loads),
    )
    power, rated = _required_power(task, loads), task.largest_drive
    uses: dict[Limit, float] = {
        "belt strength": strength(last) / last.strength,
        "motor power": power * task.rules.motor_reserve / rated,
        "take-up travel": travel(last) / task.take_up_travel,
    }
    asked = replace(asked, uses=uses)
    if max(uses.values()) > 1.0:
        limit = max(uses, key=uses.__getitem__)
        figures = {
            "belt strength": ((strength(last), "belt strength"), (last.strength, "belt strength")),
            "motor power": ((power * task.rules.motor_reserve, "power"), (rated, "power")),
            "take-up travel": ((travel(last), "length"), (task.take_up_travel, "length")),
        }[limit]
        return replace(asked, short=Shortfall(limit, message(LIMIT_MESSAGES[limit], *figures), uses[limit], uses))
    carcass = next(one for one in classes if strength(one) <= one.strength and travel(one) <= task.take_up_travel)
    if before.settling and carcass.strength < before.carcass.strength:
        carcass = before.carcass
    motor = task.motors(power)
    brake = max((0.0 if one.motions.rolls_back else one.motions.brake_to_hold) for one in loads)
    held = BRAKE_RESERVE * brake
    brake = 0.0 if brake <= 0.0 else max(before.brake, held)
    if before.brake > 0.0 and brake <= before.brake * (1.0 + RTOL):
        brake = before.brake
    shafts = _required_shafts(task, choice, before, loads) if every_load or before.shafts else ()
    diameter = drive_diameter(task, replace(before, carcass=carcass, shafts=shafts))
    backstop = max(before.backstop, _backstop_torque(diameter, loads)) if every_load else before.backstop
    chosen = SelectedParts(
        carcass, *task.covers(choice, carcass), (motor,) * len(before.motors), brake, backstop,
        _take_up_setting(task, before.take_up, loads, written=every_load and task.cold),
        _take_up_place(choice, before.take_up_place, loads), before.listed, settling=True, shafts=shafts,
    )  # fmt: skip
    made = select_listed_parts(task, choice, chosen, _holding_demand(loads, held, every_load=every_load), loads)
    return replace(asked, short=made) if isinstance(made, Shortfall) else replace(asked, chosen=made)


def _holding_demand(loads: Sequence[CalculatedConveyor], brake: float, *, every_load: bool) -> HoldingDemand:
    """Demands of the loads on a backstop, with every load only, and on a brake whose force is given [N]."""
    duties = [one.drive_duty[0] for one in loads if one.drive_duty]
    return HoldingDemand(
        BRAKE_RESERVE * _rolling_back(loads) if every_load else 0.0,
        brake,
        max((duty.stalled or 0.0 for duty in duties), default=0.0),
        max((duty.heat or 0.0 for duty in duties), default=0.0),
    )


def _rolling_back(loads: Iterable[CalculatedConveyor]) -> float:
    """Force that holds the belt where it rolls back, of all loads [N]."""
    return max((one.motions.brake_to_hold if one.motions.rolls_back else 0.0) for one in loads)


def _backstop_torque(diameter: float, loads: Iterable[CalculatedConveyor]) -> float:
    """Torque of the next preferred backstop for all loads, with a reserve [N m]; 0 if none rolls back."""
    torque = BRAKE_RESERVE * _rolling_back(loads) * 0.5 * diameter
    return next_preferred_number(torque) if torque > 0.0 else 0.0


def _required_shafts(
    task: SizingTask, choice: DesignChoice, before: SelectedParts, loads: Iterable[CalculatedConveyor]
) -> tuple[float, ...]:
    """Shaft of every pulley by stress and slope in every state of all loads [m]; after the first round none thinner.

    None of listed pulleys: they have their own.
    """
    if before.listed is not None and before.listed.pulleys:
        return ()
    bearings, hubs = task.pulleys.shaft_distances(choice.trough.width)
    least: dict[str, float] = {}
    for duty in (duty for one in loads for duty in one.pulley_duty):
        placed = replace(duty.pulley, bearing_centres=bearings, hub_centres=hubs, shaft_steel=SHAFT_STEEL)
        borne = replace(duty, pulley=placed).least_shaft or 0.0
        least[duty.pulley.name] = max(borne, least.get(duty.pulley.name, 0.0))
    needed = tuple(map(task.pulleys.shaft_diameter, least.values()))
    return tuple(map(max, needed, before.shafts)) if before.settling and before.shafts else needed


def _take_up_setting(task: SizingTask, before: float, loads: Sequence[CalculatedConveyor], *, written: bool) -> float:
    """Take-up tension for grip, sag and a taut belt in every state of motion of all loads [N].

    0 if that for grip and sag keeps the belt taut, unless it is to be written.
    """
    slack = [max(-state.smallest for state in one.motion_states) for one in loads]
    if max(slack) <= 0.0 and before == 0.0 and not written:
        return 0.0
    needed = max(
        max(one.balance.equilibrium.needed, one.balance.equilibrium.setting + lacking if lacking > 0.0 else 0.0)
        for one, lacking in zip(loads, slack, strict=True)
    )
    return before if tension_suffices(before, needed) else _take_up_on_step(task, needed)


def _take_up_on_step(task: SizingTask, needed: float) -> float:
    """The next take-up tension on its step [N]."""
    return task.take_up_step * math.ceil(needed / task.take_up_step)


def _take_up_place(choice: DesignChoice, before: TakeUpPlace, loads: Sequence[CalculatedConveyor]) -> TakeUpPlace:
    """Place of the take-up: its bends stand in the return strand, also where the slack side is the carry strand."""
    at_tail = choice.drives == "tail"
    if before == "drive" and any(one.balance.equilibrium.take_up.behind is at_tail for one in loads):
        return "tail end" if at_tail else "head end"
    return before


def _required_strength(carcass: CarcassClass, choice: DesignChoice, loads: Sequence[CalculatedConveyor]) -> float:
    """Belt strength required by the tensions in steady running, starting and stopping [N/m]."""
    tension = max(highest_tension(loads), max(one.belt_duty.largest for one in loads) / RATED_START)
    return carcass.safety * tension / choice.trough.width.belt


def _take_up_travel(now: CarcassClass, loads: Sequence[CalculatedConveyor]) -> Callable[[CarcassClass], float]:
    """Take-up travel as a function of the belt class [m], by Hooke at the calculated tensions."""
    duty = common_take_up_duty(loads)
    parts = duty.travel
    if parts is None:
        raise AssertionError("every belt of the series has a usual stiffness")
    elastic = parts.tensioning + parts.load + parts.motion
    lasting = parts.permanent + parts.temperature
    return lambda one: (1.0 + duty.unit.reserve) * (elastic * now.stiffness / one.stiffness + lasting)


def _required_power(task: SizingTask, loads: Sequence[CalculatedConveyor]) -> float:
    """Power required of each drive [W]: its share at both ends of the friction band, by the basis, and for breakaway.

    Breakaway may use the rated power itself, so that its reserve is taken off.
    """
    running = max(power for one in loads for power in (*_drive_powers(one), *_powers_by_basis(task, one)))
    starts = [(one, one.motions.design_start) for one in loads]
    stuck = max(
        (start.breakaway * one.line.speed / (one.line.efficiency * len(one.line.drives))
         for one, start in starts if 0.0 < start.force < start.breakaway),
        default=0.0,
    )  # fmt: skip
    return max(running, stuck / task.rules.motor_reserve)


def foresee_parts(task: SizingTask, design: SizedDesign) -> SelectedParts:
    """Likely class and motors for the worst loading, so that the loads mostly need only one calculation.

    Bulk is left out where the belt alone needs more force; its friction is taken as proportional to the load.
    """
    one, chosen = design.coldest, design.chosen
    steady = one.balance.forces.total
    if steady <= 0.0:
        return chosen
    more = 0.0
    for of in one.stretches[: one.line.count]:
        bulk = of.stretch.bulk_mass / of.stretch.line_mass
        more += max(0.0, -bulk * (of.total - of.forces.get("idler_rotation", 0.0)))
    motor = task.motors(
        min(max(_drive_powers(one)) * (1.0 + more / steady), task.largest_drive / task.rules.motor_reserve)
    )
    strength = (highest_tension([one]) + more) / design.choice.trough.width.belt
    carcass = next(
        (
            each
            for each in task.carcasses[design.choice.kind]
            if max(each.safety * strength, chosen.carcass.strength) <= each.strength
        ),
        chosen.carcass,
    )
    top, bottom = task.covers(design.choice, carcass)
    motors = (max(motor, *chosen.motors),) * len(chosen.motors)
    backstop = chosen.backstop if task.duty.listed.items("backstops") else _backstop_torque(
        drive_diameter(task, replace(chosen, carcass=carcass)), design.pair
    )  # fmt: skip
    setting = max(one.balance.equilibrium.setting for one in design.pair)
    return replace(
        chosen, carcass=carcass, top=top, bottom=bottom, motors=motors, backstop=backstop, settling=False,
        take_up=_take_up_on_step(task, setting) if task.cold else chosen.take_up,
        shafts=_required_shafts(task, design.choice, replace(chosen, settling=False), design.pair),
    )  # fmt: skip


def _drive_powers(one: CalculatedConveyor) -> list[float]:
    """Highest power of every drive with the friction at both ends of its band [W]."""
    return [check.calculated or 0.0 for check in motor_power(one)]


def _powers_by_basis(task: SizingTask, one: CalculatedConveyor) -> Iterator[float]:
    """Power of every drive by the classical method of the rules [W]; none by the rolling contact."""
    balance, basis = one.balance, task.rules.basis
    estimate = balance.cema if basis == "cema classic" else balance.classical
    if basis != "viscoelastic" and estimate is not None:
        whole = balance.layout.shaft_power(estimate.motor_force)
        yield from (abs(drive.share * whole) for drive in one.line.drives)


def _design_or_shortfall(
    task: SizingTask,
    begin: tuple[DesignChoice, SelectedParts, float],
    chosen: SelectedParts,
    asked: _RequiredParts,
) -> SizedDesign | Shortfall:
    """The design, or its first failure."""
    failed = next(_failed_criteria(task, asked), None)
    if failed is not None:
        return failed
    choice, _, estimate = begin
    if asked.chosen is not None:
        chosen = replace(chosen, listed=asked.chosen.listed)  # with what all loads ask of its items
    result = (asked.warm or asked.cold)[0]
    energy = 0.0 if result.year is None or result.year.cost is None else result.year.cost
    parts = conveyor_parts(result)
    if parts is None:
        raise AssertionError("a sized spec lists its parts")
    cost = conveyor_costs(parts, task.duty.prices.amounts, seconds=task.seconds, energy=energy)
    life = roll_life(result)
    built = built_choice(task, choice, chosen)
    return SizedDesign(built, chosen, result, asked.cold[0], cost, estimate, life, asked.uses)


def _failed_criteria(task: SizingTask, asked: _RequiredParts) -> Iterator[Shortfall]:
    """Criteria that fail under a load; penetration and rubber data only give warnings in the report."""
    for one in asked.loads:
        for check in run_checks(one, contacts=False):
            if check.failed:
                why = check.why or message(
                    f"{check.name.words}: {check.found.words}", *check.name.figures, *check.found.figures
                )
                if check.key in _CURES:
                    why = replace(why, words=f"{why.words}: {_CURES[check.key]}")
                yield Shortfall(check.subject.text("SI"), why, check.use or math.inf, asked.uses)
        life = roll_life(one)
        if life < task.roll_life:
            figures = (life, "duration"), (task.roll_life, "duration")
            yield Shortfall(
                "bearings", message(LIMIT_MESSAGES["bearings"], *figures), task.roll_life / life, asked.uses
            )
    travel = common_take_up_duty(asked.loads).travel
    if travel is not None and travel.whole > task.take_up_travel:
        figures = (travel.whole, "length"), (task.take_up_travel, "length")
        over = travel.whole / task.take_up_travel
        yield Shortfall("take-up travel", message(LIMIT_MESSAGES["take-up travel"], *figures), over, asked.uses)
