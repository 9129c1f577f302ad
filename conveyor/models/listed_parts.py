"""Parts of a drive from makers' lists: what they give to the drive that names them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pydantic import BaseModel, ValidationInfo

from conveyor.errors import InputError
from conveyor.models.base import Problem, raise_problems
from conveyor.models.library_items import find_item, merge_fields
from conveyor.models.maker_lists import DRIVE_KINDS, ListedItem
from conveyor.units import quantity

_OF_EACH: Final = ("installed_power", "inertia")
"""Fields of one motor; those of a drive are of all its motors together."""
_HOLDING_FIELDS: Final = (("brake_force", "brake_torque", "brake_shaft"), ("backstop_torque", "backstop_shaft"))
"""Fields that are one figure together: of a drive that gives its own, none is that of the listed part."""


def with_listed_parts(data: Mapping[str, Any], drive: type[BaseModel], info: ValidationInfo) -> Mapping[str, Any]:
    """Fill in what the listed parts of a drive give; what it gives itself goes before.

    Efficiencies become parts of the first drive's train, which holds for all drives.

    Raises
    ------
    SpecError
        A name is in no list, or two items are of one kind.
    """
    named = data.get("listed")
    if not isinstance(named, list | tuple) or not named:
        return data
    items: list[Any] = list(named)
    for i, name in enumerate(items):
        if isinstance(name, str):
            try:
                items[i] = find_item(DRIVE_KINDS, name, info)
            except InputError as error:
                raise_problems(drive.__name__, [Problem(("listed", i), str(error))])
    parts = [item for item in items if isinstance(item, ListedItem)]
    if len(parts) < len(items):
        return data  # written out, with all its values; or refused at its own field
    for i, part in enumerate(parts):
        if part.kind in {other.kind for other in parts[:i]}:
            message = f'got "{part.name}", the second of {part.kind}; a drive has one, motors says how many motors'
            raise_problems(drive.__name__, [Problem(("listed", i), message)])
    given: dict[str, Any] = {}
    for part in parts:
        given |= _drive_fields(part, data.get("motors", 1))
    train = [
        {
            "name": f"{part.one} {part.name}",
            "efficiency": part.fields["efficiency"],
            "side": "mains" if part.kind == "motors" else "belt",
        }
        for part in parts
        if "efficiency" in part.fields
    ]
    if train and not data.get("train") and data.get("efficiency") is None:
        given["train"] = train
    own = {name for part in _HOLDING_FIELDS if any(data.get(name) is not None for name in part) for name in part}
    usable = {name: value for name, value in given.items() if name in drive.model_fields and name not in own}
    of_spec = {name: value for name, value in data.items() if name != "train" or value}
    return merge_fields(usable, of_spec) | {"listed": parts}


def _drive_fields(part: ListedItem, motors: object) -> dict[str, Any]:
    """Fields of a drive that a part gives."""
    fields = {name: value for name, value in part.fields.items() if name != "efficiency"}
    if isinstance(motors, int) and motors > 1:
        fields |= {name: motors * quantity(fields[name]) for name in _OF_EACH if name in fields}
    return fields
