"""A problem while it is being solved, and a contact on the way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.problem import ContactProblem, CreepSpectrum
from conveyor.contact.quadrature import Rule, build_rule
from conveyor.contact.spectral import Contact, assemble

Array = NDArray[np.float64]


@dataclass
class Scene:
    """A problem while it is solved: creep as the solver sees it, quadrature rules made once, counters."""

    problem: ContactProblem
    creep: CreepSpectrum
    rules: dict[str, Rule] = field(default_factory=dict)
    matrices: int = 0

    @classmethod
    def of(cls, problem: ContactProblem) -> Scene:
        """Scene of a problem; terms with ζ = 0 are instantaneous."""
        given = problem.creep
        lasting = given.times > 0.0
        relaxed = given.instantaneous + float(given.weights[~lasting].sum())
        if lasting.all():
            return cls(problem, given)
        return cls(problem, CreepSpectrum(relaxed, given.weights[lasting], given.times[lasting]))

    def rule(self, alpha: float) -> Rule:
        """Quadrature rule good for half width `alpha`; remade with room when a contact outgrows it."""
        rule = self.rules.get("solve")
        if rule is None or alpha > rule.half_width:
            widest = min(1.3 * alpha, 0.5 * (alpha + self.problem.rho))
            rule = self.rules["solve"] = build_rule(self.problem.layer, self.creep, widest)
        return rule

    def matrix(self, alpha: float, n: int) -> Array:
        """Galerkin matrix of one contact, shape (1, n+1, n)."""
        self.matrices += 1
        return assemble(self.rule(alpha), self.creep, np.array([alpha]), n)


@dataclass(frozen=True, eq=False)
class State:
    """A contact at one order, its matrix, and how far its load is off (relative)."""

    contact: Contact
    matrix: Array
    miss: float

    @property
    def order(self) -> int:
        """Galerkin order n."""
        return int(self.matrix.shape[2])
