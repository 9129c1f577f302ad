"""Sizing: ranked designs of a conveyor from its duty."""

from conveyor.sizing.designs import CalculatedSizing, size
from conveyor.sizing.sized import SizedDesign

__all__ = ["CalculatedSizing", "SizedDesign", "size"]
