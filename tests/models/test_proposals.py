"""What a message proposes in place of a refused quantity is allowed where it is proposed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Annotated, Any, get_args, get_origin

import pytest
from pydantic import TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from conveyor.models import Conveyor, RubberCompound
from conveyor.models.base import Model
from conveyor.models.sizing import SizingDuty
from conveyor.units import Bounds, Measure

_PROPOSED = re.compile(r'(?:such as|e\.g\.|write|or|mean|sign:) "([^"]+)"')


def _models(model: type[Model], known: dict[str, type[Model]]) -> dict[str, type[Model]]:
    """A model and all below it."""

    def below(annotation: Any) -> None:
        if isinstance(annotation, type) and issubclass(annotation, Model):
            _models(annotation, known)
        for argument in get_args(annotation):
            below(argument)

    if model.__name__ not in known:
        known[model.__name__] = model
        for field in model.model_fields.values():
            below(field.annotation)
    return known


def _quantities(model: type[Model]) -> Iterator[tuple[str, Any]]:
    """Fields of a model that take a quantity in a range, and the type of each."""

    def ranged(annotation: Any) -> Iterator[Any]:
        if get_origin(annotation) is Annotated:
            marks = get_args(annotation)[1:]
            if any(isinstance(mark, Measure) for mark in marks) and any(isinstance(m, Bounds) for m in marks):
                yield annotation
        for argument in get_args(annotation):
            yield from ranged(argument)

    for name, field in model.model_fields.items():
        yield from ((name, each) for each in ranged(_whole(field)))


def _whole(field: FieldInfo) -> Any:
    return Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation


_FIELDS = {
    f"{model.__name__}.{name}": annotation
    for model in {k: m for top in (Conveyor, RubberCompound, SizingDuty) for k, m in _models(top, {}).items()}.values()
    for name, annotation in _quantities(model)
}


def test_there_are_ranges_of_all_models() -> None:
    assert len(_FIELDS) > 150
    assert {"IdlerSet.spacing", "Belt.width", "Section.length"} <= set(_FIELDS)


@pytest.mark.parametrize("name", _FIELDS)
def test_whatever_is_proposed_is_allowed(name: str) -> None:
    adapter = TypeAdapter(_FIELDS[name])
    for refused in (
        "3 furlong",
        "1",
        "1000",
        "0.02",
        "1 000 m",
        "1,5 m",
        "2 tons",
        "3 milimeter",
        "",
        "1e9 s",
        7,
    ):
        try:
            adapter.validate_python(refused)
        except ValidationError as error:
            (wrong,) = error.errors()
        else:
            continue  # a plain number is a fraction
        for proposed in _PROPOSED.findall(wrong["msg"]):
            adapter.validate_python(proposed)


def test_a_spacing_of_the_wrong_kind_is_told_one_that_sets_have() -> None:
    adapter = TypeAdapter(_FIELDS["IdlerSet.spacing"])
    with pytest.raises(ValidationError, match=r'got "2 kg" \(a mass\), expected a length such as "15 m"'):
        adapter.validate_python("2 kg")
    with pytest.raises(ValidationError, match=r'got "1000" without a unit; give the unit, e\.g\. "1000 mm"'):
        adapter.validate_python("1000")
    assert adapter.json_schema()["examples"] == ["15 m"]
