"""Rubber: linear viscoelastic solids in SI floats. Series, temperature shift, fits, master curves."""

from __future__ import annotations

from conveyor.rubber.dma import MasterCurve, read_master_curve
from conveyor.rubber.fit import Misfit, PronyFit, fit_prony
from conveyor.rubber.prony import CreepSeries, PronySeries
from conveyor.rubber.shift import WLF, Arrhenius, ShiftLaw, ShiftTable, entropic_b_T, shifted
from conveyor.rubber.shift_fit import ShiftFit, fit_arrhenius, fit_wlf

__all__ = [
    "WLF",
    "Arrhenius",
    "CreepSeries",
    "MasterCurve",
    "Misfit",
    "PronyFit",
    "PronySeries",
    "ShiftFit",
    "ShiftLaw",
    "ShiftTable",
    "entropic_b_T",
    "fit_arrhenius",
    "fit_prony",
    "fit_wlf",
    "read_master_curve",
    "shifted",
]
