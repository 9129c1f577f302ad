"""Units as laboratories write them, to SI: a factor and an offset for each."""

from __future__ import annotations

import math
import re
from types import MappingProxyType
from typing import Final, NamedTuple


class ColumnUnit(NamedTuple):
    """SI value = factor * (number + offset)."""

    name: str
    factor: float
    offset: float = 0.0


_POUND_FORCE_PER_SQUARE_INCH: Final = 6894.757293168361
"""0.45359237 kg * 9.80665 m/s^2 / (0.0254 m)^2, exact definitions, rounded to double."""
_STANDARD_GRAVITY: Final = 9.80665
"""[m/s^2], exact by definition; 1 kgf = 9.80665 N."""
_UnitSpellings = dict[str, tuple[float, str] | tuple[float, str, float]]
_PLAIN_NUMBER: Final[_UnitSpellings] = {"-": (1.0, "1 – — none dimensionless")}
_SPELLINGS: Final[dict[str, _UnitSpellings]] = {
    "frequency": {
        "Hz": (1.0, "hz HZ cps cycles/s Гц 赫兹 赫 ヘルツ 헤르츠"),
        "rad/s": (
            1.0 / (2.0 * math.pi),
            "rads/s rad/sec radian/s radians/s rads^-1 rads-1 radsec^-1 Rad/s rad·s^-1 rad·s-1 рад/с"
            " 弧度/秒 ラジアン/秒",
        ),
        "kHz": (1e3, "khz KHz кГц"),
        "mHz": (1e-3, "мГц"),
        "MHz": (1e6, "МГц"),
    },
    "modulus": {
        "Pa": (1.0, "pascal N/m^2 N/m2 Па 帕 帕斯卡 パスカル 파스칼"),
        "kPa": (1e3, "KPa Kpa kpa KPA кПа 千帕"),
        "MPa": (1e6, "Mpa MPA megapascal N/mm^2 N/mm2 MN/m^2 MN/m2 МПа 兆帕 メガパスカル Н/мм^2 Н/мм2"),
        "GPa": (1e9, "Gpa GPA gpa ГПа 吉帕"),
        "psi": (_POUND_FORCE_PER_SQUARE_INCH, "PSI lbf/in^2 lbf/in2"),
        "ksi": (1e3 * _POUND_FORCE_PER_SQUARE_INCH, "KSI"),
        "dyn/cm^2": (0.1, "dyn/cm2 dyne/cm^2 dyne/cm2 dynes/cm^2 dynes/cm2"),
        "kgf/cm^2": (_STANDARD_GRAVITY / 1e-4, "kgf/cm2"),
        "bar": (1e5, ""),
    },
    "temperature": {
        "degC": (1.0, "C degc celsius Celsius oC gradC ℃ centigrade С degС 摄氏度 攝氏度 摂氏", 273.15),
        "degF": (5.0 / 9.0, "F degf fahrenheit Fahrenheit oF ℉", 459.67),
        "K": (1.0, "kelvin Kelvin degK"),
    },
    "strain": {
        "-": (1.0, "1 – — mm/mm m/m in/in strain fraction dimensionless"),
        "%": (1e-2, "pct percent Prozent % %strain"),
        "permille": (1e-3, "‰"),
        "ppm": (1e-6, "um/m microstrain ustrain uε ue"),
    },
    "time": {
        "s": (1.0, "sec secs second seconds Sek с сек 秒 초"),
        "ms": (1e-3, "msec"),
        "min": (60.0, "minute minutes мин 分 分钟 분"),
        "h": (3600.0, "hr hour hours ч 小时 時間 시간"),
    },
    "angle": {
        "deg": (
            math.pi / 180.0,
            "degree degrees Grad grado grados grau graus stopień stopnie derece град 度 도",
        ),
        "rad": (1.0, "radian radians рад 弧度 ラジアン"),
    },
    "number": _PLAIN_NUMBER,
    "label": _PLAIN_NUMBER,
}
UNITS: Final = MappingProxyType(
    {
        dimension: {
            spelling: ColumnUnit(name, factor, *offset)
            for name, (factor, spellings, *offset) in units.items()
            for spelling in (name, *spellings.split())
        }
        for dimension, units in _SPELLINGS.items()
    }
)
"""For each dimension every accepted spelling, blanks removed."""
_CASELESS_UNITS: Final = MappingProxyType(
    {
        dimension: {
            spelling.lower(): {unit for other, unit in units.items() if other.lower() == spelling.lower()}
            for spelling in units
        }
        for dimension, units in UNITS.items()
    }
)
"""Units by lower-case spelling: several where capitals distinguish them, as mHz and MHz."""
_SIGN_VARIANTS: Final = str.maketrans(
    {"°": "deg", "º": "deg", "˚": "deg", "µ": "u", "μ": "u", "²": "^2", "⋅": "·", "*": "·"}
)


def find_unit(dimension: str, text: str) -> ColumnUnit | None:
    """Unit of a dimension by its spelling, brackets allowed; None if unknown.

    Examples
    --------
    >>> find_unit("modulus", "[ N/mm² ]"), find_unit("temperature", "°C").offset, find_unit("modulus", "Hz")
    (ColumnUnit(name='MPa', factor=1000000.0, offset=0.0), 273.15, None)
    >>> find_unit("modulus", "mpa").name, find_unit("modulus", "mPa"), find_unit("frequency", "mhz")
    ('MPa', None, None)

    Notes
    -----
    Capitals do not count where one unit is left without them: kpa, hz, degc. A modulus in "mpa" is in MPa, no solid has
    one of millipascals; "mPa", written so on purpose, and "mhz" stay open.
    """
    plain = re.sub(r"\s+", "", text).replace("⁻¹", "^-1")
    if len(plain) > 1 and plain[0] + plain[-1] in {"[]", "()", "<>"}:
        plain = plain[1:-1]
    plain = plain.translate(_SIGN_VARIANTS)
    exact = UNITS[dimension].get(plain)
    if exact is not None or (plain[:1] == "m" and plain != plain.lower()):
        return exact
    folded = _CASELESS_UNITS[dimension].get(plain.lower(), set())
    return next(iter(folded)) if len(folded) == 1 else None


def is_any_unit(text: str) -> bool:
    """True for a unit of any dimension."""
    return any(find_unit(dimension, text) for dimension in UNITS)


def allowed_units(dimension: str) -> str:
    """Names of the units of a dimension, for messages."""
    return ", ".join(_SPELLINGS[dimension])
