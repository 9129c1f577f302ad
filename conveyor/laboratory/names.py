"""What a column header means: quantity, logarithm, shear, unit; English, German, French and Korean names."""

from __future__ import annotations

import math
import re
from types import MappingProxyType
from typing import Final, NamedTuple

from conveyor.laboratory.units import find_unit

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
    """What the text of a header cell says."""

    quantity: str
    unit: str | None = None
    log_base: float | None = None
    letter: str = ""
    angular: bool = False
    peak_to_peak: bool = False
    reduced: bool = False
    at: SetPoint | None = None


_NAMES = {
    "frequency": """f freq frequency frequenz prüffrequenz messfrequenz testfrequency oscillationfrequency 주파수
        fréquence frequence 시험주파수 진동수""",
    "temperature": """temp temperature temperatur sampletemperature sampletemp probentemperatur prüftemperatur
        température 온도 시험온도 시료온도""",
    "strain": """strain strainamplitude strainamp dynamicstrain dynstrain straindyn oscillationstrain oscillatorystrain
        shearstrain tensilestrain dehnung dehnungsamplitude dynamischedehnung dyndehnung dehnungdyn verformung
        scherung deformation déformation déformationdynamique deformationdynamique γ γ0 gamma gamma0 ε ε0 εdyn
        epsilon epsilon0 eps 변형률 변형율 동적변형률""",
    "time": "time zeit temps relaxationtime testtime 시간",
    "storage": """storage storagemod storagemodulus speichermodul estor estorage e' e1 eprime m' tensilestoragemodulus
        moduledeconservation moduledestockage gstor gstorage g' g1 gprime shearstoragemodulus
        저장탄성률 저장탄성율 저장모듈러스 저장계수""",
    "loss": """loss lossmod lossmodulus verlustmodul eloss e'' e2 edoubleprime m'' tensilelossmodulus
        moduledeperte gloss g'' g2 gdoubleprime shearlossmodulus 손실탄성률 손실탄성율 손실모듈러스 손실계수탄성률""",
    "complex": """e* estar complexmodulus tensilecomplexmodulus komplexermodul modulecomplexe g* gstar
        shearcomplexmodulus 복소탄성률 복소탄성율""",
    "relaxation": """erelax e(t) et relaxation relaxationmodulus relaxationsmodul grelax g(t) gt
        shearrelaxationmodulus modulus e g 완화탄성률 이완탄성률""",
    "tau": "tau taui τ τi",
    "term": "ei",
    "share": "alphai alpha αi α gi relativemodulus",
    "instant": "e0 g0 instantaneousmodulus",
    "tan_delta": """tandelta tan(delta) tand tanδ tan(δ) tan(d) tandel lossfactor lossfaktor verlustfaktor
        facteurdeperte dampingfactor losstangent 손실계수 손실탄젠트""",
    "phase": "phase phaseangle phaselag lossangle phasenwinkel verlustwinkel delta δ 위상각 위상",
    "a_T": "at shiftfactor horizontalshift horizontalshiftfactor verschiebungsfaktor 이동인자 시프트팩터",
    "b_T": "bt verticalshift verticalshiftfactor",
    "run": "set setno run runno runnumber cycle sweep sweepno step stepno segment specimen probe sample sampleno",
}
_ANGULAR = "ω omega w angularfrequency angfrequency angfreq circularfrequency kreisfrequenz 각주파수"
_REDUCED = "fred reducedfrequency redfrequency f·at fat at·f atf fr reduziertefrequenz f*at at*f 환산주파수"
_PEAK_TO_PEAK = "dsa doublestrainamplitude peaktopeakstrain strainp-p strainpp"

_MEANINGS: Final = (
    {name: Meaning(quantity) for quantity, names in _NAMES.items() for name in names.split()}
    | {name: Meaning("frequency", angular=True) for name in _ANGULAR.split()}
    | {name: Meaning("frequency", reduced=True) for name in _REDUCED.split()}
    | {name: Meaning("strain", peak_to_peak=True) for name in _PEAK_TO_PEAK.split()}
)
_LONGEST_NAME = 80
"""Longer cells are sentences."""
_OTHER_LETTERS = {"e", "g"}
"""Lower-case letters that are no modulus: e is often a strain, F without a frequency unit a force."""
_PRIMES = str.maketrans(
    {"’": "'", "‘": "'", "′": "'", "`": "'", "´": "'", "″": "''", '"': "''", "”": "''", "“": "''"}
)
_BRACKETS: Final = (
    r"(?P<name>.+?)\s*\[(?P<unit>[^\[\]]*)\]",
    r"(?P<name>.+?)\s*\((?P<unit>[^()]*)\)",
    r"(?P<name>.+?)\s*<(?P<unit>[^<>]*)>",
)
_LOOSE: Final = (
    r"(?P<name>.+)_(?P<unit>[^_]+)",
    r"(?P<name>.+?)\s*/\s*(?P<unit>.+)",
    r"(?P<name>.+?)\s*,\s*(?P<unit>.+)",
    r"(?P<name>.+?)\s+in\s+(?P<unit>.+)",
    r"(?P<name>.+?)\s*(?P<unit>%)",
    r"(?P<name>.+)\s+(?P<unit>\S+)",
)
"""What stands behind is a unit only if it is known."""
_WITH_LOGARITHMS: Final = frozenset({"frequency", "time", "storage", "loss", "relaxation", "a_T", "b_T"})
_AT: Final = re.compile(
    r"\s*(?:(?:@|\bat\b|\bbei\b)\s*|(?=[(\[]))(?P<open>[(\[])?\s*(?<![\w.,])(?P<number>-?\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>k?Hz|°C|ºC|℃|degC)(?(open)\s*[)\]])",
    re.IGNORECASE,
)
_LOG = re.compile(r"(?P<log>log_?10|log|lg|ln)[\s_]*(?P<rest>\(.+\)|\[.+\]|.+)", re.IGNORECASE)


def meaning(header: str) -> Meaning | None:
    """Quantity named by a header cell; None if the name is not known.

    Notes
    -----
    A unit stands in brackets, or after `_`, `/`, a comma, a blank or `in` if what follows is a known unit; a set point,
    as in `E'(10 Hz)/MPa`, is taken apart first. A lone `t`, `T` or `Ts` is a time or a temperature by its unit, without
    one by its case.

    Examples
    --------
    >>> meaning("E'' (MPa)")[:4], meaning("E''(3.3Hz)/MPa").at
    (('loss', 'MPa', None, 'E'), SetPoint(quantity='frequency', number='3.3', unit='Hz'))
    >>> meaning("log_aT").log_base, meaning("storage_Pa").unit, meaning("Point")
    (10.0, 'Pa', None)
    """
    if len(header) > _LONGEST_NAME:
        return None
    text = " ".join(header.translate(_PRIMES).split())
    if point := _AT.search(text):
        sense = meaning((text[: point.start()] + text[point.end() :]).strip())
        quantity = "temperature" if point["unit"].lower()[-1] in "c℃" else "frequency"
        return sense and sense._replace(at=SetPoint(quantity, point["number"], point["unit"]))
    sense = _linear(text)
    if sense is not None or not (log := _LOG.fullmatch(text)):
        return sense
    rest = log["rest"].strip()
    whole = rest[1:-1] if rest[0] + rest[-1] in {"()", "[]"} else rest
    outer = re.sub(r"\(([^()]+)\)(?=\s*[\[(][^()\[\]]+[\])]$)", r"\1 ", rest, count=1)  # "(f) [Hz]"
    inner = _linear(whole) or _linear(rest) or _linear(outer)
    if inner is None or inner.quantity not in _WITH_LOGARITHMS:
        return None
    return inner._replace(log_base=math.e if log["log"].lower() == "ln" else 10.0)


def _linear(text: str) -> Meaning | None:
    """A name with its unit, if it has one."""
    bare = _named(text)
    if bare is not None:
        return bare
    for split in (*_BRACKETS, *_LOOSE):
        match = re.fullmatch(split, text)
        sense = _named(match["name"], match["unit"]) if match else None
        if match and sense and (split in _BRACKETS or find_unit(DIMENSIONS[sense.quantity], match["unit"])):
            return sense._replace(unit=match["unit"].strip())
    return None


def _named(text: str, unit: str | None = None) -> Meaning | None:
    """A name without its unit; a symbol may follow or precede the words, as in "Storage modulus E'"."""
    if text.strip() in {"t", "T", "Ts"}:
        return Meaning(_time_or_temperature(text.strip(), unit))
    sense = _word(text)
    if sense is not None:
        return _by_unit(text.strip(), sense, unit)
    parts = re.fullmatch(r"(.+?)\s*[(\[]([^()\[\]]+)[)\]]", text) or re.fullmatch(r"(.+)[\s,]+(\S+)", text)
    if parts is None:
        return None
    first, second = _word(parts[1]), _word(parts[2])
    if parts[2] in {"t", "T"}:
        return first if first and first.quantity in {"time", "temperature"} else None
    if first is None or second is None or first.quantity != second.quantity:
        return None
    return first._replace(
        letter=first.letter or second.letter,
        angular=first.angular or second.angular,
        peak_to_peak=first.peak_to_peak or second.peak_to_peak,
    )


def _by_unit(name: str, meaning: Meaning, unit: str | None) -> Meaning | None:
    """What a known name means beside its unit: F is a force without Hz, g_i in MPa a modulus and no share."""
    if meaning.quantity == "share" and unit is not None and find_unit("modulus", unit):
        return Meaning("term", letter="G" if name[0] in "gG" else "")
    force = name == "F" and not (unit is not None and find_unit("frequency", unit))
    return None if force or name in _OTHER_LETTERS else meaning


def _time_or_temperature(letter: str, unit: str | None) -> str:
    for dimension in ("time", "temperature"):
        if unit is not None and find_unit(dimension, unit):
            return dimension
    return "temperature" if letter[0] == "T" else "time"


def _word(text: str) -> Meaning | None:
    """A name alone, with the letter of its modulus."""
    compact = re.sub(r"[\s_.|\-]+", "", text.lower())
    sense = _MEANINGS.get(compact)
    if sense is None or DIMENSIONS[sense.quantity] != "modulus":
        return sense
    return sense._replace(
        letter="G"
        if compact.startswith(("g", "shear"))
        else "E"
        if compact.startswith(("e", "tensile"))
        else ""
    )
