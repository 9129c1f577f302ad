"""Sizing: ranked designs of a conveyor from its duty."""

from conveyor.sizing.design_search import CalculatedSizing, size_conveyor
from conveyor.sizing.sized_design import SizedDesign

__all__ = ["CalculatedSizing", "SizedDesign", "size_conveyor"]
