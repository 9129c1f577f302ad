"""Load control: the half width whose contact carries a given load."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.contact.galerkin.spectral import Contact, solve_equilibrium
from conveyor.contact.solvers.solver_state import OrderResult, SolverState

Array = NDArray[np.float64]

_LOAD_STEPS = 60
_ACCEPTED_MISMATCH = 1e-9  # a load that stalls below it is kept and its miss reported in error_estimate
_WIDEST = 1.0 - 1e-9
_BRACKET_CLOSED = 1e-4  # of ln α between too light and off the roll: the general solver takes what lies between
_GUESSES = 48
_DISTINCT_WIDTHS = 1e-9  # half widths closer than this carry no slope


@dataclass
class LoadSearch:
    """Root of ln p̃_m(ln α) = ln p̃_m: secant steps between the widest contact too light and the narrowest too heavy."""

    target: float
    log_alpha: float
    slope: float
    low: float = -math.inf
    high: float = math.inf
    last: tuple[float, float, float] | None = None
    eps: Array | None = None
    exponent: Array | None = None

    def accept(self, contact: Contact, log_pressure: float) -> float:
        """Take the load at the present half width and move to the next one; returns the mismatch ln p - target.

        Updates d ln p/d ln α (the next step) and d ln μ/d ln p (`exponent`, for the error at fixed load).
        With a prescribed depth Δ stands for p.
        """
        friction = float(contact.friction[0])
        miss = log_pressure - self.target
        if self.last is not None and abs(self.log_alpha - self.last[0]) > _DISTINCT_WIDTHS:
            rise = log_pressure - self.last[1]
            slope = rise / (self.log_alpha - self.last[0])
            if slope > 0.1:
                self.slope = slope
                if friction * self.last[2] > 0.0:
                    self.exponent = np.array([math.log(friction / self.last[2]) / rise])
        self.last = (self.log_alpha, log_pressure, friction)
        self.eps = contact.eps
        if miss < 0.0:
            self.low = max(self.low, self.log_alpha)
        elif miss > 0.0:
            self.high = min(self.high, self.log_alpha)
        step = self.log_alpha - max(-1.5, min(1.5, miss / self.slope))
        if not self.low < step < self.high and math.isfinite(self.low + self.high):
            step = 0.5 * (self.low + self.high)
        self.log_alpha = step
        return miss

    def reset_bracket(self) -> None:
        """Reset the bracket: at another order the load of a half width differs slightly."""
        self.low, self.high, self.last = -math.inf, math.inf, None

    def reject(self) -> None:
        """Step back to a narrower contact: the present half width has none on the roll."""
        self.high = min(self.high, self.log_alpha)
        self.log_alpha = 0.5 * (self.low + self.high) if math.isfinite(self.low) else self.high - 0.7


def contact_at_load(
    scene: SolverState, search: LoadSearch, n: int, tolerance: float, last: int = 0
) -> OrderResult | None:
    """Contact of order n that carries the load; None where it wraps the roll before it does.

    With `last` above n the orders up to there are in its equations too.
    """
    rho = scene.problem.rho
    best: OrderResult | None = None
    for _ in range(_LOAD_STEPS):
        alpha = math.exp(search.log_alpha)
        if alpha >= rho * _WIDEST:
            search.reject()
            continue
        system = scene.system(alpha, n, max(n, last))
        contact = solve_equilibrium(system.matrix, np.array([alpha]), rho, search.eps)
        if not contact.inside[0] or contact.pressure[0] <= 0.0:
            search.reject()
            if search.high - search.low < _BRACKET_CLOSED:
                break
            continue
        miss = abs(search.accept(contact, scene.measure(system, contact)))
        if best is None or miss < best.miss:
            best = OrderResult(contact, system, miss)
        if miss <= tolerance:
            return best
    return best if best is not None and best.miss <= _ACCEPTED_MISMATCH else None


def guess_half_width(scene: SolverState) -> tuple[float, float]:
    """First ln α and d ln p̃_m/d ln α: Hertz, p̃_m = α²/(4ρ² C), with the compliance C = |S| at m = 1/α.

    A depth is that load times the displacement under a pressure spread over the contact, 2 Σ_{m<1/α} |S_m|/m.
    """
    problem, creep, rho = scene.problem, scene.creep, scene.problem.rho
    held = problem.pressure if scene.depth is None else scene.depth
    narrow = rho * math.sqrt(held * creep.instantaneous) * (1.0 if scene.depth is None else 0.1)
    widest = 0.8 * rho
    if narrow >= widest:
        return math.log(widest), 2.0
    alpha = np.geomspace(narrow, widest, _GUESSES)
    compliance = np.abs(problem.layer.symbol(np.maximum(1.0 / alpha, 1.0), creep))
    log_alpha = np.log(alpha)
    log_held = 2.0 * np.log(alpha / (2.0 * rho)) - np.log(compliance)
    if scene.depth is not None:
        m = np.geomspace(1.0, 1.0 / narrow, _GUESSES)
        spread = np.abs(problem.layer.symbol(m, creep))
        below = np.concatenate([[0.0], np.cumsum(0.5 * (spread[1:] + spread[:-1]) * np.diff(np.log(m)))])
        log_held += np.log(2.0 * (spread[0] + np.interp(1.0 / alpha, m, below)))
    at = float(np.interp(scene.target, np.maximum.accumulate(log_held), log_alpha))
    return at, 2.0
