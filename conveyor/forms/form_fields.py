"""Fields of the models to fill in: single fields, groups, tables."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, TypeAlias, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MaxLen, MinLen
from pydantic import BaseModel, StringConstraints, TypeAdapter
from pydantic.fields import FieldInfo

from conveyor.models.base import field_docs
from conveyor.models.compound import CompoundReference
from conveyor.units import KINDS, Bounds, Measure, System, quantity, text
from conveyor.units.registry import UNITS
from conveyor.units.unit_systems import SYSTEMS

LeafKind = Literal[
    "quantity", "number", "count", "switch", "choice", "text", "list", "reference", "json"
]  # fmt: skip
Path: TypeAlias = tuple[str, ...]

_REFERENCE: Final = type(get_args(CompoundReference)[1])
_LISTABLE: Final = {"quantity", "number", "count", "choice", "text"}
_PLAIN_KINDS: Final[dict[Any, LeafKind]] = {bool: "switch", int: "count", float: "number", str: "text"}


@dataclass(frozen=True, kw_only=True)
class FormField:
    """A value to fill in, with its unit where it has one."""

    key: str
    kind: LeafKind
    doc: str = ""
    required: bool = False
    default: Any = None
    """Plain data as in a spec; None without a default."""
    allowed: str = ""
    units: tuple[str, ...] = ()
    measure: str = ""
    """Kind of quantity."""
    choices: tuple[Any, ...] = ()
    low: float | None = None
    """Least plain number (not of quantities)."""
    high: float | None = None
    item: FormField | None = None
    """Item of a list."""
    single: bool = False
    """True if a list may be given as one item."""
    model: type[BaseModel] | None = None
    """Model of a reference."""


@dataclass(frozen=True, kw_only=True)
class FieldGroup:
    """A nested model."""

    key: str
    doc: str
    required: bool
    parts: tuple[Part, ...]


@dataclass(frozen=True, kw_only=True)
class FieldTable:
    """A list of models: one row an item."""

    key: str
    doc: str
    required: bool
    item: FieldGroup
    allowed: str = ""

    @property
    def parts(self) -> tuple[Part, ...]:
        """Fields of an item."""
        return self.item.parts


Part: TypeAlias = FormField | FieldGroup | FieldTable


@dataclass(frozen=True, kw_only=True)
class _FieldHead:
    """Key, docstring, requirement and default of a field."""

    key: str
    doc: str = ""
    required: bool = True
    default: Any = None


@cache
def model_layout(model: type[BaseModel]) -> FieldGroup:
    """Return the fields of a model, in its order, nested models and lists included.

    Parameters
    ----------
    model : type of BaseModel
        Fields are named as in specs (by alias). What has no form of its own here (mappings, lists of
        lists, models that contain themselves) becomes a text field of JSON.

    Examples
    --------
    >>> from conveyor.models import Cleaner
    >>> [(part.key, part.required, part.allowed) for part in model_layout(Cleaner).parts if part.key == "width"]
    [('width', True, '> 0 m, ≤ 5 m')]
    """
    return FieldGroup(key="", doc=first_paragraph(model.__doc__), required=True, parts=_model_parts(model, ()))


def first_paragraph(text: str | None) -> str:
    """First paragraph of a docstring as one line."""
    return " ".join((text or "").strip().split("\n\n")[0].split())


def leaf_fields(part: Part) -> Iterator[FormField]:
    """All single fields of a part, including those of tables."""
    if isinstance(part, FormField):
        yield part
    else:
        for inner in part.parts:
            yield from leaf_fields(inner)


def _model_parts(model: type[BaseModel], seen: tuple[type[BaseModel], ...]) -> tuple[Part, ...]:
    docs = field_docs(model)
    return tuple(
        _field_part(info.alias or name, info, docs.get(name), (*seen, model))
        for name, info in model.model_fields.items()
    )


def _field_part(key: str, info: FieldInfo, doc: str | None, seen: tuple[type[BaseModel], ...]) -> Part:
    outer = (*info.metadata, *((info,) if info.discriminator else ()))
    base, marks = _split_annotation(info.annotation, outer)
    about = _FieldHead(key=key, doc=first_paragraph(doc), required=info.is_required(), default=_default_data(info))
    return _build_part(about, base, marks, seen)


def _default_data(info: FieldInfo) -> Any:
    if info.is_required():
        return None
    value = info.get_default(call_default_factory=True, validated_data={})
    if value is None or isinstance(value, BaseModel):
        return None
    annotation: Any = Annotated[(info.annotation, *info.metadata)] if info.metadata else info.annotation
    return TypeAdapter(annotation).dump_python(value, mode="json")


def _split_annotation(annotation: Any, marks: tuple[Any, ...]) -> tuple[Any, tuple[Any, ...]]:
    """Split a type into the type without None and its annotations."""
    origin = get_origin(annotation)
    if origin is Annotated:
        inner, *more = get_args(annotation)
        flat = [mark for m in more for mark in ((m, *m.metadata) if isinstance(m, FieldInfo) else (m,))]
        return _split_annotation(inner, (*marks, *flat))
    if origin in {Union, UnionType}:
        kept = tuple(arm for arm in get_args(annotation) if arm is not NoneType)
        return _split_annotation(kept[0], marks) if len(kept) == 1 else (Union[kept], marks)  # noqa: UP007
    return annotation, marks


def _union_members(base: Any) -> tuple[Any, ...]:
    return get_args(base) if get_origin(base) in {Union, UnionType} else (base,)


def _build_part(about: _FieldHead, base: Any, marks: tuple[Any, ...], seen: tuple[type[BaseModel], ...]) -> Part:
    models = [_split_annotation(arm, ())[0] for arm in _union_members(base)]
    if all(isinstance(model, type) and issubclass(model, BaseModel) for model in models):
        if any(isinstance(mark, _REFERENCE) for mark in marks):
            return _make_leaf(about, "reference", model=models[0])
        if not any(model in seen for model in models):
            group = _field_group(about, models, marks, seen)
            if group is not None:
                return group
    items = _item_type(base)
    if items is not None:
        inner = _build_part(_FieldHead(key=about.key), *_split_annotation(items, ()), seen)
        if isinstance(inner, FieldGroup):
            doc, allowed = about.doc or inner.doc, _length_text(marks, "row")
            return FieldTable(key=about.key, doc=doc, required=about.required, item=inner, allowed=allowed)
        if isinstance(inner, FormField) and inner.kind in _LISTABLE:
            allowed = ", ".join(filter(None, (inner.allowed, _length_text(marks, "value"))))
            return _make_leaf(about, "list", item=inner, allowed=allowed, choices=inner.choices)
    return _scalar_leaf(about, base, marks, seen)


def _field_group(
    about: _FieldHead, models: list[Any], marks: tuple[Any, ...], seen: tuple[type[BaseModel], ...]
) -> FieldGroup | None:
    """Field group of one model, or of all models that a tag chooses between."""
    tag = next((mark.discriminator for mark in marks if isinstance(mark, FieldInfo)), None)
    if len(models) == 1:
        parts = _model_parts(models[0], seen)
        doc = about.doc or first_paragraph(models[0].__doc__)
    elif isinstance(tag, str):
        parts = _merge_variants([_model_parts(model, seen) for model in models], tag)
        doc = about.doc or "; ".join(first_paragraph(model.__doc__) for model in models)
    else:
        return None
    return FieldGroup(key=about.key, doc=doc, required=about.required, parts=parts)


def _merge_variants(every: list[tuple[Part, ...]], tag: str) -> tuple[Part, ...]:
    """Merge the fields of tagged variants, each with its tags in the docstring."""
    tags = [next(part for part in parts if part.key == tag) for parts in every]
    choices = tuple(choice for leaf in tags if isinstance(leaf, FormField) for choice in leaf.choices)
    merged: dict[str, Part] = {
        tag: _make_leaf(_FieldHead(key=tag, doc="Decides which fields apply."), "choice", choices=choices)
    }
    for parts, own in zip(every, tags, strict=True):
        values = own.choices if isinstance(own, FormField) else ()
        for part in parts:
            if part.key != tag:
                told = f"({tag}: {', '.join(map(str, values))})"
                new = replace(part, doc=f"{part.doc} {told}".strip(), required=False)
                old = merged.get(part.key)
                merged[part.key] = new if old is None else _merge_fields(old, new)
    return tuple(merged.values())


def _merge_fields(old: Part, new: Part) -> Part:
    """Merge two variants' fields of the same name."""
    doc = f"{old.doc}; {new.doc}"
    if replace(old, doc="") == replace(new, doc=""):
        return replace(old, doc=doc)
    if isinstance(old, FormField) and isinstance(new, FormField) and old.kind == new.kind == "quantity":
        units = tuple(dict.fromkeys(old.units + new.units))
        return replace(old, doc=doc, units=units, allowed="", choices=old.choices + new.choices)
    return _make_leaf(_FieldHead(key=old.key, doc=doc, required=False), "json")


def _item_type(base: Any) -> Any:
    """Item type of a homogeneous list; None for other types."""
    if get_origin(base) not in {tuple, list}:
        return None
    kept = [arm for arm in get_args(base) if arm is not Ellipsis]
    return kept[0] if kept and all(arm == kept[0] for arm in kept) else None


def _make_leaf(about: _FieldHead, kind: LeafKind, **more: Any) -> FormField:
    return FormField(key=about.key, doc=about.doc, required=about.required, default=about.default, kind=kind, **more)


def _scalar_leaf(about: _FieldHead, base: Any, marks: tuple[Any, ...], seen: tuple[type[BaseModel], ...]) -> FormField:
    measure = next((mark for mark in marks if isinstance(mark, Measure)), None)
    if measure is not None:
        units = tuple(unit for unit in dict.fromkeys(KINDS[measure.kind].units.values()) if unit)
        return _make_leaf(about, "quantity", units=units, measure=measure.kind, allowed=_bounds_text(marks))
    if get_origin(base) is Literal:
        return _make_leaf(about, "choice", choices=get_args(base))
    if isinstance(base, type) and issubclass(base, Enum):
        return _make_leaf(about, "choice", choices=tuple(member.value for member in base))
    if base in _PLAIN_KINDS:
        low = next((float(getattr(m, _LIMIT_NAMES[type(m)])) for m in marks if isinstance(m, Gt | Ge)), None)
        high = next((float(getattr(m, _LIMIT_NAMES[type(m)])) for m in marks if isinstance(m, Lt | Le)), None)
        return _make_leaf(about, _PLAIN_KINDS[base], allowed=_limits_text(marks), low=low, high=high)
    either = _union_leaf(about, base, seen)
    if either is not None:
        return either
    annotation: Any = Annotated[(base, *marks)] if marks else base
    schema = TypeAdapter(annotation).json_schema()
    examples = ", ".join(f'such as "{example}"' for example in schema.get("examples", ())[:1])
    return _make_leaf(about, "text" if schema.get("type") == "string" else "json", allowed=examples)


def _union_leaf(about: _FieldHead, base: Any, seen: tuple[type[BaseModel], ...]) -> FormField | None:
    """Field of a union: quantity or choice, list or single item; None for other unions."""
    if len(_union_members(base)) != 2:
        return None
    arms = [_build_part(_FieldHead(key=about.key), *_split_annotation(arm, ()), seen) for arm in _union_members(base)]
    by_kind = {arm.kind: arm for arm in arms if isinstance(arm, FormField)}
    if set(by_kind) == {"quantity", "choice"}:
        words = by_kind["choice"].choices
        allowed = " or ".join(filter(None, (by_kind["quantity"].allowed, *map(str, words))))
        of = by_kind["quantity"]
        return _make_leaf(about, "quantity", units=of.units, measure=of.measure, choices=words, allowed=allowed)
    if set(by_kind) == {"text", "list"} and by_kind["list"].item == by_kind["text"]:
        return _make_leaf(about, "list", item=by_kind["text"], single=True)
    return None


_LIMIT_NAMES: Final[dict[type, str]] = {Gt: "gt", Ge: "ge", Lt: "lt", Le: "le"}
_LIMIT_SIGNS: Final = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}


def _bounds_text(marks: tuple[Any, ...]) -> str:
    """Range of a quantity as text."""
    limits = [(name, getattr(m, name)) for m in marks if isinstance(m, Bounds) for name in _LIMIT_SIGNS]
    return ", ".join(f"{_LIMIT_SIGNS[name]} {limit}" for name, limit in limits if limit is not None)


def _limits_text(marks: tuple[Any, ...]) -> str:
    """Range of a plain number, or lengths of a text, as text."""
    said = [
        f"{_LIMIT_SIGNS[_LIMIT_NAMES[type(m)]]} {getattr(m, _LIMIT_NAMES[type(m)]):g}"
        for m in marks
        if type(m) in _LIMIT_NAMES
    ]
    texts = (mark.max_length for mark in marks if isinstance(mark, StringConstraints))
    said += [f"at most {longest} characters" for longest in texts if longest is not None]
    return ", ".join(said) or _length_text(marks, "character")


def _length_text(marks: tuple[Any, ...], what: str) -> str:
    least = [
        f"at least {m.min_length} {what}s".replace("1 " + what + "s", "1 " + what)
        for m in marks
        if isinstance(m, MinLen)
    ]
    most = [f"at most {m.max_length} {what}s" for m in marks if isinstance(m, MaxLen)]
    return ", ".join(least + most)


_BOUND_PATTERN: Final = re.compile(r"([<>≤≥]) ([^ ,]+ [^ ,]+)")
_DIGITS: Final = 3


def limits_in_unit_of(allowed: str, value: Any) -> str:
    """Ranges in the unit of a given value, to three digits rounded inwards.

    Examples
    --------
    >>> limits_in_unit_of("> 0 m, ≤ 5 m", "42 in"), limits_in_unit_of("> 0, ≤ 1", 0.35)
    ('> 0 in, ≤ 196 in', '> 0, ≤ 1')
    """
    return _BOUND_PATTERN.sub(lambda match: _limit_text(match, value), allowed)


def _limit_text(match: re.Match[str], value: Any) -> str:
    limit = in_unit_of(match[2], value)
    if limit is None or limit[1] == match[2].split(" ")[1]:
        return match[0]
    number, unit = limit
    digits = _DIGITS - 1 - (math.floor(math.log10(abs(number))) if number else 0)
    towards = math.ceil if match[1] in ">≥" else math.floor
    near = round(number, digits)  # 19999.999999999996 is 20000
    inward = near if math.isclose(near, number, rel_tol=1e-9) else towards(number * 10.0**digits) / 10.0**digits
    return f"{match[1]} {_plain_number(inward)} {unit}"


def in_unit_of(given: str, value: Any) -> tuple[float, str] | None:
    """Number and unit of a quantity in the unit of another; None where the other is no quantity."""
    value = value[0] if isinstance(value, list) and value else value
    if not isinstance(value, str) or len(value.split(" ")) != 2:
        return None
    other = quantity(value)
    unit = text(other).split(" ")[1]
    return float(quantity(given).to(other.units).magnitude), unit


def _plain_number(number: float) -> str:
    return f"{number:.0f}" if abs(number) >= 10.0**_DIGITS else f"{number:.4g}"


_MISREAD_IN_US: Final = "tph"
"""Metric tonnes per hour; a US reader takes them for short tons."""


def in_system(leaf: FormField, system: System, units: Iterable[str | None]) -> FormField:
    """Field with range, default and units in a system; `units` are those filled in.

    A unit that a US reader takes for another is left out, where it is not filled in.
    """
    of = leaf.item if leaf.kind == "list" and leaf.item is not None else leaf
    if system == "SI" or of.kind != "quantity" or not of.units or not of.measure:
        return leaf
    filled = tuple(filter(None, units))
    unit = filled[0] if filled else _unit_in_system(of, system)
    if not unit:
        return leaf
    value = f"1 {unit}"
    default = leaf.default
    if isinstance(default, str) and (known := in_unit_of(default, value)) is not None:
        default = f"{known[0]:.4g} {unit}"
    others = (each for each in leaf.units if each != _MISREAD_IN_US)
    offered = tuple(dict.fromkeys((unit, *filled, *others))) if leaf.units else ()
    return replace(leaf, allowed=limits_in_unit_of(leaf.allowed, value), default=default, units=offered)


def _unit_in_system(leaf: FormField, system: System) -> str:
    """Unit of the kind in reports, empty where specs do not know it; that of thicknesses for lengths."""
    unit = SYSTEMS[system].shown("thickness" if leaf.measure == "length" else leaf.measure).unit
    return unit if unit in UNITS else ""
