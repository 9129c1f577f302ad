"""The whole calculation.

spec -> strands, loads of their rolls -> line in SI -------+-> contacts of all rolls -> forces along the belt -> loop of
     -> compound at T -> cover -> cover at working strain --+      tensions, once more with design friction -> result
        prepare                                                    solve                   assemble

Many variants are calculated in one batch: their contacts are solved together; shared parts (a line, a rubber at a
temperature, a cover at its working strain) are built once. On curves, and with a yielding belt, the tensions change the
roll loads: both are iterated to convergence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant
from conveyor.default_bands import close_design_loops
from conveyor.errors import InputError, NoSolutionError
from conveyor.forces import forces_along_belt
from conveyor.line.belt_contacts import STRETCH_QUADRATURE, solve_belt_contacts
from conveyor.line.contacts import Contacts, solve_contacts
from conveyor.line.covers import Covers
from conveyor.line.stretches import STRANDS, CurveLoads
from conveyor.loop.balance import Balance, OpenLoop, close_loops
from conveyor.loop.take_up_duty import at_common_setting
from conveyor.loop.tension_coupling import Convergence, loads_on_curves, next_convergence, pull_per_width
from conveyor.models import Conveyor
from conveyor.preparation import Preparation, PreparedLine
from conveyor.reuse import ReuseCache
from conveyor.units.sentences import error_in_units

Array = NDArray[np.float64]
ProgressCallback: TypeAlias = Callable[[int, int], None]
"""Called with the amount done, which never falls, and the total."""


def calculate(conveyor: Conveyor, kept: ReuseCache | None = None) -> CalculatedConveyor:
    """Calculate one conveyor under its own load, designed for the upper end of the band of its friction.

    The take-up is at its given setting, else at the least that serves this load; reports have the least that serves
    every load, from `conveyor.analyse_studies`.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.

    Returns
    -------
    CalculatedConveyor
        Contacts, forces, tensions, power, duties of the parts.

    Raises
    ------
    NoSolutionError
        A contact has no solution, the tensions do not converge, or the belt lifts off with its bulk.
    RangeError
        A compound is not known at the belt's temperature.
    InputError
        The argument is not a Conveyor.
    """
    if not isinstance(conveyor, Conveyor):
        raise InputError(
            f"analyse: takes a Conveyor, got {type(conveyor).__name__}; conveyor.load(path) reads one from a file"
        )
    (result,) = calculate_many([Variant(conveyor)], kept=kept)
    if not isinstance(result, CalculatedConveyor):
        raise result
    return result


def calculate_many(
    variants: Sequence[Variant],
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
    *,
    one_take_up: Callable[[CalculatedConveyor], bool] | None = None,
    known: CalculatedConveyor | None = None,
    kept: ReuseCache | None = None,
    runs: Iterable[Iterable[int]] = (),
) -> list[CalculatedConveyor | NoAnswer]:
    """Calculate many variants, all contacts in one batch.

    Parameters
    ----------
    variants : sequence of Variant
        Conveyors.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of each spec.
    progress : callable, optional
        Called as variants are prepared, and when they are solved; a variant counts half for each.
    one_take_up : callable, optional
        Give all variants one setting of the take-up, the least that serves the variants for which this is true. By
        default the least of each. A setting of the spec is kept.
    known : CalculatedConveyor, optional
        A variant calculated before: its covers at their working strain are reused.
    kept : ReuseCache, optional
        Cache of earlier calls; new parts are added.
    runs : iterable of iterable of int
        Indices of variants that differ in speed alone: their working strain is interpolated among three, where `rtol`
        allows it (`STRAIN_INTERPOLATION_RTOL`).

    Returns
    -------
    list
        Calculations in the order of the variants, or the error of each.

    Raises
    ------
    NoSolutionError
        No setting of the take-up serves all.
    """
    shared = Preparation(ReuseCache() if kept is None else kept, rtol, runs, known)
    shared.solve_test_factors(variants)
    tell = _ProgressReporter(len(variants), progress)
    made: dict[int, CalculatedConveyor] = {}
    refused: dict[int, NoAnswer] = {}
    going = {i: _IterationState() for i in range(len(variants))}
    while going:
        prepared: dict[int, PreparedLine] = {}
        for i, one in shared.prepare({i: (variants[i], step.acting) for i, step in going.items()}):
            if isinstance(one, PreparedLine):
                prepared[i] = one
            else:
                refused[i] = one
            tell(len(variants) - len(going), len(prepared))
        contacts = _solve_contacts(shared, prepared, going, rtol)
        for i, result in _assemble_results(variants, prepared, contacts).items():
            if isinstance(result, CalculatedConveyor):
                made[i] = result
            else:
                refused[i] = result
        for i in refused:
            made.pop(i, None)
        if one_take_up is not None:
            asking = list(map(one_take_up, made.values()))
            at_it = at_common_setting([result.balance for result in made.values()], asking)
            made = {i: replace(made[i], balance=one) for i, one in zip(made, at_it, strict=True)}
        acted = [i for i in going if i in made and made[i].line.has_tension_coupling]
        again: dict[int, _IterationState] = {}
        for i in acted:
            try:
                made[i] = result = replace(made[i], convergence=_tension_convergence(made[i], going[i]))
                again[i] = _IterationState.after(result)
            except NoSolutionError as error:
                refused[i] = error
                del made[i]
        moving = {i for i in again if not _is_settled(made[i])}
        # one that still moves the common setting moves the tensions of all
        going = again if one_take_up is not None and moving else {i: again[i] for i in moving}
        tell(len(variants) - len(going), 0)
    systems = enumerate(one.conveyor.report.units for one in variants)
    return [error_in_units(refused[i], system) if i in refused else made[i] for i, system in systems]


@dataclass(frozen=True, eq=False)
class _IterationState:
    """Iteration state of a variant: loads on curves, pull of the belt, results of the step before."""

    acting: CurveLoads = field(default_factory=CurveLoads)
    pulls: Array | None = None
    covers: Covers = field(default_factory=dict)
    before: Balance | None = None
    convergence: Convergence | None = None

    @classmethod
    def after(cls, result: CalculatedConveyor) -> _IterationState:
        """State for the step after a result."""
        line, steady = result.line, result.balance.equilibrium.steady
        held = pull_per_width(line, steady, STRETCH_QUADRATURE[0]) if line.support == "belt" else None
        covers = result.contacts.covers
        return cls(loads_on_curves(line, steady), held, covers, result.balance, result.convergence)


def _solve_contacts(
    shared: Preparation,
    prepared: Mapping[int, PreparedLine],
    steps: Mapping[int, _IterationState],
    rtol: float | None,
) -> dict[int, Contacts | NoAnswer]:
    """Solve the contacts of prepared lines, their covers at their working strain, in one batch.

    A yielding belt is first calculated on a rigid carcass, as its tensions are unknown.
    """
    softened = shared.soften(prepared, {i: steps[i].covers for i in prepared})
    covers = {i: one for i, one in softened.items() if isinstance(one, Mapping)}
    solved = solve_contacts([prepared[i].line for i in covers], list(covers.values()), rtol, shared.curves)
    refused = {i: one for i, one in softened.items() if not isinstance(one, Mapping)}
    contacts: dict[int, Contacts | NoAnswer] = {**refused, **dict(zip(covers, solved, strict=True))}
    tight = {i: one for i in prepared if (one := steps[i].pulls) is not None}
    held = {i: fast for i in tight if isinstance(fast := contacts[i], Contacts)}
    if held:
        rtols = [prepared[i].line.rtol if rtol is None else rtol for i in held]
        belts = solve_belt_contacts(list(held.values()), [tight[i] for i in held], rtols, shared.tensioned)
        contacts |= dict(zip(held, belts, strict=True))
    return contacts


def _assemble_results(
    variants: Sequence[Variant],
    prepared: Mapping[int, PreparedLine],
    contacts: Mapping[int, Contacts | NoAnswer],
) -> dict[int, CalculatedConveyor | NoAnswer]:
    """Assemble the forces along the belts, and close the loops in one batch."""
    found: dict[int, CalculatedConveyor | NoAnswer] = {}
    open_loops: dict[int, tuple[Contacts, OpenLoop]] = {}
    for i, one in contacts.items():
        try:
            if isinstance(one, Contacts):
                open_loops[i] = one, _open_loop(variants[i], prepared[i], one)
            else:
                found[i] = one
        except InputError as error:
            found[i] = error
    closed = close_loops([loop for _, loop in open_loops.values()])
    for (i, (rolls, _)), made in zip(open_loops.items(), closed, strict=True):
        at = variants[i]
        found[i] = (
            made
            if isinstance(made, NoSolutionError)
            else CalculatedConveyor(at.conveyor, at.covers_at, rolls, made, prepared[i].rubber_free)
        )
    own = {
        i: one
        for i, one in found.items()
        if isinstance(one, CalculatedConveyor)
        and variants[i].design_friction is None
        and one.conveyor.drive.design_friction is None
        and one.line.method == "viscoelastic"
    }
    designed = close_design_loops(list(own.values()), [open_loops[i][1] for i in own])
    return found | dict(zip(own, designed, strict=True))


def _open_loop(variant: Variant, prepared: PreparedLine, contacts: Contacts) -> OpenLoop:
    """Loop with the forces along the belt, to be closed."""
    factors = np.repeat([variant.indentation_factors.get(strand, 1.0) for strand in STRANDS], prepared.line.count)
    along = forces_along_belt(
        prepared.line,
        prepared.rubber_free,
        factors * contacts.indentation,
        roll_drag=variant.roll_drag,
        calibration=variant.conveyor.calculation.calibration,
    )
    layout = prepared.layout
    if variant.design_friction is not None and variant.conveyor.drive.design_friction is None:
        layout = layout.designed_for(variant.design_friction)
    return OpenLoop.of(layout, along, float(prepared.rubber_free.unit_main.sum()), variant.take_up)


def _tension_convergence(result: CalculatedConveyor, step: _IterationState) -> Convergence | None:
    """Convergence of coupled tensions against the step before; None in the first step."""
    if step.before is None:
        return None
    before, now = step.before.equilibrium.steady, result.balance.equilibrium.steady
    return next_convergence(step.convergence, before, now, result.line, result.balance.tensions.largest)


def _is_settled(result: CalculatedConveyor) -> bool:
    """True if tensions and roll loads have converged."""
    return result.convergence is not None and result.convergence.has_converged(result.line.rtol)


class _ProgressReporter:
    """Reports the progress of a batch; repeated steps never lower it."""

    def __init__(self, variants: int, progress: ProgressCallback | None) -> None:
        self._whole, self._most, self._progress = 2 * variants, 0, progress

    def __call__(self, solved: int, loaded: int) -> None:
        self._most = max(self._most, 2 * solved + loaded)
        if self._progress is not None:
            self._progress(self._most, self._whole)
