"""Tables of measured runs, .csv or .xlsx: units in the headers, one row a run."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from conveyor.errors import InputError
from conveyor.measured.measurement_table import ColumnMeaning, MeasuredRow, TableKind, read_rows
from conveyor.models import MeasuredRun

_RUN_TABLE: Final = TableKind(
    what="table of measured runs",
    one="run",
    columns={
        "motor power": ColumnMeaning("power", "power"), "mains power": ColumnMeaning("power", "power"),
        "flow": ColumnMeaning("flow", "mass flow"), "mass flow": ColumnMeaning("flow", "mass flow"),
        "speed": ColumnMeaning("speed", "speed"), "belt speed": ColumnMeaning("speed", "speed"),
        "temperature": ColumnMeaning("temperature", "temperature"),
        "belt temperature": ColumnMeaning("temperature", "temperature"),
        "air temperature": ColumnMeaning("air_temperature", "temperature"),
        "standard deviation": ColumnMeaning("deviation", "power", share="fraction"), "note": ColumnMeaning("note", ""),
    },
    needed={"power": "motor power [kW] or mains power [kW]", "flow": "flow [t/h], 0 where empty"},
    example='"motor power [kW],flow [t/h],temperature [degC]"',
)  # fmt: skip
_POWER_POINTS: Final = {"motor power": "motor shaft", "mains power": "mains"}


def read_runs(path: str | Path) -> tuple[MeasuredRun, ...]:
    """Read measured runs.

    Parameters
    ----------
    path : str or Path
        Table with a header: ``motor power`` or ``mains power`` (or both, one of them filled in each row) and ``flow``;
        further ``speed``, ``temperature``, ``air temperature``, ``standard deviation``, ``note``. Units are in the
        headers, as in ``flow [t/h]``; the standard deviation is a power or a percentage of the row's.

    Returns
    -------
    tuple of MeasuredRun
        In their order.

    Raises
    ------
    InputError
        ``file:row: column: what, and what to do``, for anything that is no number, unit or column known.
    """
    return tuple(map(_measured_run, read_rows(path, _RUN_TABLE)))


def _measured_run(row: MeasuredRow) -> MeasuredRun:
    given = {**row.given, "at": _POWER_POINTS[row.header("power")]}
    if "deviation" in given and given["deviation"].dimensionless:
        share = float(given["deviation"].to_base_units().magnitude)
        if not 0.0 < share < 1.0:
            raise row.refusal(f"got {100.0 * share:g} % of the power, allowed: > 0 % and < 100 %", "deviation")
        given["deviation"] = abs(given["power"]) * share
    try:
        return MeasuredRun.from_data(given)
    except InputError as error:
        raise row.refusal(str(error)) from None
