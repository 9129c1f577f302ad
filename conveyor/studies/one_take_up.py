"""Load states and cases at the one take-up setting that suits them all, with the loadings that govern a criterion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.checks import Check, run_checks, severity_rank
from conveyor.errors import NoSolutionError
from conveyor.line.bend_pulleys import name_pulley
from conveyor.loop.balance import Balance, close_loops, with_take_up_at
from conveyor.loop.load_superposition import Loading
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.loop.take_up_duty import at_common_setting
from conveyor.loop.worst_loadings import CriterionLoadings
from conveyor.models.cases import STANDARD_LOADINGS
from conveyor.pipeline import calculate_many
from conveyor.studies.load_cases import (
    AS_GIVEN,
    CalculatedCases,
    Load,
    governing_figures,
    motor_start_force,
    with_motors,
)
from conveyor.studies.states import CalculatedStates, LoadState, StateRefusal, load_states, loaded_sections, worst_key
from conveyor.units.sentences import message

_ROUNDS: Final = 20  # of reloading the rolls; each changes the tensions by a hundredth of the last change
_NAMING_FIGURES: Final = 2  # figures in the name of a state
_FIGURE_RANK: Final = 3  # rank of figures that are no criteria: behind unchecked ones
_DIGITS: Final = 9  # of figures: values that differ by rounding are equal
Rank = tuple[int, float, float]
"""Rank of a check, as returned by `severity_rank`."""


def at_one_take_up(
    states: CalculatedStates, cases: CalculatedCases | None
) -> tuple[CalculatedStates, CalculatedCases | None]:
    """The same loads at the least take-up setting that suits the load states too; a given setting is kept.

    Cases outside the rubber's data are at the setting but do not determine it. Loadings that govern a criterion at that
    setting become load states. Where tension loads the rolls, loads are recalculated until setting and rolls agree.

    Parameters
    ----------
    states : CalculatedStates
        Load states, with the spec's own load.
    cases : CalculatedCases or None
        Load cases at the same setting.

    Raises
    ------
    NoSolutionError
        No setting suits every load, or a load has no answer at it.
    """
    states, cases = _at_one_setting(states, cases)
    for _ in range(_ROUNDS):
        before = states.setting
        states, cases = _at_one_setting(_with_candidates(states, cases), cases)
        if math.isclose(before, states.setting, rel_tol=states.own.line.rtol):
            states, cases = _with_motors(states, cases)
            return _governing_only(states, cases), cases
    raise NoSolutionError("the setting of the take-up and the loadings that ask for it do not settle")


def _at_one_setting(
    states: CalculatedStates, cases: CalculatedCases | None
) -> tuple[CalculatedStates, CalculatedCases | None]:
    """Every load at one take-up setting."""
    if states.own.line.take_up.tension is not None:
        return states, cases
    for _ in range(_ROUNDS):
        before, results = states.own, () if cases is None else cases.results
        loads = [before.balance, *(result.found.balance for result in results)]
        asking = [True, *(result.covered for result in results), *(True for _ in states.states)]
        own, *closed = at_common_setting([*loads, *(state.balance for state in states.states)], asking)
        found = [replace(r.found, balance=one) for r, one in zip(results, closed, strict=False)]
        as_given, setting = replace(before, balance=own), own.equilibrium.setting
        near = math.isclose(before.balance.equilibrium.setting, setting, rel_tol=before.line.rtol)
        if before.line.has_tension_coupling and not near:
            as_given, *found = _reload_rolls([as_given, *found], own.equilibrium.take_up)
        if cases is not None:
            every = tuple(replace(r, found=one) for r, one in zip(results, found, strict=True))
            cases = replace(cases, results=every, as_given=as_given)
        if near or not before.line.has_tension_coupling:
            pairs = zip(states.states, closed[len(results) :], strict=True)
            moved = (replace(s, balance=own if s.balance is before.balance else one) for s, one in pairs)
            return replace(states, own=as_given, states=tuple(moved)), cases
        states = load_states(before.conveyor, as_given, cases)
    raise NoSolutionError("the setting of the take-up and what it does to the rolls do not settle")


def _with_motors(
    states: CalculatedStates, cases: CalculatedCases | None
) -> tuple[CalculatedStates, CalculatedCases | None]:
    """Loads with the starting force of motors without a given power."""
    of_states = [states.own, *(load.found for load in states.loads)]
    of_cases = [] if cases is None else [result.found for result in cases.designing]
    own = replace(states.own, start_of_motors=motor_start_force([*of_states, *of_cases]))
    return replace(states, own=own), None if cases is None else with_motors(cases, of_states)


def _with_candidates(states: CalculatedStates, cases: CalculatedCases | None) -> CalculatedStates:
    """States extended by the loadings that are worst for a figure of the criteria at any temperature."""
    own = states.own
    ends = iter(with_take_up_at([loop for _, *pair in states.ends for loop in pair], states.take_up))
    looked_at = {temperature: CriterionLoadings(next(ends), next(ends)) for temperature, *_ in states.ends}
    worst: dict[str, tuple[float, float, Loading]] = {}
    for temperature, loadings in looked_at.items():
        for figure, (value, loading) in loadings.worst_of_each().items():
            if figure not in worst or value > worst[figure][0]:
                worst[figure] = (value, temperature, loading)
    there = _existing_loadings(states, cases)
    wanted = {
        (temperature, loaded_sections(own, loading)): (figure, loading)
        for figure, (_, temperature, loading) in worst.items()
        if (temperature, loaded_sections(own, loading)) not in there
    }
    loops = close_loops([looked_at[at].open_loop(loading) for (at, _), (_, loading) in wanted.items()])
    candidates, refused = [], []
    for ((at, loaded), (figure, _)), loop in zip(wanted.items(), loops, strict=True):
        if isinstance(loop, Balance):
            candidates.append(LoadState(figure, loaded, at, (figure,), (), loop))
        else:
            refused.append(StateRefusal(f"worst for {figure}", at, str(loop)))
    standing = tuple(state for state in states.states if state.keys)
    return replace(states, states=(*standing, *candidates), refused=(*states.refused, *refused))


def _existing_loadings(states: CalculatedStates, cases: CalculatedCases | None) -> set[tuple[float, tuple[str, ...]]]:
    """Temperature and loaded sections of every load calculated at the spec's speed and full cross-section."""
    there = {(state.temperature, state.loaded) for state in states.states if state.keys}
    for result in () if cases is None else cases.designing:
        own_way = result.speed == states.own.line.speed and not result.case.reversed
        if own_way and result.case.loading in STANDARD_LOADINGS:
            stretches = result.found.line.stretches[: result.found.line.count]
            there.add((result.temperature, tuple(s.section for s in stretches if s.bulk_mass > 0.0)))
    return there


def _governing_only(states: CalculatedStates, cases: CalculatedCases | None) -> CalculatedStates:
    """States with only those candidates that govern a criterion or a figure, each named by it."""
    own, of_cases = states.own, () if cases is None else cases.designing
    fixed = [state for state in states.states if state.keys]
    candidates = [state for state in states.states if not state.keys]
    of_states = []
    for state in (*fixed, *candidates):
        found = states.load(state).found
        checks = () if state.balance is own.balance else run_checks(found, contacts=False)
        of_states.append(replace(state, found=found, checked=checks))
    fixed, candidates = of_states[: len(fixed)], of_states[len(fixed) :]
    judged = [(Load(AS_GIVEN, message(AS_GIVEN), own), run_checks(own, contacts=False))]
    judged += [(case, case.checks) for case in of_cases]
    count = len(judged) + len(fixed)
    judged += [(states.load(state), state.checked or ()) for state in of_states]
    governs: dict[tuple[str, str], tuple[Rank, int]] = {}
    for i, (load, checks) in enumerate(judged):
        for name, rank in _criterion_ranks(load, checks):
            if name not in governs or rank < governs[name][0]:
                governs[name] = (rank, i)
    named: list[list[tuple[Rank, str]]] = [[] for _ in candidates]
    for (_, subject), (rank, i) in governs.items():
        if i >= count:
            named[i - count].append((rank, subject))
    kept = []
    for state, subjects in zip(candidates, named, strict=True):
        if subjects:
            figures = tuple(dict.fromkeys(subject for _, subject in sorted(subjects)))
            keys = tuple(map(worst_key, figures))
            kept.append(replace(state, name=_state_name(figures), worst_for=figures, keys=keys))
    return replace(states, states=(*fixed, *kept))


def _criterion_ranks(load: Load, checks: Iterable[Check]) -> Iterator[tuple[tuple[str, str], Rank]]:
    """Criteria and figures of a load by key and name, with their rank: the least governs, as in `deciding`."""
    for check in checks:
        yield (check.key, check.subject.text()), severity_rank(check)
    figures = governing_figures(load)
    for duty in load.found.pulley_duty:
        figures[f"load of the {name_pulley(duty.pulley.name)}"] = duty.largest.resultant
    for zone in load.found.belt_duty.transitions:
        for what, least in (("stretched", zone.stretched), ("slackened", zone.slackened)):
            figures[f"length of the {zone.zone.name} transition, strips {what}"] = least or 0.0
    if load.found.line.take_up.travel is not None or load.found.take_up.travel is not None:
        lengths = load.found.line.loop.length
        means = [state.mean(lengths) for state in load.found.motion_states]
        steady = load.found.balance.equilibrium.steady.mean(lengths)
        for name, low, high in (
            ("mean tension", min(means), max(means)),
            ("mean tension, steady", steady, steady),
        ):
            figures[f"travel of the take-up, least {name}"] = -low
            figures[f"travel of the take-up, largest {name}"] = high
        figures["speed of the take-up"] = load.found.take_up.speed or 0.0
    for name, value in figures.items():
        yield ("", name), (_FIGURE_RANK, -_round_digits(value), 0.0)


def _round_digits(value: float) -> float:
    """Figure rounded so that values differing by rounding are equal."""
    return float(f"{value:.{_DIGITS}g}")


def _state_name(figures: Sequence[str]) -> str:
    """Name of a state by the figures it is worst for."""
    more = f" and {len(figures) - _NAMING_FIGURES} more" if len(figures) > _NAMING_FIGURES else ""
    return f"worst for {', '.join(figures[:_NAMING_FIGURES])}{more}"


def _reload_rolls(loads: Sequence[CalculatedConveyor], take_up: TakeUpSetting) -> list[CalculatedConveyor]:
    """Loads recalculated with the rolls loaded by the tension at a take-up setting; the first is the spec's own."""
    variants = [
        Variant(one.conveyor, one.temperature, take_up=take_up, design_friction=one.line.design_friction)
        for one in loads
    ]
    made = []
    for before, again in zip(loads, calculate_many(variants, known=loads[0]), strict=True):
        if not isinstance(again, CalculatedConveyor):
            raise again
        made.append(replace(again, friction_band=before.friction_band))
    return made
