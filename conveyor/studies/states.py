"""Load states of a conveyor: empty, full, inclines only, declines only, and the worst loadings by superposition.

The take-up is set as for the spec's own load and its cases. Forces add by section: a loading has those of the full belt
on the sections that bear bulk, and those of the empty one elsewhere. The worst for the drive force is also calculated
in full: its own tensions load the rolls of vertical curves, its own loads soften the rubber.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from operator import itemgetter
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.checks import Check, run_checks
from conveyor.errors import ConveyorError
from conveyor.loop.balance import Balance, close_loops, raise_first_error
from conveyor.loop.load_superposition import DRIVE_FORCE, HOLDING_BACK, HOLDING_DOWN, Loading, SectionLoadings
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.loop.take_up_duty import on_common_side
from conveyor.loop.ties import first_maximum
from conveyor.models import Conveyor, LoadCase
from conveyor.models.cases import STANDARD_LOADINGS
from conveyor.models.variants import with_case, with_temperature
from conveyor.pipeline import ProgressCallback, calculate, calculate_many
from conveyor.reuse import ReuseCache
from conveyor.studies.load_cases import (
    CalculatedCases,
    Load,
)
from conveyor.units import from_si
from conveyor.units.sentences import Message, escape_braces, message

_ROW: Final = 3  # consecutive sections from which a row is named by its ends
_IN_FULL: Final = frozenset({DRIVE_FORCE, HOLDING_BACK, HOLDING_DOWN})
"""Figures whose worst loading is calculated with its own contacts."""
_STATE_KEYS: Final = {
    "full": "full",
    "empty": "empty",
    "inclines only": "inclines",
    "declines only": "declines",
}


@dataclass(frozen=True, eq=False)
class LoadState:
    """A loading of the conveyor at the spec's speed.

    Attributes
    ----------
    name : str
        Name in reports.
    loaded : tuple of str
        Sections that bear bulk.
    temperature : float
        Of the belt [K].
    worst_for : tuple of str
        Figures for which it is the worst loading by sections, over all temperatures of the cases.
    keys : tuple of str
        Keys for programs: all those of the standard states and worst loadings that it represents.
    balance : Balance
        Forces, tensions and power, the take-up at its setting.
    found : CalculatedConveyor or None
        The full result, if known.
    checked : tuple of Check or None
        Every criterion of it that needs no contacts, if known.
    """

    name: str
    loaded: tuple[str, ...]
    temperature: float
    worst_for: tuple[str, ...]
    keys: tuple[str, ...]
    balance: Balance
    found: CalculatedConveyor | None = None
    checked: tuple[Check, ...] | None = None

    @property
    def label(self) -> str:
        """Its name; for a standard state with the figures it is worst for."""
        if self.name in _STATE_KEYS and self.worst_for:
            return f"{self.name} (worst for {', '.join(self.worst_for)})"
        return self.name

    @property
    def title(self) -> str:
        """Its name among load cases."""
        return f"load state {self.name if self.name in _STATE_KEYS else f'worst for {self.worst_for[0]}'}"

    @property
    def case(self) -> Message:
        """Case of its checks."""
        return message(f"{escape_braces(self.title)}, {{}}", (self.temperature, "temperature"))

    @property
    def loaded_in_words(self) -> str:
        """Names of the sections that bear bulk, or of those that do not if that is shorter."""
        names, bearing = [section.name for section in self.balance.line.sections], frozenset(self.loaded)
        loaded, empty = (_section_list(names, [(name in bearing) is on for name in names]) for on in (True, False))
        if not loaded or not empty:
            return "all" if loaded else "none"
        return min(loaded, f"all but {empty}", key=len)


@dataclass(frozen=True)
class StateRefusal:
    """A load without an answer, and the reason; SI."""

    name: str
    temperature: float
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedStates:
    """Load states of one conveyor.

    Attributes
    ----------
    own : CalculatedConveyor
        The spec's own load.
    states, refused : tuple
        The standard states first, then other worst loadings; states without an answer.
    ends : tuple
        Temperatures of the loadings [K], each with the loops under full and empty belt.
    """

    own: CalculatedConveyor
    states: tuple[LoadState, ...]
    refused: tuple[StateRefusal, ...]
    ends: tuple[tuple[float, Balance, Balance], ...] = ()

    @property
    def conveyor(self) -> Conveyor:
        """The spec."""
        return self.own.conveyor

    @property
    def take_up(self) -> TakeUpSetting:
        """Setting and side of the take-up in every state."""
        return self.own.balance.equilibrium.take_up

    @property
    def setting(self) -> float:
        """Take-up setting in every state [N]."""
        return self.take_up.tension

    def __repr__(self) -> str:
        name, answered = self.conveyor.name, len(self.states)
        return f'StateStudy("{name}": {answered} states, {len(self.refused)} without an answer)'

    def state(self, key: str) -> LoadState | None:
        """State of a key: full, empty, inclines, declines, worst and those of `worst_key`."""
        return next((state for state in self.states if key in state.keys), None)

    @cached_property
    def loads(self) -> tuple[Load, ...]:
        """Every state but the spec's own load, with the contacts of the spec's own load."""
        return tuple(self.load(state) for state in self.states if state.balance is not self.own.balance)

    def load(self, state: LoadState) -> Load:
        """A state as a load, with the contacts of the spec's own load."""
        found = state.found
        if found is None or found.balance is not state.balance:
            found = replace(self.own, temperature=state.temperature, balance=state.balance)
        return Load(state.title, state.case, found)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Every criterion that needs no contacts, in every state but the spec's own load."""
        each = [state for state in self.states if state.balance is not self.own.balance]
        return tuple(
            replace(check, case=load.label)
            for state, load in zip(each, self.loads, strict=True)
            for check in (run_checks(load.found, contacts=False) if state.checked is None else state.checked)
        )


def _section_list(names: Sequence[str], on: Sequence[bool]) -> str:
    """Names of the selected sections; of three or more in a row the first and the last."""
    runs = [[name for name, _ in run] for is_on, run in groupby(zip(names, on, strict=True), itemgetter(1)) if is_on]
    return ", ".join(", ".join(run) if len(run) < _ROW else f"{run[0]} to {run[-1]}" for run in runs)


def worst_key(figure: str) -> str:
    """Key of the worst loading for a figure; `worst` for the drive force.

    Examples
    --------
    >>> worst_key("drive force"), worst_key("grip, tail drive")
    ('worst', 'worst_grip_tail_drive')
    """
    words = "".join(c if c.isalnum() else " " for c in figure).split()
    return "worst" if figure == DRIVE_FORCE else "_".join(("worst", *words))


def load_states(
    conveyor: Conveyor,
    given: CalculatedConveyor | None = None,
    cases: CalculatedCases | None = None,
    *,
    progress: ProgressCallback | None = None,
    kept: ReuseCache | None = None,
) -> CalculatedStates:
    """Calculate empty, full, inclines only and declines only, and the worst loadings at every temperature of the cases.

    Coinciding loadings are one state.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    given : CalculatedConveyor, optional
        The spec's own load; its take-up setting is that of every state. Calculated without it.
    cases : CalculatedCases, optional
        Cases at the same setting: their temperatures are included, and their results reused.
    progress : callable, optional
        Called with the items done and their total.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        The spec's own load has no answer.
    """
    kept = ReuseCache() if kept is None else kept
    own = _fix_take_up_side(calculate(conveyor, kept) if given is None else given)
    at = own.temperature
    ends, refused = _full_and_empty(conveyor, own, cases, progress, kept)
    adding = {temperature: SectionLoadings(*pair) for temperature, pair in ends.items()}
    worst = _worst_loadings(adding)
    alike: dict[bytes, tuple[Loading, list[str]]] = {}
    for name, loading in zip(STANDARD_LOADINGS, adding[at].standard, strict=True) if at in adding else ():
        alike.setdefault(loading.tobytes(), (loading, []))[1].append(name)
    standard = [(loading, names, worst.pop((at, key), (loading, ()))[1]) for key, (loading, names) in alike.items()]
    alone = [
        (temperature, loaded_sections(own, loading))
        for (temperature, _), (loading, figures) in worst.items()
        if not _IN_FULL.isdisjoint(figures) and loading.any() and not loading.all()
    ]
    full_ones = dict(zip(alone, _calculate_in_full(conveyor, alone, own, adding, kept), strict=True))
    balances = {
        (temperature, loaded): one.balance
        for (temperature, loaded), one in full_ones.items()
        if isinstance(one, CalculatedConveyor)
    }
    wanted = [(at, loading) for loading, *_ in standard]
    wanted += [(temperature, loading) for (temperature, _), (loading, _) in worst.items()]
    adds = {(temperature, loaded_sections(own, loading)): loading for temperature, loading in wanted}
    balances |= _superpose({key: loading for key, loading in adds.items() if key not in balances}, adding)
    states = []
    for loading, names, figures in standard:
        loaded, keys = loaded_sections(own, loading), (*map(_STATE_KEYS.__getitem__, names), *map(worst_key, figures))
        states.append(LoadState(names[0], loaded, at, figures, keys, balances[at, loaded]))
    for (temperature, _), (loading, figures) in worst.items():
        loaded = loaded_sections(own, loading)
        if isinstance(again := full_ones.get((temperature, loaded)), ConveyorError):
            refused.append(StateRefusal(f"worst for {figures[0]}", temperature, str(again)))
        title, keys = f"worst for {', '.join(figures)}", tuple(map(worst_key, figures))
        states.append(LoadState(title, loaded, temperature, figures, keys, balances[temperature, loaded]))
    looked_at = tuple((temperature, *pair) for temperature, pair in ends.items())
    return CalculatedStates(own, tuple(states), tuple(refused), looked_at)


def _superpose(
    asked: Mapping[tuple[float, tuple[str, ...]], Loading], adding: Mapping[float, SectionLoadings]
) -> dict[tuple[float, tuple[str, ...]], Balance]:
    """Balances under loadings at temperatures, added by section; the full and the empty belt are known."""
    found, loops = {}, {}
    for key, loading in asked.items():
        loadings = adding[key[0]]
        if loading.all() or not loading.any():
            found[key] = loadings.full if loading.any() else loadings.empty
        else:
            loops[key] = loadings.open_loop(loading)
    return found | dict(zip(loops, raise_first_error(close_loops(list(loops.values()))), strict=True))


def _fix_take_up_side(own: CalculatedConveyor) -> CalculatedConveyor:
    """The spec's own load with the take-up on the side of the drives that suits every load."""
    (balance,) = on_common_side([own.balance])
    return own if balance is own.balance else replace(own, balance=balance)


_Ends = tuple[Balance, Balance]
"""Under full and empty belt."""


def _full_and_empty(
    conveyor: Conveyor,
    own: CalculatedConveyor,
    cases: CalculatedCases | None,
    progress: ProgressCallback | None,
    kept: ReuseCache,
) -> tuple[dict[float, _Ends], list[StateRefusal]]:
    """Full and empty belt at the spec's temperature and those of its cases, reusing results of the cases.

    A temperature at which a case is outside the rubber's data is left out: worst loadings would be designed by it.
    """
    here = () if cases is None else cases.results
    every = [result for result in here if result.speed == own.line.speed and not result.case.reversed]
    beyond = {r.temperature for r in every if not r.covered}
    results = [r for r in every if r.temperature not in beyond]
    known: dict[tuple[float, str], CalculatedConveyor] = {(r.temperature, r.case.loading): r.found for r in results}
    at = own.temperature
    wanted = [(t, name) for t in dict.fromkeys([at, *(t for t, _ in known)]) for name in ("full", "empty")]
    asked: dict[tuple[float, str], Conveyor] = {}
    refused = []
    for temperature, name in wanted:
        case = LoadCase.from_data({"name": name, "loading": name})
        try:
            asked[temperature, name] = _load_conveyor(conveyor, case, temperature, own)
        except ConveyorError as error:
            refused.append(StateRefusal(name, temperature, str(error)))
    solved: dict[tuple[float, str], CalculatedConveyor] = {k: known[k] for k in asked if k in known}
    solved |= {key: own for key, one in asked.items() if one is conveyor}
    take_up = own.balance.equilibrium.take_up
    missing = {key: Variant(one, take_up=take_up) for key, one in asked.items() if key not in solved}
    if missing:
        answers = calculate_many(list(missing.values()), progress=progress, known=own, kept=kept)
        for key, one in zip(missing, answers, strict=True):
            if isinstance(one, CalculatedConveyor):
                solved[key] = one
            else:
                refused.append(StateRefusal(key[1], key[0], str(one)))
    ends = {
        temperature: (solved[temperature, "full"].balance, solved[temperature, "empty"].balance)
        for temperature, name in wanted
        if name == "full" and (temperature, "full") in solved and (temperature, "empty") in solved
    }
    return {temperature: _at_one_design_friction(*pair) for temperature, pair in ends.items()}, refused


def _at_one_design_friction(full: Balance, empty: Balance) -> _Ends:
    """Full and empty belt designed for the friction of the full one."""
    return full, empty.designed_for(full.line.design_friction)


def _load_conveyor(conveyor: Conveyor, case: LoadCase, temperature: float, own: CalculatedConveyor) -> Conveyor:
    """Conveyor under a load case at a temperature; the same object if nothing changes."""
    loaded = with_case(conveyor, case)
    if temperature == own.temperature:
        return loaded
    return with_temperature(loaded, from_si(temperature, "temperature", "K"))


def _worst_loadings(
    adding: Mapping[float, SectionLoadings],
) -> dict[tuple[float, bytes], tuple[Loading, tuple[str, ...]]]:
    """Worst loadings over all temperatures, each with the figures it is worst for."""
    every: dict[str, list[tuple[float, float, Loading]]] = {}
    for temperature, states in adding.items():
        for figure, loading in states.worst().items():
            every.setdefault(figure, []).append((states.figures(loading)[figure], temperature, loading))
    best = {figure: first_maximum(found, itemgetter(0)) for figure, found in every.items()}
    loadings: dict[tuple[float, bytes], tuple[Loading, tuple[str, ...]]] = {}
    for figure, (_, temperature, loading) in best.items():
        key = (temperature, loading.tobytes())
        loadings[key] = (loading, (*loadings.get(key, (loading, ()))[1], figure))
    return loadings


def _calculate_in_full(
    conveyor: Conveyor,
    loads: Sequence[tuple[float, tuple[str, ...]]],
    own: CalculatedConveyor,
    adding: Mapping[float, SectionLoadings],
    kept: ReuseCache,
) -> list[CalculatedConveyor | ConveyorError]:
    """Calculate loadings at temperatures with their own contacts, or return the errors."""
    made: list[CalculatedConveyor | ConveyorError] = []
    variants: dict[int, Variant] = {}
    for i, (temperature, loaded) in enumerate(loads):
        case = LoadCase(name="worst", loading="sections", sections=loaded)
        try:
            one = _load_conveyor(conveyor, case, temperature, own)
        except ConveyorError as error:
            made.append(error)
        else:
            friction = adding[temperature].line.design_friction
            variants[i] = Variant(one, take_up=own.balance.equilibrium.take_up, design_friction=friction)
            made.append(own)
    if variants:
        for i, answer in zip(variants, calculate_many(list(variants.values()), known=own, kept=kept), strict=True):
            made[i] = answer
    return made


def loaded_sections(own: CalculatedConveyor, loading: Loading) -> tuple[str, ...]:
    """Names of the sections that bear bulk."""
    pairs = zip(own.line.sections, loading.tolist(), strict=True)
    return tuple(section.name for section, on in pairs if on)
