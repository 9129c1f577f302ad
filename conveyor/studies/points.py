"""Points of a study: the exact calculation of a spec with some fields changed, many side by side."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from operator import attrgetter
from typing import Any, Final, NamedTuple, Self, TypeAlias

from conveyor.checks import checks
from conveyor.errors import ConveyorError, InputError
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import with_fields
from conveyor.models.study import Changes
from conveyor.pipeline import Anchors, CalculatedConveyor, Kept, Variant, anchors_of, calculate_many
from conveyor.studies.costs import Parts, costs, parts_of

RTOL: Final = 1e-4
"""Of the contacts of a study: their true error is a fifth of it, far below what a spec knows."""

Answer: TypeAlias = list[Any] | str
"""Figures of a point, SI, in the order asked for; or why it has none."""


@dataclass(frozen=True)
class Output:
    """A figure of a point: words, kind of quantity, and how it is read."""

    label: str
    kind: str
    get: Callable[[Any], float | int | None]
    priced: bool = False
    """Whether it is read from the costs of the parts instead of the calculated conveyor."""


OUTPUTS: Final[Mapping[str, Output]] = {
    "motor_power": Output("motor power", "power", attrgetter("balance.power.motor")),
    "mains_power": Output("mains power", "power", attrgetter("balance.power.mains")),
    "flow": Output("mass flow", "mass flow", attrgetter("line.flow")),
    "energy_per_tonne_km": Output(
        "energy", "specific energy", attrgetter("balance.power.energy_per_tonne_km")
    ),
    "effective_tension": Output("effective tension", "force", attrgetter("balance.settled.force")),
    "indentation": Output("indentation", "force", attrgetter("balance.forces.indentation")),
    "friction_factor": Output("equivalent DIN f", "friction", attrgetter("balance.friction_factor")),
    "largest_tension": Output("largest tension", "force", attrgetter("balance.settled.largest")),
    "take_up": Output("setting of the take-up", "force", attrgetter("balance.settled.setting")),
    "belt_safety": Output("belt safety", "ratio", attrgetter("belt_duty.safety")),
    "energy_per_year": Output(
        "energy per year", "energy", lambda a: None if a.year is None else JOULE_PER_KWH * a.year.energy
    ),
    "cost_per_year": Output("cost per year", "money", lambda a: None if a.year is None else a.year.cost),
    "capital_cost": Output("capital cost", "money", lambda costs: float(costs.whole_capital), priced=True),
    "parts_cost_per_year": Output(
        "cost per year of the parts", "money", lambda costs: float(costs.parts_year), priced=True
    ),
    "total_cost_per_year": Output(
        "total cost per year",
        "money",
        lambda costs: float(costs.year) if "energy" in costs.yearly else None,
        priced=True,
    ),
    "failed": Output(
        "failed checks of the own load",
        "count",
        lambda a: sum(check.failed for check in checks(a)),
    ),
    "error_estimate": Output("largest error estimate of the contacts", "error", attrgetter("error_estimate")),
}
"""Figures by key."""
PARTS: Final = "parts"
"""What is kept of a point for figures that are priced."""


def outputs_of(keys: Iterable[str]) -> dict[str, Output]:
    """Figures asked for; all of them of none.

    Raises
    ------
    InputError
        A key is not known.
    """
    asked = tuple(keys) or tuple(OUTPUTS)
    for key in asked:
        if key not in OUTPUTS:
            raise InputError(f'outputs: no figure "{key}"; there are {", ".join(OUTPUTS)}')
    return {key: OUTPUTS[key] for key in asked}


def asked_of(outputs: Iterable[str]) -> tuple[str, ...]:
    """What is calculated of points for figures: those that are priced follow from parts, whatever they cost."""
    keys = dict.fromkeys(outputs)
    read = [key for key in keys if not OUTPUTS[key].priced]
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
    return [(None if costed is None else one.get(costed)) if one.priced else known[key] for one, key in read]


@dataclass(frozen=True)
class Job:
    """What every batch of a study follows from, packed once; equal ones have the same key.

    Attributes
    ----------
    key : bytes
        Hash of all of it.
    packed : bytes
        Spec, what is asked of points, compounds, and the levels of all compounds.
    """

    key: bytes
    packed: bytes = field(compare=False, repr=False)

    @classmethod
    def of(cls, base: Conveyor, asked: Sequence[str], compounds: Mapping[str, RubberCompound]) -> Self:
        """Pack a spec, what is `asked_of` its points, and the compounds that they give by name."""
        every = _every(base, compounds)
        anchors = anchors_of(base, every)
        # a compound that is unpickled is another object
        levels = [[level for one, *level in anchors if one is compound] for compound in every]
        packed = pickle.dumps((base, tuple(asked), dict(compounds), levels))
        return cls(hashlib.sha256(packed).digest(), packed)


def _every(base: Conveyor, compounds: Mapping[str, RubberCompound]) -> tuple[RubberCompound, ...]:
    """The compounds of all points."""
    return base.carry_compound, base.return_compound, *compounds.values()


class _Opened(NamedTuple):
    """A job where it is done: the very same parts for all its batches, and what batches before made of them."""

    base: Conveyor
    asked: tuple[str, ...]
    compounds: Mapping[str, RubberCompound]
    anchors: Anchors
    kept: Kept


@lru_cache(maxsize=1)
def _opened(job: Job) -> _Opened:
    """A job unpacked, once in a process that does many batches of it."""
    base, asked, compounds, levels = pickle.loads(job.packed)  # noqa: S301 packed by this program
    every = zip(_every(base, compounds), levels, strict=True)
    anchors = [(compound, how, level) for compound, known in every for how, level in known]
    return _Opened(base, asked, compounds, anchors, Kept())


def answers(job: Job, points: Sequence[Changes], rtol: float = RTOL) -> list[Answer]:
    """Figures of points, calculated side by side.

    Parameters
    ----------
    job : Job
        The study's.
    points : sequence of mapping
        New values of the spec's fields, by path.
    rtol : float
        Relative tolerance of the contacts [-].

    Returns
    -------
    list
        In their order what is asked for in SI, or why a point has none.
    """
    base, asked, compounds, anchors, kept = _opened(job)
    kept.forget_solved()
    known = kept.fields
    made: list[Conveyor | str] = []
    for point in points:
        try:
            made.append(with_fields(base, point, resolve=compounds.__getitem__, known=known))
        except ConveyorError as error:
            made.append(str(error))
    variants = [Variant(one) for one in made if isinstance(one, Conveyor)]
    results = iter(calculate_many(variants, rtol, anchors=list(anchors), kept=kept))
    return [one if isinstance(one, str) else _answer(next(results), asked) for one in made]


def _answer(result: CalculatedConveyor | ConveyorError, asked: Sequence[str]) -> Answer:
    if not isinstance(result, CalculatedConveyor):
        return str(result)
    try:
        return [_parts(result) if key == PARTS else kept(OUTPUTS[key].get(result)) for key in asked]
    except ConveyorError as error:
        return str(error)


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
