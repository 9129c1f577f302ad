"""Units: exact definitions, traps refused with advice, round trips, bounds, display."""

from __future__ import annotations

import math
import subprocess
import sys
from typing import Annotated

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from conveyor import units
from conveyor.errors import InputError
from conveyor.units import Bounds, Density, Fraction, Length, MassFlow, Speed, Temperature, quantity, si, text
from conveyor.units.presentation import display_unit, format_figure
from conveyor.units.quantity_kinds import INPUT_KINDS, KINDS
from conveyor.units.registry import UNITS
from conveyor.units.unit_systems import SYSTEMS

# Definitions: international yard and pound (1959): 1 ft = 0.3048 m, 1 lb = 0.45359237 kg; standard gravity
# 9.80665 m/s² defines lbf; 1 short ton = 2000 lb; 1 hp = 550 ft lbf/s.
LB, FT, G = 0.45359237, 0.3048, 9.80665
LBF = LB * G
DEFINITIONS = [
    ("1200 mm", "length", 1.2), ("120 cm", "length", 1.2), ("1.2 km", "length", 1200.0),
    ("48 in", "length", 48 * FT / 12),
    ("10 inch", "length", 10 * FT / 12), ("10 ft", "length", 10 * FT), ("0.2 m²", "area", 0.2),
    ("1 ft^2", "area", FT**2),
    ("5 m/s", "speed", 5.0), ("600 fpm", "speed", 600 * FT / 60), ("600 ft/min", "speed", 600 * FT / 60),
    ("18 km/h", "speed", 5.0), ("2 kg", "mass", 2.0), ("2 t", "mass", 2000.0), ("2 lb", "mass", 2 * LB),
    ("2 short_ton", "mass", 4000 * LB), ("16.4 kg/m", "line mass", 16.4), ("11 lb/ft", "line mass", 11 * LB / FT),
    ("27 kg/m^2", "area mass", 27.0), ("27 kg/m²", "area mass", 27.0), ("5 lb/ft^2", "area mass", 5 * LB / FT**2),
    ("850 kg/m3", "density", 850.0), ("0.85 t/m^3", "density", 850.0), ("53 lb/ft³", "density", 53 * LB / FT**3),
    ("2 kN", "force", 2000.0), ("2 lbf", "force", 2 * LBF), ("1600 N/mm", "line force", 1.6e6),
    ("2 kN/m", "line force", 2000.0), ("600 PIW", "line force", 600 * LBF * 12 / FT),
    ("600 lbf/in", "line force", 600 * LBF * 12 / FT), ("10 MPa", "pressure", 1e7), ("3 GPa", "pressure", 3e9),
    ("30 kPa", "pressure", 3e4), ("1450 psi", "pressure", 1450 * LBF * 144 / FT**2), ("5 ms", "time", 5e-3),
    ("5 us", "time", 5e-6), ("2 min", "time", 120.0), ("2 h", "time", 7200.0), ("10 Hz", "frequency", 10.0),
    ("10 rad/s", "angular frequency", 10.0), ("20 degC", "temperature", 293.15), ("20 °C", "temperature", 293.15),
    ("68 degF", "temperature", 293.15), ("293.15 K", "temperature", 293.15), ("50 K", "temperature difference", 50.0),
    ("50 delta_degC", "temperature difference", 50.0), ("90 Δ°F", "temperature difference", 50.0),
    ("180 deg", "angle", math.pi), ("180°", "angle", math.pi), ("1.5 rad", "angle", 1.5),
    ("2400 t/h", "mass flow", 2400 / 3.6), ("2400 tph", "mass flow", 2400 / 3.6), ("5 kg/s", "mass flow", 5.0),
    ("1500 short_ton/h", "mass flow", 1500 * 2000 * LB / 3600), ("1500 stph", "mass flow", 1500 * 2000 * LB / 3600),
    ("100 lb/h", "mass flow", 100 * LB / 3600), ("5 kW", "power", 5000.0), ("300 hp", "power", 300 * 550 * FT * LBF),
    ("2 kWh", "heat", 7.2e6), ("150 kJ/mol", "molar energy", 1.5e5), ("95 %", "fraction", 0.95),
    ("0.95", "fraction", 0.95), ("32.2 ft/s^2", "acceleration", 32.2 * FT), ("3600 m³/h", "volume flow", 1.0),
    ("600 rpm", "rotation", 10.0), ("0.01 N/rpm", "force per rotation", 0.6), ("20 N*mm", "moment", 0.02),
    ("10 lbf*in", "moment", 10 * LBF * FT / 12), ("12 lbf*ft", "torque", 12 * LBF * FT),
    ("10 mph", "speed", 5280 * FT / 360), ("30 N*m²", "bending stiffness", 30.0), ("100 cSt", "viscosity", 1e-4),
]  # fmt: skip


@pytest.mark.parametrize(("written", "kind", "expected"), DEFINITIONS)
def test_si_value_is_the_definition(written: str, kind: str, expected: float) -> None:
    # A few roundings of factors in double precision.
    assert si(quantity(written, kind)) == pytest.approx(expected, rel=1e-14)


def test_every_unit_of_every_kind_has_the_dimension_of_its_kind() -> None:
    for kind, entry in INPUT_KINDS.items():
        if kind in {"belt mass", "set mass"}:  # two dimensions: per area or set, or per length
            continue
        dimensions = {units.quantity(f"1 {form}", kind).dimensionality for form in entry.units if form}
        assert len(dimensions) == 1, kind


def test_every_example_is_read_by_its_own_kind() -> None:
    for kind, entry in INPUT_KINDS.items():
        assert text(quantity(entry.example, kind)) == entry.example


TRAPS = [
    ("1,2 m", "length", r'a comma is ambiguous; write a decimal point and no thousands sign: "1.2 m"'),
    ("1.200,5 m", "length", 'no thousands sign: "1200.5 m"'),
    ("2,000 tph", "mass flow", 'no thousands sign: "2.000 tph" or "2000 tph"'),
    ("1,200,000.5 m", "length", 'no thousands sign: "1200000.5 m"'),
    ("1,2,3 m", "length", "a comma is ambiguous"),
    ("50 pcf", "density", r'unknown unit "pcf"; did you mean "50 lb/ft\^3"\?'),
    ("1 000 m", "length", 'without a thousands sign, e.g. "1000 m"'),
    ("1\u00a0000 m", "length", "without a thousands sign"),
    ("1\u202f000 m", "length", "without a thousands sign"),
    ("1'000 m", "length", "without a thousands sign"),
    ("1_000 m", "length", "without a thousands sign"),
    ("1.2.3 m", "length", "more than one decimal point"),
    ("1200", "length", r'got "1200" without a unit; give the unit, e.g. "1200 mm"'),
    (1200, "length", r'got 1200 without a unit; give the unit, e.g. "1200 mm"'),
    (45, "angle", r'got 45 without a unit; give the unit, e.g. "45 deg"'),
    (5.0, None, r'got 5.0 without a unit; give the unit, e.g. "5.0 mm"'),
    ("nan m", "length", "expected a finite number"),
    ("inf m", "length", "expected a finite number"),
    ("-Infinity m", "length", "expected a finite number"),
    ("1e999 m", "length", "expected a finite number"),
    (math.nan, "length", "got nan, expected a finite number"),
    (math.inf, "fraction", "got inf, expected a finite number"),
    ("5 s", "length", r'got "5 s" \(a time\), expected a length such as "1200 mm"'),
    ("12 mmm", "length", r'unknown unit "mmm"; did you mean "12 mm"\?; units allowed: mm, cm, m, km, in'),
    ("12 MM", "length", r'did you mean "12 mm"\?'),
    ("12 kg / m", "line mass", r'did you mean "12 kg/m"\?'),
    ('48"', "length", r'did you mean "48 in"\?'),
    ("5 lbs", "mass", r'did you mean "5 lb"\?'),
    ("5 ton", "mass", r'"ton" is ambiguous; write "5 t" \(metric\) or "5 short_ton"'),
    ("500 tons/h", "mass flow", r'write "500 t/h" \(metric\) or "500 short_ton/h"'),
    ("20 C", "temperature", r'unknown unit "C"; did you mean "20 degC"\?'),
    ("20 F", "temperature", r'did you mean "20 degF"\?'),
    ("10 rad/s", "frequency", r"\(an angular frequency\), expected a frequency .* not interchangeable"),
    ("10 Hz", "angular frequency", r"\(a frequency\), expected an angular frequency .* not interchangeable"),
    ("600 rpm", "frequency", "a rotational speed"),
    ("10 degC", "temperature difference", 'write a difference as "10 K" or "10 delta_degC"'),
    ("10 delta_degC", "temperature", r"\(a temperature difference\), expected a temperature"),
    ("−5 degC", "temperature", 'write minus as "-"'),
    ("9**9**9 m", "length", "unknown unit"),
    ("0x10 m", "length", "unknown unit"),
    ("1-2 m", "length", r'expected a length such as "1200 mm", got "1-2 m"'),
    ("m", "length", 'expected a length such as "1200 mm", got "m"'),
    ("", "length", 'expected a length such as "1200 mm", got ""'),
    ("١٢ m", "length", "expected a length"),
    ("9" * 100 + " m", "length", "expected a length"),
    (None, "length", "got nothing"),
    (True, "length", "got true"),
    (True, "fraction", "got true"),
    ([1], "length", "got a list"),
    ({"a": 1}, "length", "got several fields"),
    ("much", "fraction", r'expected a fraction \(0.95 or "95 %"\), got "much"'),
    ("much", None, r'expected a number and a unit such as "1200 mm"'),
]


@pytest.mark.parametrize(("written", "kind", "message"), TRAPS)
def test_trap_is_refused_with_advice(written: object, kind: str | None, message: str) -> None:
    with pytest.raises(InputError, match=message):
        quantity(written, kind)


@pytest.mark.parametrize("kind", sorted(set(INPUT_KINDS) - {"temperature"}))
def test_sizes_that_nothing_has_are_refused(kind: str) -> None:
    smallest, largest = KINDS[kind].sizes
    for unit in KINDS[kind].units:
        one = si(quantity(f"1 {unit}".strip()))
        for size in (0.0, 1.01 * smallest, 0.99 * largest):
            for sign in (1.0, -1.0):
                quantity(f"{sign * size / one!r} {unit}".strip(), kind)
        for size in (5e-324, 1e-300, 0.99 * smallest / one, 1.01 * largest / one, 1e300):
            with pytest.raises(InputError, match=r"got .*, expected .*, in size from .* to "):
                quantity(f"{size!r} {unit}".strip(), kind)


def test_power_towers_do_not_hang() -> None:
    with pytest.raises(InputError):  # worked out, it has more digits than memory holds
        quantity("9**9**9**9 m", "length")


@given(
    number=st.floats(allow_nan=False, allow_infinity=False),
    form=st.sampled_from([(kind, form) for kind, entry in INPUT_KINDS.items() for form in entry.units]),
)
def test_text_quantity_text_round_trip(number: float, form: tuple[str, str]) -> None:
    kind, unit = form
    if kind != "fraction" and unit == "":
        return
    smallest, largest = (size / abs(si(quantity(f"1 {unit}".rstrip()))) for size in KINDS[kind].sizes)
    if kind == "temperature" or not (number == 0.0 or smallest <= abs(number) <= largest):
        number = math.copysign(min(max(abs(number), 2.0 * smallest), 0.5 * largest), number)
    if kind == "temperature":  # below absolute zero is refused
        number = max(number, 0.0 if unit == "K" else -200.0)
    first = quantity(f"{number!r} {unit}".rstrip(), kind)
    assert first.magnitude == number
    second = quantity(text(first), kind)
    assert (second.magnitude, second.units) == (first.magnitude, first.units)
    assert text(second) == text(first)


@given(st.text(max_size=40))
def test_any_text_is_read_or_refused_in_our_words(written: str) -> None:
    try:
        value = quantity(written)
    except InputError:
        return
    assert math.isfinite(value.magnitude)


def test_unit_is_kept_as_entered() -> None:
    assert [text(quantity(t)) for t in ("600 fpm", "600 ft/min", "5 tph", "5 t/h")] == [
        "600 fpm",
        "600 ft/min",
        "5 tph",
        "5 t/h",
    ]


def test_quantities_are_taken_when_their_unit_is_of_the_kind() -> None:
    speed = quantity("5 m/s", "speed")
    assert text(quantity(speed * 2, "speed")) == "10 m/s"
    with pytest.raises(InputError, match=r"expected a length .*convert with .to"):
        quantity(speed, "length")
    with pytest.raises(InputError, match="another pint registry"):
        quantity(pint.UnitRegistry().Quantity(5.0, "m/s"), "speed")
    with pytest.raises(InputError, match="finite"):
        quantity(speed * math.inf, "speed")
    with pytest.raises(InputError, match="unit that specs do not know"):
        text(speed * speed)


def test_the_registry_knows_every_unit_of_pint_once_a_program_names_one() -> None:
    ours, pints = units.Quantity._REGISTRY, pint.UnitRegistry()
    before = quantity("3 t/h", "mass flow")
    for form, unit in UNITS.items():
        name = f"{unit:D}"
        if not any(own in name for own in ("_per_hour", "_per_inch_width", "foot_per_minute")):
            of_pint = pints.Quantity(1.0, name).to_base_units()
            assert si(quantity(f"1 {form}")) == pytest.approx(of_pint.magnitude, rel=1e-15), form
    assert ours.Quantity(1.0, "nautical_mile").to(quantity("1 m").units).magnitude == pytest.approx(1852.0)
    assert (before + ours.Quantity(1.0, "tonne / hour")).magnitude == pytest.approx(4.0)
    assert text(before) == "3 t/h"
    assert str(before) == "3.0 t/h"


def test_threads_that_name_a_unit_first_find_all_of_pint() -> None:
    program = """
from concurrent.futures import ThreadPoolExecutor
from conveyor.units import quantity
with ThreadPoolExecutor(8) as pool:
    print(sum(pool.map(lambda metres: quantity(metres, "length").to("nautical_mile").magnitude, ["1852 m"] * 16)))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(16.0)


def test_from_si_and_convert_invert_si() -> None:
    for kind, entry in INPUT_KINDS.items():
        if kind in {"belt mass", "set mass"}:  # two dimensions: per area or set, or per length
            continue
        for form in entry.units:
            built = units.from_si(3.5, kind, form)
            # 300 K offsets against 3.5 cost two digits of double precision.
            assert si(built) == pytest.approx(3.5, rel=1e-13), (kind, form)
    with pytest.raises(InputError, match='"kg" is not a unit of a length'):
        units.from_si(1.0, "length", "kg")


@pytest.mark.parametrize(
    ("value", "kind", "metric", "us"),
    [
        (1.524, "length", "1.524 m", "5 ft"),
        (0.00635, "thickness", "6.35 mm", "0.25 in"),
        (3.048, "speed", "3.048 m/s", "600 fpm"),
        (293.15, "temperature", "20 degC", "68 degF"),
        (1000 / 3.6, "mass flow", "1000 t/h", "1102 stph"),
        (123456.0, "force", "123456 N", "27754 lbf"),
        (745.69987158227022, "power", "0.7457 kW", "1 hp"),
        (0.95, "fraction", "0.95", "0.95"),
        (0.0, "length", "0 m", "0 ft"),
    ],
)
def test_display(value: float, kind: str, metric: str, us: str) -> None:
    assert (
        format_figure(value, kind, as_input=True),
        format_figure(value, kind, "US", as_input=True),
    ) == (metric, us)


@pytest.mark.parametrize("system", SYSTEMS)
def test_every_kind_is_written_in_a_unit_of_its_own_dimension(system: str) -> None:
    assert set(SYSTEMS[system].kinds) <= set(KINDS)
    for kind, entry in KINDS.items():
        unit = display_unit(kind, system)
        if entry.noun and unit.spelled != "-":
            assert unit.spelled in entry.units, kind
            assert unit.size == pytest.approx(si(quantity(f"1 {unit.spelled}")) - unit.zero, rel=1e-12), kind


def test_figures_of_sentences_have_the_unit_of_their_size() -> None:
    assert [format_figure(x, "force") for x in (999.0, 1e3)] == ["999 N", "1 kN"]
    assert [format_figure(x, "heat") for x in (0.0, 999e3, 1e6)] == ["0 kJ", "999 kJ", "1 MJ"]
    assert format_figure(quantity("2100 N/mm"), "belt strength") == "2,100 N/mm"
    assert format_figure(105e3, "belt rating", "US") == "600 PIW"
    assert format_figure(1.5, "safety") == "1.50"


class Sample(BaseModel):
    """Six fields of six kinds."""

    width: Annotated[Length, Bounds(gt="0 m", le="4 m")]
    speed: Speed
    temperature: Temperature
    share: Fraction
    flow: MassFlow
    density: Density


VALID = {
    "width": "1200 mm", "speed": "600 fpm", "temperature": "20 degC", "share": 0.5, "flow": "2400 t/h",
    "density": "850 kg/m^3",
}  # fmt: skip


def test_models_write_back_the_text_entered() -> None:
    assert Sample(**VALID).model_dump(mode="json") == VALID
    assert Sample(**VALID | {"share": "50 %"}).model_dump(mode="json")["share"] == "50 %"


@pytest.mark.parametrize(
    ("given_width", "message"),
    [
        ("4001 mm", r"got 4001 mm, allowed: > 0 mm and <= 4000 mm"),
        ("0 ft", r"got 0 ft, allowed: > 0 ft and <= 13.1234 ft"),
        ("-1 in", r"got -1 in, allowed: > 0 in and <= 157.48 in"),
        ("{0} m", r'expected a length such as "1200 mm", got "\{0\} m"'),
    ],
)
def test_bounds_are_told_in_the_unit_given(given_width: str, message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        Sample(**VALID | {"width": given_width})


def test_bounds_are_inclusive_as_written() -> None:
    assert Sample(**VALID | {"width": "4000 mm"}).width == quantity("4 m")


def test_json_schema_accepts_what_the_model_accepts() -> None:
    import re

    schema = Sample.model_json_schema()["properties"]
    for name, value in VALID.items():
        if name != "share":
            assert re.fullmatch(schema[name]["pattern"], str(value)), name
            assert re.fullmatch(schema[name]["pattern"], schema[name]["examples"][0]), name
            assert not re.fullmatch(schema[name]["pattern"], "1,2 furlong")
    assert schema["width"]["x-allowed"] == "> 0 m and <= 4 m"
    assert {"type": "number"} in schema["share"]["anyOf"]


def test_models_ask_no_parser_of_expressions(monkeypatch: pytest.MonkeyPatch) -> None:
    """It takes 40 times as long as the rest of a model of six fields."""

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("asked")

    monkeypatch.setattr(pint.registry.UnitRegistry, "parse_expression", refuse)
    Sample(**{**VALID, "width": "1.2345 m"})


def test_a_margin_beyond_what_says_something_is_cut_at_both_ends():
    shown = [display_unit("margin").said(share) for share in (0.999, 1.5, -9.0, -10.5)]
    assert shown == ["99.9 %", "> 100 %", "-900.0 %", "< -1,000 %"]
