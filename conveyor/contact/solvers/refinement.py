"""The loop that raises the order of a contact until its friction is known to a tolerance.

A contact of one strip or of several is balanced at an order, its error by order is compared with the tolerance, and
where that is met the load is closed and the energy checked. Whatever ends the loop, the best contact found is returned
with its own estimate.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple, Protocol

from conveyor.contact.galerkin.spectral import Contact
from conveyor.contact.problem import Status
from conveyor.contact.solution import ContactResult, SolveOutcome
from conveyor.contact.solvers.acceptance import PressureSign, interior_dip, worst_sign
from conveyor.contact.solvers.solver_state import SolverState

ROUNDING = 1e-14
SIGN_ORDER = 256  # splits show below it; a dip that lasts is an edge layer that friction does not feel
_SETTLED_CHANGE = 1e-3  # change of friction below which tension is no longer the order's ripple
_EDGE_LAYER_REMARK = "a layer at the contact's edge is thinner than the order resolves: pressure ripples there"
_LIFT_REMARK = (
    "inside a strip the pressure falls below zero by {:.1e} of its largest: the layer lifts off there, over about "
    "{:.1e} R, and the strips on both sides of it were not resolved"
)


@dataclass(frozen=True)
class EnergyCheck:
    """Relative difference of friction by geometry and by loss, and friction's error, that of the order included [-]."""

    energy: float
    error: float


class OrderLadder(Protocol):
    """Orders of one contact: it is balanced at its load, its energy checked, its order raised."""

    @property
    def scene(self) -> SolverState:
        """Problem under solution."""

    @property
    def order(self) -> int:
        """Present order."""

    @property
    def contact(self) -> Contact:
        """Contact last balanced: strips, one an entry, with the coefficients of every order."""

    def balance(self, *, closed: bool = False) -> float | None:
        """Relative error of friction due to the present order; None where that has no contact.

        `closed` where the load is met to the tolerance, too.
        """

    def may_split(self) -> bool:
        """True while tension tells that the contact splits."""

    def is_last(self) -> bool:
        """True where no higher order would help."""

    def check_energy(self) -> EnergyCheck:
        """Energy of the closed contact."""

    def advance(self, checked: EnergyCheck | None) -> bool:
        """Go on to the next order; False where none would help."""

    def result(self, checked: EnergyCheck) -> ContactResult | None:
        """Result of the closed contact; None where the layer touches the roll outside its strips."""


class RefinementEnd(Enum):
    """Reason why the order was raised no further."""

    MET = "the tolerance is met"
    EXHAUSTED = "no higher order helps"
    SPLITS = "the contact has other strips"
    LOST = "an order has no contact that carries the load"


class Refined(NamedTuple):
    """Reason of the end, and the best contact found; None where no order had one."""

    end: RefinementEnd
    best: SolveOutcome | None


def refine_contact(ladder: OrderLadder, rtol: float) -> Refined:
    """Raise the order until friction is known to `rtol`."""
    best: SolveOutcome | None = None
    balanced = False
    while (error := ladder.balance()) is not None:
        checked, balanced = None, True
        splits = False
        if error <= _SETTLED_CHANGE and ladder.may_split():
            sign, tension = worst_sign(ladder.contact, rtol)
            splits = sign is PressureSign.PULLING
            if splits and tension > rtol:
                return Refined(RefinementEnd.SPLITS, None)
        if splits or error <= rtol or ladder.is_last():
            if ladder.balance(closed=True) is None:
                break  # what was balanced before is told with its load's miss
            checked = ladder.check_energy()
            outcome, sign = _closed_outcome(ladder, checked, rtol)
            if outcome is None or splits or sign is PressureSign.PULLING:
                return Refined(RefinementEnd.SPLITS, outcome)
            best = better_outcome(best, outcome)
            if outcome.status is Status.OK and (sign is PressureSign.PRESSING or ladder.order >= SIGN_ORDER):
                return Refined(RefinementEnd.MET, outcome)
        if not ladder.advance(checked):
            return Refined(RefinementEnd.EXHAUSTED, best)
    if balanced and best is None:
        best, _ = _closed_outcome(ladder, ladder.check_energy(), rtol)
    return Refined(RefinementEnd.LOST, best)


def better_outcome(one: SolveOutcome | None, other: SolveOutcome) -> SolveOutcome:
    """The outcome that met its tolerance, else the one of the smaller estimate."""
    if one is None or (one.found is None and other.found is not None) or other.status is not Status.NOT_CONVERGED:
        return other
    if other.found is None or one.found is None or one.found.error_estimate <= other.found.error_estimate:
        return one
    return other


def _closed_outcome(ladder: OrderLadder, checked: EnergyCheck, rtol: float) -> tuple[SolveOutcome | None, PressureSign]:
    """Outcome of a closed contact; its friction may be off by the share of the load that tension carries."""
    contact = ladder.contact
    sign, tension = worst_sign(contact, rtol)
    estimate = max(checked.error, tension, ROUNDING)
    result = ladder.result(EnergyCheck(checked.energy, estimate))
    if result is None:
        return None, sign
    remarks: tuple[str, ...] = ()
    if sign is PressureSign.UNDECIDED:
        remarks = (_EDGE_LAYER_REMARK,)
    elif sign is PressureSign.PULLING:
        depth, width = interior_dip(contact)
        remarks = (_LIFT_REMARK.format(depth, width / ladder.scene.problem.rho),)
        result = replace(result, edge_error=result.edge_error + width)
    status = Status.OK if estimate <= rtol else Status.NOT_CONVERGED
    return SolveOutcome(status, result, int(contact.c.shape[1]), remarks=remarks), sign
