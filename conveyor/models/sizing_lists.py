"""Items of makers' lists that a sized design is built of, instead of the series of the package."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Final, Self, TypeAlias

from pydantic import Field, ValidationInfo, WithJsonSchema, model_validator

from conveyor.errors import InputError
from conveyor.laws.tension import usual_stiffness
from conveyor.models.base import Model, Problem, raise_problems
from conveyor.models.library_items import find_item
from conveyor.models.maker_lists import MAKER_KINDS, Listed, ListedItem, MakerKind, MakerLists
from conveyor.units import read_si

_BEARING_FIELDS: Final = ("dynamic_rating", "distance")
_RATED_FIELDS: Final = {"pulleys": "face_width", "gearboxes": "gear_torque", "couplings": "coupling_torque"}
_TRAIN_FIELDS: Final = ("motor_speed", "inertia")  # of motors, for gearboxes: ratio and the masses behind it
ALL: Final = "all"
_SCHEMA: Final = {"anyOf": [{"const": ALL}, {"type": "array", "items": {"type": "string"}}],
                  "description": "Names of items, or `all`."}  # fmt: skip
Items: TypeAlias = Annotated[tuple[Listed, ...], Field(max_length=1000), WithJsonSchema(_SCHEMA)]


class ListedSeries(Model):
    """Makers' items to choose from, by name or `all`; the package's series for kinds without."""

    rolls: Items = ()
    """Rolls, by name or `all`: for each width and diameter those of the lengths that its sets need."""
    belts: Items = ()
    """Belts, likewise; one listed with its covers has those."""
    motors: Items = ()
    """Motors, likewise."""
    pulleys: Items = ()
    """Pulleys, likewise: the smallest that the belt allows, wide enough, and that bear their tensions."""
    gearboxes: Items = ()
    """Gearboxes of listed motors, likewise: by the ratio that the belt speed asks for, and their torque."""
    couplings: Items = ()
    """Couplings of listed motors, likewise, by their torque."""
    backstops: Items = ()
    """Backstops, likewise, by the torque that holds the loaded belt in the worst load."""
    brakes: Items = ()
    """Brakes, likewise, by the force that holds it."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, Mapping):
            return data
        problems, found = list[Problem](), dict(data)
        for kind in MAKER_KINDS:
            asked = data.get(kind)
            if asked == ALL or isinstance(asked, list | tuple):
                found[kind] = tuple(_find_items(kind, asked, info, problems))
        raise_problems(cls.__name__, problems)
        return found

    @model_validator(mode="after")
    def _usable(self) -> Self:
        problems = []
        for kind in MAKER_KINDS:
            for i, item in enumerate(self.items(kind)):
                missing = _missing_field(item) or self._missing_of_motor(item)
                if item.kind != kind:
                    problems.append(Problem((kind, i), f'got "{item.name}", which is of {item.kind}'))
                elif missing:
                    told = (
                        f'"{item.name}" has no {missing}, which sizing needs; add it to the list, or name the items to '
                        f"use instead of {ALL}"
                    )
                    problems.append(Problem((kind, i), told))
            if self._turned(kind) and not self.items("motors"):
                told = f"given without listed.motors, whose speed {kind} are chosen by; list motors, or remove {kind}"
                problems.append(Problem((kind,), told))
        raise_problems(type(self).__name__, problems)
        return self

    def _missing_of_motor(self, item: ListedItem) -> str:
        """Field that gearboxes or couplings need of a motor; empty if none."""
        if item.kind != "motors":
            return ""
        turned = any(self._turned(kind) for kind in ("couplings", "backstops", "brakes"))
        needed = _TRAIN_FIELDS if self.items("gearboxes") else _TRAIN_FIELDS[:1] if turned else ()
        return next((name for name in needed if name not in item.fields), "")

    def _turned(self, kind: MakerKind) -> bool:
        """True if items of a kind are chosen by the speed of the motor."""
        at_motor = {"backstops": "backstop_shaft", "brakes": "brake_shaft"}.get(kind)
        return any(
            kind in {"gearboxes", "couplings"} or (at_motor is not None and item.fields.get(at_motor) == "motor")
            for item in self.items(kind)
        )

    def items(self, kind: MakerKind) -> tuple[ListedItem, ...]:
        """Items of a kind; names are items once they are read."""
        return tuple(item for item in getattr(self, kind) if isinstance(item, ListedItem))


def _find_items(
    kind: MakerKind, asked: str | list[Any] | tuple[Any, ...], info: ValidationInfo, problems: list[Problem]
) -> Iterator[Any]:
    """All items of a kind, or those of names; those that are written out as they are."""
    if isinstance(asked, str):
        lists: MakerLists = (info.context or {}).get("lists") or MakerLists()
        try:
            found = lists.every(kind)
            told = f"got {ALL}, but makers' lists have no {kind}; conveyor library add LIST.xlsx reads them"
        except InputError as error:
            found, told = [], str(error)
        if not found:
            problems.append(Problem((kind,), told))
        yield from found
        return
    for i, name in enumerate(asked):
        try:
            yield find_item((kind,), name, info) if isinstance(name, str) else name
        except InputError as error:
            problems.append(Problem((kind, i), str(error)))


def _missing_field(item: ListedItem) -> str:
    """Field that sizing needs and an item has not; empty if none."""
    fields = item.fields
    if item.kind in _RATED_FIELDS and _RATED_FIELDS[item.kind] not in fields:
        return _RATED_FIELDS[item.kind]
    if item.kind == "rolls":
        return next((f"bearing.{name}" for name in _BEARING_FIELDS if name not in fields.get("bearing", {})), "")
    if item.kind == "belts":
        carcass = fields.get("carcass", {})
        if not {"strength", "rating"} & set(carcass):
            return "carcass.strength"
        strength, rating = (
            read_si(carcass[name], "line force") if name in carcass else None for name in ("strength", "rating")
        )
        if "stiffness" not in carcass and usual_stiffness(strength, rating=rating, carcass=carcass["kind"]) is None:
            return "carcass.stiffness"
    return ""
