"""What all models share: frozen, strict, replaceable, picklable, hashable."""

from __future__ import annotations

import copy
import json
import pickle
from collections.abc import Callable, Iterator
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

import conveyor
from conveyor.errors import InputError, SpecError
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.models.base import Model
from conveyor.models.belt import Belt
from conveyor.units import quantity, text

ROLL = {"diameter": "159 mm", "length": "465 mm", "rotating_mass": "5 kg"}


def test_models_are_frozen() -> None:
    roll = Roll(**ROLL)
    with pytest.raises(InputError, match=r"^diameter: a Roll does not change; replace\(diameter=\.\.\.\)"):
        roll.diameter = quantity("1 m")  # type: ignore[misc]
    with pytest.raises(InputError, match=r"^diameter: a Roll does not change; replace\(\)"):
        del roll.diameter
    assert text(roll.diameter) == "159 mm"


@pytest.mark.parametrize(
    ("make", "path"),
    [
        (lambda data: Conveyor(**data), "belt.speed"),
        (Conveyor.model_validate, "belt.speed"),
        (Conveyor.from_data, "belt.speed"),
        (lambda data: Conveyor.model_validate_json(json.dumps(data)), "belt.speed"),
        (Conveyor.model_validate_strings, "belt.speed"),
        (lambda data: Belt(**data["belt"]), "speed"),
    ],
    ids=["class", "validate", "from_data", "json", "strings", "part"],
)
def test_every_way_in_refuses_with_all_places(
    conveyor_data: dict[str, Any], make: Callable[[dict[str, Any]], object], path: str
) -> None:
    conveyor_data["belt"] |= {"speed": "50 m/s", "width": "1200 kg"}
    with pytest.raises(SpecError, match=r"speed: got 50 m/s, allowed: > 0 m/s and <= 20 m/s") as caught:
        make(conveyor_data)
    found = dict(caught.value.problems)
    assert found[path.replace("speed", "width")] == ('got "1200 kg" (a mass), expected a length such as "1200 mm"')
    assert str(caught.value).splitlines() == [f"{at}: {what}" for at, what in caught.value.problems]
    twin = pickle.loads(pickle.dumps(caught.value))  # noqa: S301 made here
    assert (str(twin), twin.problems) == (str(caught.value), caught.value.problems)
    assert isinstance(caught.value, conveyor.ConveyorError)


def _models(model: type[Model]) -> Iterator[type[Model]]:
    for one in model.__subclasses__():
        yield one
        yield from _models(one)


@pytest.mark.parametrize("model", sorted(set(_models(Model)), key=lambda one: one.__name__))
def test_no_model_raises_an_error_of_pydantic(model: type[Model]) -> None:
    with pytest.raises(SpecError, match=r'no_such_field: unknown key "no_such_field"'):
        model(no_such_field=1)


def test_unknown_keys_are_refused() -> None:
    with pytest.raises(SpecError, match="colour"):
        Roll(**ROLL, colour="red")


def test_replace_checks_again_and_keeps_the_rest() -> None:
    roll = Roll(**ROLL)
    bigger = roll.replace(diameter="7 in")
    assert text(bigger.diameter) == "7 in"
    assert bigger.length == roll.length
    assert text(roll.diameter) == "159 mm"
    with pytest.raises(InputError, match=r"diameter: got -7 in, allowed: >= "):
        roll.replace(diameter="-7 in")
    with pytest.raises(InputError, match='colour: unknown key "colour"'):
        roll.replace(colour="red")


def test_replace_reports_every_refusal() -> None:
    with pytest.raises(InputError) as caught:
        Roll(**ROLL).replace(diameter=5, length="5 kg", rotating_mass="5 ton")
    assert [line.split(":")[0] for line in str(caught.value).splitlines()] == [
        "diameter",
        "length",
        "rotating_mass",
    ]


def test_replace_checks_between_fields(conveyor_data: dict[str, Any]) -> None:
    line = Conveyor.model_validate(conveyor_data)
    with pytest.raises(InputError, match=r"^material\.flow: got 2000 t/h, which at 1 m/s"):
        line.replace(belt=line.belt.replace(speed="1 m/s"))


def test_replace_knows_aliases_and_names(conveyor_data: dict[str, Any]) -> None:
    idlers = Conveyor.model_validate(conveyor_data).idlers
    other = idlers.return_.replace(spacing="2.5 m")
    assert idlers.replace(return_=other) == idlers.replace(**{"return": other})
    assert idlers.replace(return_=other).return_.spacing == quantity("2.5 m")


def test_pickle_copy_hash(conveyor_data: dict[str, Any]) -> None:
    line = Conveyor.model_validate(conveyor_data)
    for twin in (pickle.loads(pickle.dumps(line)), copy.deepcopy(line)):  # noqa: S301
        assert twin == line
        assert hash(twin) == hash(line)
        assert twin.as_data() == line.as_data()


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("rolls", "3", "allowed: 1, 2, 3, 4, 5 or 6"),
        ("rolls", 7, "allowed: 1, 2, 3, 4, 5 or 6"),
        ("spacing", 1.5, 'give the unit, e.g. "1.5 m"'),
        ("trough_angle", "35 degC", r'got "35 degC" \(a temperature\), expected an angle'),
        ("trough_angle", "75 deg", "got 75 deg, allowed: >= 0 deg and <= 60 deg"),
    ],
)
def test_values_are_not_coerced(field: str, value: object, message: str) -> None:
    data = {"rolls": 3, "spacing": "1.5 m", "trough_angle": "35 deg", "roll": ROLL}
    IdlerSet.model_validate(data)
    with pytest.raises(SpecError, match=message):
        IdlerSet.model_validate(data | {field: value})


@pytest.mark.parametrize("value", ["0.35", True, float("nan"), float("inf"), 0, -1, 1.5])
def test_plain_numbers_are_strict_and_bounded(conveyor_data: dict[str, Any], value: object) -> None:
    conveyor_data["drive"]["friction"] = value
    with pytest.raises(SpecError, match=r"drive\.friction"):
        Conveyor.model_validate(conveyor_data)


def every_model(of: type[Model] = Model) -> Iterator[type[Model]]:
    for one in of.__subclasses__():
        if one.__module__.startswith("conveyor."):
            yield one
        yield from every_model(one)


WHOLE = [
    (one, name)
    for one in dict.fromkeys(every_model())
    for name, field in one.model_fields.items()
    if field.annotation is int
]


@pytest.mark.parametrize(("model", "name"), WHOLE)
def test_whole_numbers_of_numpy_are_taken(model: type[Model], name: str):
    """As Python's; a truth value is no number."""
    field = model.model_fields[name]
    read = TypeAdapter(Annotated[field.annotation, *field.metadata])
    taken = read.validate_python(np.int64(1 if name != "population" else 2))
    assert type(taken) is int
    with pytest.raises(ValidationError):
        read.validate_python(np.int64(-1))
    with pytest.raises(ValidationError):
        read.validate_python(2.5)
    if any(getattr(each, "strict", False) for each in field.metadata):
        with pytest.raises(ValidationError):
            read.validate_python(True)


def test_there_are_whole_numbers():
    assert {"motors", "gauss_points", "format_version", "seed"} <= {name for _, name in WHOLE}
