"""Rubber: linear viscoelastic solids in SI floats. Series, temperature shift, fits, master curves."""

from __future__ import annotations

from conveyor.rubber.band import ReplicaBand, bootstrap
from conveyor.rubber.equivalent import (
    EquivalentLinear,
    StrainTask,
    at_strains,
    equivalent_linear,
    equivalent_linear_many,
    softened,
)
from conveyor.rubber.fit import PronyFit, fit_prony
from conveyor.rubber.interconversion import equivalent_sweep
from conveyor.rubber.kramers_kronig import KramersKronig, kramers_kronig, testable
from conveyor.rubber.kraus import KrausFit, KrausLaw, fit_kraus
from conveyor.rubber.misfit import Misfit
from conveyor.rubber.prony import CreepSeries, PronySeries, creeps
from conveyor.rubber.shift import WLF, Arrhenius, ShiftLaw, ShiftTable, entropic_b_T, shifted
from conveyor.rubber.shift_fit import ShiftFit, fit_arrhenius, fit_wlf
from conveyor.rubber.shift_laws import ShiftComparison, compare_shift_laws
from conveyor.rubber.strain import AmplitudeFactors, StrainSweep
from conveyor.rubber.superposition import Isotherm, Superposition, superpose
from conveyor.rubber.term_count import Candidate

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
    "at_strains",
    "bootstrap",
    "compare_shift_laws",
    "creeps",
    "entropic_b_T",
    "equivalent_linear",
    "equivalent_linear_many",
    "equivalent_sweep",
    "fit_arrhenius",
    "fit_kraus",
    "fit_prony",
    "fit_wlf",
    "kramers_kronig",
    "shifted",
    "softened",
    "superpose",
    "testable",
]
