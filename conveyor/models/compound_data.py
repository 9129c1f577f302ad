"""Series, shift law and strain sweeps of rubber, written as the fields of a compound."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from conveyor.errors import InputError
from conveyor.units import Quantity, from_si, quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from conveyor.rubber import WLF, AmplitudeFactors, Arrhenius, PronySeries, ShiftTable


def temperature_quantity(given: float | str | Quantity) -> Quantity:
    """Temperature as a quantity; a plain number is in kelvin."""
    return from_si(given, "temperature", "K") if isinstance(given, int | float) else quantity(given, "temperature")


def prony_data(series: PronySeries) -> dict[str, Any]:
    """Compound-file data of a series."""
    return {
        "equilibrium": from_si(series.equilibrium, "pressure", "Pa"),
        "terms": [
            {"modulus": from_si(modulus, "pressure", "Pa"), "time": from_si(time, "time", "s")}
            for modulus, time in zip(series.moduli.tolist(), series.times.tolist(), strict=True)
        ],
    }


def shift_data(
    law: WLF | Arrhenius | ShiftTable | None, log10_b_T: Sequence[float] | NDArray[np.float64] | None
) -> dict[str, Any] | None:
    """Compound-file data of a shift law."""
    from conveyor.rubber import WLF, ShiftTable

    if isinstance(law, ShiftTable):
        vertical = None if log10_b_T is None else list(map(float, log10_b_T))
        return {
            "law": "table",
            "temperature": list(map(temperature_quantity, law.temperatures.tolist())),
            "log10_aT": law.log10_factors.tolist(),
            "log10_bT": vertical,
        }
    if log10_b_T is not None:
        raise InputError("log10_b_T: belongs to the temperatures of a ShiftTable; give one as shift, or leave it out")
    if law is None:
        return None
    if isinstance(law, WLF):
        return {"law": "wlf", "c1": law.c1, "c2": quantity(f"{float(law.c2)!r} K", "temperature difference")}
    energy = from_si(law.activation_energy, "molar energy", "J/mol")
    return {"law": "arrhenius", "activation_energy": energy}


def strain_data(factors: AmplitudeFactors) -> dict[str, Any]:
    """Compound-file data of strain factors."""
    return {
        "reference_strain": from_si(factors.reference_strain, "fraction"),
        "sweeps": [
            {
                "temperature": temperature_quantity(sweep.temperature),
                "frequency": from_si(sweep.frequency, "frequency", "Hz"),
                "strain": (100.0 * sweep.strain).tolist(),
                "unit": "Pa",
                "storage": sweep.storage.tolist(),
                "loss": sweep.loss.tolist(),
            }
            for sweep in factors.sweeps
        ],
    }
