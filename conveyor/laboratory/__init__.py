"""Read laboratory files of any layout into one frozen table in SI; doubtful ones are refused with a question."""

from conveyor.laboratory.dma_data import DmaData, IsothermRows, StrainRows
from conveyor.laboratory.dma_file import KINDS, read_dma

__all__ = ["KINDS", "DmaData", "IsothermRows", "StrainRows", "read_dma"]
