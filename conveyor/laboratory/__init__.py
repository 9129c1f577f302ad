"""Read laboratory files of any layout into one frozen table in SI; doubtful ones are refused with a question."""

from conveyor.laboratory.read import KINDS, read_dma
from conveyor.laboratory.table import DmaData, IsothermRows, StrainRows

__all__ = ["KINDS", "DmaData", "IsothermRows", "StrainRows", "read_dma"]
