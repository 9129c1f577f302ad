"""Factors on the main resistances from measured power, as many as the runs resolve, with bands.

Every run is the conveyor of the spec at its flow, speed and temperature; all contacts are solved in one batch, once.
The forces are then scaled and the loop of tensions is closed again (Gauss-Newton: the power is nearly linear in the
factors), weighted least squares. Factors that the runs do not resolve are joined: the grouping with the most factors
whose bands are expected to be narrow enough is taken. Derived; least squares and bands as in every textbook (Seber and
Lee, Linear Regression Analysis, 2003, chapters 3 and 5).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError, MessageQuantity, NoSolutionError
from conveyor.models import CALIBRATED_FORCES, Calibration, Conveyor, MeasuredRun
from conveyor.models.variants import require_rolling_contact
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.studies.factor_fit import (
    MOST_ITERATIONS,
    Array,
    FittedFactor,
    Grouping,
    SolvedRuns,
    force_names,
    free_factors,
    select_grouping,
)


@dataclass(frozen=True)
class CalibratedRun:
    """A run: power measured, computed without and with the factors, and the standard error of its weight [W]."""

    run: MeasuredRun
    measured: float
    before: float
    after: float
    error: float

    @property
    def difference(self) -> float:
        """Calculated less measured over measured [-]."""
        return self.after / self.measured - 1.0

    @property
    def difference_before(self) -> float:
        """As `difference`, without factors [-]."""
        return self.before / self.measured - 1.0


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedCalibration:
    """Factors from measured power.

    Attributes
    ----------
    conveyor : Conveyor
        With the factors as its `calculation.calibration`.
    factors : tuple of FittedFactor
        Those that the runs resolve, with bands.
    held : tuple of str
        Forces whose factor stays 1.
    correlation : ndarray, shape (n, n)
        Of the factors.
    runs : tuple of CalibratedRun
        In the order given.
    chi_square : float
        Sum of squared differences over errors; the degrees of freedom where errors are estimated.
    freedom : int
        Runs less factors.
    error : float or None
        Relative standard deviation of a power: given, or from the residuals; None where the runs state their own.
    estimated : bool
        True if it is from the residuals.
    notes : tuple of str
        Factors that are not resolved, and other remarks.
    """

    conveyor: Conveyor
    factors: tuple[FittedFactor, ...]
    held: tuple[str, ...]
    correlation: Array
    runs: tuple[CalibratedRun, ...]
    chi_square: float
    freedom: int
    error: float | None
    estimated: bool
    notes: tuple[str, ...]

    @property
    def calibration(self) -> Calibration:
        """The factors as a field of the spec."""
        given = self.conveyor.calculation.calibration
        return Calibration() if given is None else given

    @property
    def fragment(self) -> str:
        """YAML of the calibration, to paste into a spec."""
        lines = [f"    {name}: {value:g}" for name, value in self.calibration.factors.items()]
        return "\n".join(["calculation:", "  calibration:", *lines, f'    source: "{self.calibration.source}"', ""])

    def __repr__(self) -> str:
        told = ", ".join(f"{f.name} {f.value:.3f} ({f.low:.3f} to {f.high:.3f})" for f in self.factors)
        return f'CalibrationStudy("{self.conveyor.name}": {told}; {len(self.runs)} runs)'


@check_arguments
def fit_factors(
    conveyor: Conveyor,
    runs: Sequence[MeasuredRun],
    *,
    error: float | None = None,
    factors: Sequence[str] | None = None,
    rtol: float | None = None,
    progress: ProgressCallback | None = None,
) -> CalculatedCalibration:
    """Fit factors on forces to measured power.

    Parameters
    ----------
    conveyor : Conveyor
        The spec; its own calibration is ignored and replaced.
    runs : sequence of MeasuredRun
        Measured power.
    error : float, optional
        Relative standard deviation of a power [-], for runs that do not state theirs; by default from the residuals,
        with bands no narrower than 2 % make them.
    factors : sequence of str, optional
        Those of indentation, idler_rotation, flexure and misalignment to fit, each for itself, the others stay 1; by
        default as many as the runs resolve, the others joined.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of the spec.
    progress : callable, optional
        Called with the items done and their total.

    Returns
    -------
    CalculatedCalibration
        Factors with bands, runs with residuals, remarks.

    Raises
    ------
    InputError
        Fewer runs than factors, runs at the mains without the train's efficiency, runs that brake without theirs or
        against the calculation, factors that are not resolved or come out negative, or a classical method.
    NoSolutionError, RangeError
        A run has no answer.

    Notes
    -----
    Bands hold nine tenths: from the errors stated, widened by the root of chi square over its degrees of freedom where
    that is improbable (below 1 %), or from the residuals, with Student's t, and then no narrower than a known error of
    `TYPICAL_ERROR` makes them. Which factors are joined is decided before the fit, by the bands to be expected: chosen
    by its residuals a grouping would have bands that hold less. The forces that have no factor (lift, tilt,
    secondary resistances) and the efficiencies are taken as the spec says.
    """
    require_rolling_contact(conveyor, "factors of its forces are found")
    _check_runs(conveyor, runs, error, factors)
    plain = conveyor.replace(calculation=conveyor.calculation.replace(calibration=None))
    solve = partial(calculate_many, rtol=rtol, progress=progress)
    scene = SolvedRuns.of(plain, runs, Calibration(), error, solve)
    before = scene.power(Calibration())
    _check_direction(runs, before, "as calculated")
    free, notes = free_factors(scene, factors)
    for _ in range(MOST_ITERATIONS):
        chosen, solved = select_grouping(scene, free, wanted=factors is not None)
        if not scene.curved or scene.solved_with(solved.calibration):
            break
        scene = SolvedRuns.of(plain, runs, solved.calibration, error, solve)
    else:
        raise NoSolutionError("the factors and the loads on vertical curves do not settle: fit fewer factors")
    _check_direction(runs, solved.power, "with the factors")
    source = f"{len(runs)} measured run{'s'[: len(runs) > 1]}, conveyor calibrate {version('conveyor')}"
    made = solved.calibration.replace(source=source)
    calibrated = conveyor.replace(calculation=conveyor.calculation.replace(calibration=made))
    relations = [*notes, *_unresolved_groups(runs, chosen), *solved.notes]
    figures = (each.tolist() for each in (scene.measured, before, solved.power, solved.sigma))
    columns = zip(runs, *figures, strict=True)
    return CalculatedCalibration(
        conveyor=calibrated,
        factors=solved.factors,
        held=tuple(name for name in CALIBRATED_FORCES if not any(name in group for group in chosen)),
        correlation=solved.correlation,
        runs=tuple(CalibratedRun(*column) for column in columns),
        chi_square=solved.chi_square,
        freedom=solved.freedom,
        error=solved.error,
        estimated=scene.estimated,
        notes=tuple(relations),
    )


def _check_runs(
    conveyor: Conveyor, runs: Sequence[MeasuredRun], error: float | None, factors: Sequence[str] | None
) -> None:
    """Reject runs that cannot be fitted."""
    unknown = [name for name in factors or () if name not in CALIBRATED_FORCES]
    if unknown or (factors is not None and not factors):
        raise InputError(f"factors: got {', '.join(unknown) or 'none'}, allowed: {', '.join(CALIBRATED_FORCES)}")
    twice = next((name for name in factors or () if list(factors or ()).count(name) > 1), None)
    if twice is not None:
        raise InputError(f"factors: {twice} is given twice; each one once")
    if error is not None and not 0.0 < error < 1.0:
        raise InputError(f"error = {error:g}: a standard deviation over the power, between 0 and 1, is needed")
    wanted = 1 if factors is None else len(factors)
    if len(runs) < wanted or not runs:
        raise InputError(f"{len(runs)} runs for {wanted} factors: give as many runs as factors at least")
    for number, run in enumerate(runs, start=1):
        if run.at == "mains" and not conveyor.drive.knows_mains:
            raise InputError(
                f"run {number}: its power is that at the mains, and drive.train has no part between mains and motor "
                "shaft: add the motor and the converter (side: mains), or measure at the shaft"
            )
        if run.watts == 0.0:
            raise InputError(f"run {number}: a power of 0 tells nothing of the friction; remove it")
        if run.watts < 0.0 and conveyor.drive.regeneration_efficiency is None:
            raise InputError(
                f"run {number}: the belt drives its motors, and drive.regeneration_efficiency is not given: give it"
            )
    stated = [run.deviation is not None for run in runs]
    if any(stated) and not all(stated) and error is None:
        raise InputError(
            f"run {1 + stated.index(False)}: no standard deviation, others have one; complete it, or give one for all "
            "others (error)"
        )


def _check_direction(runs: Sequence[MeasuredRun], power: Array, how: str) -> None:
    for number, (run, watts) in enumerate(zip(runs, power.tolist(), strict=True), start=1):
        if run.watts * watts <= 0.0:
            raise InputError(
                f"run {number}: measured {{}}, {how} {{}}: one drives, the other brakes, and the drive's efficiency "
                "counts either way; leave the run out, or look at route and flow",
                *(MessageQuantity(each, "power", f"{each / 1e3:.4g} kW") for each in (run.watts, watts)),
            )


def _unresolved_groups(runs: Sequence[MeasuredRun], grouping: Grouping) -> Iterator[str]:
    """Notes on the joined factors, and the runs that would separate them."""
    for group in grouping:
        if len(group) > 1:
            yield (
                f"{_kind_of_runs(runs)}: {force_names(group)} cannot be told apart; one factor for them. Empty and "
                f"full "
                "runs tell losses under load from constant ones, several temperatures rubber from rolls"
            )


def _kind_of_runs(runs: Sequence[MeasuredRun]) -> str:
    """Description of what all runs have in common."""
    flows, temperatures = ({run.state[k] for run in runs} for k in (0, 2))
    flow = "empty runs only" if flows == {0.0} else "runs at one flow only" if len(flows) == 1 else ""
    alike = [flow] if flow else []
    if len(temperatures) == 1:
        alike.append("at one temperature only" if flow else "runs at one temperature only")
    return ", ".join(alike) or "these runs"
