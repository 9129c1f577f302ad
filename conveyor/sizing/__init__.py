"""Sizing: ranked designs of a conveyor from its duty alone."""

from conveyor.sizing.designs import CalculatedSizing, Design, size

__all__ = ["CalculatedSizing", "Design", "size"]
