"""Messages for input that is no quantity: traps of locale, unit and kind, and what to write instead."""

from __future__ import annotations

import difflib
import math
import re
import sys
from collections.abc import Callable, Iterator

from conveyor.errors import shorten_text
from conveyor.units.quantity_kinds import KINDS, SPELLINGS

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
NUMBER_UNIT = re.compile(rf"\s*({NUMBER})\s*([^\s0-9.,+-](?:.*\S)?|)\s*")
_LARGEST_FLOAT = sys.float_info.max
_POWERS = (-1, 1, -2, 2, -3, 3, -4, 4)
"""Powers of ten tried on the example of a kind until a range allows it."""
LONGEST_TEXT = 80
"""Largest number of characters of a quantity."""

_SEPARATORS = "[ \u00a0\u2007\u2009\u202f'’_]"
_THOUSANDS = rf"[+-]?[0-9]{{1,3}}({_SEPARATORS}[0-9]{{3}})+(?![0-9])"
_COMMA = re.compile(r"[+-]?[0-9][0-9.' ]*,[0-9,.]*")
_TRAPS: tuple[tuple[str, str], ...] = (
    (r"[+-]?[0-9]*\.[0-9]*\.", "the number has more than one decimal point"),
    (r"[−–]", 'write minus as "-"'),
    (r"(?i)[+-]?\.?(nan|inf)", "expected a finite number"),
)
_HZ = "1 Hz is 6.283 rad/s: they are not interchangeable"
_CONFUSION_HINTS = {
    ("frequency", "angular frequency"): _HZ,
    ("angular frequency", "frequency"): _HZ,
    ("temperature difference", "temperature"): 'write a difference as "10 K" or "10 delta_degC"',
}
_DESIGNATION = re.compile(r"(?i)(?:ST|EP|NN|PA|PP|EE)[ -]?([0-9]+)(?:\s*/\s*[0-9]+)?")
"""Designation of a belt, ST1600 or EP 1000/4: its breaking strength [N/mm], a textile one with its plies."""
_UNIT_GUESSES = {
    "C": "degC", "c": "degC", "celsius": "degC", "Celsius": "degC", "F": "degF", "fahrenheit": "degF",
    "Fahrenheit": "degF", "kelvin": "K", '"': "in", "inches": "in", "''": "in", "'": "ft", "feet": "ft", "foot": "ft",
    "metre": "m", "meter": "m", "metres": "m", "meters": "m", "lbs": "lb", "pound": "lb", "pounds": "lb",
    "sec": "s", "hr": "h", "hour": "h", "hours": "h", "tonne": "t", "tonnes": "t", "tonne/h": "t/h",
    "tonnes/h": "t/h", "degree": "deg", "degrees": "deg", "percent": "%", "lbs/ft": "lb/ft", "pli": "PIW",
    "pcf": "lb/ft^3",
}  # fmt: skip


def allow_all(_: str) -> bool:
    """Allow every proposal of a message."""
    return True


def misread_reason(given: object, kind: str | None, allows: Callable[[str], bool] = allow_all) -> str:
    """Reason why `given` is no quantity of `kind`, and an allowed text to write instead."""
    if isinstance(given, str):
        return _text_reason(given, kind, allows)
    expected = expected_text(kind, allows)
    if isinstance(given, int | float) and not isinstance(given, bool):
        if not -_LARGEST_FLOAT <= given <= _LARGEST_FLOAT:
            return f"got {_value_text(given)}, expected a finite number"
        return f"got {given} without a unit; {_unit_advice(str(given), kind, allows)}"
    return f"expected {expected}, got {_value_text(given)}"


def expected_text(kind: str | None, allows: Callable[[str], bool] = allow_all) -> str:
    """Expected input, for messages: the noun of a kind and an allowed example, if any.

    Examples
    --------
    >>> expected_text("distance"), expected_text("distance", lambda given: given == "15 m")
    ('a length such as "150 m"', 'a length such as "15 m"')
    """
    if kind is None:
        return 'a number and a unit such as "1200 mm"'
    noun, example = KINDS[kind].noun, allowed_example(kind, allows)
    if kind == "fraction":
        noun, _, _ = noun.partition(" (")
        if example is not None:
            return f'{noun} ({float(example.split()[0]) / 100.0:.12g} or "{example}")'
    return noun if example is None else f'{noun} such as "{example}"'


def allowed_example(kind: str, allows: Callable[[str], bool] = allow_all) -> str | None:
    """Allowed example of a kind: its own, or that times a power of ten; None if none is allowed.

    Examples
    --------
    >>> allowed_example("distance"), allowed_example("distance", lambda given: given == "15 m")
    ('150 m', '15 m')
    """
    own = KINDS[kind].example
    number, _, unit = own.partition(" ")
    scaled = (f"{float(number) * 10.0**power:.12g} {unit}".strip() for power in _POWERS)
    return own if allows(own) else next(filter(allows, scaled), None)


def _unit_advice(number: str, kind: str | None, allows: Callable[[str], bool]) -> str:
    """Propose the first unit that makes the number allowed, that of the kind's example before others."""
    first = "mm" if kind is None else KINDS[kind].example.split()[1]
    units = dict.fromkeys([first, *([] if kind is None else KINDS[kind].units.values())])
    meant = next((unit for unit in units if unit and allows(f"{number} {unit}")), None)
    if meant is None:
        return f"give the unit, as in {expected_text(kind, allows)}"
    return f'give the unit, e.g. "{number} {meant}"'


def _value_text(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, dict | list | tuple):
        return "several fields" if isinstance(value, dict) else "a list"
    if isinstance(value, bool):
        return str(value).lower()
    return shorten_text(f'"{escape_line_breaks(value)}"' if isinstance(value, str) else repr(value), LONGEST_TEXT)


def escape_line_breaks(text: str) -> str:
    r"""Escape line breaks and tabs: a message is one line.

    Examples
    --------
    >>> escape_line_breaks("1\n2")
    '1\\n2'
    """
    return text.replace("\n", "\\n").replace("\r", "\\r").replace("\t", "\\t")


def _text_reason(given: str, kind: str | None, allows: Callable[[str], bool]) -> str:
    shown, expected = _value_text(given), expected_text(kind, allows)
    start = given.strip()
    if len(given) > LONGEST_TEXT:
        return f"expected {expected}, got {shown}"
    advice = _trap_advice(start, kind, allows)
    if advice is not None:
        return f"got {shown}: {advice}"
    match = NUMBER_UNIT.fullmatch(given)
    if match is None:
        return f"expected {expected}, got {shown}"
    number, unit = match.groups()
    if not math.isfinite(float(number)):
        return f"got {shown}, expected a finite number"
    if unit == "":
        return f"got {shown} without a unit; {_unit_advice(number, kind, allows)}"
    return f"got {shown}" + _unit_reason(number, unit, kind, allows)


def _trap_advice(start: str, kind: str | None, allows: Callable[[str], bool]) -> str | None:
    """Advice for a text that is one of the traps, else None."""
    if kind == "line force" and (belt := _DESIGNATION.fullmatch(start)):
        return f'of a belt\'s designation write the number, "{belt[1]} N/mm"; its kind is a field of its own'
    if re.match(_THOUSANDS, start):
        together = re.sub(rf"(?<=[0-9]){_SEPARATORS}(?=[0-9]{{3}})", "", escape_line_breaks(start))
        meant = f', e.g. "{together}"' if _may_propose(together, allows) else ""
        return f"write the number without a thousands sign{meant}"
    if comma := _COMMA.match(start):
        rest = escape_line_breaks(start[comma.end() :])
        readings = [f"{number}{rest}" for number in _comma_readings(comma[0])]
        meant = " or ".join(f'"{one}"' for one in readings if _may_propose(one, allows))
        advice = "a comma is ambiguous; write a decimal point and no thousands sign"
        return f"{advice}: {meant}" if meant else advice
    return next((advice for trap, advice in _TRAPS if re.match(trap, start)), None)


def _may_propose(meant: str, allows: Callable[[str], bool]) -> bool:
    """True if a text is allowed or has further faults, reported later."""
    return allows(meant) or NUMBER_UNIT.fullmatch(meant) is None


def _comma_readings(number: str) -> Iterator[str]:
    """Possible readings of a number with commas: decimal comma, thousands separators."""
    if re.fullmatch(r"[^,]+,[0-9]+", number):
        yield re.sub(r"[.' ]", "", number).replace(",", ".")
    if re.fullmatch(r"[+-]?[0-9]{1,3}(,[0-9]{3})+(\.[0-9]+)?", number):
        yield number.replace(",", "")


def _unit_reason(number: str, unit: str, kind: str | None, allows: Callable[[str], bool]) -> str:
    """Message about a wrong unit behind a valid number."""
    others = [name for name, other in KINDS.items() if unit in other.units]
    if others:
        hint = next(
            (_CONFUSION_HINTS[kind or "", other] for other in others if (kind or "", other) in _CONFUSION_HINTS),
            None,
        )
        return f" ({KINDS[others[0]].noun}), expected {expected_text(kind, allows)}" + (f"; {hint}" if hint else "")
    if re.search(r"\b(short |long )?tons?\b", unit, re.IGNORECASE):
        rest = re.sub(r"^.*?tons?", "", unit, flags=re.IGNORECASE)
        both = {f"{number} t{rest}": " (metric)", f"{number} short_ton{rest}": ""}
        meant = [f'"{one}"{which}' for one, which in both.items() if allows(one)]
        written = " or ".join(meant) or "t (metric) or short_ton"
        return f': "ton" is ambiguous; write {written}'
    forms = [form for form in (SPELLINGS if kind is None else KINDS[kind].units) if form]
    tight = re.sub(r"\s+", "", unit).lower()
    same_but_case = [form for form in forms if form.lower() == tight]
    meant = [_UNIT_GUESSES[unit]] if _UNIT_GUESSES.get(unit) in forms else same_but_case
    near = meant or difflib.get_close_matches(unit, forms, n=1)
    guess = f'; did you mean "{number} {near[0]}"?' if near and allows(f"{number} {near[0]}") else ""
    allowed = "" if kind is None else "; units allowed: " + ", ".join(forms)
    return f': unknown unit "{unit}"{guess}{allowed}'
