"""Factors on the main resistances from measured power, as many as the runs resolve, with bands.

Every run is the conveyor of the spec at its flow, speed and temperature; all contacts are solved in one batch, once.
The forces are then scaled and the loop of tensions is closed again (Gauss-Newton: the power is nearly linear in the
factors), weighted least squares. Factors that the runs do not resolve are joined: the grouping with the most factors
whose bands are narrow enough is taken. Derived; least squares and bands as in every textbook (Seber and Lee, Linear
Regression Analysis, 2003, chapters 3 and 5).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, stdtrit

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError, MessageQuantity, NoSolutionError
from conveyor.forces import forces_along_belt
from conveyor.loop.balance import OpenLoop, close_loops, raise_first_error
from conveyor.models import CALIBRATED_FORCES, Calibration, Conveyor, MeasuredRun
from conveyor.models.variants import with_runs
from conveyor.pipeline import CalculatedConveyor, NoAnswer, ProgressCallback, Variant, calculate_many
from conveyor.rubber.rolling_test_factor import BAND_COVERAGE

Array = NDArray[np.float64]
Group = tuple[str, ...]
Grouping = tuple[Group, ...]

TYPICAL_ERROR: Final = 0.02
"""Relative standard deviation of a measured power assumed until residuals are known: general knowledge (a power meter
of 0.5 to 1 % and a belt scale of 1 to 2 %)."""
WIDEST_BAND: Final = 0.25
"""Widest half band of a factor that is reported: a wider one says less than a guess (general knowledge)."""
JOINED_SPREAD: Final = 0.2
"""Standard deviation of joined factors about their mean: general knowledge (friction factors of like conveyors spread
as much). It enters the bands of the other factors."""
POOR_FIT: Final = 0.01
"""Probability of a larger chi square below which stated errors are taken to be too small, and bands are widened."""
LARGEST_FACTOR: Final = 10.0
_BY_LOAD: Final = ("flexure", "misalignment")
_DIGITS: Final = 6
_STEP: Final = 1e-3  # of a factor for derivatives; the power is linear but for wraps and the take-up's conditions
_STEP_TOLERANCE: Final = 1e-7
_MOST_ITERATIONS: Final = 30


@dataclass(frozen=True)
class FittedFactor:
    """A fitted factor, one for all its forces, with the ends of its 90 % band [-]."""

    forces: tuple[str, ...]
    value: float
    low: float
    high: float

    @property
    def name(self) -> str:
        """Names of its forces."""
        return _force_names(self.forces)


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
        Relative standard deviation of a power [-], for runs that do not state theirs; by default from the residuals.
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
        against the calculation, factors that are not resolved or come out negative.
    NoSolutionError, RangeError
        A run has no answer.

    Notes
    -----
    Bands hold nine tenths: from the errors stated, widened by the root of chi square over its degrees of freedom where
    that is improbable (below 1 %), or from the residuals, with Student's t. The forces that have no factor (lift, tilt,
    secondary resistances) and the efficiencies are taken as the spec says.
    """
    _check_runs(conveyor, runs, error, factors)
    plain = conveyor.replace(calculation=conveyor.calculation.replace(calibration=None))
    solve = partial(calculate_many, rtol=rtol, progress=progress)
    scene = _SolvedRuns.of(plain, runs, Calibration(), error, solve)
    before = scene.power(Calibration())
    _check_direction(runs, before, "as calculated")
    free, notes = _free_factors(scene, factors)
    for _ in range(_MOST_ITERATIONS):
        chosen, solved = _select_grouping(scene, free, wanted=factors is not None)
        if not scene.curved or scene.solved_with(solved.calibration):
            break
        scene = _SolvedRuns.of(plain, runs, solved.calibration, error, solve)
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
    if error is not None and not 0.0 < error < 1.0:
        raise InputError(f"error = {error:g}: a standard deviation over the power, between 0 and 1, is needed")
    wanted = 1 if factors is None else len(set(factors))
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


@dataclass(frozen=True, eq=False)
class _SolvedRuns:
    """The runs with their contacts solved at given factors (which on vertical curves load the rolls)."""

    found: tuple[CalculatedConveyor, ...]
    at: tuple[str, ...]
    measured: Array
    stated: Array | None
    error: float | None
    under: Calibration

    @classmethod
    def of(
        cls,
        conveyor: Conveyor,
        runs: Sequence[MeasuredRun],
        under: Calibration,
        error: float | None,
        solve: Callable[[list[Variant]], list[CalculatedConveyor | NoAnswer]],
    ) -> _SolvedRuns:
        """Solve the runs, each distinct state once."""
        made = conveyor.replace(calculation=conveyor.calculation.replace(calibration=under))
        states = dict(zip((run.state for run in runs), with_runs(made, runs), strict=True))
        answers = dict(zip(states, solve(list(map(Variant, states.values()))), strict=True))
        rows = []
        for number, run in enumerate(runs, start=1):
            answer = answers[run.state]
            if not isinstance(answer, CalculatedConveyor):
                raise answer.at(f"run {number}")
            rows.append(answer)
        measured = np.array([run.watts for run in runs])
        own = [run.deviation_watts for run in runs]
        stated = None
        if any(value is not None for value in own):
            shares = (error or 0.0) * abs(measured)
            stated = np.array([value or share for value, share in zip(own, shares.tolist(), strict=True)])
        return cls(tuple(rows), tuple(run.at for run in runs), measured, stated, error, under)

    @property
    def curved(self) -> bool:
        """True if tensions load the rolls."""
        return self.found[0].line.has_tension_coupling

    @property
    def estimated(self) -> bool:
        """True if errors are estimated from the residuals."""
        return self.error is None and self.stated is None

    def solved_with(self, calibration: Calibration) -> bool:
        """True if the contacts were solved at these factors, within 1e-4."""
        pairs = zip(self.under.factors.values(), calibration.factors.values(), strict=True)
        return all(abs(a - b) <= 10.0**-4 for a, b in pairs)

    def power(self, calibration: Calibration) -> Array:
        """Power of every run at its point of measurement [W], with the loop closed on the scaled forces."""
        runs = dict.fromkeys(self.found)
        loops = [
            OpenLoop(
                one.balance.frame,
                forces_along_belt(one.line, one.fixed, one.contacts.indentation, calibration=calibration),
                one.balance.unit_main,
            )
            for one in runs
        ]
        power = {one: made.power for one, made in zip(runs, raise_first_error(close_loops(loops)), strict=True)}
        pairs = zip(self.found, self.at, strict=True)
        return np.array([power[one].mains if at == "mains" else power[one].motor for one, at in pairs])

    def slopes(self, grouping: Grouping, values: Sequence[float], power: Array) -> Array:
        """Derivatives of the powers with respect to the group factors [W], shape (n, groups)."""
        columns = []
        for k in range(len(grouping)):
            moved = [value * (1.0 + _STEP * (i == k)) for i, value in enumerate(values)]
            columns.append((self.power(_grouped_calibration(grouping, moved)) - power) / (_STEP * values[k]))
        return np.array(columns).T

    def sigma(self, power: Array) -> Array:
        """Standard errors of the runs [W]: stated, or the relative error times the calculated power."""
        return self.stated if self.stated is not None else (self.error or 1.0) * abs(power)


def _grouped_calibration(grouping: Grouping, values: Sequence[float]) -> Calibration:
    return Calibration(**{name: value for group, value in zip(grouping, values, strict=True) for name in group})


def _free_factors(scene: _SolvedRuns, factors: Sequence[str] | None) -> tuple[Grouping, list[str]]:
    """Factors that affect the power, and notes on the others; those that no power can separate are joined.

    Flexure and misalignment are both proportional to the load, at any flow, speed and temperature.
    """
    notes = []
    forces = {name: max(abs(_total_force(one, name)) for one in scene.found) for name in CALIBRATED_FORCES}
    free = [name for name in CALIBRATED_FORCES if forces[name] > 0.0]
    if "flexure" in free and scene.found[0].fixed.flexure is None:
        if factors is None:
            free.remove("flexure")
        notes.append(
            "flexure is a share of the main resistance here: it follows indentation and idler rotation, "
            "a factor of its own cannot be told apart"
        )
    if factors is not None:
        idle = [name for name in factors if forces[name] == 0.0]
        if idle:
            raise InputError(f"factors: {_force_names(idle)} is no force of this conveyor: leave it out")
        return tuple((name,) for name in CALIBRATED_FORCES if name in factors), notes
    groups: list[Group] = [(name,) for name in free if name not in _BY_LOAD]
    if (
        "flexure" in free
    ):  # small against flexure, misalignment stays as computed where flexure has no factor of its own
        groups.append(tuple(name for name in free if name in _BY_LOAD))
    return tuple(groups), notes


def _total_force(one: CalculatedConveyor, name: str) -> float:
    return next(force.total for force in one.balance.along if force.key == name)


@dataclass(frozen=True, eq=False)
class _Fit:
    """Fitted factors of a grouping, rounded as they are reported."""

    calibration: Calibration
    factors: tuple[FittedFactor, ...]
    correlation: Array
    power: Array
    sigma: Array
    chi_square: float
    freedom: int
    error: float | None
    notes: tuple[str, ...]


def _possible_groupings(free: Grouping) -> Iterator[list[Grouping]]:
    """Groupings of the factors, from most to fewest: each for itself, two joined, all joined."""
    yield [free]
    if len(free) == 3:
        a, b, c = free
        yield [(a + c, b), (a, b + c), (a + b, c)]
    if len(free) > 1:
        yield [(sum(free, ()),)]


def _select_grouping(scene: _SolvedRuns, free: Grouping, *, wanted: bool) -> tuple[Grouping, _Fit]:
    """Grouping and fit with the most factors whose bands are narrow enough.

    Raises
    ------
    InputError
        No factor, or not those requested, can be fitted.
    """
    reasons = []
    for ways in _possible_groupings(free):
        judged = sorted(((_expected_width(scene, way), way) for way in ways), key=lambda pair: pair[0])
        for width, way in judged:
            fewest = len(way) + scene.estimated
            if len(scene.measured) < fewest:
                stated = "; with a stated error one less" if scene.estimated else ""
                reasons.append(f"{_grouping_text(way)}: {fewest} runs at least are needed{stated}")
                continue
            if width > WIDEST_BAND:
                wide = f"a band wider than ±{WIDEST_BAND:g} is to be expected"
                reasons.append(f"{_grouping_text(way)}: the runs do not tell, {wide}")
                continue
            fit = _fit_grouping(scene, way)
            if isinstance(fit, _Fit):
                return way, fit
            reasons.append(f"{_grouping_text(way)}: {fit}")
        if wanted:
            break
    too_few = all("runs at least are needed" in reason for reason in reasons)
    raise InputError(
        "; ".join(reasons[-1:] if too_few else reasons)
        + ". Give more runs, empty and full ones and at several temperatures, or ask for fewer factors"
    )


def _expected_width(scene: _SolvedRuns, grouping: Grouping) -> float:
    """Widest half band of a grouping's factors expected before the fit [-]; infinite if they are dependent."""
    ones = [1.0] * len(grouping)
    power = scene.power(Calibration())
    error = scene.sigma(power) * (TYPICAL_ERROR if scene.estimated else 1.0)
    weighed = scene.slopes(grouping, ones, power) / error[:, None]
    if np.linalg.matrix_rank(weighed) < len(grouping):
        return math.inf
    spread = np.sqrt(np.diag(np.linalg.inv(weighed.T @ weighed)))
    return float(_normal_quantile() * spread.max())


def _normal_quantile() -> float:
    return _student_quantile(10**9)


def _student_quantile(freedom: int) -> float:
    """Student's t quantile at the end of a 90 % band [-]."""
    return float(stdtrit(freedom, 0.5 + 0.5 * BAND_COVERAGE))


def _fit_grouping(scene: _SolvedRuns, grouping: Grouping) -> _Fit | str:
    """Gauss-Newton fit on the closed loop, or the reason why its factors are unusable."""
    values = [1.0] * len(grouping)
    for _ in range(_MOST_ITERATIONS):
        power = scene.power(_grouped_calibration(grouping, values))
        slopes, sigma = scene.slopes(grouping, values, power), scene.sigma(power)
        step = np.linalg.lstsq(slopes / sigma[:, None], (scene.measured - power) / sigma, rcond=None)[0]
        values = [value + float(change) for value, change in zip(values, step, strict=True)]
        for group, value in zip(grouping, values, strict=True):
            if not 0.0 < value <= LARGEST_FACTOR:
                return f"the factor of {_force_names(group)} comes out as {value:.3g}"
        if float(abs(step).max()) <= _STEP_TOLERANCE:
            break
    else:
        return "does not settle"
    values = [float(f"{value:.{_DIGITS}g}") for value in values]
    calibration = _grouped_calibration(grouping, values)
    power = scene.power(calibration)
    return _fit_with_bands(scene, grouping, values, power, scene.slopes(grouping, values, power))


def _fit_with_bands(
    scene: _SolvedRuns, grouping: Grouping, values: list[float], power: Array, slopes: Array
) -> _Fit | str:
    """Fit with the bands of its factors, or the reason why one band is too wide."""
    sigma, freedom = scene.sigma(power), len(power) - len(values)
    chi_square = float((((scene.measured - power) / sigma) ** 2).sum())
    error, ends, notes = scene.error, _normal_quantile(), []
    if scene.estimated:
        error = math.sqrt(chi_square / freedom)
        sigma, chi_square, ends = error * sigma, float(freedom), _student_quantile(freedom)
    elif freedom > 0 and chdtrc(freedom, chi_square) < POOR_FIT:
        wider = math.sqrt(chi_square / freedom)
        sigma, ends = sigma * wider, _student_quantile(freedom)
        notes.append(
            f"the differences are {wider:.2g} times the errors stated (probability below {100.0 * POOR_FIT:.0f} %): "
            "the errors are larger, or something else than these factors differs; the bands are widened by it"
        )
    weighed = slopes / sigma[:, None]
    covariance = np.linalg.inv(weighed.T @ weighed)
    covariance += _joined_covariance(scene, grouping, values, power, covariance @ (weighed / sigma[:, None]).T)
    spread = np.sqrt(np.diag(covariance))
    factors = tuple(
        FittedFactor(group, value, value - ends * one, value + ends * one)
        for group, value, one in zip(grouping, values, spread.tolist(), strict=True)
    )
    for factor in factors:
        if factor.high - factor.value > WIDEST_BAND:
            return f"the factor of {factor.name} has a band of ±{factor.high - factor.value:.2g}"
    correlation = covariance / np.outer(spread, spread)
    stated = None if scene.stated is not None else error
    return _Fit(
        _grouped_calibration(grouping, values), factors, correlation, power,
        sigma if scene.estimated else scene.sigma(power),
        chi_square, freedom, stated, tuple(notes),
    )  # fmt: skip


def _joined_covariance(
    scene: _SolvedRuns, grouping: Grouping, values: Sequence[float], power: Array, solved: Array
) -> Array:
    """Covariance of the factors from the differences within joined ones, which are means weighted by the runs.

    With P = Σ J_i θ_i and estimates A P, A of shape (groups, runs), a difference δ_i moves the factor of group k by
    A_k J_i δ_i.
    """
    joined = np.zeros((len(grouping), len(grouping)))
    for k, (group, value) in enumerate(zip(grouping, values, strict=True)):
        if len(group) > 1:
            apart = tuple((name,) for name in group)
            others = [g for i, g in enumerate(grouping) if i != k]
            fixed = [v for i, v in enumerate(values) if i != k]
            slopes = scene.slopes((*apart, *others), [*[value] * len(group), *fixed], power)[:, : len(group)]
            moved = solved @ slopes
            moved[k] = 0.0
            joined += JOINED_SPREAD**2 * moved @ moved.T
    return joined


def _unresolved_groups(runs: Sequence[MeasuredRun], grouping: Grouping) -> Iterator[str]:
    """Notes on the joined factors, and the runs that would separate them."""
    for group in grouping:
        if len(group) > 1:
            yield (
                f"{_kind_of_runs(runs)}: {_force_names(group)} cannot be told apart; one factor for them. Empty and "
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


def _grouping_text(grouping: Grouping) -> str:
    if len(grouping) == 1:
        return f"one factor for {_force_names(grouping[0])}"
    return "; ".join(_force_names(group) for group in grouping)


def _force_names(forces: Sequence[str]) -> str:
    *others, last = [force.replace("_", " ") for force in forces]
    return f"{', '.join(others)} and {last}" if others else last
