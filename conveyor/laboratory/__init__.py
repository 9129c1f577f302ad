"""Laboratory files of every shape to one frozen table in SI; what is doubtful is asked for."""

from __future__ import annotations

from conveyor.laboratory.read import read_dma
from conveyor.laboratory.table import KINDS, DmaData, IsothermRows, StrainRows

__all__ = ["KINDS", "DmaData", "IsothermRows", "StrainRows", "read_dma"]
