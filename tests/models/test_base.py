"""What all models share: frozen, strict, replaceable, picklable, hashable."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest
from pydantic import ValidationError

from conveyor.errors import InputError
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.units import quantity, text

ROLL = {"diameter": "159 mm", "length": "465 mm", "rotating_mass": "5 kg"}


def test_models_are_frozen() -> None:
    roll = Roll(**ROLL)
    with pytest.raises(ValidationError, match="frozen"):
        roll.diameter = quantity("1 m")  # type: ignore[misc]


def test_unknown_keys_are_refused() -> None:
    with pytest.raises(ValidationError, match="colour"):
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
        ("rolls", "3", "Input should be 1, 2, 3, 4 or 5"),
        ("rolls", 6, "Input should be 1, 2, 3, 4 or 5"),
        ("spacing", 1.5, 'give the unit, e.g. "1.5 m"'),
        ("trough_angle", "35 degC", r'got "35 degC" \(a temperature\), expected an angle'),
        ("trough_angle", "75 deg", "got 75 deg, allowed: >= 0 deg and <= 60 deg"),
    ],
)
def test_values_are_not_coerced(field: str, value: object, message: str) -> None:
    data = {"rolls": 3, "spacing": "1.5 m", "trough_angle": "35 deg", "roll": ROLL}
    IdlerSet.model_validate(data)
    with pytest.raises(ValidationError, match=message):
        IdlerSet.model_validate(data | {field: value})


@pytest.mark.parametrize("value", ["0.35", True, float("nan"), float("inf"), 0, -1, 1.5])
def test_plain_numbers_are_strict_and_bounded(conveyor_data: dict[str, Any], value: object) -> None:
    conveyor_data["drive"]["friction"] = value
    with pytest.raises(ValidationError, match=r"drive\.friction"):
        Conveyor.model_validate(conveyor_data)
