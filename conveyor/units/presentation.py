"""Units and digits of reports, for every kind of quantity and system of units.

Values come in SI units; energies per mass and distance in kWh/(t km), paybacks in years, money in its currency.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from conveyor.errors import InputError
from conveyor.units.quantities import Quantity, System, quantity, si
from conveyor.units.sentences import format_number, format_rating, format_strength

SYSTEMS: Final[tuple[System, ...]] = ("SI", "US")
NEVER: Final = "never"
"""Text of an infinite payback."""
MONEY: Final = "money "
"""Prefix of the kinds of money, before the currency's code."""
_GROUPED_BELOW: Final = 1e12
_LARGEST_SHOWN: Final = {"margin": 1.0, "life": 1e6}  # in the unit of reports; larger sizes are meaningless
_NEGATIVE_FACTOR: Final = 10.0  # times that, below zero
_SIGNIFICANT, _DECIMALS = 12, 9  # beyond them is the rounding of a conversion
_SIGNS: Final = {"degC": "°C", "degF": "°F", "deg": "°", "-": ""}


class _Format(NamedTuple):
    """Unit and format of a kind in one system, in tables and on axes."""

    unit: str | None
    digits: str
    large: tuple[str, str] | None = None


_COMMON_FORMATS: Final = {
    "text": _Format(None, ""), "number": _Format(None, ""), "verdict": _Format(None, ""),
    "count": _Format(None, ",.0f"),
    "ratio": _Format("-", ".2f"), "share": _Format("-", ".1%"), "factor": _Format("-", ".3f"),
    "friction": _Format("-", ".4f"),
    "decades": _Format("-", ".4f"),
    "error": _Format("-", ".1E"), "time": _Format("s", ".2E"), "duration": _Format("s", ",.1f"),
    "life": _Format("h", ",.0f"),
    "frequency": _Format("Hz", ".2E"), "passing": _Format("Hz", ",.0f"), "rotation": _Format("rpm", ",.1f"),
    "angle": _Format("deg", ".2f"), "carbon dioxide": _Format("t", ",.0f"), "energy": _Format("MWh", ",.1f"),
    "heat": _Format("MJ", ",.3f"), "rise": _Format("K", ",.0f"), "swing": _Format("Hz", ".1f"),
    "emission factor": _Format("kg/kWh", ".3f"), "years": _Format("a", ".1f"), "margin": _Format("-", ".1%"),
}  # fmt: skip
"""Kinds written alike in every system."""
_KIND_FORMATS: Final[dict[System, dict[str, _Format]]] = {
    "SI": {
        **_COMMON_FORMATS,
        "length": _Format("m", ",.1f"), "spacing": _Format("m", ".2f"), "size": _Format("mm", ",.1f"),
        "thickness": _Format("mm", ",.2f"), "speed": _Format("m/s", ".2f"), "acceleration": _Format("m/s²", ".3f"),
        "force": _Format("N", ",.0f", ("kN", ",.1f")), "roll force": _Format("N", ",.1f"),
        "line force": _Format("N/m", ",.2f"), "area": _Format("m²", ".3f"),
        "strength": _Format("N/mm", ",.1f"), "pressure": _Format("MPa", ",.3f"), "mass": _Format("kg", ",.0f"),
        "line mass": _Format("kg/m", ".2f"), "mass flow": _Format("t/h", ",.1f"), "power": _Format("kW", ",.1f"),
        "torque": _Format("N m", ",.0f"), "temperature": _Format("degC", ".1f"), "density": _Format("kg/m³", ",.0f"),
        "inertia": _Format("kg m²", ",.2f"), "wind": _Format("m/s", ".1f"),
        "conveyed": _Format("t", ",.0f"), "area mass": _Format("kg/m²", ".3f"), "carryback": _Format("kg/h", ",.1f"),
        "specific energy": _Format("kWh/(t km)", ".4f"),
    },
    "US": {
        **_COMMON_FORMATS,
        "length": _Format("ft", ",.1f"), "spacing": _Format("ft", ".2f"), "size": _Format("in", ",.2f"),
        "thickness": _Format("in", ".4f"), "speed": _Format("fpm", ",.1f"), "acceleration": _Format("ft/s²", ".2f"),
        "force": _Format("lbf", ",.0f", ("lbf", ",.0f")), "roll force": _Format("lbf", ",.2f"),
        "line force": _Format("lbf/in", ",.4f"), "area": _Format("ft²", ".2f"),
        "strength": _Format("lbf/in", ",.1f"), "pressure": _Format("psi", ",.1f"), "mass": _Format("lb", ",.0f"),
        "line mass": _Format("lb/ft", ".2f"), "mass flow": _Format("stph", ",.1f"), "power": _Format("hp", ",.1f"),
        "torque": _Format("lbf ft", ",.0f"), "temperature": _Format("degF", ".1f"),
        "density": _Format("lb/ft³", ",.1f"),
        "inertia": _Format("lb ft²", ",.1f"), "wind": _Format("mph", ".1f"), "rise": _Format("Δ°F", ",.0f"),
        "carbon dioxide": _Format("metric ton", ",.0f"), "conveyed": _Format("short ton", ",.0f"),
        "area mass": _Format("lb/ft²", ".4f"), "carryback": _Format("lb/h", ",.1f"),
        "specific energy": _Format("kWh/(short ton mile)", ".4f"),
    },
}  # fmt: skip
_UNIT_SIZES: Final = {"-": 1.0, "rpm": 1.0 / 60.0, "deg": math.pi / 180.0, "kWh/(t km)": 1.0, "kg/kWh": 1.0, "a": 1.0,
    "N m": 1.0, "lbf ft": 4.4482216152605 * 0.3048, "short ton": 907.18474, "metric ton": 1000.0,
    "kWh/(short ton mile)": 1.0 / (0.90718474 * 1.609344), "kg m²": 1.0, "lb ft²": 0.45359237 * 0.3048**2, "K": 1.0,
    "Δ°F": 5.0 / 9.0,
}  # fmt: skip
"""SI sizes of units that the registry does not know by this spelling."""


@dataclass(frozen=True)
class Unit:
    """Unit and format of a kind of quantity in a system.

    Attributes
    ----------
    label : str or None
        Unit as headers write it; None for kinds without one.
    digits : str
        Python format of its numbers; empty for six significant digits.
    size, zero : float
        Value of one unit and of its zero point in SI.
    exact : bool
        False: converted values are rounded to 12 digits.
    most : float
        Larger numbers are written "> most", those below -10 times it "< -10 most".
    """

    label: str | None
    digits: str
    size: float = 1.0
    zero: float = 0.0
    exact: bool = field(default=True, repr=False)
    most: float = math.inf

    def __call__(self, values: ArrayLike) -> Any:
        """Convert SI values to this unit, for axes."""
        given = np.asarray(values, dtype=float) - self.zero
        scaled = given * (1.0 / self.size) if self.size < 1.0 else given / self.size
        return scaled if self.zero == 0.0 else np.round(scaled, _DECIMALS)

    def shown(self, value: Any) -> Any:
        """Convert one SI value to this unit; text, gaps and whole numbers stay as they are."""
        if isinstance(value, np.generic):
            value = value.item()
        if not isinstance(value, float) or not math.isfinite(value):
            return value
        scaled = (value - self.zero) * (1.0 / self.size) if self.size < 1.0 else (value - self.zero) / self.size
        if self.zero != 0.0:
            return round(scaled, _DECIMALS) + 0.0  # a difference of like figures; no -0
        return scaled if self.exact else float(f"{scaled:.{_SIGNIFICANT}g}")

    def written(self, value: Any) -> str:
        """One SI value as text, without its unit.

        Examples
        --------
        >>> (
        ...     display_unit("force").written(84147.576),
        ...     display_unit("share").written(0.4681),
        ...     display_unit("margin").written(102.7),
        ... )
        ('84,148', '46.8 %', '> 100 %')
        >>> display_unit("margin").written(-1.5), display_unit("margin").written(-5979.0)
        ('-150.0 %', '< -1,000 %')
        >>> display_unit("life").written(3600.0 * 45_678.0), display_unit("life").written(3600.0 * 6e8)
        ('45,678', '> 1,000,000')
        """
        number = self.shown(value)
        if isinstance(number, bool):
            return "yes" if number else "NO"
        if isinstance(number, str):
            return number
        if number is None or math.isnan(number):
            return ""
        if math.isinf(number) and math.isinf(self.most):
            return NEVER if self.label == "a" else "∞" if number > 0.0 else "-∞"
        if isinstance(number, int):
            return f"{number:,}"
        digits, more = self.digits or ",.6g", ""
        if not -_NEGATIVE_FACTOR * self.most <= number <= self.most:
            number, more = (self.most, "> ") if number > 0.0 else (-_NEGATIVE_FACTOR * self.most, "< ")
            digits = f",{digits.removeprefix(',').replace('.1', '.0')}"
        return more + drop_zero_sign(f"{number:{digits}}").replace("%", " %")

    def said(self, value: Any) -> str:
        """One SI value as text with its unit, for sentences.

        Examples
        --------
        >>> (
        ...     display_unit("force", large=True).said(168734.4),
        ...     display_unit("force", "US", large=True).said(168734.4),
        ... )
        ('168.7 kN', '37,933 lbf')
        """
        return self._with_sign(self.written(value))

    def four_digits(self, value: float | str) -> str:
        """One SI value to four digits with its unit, for sentences; text stays as it is.

        Examples
        --------
        >>> (
        ...     display_unit("speed").four_digits(5.0),
        ...     display_unit("speed", "US").four_digits(5.08),
        ...     display_unit("mass flow").four_digits(2000.0 / 3.6),
        ... )
        ('5 m/s', '1,000 fpm', '2,000 t/h')
        """
        number = self.shown(value)
        if isinstance(number, str):
            return number
        written = f"{number:.4g}"
        if 1000.0 <= abs(float(written)) < _GROUPED_BELOW:
            written = f"{float(written):,.0f}"
        return self._with_sign(written)

    def short(self, value: float | str | None) -> str:
        """One SI value to three digits with its unit, for summaries; text stays as it is.

        Examples
        --------
        >>> (
        ...     display_unit("power").short(1294412.0),
        ...     display_unit("force", large=True).short(76331.0),
        ...     display_unit("share").short(0.634),
        ... )
        ('1,290 kW', '76.3 kN', '63.4 %')
        """
        number = self.shown(value)
        if not isinstance(number, float) or self.digits.endswith("%"):
            return self.written(value)
        return self._with_sign(format_number(number))

    def quantity_text(self, value: Quantity) -> str:
        """A quantity of a spec as text in this unit, for sentences."""
        return self.written(si(value)) if self.digits.endswith("%") else self.four_digits(si(value))

    def _with_sign(self, number: str) -> str:
        """A number and its unit, with a space between them but for degrees of arc (SI brochure 5.4.3)."""
        return f"{number}{self.sign}" if self.sign == "°" else f"{number} {self.sign}".rstrip()

    def beside(self, words: str) -> str:
        """Label with the unit in brackets, for an axis.

        Examples
        --------
        >>> display_unit("force", large=True).beside("tension"), display_unit("friction").beside("tan δ")
        ('tension [kN]', 'tan δ [-]')
        """
        return f"{words} [{self.sign or self.label}]"

    @property
    def sign(self) -> str:
        """Unit sign for pages and sentences: degrees with their sign, none for ratios."""
        return "" if self.label is None else _SIGNS.get(self.label, self.label)

    @property
    def pattern(self) -> str:
        """Number format of spreadsheets.

        Examples
        --------
        >>> (
        ...     display_unit("force").pattern,
        ...     display_unit("error").pattern,
        ...     display_unit("share").pattern,
        ...     display_unit("text").pattern,
        ... )
        ('#,##0', '0.0E+00', '0.0 %', 'General')
        """
        if not self.digits:
            return "General"
        decimals = int(self.digits.strip(",.f%E"))
        whole = "#,##0" if self.digits.startswith(",") else "0"
        ending = {"%": " %", "E": "E+00"}.get(self.digits[-1], "")
        shown = whole + ("." + "0" * decimals if decimals else "") + ending
        most = self.written(math.inf)
        return shown if math.isinf(self.most) else f'[>{self.most:.0f}]"{most}";[<0]-{shown};{shown}'


@cache
def display_unit(kind: str, system: System = "SI", *, large: bool = False) -> Unit:
    """Return the unit and format of a kind in a system; `large`: of axes and sentences, kN instead of N.

    Examples
    --------
    >>> (
    ...     display_unit("power").shown(897500.0),
    ...     display_unit("temperature", "US").shown(293.15),
    ...     display_unit("money EUR").label,
    ... )
    (897.5, 68.0, 'EUR')
    """
    if kind.startswith(MONEY):
        currency = kind.removeprefix(MONEY)
        return Unit(currency, ",.4f" if "/" in currency else ",.0f")
    unit_of = _KIND_FORMATS[system][kind]
    label, digits = unit_of.large if large and unit_of.large else (unit_of.unit, unit_of.digits)
    exact = system == "SI" or _KIND_FORMATS["SI"][kind].unit == label
    most = _LARGEST_SHOWN.get(kind, math.inf)
    if label is None or label in _UNIT_SIZES:
        return Unit(label, digits, _UNIT_SIZES.get(label or "-", 1.0), most=most)
    if kind == "temperature":
        one = si(quantity("1 K")) if label == "degC" else 5.0 / 9.0
        return Unit(label, digits, one, si(quantity(f"0 {label}", kind)), exact)
    return Unit(label, digits, si(quantity(f"1 {label}")), exact=exact, most=most)


def label_for_people(label: str, kind: str, system: System = "SI") -> str:
    """Return a label with its unit for people: degrees with their sign, none for per cent.

    Examples
    --------
    >>> (
    ...     label_for_people("temperature", "temperature"),
    ...     label_for_people("share", "share"),
    ...     label_for_people("f", "friction"),
    ... )
    ('temperature [°C]', 'share', 'f [-]')
    """
    unit_of = display_unit(kind, system)
    return label if unit_of.label is None or unit_of.digits.endswith("%") else unit_of.beside(label)


def column_name(label: str, kind: str, system: System = "SI") -> str:
    """Return the name of a column or figure in tables: label and unit.

    Examples
    --------
    >>> (
    ...     column_name("motor power", "power", "US"),
    ...     column_name("strand", "text"),
    ...     column_name("share", "share"),
    ... )
    ('motor power [hp]', 'strand', 'share [-]')
    """
    return label_with_unit(label, display_unit(kind, system).label)


def label_with_unit(label: str, sign: str | None) -> str:
    """Return a label with its unit in brackets, if it has one."""
    return f"{label} [{sign}]" if sign else label


def drop_zero_sign(number: str) -> str:
    """Drop the minus of a number that rounds to zero."""
    return number.removeprefix("-") if not number.strip("-0.,%") else number


def report_system(own: System, system: System | None) -> System:
    """Return the system of units of a report: the given one, else the spec's own.

    Raises
    ------
    InputError
        Not one of the systems.
    """
    if system is not None and system not in SYSTEMS:
        raise InputError(f'system = "{system}": SI or US, or none for that of the spec (report.units)')
    return system or own


def belt_strength_text(value: Quantity, system: System) -> str:
    """Breaking strength per width as text, as in belt names."""
    return format_strength(si(value), system)


def belt_rating_text(value: Quantity, system: System) -> str:
    """Rated working tension per width as text."""
    return format_rating(si(value), system)
