"""Points of a study: exact calculations of a spec with some fields changed, in batches."""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from operator import attrgetter
from typing import Any, Final, Literal, Self, TypeAlias

from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.checks import BELT_STRENGTH_CRITERIA, highest_use, run_checks
from conveyor.checks.belt_checks import belt_rating, belt_safety
from conveyor.errors import ConveyorError, InputError
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.line.known_test_factors import TEST_FACTORS
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import with_fields
from conveyor.models.study import Changes, Direction, Value
from conveyor.pipeline import calculate_many
from conveyor.preparation import conveyor_test_factors
from conveyor.reuse import ReuseCache
from conveyor.studies.costs import Parts, conveyor_costs, conveyor_parts
from conveyor.studies.loads import every_load

Loads: TypeAlias = Mapping[str, Any]
"""Figures over all loads of a design, by key."""
Answer: TypeAlias = list[Any] | str
"""Figures of a point in the requested order [SI], or the reason why it has none."""


@dataclass(frozen=True)
class Output:
    """A figure of a point: label, kind of quantity, and its getter."""

    label: str
    kind: str
    get: Callable[[Any], float | int | None]
    of: Literal["point", "parts", "loads"] = "point"
    """Source: the calculated conveyor, the costs of its parts, or every load of the design."""
    better: Direction = "least"
    """Default direction as an objective."""
    needs: tuple[str, ...] = ()
    """Fields of a spec, at least one of which the figure needs."""


_STRENGTH: Final = ("belt.carcass.strength",)
_BELT: Final = (*_STRENGTH, "belt.carcass.rating")

OUTPUTS: Final[Mapping[str, Output]] = {
    "motor_power": Output("motor power", "power", attrgetter("balance.power.motor")),
    "mains_power": Output("mains power", "power", attrgetter("balance.power.mains")),
    "flow": Output("mass flow", "mass flow", attrgetter("line.flow"), better="most"),
    "energy_per_tonne_km": Output("energy", "specific energy", attrgetter("balance.power.energy_per_tonne_km")),
    "effective_tension": Output("effective tension", "force", attrgetter("balance.equilibrium.force")),
    "indentation": Output("indentation", "force", attrgetter("balance.forces.indentation")),
    "friction_factor": Output("equivalent DIN f", "friction", attrgetter("balance.friction_factor")),
    "largest_tension": Output("largest tension", "force", attrgetter("balance.equilibrium.largest")),
    "take_up": Output("setting of the take-up", "force", attrgetter("balance.equilibrium.setting")),
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
        lambda a: highest_use((*belt_safety(a), *belt_rating(a)), BELT_STRENGTH_CRITERIA)[0],
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
        lambda a: sum(check.failed for check in run_checks(a)),
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
    "all_loads_tension": Output("largest tension, all loads", "force", attrgetter("largest_tension"), of="loads"),
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
    "all_loads_take_up": Output("setting of the take-up for all loads", "force", attrgetter("take_up"), of="loads"),
    "error_estimate": Output("largest error estimate of the contacts", "error", attrgetter("error_estimate")),
}
"""Figures by key."""
PARTS: Final = "parts"
"""Key of a point's parts, from which priced figures follow."""


def select_outputs(keys: Iterable[str]) -> dict[str, Output]:
    """Requested figures; by default all but those of every load, which take a hundred times as long.

    Raises
    ------
    InputError
        A key is unknown.
    """
    asked = tuple(keys) or tuple(key for key, one in OUTPUTS.items() if one.of != "loads")
    for key in asked:
        if key not in OUTPUTS:
            raise InputError(f'outputs: no figure "{key}"; there are {", ".join(OUTPUTS)}')
    return {key: OUTPUTS[key] for key in asked}


def all_loads_keys(asked: Iterable[str]) -> tuple[str, ...]:
    """Keys of the requested figures that need every load of a design."""
    return tuple(key for key in asked if key != PARTS and OUTPUTS[key].of == "loads")


def required_outputs(outputs: Iterable[str]) -> tuple[str, ...]:
    """Keys to calculate at points for the requested figures; priced ones need only the parts."""
    keys = dict.fromkeys(outputs)
    read = [key for key in keys if OUTPUTS[key].of != "parts"]
    energy = ("cost_per_year",) if "total_cost_per_year" in keys else ()
    return tuple(dict.fromkeys([*read, *energy, *((PARTS,) if len(read) < len(keys) else ())]))


def price_answer(
    answer: Answer, asked: Sequence[str], outputs: Sequence[str], amounts: Mapping[str, float], seconds: float
) -> Answer:
    """Requested figures of a calculated answer, with prices applied.

    Parameters
    ----------
    answer : list or str
        Values of the keys `asked` [SI].
    asked, outputs : sequence of str
        Keys calculated, and keys requested.
    amounts : mapping
        `Prices.amounts`; empty if parts have no price.
    seconds : float
        Running time in a year [s].
    """
    if isinstance(answer, str) or PARTS not in asked:
        return answer
    known = dict(zip(asked, answer, strict=True))
    parts, costed = known[PARTS], None
    if amounts and parts is not None:
        costed = conveyor_costs(Parts(*parts), amounts, seconds=seconds, energy=known.get("cost_per_year"))
    read = ((OUTPUTS[key], key) for key in outputs)
    return [(None if costed is None else one.get(costed)) if one.of == "parts" else known[key] for one, key in read]


@dataclass(frozen=True)
class Job:
    """Inputs common to all batches of a study, pickled once; equal jobs have the same key.

    Attributes
    ----------
    key : bytes
        Hash of the packed inputs.
    packed : bytes
        Spec, keys to calculate, compounds, paths of states, and the test factors of all compounds.
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
        """Pack a spec, the keys to calculate, compounds by name, and paths of the states."""
        every = _all_compounds(base, compounds)
        factors = conveyor_test_factors(base, every)
        packed = pickle.dumps((base, tuple(asked), dict(compounds), tuple(met), factors))
        return cls(hashlib.sha256(packed).digest(), packed)


def _all_compounds(base: Conveyor, compounds: Mapping[str, RubberCompound]) -> tuple[RubberCompound, ...]:
    """The compounds of all points."""
    return base.carry_compound, base.return_compound, *compounds.values()


class _UnpackedJob:
    """An unpickled job: shared inputs of all its batches, and results of earlier ones."""

    def __init__(self, job: Job) -> None:
        self.base: Conveyor
        self.asked: tuple[str, ...]
        self.compounds: Mapping[str, RubberCompound]
        self.base, self.asked, self.compounds, self._met, factors = pickle.loads(job.packed)  # noqa: S301 by this program
        for compound, answer in zip(_all_compounds(self.base, self.compounds), factors, strict=False):
            TEST_FACTORS.keep(compound, answer, softened=self.base.calculation.strain != "off")
        self.kept = ReuseCache()
        self._loads: dict[tuple[tuple[str, Value], ...], Loads] = {}

    def made(self, point: Changes) -> Conveyor:
        """Spec of a point.

        Raises
        ------
        InputError
            A change is invalid.
        """
        return with_fields(self.base, point, resolve=self.compounds.__getitem__, kept=self.kept)

    def loads(self, point: Changes) -> Loads:
        """Figures over all loads of a point's design, whatever state the point is in.

        Calculated on its own, so that it does not depend on the batch.
        """
        design = {path: value for path, value in point.items() if path not in self._met}
        key = tuple(design.items())
        if key not in self._loads:
            if len(self._loads) >= ReuseCache.MOST:
                self._loads.clear()
            self._loads[key] = _all_loads_figures(self.made(design), self.asked)
        return self._loads[key]


@lru_cache(maxsize=1)
def _unpack_job(job: Job) -> _UnpackedJob:
    """Unpickled job, cached in a process that does many of its batches."""
    return _UnpackedJob(job)


def evaluate_points(job: Job, points: Sequence[Changes]) -> list[Answer]:
    """Calculate points in one batch.

    Parameters
    ----------
    job : Job
        The study's.
    points : sequence of mapping
        New values of the spec's fields, by path.

    Returns
    -------
    list
        For each point the requested values in SI, or the reason why it has none.
    """
    opened = _unpack_job(job)
    opened.kept.forget_solved()
    made: list[Conveyor | str] = []
    for point in points:
        try:
            made.append(opened.made(point))
        except ConveyorError as error:
            made.append(str(error))
    variants = [Variant(one) for one in made if isinstance(one, Conveyor)]
    results = iter(calculate_many(variants, kept=opened.kept))
    return [
        one if isinstance(one, str) else _point_answer(next(results), opened, point)
        for one, point in zip(made, points, strict=True)
    ]


def _point_answer(result: CalculatedConveyor | ConveyorError, opened: _UnpackedJob, point: Changes) -> Answer:
    if not isinstance(result, CalculatedConveyor):
        return str(result)
    answer = []
    try:
        for key in opened.asked:
            if key == PARTS:
                answer.append(_parts_figures(result))
            elif OUTPUTS[key].of == "loads":
                answer.append(opened.loads(point)[key])
            else:
                answer.append(round_for_storage(OUTPUTS[key].get(result)))
    except ConveyorError as error:
        return str(error)
    return answer


def _all_loads_figures(design: Conveyor, asked: Iterable[str]) -> Loads:
    """Requested figures over all loads of a design."""
    loads = every_load(design)
    return {key: round_for_storage(OUTPUTS[key].get(loads)) for key in all_loads_keys(asked)}


def round_for_storage(value: Any) -> Any:
    """Round to ten digits: further ones differ from run to run of the same batch.

    Examples
    --------
    >>> round_for_storage(7197.430288888889), round_for_storage("pass")
    (7197.430289, 'pass')
    """
    return float(f"{value:.10g}") if isinstance(value, float) else value


def _parts_figures(result: CalculatedConveyor) -> list[float | None] | None:
    parts = conveyor_parts(result)
    return None if parts is None else [round_for_storage(float(value)) for value in vars(parts).values()]
