"""From a measured master curve to a compound file: fit, provenance, and what is not known."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from conveyor.errors import InputError
from conveyor.models import RubberCompound
from conveyor.rubber import PronyFit, fit_prony, read_master_curve

_DIGITS = 12  # read back, the series is the fit to 1e-11
_SHIFT_COLUMNS = ("temperature_degC", "a_T")
_UNKNOWN = "not stated"


def fit_file(
    data: Path,
    *,
    name: str,
    reference_temperature: str | None = None,
    shift: Path | None = None,
    poisson_ratio: float = 0.5,
    equilibrium: float | None = None,
    terms_per_decade: float = 1.0,
) -> tuple[RubberCompound, PronyFit]:
    """Fit a master-curve file and describe the result as a compound.

    Parameters
    ----------
    data : Path
        Master curve: frequency, E', E'' with units in the header (`conveyor.rubber.read_master_curve`).
    name : str
        Name of the compound.
    reference_temperature : str, optional
        Temperature of the master curve, with unit ("20 degC"); else the file's line ``# reference_temperature: …``.
    shift : Path, optional
        CSV with the header ``temperature_degC,a_T``; without it the compound holds at its reference only.
    poisson_ratio : float
        ν [-].
    equilibrium : float, optional
        E_e held in the fit [Pa]; fitted without it.
    terms_per_decade : float
        Density of the times [1/decade].

    Raises
    ------
    InputError
        A file is refused, or a value is outside its range.
    """
    curve = read_master_curve(data)
    reference = reference_temperature or _stated_temperature(data, curve.metadata)
    fit = fit_prony(
        curve.frequency_Hz,
        curve.storage_Pa,
        curve.loss_Pa,
        terms_per_decade=terms_per_decade,
        equilibrium=equilibrium,
    )
    table = None if shift is None else read_shifts(shift)
    missing = ["strain dependence", "vertical shift (none applied)"]
    described: dict[str, Any] = {
        "name": name,
        "kind": "measured",
        "source": {
            "origin": curve.metadata.get("origin", _UNKNOWN),
            "licence": curve.metadata.get("licence", _UNKNOWN),
            "data": data.name,
        },
        "poisson_ratio": poisson_ratio,
        "strain": curve.metadata.get("strain", _UNKNOWN),
        "reference_temperature": reference,
        "prony": {
            "equilibrium": f"{fit.series.equilibrium / 1e6:.{_DIGITS}g} MPa",
            "terms": [
                {"modulus": f"{modulus / 1e6:.{_DIGITS}g} MPa", "time": f"{time:.{_DIGITS}g} s"}
                for modulus, time in zip(fit.series.moduli, fit.series.times, strict=True)
            ],
        },
        "range": {
            "frequency": [f"{limit:.{_DIGITS}g} Hz" for limit in fit.window],
            "temperature": [reference] * 2,
        },
        "fit": {
            "storage_rms": fit.storage.rms,
            "loss_rms": fit.loss.rms,
            "storage_worst": abs(fit.storage.worst),
            "loss_worst": abs(fit.loss.worst),
            "method": f"NNLS on relative errors of E' and E'', {terms_per_decade:g} times per decade inside the data "
            f"window, equilibrium {'free' if equilibrium is None else 'held'}",
        },
        "missing": missing,
    }
    if table is None:
        missing.append("temperature shift: known at the reference temperature only")
    else:
        temperatures = [f"{t:.{_DIGITS}g} degC" for t, _ in table]
        described["shift"] = {"law": "table", "temperature": temperatures, "log10_aT": [y for _, y in table]}
        described["range"]["temperature"] = [temperatures[0], temperatures[-1]]
    return RubberCompound.from_data(described), fit


def _stated_temperature(data: Path, metadata: Mapping[str, str]) -> str:
    """Temperature that a master curve's comment states, e.g. ``39.96 degC (where a_T = 1)``."""
    stated = metadata.get("reference_temperature", "")
    found = re.match(r"\s*(\S+ ?(?:degC|degF|K|°C|°F))\b", stated)
    if found is None:
        raise InputError(
            f'{data}: the temperature of the master curve is not stated; give it, e.g. --at "20 degC", or write '
            '"# reference_temperature: 20 degC" into the file'
        )
    return found[1]


def read_shifts(path: Path) -> list[tuple[float, float]]:
    """Rows (temperature [degC], log10 a_T) of a shift file, coldest first.

    Raises
    ------
    InputError
        The file or a row is refused, with its line.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    rows = [(i, line) for i, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    header = tuple(cell.strip() for cell in rows[0][1].split(",")) if rows else ()
    if header != _SHIFT_COLUMNS:
        raise InputError(f"{path}: the first line after the comments must be {','.join(_SHIFT_COLUMNS)}")
    found = []
    for number, line in rows[1:]:
        try:
            temperature, factor = (float(cell) for cell in next(csv.reader([line])))
        except ValueError:
            raise InputError(f'{path}:{number}: got "{line}", two numbers are needed: degC, a_T') from None
        if not (math.isfinite(temperature) and 0.0 < factor < math.inf):
            raise InputError(
                f'{path}:{number}: got "{line}", a finite temperature and a positive a_T are needed'
            )
        found.append((temperature, math.log10(factor)))
    return sorted(found)


def dump(compound: RubberCompound) -> str:
    """YAML text of a compound file, as the shelf reads it."""
    from ruamel.yaml import YAML

    writer = YAML(typ="rt", pure=True)
    writer.width = 110
    stream = io.StringIO()
    writer.dump(compound.as_data(), stream)
    return stream.getvalue()
