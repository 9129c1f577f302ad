"""Rubber: linear viscoelastic solids in SI floats. Series, temperature shift, fits, master curves."""

from __future__ import annotations

from conveyor.rubber.band import ReplicaBand, bootstrap
from conveyor.rubber.equivalent_series import (
    EquivalentLinear,
    StrainTask,
    equivalent_linear,
    equivalent_linear_many,
    series_at_strains,
    soften_series,
)
from conveyor.rubber.fit import PronyFit, fit_prony
from conveyor.rubber.interconversion import equivalent_sweep
from conveyor.rubber.kramers_kronig import KramersKronig, kramers_kronig, kramers_kronig_applicable
from conveyor.rubber.kraus import KrausFit, KrausLaw, fit_kraus
from conveyor.rubber.master_curve import Isotherm, Superposition
from conveyor.rubber.misfit import Misfit
from conveyor.rubber.prony import CreepSeries, PronySeries, creep_forms
from conveyor.rubber.shift import WLF, Arrhenius, ShiftLaw, ShiftTable, entropic_b_T, shift_series
from conveyor.rubber.shift_fit import ShiftFit, fit_arrhenius, fit_wlf
from conveyor.rubber.shift_laws import ShiftComparison, compare_shift_laws
from conveyor.rubber.strain import AmplitudeFactors, StrainSweep
from conveyor.rubber.term_count import Candidate
from conveyor.rubber.time_temperature import superpose

__all__ = [
    "WLF",
    "AmplitudeFactors",
    "Arrhenius",
    "Candidate",
    "CreepSeries",
    "EquivalentLinear",
    "Isotherm",
    "KramersKronig",
    "KrausFit",
    "KrausLaw",
    "Misfit",
    "PronyFit",
    "PronySeries",
    "ReplicaBand",
    "ShiftComparison",
    "ShiftFit",
    "ShiftLaw",
    "ShiftTable",
    "StrainSweep",
    "StrainTask",
    "Superposition",
    "bootstrap",
    "compare_shift_laws",
    "creep_forms",
    "entropic_b_T",
    "equivalent_linear",
    "equivalent_linear_many",
    "equivalent_sweep",
    "fit_arrhenius",
    "fit_kraus",
    "fit_prony",
    "fit_wlf",
    "kramers_kronig",
    "kramers_kronig_applicable",
    "series_at_strains",
    "shift_series",
    "soften_series",
    "superpose",
]
