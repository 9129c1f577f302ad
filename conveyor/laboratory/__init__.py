"""Laboratory files of every shape to one frozen table in SI; what is doubtful is asked for."""

from conveyor.laboratory.read import KINDS, read_dma
from conveyor.laboratory.table import DmaData, IsothermRows, StrainRows

__all__ = ["KINDS", "DmaData", "IsothermRows", "StrainRows", "read_dma"]
