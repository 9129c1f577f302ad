"""Sizes of makers' items to choose from, and their part of the spec."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from conveyor.laws.belt_strength import RATED_SAFETY
from conveyor.models.belt import RUBBER_DENSITY
from conveyor.models.maker_lists import ListedItem
from conveyor.models.sizing import Carcasses
from conveyor.sizing.design_choice import CarcassClass, RollPiece, RollSize
from conveyor.units import read_si


def listed_rolls(items: Sequence[ListedItem]) -> tuple[RollSize, ...]:
    """Rolls of each diameter and bearing, with all lists' pieces of that diameter."""
    sizes = [(read_si(item.fields["diameter"], "length"), _roll_piece(item)) for item in items]
    return tuple(
        RollSize(diameter, 0.0, 0.0, rating, pieces=tuple(piece for size, piece in sizes if size == diameter))
        for diameter, rating in sorted({(size, piece.rating) for size, piece in sizes})
    )


def _roll_piece(item: ListedItem) -> RollPiece:
    """A roll of a list in SI."""
    fields = item.fields
    return RollPiece(
        item.name,
        read_si(fields["length"], "length"),
        read_si(fields["rotating_mass"], "mass"),
        read_si(fields["bearing"]["dynamic_rating"], "force"),
    )


def listed_carcasses(items: Sequence[ListedItem], kind: Carcasses) -> tuple[CarcassClass, ...]:
    """Belts of steel cord or of textile carcasses, the weakest first."""
    classes = [_carcass_class(item) for item in items]
    alike = (one for one in classes if one.steel_cord == (kind == "steel cord"))
    return tuple(sorted(alike, key=lambda one: (one.strength, one.thickness)))


def _carcass_class(item: ListedItem) -> CarcassClass:
    """Class of a listed belt."""
    carcass, fields = item.fields["carcass"], item.fields

    def read(of: Mapping[str, Any], name: str, kind: str) -> float | None:
        return read_si(of[name], kind) if name in of else None

    strength, rating = (read(carcass, name, "line force") for name in ("strength", "rating"))
    covers = [read(fields.get(cover, {}), "thickness", "length") for cover in ("top_cover", "bottom_cover")]
    own = None if covers[0] is None or covers[1] is None else (covers[0], covers[1])
    steel_cord = carcass["kind"] == "steel cord"
    mass, whole = read(carcass, "mass", "area mass"), read(fields, "mass", "area mass")
    if mass is None and whole is not None and own is not None:
        mass = whole - RUBBER_DENSITY * sum(own)
    return CarcassClass(
        carcass["kind"],
        RATED_SAFETY["steel cord" if steel_cord else "textile"] * (rating or 0.0) if strength is None else strength,
        read_si(carcass["thickness"], "length"),
        mass,
        rating if strength is None else None,
        item.name,
        read(carcass, "stiffness", "line force"),
        own,
    )


def listed_belt(item: ListedItem, carcass: CarcassClass) -> ListedItem:
    """A listed belt for a spec; mass and thickness of the whole belt are left out where its covers are not its own."""
    if carcass.own_covers is not None:
        return item
    fields = {name: value for name, value in item.fields.items() if name not in {"mass", "thickness"}}
    return item.replace(fields=fields)


def listed_motor(item: ListedItem, pulley_speed: float) -> dict[str, Any]:
    """Fields of a drive with a listed motor; its inertia counts where its speed is listed.

    `pulley_speed` [1/s].
    """
    fields = dict(item.fields)
    speed = fields.get("motor_speed")
    if "inertia" in fields and speed is None:
        del fields["inertia"]
    ratio = {}
    if "inertia" in fields and speed is not None:
        ratio["gear_ratio"] = round(read_si(speed, "rotation") / pulley_speed, 4)
    return {"listed": [item.replace(fields=fields)], **ratio}


def motor_power(item: ListedItem) -> float:
    """Rated power of a listed motor [W]."""
    return read_si(item.fields["installed_power"], "power")


def named_item(items: Sequence[ListedItem], name: str) -> ListedItem:
    """Item of a name."""
    return next(item for item in items if item.name == name)
