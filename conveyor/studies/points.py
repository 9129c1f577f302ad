"""Points of a study: the exact calculation of a spec with some fields changed, many side by side."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from operator import attrgetter
from typing import Any, Final, Literal, Self, TypeAlias

from conveyor.checks import BELT_USE, belt_rating, belt_safety, checks, highest_use
from conveyor.errors import ConveyorError, InputError
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import with_fields
from conveyor.models.study import Changes, Direction, Value
from conveyor.pipeline import Anchors, CalculatedConveyor, Kept, Variant, anchors_of, calculate_many
from conveyor.studies.costs import Parts, costs, parts_of
from conveyor.studies.loads import every_load

Loads: TypeAlias = Mapping[str, Any]
"""Figures of every load of a design, by key."""
Answer: TypeAlias = list[Any] | str
"""Figures of a point, SI, in the order asked for; or why it has none."""


@dataclass(frozen=True)
class Output:
    """A figure of a point: words, kind of quantity, and how it is read."""

    label: str
    kind: str
    get: Callable[[Any], float | int | None]
    of: Literal["point", "parts", "loads"] = "point"
    """What it is read from: the calculated conveyor, the costs of its parts, every load of the design."""
    better: Direction = "least"
    """What is sought of it where a study does not say."""
    needs: tuple[str, ...] = ()
    """Fields of a spec without any of which there is no such figure."""


_STRENGTH: Final = ("belt.carcass.strength",)
_BELT: Final = (*_STRENGTH, "belt.carcass.rating")

OUTPUTS: Final[Mapping[str, Output]] = {
    "motor_power": Output("motor power", "power", attrgetter("balance.power.motor")),
    "mains_power": Output("mains power", "power", attrgetter("balance.power.mains")),
    "flow": Output("mass flow", "mass flow", attrgetter("line.flow"), better="most"),
    "energy_per_tonne_km": Output(
        "energy", "specific energy", attrgetter("balance.power.energy_per_tonne_km")
    ),
    "effective_tension": Output("effective tension", "force", attrgetter("balance.settled.force")),
    "indentation": Output("indentation", "force", attrgetter("balance.forces.indentation")),
    "friction_factor": Output("equivalent DIN f", "friction", attrgetter("balance.friction_factor")),
    "largest_tension": Output("largest tension", "force", attrgetter("balance.settled.largest")),
    "take_up": Output("setting of the take-up", "force", attrgetter("balance.settled.setting")),
    "belt_safety": Output(
        "belt safety, starts and stops included",
        "ratio",
        attrgetter("belt_duty.safety"),
        better="most",
        needs=_STRENGTH,
    ),
    "belt_safety_steady": Output(
        "belt safety, steady", "ratio", attrgetter("belt_duty.safety_steady"), better="most", needs=_STRENGTH
    ),
    "belt_use": Output(
        "belt utilisation",
        "ratio",
        lambda a: highest_use((*belt_safety(a), *belt_rating(a)), BELT_USE)[0],
        needs=_BELT,
    ),
    "energy_per_year": Output(
        "energy per year", "energy", lambda a: None if a.year is None else JOULE_PER_KWH * a.year.energy
    ),
    "cost_per_year": Output("cost per year", "money", lambda a: None if a.year is None else a.year.cost),
    "capital_cost": Output("capital cost", "money", lambda costs: float(costs.whole_capital), of="parts"),
    "parts_cost_per_year": Output(
        "cost per year of the parts", "money", lambda costs: float(costs.parts_year), of="parts"
    ),
    "total_cost_per_year": Output(
        "total cost per year",
        "money",
        lambda costs: float(costs.year) if "energy" in costs.yearly else None,
        of="parts",
    ),
    "failed": Output(
        "failed checks of the own load",
        "count",
        lambda a: sum(check.failed for check in checks(a)),
    ),
    "all_loads_failed": Output("failed checks, all loads", "count", attrgetter("failed"), of="loads"),
    "all_loads_motor_power": Output(
        "motor power given or held, highest of all loads", "power", attrgetter("motor_power"), of="loads"
    ),
    "all_loads_motor_use": Output(
        "motor power over that installed, all loads",
        "ratio",
        attrgetter("motor_use"),
        of="loads",
        needs=("drive.installed_power", "drive.pulleys"),
    ),
    "all_loads_tension": Output(
        "largest tension, all loads", "force", attrgetter("largest_tension"), of="loads"
    ),
    "all_loads_belt_safety": Output(
        "belt safety, steady, lowest of all loads",
        "ratio",
        attrgetter("belt_safety"),
        of="loads",
        better="most",
        needs=_STRENGTH,
    ),
    "all_loads_belt_use": Output(
        "belt utilisation, highest of all loads", "ratio", attrgetter("belt_use"), of="loads", needs=_BELT
    ),
    "all_loads_take_up": Output(
        "setting of the take-up for all loads", "force", attrgetter("take_up"), of="loads"
    ),
    "error_estimate": Output("largest error estimate of the contacts", "error", attrgetter("error_estimate")),
}
"""Figures by key."""
PARTS: Final = "parts"
"""What is kept of a point for figures that are priced."""


def outputs_of(keys: Iterable[str]) -> dict[str, Output]:
    """Figures asked for; of none all but those of every load, which take a hundred times as long.

    Raises
    ------
    InputError
        A key is not known.
    """
    asked = tuple(keys) or tuple(key for key, one in OUTPUTS.items() if one.of != "loads")
    for key in asked:
        if key not in OUTPUTS:
            raise InputError(f'outputs: no figure "{key}"; there are {", ".join(OUTPUTS)}')
    return {key: OUTPUTS[key] for key in asked}


def loads_asked(asked: Iterable[str]) -> tuple[str, ...]:
    """What of things asked for is read from every load of a design."""
    return tuple(key for key in asked if key != PARTS and OUTPUTS[key].of == "loads")


def asked_of(outputs: Iterable[str]) -> tuple[str, ...]:
    """What is calculated of points for figures: those that are priced follow from parts, whatever they cost."""
    keys = dict.fromkeys(outputs)
    read = [key for key in keys if OUTPUTS[key].of != "parts"]
    energy = ("cost_per_year",) if "total_cost_per_year" in keys else ()
    return tuple(dict.fromkeys([*read, *energy, *((PARTS,) if len(read) < len(keys) else ())]))


def priced(
    answer: Answer, asked: Sequence[str], outputs: Sequence[str], amounts: Mapping[str, float], seconds: float
) -> Answer:
    """Figures of an answer that is calculated.

    Parameters
    ----------
    answer : list or str
        Of `asked`, [SI].
    asked, outputs : sequence of str
        What was calculated, and what is wanted.
    amounts : mapping
        `Prices.amounts`; empty where parts have no price.
    seconds : float
        Of running in a year [s].
    """
    if isinstance(answer, str) or PARTS not in asked:
        return answer
    known = dict(zip(asked, answer, strict=True))
    parts, costed = known[PARTS], None
    if amounts and parts is not None:
        costed = costs(Parts(*parts), amounts, seconds=seconds, energy=known.get("cost_per_year"))
    read = ((OUTPUTS[key], key) for key in outputs)
    return [
        (None if costed is None else one.get(costed)) if one.of == "parts" else known[key]
        for one, key in read
    ]


@dataclass(frozen=True)
class Job:
    """What every batch of a study follows from, packed once; equal ones have the same key.

    Attributes
    ----------
    key : bytes
        Hash of all of it.
    packed : bytes
        Spec, what is asked of points, compounds, paths of states, and the levels of all compounds.
    """

    key: bytes
    packed: bytes = field(compare=False, repr=False)

    @classmethod
    def of(
        cls,
        base: Conveyor,
        asked: Sequence[str],
        compounds: Mapping[str, RubberCompound],
        met: Sequence[str] = (),
    ) -> Self:
        """Pack a spec, what is `asked_of` its points, compounds that they give by name, paths of their states."""
        every = _every(base, compounds)
        anchors = anchors_of(base, every)
        # a compound that is unpickled is another object
        levels = [[level for one, *level in anchors if one is compound] for compound in every]
        packed = pickle.dumps((base, tuple(asked), dict(compounds), tuple(met), levels))
        return cls(hashlib.sha256(packed).digest(), packed)


def _every(base: Conveyor, compounds: Mapping[str, RubberCompound]) -> tuple[RubberCompound, ...]:
    """The compounds of all points."""
    return base.carry_compound, base.return_compound, *compounds.values()


class _Opened:
    """A job where it is done: the very same parts for all its batches, and what batches before made of them."""

    def __init__(self, job: Job) -> None:
        self.base: Conveyor
        self.asked: tuple[str, ...]
        self.compounds: Mapping[str, RubberCompound]
        self.base, self.asked, self.compounds, self._met, levels = pickle.loads(job.packed)  # noqa: S301 by this program
        every = zip(_every(self.base, self.compounds), levels, strict=True)
        self.anchors: Anchors = [(compound, how, level) for compound, known in every for how, level in known]
        self.kept = Kept()
        self._loads: dict[tuple[tuple[str, Value], ...], Loads] = {}

    def made(self, point: Changes) -> Conveyor:
        """The spec of a point.

        Raises
        ------
        InputError
            A change is refused.
        """
        return with_fields(self.base, point, resolve=self.compounds.__getitem__, known=self.kept.fields)

    def loads(self, point: Changes) -> Loads:
        """Every load of the design of a point, whatever state it is in; or why there is none.

        Calculated for itself: whatever batch asks first, it is the same.
        """
        design = {path: value for path, value in point.items() if path not in self._met}
        key = tuple(design.items())
        if key not in self._loads:
            if len(self._loads) >= Kept.MOST:
                self._loads.clear()
            self._loads[key] = _loads(self.made(design), self.asked)
        return self._loads[key]


@lru_cache(maxsize=1)
def _opened(job: Job) -> _Opened:
    """A job unpacked, once in a process that does many batches of it."""
    return _Opened(job)


def answers(job: Job, points: Sequence[Changes]) -> list[Answer]:
    """Figures of points, calculated side by side.

    Parameters
    ----------
    job : Job
        The study's.
    points : sequence of mapping
        New values of the spec's fields, by path.

    Returns
    -------
    list
        In their order what is asked for in SI, or why a point has none.
    """
    opened = _opened(job)
    opened.kept.forget_solved()
    made: list[Conveyor | str] = []
    for point in points:
        try:
            made.append(opened.made(point))
        except ConveyorError as error:
            made.append(str(error))
    variants = [Variant(one) for one in made if isinstance(one, Conveyor)]
    results = iter(calculate_many(variants, anchors=list(opened.anchors), kept=opened.kept))
    return [
        one if isinstance(one, str) else _answer(next(results), opened, point)
        for one, point in zip(made, points, strict=True)
    ]


def _answer(result: CalculatedConveyor | ConveyorError, opened: _Opened, point: Changes) -> Answer:
    if not isinstance(result, CalculatedConveyor):
        return str(result)
    answer = []
    try:
        for key in opened.asked:
            if key == PARTS:
                answer.append(_parts(result))
            elif OUTPUTS[key].of == "loads":
                answer.append(opened.loads(point)[key])
            else:
                answer.append(kept(OUTPUTS[key].get(result)))
    except ConveyorError as error:
        return str(error)
    return answer


def _loads(design: Conveyor, asked: Iterable[str]) -> Loads:
    """Figures of every load of a design that are asked for."""
    loads = every_load(design)
    return {key: kept(OUTPUTS[key].get(loads)) for key in loads_asked(asked)}


def kept(value: Any) -> Any:
    """A figure to ten digits: what follows them differs from one run of the same batch to the next.

    Examples
    --------
    >>> kept(7197.430288888889), kept("pass")
    (7197.430289, 'pass')
    """
    return float(f"{value:.10g}") if isinstance(value, float) else value


def _parts(result: CalculatedConveyor) -> list[float | None] | None:
    parts = parts_of(result)
    return None if parts is None else [kept(float(value)) for value in vars(parts).values()]
