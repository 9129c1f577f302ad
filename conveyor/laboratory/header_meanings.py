"""Meaning of a column header: quantity, logarithm, shear, unit; names in the languages of `words/columns.txt`."""

from __future__ import annotations

import math
import re
from types import MappingProxyType
from typing import Final, NamedTuple

from conveyor.laboratory.column_units import find_unit, is_any_unit
from conveyor.laboratory.numbers import half_width
from conveyor.laboratory.vocabulary import compact_name, word_lists

DIMENSIONS: Final = MappingProxyType(
    {
        "frequency": "frequency",
        "temperature": "temperature",
        "strain": "strain",
        "time": "time",
        "storage": "modulus",
        "loss": "modulus",
        "complex": "modulus",
        "relaxation": "modulus",
        "tau": "time",
        "term": "modulus",
        "share": "number",
        "instant": "modulus",
        "tan_delta": "number",
        "phase": "angle",
        "a_T": "number",
        "b_T": "number",
        "run": "label",
    }
)
"""Quantities that can be read, with the dimension of each."""


class SetPoint(NamedTuple):
    """A frequency or temperature in a header, as in "E'(10 Hz)/MPa": its quantity, number and unit."""

    quantity: str
    number: str
    unit: str


class Meaning(NamedTuple):
    """Meaning of a header cell."""

    quantity: str
    unit: str | None = None
    log_base: float | None = None
    letter: str = ""
    angular: bool = False
    peak_to_peak: bool = False
    reduced: bool = False
    commanded: bool = False
    at: SetPoint | None = None


def _read_meanings() -> tuple[dict[str, Meaning], tuple[str, ...], tuple[str, ...]]:
    """Meanings by compact names, and the words for commanded and for measured quantities."""
    made: dict[str, Meaning] = {}
    beside: dict[str, list[str]] = {"commanded": [], "measured": []}
    for head, words in word_lists("columns"):
        quantity, *of = head.split()
        if quantity in beside:
            beside[quantity] += words
            continue
        sense = Meaning(
            quantity,
            letter="G" if "shear" in of else "E" if "tensile" in of else "",
            angular="angular" in of,
            peak_to_peak="peak-to-peak" in of,
            reduced="reduced" in of,
        )
        made |= {compact_name(word): sense for word in words}
    return made, tuple(beside["commanded"]), tuple(beside["measured"])


_MEANINGS, _COMMANDED_WORDS, _MEASURED_WORDS = _read_meanings()
_ORIGIN_WORDS: Final = re.compile(
    rf"(?P<commanded>{'|'.join(map(re.escape, _COMMANDED_WORDS))})|{'|'.join(map(re.escape, _MEASURED_WORDS))}",
    re.IGNORECASE,
)
_QUALIFIED_NAMES: Final = (
    re.compile(r"(?P<name>.+?)\s*[(\[](?P<word>[^()\[\]]+)[)\]](?P<rest>.*)"),
    re.compile(r"(?P<word>\w+)[\s_\-]+(?P<name>.+)(?P<rest>)"),
    re.compile(r"(?P<name>.+?)[\s_,]+(?P<word>\w+)(?P<rest>(?:\s*[\[(].*)?)"),
)
"""Places of a word such as "cmd" or "measured": in brackets, before the name, behind it."""
_LONGEST_NAME = 80
"""Longer cells are sentences."""
_OTHER_LETTERS = {"e", "g"}
"""Lower-case letters that are no modulus: e is often a strain, F without a frequency unit a force."""
_PRIMES = str.maketrans({"’": "'", "‘": "'", "′": "'", "`": "'", "´": "'", "″": "''", '"': "''", "”": "''", "“": "''"})
_BRACKETED_UNITS: Final = (
    r"(?P<name>.+?)\s*\[(?P<unit>[^\[\]]*)\]",
    r"(?P<name>.+?)\s*\((?P<unit>[^()]*)\)",
    r"(?P<name>.+?)\s*<(?P<unit>[^<>]*)>",
)
_LOOSE_UNITS: Final = (
    r"(?P<name>.+)_(?P<unit>[^_]+)",
    r"(?P<name>.+?)\s*/\s*(?P<unit>.+)",
    r"(?P<name>.+?)\s*,\s*(?P<unit>.+)",
    r"(?P<name>.+?)\s+in\s+(?P<unit>.+)",
    r"(?P<name>.+?)\s*(?P<unit>%)",
    r"(?P<name>.+)\s+(?P<unit>\S+)",
)
"""The last part is a unit only if it is known."""
_WITH_LOGARITHMS: Final = frozenset({"frequency", "time", "storage", "loss", "relaxation", "a_T", "b_T"})
_WITH_SYMBOL: Final = (
    r"(.+?)\s*[(\[]([^()\[\]]+)[)\]]",
    r"(.+)[\s,]+(\S+)",
    r"(.*[\u2e80-\uffef])([A-Za-z|]\S*)",
)
"""A symbol next to words, in Chinese, Japanese and Korean also without a blank."""
_SET_POINT: Final = re.compile(
    r"\s*(?:(?:@|\bat\b|\bbei\b)\s*|(?=[(\[]))(?P<open>[(\[])?\s*(?<![\w.,])(?P<number>-?\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>k?Hz|°C|ºC|℃|degC)(?(open)\s*[)\]])",
    re.IGNORECASE,
)
_LOGARITHM = re.compile(r"(?P<log>log_?10|log|lg|ln)[\s_]*(?P<rest>\(.+\)|\[.+\]|.+)", re.IGNORECASE)


def header_meaning(header: str) -> Meaning | None:
    """Quantity named by a header cell; None if the name is not known.

    Notes
    -----
    A unit is in brackets, or after `_`, `/`, a comma, a blank or `in` if what follows is a known unit; a set point,
    as in `E'(10 Hz)/MPa`, is taken apart first. A lone `t`, `T` or `Ts` is a time or a temperature by its unit, without
    one by its case.

    Examples
    --------
    >>> header_meaning("E'' (MPa)")[:4], header_meaning("E''(3.3Hz)/MPa").at
    (('loss', 'MPa', None, 'E'), SetPoint(quantity='frequency', number='3.3', unit='Hz'))
    >>> header_meaning("log_aT").log_base, header_meaning("storage_Pa").unit, header_meaning("Point")
    (10.0, 'Pa', None)
    """
    if len(header) > _LONGEST_NAME:
        return None
    text = " ".join(header.translate(_PRIMES).split())
    if point := _SET_POINT.search(text):
        sense = header_meaning((text[: point.start()] + text[point.end() :]).strip())
        quantity = "temperature" if point["unit"].lower()[-1] in "c℃" else "frequency"
        return sense and sense._replace(at=SetPoint(quantity, point["number"], point["unit"]))
    sense = _qualified_meaning(text) or _linear_meaning(text)
    if sense is not None or not (log := _LOGARITHM.fullmatch(text)):
        return sense
    rest = log["rest"].strip()
    whole = rest[1:-1] if rest[0] + rest[-1] in {"()", "[]"} else rest
    outer = re.sub(r"\(([^()]+)\)(?=\s*[\[(][^()\[\]]+[\])]$)", r"\1 ", rest, count=1)  # "(f) [Hz]"
    inner = _linear_meaning(whole) or _linear_meaning(rest) or _linear_meaning(outer)
    if inner is None or inner.quantity not in _WITH_LOGARITHMS:
        return None
    return inner._replace(log_base=math.e if log["log"].lower() == "ln" else 10.0)


def known_names(text: str) -> int:
    """Number of cells of a text, with any separator, that are column names with letters beyond ASCII.

    Examples
    --------
    >>> known_names("Частота, Гц;Температура, °С;E' [MPa]")
    2
    """
    parts = (part.strip(' "') for part in re.split(r"[\t;\n(\[,]| / |  +|/", half_width(text)))
    return sum(not part.isascii() and header_meaning(part) is not None for part in parts)


def bare_name(header: str) -> str:
    """Header without its unit in brackets.

    Examples
    --------
    >>> bare_name("Modul A [MPa]"), bare_name("Point"), bare_name("Strain (cmd)")
    ('Modul A', 'Point', 'Strain (cmd)')
    """
    for split in _BRACKETED_UNITS:
        match = re.fullmatch(split, header.strip())
        if match and is_any_unit(match["unit"]):
            return match["name"]
    return header.strip()


def _qualified_meaning(text: str) -> Meaning | None:
    """Meaning of a name with a word for commanded or measured, as in "Strain (cmd) [%]"."""
    for form in _QUALIFIED_NAMES:
        if (match := form.fullmatch(text)) and (word := _ORIGIN_WORDS.fullmatch(match["word"].strip())):
            sense = _linear_meaning(f"{match['name']} {match['rest'].strip()}".strip())
            if sense is not None:
                return sense._replace(commanded=word["commanded"] is not None)
    return None


def _linear_meaning(text: str) -> Meaning | None:
    """Meaning of a name with its unit, if it has one."""
    bare = _name_meaning(text)
    if bare is not None:
        return bare
    for split in (*_BRACKETED_UNITS, *_LOOSE_UNITS):
        match = re.fullmatch(split, text)
        sense = _name_meaning(match["name"], match["unit"]) if match else None
        if match and sense and (split in _BRACKETED_UNITS or find_unit(DIMENSIONS[sense.quantity], match["unit"])):
            return sense._replace(unit=match["unit"].strip())
    return None


def _name_meaning(text: str, unit: str | None = None) -> Meaning | None:
    """Meaning of a name without its unit, with or without a symbol, as in "Storage modulus E'"."""
    if text.strip() in {"t", "T", "Ts"}:
        return Meaning(_time_or_temperature(text.strip(), unit))
    sense = _word_meaning(text)
    if sense is not None:
        return _meaning_by_unit(text.strip(), sense, unit)
    parts = next(filter(None, (re.fullmatch(form, text) for form in _WITH_SYMBOL)), None)
    if parts is None:
        return None
    first, second = _word_meaning(parts[1]), _word_meaning(parts[2])
    if parts[2] in {"t", "T"}:
        return first if first and first.quantity in {"time", "temperature"} else None
    if first is None or second is None or first.quantity != second.quantity:
        return None
    return first._replace(
        letter=first.letter or second.letter,
        angular=first.angular or second.angular,
        peak_to_peak=first.peak_to_peak or second.peak_to_peak,
    )


def _meaning_by_unit(name: str, meaning: Meaning, unit: str | None) -> Meaning | None:
    """Meaning corrected by the unit: F without Hz is a force, g_i in MPa a modulus and no share."""
    if meaning.quantity == "share" and unit is not None and find_unit("modulus", unit):
        return Meaning("term", letter="G" if name[0] in "gG" else "")
    force = name == "F" and not (unit is not None and find_unit("frequency", unit))
    return None if force or name in _OTHER_LETTERS else meaning


def _time_or_temperature(letter: str, unit: str | None) -> str:
    for dimension in ("time", "temperature"):
        if unit is not None and find_unit(dimension, unit):
            return dimension
    return "temperature" if letter[0] == "T" else "time"


def _word_meaning(text: str) -> Meaning | None:
    """Meaning of a single name, with the letter of its modulus or strain."""
    return _MEANINGS.get(compact_name(text))
