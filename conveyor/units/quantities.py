"""Quantities with units: read from text, kept as entered (`text`), converted to SI (`si`).

Text such as ``"1200 mm"`` is split by one regular expression and its unit looked up in a table; it never
reaches pint's expression parser.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Annotated, Any, TypeGuard

import pint
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from conveyor.errors import InputError
from conveyor.units.misreadings import (
    LONGEST_TEXT,
    NUMBER,
    NUMBER_UNIT,
    allow_all,
    allowed_example,
    expected_text,
    misread_reason,
)
from conveyor.units.quantity_kinds import KINDS
from conveyor.units.registry import REGISTRY, UNITS
from conveyor.units.unit_systems import System

if TYPE_CHECKING:
    from typing import TypeAlias

    Quantity: TypeAlias = pint.Quantity[float]
else:
    Quantity = REGISTRY.Quantity

_UNIT_TABLES: dict[str | None, dict[str, Any]] = {
    None: UNITS,
    **{key: {form: UNITS[form] for form in kind.units} for key, kind in KINDS.items()},
}
_UNIT_SPELLINGS: dict[Any, str] = {}
for _form, _unit in UNITS.items():
    _UNIT_SPELLINGS.setdefault(_unit, _form)
_PERCENT, _PLAIN = UNITS["%"], UNITS[""]
TextTest = Callable[[str], bool]
"""Test for texts that a message may propose."""
_MEASURE = "measure"  # in the schema of a field


def quantity(value: object, kind: str | None = None) -> Quantity:
    """Read a quantity from text, or check one, and keep number and unit as entered.

    Parameters
    ----------
    value : str or Quantity
        ``"number unit"``; for a fraction a plain number too.
    kind : str, optional
        A key of `conveyor.units.quantity_kinds.KINDS`; without it every unit of the table is taken.

    Raises
    ------
    InputError
        Not a number and a unit of the table, of another kind, not finite, or of an impossible size.

    Examples
    --------
    >>> text(quantity("1200 mm", "length")), si(quantity("1200 mm"))
    ('1200 mm', 1.2)
    """
    return _read_quantity(value, kind, allow_all)


def _read_quantity(value: object, kind: str | None, allows: TextTest) -> Quantity:
    """`quantity` with messages that propose only allowed texts."""
    if isinstance(value, str):
        match = NUMBER_UNIT.fullmatch(value) if len(value) <= LONGEST_TEXT else None
        if match is not None:
            unit = _UNIT_TABLES[kind].get(match[2])
            number = float(match[1])
            if unit is not None and math.isfinite(number):
                return _check_size(_make_quantity(number, unit), kind, allows, match[2])
    elif isinstance(value, pint.Quantity):
        return _check_size(_check_quantity(value, kind, allows), kind, allows)
    elif kind == "fraction" and _is_finite_number(value):
        return _check_size(_make_quantity(float(value), _PLAIN), kind, allows)
    raise InputError(misread_reason(value, kind, allows))


def _check_size(value: Quantity, kind: str | None, allows: TextTest, unit: str | None = None) -> Quantity:
    """Refuse an impossible size of a kind: results would overflow or vanish."""
    if kind == "temperature" and si(value) < 0.0:
        raise InputError(f"got {text(value)}, below absolute zero (-273.15 degC)")
    number = abs(value.magnitude)
    if kind is None or number == 0.0:
        return value
    smallest, largest = _size_limits(kind, _UNIT_SPELLINGS[value.units] if unit is None else unit)
    if smallest <= number <= largest:
        return value
    low, high = KINDS[kind].sizes
    label = "" if kind == "fraction" else f" {si_with_unit(value)[1]}"
    if unit_system(value) == "US" and kind != "temperature":
        low, high, label = (
            float(f"{smallest:.4g}"),
            float(f"{largest:.4g}"),
            f" {_UNIT_SPELLINGS[value.units]}",
        )
    expected = f"{expected_text(kind, allows)}, in size from {low:g} to {high:g}{label}"
    raise InputError(f"got {text(value)}, expected {expected}")


@cache
def _size_limits(kind: str, unit: str) -> tuple[float, float]:
    """Smallest and largest size of a kind in a unit; for scales with an offset in their degrees."""
    scale = _si_scale(UNITS[unit]._units)  # noqa: SLF001 as `si` asks
    one = 1.0 if scale is None or scale[2] else scale[0] / scale[1]
    low, high = KINDS[kind].sizes
    return low / one, high / one


def _is_finite_number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _make_quantity(number: float, unit: Any) -> Quantity:
    built: Quantity = REGISTRY.Quantity(number, unit)
    return built


def _check_quantity(value: Any, kind: str | None, allows: TextTest) -> Quantity:
    """Check a quantity built in Python: our registry, a unit of the table, finite."""
    expected = "a quantity" if kind is None else expected_text(kind, allows)
    if not isinstance(value, REGISTRY.Quantity):
        raise InputError(f"got {value} of another pint registry, expected {expected}; give it as text")
    if value.units not in _UNIT_TABLES[kind].values():
        allowed = ", ".join(form for form in _UNIT_TABLES[kind] if form)
        raise InputError(f"got {value}, expected {expected}; units allowed (convert with .to): {allowed}")
    number = float(value.magnitude)
    if not math.isfinite(number):
        raise InputError(f"got {value}, expected a finite number")
    return _make_quantity(number, value.units)


def si(value: Quantity) -> float:
    """Return the value in SI base units: m, kg, s, N, Pa, W, K, rad, mol; a fraction as a plain number.

    Examples
    --------
    >>> si(quantity("20 degC", "temperature")), si(quantity("95 %", "fraction"))
    (293.15, 0.95)
    """
    scale = _si_scale(value._units)  # noqa: SLF001 a Unit is made, and compared, at each call of .units
    if scale is None:
        return float(value.to_base_units().magnitude)
    return float(value.magnitude * scale[0] / scale[1] + scale[2])


def read_si(value: str, kind: str, place: str = "") -> float:
    """Read a quantity of one kind from text straight to its SI value.

    Raises
    ------
    InputError
        As of `quantity`, preceded by the place if given.

    Examples
    --------
    >>> read_si("1200 mm", "length"), read_si("20 degC", "temperature")
    (1.2, 293.15)
    """
    try:
        return si(quantity(value, kind))
    except InputError as error:
        if not place:
            raise
        raise InputError("{}: {}", place, error) from None


def si_with_unit(value: Quantity) -> tuple[float, str]:
    """Return the value in SI and its SI unit, as reports write it.

    Examples
    --------
    >>> si_with_unit(quantity("20 degC", "temperature")), si_with_unit(quantity("3 kN"))
    ((293.15, 'K'), (3000.0, 'N'))
    """
    return si(value), _si_label(value.units)


@cache
def _si_label(unit: Any) -> str:
    return next(kind.base for name, kind in KINDS.items() if unit in _UNIT_TABLES[name].values())


def interpolate_quantity(low: Quantity, high: Quantity, share: float) -> Quantity:
    """Interpolate between two quantities, in the unit of the first.

    Raises
    ------
    InputError
        They are of different kinds.

    Examples
    --------
    >>> text(interpolate_quantity(quantity("-10 degC"), quantity("30 degC"), 0.25))
    '0 degC'
    """
    if low.dimensionality != high.dimensionality:
        raise InputError(f"got {text(low)} and {text(high)}, expected two of one kind")
    base, other = low.to_base_units(), high.to_base_units()
    built: Quantity = _make_quantity(base.magnitude + share * (other.magnitude - base.magnitude), base.units).to(
        low.units
    )
    return _make_quantity(float(f"{built.magnitude:.9g}"), low.units)


def same_value(one: Quantity, other: Quantity) -> bool:
    """True if two quantities have the same value, in any units."""
    return si(one) == si(other)


@cache
def _si_scale(unit: Any) -> tuple[float, float, float] | None:
    """Factor, divisor and offset to SI, None for degrees unlike kelvin; by pint once for each unit."""
    if REGISTRY.Unit(unit) == _PERCENT:
        return 1.0, 100.0, 0.0
    zero, one = (float(_make_quantity(number, unit).to_base_units().magnitude) for number in (0.0, 1.0))
    if zero == 0.0:
        return one, 1.0, 0.0
    return (1.0, 1.0, zero) if one == zero + 1.0 else None


def text(value: Quantity) -> str:
    """Return number and unit as entered; `quantity` reads it back to the same value.

    Raises
    ------
    InputError
        The unit is not in the table (a result of arithmetic): convert with ``.to`` first.

    Examples
    --------
    >>> text(quantity("600 fpm")), text(quantity("0.5 kg/m³"))
    ('600 fpm', '0.5 kg/m^3')
    """
    spelled = _UNIT_SPELLINGS.get(value.units)
    if spelled is None:
        raise InputError(f"{value} has a unit that specs do not know; convert it with .to first")
    number = repr(float(value.magnitude)).removesuffix(".0")
    return f"{number} {spelled}" if spelled else number


_US_UNITS = re.compile(r"\b(?:in|ft|yd|mi|lb|lbf|short_ton|psi|hp|fpm|mph|PIW|stph|degF|delta_degF)\b|°F")


def unit_system(value: Quantity) -> System:
    """Return the system of units that a quantity was entered in.

    Examples
    --------
    >>> unit_system(quantity("48 in")), unit_system(quantity("90 lb/ft^3")), unit_system(quantity("1.2 m"))
    ('US', 'US', 'SI')
    """
    return "US" if _US_UNITS.search(text(value)) else "SI"


def is_quantity(value: object) -> TypeGuard[Quantity]:
    """True for a quantity of this package."""
    return isinstance(value, REGISTRY.Quantity)


def is_kind(value: Quantity, kind: str) -> bool:
    """True if the unit of a quantity is one of a kind's.

    Examples
    --------
    >>> is_kind(quantity("16 kg/m"), "line mass"), is_kind(quantity("16 kg/m"), "area mass")
    (True, False)
    """
    return value.units in _UNIT_TABLES[kind].values()


def from_si(value: float, kind: str, unit: str | None = None) -> Quantity:
    """Build a quantity from an SI value, in `unit` or the SI report unit of its kind.

    Examples
    --------
    >>> text(from_si(0.125, "length", "mm"))
    '125 mm'
    """
    spelled = _usual_unit(kind) if unit is None else unit
    if spelled not in KINDS[kind].units:
        raise InputError(f'"{spelled}" is not a unit of {KINDS[kind].noun}')
    built: Quantity = _make_quantity(float(value), _base_unit(kind)).to(UNITS[spelled])
    return built


@cache
def _base_unit(kind: str) -> Any:
    if kind == "temperature":
        return UNITS["K"]
    return _make_quantity(1.0, UNITS[_usual_unit(kind)]).to_base_units().units


def _usual_unit(kind: str) -> str:
    """SI unit of reports of a kind of input, as specs spell it."""
    return "" if "" in KINDS[kind].units else KINDS[kind].si.unit or ""


def _pydantic_validator(check: Callable[[Any], Quantity]) -> Callable[[Any], Quantity]:
    """Turn an `InputError` into pydantic's own error, without its prefix."""

    def validate(value: Any) -> Quantity:
        try:
            return check(value)
        except InputError as error:
            raise PydanticCustomError("quantity", "{message}", {"message": str(error)}) from None

    return validate


def spec_value(value: Quantity) -> str | float:
    """Return a quantity as a spec stores it: text, or a number for a fraction without a percent sign."""
    return float(value.magnitude) if value.units == _PLAIN else text(value)


@dataclass(frozen=True)
class Measure:
    """Marker of a model field: a quantity of one kind, read by `quantity`, written by `text`."""

    kind: str

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Validate with `quantity`; keep quantities in Python, write text to JSON."""
        return core_schema.no_info_plain_validator_function(
            self._reads(allow_all),
            serialization=core_schema.plain_serializer_function_ser_schema(spec_value, when_used="json"),
            metadata={_MEASURE: self},
        )

    def within(self, schema: Any, bounds: Bounds) -> None:
        """Limit the proposals in a schema's messages to the bounds."""
        schema["function"] = schema["function"] | {"function": self._reads(partial(bounds.allows, self.kind))}

    def _reads(self, allows: TextTest) -> Callable[[Any], Quantity]:
        return _pydantic_validator(partial(_read_quantity, kind=self.kind, allows=allows))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Describe the field as text with a pattern (a fraction as a number too)."""
        kind = KINDS[self.kind]
        units = "|".join(re.escape(form) for form in sorted(kind.units, key=len, reverse=True) if form)
        described: JsonSchemaValue = {
            "type": "string",
            "pattern": rf"^\s*{NUMBER}\s*({units})\s*$",
            "description": kind.noun,
            "examples": [kind.example],
        }
        if self.kind == "fraction":
            described = {"anyOf": [{"type": "number"}, described], "description": kind.noun}
        return described | {"x-quantity": kind.noun}


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """Marker of an allowed range, as text with units; messages give it in the unit the user wrote."""

    gt: str | None = None
    ge: str | None = None
    lt: str | None = None
    le: str | None = None

    @cache  # noqa: B019 a range is stated once, by a model
    def _limits(self) -> list[tuple[str, Quantity, Callable[[float, float], bool]]]:
        signs: list[tuple[str, str | None, Callable[[float, float], bool]]] = [
            (">", self.gt, float.__gt__),
            (">=", self.ge, float.__ge__),
            ("<", self.lt, float.__lt__),
            ("<=", self.le, float.__le__),
        ]
        return [(sign, quantity(limit), holds) for sign, limit, holds in signs if limit is not None]

    def _hold(self, value: Quantity) -> bool:
        given = si(value)
        return all(holds(given, si(limit)) for _, limit, holds in self._limits())

    def allows(self, kind: str, given: str) -> bool:
        """True if a text is a quantity of a kind within this range."""
        try:
            return self._hold(quantity(given, kind))
        except InputError:
            return False

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Check the range after the field has been read."""
        inner: Any = handler(source)
        measure = inner.get("metadata", {}).get(_MEASURE)
        if measure is not None:
            measure.within(inner, self)

        def check(value: Quantity) -> Quantity:
            if self._hold(value):
                return value
            allowed = " and ".join(f"{sign} {_limit_text(limit, value)}" for sign, limit, _ in self._limits())
            percent = f"{text(value)} %"
            meant = measure is not None and measure.kind == "fraction" and self.allows("fraction", percent)
            raise InputError(
                f"got {text(value)}, allowed: {allowed}" + (f'; did you mean "{percent}"?' if meant else "")
            )

        return core_schema.no_info_after_validator_function(_pydantic_validator(check), inner)

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        """Add the range to the description."""
        described = handler(schema)
        allowed = " and ".join(f"{sign} {text(limit)}" for sign, limit, _ in self._limits())
        measure = schema.get("schema", {}).get("metadata", {}).get(_MEASURE)
        if measure is not None and "examples" in described:
            described["examples"] = [allowed_example(measure.kind, partial(self.allows, measure.kind))]
        described["description"] = f"{described.get('description', '')}, {allowed}"
        return described | {"x-allowed": allowed}


def _limit_text(limit: Quantity, like: Quantity) -> str:
    """Write a limit in the unit of another quantity, to six digits."""
    converted = limit.to(like.units)
    return text(_make_quantity(float(f"{converted.magnitude:.6g}"), like.units))


Length = Annotated[Quantity, Measure("length")]
Distance = Annotated[Quantity, Measure("distance")]
Thickness = Annotated[Quantity, Measure("thickness")]
Speed = Annotated[Quantity, Measure("speed")]
WindSpeed = Annotated[Quantity, Measure("wind")]
Acceleration = Annotated[Quantity, Measure("acceleration")]
Mass = Annotated[Quantity, Measure("mass")]
AreaMass = Annotated[Quantity, Measure("area mass")]
BeltMass = Annotated[Quantity, Measure("belt mass")]
SetMass = Annotated[Quantity, Measure("set mass")]
Inertia = Annotated[Quantity, Measure("inertia")]
Density = Annotated[Quantity, Measure("density")]
Force = Annotated[Quantity, Measure("force")]
LineForce = Annotated[Quantity, Measure("line force")]
SpringRate = Annotated[Quantity, Measure("spring rate")]
Pressure = Annotated[Quantity, Measure("pressure")]
Modulus = Pressure
Time = Annotated[Quantity, Measure("time")]
Duration = Annotated[Quantity, Measure("duration")]
Frequency = Annotated[Quantity, Measure("frequency")]
Rotation = Annotated[Quantity, Measure("rotation")]
ForcePerRotation = Annotated[Quantity, Measure("force per rotation")]
Moment = Annotated[Quantity, Measure("moment")]
Torque = Annotated[Quantity, Measure("torque")]
BendingStiffness = Annotated[Quantity, Measure("bending stiffness")]
Viscosity = Annotated[Quantity, Measure("viscosity")]
Temperature = Annotated[Quantity, Measure("temperature")]
TemperatureDifference = Annotated[Quantity, Measure("temperature difference")]
Angle = Annotated[Quantity, Measure("angle")]
MassFlow = Annotated[Quantity, Measure("mass flow")]
Power = Annotated[Quantity, Measure("power")]
Heat = Annotated[Quantity, Measure("heat")]
MolarEnergy = Annotated[Quantity, Measure("molar energy")]
Fraction = Annotated[Quantity, Measure("fraction")]
