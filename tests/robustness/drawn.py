"""Specs drawn at random from the examples (seeded), and what must hold of whatever comes of them."""

from __future__ import annotations

import copy
import functools
import math
import random
import re
import traceback
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

from ruamel.yaml import YAML

import conveyor
from conveyor import shelf
from conveyor.errors import ConveyorError, InputError
from conveyor.models.fields import with_fields
from conveyor.results.analysis import analyse_studies
from conveyor.spec import from_data
from conveyor.units import si
from conveyor.units.quantity_kinds import INPUT_KINDS

Data = dict[str, Any]
Place = tuple[Any, Any]
"""A mapping or list, and the key of a value in it."""

EXAMPLES: Final = Path(__file__).parents[2] / "examples" / "specs"
COLDEST, WARMEST = -50.0, 60.0  # degC
FAULT: Final = "FAULT"
"""Begins how a spec ends of which something does not hold."""
_FIGURE: Final = re.compile(r"(-?[\d.]+(?:e[+-]?\d+)?) ?(.*)")
_EXTREME: Final = (0.0, -1.0, 1e-6, 1e-3, 1e3, 1e6, 1e12)
_ROUNDING: Final = 1e-9
"""Of sums of some thousand figures, over the sum of their amounts."""


@functools.cache
def examples() -> dict[str, Data]:
    """Every example spec as plain data."""
    read = YAML(typ="safe", pure=True)
    return {path.stem: read.load(path) for path in sorted(EXAMPLES.glob("*.yaml"))}


def drawn(seed: int) -> tuple[str, Data]:
    """A spec of a seed: the example it comes from and what was done to it; its data."""
    seeded = random.Random(seed)  # noqa: S311 a repeatable test, no secret
    name = seeded.choice(list(examples()))
    data, done = copy.deepcopy(examples()[name]), [name]
    if seeded.random() < 0.6:
        data.setdefault("ambient", {})["temperature"] = f"{seeded.uniform(COLDEST, WARMEST):.1f} degC"
        done.append(data["ambient"]["temperature"])
    for _ in range(seeded.choice((0, 1, 1, 2, 2, 3, 5))):
        change = seeded.choice(_CHANGES)
        done.append(change(data, seeded))
    return ", ".join(done), data


def _places(data: object, inside: Callable[[object], bool]) -> list[Place]:
    """Places in nested data whose values are of a sort."""

    def walk(part: object) -> Iterator[Place]:
        pairs = part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else ()
        for key, value in pairs:
            if inside(value):
                yield part, key
            yield from walk(value)

    return list(walk(data))


def _figure_in(value: object) -> re.Match[str] | None:
    """Number and unit of a value."""
    if isinstance(value, bool):
        return None
    return _FIGURE.fullmatch(str(value)) if isinstance(value, (int, float, str)) else None


def _put(place: Place, number: float, unit: str) -> str:
    part, key = place
    plain = isinstance(part[key], (int, float))
    whole = isinstance(part[key], int) and number.is_integer()
    part[key] = (int(number) if whole else number) if plain else f"{number:.6g} {unit}".strip()
    return f"{key} = {part[key]}"


def _scaled(data: Data, seeded: random.Random) -> str:
    """Change a value to a third or three times at most, now and then to an extreme."""
    place = seeded.choice(_places(data, lambda value: _figure_in(value) is not None))
    number, unit = _figure_in(place[0][place[1]]).groups()
    factor = seeded.choice(_EXTREME) if seeded.random() < 0.15 else 3.0 ** seeded.uniform(-1.0, 1.0)
    return _put(place, float(number) * factor, unit)


def _other_unit(data: Data, seeded: random.Random) -> str:
    """Give a value another unit of its kind, or of another, the number as it was."""
    place = seeded.choice(_places(data, lambda value: isinstance(value, str) and _figure_in(value) is not None))
    number, unit = _figure_in(place[0][place[1]]).groups()
    own = [kind for kind in INPUT_KINDS.values() if unit in kind.units]
    kind = seeded.choice(own if own and seeded.random() < 0.8 else list(INPUT_KINDS.values()))
    return _put(place, float(number), seeded.choice(sorted(kind.units)))


def _left_out(data: Data, seeded: random.Random) -> str:
    """Leave a part or a value out."""
    part, key = seeded.choice(_places(data, lambda _: True))
    del part[key]
    return f"no {key}"


def _exchanged(data: Data, seeded: random.Random) -> str:
    """Put in the place of a part one of the same name from another example."""
    name, other = seeded.choice(list(examples().items()))
    own = _places(data, lambda value: isinstance(value, (dict, list)))
    theirs = _places(other, lambda value: isinstance(value, (dict, list)))
    part, key = seeded.choice(own)
    alike = [there[its] for there, its in theirs if its == key] or [theirs[0][0][theirs[0][1]]]
    part[key] = copy.deepcopy(seeded.choice(alike))
    return f"{key} of {name}"


def _other_compound(data: Data, seeded: random.Random) -> str:
    """Make a cover of another compound."""
    covers = [
        place
        for place in _places(data, lambda value: isinstance(value, dict) and "compound" in value)
        if isinstance(place[0], dict)
    ]
    if not covers:
        return "no cover"
    part, key = seeded.choice(covers)
    part[key]["compound"] = seeded.choice(sorted(shelf.names()))
    return f"{key} of {part[key]['compound']}"


_CHANGES: Final = (_scaled, _scaled, _scaled, _other_unit, _left_out, _exchanged, _other_compound)


def outcome(data: Data, *, whole: bool) -> str:
    """How a spec ends, after holding what must hold: "answered", "no answer" or "refused".

    Its load states are calculated, its tables made and power held against friction where it is done `whole`: most of
    the time.

    Raises
    ------
    AssertionError
        Something does not hold, with what it is.
    """
    try:
        line = from_data(data)
    except InputError as error:
        _said_well(error)
        return "refused"
    try:
        result = conveyor.analyse(line)
        every = analyse_studies(line, result) if whole else None
        shown = result.at_common_take_up(every)
        plain = shown.to_dict(every)
        tables = shown.contents(every).by_key if whole else {}
    except ConveyorError as error:
        _said_well(error)
        return "no answer"
    for table in tables.values():
        table.frame()
    assert not list(_not_finite(plain)), list(_not_finite(plain))
    _forces_add_up(result)
    if whole and line.calculation.method == "viscoelastic":  # factors know no roll's drag
        _power_grows_with_friction(line, result)
    _slack_belts_fail(result, {check.verdict.upper() for check in result.checks})
    _slack_belts_fail(shown, {check["verdict"].upper() for check in plain["checks"]})
    return "answered"


def _said_well(error: ConveyorError) -> None:
    """A message is words, short enough to be read."""
    said = str(error)
    assert 0 < len(said) < 20_000, said[:200]
    assert re.search(r"\bnan\b|Traceback|object at 0x|NoneType", said) is None, said


def _not_finite(value: object, at: str = "") -> Iterator[str]:
    """Places of numbers that are none."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _not_finite(part, f"{at}.{key}")
    elif isinstance(value, list):
        for k, part in enumerate(value):
            yield from _not_finite(part, f"{at}[{k}]")
    elif isinstance(value, float) and not math.isfinite(value):
        yield f"{at} = {value}"


def _forces_add_up(result: conveyor.Analysis) -> None:
    """Forces sum to the pull, it to that of the drives and, with the speed, to the power; so round the loop."""
    balance = result.balance
    force, every = balance.equilibrium.force, [one.total for one in balance.every]
    amount = math.fsum(abs(one) for one in every) + 1.0
    assert abs(math.fsum(every) - force) <= _ROUNDING * amount
    assert abs(math.fsum(drive.force for drive in balance.equilibrium.steady.drives) - force) <= _ROUNDING * amount
    assert math.isclose(balance.power.belt, force * balance.line.speed, rel_tol=_ROUNDING, abs_tol=1e-6)
    for state in balance.equilibrium.states.values():
        largest = max(map(abs, (state.smallest, *(drive.arriving for drive in state.drives))))
        for drive in state.drives:
            assert abs(drive.arriving - drive.leaving - drive.force) <= _ROUNDING * (amount + largest)


def _power_grows_with_friction(line: conveyor.Conveyor, result: conveyor.Analysis) -> None:
    """Rolls that drag more take more power at the belt and at the motors."""
    changes = {}
    for strand, idlers in (("carry", line.idlers.carry), ("return", line.idlers.return_)):
        given = 0.0 if idlers.roll.drag is None else si(idlers.roll.drag)
        changes[f"idlers.{strand}.roll.drag"] = f"{given + 50.0!r} N"
    try:
        more = conveyor.analyse(with_fields(line, changes))
    except ConveyorError as error:
        _said_well(error)
        return
    before, after = result.balance, more.balance
    assert after.forces.total > before.forces.total
    assert after.power.belt > before.power.belt
    assert after.power.motor > before.power.motor


def _slack_belts_fail(result: conveyor.Analysis, verdicts: set[str]) -> None:
    """Where a tension is negative, in whatever state, a check fails."""
    states = result.balance.equilibrium.states.values()
    if any(state.smallest < 0.0 for state in states):
        assert "FAIL" in verdicts


def run(seed: int, *, whole: bool = True) -> tuple[str, str]:
    """What was drawn, and how it ends or what does not hold of it."""
    said, data = drawn(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", conveyor.ValidityWarning)
        try:
            return said, outcome(data, whole=whole)
        except Exception as error:  # noqa: BLE001 whatever it is, it is a fault
            frame = traceback.extract_tb(error.__traceback__)[-1]
            return said, f"{FAULT}: {type(error).__name__} in {frame.name}: {error}"
