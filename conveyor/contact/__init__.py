"""Steady viscoelastic rolling contact of a layer on periodic rigid cylinders, dimensionless."""

from conveyor.contact.layers import Confined, Free, HalfSpace, Layer
from conveyor.contact.problem import ContactProblem, CreepSpectrum, Status
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solve import solve

__all__ = [
    "Confined",
    "ContactProblem",
    "ContactSolution",
    "CreepSpectrum",
    "Free",
    "HalfSpace",
    "Layer",
    "SolveStats",
    "Status",
    "solve",
]
