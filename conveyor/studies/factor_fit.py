"""Which forces of measured runs have a factor of their own, and the factors by least squares with their bands."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, stdtrit

from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant
from conveyor.default_bands import close_design_loops
from conveyor.errors import InputError, NoSolutionError
from conveyor.forces import forces_along_belt
from conveyor.loop.balance import OpenLoop, close_loops, raise_first_error
from conveyor.models import CALIBRATED_FORCES, Calibration, Conveyor, MeasuredRun
from conveyor.models.variants import with_runs
from conveyor.rubber.rolling_test_factor import BAND_COVERAGE

Array = NDArray[np.float64]


Group = tuple[str, ...]


Grouping = tuple[Group, ...]


TYPICAL_ERROR: Final = 0.02
"""Relative standard deviation of a measured power: general knowledge (a power meter of 0.5 to 1 % and a belt scale of 1
to 2 %). Without stated errors it decides the grouping, and no band is narrower than it makes it."""


WIDEST_BAND: Final = 0.25
"""Widest half band to be expected of a fitted factor: a wider one says less than a guess (general knowledge)."""


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


MOST_ITERATIONS: Final = 30


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
        return force_names(self.forces)


@dataclass(frozen=True, eq=False)
class SolvedRuns:
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
    ) -> SolvedRuns:
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
        own_band = self.found[0].conveyor.drive.design_friction is None
        loops = [
            OpenLoop(
                one.balance.layout.designed_for(1.0) if own_band else one.balance.layout,
                forces_along_belt(one.line, one.rubber_free, one.contacts.indentation, calibration=calibration),
                one.balance.unit_main,
            )
            for one in runs
        ]
        closed = raise_first_error(close_loops(loops))
        if own_band:
            scaled = [replace(one, balance=balance) for one, balance in zip(runs, closed, strict=True)]
            closed = raise_first_error(
                [one if isinstance(one, NoSolutionError) else one.balance for one in close_design_loops(scaled, loops)]
            )
        power = {one: made.power for one, made in zip(runs, closed, strict=True)}
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


def free_factors(scene: SolvedRuns, factors: Sequence[str] | None) -> tuple[Grouping, list[str]]:
    """Factors that affect the power, and notes on the others; those that no power can separate are joined.

    Flexure and misalignment are both proportional to the load, at any flow, speed and temperature.
    """
    notes = []
    forces = {name: max(abs(_total_force(one, name)) for one in scene.found) for name in CALIBRATED_FORCES}
    free = [name for name in CALIBRATED_FORCES if forces[name] > 0.0]
    if "flexure" in free and scene.found[0].rubber_free.flexure is None:
        if factors is None:
            free.remove("flexure")
        notes.append(
            "flexure is a share of the main resistance here: it follows indentation and idler rotation, "
            "a factor of its own cannot be told apart"
        )
    if factors is not None:
        idle = [name for name in factors if forces[name] == 0.0]
        if idle:
            raise InputError(f"factors: {force_names(idle)} is no force of this conveyor: leave it out")
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


def select_grouping(scene: SolvedRuns, free: Grouping, *, wanted: bool) -> tuple[Grouping, _Fit]:
    """Grouping and fit with the most factors whose bands are expected to be narrow enough.

    What decides is known before the fit: bands of a grouping taken for its small differences would not hold.

    Raises
    ------
    InputError
        No factor, or not those requested, can be fitted.
    """
    reasons = []
    power = scene.power(Calibration())
    slopes, sigma = _force_slopes(scene, free, [1.0] * len(free), power), scene.sigma(power)
    for ways in _possible_groupings(free):
        judged = sorted(((_expected_width(scene, way, slopes, sigma), way) for way in ways), key=lambda pair: pair[0])
        for width, way in judged:
            fewest = len(way) + scene.estimated
            if len(scene.measured) < fewest:
                stated = "; with a stated error one less" if scene.estimated else ""
                reasons.append(f"{_grouping_text(way)}: {fewest} runs at least are needed{stated}")
                continue
            if width > WIDEST_BAND:
                stated = " without a stated error" if scene.estimated else ""
                wide = f"a band wider than ±{WIDEST_BAND:g} is to be expected{stated}"
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


def _expected_width(scene: SolvedRuns, grouping: Grouping, slopes: Mapping[str, Array], sigma: Array) -> float:
    """Widest half band of a grouping's factors expected before the fit [-]; infinite if they are dependent."""
    if np.linalg.matrix_rank(_group_slopes(grouping, slopes) / sigma[:, None]) < len(grouping):
        return math.inf
    reach = 1.0
    if scene.estimated:
        reach = TYPICAL_ERROR * _student_ratio(len(scene.measured) - len(grouping))
    covariance = _factor_covariance(grouping, slopes, reach * sigma)
    return float(_normal_quantile() * np.sqrt(np.diag(covariance)).max())


def _normal_quantile() -> float:
    """Normal quantile at the end of a 90 % band [-]."""
    return _student_quantile(10**9)


def _student_quantile(freedom: int) -> float:
    """Student's t quantile at the end of a 90 % band [-]."""
    return float(stdtrit(freedom, 0.5 + 0.5 * BAND_COVERAGE))


def _student_ratio(freedom: int) -> float:
    """Student's quantile over the normal one [-]: an error from few differences, as one that is known."""
    return _student_quantile(freedom) / _normal_quantile()


def _force_slopes(scene: SolvedRuns, grouping: Grouping, values: Sequence[float], power: Array) -> dict[str, Array]:
    """Derivatives of the powers with respect to the factor of each force [W]."""
    names = [name for group in grouping for name in group]
    at = [value for group, value in zip(grouping, values, strict=True) for _ in group]
    return dict(zip(names, scene.slopes(tuple((name,) for name in names), at, power).T, strict=True))


def _group_slopes(grouping: Grouping, slopes: Mapping[str, Array]) -> Array:
    """Derivatives of the powers with respect to the group factors [W], shape (n, groups)."""
    return np.array([np.sum([slopes[name] for name in group], axis=0) for group in grouping]).T


def _factor_covariance(grouping: Grouping, slopes: Mapping[str, Array], sigma: Array) -> Array:
    """Covariance of the factors from the errors of the runs [W] and the differences within joined factors.

    Joined ones are means weighted by the runs: with P = Σ J_i θ_i and estimates A P, A of shape (groups, runs), a
    difference δ_i moves the factor of another group k by A_k J_i δ_i.
    """
    weighed = _group_slopes(grouping, slopes) / sigma[:, None]
    covariance = np.asarray(np.linalg.inv(weighed.T @ weighed), dtype=float)
    solved = covariance @ (weighed / sigma[:, None]).T
    for k, group in enumerate(grouping):
        if len(group) > 1:
            moved = solved @ np.array([slopes[name] for name in group]).T
            moved[k] = 0.0
            covariance = covariance + JOINED_SPREAD**2 * moved @ moved.T
    return covariance


def _fit_grouping(scene: SolvedRuns, grouping: Grouping) -> _Fit | str:
    """Gauss-Newton fit on the closed loop, or the reason why its factors are unusable."""
    values = [1.0] * len(grouping)
    for _ in range(MOST_ITERATIONS):
        power = scene.power(_grouped_calibration(grouping, values))
        slopes, sigma = scene.slopes(grouping, values, power), scene.sigma(power)
        step = np.linalg.lstsq(slopes / sigma[:, None], (scene.measured - power) / sigma, rcond=None)[0]
        values = [value + float(change) for value, change in zip(values, step, strict=True)]
        for group, value in zip(grouping, values, strict=True):
            if not 0.0 < value <= LARGEST_FACTOR:
                return f"the factor of {force_names(group)} comes out as {value:.3g}"
        if float(abs(step).max()) <= _STEP_TOLERANCE:
            break
    else:
        return "does not settle"
    values = [float(f"{value:.{_DIGITS}g}") for value in values]
    calibration = _grouped_calibration(grouping, values)
    power = scene.power(calibration)
    return _fit_with_bands(scene, grouping, values, power)


def _fit_with_bands(scene: SolvedRuns, grouping: Grouping, values: list[float], power: Array) -> _Fit:
    """Fit with the bands of its factors."""
    sigma, freedom = scene.sigma(power), len(power) - len(values)
    weights = sigma
    chi_square = float((((scene.measured - power) / sigma) ** 2).sum())
    error, reach, notes = scene.error, 1.0, []
    if scene.estimated:
        error = math.sqrt(chi_square / freedom)
        reach, weights, chi_square = error * _student_ratio(freedom), error * sigma, float(freedom)
        if reach < TYPICAL_ERROR:
            reach = TYPICAL_ERROR
            notes.append(
                f"the differences are smaller than meters and belt scales let expect: the bands are those of a known "
                f"error of {100.0 * TYPICAL_ERROR:g} % of each power; state the errors for narrower ones"
            )
    elif freedom > 0 and chdtrc(freedom, chi_square) < POOR_FIT:
        wider = math.sqrt(chi_square / freedom)
        reach = wider * _student_ratio(freedom)
        notes.append(
            f"the differences are {wider:.2g} times the errors stated (probability below {100.0 * POOR_FIT:.0f} %): "
            "the errors are larger, or something else than these factors differs; the bands are widened by it"
        )
    covariance = _factor_covariance(grouping, _force_slopes(scene, grouping, values, power), reach * sigma)
    spread = np.sqrt(np.diag(covariance))
    half = (_normal_quantile() * spread).tolist()
    factors = tuple(
        FittedFactor(group, value, value - ends, value + ends)
        for group, value, ends in zip(grouping, values, half, strict=True)
    )
    notes += [
        f"the band of {factor.name} is wider than ±{WIDEST_BAND:g}: the differences are larger than meters and belt "
        "scales explain; look for runs that were not steady, or give more"
        for factor, ends in zip(factors, half, strict=True)
        if ends > WIDEST_BAND
    ]
    return _Fit(
        _grouped_calibration(grouping, values), factors, covariance / np.outer(spread, spread), power,
        weights, chi_square, freedom, None if scene.stated is not None else error, tuple(notes),
    )  # fmt: skip


def _grouping_text(grouping: Grouping) -> str:
    if len(grouping) == 1:
        return f"one factor for {force_names(grouping[0])}"
    return "; ".join(force_names(group) for group in grouping)


def force_names(forces: Sequence[str]) -> str:
    """Names of forces in words."""
    *others, last = [force.replace("_", " ") for force in forces]
    return f"{', '.join(others)} and {last}" if others else last
