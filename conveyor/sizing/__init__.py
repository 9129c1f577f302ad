"""Sizing: ranked designs of a conveyor from its duty alone."""

from conveyor.sizing.designs import CalculatedSizing, SizedDesign, size

__all__ = ["CalculatedSizing", "SizedDesign", "size"]
