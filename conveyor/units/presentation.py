"""Figures as text and in tables: the unit and digits of every kind of quantity in a system of units.

Values come in SI units; energies per mass and distance in kWh/(t km), paybacks in years, money in its currency.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from conveyor.units.quantities import Quantity, is_quantity, quantity, si
from conveyor.units.quantity_kinds import KINDS, NO_UNIT, readable_unit
from conveyor.units.registry import UNITS
from conveyor.units.unit_systems import SYSTEMS, System

NEVER: Final = "never"
"""Text of an infinite payback."""
MONEY: Final = "money "
"""Prefix of the kinds of money, before the currency's code."""
DIGITS: Final = 3
"""Significant digits of figures in sentences."""
_INPUT_DIGITS: Final = 4
_GROUPED_BELOW: Final = 1e12
_NEGATIVE_FACTOR: Final = 10.0  # times the largest number shown, below zero
_SIGNIFICANT, _DECIMALS = 12, 9  # beyond them is the rounding of a conversion
_REPORT_UNITS: Final = {
    "kWh/(t km)": 1.0, "kWh/(short ton mile)": 1.0 / (0.90718474 * 1.609344), "kg/kWh": 1.0, "a": 1.0,
    "short ton": 907.18474, "metric ton": 1000.0, NO_UNIT: 1.0,
}  # fmt: skip
"""Sizes of units that specs do not know; of energies per mass and distance, of paybacks in those they come in."""


def format_number(number: float, digits: int = DIGITS) -> str:
    """Format a number to significant digits, its thousands grouped.

    Examples
    --------
    >>> format_number(30097.4), format_number(76.331), format_number(0.04069), format_number(-0.0)
    ('30,100', '76.3', '0.0407', '0')
    """
    rounded = float(f"{number:.{digits}g}")
    if 10.0 ** (digits - 1) <= abs(rounded) < _GROUPED_BELOW:
        return f"{rounded:,.0f}"
    return "0" if rounded == 0.0 else f"{number:,.{digits}g}"


@dataclass(frozen=True)
class Unit:
    """Unit and format of a kind of quantity in a system.

    Attributes
    ----------
    spelled : str or None
        Unit as specs spell it, if they know it; None for kinds without one.
    digits : str
        Python format of its numbers; empty for six significant digits.
    size, zero : float
        Value of one unit and of its zero point in SI.
    exact : bool
        False: converted values are rounded to 12 digits.
    most : float
        Larger numbers are written "> most", those below -10 times it "< -10 most".
    phrase : str
        Python format of its numbers in sentences; empty for significant digits.
    """

    spelled: str | None
    digits: str
    size: float = 1.0
    zero: float = 0.0
    exact: bool = field(default=True, repr=False)
    most: float = math.inf
    phrase: str = ""

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
        if self.zero != 0.0 or math.isfinite(self.most):
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
        >>> display_unit("duration").written(3600.0 * 45_678.0), display_unit("duration").written(3600.0 * 6e8)
        ('45,678', '> 1,000,000')
        """
        return self._table_text(self.shown(value))

    def _table_text(self, number: Any) -> str:
        """A converted value as tables write it."""
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
        return more + _drop_zero_sign(f"{number:{digits}}").replace("%", " %")

    def said(self, value: Any, digits: int | None = None) -> str:
        """One SI value, or a quantity, as text with its unit; text stays as it is.

        Parameters
        ----------
        value : float, str, Quantity or None
            SI value.
        digits : int, optional
            Significant digits; without it those of tables, as whole numbers and per cent always have.

        Examples
        --------
        >>> force, speed = display_unit("force", large=True), display_unit("speed", "US")
        >>> force.said(168734.4), force.said(76331.0, 3), display_unit("share").said(0.634, 3), speed.said(5.08, 4)
        ('168.7 kN', '76.3 kN', '63.4 %', '1,000 fpm')
        """
        number = self.shown(si(value) if is_quantity(value) else value)
        if isinstance(number, str):
            return number
        if digits is None or not isinstance(number, float) or self.digits.endswith("%"):
            return self.with_sign(self._table_text(number))
        return self.with_sign(format_number(number, digits))

    def with_sign(self, number: str) -> str:
        """A number and its unit, with a space between them but for degrees of arc (SI brochure 5.4.3)."""
        if not number:
            return ""
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
    def label(self) -> str | None:
        """Unit in headers: powers as signs."""
        return None if self.spelled is None else readable_unit(self.spelled)

    @property
    def sign(self) -> str:
        """Unit on pages and in sentences: degrees with their sign, none for ratios."""
        return "" if self.spelled in {None, NO_UNIT} else (self.label or "").replace("deg", "°")

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
    """Return the unit and format of a kind in a system; `large`: of axes and large figures, kN instead of N.

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
    shown = SYSTEMS[system].shown(kind)
    spelled, digits = (large and shown.large) or (shown.unit, shown.digits)
    exact = system == "SI" or KINDS[kind].si.unit == spelled
    return _unit_of(kind, spelled, digits, shown.said, exact=exact)


def _unit_of(kind: str, spelled: str | None, digits: str, phrase: str, *, exact: bool) -> Unit:
    """Unit of a kind by its spelling."""
    most = KINDS[kind].most
    if spelled is None or spelled not in UNITS:
        if (spelled or NO_UNIT) not in _REPORT_UNITS:
            raise LookupError(
                f'unit "{spelled}" of {kind}: specs do not know it; give its size in _REPORT_UNITS of '
                "units/presentation.py, or, for specs to know it, its spelling in units/quantity_kinds.py"
            )
        return Unit(spelled, digits, _REPORT_UNITS[spelled or NO_UNIT], most=most, phrase=phrase)
    if kind == "temperature":
        one = si(quantity("1 K")) if spelled in {"degC", "K"} else 5.0 / 9.0
        return Unit(spelled, digits, one, si(quantity(f"0 {spelled}", kind)), exact)
    return Unit(spelled, digits, si(quantity(f"1 {spelled}")), 0.0, exact, most, phrase)


@cache
def _figure_units(kind: str, system: System) -> tuple[Unit, Unit | None, Unit | None]:
    """Units of a figure in sentences: the usual one, that of large and that of small ones."""
    shown, own = SYSTEMS[system].shown(kind), display_unit(kind, system)
    large, small = (each and _unit_of(kind, *each, "", exact=own.exact) for each in (shown.large, shown.small))
    return own, large, small


@cache
def report_units() -> frozenset[str]:
    """Return the signs and labels of all units of reports.

    Examples
    --------
    >>> {"kW", "lbf", "m/s²", "°C"} <= report_units()
    True
    """
    shown = (unit for kind in KINDS for system in SYSTEMS for unit in _figure_units(kind, system) if unit is not None)
    return frozenset(name for unit in shown for name in (unit.sign, unit.label) if name)


def format_figure(
    value: float | Quantity, kind: str, system: System = "SI", *, digits: int | None = None, as_input: bool = False
) -> str:
    """Format an SI figure with its unit: significant digits, thousands grouped, large and small in units of their own.

    Parameters
    ----------
    value : float or Quantity
        SI value, or a quantity.
    kind : str
        A key of `conveyor.units.quantity_kinds.KINDS`.
    system : str
        System of units.
    digits : int, optional
        Significant digits; three, four of `as_input`.
    as_input : bool
        True: as a spec may have it, in the usual unit, no sign but ASCII, no grouping.

    Examples
    --------
    >>> (
    ...     format_figure(30097.4, "force"),
    ...     format_figure(2.267, "force"),
    ...     format_figure(9.81, "acceleration", "US"),
    ...     format_figure(5180.0, "heat"),
    ... )
    ('30.1 kN', '2.27 N', '32.2 ft/s²', '5.18 kJ')
    >>> format_figure(5.08, "speed", "US", as_input=True)
    '1000 fpm'
    """
    unit, large, small = _figure_units(kind, system)
    given = si(value) if is_quantity(value) else float(value)
    number = unit.shown(given)
    if as_input:
        shown = f"{number:.{digits or _INPUT_DIGITS}g}"
        if "e" in shown and 1.0 <= abs(number) < _GROUPED_BELOW:
            shown = f"{number:.0f}"
        return f"{shown} {'' if unit.spelled == NO_UNIT else unit.spelled or ''}".rstrip()
    if unit.phrase:
        return unit.with_sign(f"{number:{unit.phrase}}")
    if large is not None and abs(large.shown(given)) >= 1.0:
        unit = large
    elif small is not None and abs(number) < 1.0:
        unit = small
    return unit.said(given, digits or DIGITS)


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


def _drop_zero_sign(number: str) -> str:
    """Drop the minus of a number that rounds to zero."""
    return number.removeprefix("-") if not number.strip("-0.,%") else number
