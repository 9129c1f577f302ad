"""Load states of a conveyor: empty, full, inclines only, declines only, and the worst loadings by superposition.

All are calculated in full with the take-up as it is set for the spec's own load and its cases. Which sections a worst
state loads follows from the forces of the full and the empty belt; on vertical curves, and where strain softens the
rubber, these are forces of other tensions and loads, so that a section whose load hardly matters may be on the wrong
side.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from conveyor.checks import Check, compared, drive_power, not_slack, steady_safety, verdict
from conveyor.loop.settled import holds
from conveyor.loop.superposition import DRIVE_FORCE, Superposition
from conveyor.models import Conveyor, LoadCase
from conveyor.models.cases import STANDARD_LOADINGS
from conveyor.models.variants import with_case
from conveyor.pipeline import CalculatedConveyor, NoAnswer, Progress, Variant, calculate, calculate_many
from conveyor.units import si
from conveyor.units.sentences import Said, quoted, said

_KEYS: Final = {"full": "full", "empty": "empty", "inclines only": "inclines", "declines only": "declines"}


@dataclass(frozen=True, eq=False)
class LoadState:
    """A loading of the conveyor at the spec's speed and temperature.

    Attributes
    ----------
    name : str
        What it is called in reports.
    loaded : tuple of str
        Sections that bear bulk.
    worst_for : tuple of str
        Figures that no loading makes worse, as far as single sections go.
    keys : tuple of str
        For programs; a worst loading that is one of the standard states has the keys of both.
    found : CalculatedConveyor
        Forces, tensions and power, the take-up at its setting.
    """

    name: str
    loaded: tuple[str, ...]
    worst_for: tuple[str, ...]
    keys: tuple[str, ...]
    found: CalculatedConveyor

    @property
    def loaded_in_words(self) -> str:
        """The sections that bear bulk, by name."""
        if len(self.loaded) == self.found.line.count:
            return "all"
        return ", ".join(self.loaded) or "none"


@dataclass(frozen=True)
class StateRefusal:
    """A load state without an answer, and why."""

    name: str
    loaded: tuple[str, ...]
    reason: str


@dataclass(frozen=True, eq=False)
class CalculatedStates:
    """Load states of one conveyor.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    setting : float
        Of the take-up in every state [N].
    states, refused : tuple
        The standard ones first, then worst loadings that are none of them; what has no answer.
    """

    conveyor: Conveyor
    setting: float
    states: tuple[LoadState, ...]
    refused: tuple[StateRefusal, ...]

    def state(self, key: str) -> LoadState | None:
        """The state of a key: full, empty, inclines, declines, worst and what `worst_key` makes."""
        return next((state for state in self.states if key in state.keys), None)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The states against what is installed and against the take-up's setting; the state that decides is named."""
        return tuple(_checks(self)) if self.states else ()


def worst_key(figure: str) -> str:
    """Return the key of the worst loading for a figure: worst is that of the drive force.

    Examples
    --------
    >>> worst_key("drive force"), worst_key("largest tension")
    ('worst', 'worst_largest_tension')
    """
    return "worst" if figure == DRIVE_FORCE else f"worst_{'_'.join(figure.replace(',', ' ').split())}"


def load_states(
    conveyor: Conveyor, given: CalculatedConveyor | None = None, *, progress: Progress | None = None
) -> CalculatedStates:
    """Calculate empty, full, inclines only and declines only, then the worst loadings.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    given : CalculatedConveyor, optional
        The spec's own load; its take-up setting is that of every state. Calculated without it.
    progress : callable, optional
        Called with what is done and the whole.

    Raises
    ------
    NoSolutionError, RangeError, InputError
        The spec's own load has no answer.
    """
    own = calculate(conveyor) if given is None else given
    names = [section.name for section in own.line.sections]
    standard = {loading: LoadCase(name=loading, loading=loading) for loading in STANDARD_LOADINGS}
    found, loads = _calculated(standard, conveyor, own, progress)
    worst: dict[tuple[str, ...], list[str]] = {}
    full, empty = found["full"], found["empty"]
    if isinstance(full, CalculatedConveyor) and isinstance(empty, CalculatedConveyor):
        for figure, loading in Superposition(full.balance, empty.balance).worst().items():
            bearing = tuple(name for name, on in zip(names, loading.tolist(), strict=True) if on)
            worst.setdefault(bearing, []).append(figure)
    further = {
        f"worst for {', '.join(figures)}": LoadCase(name="worst", loading="sections", sections=bearing)
        for bearing, figures in worst.items()
        if bearing not in loads.values()
    }
    more, more_loads = _calculated(further, conveyor, own, progress)
    states, refused = [], []
    for name, loaded in (loads | more_loads).items():
        one, figures = (found | more)[name], tuple(worst.pop(loaded, ()))
        if isinstance(one, CalculatedConveyor):
            keys = (*((_KEYS[name],) if name in _KEYS else ()), *map(worst_key, figures))
            states.append(LoadState(name, loaded, figures, keys, one))
        else:
            refused.append(StateRefusal(name, loaded, str(one)))
    return CalculatedStates(conveyor, own.balance.settled.setting, tuple(states), tuple(refused))


_Found = dict[str, CalculatedConveyor | NoAnswer]


def _calculated(
    cases: Mapping[str, LoadCase], conveyor: Conveyor, own: CalculatedConveyor, progress: Progress | None
) -> tuple[_Found, dict[str, tuple[str, ...]]]:
    """Loadings calculated at the setting of the spec's own load, and the sections that bear bulk in each."""
    asked = {name: with_case(conveyor, case) for name, case in cases.items()}
    found: _Found = {name: own for name, one in asked.items() if one is conveyor}
    variants = {
        name: Variant(one, take_up=own.balance.settled.setting)
        for name, one in asked.items()
        if name not in found
    }
    if variants:
        answers = calculate_many(list(variants.values()), progress=progress)
        found |= dict(zip(variants, answers, strict=True))
    return found, {name: _bearing(one) for name, one in asked.items()}


def _bearing(conveyor: Conveyor) -> tuple[str, ...]:
    """Sections that bear bulk, by name."""
    if si(conveyor.material.flow) == 0.0:
        return ()
    return tuple(section.name for section in conveyor.route.sections if section.loaded)


def _checks(found: CalculatedStates) -> Iterator[Check]:
    yield from _motor_checks(found.states)
    yield _take_up_check(max(found.states, key=lambda state: state.found.balance.settled.needed))
    slackest = min(found.states, key=lambda state: state.found.balance.tensions.smallest)
    yield not_slack(slackest.found.balance.tensions.smallest, _of_state("smallest tension", slackest))
    tightest = max(found.states, key=lambda state: state.found.belt_duty.largest_steady)
    if tightest.found.belt_duty.safety_steady is not None:
        yield steady_safety(tightest.found.belt_duty, _of_state("safety of the belt, steady", tightest))


def _of_state(criterion: str, state: LoadState) -> Said:
    return said(f"load states: {criterion} ({quoted(state.name)})")


def _motor_checks(states: Sequence[LoadState]) -> Iterator[Check]:
    """Every drive with power given, in the state that asks it for most."""
    for d, drive in enumerate(states[0].found.line.drives):
        if drive.power is None:
            continue
        powers = [
            state.found.balance.frame.motor(state.found.balance.settled.steady.drives[d].force)
            for state in states
        ]
        power, state = max(zip(powers, states, strict=True), key=lambda pair: abs(pair[0]))
        subject = _of_state(f"motor power, {drive.name}", state)
        yield drive_power(quoted(drive.name), drive, power, subject)


def _take_up_check(most: LoadState) -> Check:
    settled = most.found.balance.settled
    why = said(
        f"the take-up holds {{}}, the load state {quoted(most.name)} asks for {{}}: give route.take_up.tension, or a "
        'case with loading "sections" and those of the state',
        (settled.setting, "force"),
        (settled.needed, "force"),
    )
    made = compared(
        "take_up_tension", _of_state("tension of the take-up", most), settled.setting, "at least", settled.needed,
        "force", why=why,
    )  # fmt: skip
    return replace(made, verdict=verdict(holds=holds(settled.setting, settled.needed)))
