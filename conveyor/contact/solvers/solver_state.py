"""State of a solve: the problem with its quadrature, its equations, a contact at one order."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.galerkin.bessel import ProductIK
from conveyor.contact.galerkin.order_tail import OrderTail
from conveyor.contact.galerkin.quadrature import Rule, build_rule
from conveyor.contact.galerkin.spectral import Contact, assemble_matrix, crown_depth, nested_matrices
from conveyor.contact.layers.creep import CreepSpectrum
from conveyor.contact.layers.layer_models import Confined, Free, HalfSpace
from conveyor.contact.problem import ContactProblem

Array = NDArray[np.float64]


def merge_instant_terms(creep: CreepSpectrum) -> CreepSpectrum:
    """Merge the terms of ζ = 0 into the instantaneous compliance."""
    lasting = creep.times > 0.0
    if lasting.all():
        return creep
    relaxed = creep.instantaneous + float(creep.weights[~lasting].sum())
    return CreepSpectrum(relaxed, creep.weights[lasting], creep.times[lasting])


@dataclass
class SolverState:
    """Problem under solution: creep without terms of ζ = 0, the quadrature rule built last, counters.

    `depth` is the Δ/R prescribed in place of the problem's load.
    """

    problem: ContactProblem
    creep: CreepSpectrum
    depth: float | None = None
    built: Rule | None = None
    matrices: int = 0

    @classmethod
    def of(cls, problem: ContactProblem, depth: float | None = None) -> SolverState:
        """State of a problem; terms with ζ = 0 are instantaneous."""
        return cls(problem, merge_instant_terms(problem.creep), depth)

    @property
    def lossy(self) -> bool:
        """True where rubber or layer may lose energy; else friction is zero but for rounding."""
        return bool(self.creep.weights.size) or not isinstance(self.problem.layer, (HalfSpace, Free, Confined))

    @property
    def target(self) -> float:
        """Ln of the prescribed load p̃_m, or depth Δ/R."""
        return math.log(self.problem.pressure if self.depth is None else self.depth)

    def measure(self, system: ContactEquations, contact: Contact) -> float:
        """Ln of a contact's load, or of its depth."""
        return math.log(contact.pressure[0] if self.depth is None else self.depth_of(system, contact))

    def depth_of(self, system: ContactEquations, contact: Contact) -> float:
        """Δ/R of a contact."""
        return system.depth(self.rule(float(contact.alpha[0])), self.creep, contact, self.problem.rho)

    def rule(self, alpha: float) -> Rule:
        """Quadrature rule valid for half width `alpha`; rebuilt with room when a contact outgrows it."""
        if self.built is None or alpha > self.built.half_width:
            widest = min(1.3 * alpha, 0.5 * (alpha + self.problem.rho))
            self.built = build_rule(self.problem.layer, self.creep, widest)
        return self.built

    def system(self, alpha: float, n: int, last: int) -> ContactEquations:
        """Galerkin equations of one contact of order n, with the orders from n up to `last` eliminated."""
        self.matrices += 1
        place = np.array([alpha])
        if last == n:
            matrix = assemble_matrix(self.rule(alpha), self.creep, place, n)
            return ContactEquations(matrix, [nested_matrices(matrix)])
        ik = ProductIK(n, place[:, None] / self.creep.times)
        matrix = assemble_matrix(self.rule(alpha), self.creep, place, n, ik)
        tail = OrderTail.of(alpha, self.creep, n, last)
        return ContactEquations(*tail.closed(matrix, ik), tail, ik)


@dataclass(frozen=True, eq=False)
class ContactEquations:
    """Equations of one contact, shape (1, n+1, n), and pairs of lower orders, half and three quarters."""

    matrix: Array
    lower: list[tuple[Array, Array]]
    tail: OrderTail | None = None
    ik: ProductIK | None = None

    def depth(self, rule: Rule, creep: CreepSpectrum, contact: Contact, rho: float) -> float:
        """Δ/R of a contact of these equations."""
        beyond = self.tail.level(self.ik, contact.c[0]) if self.tail and self.ik else 0.0
        return float(crown_depth(rule, creep, contact, rho)[0]) + beyond

    def whole(self, contact: Contact) -> Contact:
        """Contact with the coefficients of every order, the tail included."""
        if self.tail is None or self.ik is None:
            return contact
        return replace(contact, c=self.tail.coefficients(self.ik, contact.c[0])[None])

    def loss_beyond_core(self, whole: Contact) -> float:
        """Part of Σ Im S_m |p̃̂_m|² in the orders beyond the core."""
        if self.tail is None or self.ik is None:
            return 0.0
        return 0.25 * self.tail.quadratic(self.ik, whole.c[0])


@dataclass(frozen=True, eq=False)
class OrderResult:
    """Contact at one order, its equations, and the relative error of its load."""

    contact: Contact
    system: ContactEquations
    miss: float
