"""Steady viscoelastic rolling contact of a layer on periodic rigid cylinders, dimensionless.

A frozen `ContactProblem` goes into `solve`, a frozen `ContactSolution` with its errors comes out; `solve_loads` and
`load_curve` share one set-up among many loads. Numbers only: no units, no rubber.
"""

from conveyor.contact.belt_layer import BeltSupport as Belt
from conveyor.contact.creep import CreepSpectrum
from conveyor.contact.curve import LoadCurve, LoadSolutions, frictions
from conveyor.contact.curve_batch import load_curve, load_curves, solve_loads
from conveyor.contact.interior import Interior, InteriorFields, interior, interior_fields
from conveyor.contact.layers import Confined, Free, HalfSpace, Layer
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solve import solve, solve_many, solve_penetration
from conveyor.contact.working_strain import working_strains

__all__ = [
    "Belt",
    "Confined",
    "ContactProblem",
    "ContactSolution",
    "CreepSpectrum",
    "Free",
    "HalfSpace",
    "Interior",
    "InteriorFields",
    "Layer",
    "LoadCurve",
    "LoadSolutions",
    "SolveStats",
    "Status",
    "frictions",
    "interior",
    "interior_fields",
    "load_curve",
    "load_curves",
    "solve",
    "solve_loads",
    "solve_many",
    "solve_penetration",
    "working_strains",
]
