"""Describe a fit as data of a compound file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.fitting.amplitude import FEWEST_STRAINS
from conveyor.fitting.measured_rows import MeasuredRows, isotherm_scatter, shift_factors
from conveyor.fitting.request import Request
from conveyor.laboratory import DmaData
from conveyor.rubber import WLF, Arrhenius, PronyFit, PronySeries, ReplicaBand, ShiftLaw, Superposition
from conveyor.rubber.band import BOOTSTRAP_METHOD
from conveyor.units.sentences import ZERO_CELSIUS, percent

Array = NDArray[np.float64]

SERIES_DIGITS = 12
"""Digits of a series in a compound file: read back, it is the fit to 1e-11."""
_BAND_DIGITS = 6  # the band is known to one or two
_ERROR_DECIMALS = 8  # of a relative error: an exact fit leaves rounding, which is none
_NOT_STATED = "not stated"
_STATED_EXAMPLES = {
    "temperature": ("temperature [degC]", "temperature: 20 degC"),
    "frequency": ("frequency [Hz]", "frequency: 1 Hz"),
}
"""Header of a column, and line above the table, of what a strain sweep needs beside its strains."""


def describe_fit(
    read: Sequence[DmaData],
    asked: tuple[Request, str | None],
    fitted: tuple[str, PronyFit],
    made: tuple[ReplicaBand | None, MeasuredRows],
) -> dict[str, Any]:
    """Data of a compound file for a fit with its band; `asked` is the request and its strain."""
    (request, _), (band, rows) = asked, made
    reference, fit = fitted
    described = describe_series(read, asked, reference, fit.series, fit.window)
    if band is not None:
        described["prony"]["band"] = _describe_band(band)
    described["fit"] = {
        "storage_rms": _six_digits(round(fit.storage.rms, _ERROR_DECIMALS)),
        "loss_rms": _six_digits(round(fit.loss.rms, _ERROR_DECIMALS)),
        "storage_worst": _six_digits(round(abs(fit.storage.worst), _ERROR_DECIMALS)),
        "loss_worst": _six_digits(round(abs(fit.loss.worst), _ERROR_DECIMALS)),
        "method": _method_text(fit, request, rows),
    }
    described["missing"] = ["strain dependence", "density"]
    return described


def describe_series(
    read: Sequence[DmaData],
    asked: tuple[Request, str | None],
    reference: str,
    series: PronySeries,
    window: Sequence[float],
) -> dict[str, Any]:
    """Data of a compound file for a series at its reference temperature; `asked` is the request and its strain."""
    request, strain = asked
    stated = {key: value for each in reversed(read) for key, value in each.metadata.items()}
    prony: dict[str, Any] = {
        "equilibrium": modulus_text(series.equilibrium),
        "terms": [
            {"modulus": modulus_text(modulus), "time": f"{time:.{SERIES_DIGITS}g} s"}
            for modulus, time in zip(series.moduli, series.times, strict=True)
        ],
    }
    return {
        "name": request.name,
        "kind": "measured",
        "source": {
            "origin": stated.get("origin", _NOT_STATED),
            "licence": stated.get("licence", _NOT_STATED),
            "data": ", ".join(Path(each.source.partition("[")[0]).name for each in read),
        },
        "poisson_ratio": request.poisson_ratio,
        "strain": strain or stated.get("strain", _NOT_STATED),
        "reference_temperature": reference,
        "prony": prony,
        "range": {
            "frequency": [f"{limit:.{SERIES_DIGITS}g} Hz" for limit in window],
            "temperature": [reference] * 2,
        },
    }


def modulus_text(modulus: float, digits: int = SERIES_DIGITS) -> str:
    """Modulus [Pa] written in MPa."""
    return f"{modulus / 1e6:.{digits}g} MPa"


def _six_digits(value: float) -> float:
    return float(f"{value:.6g}")


def _describe_band(band: ReplicaBand) -> dict[str, Any]:
    described: dict[str, Any] = {
        "method": BOOTSTRAP_METHOD,
        "equilibrium": [modulus_text(modulus, _BAND_DIGITS) for modulus in band.equilibrium],
        "unit": "MPa",
        "moduli": [[_six_digits(modulus / 1e6) for modulus in row] for row in band.moduli],
    }
    shifts = {"log10_aT": band.log10_a_T, "log10_bT": band.log10_b_T}
    described |= {
        key: [[_six_digits(y) for y in row] for row in rows] for key, rows in shifts.items() if rows is not None
    }
    return described | ({"shift": [_describe_law(law, _BAND_DIGITS) for law in band.laws]} if band.laws else {})


def _describe_law(law: ShiftLaw, digits: int) -> dict[str, Any]:
    """Data of a formula of a_T."""
    if isinstance(law, WLF):
        return {"law": "wlf", "c1": float(f"{law.c1:.{digits}g}"), "c2": f"{law.c2:.{digits}g} K"}
    if isinstance(law, Arrhenius):
        return {"law": "arrhenius", "activation_energy": f"{law.activation_energy / 1e3:.{digits}g} kJ/mol"}
    raise TypeError(type(law).__name__)


def _method_text(fit: PronyFit, request: Request, rows: MeasuredRows) -> str:
    storage, loss = isotherm_scatter(rows, fit)
    equilibrium = "free" if request.equilibrium is None else "held"
    left = (
        f"leaves {percent(fit.residual, 1)} rms of both, the best positive spectrum of all "
        f"{percent(fit.consistency_floor, 1)}"
    )
    if request.terms_per_decade is not None:
        return (
            f"NNLS on relative errors of E' and E'', {request.terms_per_decade:g} times per decade inside the data "
            f"window, equilibrium {equilibrium}; {left}"
        )
    scatter = (
        ""
        if storage is None or loss is None
        else f"; scatter of the data from row to row {percent(storage, 1)} (E') and {percent(loss, 1)} (E'')"
    )
    return (
        f"NNLS on errors of E' and E'' relative to the fit, {fit.candidates[0].terms_per_decade:g} relaxation times "
        f"per decade to a decade beyond the data window and penalty {fit.regularisation:g} on the curvature of the "
        f"spectrum by AICc, outliers without weight, equilibrium {equilibrium}; {left}{scatter}"
    )


def add_shift(
    described: dict[str, Any],
    superposition: Superposition | None,
    shifts: DmaData | None,
    law: WLF | Arrhenius | None,
) -> None:
    """Add the shift, and the range of temperature that it gives."""
    known = shift_factors(superposition, shifts)
    if known is None:
        described["missing"].append("temperature shift: known at the reference temperature only")
        return
    kelvin, decades, _, vertical = known
    order = np.argsort(kelvin)
    temperatures = [f"{t - ZERO_CELSIUS:.{SERIES_DIGITS}g} degC" for t in kelvin[order]]
    described["range"]["temperature"] = [temperatures[0], temperatures[-1]]
    if law is not None:
        described["shift"] = _describe_law(law, SERIES_DIGITS)
        described["missing"].append("vertical shift (none applied)")
        return
    described["shift"] = {
        "law": "table",
        "temperature": temperatures,
        "log10_aT": [float(f"{y:.{SERIES_DIGITS}g}") for y in decades[order]],
    }
    if vertical is None:
        described["missing"].append("vertical shift (none applied)")
    else:
        described["shift"]["log10_bT"] = [float(f"{y:.{SERIES_DIGITS}g}") for y in vertical[order]]


def describe_strain(reference: str | None, sweeps: DmaData) -> dict[str, Any]:
    """Data of the strain dependence, from runs of four rows and more; shorter ones are stray rows."""
    if reference is None:
        raise InputError(
            f"{sweeps.source}: at which strain was the master curve measured? Give it, e.g. "
            '--reference-strain "0.1 %"; everything is counted from it'
        )
    runs = [run for run in sweeps.strain_sweeps() if run.strain.size >= FEWEST_STRAINS]
    if not runs:
        raise InputError(f"{sweeps.source}: no sweep of {FEWEST_STRAINS} strains and more is in it")
    unknown = [name for name in _STATED_EXAMPLES if any(getattr(run, name) is None for run in runs)]
    if unknown:
        headers, lines = zip(*(_STATED_EXAMPLES[name] for name in unknown), strict=True)
        raise InputError(
            f"{sweeps.source}: {' and '.join(unknown)} of the strain sweep not stated; give every row "
            + " and ".join(f'a column "{header}"' for header in headers)
            + ", or write above the table "
            + " and ".join(f'"{line}"' for line in lines)
        )
    return {
        "reference_strain": reference,
        "reference_note": sweeps.metadata.get("reference_strain", ""),
        "source": Path(sweeps.source).name,
        "sweeps": [
            {
                "temperature": f"{(run.temperature or 0.0) - ZERO_CELSIUS:.6g} degC",
                "frequency": f"{run.frequency:.6g} Hz",
                "strain": [_six_digits(100.0 * strain) for strain in run.strain],
                "unit": "MPa",
                "storage": [_six_digits(modulus / 1e6) for modulus in run.storage],
                "loss": [_six_digits(modulus / 1e6) for modulus in run.loss],
            }
            for run in runs
        ],
    }
