"""A problem while it is being solved, and a contact on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.creep import CreepSpectrum
from conveyor.contact.layers import Confined, Free, HalfSpace
from conveyor.contact.problem import ContactProblem
from conveyor.contact.quadrature import Rule, build_rule
from conveyor.contact.spectral import Contact, assemble, penetration

Array = NDArray[np.float64]


def instantly_relaxed(creep: CreepSpectrum) -> CreepSpectrum:
    """The same creep with the terms of ζ = 0 in the instantaneous compliance."""
    lasting = creep.times > 0.0
    if lasting.all():
        return creep
    relaxed = creep.instantaneous + float(creep.weights[~lasting].sum())
    return CreepSpectrum(relaxed, creep.weights[lasting], creep.times[lasting])


@dataclass
class Scene:
    """A problem while it is solved: creep as the solver sees it, quadrature rules made once, counters.

    `depth` is the Δ/R held in place of the problem's load.
    """

    problem: ContactProblem
    creep: CreepSpectrum
    depth: float | None = None
    rules: dict[str, Rule] = field(default_factory=dict)
    matrices: int = 0

    @classmethod
    def of(cls, problem: ContactProblem, depth: float | None = None) -> Scene:
        """Scene of a problem; terms with ζ = 0 are instantaneous."""
        return cls(problem, instantly_relaxed(problem.creep), depth)

    @property
    def lossy(self) -> bool:
        """Whether anything may lose energy: an elastic scene has no friction but rounding."""
        return bool(self.creep.weights.size) or not isinstance(
            self.problem.layer, (HalfSpace, Free, Confined)
        )

    @property
    def target(self) -> float:
        """Ln of what is held: the load p̃_m, or the depth Δ/R."""
        return math.log(self.problem.pressure if self.depth is None else self.depth)

    def measure(self, contact: Contact) -> float:
        """Ln of the same of a contact."""
        if self.depth is None:
            return math.log(contact.pressure[0])
        rule = self.rule(float(contact.alpha[0]))
        return math.log(penetration(rule, self.creep, contact, self.problem.rho)[0])

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
