"""Steady viscoelastic rolling contact of a layer on periodic rigid cylinders, dimensionless.

A frozen `ContactProblem` goes into `solve`, a frozen `ContactSolution` with its errors comes out; `solve_loads` and
`load_curve` share one set-up among many loads. Numbers only: no units, no rubber.
"""

from conveyor.contact.fields.interior import Interior, InteriorFields, interior, interior_fields
from conveyor.contact.fields.working_strain import working_strains
from conveyor.contact.layers.belt_layer import BeltSupport as Belt
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Confined, Free, HalfSpace, Layer
from conveyor.contact.load_curves.curve_batch import load_curve, load_curves, solve_loads
from conveyor.contact.load_curves.load_curve import LoadCurve, LoadSolutions, frictions
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.solution import ContactSolution, SolveStats
from conveyor.contact.solvers.entry import solve, solve_many, solve_penetration

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
