"""Number formats of the workbook, by the unit or the name of a column or figure."""

from __future__ import annotations

import re
from functools import cache
from typing import Final

_UNIT: Final = re.compile(r"\[([^\]]*)\]$")

_BY_NAME: Final = (
    (r"error", "0.0E+00"),
    (r"^transit", "#,##0"),
    (r"^(time over|stopping time).*\[s\]", "#,##0.0"),
    (r"^value$|^strength", "#,##0.0"),
    (r"share|penetration of cover|against base|working strain", "0.0%"),
    (r"factor of strain", "0.000"),
    (r"\bf \[-\]|^classical f", "0.0000"),
    (r"friction \[-\]|tan delta|^energy \[kWh/", "0.0000"),
    (r"^(order|matrices|nodes|retardation|temperatures averaged|motors$|steps)", "#,##0"),
    (r"change over|bound over", "0.0E+00"),
    (r"^(diameter|roll|cover|least|of the series).*\[mm\]", "#,##0.0"),
    (r"^(diameter|roll|cover|least|of the series).*\[in\]", "#,##0.00"),
    (r"spacing", "0.00"),
)
"""Names that say more than their unit; the first pattern found in a name holds."""
_BY_UNIT: Final = {
    "s": "0.00E+00", "Hz": "0.00E+00", "kg": "#,##0", "t": "#,##0", "h": "#,##0", "rpm": "#,##0.0", "a": "0.0",
    "m/s²": "0.000", "N/m": "#,##0.00", "kg/m": "0.00", "deg": "0.00", "-": "0.00", "m/s": "0.00", "degC": "0.0",
    "mm": "#,##0.000", "MPa": "#,##0.000", "N/mm": "#,##0.0", "m": "#,##0.0", "N": "#,##0.0", "kW": "#,##0.0",
    "MWh": "#,##0.0", "t/h": "#,##0.0",
    "ft": "#,##0.0", "in": "0.0000", "lbf": "#,##0.0", "hp": "#,##0.0", "lb": "#,##0", "lb/ft": "0.00",
    "lbf/in": "#,##0.0000", "psi": "#,##0.0", "fpm": "#,##0.0", "ft/s²": "0.00", "stph": "#,##0.0", "degF": "0.0",
}  # fmt: skip
_CURRENCY: Final = re.compile(r"[A-Z]{3}")


@cache
def number_format(column: str) -> str:
    """Return the number format of a column or figure from the unit in its name.

    Examples
    --------
    >>> number_format("tension [N]"), number_format("tension [lbf]"), number_format("error estimate [-]")
    ('#,##0.0', '#,##0.0', '0.0E+00')
    """
    named = next((shown for pattern, shown in _BY_NAME if re.search(pattern, column)), None)
    if named is not None:
        return named
    found = _UNIT.search(column)
    unit = "" if found is None else found[1]
    return "#,##0" if _CURRENCY.fullmatch(unit) else _BY_UNIT.get(unit, "General")
