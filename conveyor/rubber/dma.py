"""Read a master curve from a small, strict text file; whatever is ambiguous is refused."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from conveyor.errors import InputError
from conveyor.rubber.arrays import FloatArray

_QUANTITIES = {
    "frequency": r"f|freq|frequency|omega|angular[ _]frequency",
    "storage": r"storage|storage[ _]modulus|e'|e_stor|e_storage",
    "loss": r"loss|loss[ _]modulus|e''|e\"|e_loss",
}
_UNITS = {
    "frequency": {"Hz": 1.0, "rad/s": 1.0 / (2.0 * math.pi)},
    "storage": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
    "loss": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
}
_HEADER = re.compile(r"^(?P<name>.+?)(?:_(?P<plain>[A-Za-z]+)|\s*[\[(](?P<bracketed>[^\])]+)[\])])$")
_SHEAR = re.compile(r"^(g'|g''|g_stor|g_loss|shear.*)", re.IGNORECASE)
_LAYOUT = (
    "the first line after the comments names the columns with units, as in 'frequency_Hz,storage_Pa,loss_Pa'"
)
PLAUSIBLE_STORAGE = (1.0e4, 1.0e11)
"""Storage modulus of a solid, soft gel to steel [Pa]; outside, the header states a wrong unit."""


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """A measured master curve in SI, rows as in the file.

    Parameters
    ----------
    frequency_Hz : numpy.ndarray
        Cyclic frequency, shape `(n,)` [Hz].
    storage_Pa : numpy.ndarray
        E', shape `(n,)` [Pa].
    loss_Pa : numpy.ndarray
        E'', shape `(n,)` [Pa].
    metadata : mapping of str
        The `# key: value` lines of the file [-].
    source : str
        The file it was read from [-].
    """

    frequency_Hz: FloatArray  # noqa: N815
    storage_Pa: FloatArray  # noqa: N815
    loss_Pa: FloatArray  # noqa: N815
    metadata: Mapping[str, str]
    source: str


def read_master_curve(path: str | Path) -> MasterCurve:
    r"""Read frequency, E' and E'' from CSV or TXT.

    Parameters
    ----------
    path : str or pathlib.Path
        UTF-8 text, byte-order mark allowed: comment lines `# key: value`, one header line, rows of three
        numbers with a decimal point, separated by comma, semicolon or tab [-].

    Returns
    -------
    MasterCurve
        Values in SI, in the order of the file.

    Raises
    ------
    InputError
        As `file:line: what, what is allowed`, for anything else.

    Notes
    -----
    Units: frequency Hz or rad/s; moduli Pa, kPa, MPa or GPa, written `name_unit`, `name (unit)` or
    `name [unit]`. Not read: shear moduli (E = 3G only if incompressible), decimal commas, a unit row under
    the header, other encodings.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "pad.dma.csv"
    ...     _ = file.write_text("# temperature: 40 degC\nfrequency_Hz,storage_MPa,loss_MPa\n10,6.8,0.74\n")
    ...     curve = read_master_curve(file)
    >>> curve.storage_Pa, curve.metadata["temperature"]
    (array([6800000.]), '40 degC')
    """
    file = Path(path)
    lines = _decoded(file)
    metadata: dict[str, str] = {}
    columns: dict[str, tuple[int, float]] = {}
    separator = ","
    rows: list[list[float]] = []
    row_lines: list[int] = []
    for number, line in enumerate(lines, start=1):
        where = f"{file.name}:{number}"
        if line.startswith("#"):
            key, colon, value = line[1:].partition(":")
            if colon:
                metadata[key.strip()] = value.strip()
        elif not line.strip():
            continue
        elif not columns:
            separator, columns = _header(line, where)
        else:
            rows.append(_row(line, separator, columns, where))
            row_lines.append(number)
    if not rows:
        raise InputError(f"{file.name}: no rows of data found; {_LAYOUT}")
    data = np.array(rows)
    _plausible(data, row_lines, file.name)
    data.setflags(write=False)
    return MasterCurve(data[:, 0], data[:, 1], data[:, 2], MappingProxyType(metadata), str(file))


def _decoded(file: Path) -> list[str]:
    try:
        return file.read_bytes().decode("utf-8-sig").splitlines()
    except FileNotFoundError:
        raise InputError(f"{file}: no such file") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{file.name}: not UTF-8 at byte {error.start}: save it as UTF-8 text") from error


def _header(line: str, where: str) -> tuple[str, dict[str, tuple[int, float]]]:
    """Separator, and for each quantity its column and its factor to SI."""
    found = [s for s in ",;\t" if s in line]
    if len(found) != 1:
        raise InputError(f"{where}: columns must be separated by one of comma, semicolon, tab; {_LAYOUT}")
    columns: dict[str, tuple[int, float]] = {}
    for index, text in enumerate(_cells(line, found[0])):
        quantity, factor = _column(text, where)
        if quantity in columns:
            raise InputError(f"{where}: two columns for {quantity}; exactly one of each is allowed")
        columns[quantity] = (index, factor)
    missing = [q for q in _QUANTITIES if q not in columns]
    if missing:
        raise InputError(f"{where}: no column for {', '.join(missing)}; {_LAYOUT}")
    return found[0], columns


def _column(text: str, where: str) -> tuple[str, float]:
    if _SHEAR.match(text):
        raise InputError(
            f"{where}: column {text!r} is a shear modulus; convert it first (E = 3 G at nu = 0.5)"
        )
    match = _HEADER.match(text)
    for quantity, pattern in _QUANTITIES.items():
        units = _UNITS[quantity]
        allowed = ", ".join(units)
        if match and re.fullmatch(pattern, match["name"].strip(), re.IGNORECASE):
            unit = match["plain"] or match["bracketed"].strip()
            if unit not in units:
                raise InputError(f"{where}: column {text!r}: unit {unit!r} of {quantity}; allowed: {allowed}")
            return quantity, units[unit]
        if re.fullmatch(pattern, text, re.IGNORECASE):
            raise InputError(
                f"{where}: column {text!r} has no unit; allowed for {quantity}: {allowed}; {_LAYOUT}"
            )
    raise InputError(f"{where}: column {text!r} is not known; {_LAYOUT}")


def _cells(line: str, separator: str) -> list[str]:
    """Split without quoting: a header may hold E' and E"."""
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, quoting=csv.QUOTE_NONE))]


def _row(line: str, separator: str, columns: Mapping[str, tuple[int, float]], where: str) -> list[float]:
    cells = _cells(line, separator)
    if len(cells) != len(columns):
        raise InputError(
            f"{where}: {len(cells)} values, the header names {len(columns)} (a decimal comma? use a point)"
        )
    values = []
    for quantity in _QUANTITIES:
        index, factor = columns[quantity]
        try:
            value = float(cells[index])
        except ValueError:
            raise InputError(
                f"{where}: {quantity} = {cells[index]!r} is not a number (decimal point, no unit)"
            ) from None
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{where}: {quantity} = {cells[index]} must be finite and > 0")
        values.append(value * factor)
    return values


def _plausible(data: FloatArray, lines: list[int], name: str) -> None:
    low, high = PLAUSIBLE_STORAGE
    bad = np.flatnonzero((data[:, 1] < low) | (data[:, 1] > high))
    if bad.size:
        raise InputError(
            f"{name}:{lines[bad[0]]}: storage = {data[bad[0], 1]:g} Pa; a solid has {low:g} to {high:g} Pa:"
            " is the unit in the header right (MPa written as Pa)?"
        )
